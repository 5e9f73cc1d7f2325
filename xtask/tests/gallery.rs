//! The gallery of the book shows the files that `.ci/programs` runs: whole, short, and with figures
//! that name no folder of a machine.

use std::fs;

use crate::place::{read, root};
use crate::readme::blocks::fenced;

const PAGES: &str = "crates/convergence-study/book/src/gallery";

/// How a page links a program or another file of a code; its path below `studies` follows.
const LINK: &str = "](../../../../../studies/";

/// Lines of the longest program, and of its part for the harness only.
const LONGEST: usize = 60;
const LONGEST_FOR_THE_HARNESS: usize = 10;

/// Bytes of the largest figure.
const LARGEST: usize = 20_000;

/// The files that a page links, in their order.
fn linked(page: &str) -> Vec<&str> {
    let after = page.split(LINK).skip(1);
    after.filter_map(|rest| rest.split(')').next()).collect()
}

/// The linked files whose text is not the block of code after their link.
fn differing(page: &str, text_of: impl Fn(&str) -> String) -> Vec<String> {
    let blocks = fenced(page);
    let files = linked(page).into_iter().enumerate();
    let differs = |(k, file): &(usize, &str)| {
        blocks
            .get(*k)
            .is_none_or(|(_, block)| block != text_of(file).trim_end())
    };
    files
        .filter(differs)
        .map(|(_, file)| file.to_owned())
        .collect()
}

/// The numbers of lines that a page states: all, and those for the harness.
fn stated(page: &str) -> [usize; 2] {
    let (_, after) = page.split_once("): ").expect("a link and its lines");
    let (all, rest) = after.split_once(" lines, ").expect("lines");
    let (harness, _) = rest.split_once(" of them").expect("lines for the harness");
    [all, harness].map(|number| number.parse().expect("a number"))
}

/// The lines of a program that are not blank, and those behind the mark.
fn lines(program: &str) -> [usize; 2] {
    let lines: Vec<&str> = program
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    let mark = lines
        .iter()
        .position(|line| line.contains("For the harness:"));
    // A test for pytest has no mark: there the lines that use the fixture count.
    let is_of_the_fixture =
        |line: &&&str| line.contains("convergence") && !line.starts_with("\"\"\"");
    let of_the_fixture = || lines.iter().filter(is_of_the_fixture).count();
    let is_a_test = program.contains("(convergence)");
    let harness = match mark {
        Some(mark) => lines.len() - mark - 1,
        None if is_a_test => of_the_fixture(),
        None => 0,
    };
    [lines.len(), harness]
}

/// The pages: name without its ending, and text.
fn pages() -> Vec<(String, String)> {
    let entries = fs::read_dir(root().join(PAGES)).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut pages: Vec<(String, String)> = names
        .filter_map(|name| name.strip_suffix(".md").map(str::to_owned))
        .map(|name| (name.clone(), read(&format!("{PAGES}/{name}.md"))))
        .collect();
    pages.sort();
    pages
}

#[test]
fn each_page_shows_its_files() {
    let pages = pages();
    assert_eq!(pages.len(), 12);
    for (name, page) in pages {
        assert!(!linked(&page).is_empty(), "{name}");
        let differing = differing(&page, |file| read(&format!("studies/{file}")));
        assert!(
            differing.is_empty(),
            "{name}: other text than {differing:?}: run .ci/programs --write"
        );
    }
}

#[test]
fn each_program_is_short_and_its_page_counts_its_lines() {
    for (name, page) in pages() {
        let program = read(&format!("studies/{}", linked(&page)[0]));
        let [all, harness] = lines(&program);
        assert_eq!(stated(&page), [all, harness], "{name}");
        assert!(
            all <= LONGEST && harness <= LONGEST_FOR_THE_HARNESS,
            "{name}: {all} lines, {harness} for the harness"
        );
    }
}

#[test]
fn each_verdict_has_a_mistake_and_a_figure_without_folders() {
    let mut figures = 0;
    for (name, page) in pages() {
        let has_run = !page.contains("\nNobody has run it here.\n");
        assert!(page.contains("\n## With a mistake: "), "{name}");
        assert_eq!(page.contains("\n**pass**\n"), has_run, "{name}");
        assert_eq!(page.contains("\n**fail**\n"), has_run, "{name}");
        assert_eq!(page.contains(&format!("]({name}.svg)")), has_run, "{name}");
        if has_run {
            figures += 1;
            let figure = read(&format!("{PAGES}/{name}.svg"));
            assert!(figure.len() <= LARGEST, "{name}: {} bytes", figure.len());
            for folder in ["/tmp", "/home", "/root", "/Users"] {
                assert!(!figure.contains(folder), "{name}: {folder}");
            }
        }
    }
    assert!(figures >= 11, "{figures}");
}

#[test]
fn a_page_with_another_text_is_found() {
    let page = |code: &str| {
        format!(
            "# A\n\n[a.py{LINK}a.py): 3 lines, 1 of them for the harness.\n\n```python\n{code}\n```\n"
        )
    };
    let file = |_: &str| "x = 1\n\n# For the harness:\nprint(x)\n".to_owned();
    let same = page("x = 1\n\n# For the harness:\nprint(x)");
    assert_eq!(differing(&same, file), Vec::<String>::new());
    assert_eq!(stated(&same), lines(&file("")));
    assert_eq!(differing(&page("x = 2"), file), ["a.py"]);
    assert_eq!(
        differing("[a.py](../../../../../studies/a.py)", file),
        ["a.py"]
    );
    assert_eq!(
        lines("def test_a(convergence):\n    convergence.study(f)\n"),
        [2, 2]
    );
}
