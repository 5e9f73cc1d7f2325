//! `TABLES.md`: every table on that page is read, or refused, as the page says.

use convergence_study::input::error_table::{Choice, RateTable};

const PAGE: &str = include_str!("../TABLES.md");

/// One section of the page.
struct Sample {
    title: &'static str,
    options: &'static str,
    table: String,
    /// Whether `expected` is a message.
    is_refused: bool,
    expected: &'static str,
}

/// A fenced block: the words behind the fence, the text, and what follows.
fn block(text: &'static str) -> Option<(&'static str, &'static str, &'static str)> {
    let (head, rest) = text.split_once("```")?.1.split_once('\n')?;
    let (body, rest) = rest.split_once("\n```\n")?;
    Some((head, body, rest))
}

fn samples() -> Vec<Sample> {
    let sample = |section: &'static str| {
        let title = section.lines().next().expect("a title").trim();
        let (head, table, rest) = block(section).unwrap_or_else(|| panic!("{title}: no table"));
        let options = head.strip_prefix("table").unwrap_or_else(|| panic!("{title}: {head}")).trim();
        let (kind, expected, _) = block(rest).unwrap_or_else(|| panic!("{title}: no result"));
        assert!(matches!(kind, "result" | "refused"), "{title}: {kind}");
        Sample { title, options, table: table.replace('→', "\t"), is_refused: kind == "refused", expected }
    };
    PAGE.split("\n### ").skip(1).map(sample).collect()
}

fn choice(options: &str) -> Choice {
    let mut choice = Choice::default();
    let words: Vec<&str> = options.split_whitespace().collect();
    for option in words.chunks(2) {
        match option {
            ["--dim", dim] => choice.dim = Some(dim.parse().expect("a dimension")),
            ["--step", step] => choice.step = Some((*step).to_owned()),
            ["--columns", list] => choice.columns = Some(list.split(',').map(str::to_owned).collect()),
            _ => panic!("{options}"),
        }
    }
    choice
}

/// A table as the page writes it: a line for the step and one for each error.
fn lines(table: &RateTable) -> Vec<(String, Vec<f64>)> {
    let steps = table.columns[0].1.iter().map(|level| level.step).collect();
    let errors = table.columns.iter().map(|(name, levels)| {
        assert!(levels.iter().zip(&table.columns[0].1).all(|(level, first)| level.step == first.step));
        (name.clone(), levels.iter().map(|level| level.error).collect())
    });
    std::iter::once((table.step.clone(), steps)).chain(errors).collect()
}

/// Equal up to the rounding of a power, both NaN, or both infinite.
fn is_same(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan()) || (a - b).abs() <= 4.0 * f64::EPSILON * b.abs()
}

#[test]
fn every_table_of_the_page_is_read_or_refused_as_it_says() {
    let mut wrong = vec![];
    for sample in samples() {
        let found = RateTable::parse_with(&sample.table, "TABLE", &choice(sample.options));
        match (found, sample.is_refused) {
            (Err(error), true) if error.to_string() == sample.expected => {}
            (Ok(table), false) => {
                let expected: Vec<(String, Vec<f64>)> = sample.expected.lines().map(expected).collect();
                let found = lines(&table);
                let same = expected.len() == found.len()
                    && expected.iter().zip(&found).all(|((name, values), (found_name, found))| {
                        name == found_name
                            && values.len() == found.len()
                            && values.iter().zip(found).all(|(a, b)| is_same(*a, *b))
                    });
                if !same {
                    wrong.push(format!("{}: {found:?}", sample.title));
                }
            }
            (Ok(table), true) => wrong.push(format!("{}: not refused: {:?}", sample.title, lines(&table))),
            (Err(error), _) => wrong.push(format!("{}: {error}", sample.title)),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn expected(line: &str) -> (String, Vec<f64>) {
    let (name, values) = line.rsplit_once(": ").unwrap_or_else(|| panic!("{line}"));
    (name.to_owned(), values.split(' ').map(|value| value.parse().expect("a number")).collect())
}

#[test]
fn the_matrix_lists_every_table_with_its_options_and_result() {
    let (matrix, _) = PAGE.split_once("\n## Tables\n").expect("tables");
    let rows = |part: &str| part.lines().filter(|line| line.starts_with("| ")).count() - 2;
    let (read, refused) = matrix.split_once("\n## Refused\n").expect("refusals");
    let samples = samples();
    let refusals = samples.iter().filter(|sample| sample.is_refused).count();
    assert_eq!((rows(read), rows(refused)), (samples.len() - refusals, refusals));
    assert!(samples.len() - refusals >= 25, "{} tables", samples.len() - refusals);
    for Sample { title, options, is_refused, .. } in samples {
        let row = format!("\n| {title} | ");
        let part = if is_refused { refused } else { read };
        let line = part.split_once(&row).unwrap_or_else(|| panic!("{title} is not in the matrix")).1;
        let line = line.lines().next().unwrap_or_default();
        assert!(options.is_empty() || line.contains(&format!("`{options}`")), "{title}: {line}");
        assert!(line.ends_with(if is_refused { "| exit status 2 |" } else { "| read |" }), "{title}: {line}");
    }
}

#[test]
fn tables_read_the_same_with_other_line_ends_and_a_byte_order_mark() {
    for sample in samples().iter().filter(|sample| !sample.is_refused) {
        let parse =
            |text: &str| RateTable::parse_with(text, "TABLE", &choice(sample.options)).map(|table| lines(&table));
        for end in ["\r\n", "\r"] {
            let other = parse(&format!("\u{feff}{}{end}", sample.table.replace('\n', end)));
            assert_eq!(format!("{other:?}"), format!("{:?}", parse(&sample.table)), "{end:?}: {}", sample.title);
        }
    }
}
