//! Tables of steps and errors.

use std::time::{Duration, Instant};

use convergence_study::input::error_table::RateTable;

/// The message about a table.
#[track_caller]
fn refused(text: &str) -> String {
    RateTable::parse(text, "t.csv").unwrap_err().to_string()
}

#[test]
fn a_table_is_read_coarse_to_fine_whatever_its_order_and_separator() {
    let coarse_first = "# comment\nh, L2, H1\n\n0.2, 4, 2\n0.1, 1, 1\n";
    let fine_first = "\u{feff}h\tL2\t\"H1\"\n0.1\t1\t1\n0.2\t4\t2\n";
    let table = RateTable::parse(coarse_first, "t.csv").unwrap();
    assert_eq!(RateTable::parse(fine_first, "t.csv").unwrap(), table);
    let levels =
        |column: usize| table.columns[column].1.iter().map(|level| (level.step, level.error)).collect::<Vec<_>>();
    assert_eq!((table.step.as_str(), table.columns[1].0.as_str()), ("h", "H1"));
    assert_eq!((levels(0), levels(1)), (vec![(0.2, 4.0), (0.1, 1.0)], vec![(0.2, 2.0), (0.1, 1.0)]));
}

#[test]
fn a_table_that_cannot_be_used_is_refused_with_its_place() {
    for (text, words) in [
        ("", "t.csv: found an empty table"),
        ("h\n0.1\n", "t.csv:1:1: found one column"),
        ("h,a,b,a\n", "t.csv:1:7: found `a` a second time"),
        ("h,1\n", "t.csv:1:3: found `1`; allowed is a name"),
        ("h,a\x1b[31m\n", "t.csv:1:3: found `a [31m`; allowed is a name without control characters"),
        ("h,a\n0.1,x\n", "t.csv:2:5: a: found `x`; allowed is a number"),
        ("h,a\n0.1,1,2\n", "t.csv:2:1: found 3 cells; allowed is 2"),
        ("h,a\n-1,1\n", "t.csv:2:1: h: found `-1`; allowed is a step"),
    ] {
        let message = refused(text);
        assert!(message.starts_with(words), "{message}");
    }
}

#[test]
fn a_hundred_thousand_columns_are_read_in_time_proportional_to_their_number() {
    let row = |cell: &dyn Fn(usize) -> String| (0..100_000).map(|i| format!(",{}", cell(i))).collect::<String>();
    let text = format!("h{}\n0.1{}\n", row(&|i| format!("column-{i}")), row(&|_| "0.5".to_owned()));
    let start = Instant::now();
    let table = RateTable::parse(&text, "t.csv").unwrap();
    assert_eq!(table.columns.len(), 100_000);
    // A fraction of a second without optimisation; comparing each name with all others takes minutes.
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}
