//! Blocks of commands and of their output in Markdown.

/// Numbers below this are round-off, whose digits differ between builds.
const ROUND_OFF: f64 = 1e-12;

/// A block of output and the command line before it.
pub(crate) struct Printed {
    pub(crate) command: Vec<String>,
    /// Its lines; `...` stands for any others.
    pub(crate) lines: Vec<String>,
}

/// The fenced blocks of a page: language and text.
pub(crate) fn fenced(page: &str) -> Vec<(String, String)> {
    let parts: Vec<&str> = page.split("\n```").collect();
    let inside = parts.iter().skip(1).step_by(2);
    let block = |part: &&str| {
        part.split_once('\n')
            .map(|(language, text)| (language.to_owned(), text.to_owned()))
    };
    inside.filter_map(block).collect()
}

/// Each block of output, with the last command of the block of commands that stands last before it.
/// What a block of Python prints, the tests of the package compare.
pub(crate) fn printed(page: &str) -> Vec<Printed> {
    let mut all = vec![];
    let mut command = None;
    let mut before = String::new();
    for (language, text) in fenced(page) {
        let is_of_python = before == "python";
        before.clone_from(&language);
        match language.as_str() {
            "text" if is_of_python => {}
            "sh" => {
                command = text
                    .lines()
                    .rfind(|line| !line.starts_with('#'))
                    .map(str::to_owned);
            }
            "text" => all.push(Printed {
                command: command
                    .take()
                    .expect("a command before its output")
                    .split(' ')
                    .map(str::to_owned)
                    .collect(),
                lines: text.lines().map(str::to_owned).collect(),
            }),
            _ => {}
        }
    }
    all
}

/// Whether two words are the same, or both round-off.
fn are_alike(one: &str, other: &str) -> bool {
    let is_round_off = |word: &str| {
        word.parse::<f64>()
            .is_ok_and(|number| number != 0.0 && number.abs() < ROUND_OFF)
    };
    one == other || is_round_off(one) && is_round_off(other)
}

/// The first line of a block that an output does not have in its place.
pub(crate) fn missing(block: &[String], output: &str) -> Option<String> {
    let is_line = |line: &str, found: &str| {
        let [line, found] = [line, found].map(|text| text.split(' ').collect::<Vec<_>>());
        line.len() == found.len()
            && line
                .iter()
                .zip(&found)
                .all(|(one, other)| are_alike(one, other))
    };
    let mut output = output.lines().filter(|line| !line.trim().is_empty());
    let mut may_skip = false;
    for line in block.iter().filter(|line| !line.trim().is_empty()) {
        if line == "..." {
            may_skip = true;
            continue;
        }
        let is_there = if may_skip {
            output.any(|found| is_line(line, found))
        } else {
            output.next().is_some_and(|found| is_line(line, found))
        };
        if !is_there {
            return Some(line.clone());
        }
        may_skip = false;
    }
    output
        .next()
        .filter(|_| !may_skip)
        .map(|line| format!("nothing, found {line}"))
}
