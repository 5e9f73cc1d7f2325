//! `rates`: a table of errors is judged.

use std::fs;

use serde_json::{Value, json};

use super::{run, run_words, workspace, write};

/// Errors of second and of first order, and a column without a claim that would fail.
const RATES: &str = "h L2 H1 max\n0.4 1.6000000e-1 4.0000000e-1 3\n0.2 4.0000000e-2 2.0000000e-1 3\n\
                     0.1 1.0000000e-2 1.0000000e-1 3\n0.05 2.5000000e-3 5.0000000e-2 3\n";

#[test]
fn rates_come_in_words_and_as_an_object() {
    let root = workspace(false);
    write(&root, "t", RATES);
    let claims = ["rates", "t", "--order", "L2=2", "--order", "H1=1"];
    let with = |more: &[&str]| run_words(&root, &[&claims, more].concat());
    let (status, out, err) = with(&[]).parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    assert!(
        out.contains("L2: pass: 2.000000 ± 0.0000005, claimed 2 ± 0.25: 2, not 1.5 or 2.5\n"),
        "{out}"
    );
    assert!(
        out.contains("max: inconclusive: 0.000000 ± 0.0000005: no order is claimed\n"),
        "{out}"
    );
    assert!(
        out.contains("powers rates t: --order P") && !out.contains("xtask"),
        "{out}"
    );
    assert!(
        out.ends_with("pass: 2 of 2 columns agree with their orders\n"),
        "{out}"
    );
    with(&["--all"]).says(1, "");
    assert_eq!(
        with(&["--quiet"]).stdout,
        "pass: 2 of 2 columns agree with their orders\n"
    );
    // A rate that disagrees is still shown.
    run(&root, "rates t --order H1=2 --quiet").begins(
        1,
        "H1: fail: 1.000000 ± 0.0000005, claimed 2 ± 0.25: too low\n",
    );
    let (_, out, _) = with(&["--format", "json"]).parts();
    let object: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (&object["schema"], &object["verdict"]),
        (&2.into(), &"pass".into())
    );
    assert_eq!(
        (
            &object["rates"][2]["decides"],
            &object["rates"][0]["levels"][3]["step"]
        ),
        (&false.into(), &0.05.into())
    );
    run(&root, "rates t --order L9=2")
        .complains(2, "expected a column of errors: L2, H1, max; found `L9`");
    run(&root, "rates t --columns L2,L3").complains(
        2,
        "t:1:1: expected --columns L3, the name or number of a column",
    );
}

#[test]
fn levels_set_aside_are_marked() {
    let root = workspace(false);
    // The rates 0.3, 2, 2, 2, and a level at the floor.
    let errors = [0.16, 0.13, 0.0325, 0.008125, 0.00203125, 1e-4];
    let row = |(k, error): (usize, &f64)| format!("{} {error}\n", 0.4 / f64::powi(2.0, k as i32));
    write(
        &root,
        "t",
        "h e\n".to_owned() + &errors.iter().enumerate().map(row).collect::<String>(),
    );
    let marks = |floor: &str| {
        let (_, out, _) =
            run_words(&root, &["rates", "t", "--order", "2", "--floor", floor]).parts();
        let rows: Vec<&str> = out.lines().skip(2).take(errors.len()).collect();
        let marked = |mark: char| {
            rows.iter()
                .map(|row| row.contains(mark))
                .collect::<Vec<bool>>()
        };
        (marked('~'), marked('_'), out.clone())
    };
    let (coarse, fine, out) = marks("2e-4");
    assert_eq!(coarse, [true, false, false, false, false, false], "{out}");
    assert_eq!(fine, [false, false, false, false, false, true], "{out}");
    assert!(
        out.contains("_ set aside: not above the floor 2e-4") && out.contains("e: pass"),
        "{out}"
    );
    let (_, fine, out) = marks("0");
    assert!(!fine.contains(&true) && !out.contains("e: pass"), "{out}");
    let (_, fine, out) = marks("0.01");
    assert_eq!(fine, [false, false, false, true, true, true], "{out}");
}

#[test]
fn rates_write_figure_markdown_and_junit() {
    let root = workspace(false);
    write(&root, "a&b|c", RATES);
    let (status, _, err) = run(
        &root,
        "rates a&b|c --order L2=2 --order H1=2 --out out/rates",
    )
    .parts();
    assert_eq!((status, err.as_str()), (Some(1), ""));
    let read = |name: &str| fs::read_to_string(root.path().join("out/rates").join(name)).unwrap();
    let (svg, junit, page) = (read("rates.svg"), read("junit.xml"), read("rates.md"));
    assert!(
        roxmltree::Document::parse(&svg)
            .unwrap()
            .descendants()
            .any(|node| node.has_tag_name("svg"))
    );
    assert!(svg.contains("L2, order 2, rate 2.000"), "{svg}");
    let document = roxmltree::Document::parse(&junit).unwrap();
    let cases: Vec<_> = document
        .descendants()
        .filter(|node| node.has_tag_name("testcase"))
        .collect();
    assert_eq!(cases.len(), 2);
    assert!(
        cases
            .iter()
            .all(|case| case.attribute("classname") == Some("a&b|c"))
    );
    let failure = document
        .descendants()
        .find(|node| node.has_tag_name("failure"))
        .unwrap();
    assert_eq!(
        failure.parent().unwrap().attribute("name"),
        Some("H1: order 2")
    );
    assert_eq!(document.root_element().attribute("failures"), Some("1"));
    assert!(
        page.starts_with("# Rates of a&b\\|c\n\n**fail**: 1 of 2 columns")
            && page.contains("](rates.svg)"),
        "{page}"
    );
    assert!(
        page.contains("    0.2  4.0000e-2   2.000000  2.0000e-1   1.000000"),
        "{page}"
    );
    write(&root, "file", "");
    run(&root, "rates a&b|c --order L2=2 --out file").says(2, "");
}

#[test]
fn a_refusal_is_an_object_for_programs() {
    let root = workspace(false);
    write(&root, "t", "n L2\n10 0.16\n20 0.04\n40 0.01\n");
    let (_, silent, words) = run(&root, "rates t --order 2").parts();
    let (status, out, err) = run(&root, "rates t --order 2 --format json").parts();
    assert_eq!((status, silent.as_str()), (Some(2), ""));
    assert_eq!(err, words);
    let object: Value = serde_json::from_str(&out).unwrap();
    let refused = &object["refused"];
    assert_eq!(
        err,
        format!("error: {}\n", refused["message"].as_str().unwrap())
    );
    assert_eq!(
        (&refused["file"], &refused["line"]),
        (&json!("t"), &json!(1))
    );
    let parts = json!([
        {"argument": "dim", "value": "D"},
        " for h = n^(-1/D), or ",
        {"argument": "step", "value": "COLUMN"},
    ]);
    assert_eq!(refused["expected"], parts);
    assert_eq!(refused["found"], "the count `n` and no step");
    let offers = refused["offers"].as_array().unwrap();
    let comments = ["along an edge", "all, in the plane", "all, in space"];
    assert_eq!(offers.len(), comments.len());
    for ((offer, comment), dim) in offers.iter().zip(comments).zip(1..) {
        assert_eq!(offer["comment"], comment);
        assert_eq!(offer["settings"], json!({"dim": f64::from(dim)}));
        let call = offer["call"].as_str().unwrap();
        assert!(
            call.ends_with(&format!(" rates t --order 2 --dim {dim}")),
            "{call}"
        );
    }
    // A claim has no table and no offer.
    let (status, out, err) = run(&root, "rates t --dim 1 --order L3=2 --format json").parts();
    let object: Value = serde_json::from_str(&out).unwrap();
    let words = "--order L3=2: expected a column of errors: L2; found `L3`, did you mean `L2`?";
    assert_eq!(
        (status, &object["refused"]),
        (Some(2), &json!({"message": words}))
    );
    assert_eq!(err, format!("error: {words}\n"));
}
