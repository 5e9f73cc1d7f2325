//! Tables as codes, libraries and people print them: each is read as `tables.txt` says, or refused
//! with the command that reads it.
//!
//! With `BLESS_TABLES` set, results and `reading-tables.md` are written anew; read them before
//! committing.

use std::{env, fs, path::Path};

use convergence_study::{
    Choice, Claim, Column, Estimator, Floor, RateTable, Verdict,
    internal::input::advice::CommandLine,
};

/// The tolerance of all claims of the page.
const TOLERANCE: f64 = 0.25;

/// `>>> title`, the options, the table, `---`, and the result.
#[derive(Clone)]
struct Sample {
    title: String,
    options: String,
    /// `→` stands for a tab, `␛` for the escape character, in the file.
    table: String,
    found: String,
}

fn file(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn samples() -> Vec<Sample> {
    let text = fs::read_to_string(file("tests/tables.txt")).expect("the tables");
    let sample = |part: &str| {
        let (head, rest) = part.split_once('\n').expect("a title");
        let (options, rest) = rest.split_once('\n').expect("options");
        let (table, found) = rest
            .split_once("\n---\n")
            .unwrap_or_else(|| panic!("{head}: no result"));
        let options = options
            .strip_prefix('$')
            .unwrap_or_else(|| panic!("{head}: {options}"))
            .trim()
            .to_owned();
        Sample {
            title: head.trim().to_owned(),
            options,
            table: table.to_owned() + "\n",
            found: found.trim_end().to_owned(),
        }
    };
    format!("\n{text}")
        .split("\n>>> ")
        .skip(1)
        .map(sample)
        .collect()
}

/// Words as a shell splits them, without escapes.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            c => words.last_mut().expect("a word").push(c),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The choice made by the options, and the orders they claim.
fn choice(options: &[String]) -> (Choice, Vec<(Option<String>, f64)>) {
    let (mut choice, mut orders) = (Choice::default(), vec![]);
    for option in options.chunks(2) {
        let value = option[1].clone();
        let list = || value.split(',').map(str::to_owned).collect::<Vec<_>>();
        match option[0].as_str() {
            "--dim" => choice.dim = Some(value.parse().expect("a dimension")),
            "--ratio" => choice.ratio = Some(value.parse().expect("a ratio")),
            "--step" => choice.step = Some(value),
            "--columns" => choice.columns = Some(list()),
            "--values" => choice.values = list(),
            "--names" => choice.names = Some(list()),
            "--order" => match value.rsplit_once('=') {
                Some((name, order)) => {
                    orders.push((Some(name.to_owned()), order.parse().expect("an order")));
                }
                None => orders.push((None, value.parse().expect("an order"))),
            },
            other => panic!("{other}"),
        }
    }
    choice.claimed = orders.iter().filter_map(|(name, _)| name.clone()).collect();
    (choice, orders)
}

/// How a table was read, its numbers, and the verdict on each column with a claimed order.
fn told(table: &RateTable, orders: &[(Option<String>, f64)]) -> String {
    let numbers = |column: &Column| {
        column
            .levels
            .iter()
            .map(|level| level.error.to_string())
            .collect::<Vec<_>>()
            .join(" ")
    };
    let first = table
        .columns
        .iter()
        .chain(&table.values)
        .next()
        .expect("a column");
    let steps: Vec<String> = first
        .levels
        .iter()
        .map(|level| level.step.to_string())
        .collect();
    let mut text = format!("{}\n{}: {}\n", table.reading, table.step, steps.join(" "));
    let order = |name: &str| {
        let by_name = orders.iter().find(|(of, _)| {
            of.as_deref()
                .is_some_and(|of| of == name || format!("column {of}") == name)
        });
        by_name
            .or_else(|| orders.iter().find(|(of, _)| of.is_none()))
            .map(|(_, order)| *order)
    };
    for column in &table.columns {
        text += &format!("{}: {}", column.name, numbers(column));
        if let Some(order) = order(&column.name) {
            let judged = column.judge(&Claim::new(order, TOLERANCE), Floor::NONE);
            text += &format!(
                " | {order}: {}{}",
                judged.verdict,
                if judged.verdict == Verdict::Pass {
                    String::new()
                } else {
                    format!(": {}", judged.because)
                }
            );
        }
        text.push('\n');
    }
    for column in &table.values {
        let found = column.estimate(
            &Estimator::new(TOLERANCE).expect("a tolerance"),
            order(&column.name),
        );
        let limit = found.bar.map_or_else(
            |refusal| refusal.to_string(),
            |bar| format!("limit {:.6}", bar.extrapolated),
        );
        text += &format!(
            "{}: {} | {}, {limit}\n",
            column.name,
            numbers(column),
            found.judged.verdict
        );
    }
    text
}

fn found(sample: &Sample) -> String {
    let table = sample.table.replace('→', "\t").replace('␛', "\x1b");
    let (chosen, orders) = choice(&words(&sample.options));
    match RateTable::parse_all_with(&table, "TABLE", &chosen) {
        Ok(tables) => {
            let one = |(heading, table): &(String, RateTable)| match heading.as_str() {
                "" => told(table, &orders),
                heading => format!("{heading}: {}", told(table, &orders)),
            };
            tables.iter().map(one).collect()
        }
        Err(error) => {
            let message = error.words(&CommandLine {
                command: Some("rates TABLE"),
            });
            let mut text = format!("refused: {message}\n");
            // Every command in the message reads the table.
            for line in message
                .lines()
                .filter_map(|line| line.strip_prefix("  rates TABLE"))
            {
                let tables = RateTable::parse_all_with(
                    &table,
                    "TABLE",
                    &choice(&words(line.split("  #").next().unwrap_or_default())).0,
                );
                let tables =
                    tables.unwrap_or_else(|error| panic!("{}: {line}: {error}", sample.title));
                for (_, table) in tables {
                    text += &format!("then: {}\n", table.reading);
                }
            }
            text
        }
    }
}

/// A row of the page: tables that are read in the same way, or refused with the same words.
struct Row {
    titles: Vec<String>,
    options: String,
    text: String,
}

/// The rows of one table of the page.
#[derive(Default)]
struct Rows(Vec<Row>);

impl Rows {
    fn add(&mut self, sample: &Sample, text: &str) {
        let title = sample.title.trim_start_matches("captured: ").to_owned();
        let options = shown(&sample.options);
        let same = |row: &&mut Row| row.options == options && row.text == text;
        match self.0.iter_mut().find(same) {
            Some(row) => row.titles.push(title),
            None => self.0.push(Row {
                titles: vec![title],
                options,
                text: text.to_owned(),
            }),
        }
    }

    /// As Markdown.
    ///
    /// * `last`: the name of the last column.
    fn table(&self, last: &str) -> String {
        let mut table = format!("| table | options | {last} |\n| --- | --- | --- |\n");
        for row in &self.0 {
            let cells = [row.titles.join("; "), row.options.clone(), row.text.clone()];
            let cells = cells.map(|cell| cell.replace('|', "\\|"));
            table += &format!("| {} |\n", cells.join(" | "));
        }
        table
    }
}

/// Options as the page shows them: without an order that is claimed for all columns.
fn shown(options: &str) -> String {
    let words = words(options);
    let pairs = words.chunks(2);
    let matter = pairs.filter(|pair| pair[0] != "--order" || pair[1].contains('='));
    let text = matter.map(|pair| pair.join(" ")).collect::<Vec<_>>();
    match text.join(" ") {
        empty if empty.is_empty() => empty,
        options => format!("`{options}`"),
    }
}

/// What the page says of a refusal: the message without the place, and the first command that
/// works.
fn refusal(message: &str) -> String {
    let (message, rest) = message.split_once('\n').unwrap_or((message, ""));
    let command = rest
        .lines()
        .find_map(|line| line.strip_prefix("  "))
        .map_or(String::new(), |line| format!(": `{line}`"));
    let is_place = |c: char| c == ':' || c == ' ' || c.is_ascii_digit();
    message.trim_start_matches(is_place).to_owned() + &command
}

#[test]
fn every_table_is_read_or_refused_as_the_page_says() {
    let samples = samples();
    let (mut tables, mut wrong) = (String::new(), vec![]);
    let [mut read, mut refused] = [Rows::default(), Rows::default()];
    for sample in &samples {
        let found = found(sample);
        tables += &format!(
            ">>> {}\n$ {}\n{}---\n{found}\n",
            sample.title, sample.options, sample.table
        );
        if found.trim_end() != sample.found {
            wrong.push(format!("{}:\n{found}", sample.title));
        }
        match found.strip_prefix("refused: TABLE") {
            Some(message) => refused.add(sample, &refusal(message)),
            None => read.add(sample, found.lines().next().unwrap_or_default()),
        }
    }
    let (head, _) = include_str!("../book/src/reading-tables.md")
        .split_once("## Read\n")
        .expect("a head");
    let page = format!(
        "{head}## Read\n\n{}\n## Refused\n\n{}",
        read.table("how it is read"),
        refused.table("what is said")
    );
    if env::var_os("BLESS_TABLES").is_some() {
        fs::write(file("tests/tables.txt"), &tables).expect("written");
        fs::write(file("book/src/reading-tables.md"), &page).expect("written");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(
        include_str!("../book/src/reading-tables.md"),
        page,
        "reading-tables.md is not what the tests say"
    );
    assert!(samples.len() >= 200, "{} tables", samples.len());
}

#[test]
fn tables_read_the_same_with_other_line_ends_and_a_byte_order_mark() {
    for sample in samples()
        .iter()
        .filter(|sample| !sample.found.starts_with("refused"))
    {
        for end in ["\r\n", "\r"] {
            let table = format!("\u{feff}{}", sample.table.replace('\n', end));
            let other = Sample {
                table,
                ..sample.clone()
            };
            assert_eq!(
                found(&other).trim_end(),
                sample.found,
                "{end:?}: {}",
                sample.title
            );
        }
    }
}

#[test]
fn each_form_of_the_page_is_read() {
    let page = include_str!("../book/src/tables.md");
    let (_, forms) = page.split_once("## Each form\n").expect("forms");
    let mut count = 0;
    for part in forms.split("```\n") {
        let Some((words, table)) = part.split_once("```text\n") else {
            continue;
        };
        let ratio = if words.contains("--ratio 2") {
            " --ratio 2"
        } else {
            ""
        };
        let found = found(&Sample {
            title: words.to_owned(),
            options: format!("--order L2=2 --order H1=1{ratio}"),
            table: table.to_owned(),
            found: String::new(),
        });
        assert_eq!(found.matches(": pass").count(), 2, "{words}{table}{found}");
        count += 1;
    }
    assert!(count >= 9, "{count} forms");
}
