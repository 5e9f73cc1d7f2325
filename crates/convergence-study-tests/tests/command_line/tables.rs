//! What `rates` says about how it reads tables, and about claims that do not hold.

use tempfile::TempDir;

use convergence_study_tests::Ended;

use super::{run, workspace, write};

/// A table of one column of errors with seven digits, over halved steps.
fn table(name: &str, first: f64, errors: &[f64]) -> String {
    let row =
        |(k, error): (usize, &f64)| format!("{},{error:.6e}\n", first / f64::powi(2.0, k as i32));
    format!(
        "h,{name}\n{}",
        errors.iter().enumerate().map(row).collect::<String>()
    )
}

/// What `rates` says of a table, all of it with single blanks.
fn told(root: &TempDir, table: &str, options: &str) -> Ended {
    write(root, "TABLE", table);
    let mut ended = run(root, &format!("rates TABLE {options}"));
    let all = ended.stdout + &ended.stderr;
    ended.stdout = all.split_whitespace().collect::<Vec<_>>().join(" ");
    ended
}

#[test]
fn wrong_claims_are_answered_with_what_to_do() {
    let root = workspace();
    let first = [0.0412, 0.0203, 0.010075, 0.0050188, 0.0025047];
    let second = [0.00412, 0.001015, 0.00025188, 6.2734e-05, 1.5654e-05];
    let noise = [
        0.0056829, 0.0006216, 0.00033212, 4.5499e-05, 1.8908e-05, 3.3439e-06,
    ];
    let halved = |levels: i32, error: fn(f64) -> f64| -> Vec<f64> {
        let steps = (0..levels).map(|k| 0.1 / f64::powi(2.0, k));
        steps.map(error).collect()
    };
    for (errors, order, words) in [
        (
            &first[..],
            "2",
            "L2: fail: 1.0001 … too low … an order is lost",
        ),
        (&second, "1", "L2: fail: 2.0001 … too high"),
        (
            &[0.010824, 0.01079, 0.010749, 0.010725, 0.010712],
            "2",
            "fail … The errors tend to about 0.0106 … the scheme solves another problem … --values 'L2'",
        ),
        (
            &[4e-3, 1e-3, 2.5e-4, f64::NAN, 1.5625e-5],
            "2",
            "fail … NaN or infinite",
        ),
        // Without a floor no error is too small.
        (
            &halved(5, |h| 1e-30 * h * h),
            "1",
            "L2: fail: 2.0000 … too high",
        ),
        (&[4e-3, 1e-3], "2", "inconclusive … too few levels"),
        (
            &[1.5625e-5, 6.25e-5, 2.5e-4, 1e-3, 4e-3],
            "2",
            "fail … The errors grow at every refinement",
        ),
        (&noise, "2", "inconclusive"),
        (&halved(6, |h| 0.4 * h * h + 2e-4), "2", "L2: fail"),
        (&halved(6, |h| 0.5 * h * h + 0.01 * h), "2", "L2: fail"),
        (
            &[0.01, 0.0025, 0.000625, 0.00015625, 3.9e-5, 4.3e-5],
            "2",
            "fall with rate 2.00 down to 3.900e-5, then stop",
        ),
        (
            &[0.01, 0.0025, 0.000625, 0.0],
            "2",
            "zero on the finest level only. Is that level its own reference?",
        ),
        (
            &[0.01, 0.0025, 6.25e-7, 1.5625e-7],
            "2",
            "inconclusive … a rate does not belong to its neighbours",
        ),
        // Rates that approach the order slowly.
        (
            &halved(4, |h| h * h * (1.0 + 2.0 * h)),
            "2",
            "inconclusive … they scatter, or approach it slowly",
        ),
        // A least order.
        (&second, ">=3", "claimed at least 3 ± 0.05: too low"),
    ] {
        let table = table("L2", 0.1, errors);
        told(&root, &table, &format!("--order {order} --tolerance 0.05")).says(1, words);
    }
    let tiny = [4.03e-12, 1.0366e-12, 2.8991e-13, 1.0087e-13, 4.8334e-14];
    told(&root, &table("L2", 0.1, &tiny), "--order 2 --floor 1e-10")
        .says(1, "_ set aside … round-off floor");
    // A least order, for all columns and for one; other notations are refused.
    for (order, status, words) in [
        (">=1", 0, "claimed at least 1 ± 0.05: at least 0.95"),
        ("L2=>=1.5", 0, "L2: pass"),
        (
            "L2=>1",
            2,
            "expected a number > 0, '>=P' with such a number P, or NAME= before one of them",
        ),
    ] {
        let table = table("L2", 0.1, &second);
        told(&root, &table, &format!("--order {order} --tolerance 0.05")).says(status, words);
    }
    // An error that grows next to one that falls, or in the only column.
    let both = "h,L2_u,p\n0.4,1.60e-1,1.00e-1\n0.2,4.00e-2,2.00e-1\n0.1,1.00e-2,4.00e-1\n";
    let ran = told(&root, both, "--order 2");
    ran.says(1, "p: fail: -1.0");
    ran.says(1, "L2_u: pass");
}

#[test]
fn values_and_rounded_numbers_are_told_from_errors() {
    let root = workspace();
    let drag = "h, drag\n0.1, 5.577\n0.05, 5.5718\n0.025, 5.5704\n";
    told(&root, drag, "--order 2").says(1, "If `drag` is a value and no error: --values 'drag'.");
    let rows = |first: f64, row: fn(f64) -> String| -> String {
        let steps = (0..6).map(|k| first / f64::powi(2.0, k));
        steps.map(|h| format!("{h} {}\n", row(h))).collect()
    };
    let values = rows(0.1, |h| {
        format!("{:.9}", 5.5699 + 0.45 * h * h + 0.1 * h.powi(3))
    });
    let ran = told(
        &root,
        &format!("h drag\n{values}"),
        "--order 2 --values drag",
    );
    ran.says(0, "limit 5.569");
    ran.says(0, "GCI ± ");
    // Six decimals of errors of second order.
    let decimals = rows(0.25, |h| format!("{:.6}", 0.11 * h * h));
    let ran = told(&root, &format!("h L2\n{decimals}"), "--order 2");
    ran.says(1, "inconclusive");
    ran.says(1, "1 digit: print more");
    // The same rounded to three digits passes, with a wider interval.
    let digits = rows(0.25, |h| format!("{:.2e}", 0.11 * h * h));
    told(&root, &format!("h L2\n{digits}"), "--order 2").says_not(0, "± 0.0000005");
    // Digits that decide, and digits that do not.
    for (rows, status, words) in [
        ("0.4 0.16\n0.2 0.04\n0.1 0.01\n", 1, "1 digit: print more"),
        (
            "0.4 12.5\n0.2 3.1\n0.1 0.78\n0.05 0.2\n",
            1,
            "2 digits: print more",
        ),
        ("0.4 16.0e-2\n0.2 4.00e-2\n0.1 1.00e-2\n", 0, "pass"),
        (
            "0.1 0.0406\n0.05 0.0103\n0.025 0.00265\n0.0125 0.0007\n",
            1,
            "inconclusive",
        ),
        (
            "0.05 0.0103\n0.025 0.00265\n0.0125 0.0007\n",
            1,
            "inconclusive",
        ),
        (
            "0.1 0.0406\n0.05 0.0103\n0.025 0.00265\n",
            1,
            "inconclusive",
        ),
    ] {
        told(&root, &format!("h L2\n{rows}"), "--order 2").says(status, words);
    }
}

#[test]
fn a_column_has_one_interval_whatever_is_claimed() {
    let root = workspace();
    let rounded = "h e\n0.1 0.0102\n0.05 0.00508\n0.025 0.00253\n0.0125 0.00126\n";
    for order in [
        "--order 1",
        "--order 0.5",
        "--order 1.3",
        "--order >=0.8",
        "",
    ] {
        let text = told(&root, rounded, order).stdout;
        assert!(text.contains("1.006 (0.997 to 1.015)"), "{order:?}: {text}");
    }
    // The digits of the steps count with the finest rate: 0.1, 0.033, 0.011 are no regular ratios.
    let steps = "h e\n0.1 1.0000e-1\n0.033 1.0890e-2\n0.011 1.2100e-3\n0.0037 1.3690e-4\n";
    let interval = |order: &str| {
        let text = told(&root, steps, &format!("--order {order}")).stdout;
        text.split_once("e: ")
            .and_then(|(_, rest)| rest.split_once(", claimed"))
            .map(|(rate, _)| rate.split_once(": ").expect("a verdict").1.to_owned())
    };
    assert!(
        interval("2").is_some_and(|two| Some(two) == interval("1")),
        "{:?} {:?}",
        interval("2"),
        interval("1")
    );
}

#[test]
fn words_name_what_is_there() {
    let root = workspace();
    let slow = "h,e\n0.2,0.800000\n0.1,0.459479\n0.05,0.263902\n0.025,0.151572\n";
    told(&root, slow, "--order >=1").says(0, "claimed at least 1 ± 0.25: at least 0.75");
    // Errors that are halved have the rate 1 and the factor 2.
    let order = "h,err,order\n0.1,0.1,\n0.05,0.05,2.00\n0.025,0.025,2.00\n0.0125,0.0125,2.00\n";
    let text = told(&root, order, "--order 1").stdout;
    assert!(
        text.contains("left out: `order` (the factors of `err`)"),
        "{text}"
    );
    // The last differences would end above zero, but the rate says that the error goes on falling.
    let odd_even: Vec<f64> = (0..6)
        .map(|k| 0.01 / f64::powi(4.0, k) * if k % 2 == 0 { 0.7 } else { 1.3 })
        .collect();
    let text = told(&root, &table("e", 0.1, &odd_even), "--order 2").stdout;
    assert!(
        text.contains("inconclusive") && !text.contains("to zero"),
        "{text}"
    );
    // Causes with names.
    let turns = "h,e\n0.1,0.0142\n0.05,5.25e-4\n0.025,2.4688e-4\n0.0125,1.0898e-4\n";
    let text = told(&root, turns, "--order 2").stdout;
    assert!(
        text.contains("The error may change its sign between levels"),
        "{text}"
    );
    let logarithm: Vec<f64> = (3..10)
        .map(|k| f64::powi(4.0, -k) * f64::from(k) * std::f64::consts::LN_2)
        .collect();
    let text = told(
        &root,
        &table("e", 0.125, &logarithm),
        "--order 2 --tolerance 0.05",
    )
    .stdout;
    assert!(
        text.contains("inconclusive") && text.contains("A logarithm may be at work"),
        "{text}"
    );
}

#[test]
fn no_error_is_too_small_or_too_large() {
    let root = workspace();
    for unit in [1e-200, 1e-9, 1.0, 1e40, 1e200] {
        let errors: Vec<f64> = [4.1e-3, 1.02e-3, 2.55e-4, 6.37e-5]
            .map(|error| unit * error)
            .into();
        for (order, words) in [("2", "pass: 2.000"), ("1", "fail: 2.000")] {
            let text = told(
                &root,
                &table("e", 0.1, &errors),
                &format!("--order {order}"),
            )
            .stdout;
            assert!(text.contains(words), "{unit}: {text}");
        }
    }
}

#[test]
fn a_table_in_utf_16_is_refused_with_what_to_do() {
    let root = workspace();
    let words = "\u{feff}h,L2\n".encode_utf16();
    write(
        &root,
        "t",
        words.flat_map(u16::to_le_bytes).collect::<Vec<u8>>(),
    );
    run(&root, "rates t").refuses("found UTF-16; expected UTF-8 text: save the file as UTF-8");
}
