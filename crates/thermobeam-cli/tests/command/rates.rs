use super::{Ended, Folder, ended, thermobeam};

fn judge(folder: &Folder, table: &str, arguments: &[&str]) -> Ended {
    ended(
        thermobeam()
            .arg("rates")
            .arg(folder.file("table.csv", table))
            .args(arguments),
    )
}

/// A table of two columns from h and a rule for the error.
fn table(levels: usize, error: impl Fn(f64) -> f64) -> String {
    let row = |k| {
        let h = 0.5_f64.powi(k);
        format!("{h},{}\n", error(h))
    };
    (0..levels as i32)
        .map(row)
        .fold("h,e\n".to_owned(), |text, row| text + &row)
}

#[test]
fn a_sound_table_passes_in_either_order_with_any_separator() {
    let folder = Folder::new();
    let text = "# two norms\nh,L2,H1\n0.1,1e-2,1e-1\n0.05,2.5e-3,5e-2\n0.025,6.25e-4,2.5e-2\n0.0125,1.5625e-4,1.25e-2\n";
    let mut rows: Vec<&str> = text.lines().collect();
    rows[2..].reverse();
    for text in [
        text.to_owned(),
        rows.join("\r\n"),
        text.replace(',', ";"),
        text.replace(',', "\t"),
    ] {
        let ended = judge(&folder, &text, &["--order", "2", "--order", "H1=1"]);
        assert_eq!(
            (ended.status, ended.stderr.as_str()),
            (Some(0), ""),
            "{}",
            ended.stdout
        );
        assert!(
            ended.stdout.contains("L2: pass") && ended.stdout.contains("H1: pass"),
            "{}",
            ended.stdout
        );
    }
    let json = judge(&folder, text, &["--order", "L2=2", "--format", "json"]);
    let value: serde_json::Value = serde_json::from_str(&json.stdout).expect("JSON");
    assert_eq!(
        (&value["rates"][0]["verdict"], &value["rates"][1]["verdict"]),
        (&"pass".into(), &"inconclusive".into())
    );
    // With --all a column without a claim decides the verdict.
    assert_eq!(
        (json.status, &value["verdict"], &value["schema"]),
        (Some(0), &"pass".into(), &2.into())
    );
    assert_eq!(
        judge(&folder, text, &["--order", "L2=2", "--all"]).status,
        Some(1)
    );
}

#[test]
fn a_table_that_fools_never_passes() {
    let folder = Folder::new();
    let nan = table(6, |h| if h < 0.1 { f64::NAN } else { h * h });
    let infinite = table(6, |h| if h > 0.9 { f64::INFINITY } else { h * h });
    let sign_lost = table(6, |h| if h < 0.2 { -h * h } else { h * h });
    let zero = table(6, |h| if h < 0.05 { 0.0 } else { h * h });
    let two = table(2, |h| h * h);
    let one = table(1, |h| h * h);
    let none = "h,e\n".to_owned();
    let stagnating = table(8, |h| h * h + 1e-3);
    let growing = table(6, |h| 1.0 / h);
    let wrong = table(6, |h| h);
    let better = table(6, |h| h * h * h);
    let round_off = table(6, |h| 1e-16 * (1.0 + 0.9 * (7.0 / h).sin()));
    let twice = "h,e\n0.5,1\n0.25,0.25\n0.25,0.25\n0.125,0.0625\n".to_owned();
    for text in [
        nan, infinite, sign_lost, zero, two, one, stagnating, growing, wrong, better, round_off,
    ] {
        let ended = judge(&folder, &text, &["--order", "2"]);
        assert_eq!(
            (ended.status, ended.stderr.as_str()),
            (Some(1), ""),
            "{text}{}",
            ended.stdout
        );
        assert!(!ended.stdout.contains(": pass"), "{text}{}", ended.stdout);
    }
    // A table without levels, or with two contradictory levels, is refused.
    for text in [none, twice] {
        let ended = judge(&folder, &text, &["--order", "2"]);
        assert_eq!(
            (ended.status, ended.stdout.as_str()),
            (Some(2), ""),
            "{text}"
        );
    }
    let shuffled = "h,e\n0.5,1\n0.125,0.0625\n0.25,0.25\n0.0625,0.015625\n".to_owned();
    for text in [table(6, |h| h * h), shuffled] {
        assert_eq!(
            judge(&folder, &text, &["--order", "2"]).status,
            Some(0),
            "{text}"
        );
    }
}

#[test]
fn without_a_claim_nothing_passes() {
    let folder = Folder::new();
    let ended = judge(&folder, &table(5, |h| h * h), &[]);
    assert_eq!(ended.status, Some(1));
    for words in [
        "e: inconclusive: 2.000000 (1.999998 to 2.000002): no order is claimed\n",
        "--order NAME=P",
    ] {
        assert!(ended.stdout.contains(words), "{}", ended.stdout);
    }
}

#[test]
fn a_malformed_table_is_named_with_its_place() {
    let folder = Folder::new();
    for (text, pieces) in [
        (
            "",
            &["table.csv: expected a row of names", "found an empty table"][..],
        ),
        (
            "0.1,1\n0.05,2\n",
            &["table.csv:1:1:", "`column 1`", "a column of steps"],
        ),
        ("h\n0.1\n", &["table.csv:1:1:", "one column"]),
        ("h,e,e\n0.1,1,1\n", &["table.csv:1:5:", "a second time"]),
        (
            "h,e\n\n# note\n0.1, x\n",
            &["table.csv:4:6: e:", "`x`", "a number"],
        ),
        (
            "h,e\n0.1,1\n0.05\n",
            &[
                "table.csv:3:1:",
                "expected 2 cells, one for each name",
                "found 1 cell",
            ],
        ),
        ("h,e\n0.1,1\n-0.05,1\n", &["table.csv:3:1: h:", "a step"]),
        ("h,e\n0.1,\n", &["table.csv:2:5: e:", "``"]),
    ] {
        let ended = judge(&folder, text, &["--order", "1"]);
        assert_eq!(
            (ended.status, ended.stdout.as_str()),
            (Some(2), ""),
            "{text}"
        );
        for piece in pieces {
            assert!(ended.stderr.contains(piece), "{piece}: {}", ended.stderr);
        }
    }
    let good = table(4, |h| h);
    for arguments in [
        &["--order", "0"][..],
        &["--order", "x=1"],
        &["--tolerance", "0.5"],
        &["--tolerance", "nan"],
        &["--floor", "inf"],
    ] {
        assert_eq!(
            judge(&folder, &good, arguments).status,
            Some(2),
            "{arguments:?}"
        );
    }
    assert_eq!(
        ended(thermobeam().arg("rates").arg(folder.path("missing.csv"))).status,
        Some(2)
    );
}
