//! Each row of what is set aside: what it sets aside, and what it must not.

use super::forms::{Form, Law, Table};
use super::{LAW, Page, answer, never_passes, passes};
use crate::rows::rows;
use convergence_study::rates::{Choice, FrameCell, FrameColumn, RateTable};

/// A table of order 2 in four levels with another column.
fn with(name: &str, column: &str) -> Table {
    Table::of(Law { levels: 4, ..LAW }).with(name, column.split(", "))
}

#[test]
fn each_row_sets_aside_what_it_says_and_no_more() {
    for [name, aside, because, judged] in rows(include_str!("left_out.md")) {
        let said = format!("left out: `{name}` ({because}");
        // A line with a word alone is no part of a log.
        let is_word = because == "labels";
        let forms = Form::ALL.into_iter();
        for form in forms.filter(|form| !(is_word && *form == Form::LongLog)) {
            let lost = form.write(&with(name, judged));
            assert!(!passes(&lost), "{form:?}: {because}\n{lost}");
            let text = form.write(&with(name, aside));
            let sheet = answer(&text, &["2"]);
            let is_said = |sheet: Page| sheet.verdict.is_pass() && sheet.text.contains(&said);
            assert!(sheet.is_some_and(is_said), "{form:?}: not {said}\n{text}");
        }
    }
}

#[test]
fn what_no_row_sets_aside_is_judged() {
    for [name, column, _] in rows(include_str!("judged.md")) {
        never_passes(&with(name, column));
    }
}

#[test]
fn a_unit_that_all_numbers_share_is_no_part_of_them() {
    for unit in ["%", " %", "\\%", " mm", " µm"] {
        let text = format!("h;L2\n0.4;1.600e-1{unit}\n0.2;4.000e-2{unit}\n0.1;1.000e-2{unit}\n");
        assert!(passes(&text), "{text}");
        let some = text.replacen(unit, "", 1);
        assert!(answer(&some, &["2"]).is_none(), "{some}");
    }
    // Words that say something of a number are no units.
    for word in ["*", "?", "!", " (est.)", " nan", " fail", " extrapolated"] {
        let text = format!("h;L2\n0.4;0.16{word}\n0.2;0.04{word}\n0.1;0.01{word}\n");
        assert!(!passes(&text), "{text}");
    }
}

/// A refusal offers only what is read, and the first offer does not pass where an expert would not.
#[test]
fn each_offer_of_a_refusal_is_read() {
    for text in [
        "cells,L2\n16,4.00e-2\n64,1.00e-2\n256,2.50e-3\n",
        "N,dt,L2\n16,0.1,4.00e-2\n32,0.05,1.00e-2\n64,0.02,2.50e-3\n",
        "mesh,L2\ncoarse,4.00e-2\nmedium,1.00e-2\nfine,2.50e-3\n",
    ] {
        let error = RateTable::parse_all_with(text, "t", &Choice::default()).expect_err(text);
        assert_ne!(error.offered().count(), 0, "{error}");
        for choice in error.offered() {
            let read = RateTable::parse_all_with(text, "t", choice);
            assert!(read.is_ok(), "{choice:?}\n{text}");
        }
    }
}

#[test]
fn frames_obey_the_same_rule() {
    let numbers =
        |name: &str, numbers: &[f64]| FrameColumn::of_numbers(name, numbers.iter().copied());
    let words = |words: [&str; 5]| FrameColumn {
        name: "status".to_owned(),
        cells: words.map(|word| FrameCell::Word(word.to_owned())).to_vec(),
    };
    for (other, aside) in [
        (
            numbers("seconds", &[0.1, 0.4, 1.6, 6.4, 25.6]),
            Some("a cost: at least doubles"),
        ),
        (words(["ok"; 5]), Some("labels")),
        (words(["ok", "ok", "ok", "ok", "diverged"]), None),
        (numbers("nodes", &[5e3, 4e3, 3e3, 2e3, 1e3]), None),
        (numbers("k", &[0.5, 0.4, 0.3, 0.2, 0.1]), None),
    ] {
        let good = [("h", LAW.steps()), ("L2", LAW.errors())];
        let good = good.map(|(name, column)| numbers(name, &column));
        let columns = [&good[..], &[other]].concat();
        let table = RateTable::from_columns(&columns, "h", &Choice::default()).expect("a table");
        let because: Vec<_> = table.left_out.iter().map(|left| &*left.because).collect();
        assert_eq!(because, Vec::from_iter(aside), "{}", table.reading);
        assert_eq!(table.columns.len(), 2 - because.len(), "{}", table.reading);
    }
}
