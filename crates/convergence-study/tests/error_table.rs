//! Tables of steps and errors.

use convergence_study::{Choice, Claim, Floor, InputError, RateTable, Verdict};

fn parsed(text: &str) -> Result<RateTable, InputError> {
    RateTable::parse_with(text, "t.csv", &Choice::default())
}

/// The message about a table.
#[track_caller]
fn refused(text: &str) -> String {
    parsed(text).unwrap_err().to_string()
}

#[test]
fn a_table_is_read_coarse_to_fine_whatever_its_order_and_separator() {
    let coarse_first = "# comment\nh, L2, H1\n\n0.2, 4, 2\n0.1, 1, 1\n";
    let fine_first = "\u{feff}h\tL2\t\"H1\"\n0.1\t1\t1\n0.2\t4\t2\n";
    let table = parsed(coarse_first).unwrap();
    assert_eq!(parsed(fine_first).unwrap(), table);
    let levels = |column: usize| {
        table.columns[column]
            .levels
            .iter()
            .map(|level| (level.step, level.error))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        (table.step.as_str(), table.columns[1].name.as_str()),
        ("h", "H1")
    );
    assert_eq!(
        (levels(0), levels(1)),
        (vec![(0.2, 4.0), (0.1, 1.0)], vec![(0.2, 2.0), (0.1, 1.0)])
    );
}

#[test]
fn a_table_that_cannot_be_used_is_refused_with_its_place() {
    for (text, words) in [
        (
            "",
            "t.csv: expected a row of names, such as `h L2 H1`, then rows of numbers, such as `0.1 1.6e-3 4e-2`, found an empty table",
        ),
        (
            "h\n0.1\n",
            "t.csv:1:1: expected a column of steps and at least one of errors, found one column",
        ),
        (
            "h,a,b,a\n0.1,1,2,3\n",
            "t.csv:1:7: expected each name once, found `a` a second time",
        ),
        (
            "h,a\x07\n0.1,1\n",
            "t.csv:1:3: expected a name without control characters, found `a",
        ),
        ("h,a\n0.1,x\n", "t.csv:2:5: a: expected a number, found `x`"),
        (
            "h,a\n0.1,1,2\n",
            "t.csv:2:1: expected 2 cells, one for each name, found 3 cells",
        ),
        (
            "h,a\n-1,1\n",
            "t.csv:2:1: h: expected a step, a finite number > 0, found `-1`",
        ),
        (
            "h a b\n0.1 1 2\n0.05 1\n",
            "t.csv:3:1: expected 3 cells, one for each name, found 2 cells",
        ),
        (
            "h a\n0.1 1\n0.05 2 3\n",
            "t.csv:3:1: expected 2 cells, one for each name, found 3 cells",
        ),
        (
            "h    a b\n0.1  1 2\n0.05 1\n",
            "t.csv:3:7: b: expected a number, found ``",
        ),
    ] {
        let message = refused(text);
        assert!(message.starts_with(words), "{message}");
    }
}

/// Processor time of this thread.
#[cfg(unix)]
fn processor_time() -> std::time::Duration {
    nix::time::clock_gettime(nix::time::ClockId::CLOCK_THREAD_CPUTIME_ID)
        .expect("a clock")
        .into()
}

/// The least of several times to read a text, because other processes disturb some.
#[cfg(unix)]
fn time_of(text: &str) -> std::time::Duration {
    let timed = |_| {
        let start = processor_time();
        // A refusal takes as long, and repeats the reading for the choices that it offers.
        let _ = parsed(text);
        processor_time() - start
    };
    (0..4).map(timed).min().expect("four times")
}

/// A text of a given size.
#[cfg(unix)]
type Text = fn(usize) -> String;

/// Texts in which one of lines, names and columns grows, and the step with it where there is one.
#[cfg(unix)]
const GROWING: [(&str, Text); 9] = [
    ("columns", |n| {
        let row =
            |cell: fn(usize) -> String| (0..n).map(|k| format!(",{}", cell(k))).collect::<String>();
        format!(
            "h{}\n0.1{}\n",
            row(|k| format!("column-{k}")),
            row(|_| "0.5".to_owned())
        )
    }),
    ("columns of four rows", |n| {
        let row = |factor: f64| {
            (0..n)
                .map(|k| format!(" {}", factor * (1.0 + k as f64)))
                .collect::<String>()
        };
        let rows: String = [0.4, 0.2, 0.1, 0.05]
            .iter()
            .map(|h| format!("{h}{}\n", row(h * h)))
            .collect();
        format!(
            "h{}\n{rows}",
            (0..n).map(|k| format!(" spam{k}")).collect::<String>()
        )
    }),
    ("rows", |n| {
        (1..=n)
            .map(|k| format!("{},{}\n", 1.0 / k as f64, 1.0 / (k * k) as f64))
            .collect()
    }),
    ("a name on each line", |n| {
        (0..n).map(|k| format!("a{k} {k}\n")).collect()
    }),
    ("a marked name on each line", |n| {
        (0..n).map(|k| format!("a{k} = {k}\n")).collect()
    }),
    ("names on one line", |n| {
        (0..n).map(|k| format!("a{k} = {k}, ")).collect()
    }),
    ("lines of a log", |n| {
        (1..=n)
            .map(|k| format!("h = {}, L2 = {}\n", 1.0 / k as f64, 0.1 / k as f64))
            .collect()
    }),
    ("words after names", |n| {
        "x: 1\ny: 2\n".to_owned() + &"k: foo\n".repeat(n)
    }),
    ("rows that lack a cell", |n| {
        let cells = "1.5 ".repeat(n);
        format!("{cells}2.5\n{cells}\n{cells}\n") + &"0.5 3\n".repeat(n)
    }),
];

#[cfg(unix)]
#[test]
fn a_text_is_read_in_time_proportional_to_its_lines_names_and_columns() {
    // Eight times as much; comparing each with all others takes 64 times as long.
    let times = GROWING.map(|(what, text)| (what, [500, 4_000].map(|size| time_of(&text(size)))));
    let slow: Vec<_> = times
        .into_iter()
        .filter(|(_, [few, many])| *many >= 24 * *few)
        .collect();
    assert!(slow.is_empty(), "{slow:?}");
}

#[test]
fn a_text_beyond_the_limits_is_refused() {
    let tables = |count: usize| "# more\nh L2\n0.2 0.04\n0.1 0.01\n".repeat(count);
    for (text, words) in [
        (
            "0.1 1\n".repeat(10_001),
            "at most 10000 rows, found 10001 rows",
        ),
        (
            format!("h{}\n0.1{}\n", ",a".repeat(5_000), ",1".repeat(5_000)),
            "at most 5000 columns, found 5001",
        ),
        (tables(1_001), "at most 1000 tables, found 1001"),
        (
            format!("h,{}\n0.1,1\n", "x".repeat(65_536)),
            "a name of at most 200 characters, found 65536",
        ),
        (
            "h,L2\u{202e}\n0.1,1\n".to_owned(),
            "a name without control characters",
        ),
    ] {
        let message = refused(&text);
        assert!(message.contains(words), "{message}");
        assert!(message.len() < 500, "{} bytes", message.len());
    }
}

/// The error in a table of one row.
fn read(cell: &str) -> Option<f64> {
    let table = parsed(&format!("h;e\n1;{cell}\n")).ok()?;
    Some(table.columns[0].levels[0].error)
}

#[test]
fn a_number_is_read_as_it_is_written() {
    for (cell, value) in [
        ("1/8", 0.125),
        ("1.0D-01", 0.1),
        ("2.5d0", 2.5),
        ("0.125-101", 0.125e-101),
        ("2^-3", 0.125),
        ("2**-3", 0.125),
        ("1/2^{3}", 0.125),
        ("$1.2 \\times 10^{-3}$", 1.2e-3),
        ("1.2·10^(-3)", 1.2e-3),
        ("\\num{1e-3}", 1e-3),
        ("**0.5**", 0.5),
        ("$\\frac{1}{16}$", 0.0625),
        ("\u{2212}0.5", -0.5),
        ("10^{-2}", 0.01),
        ("0,125", 0.125),
        ("1,5e-3", 1.5e-3),
    ] {
        assert_eq!(read(cell), Some(value), "{cell}");
    }
    for cell in [
        "", "x", "2*0.1", "1,024", "1/2/4", "é-101", "1.5-10", "D-01", "infD2", "1e-3 4", "1,2,3",
    ] {
        assert_eq!(read(cell), None, "{cell}");
    }
    for cell in [
        "-",
        "****",
        "-nan(ind)",
        "1.#QNAN",
        "NaNQ",
        "diverged",
        "None",
        "null",
    ] {
        assert!(read(cell).is_some_and(f64::is_nan), "{cell}");
    }
}

#[test]
fn the_order_of_the_rows_does_not_matter() {
    let rows = [
        "0.1,1.01e-1",
        "0.05,5.02e-2",
        "0.025,2.505e-2",
        "0.0125,1.2512e-2",
    ];
    let judged = |rows: Vec<&str>| {
        let table = parsed(&format!("h,e\n{}\n", rows.join("\n"))).expect("a table");
        table.columns[0].judge(&Claim::new(1.0, 0.05), Floor::NONE)
    };
    let (down, up) = (
        judged(rows.to_vec()),
        judged(rows.iter().rev().copied().collect()),
    );
    assert_eq!(down, up);
    assert_eq!(down.verdict, Verdict::Pass);
}
