//! How large a text may be, and how long it is read.

use super::{Choice, chosen, request};
use convergence_study::rates::RateTable;

fn refused(text: &str) -> String {
    let refusal = chosen(text, &["2"], Choice::default()).expect_err("beyond a limit");
    refusal.words(&request(&["2"], Choice::default()).command_line("rates", "FILE"))
}

/// A table of this many rows and columns.
fn table(rows: usize, columns: usize) -> String {
    let names: String = (1..columns).map(|k| format!(",e{k}")).collect();
    let row = |k: usize| {
        let h = 1.0 / (k + 1) as f64;
        let cells: String = (1..columns)
            .map(|k| format!(",{:.6e}", k as f64 * h * h))
            .collect();
        format!("{h:.9}{cells}\n")
    };
    format!("h{names}\n{}", (0..rows).map(row).collect::<String>())
}

#[test]
fn a_text_beyond_the_limits_is_refused() {
    let tables = "h L2\n0.2 0.04\n0.1 0.01\n\n".repeat(1_001);
    let mut long = table(3, 2);
    long = long.replace("e1", &"x".repeat(201));
    for (text, words) in [
        (table(10_001, 2), "at most 10000 rows"),
        (table(2, 1_001), "at most 1000 columns"),
        (tables, "at most 1000 tables"),
        ("# a heading\n".repeat(100_001), "at most 100000 lines"),
        (long, "a name of at most 200 characters"),
        (
            "h,L2\u{202e}\n0.2,4.0\n0.1,1.0\n".to_owned(),
            "a name without control characters",
        ),
    ] {
        let message = refused(&text);
        assert!(message.contains(words), "{message}");
        assert!(message.len() < 700, "{} bytes", message.len());
    }
    for largest in [table(10_000, 2), table(3, 1_000)] {
        assert!(chosen(&largest, &["2"], Choice::default()).is_ok());
    }
}

/// Processor time of this thread.
#[cfg(unix)]
fn processor_time() -> std::time::Duration {
    nix::time::clock_gettime(nix::time::ClockId::CLOCK_THREAD_CPUTIME_ID)
        .expect("a clock")
        .into()
}

/// A text of a given size.
type Text = fn(usize) -> String;

/// Texts in which one of lines, names and columns grows.
#[cfg(unix)]
const GROWING: [(&str, Text); 10] = [
    ("columns", |n| table(5, n / 8)),
    ("rows", |n| table(n, 3)),
    ("headings", |n| "# a heading of 3 words\n".repeat(n)),
    ("a name on each line", |n| {
        (0..n).map(|k| format!("a{k} = {k}\n")).collect()
    }),
    ("names on one line", |n| {
        (0..n).map(|k| format!("a{k} = {k}, ")).collect()
    }),
    ("lines of a log", |n| {
        let line = |k| format!("h = {:.9}, L2 = {:.9}\n", 1.0 / k as f64, 0.1 / k as f64);
        (1..=n).map(line).collect()
    }),
    ("cells of HTML", |n| {
        format!("<table><tr>{}</tr></table>", "<td>1</td>".repeat(n))
    }),
    ("marks in a cell", |n| {
        format!("h L2\n0.2 {}\n0.1 0.01\n", "a.".repeat(n))
    }),
    ("frames", |n| "----\n".repeat(n)),
    ("tables of HTML", |n| "<table>".repeat(n)),
];

#[cfg(unix)]
#[test]
fn a_text_is_read_in_time_proportional_to_its_lines_names_and_columns() {
    let time = |text: &str| {
        let start = processor_time();
        let _ = RateTable::parse_all_with(text, "t", &Choice::default());
        processor_time() - start
    };
    for (what, text) in GROWING {
        let [few, many] = [1_000, 8_000].map(text);
        let of_few = (0..3).map(|_| time(&few)).min().expect("three times");
        // Eight times as much; comparing each with all others takes 64 times as long. Only what is
        // slow by chance is fast at another time.
        let is_slow = (0..3).all(|_| time(&many) >= 24 * of_few);
        assert!(!is_slow, "{what}");
    }
}
