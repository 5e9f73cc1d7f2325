//! The published numbers of the rule.

use std::sync::LazyLock;

use convergence_calibration::intervals::ALL;
use convergence_calibration::noise::of_noise;
use convergence_calibration::of_the_rule;
use convergence_calibration::rules::{CLAIMS, wrong_pass};
use convergence_calibration::sheet::{Sheet, SheetRow};

static RULE: LazyLock<Vec<Sheet>> = LazyLock::new(|| of_the_rule(20, 1).expect("usable settings"));

fn sheet<'s>(sheets: &'s [Sheet], key: &str) -> &'s Sheet {
    sheets
        .iter()
        .find(|sheet| sheet.key == key)
        .expect("a sheet")
}

fn cell(row: &SheetRow, column: &str) -> f64 {
    row.value(column)
        .unwrap_or_else(|| panic!("no {column}: {row:?}"))
}

fn value(sheet: &Sheet, row: &str, column: &str) -> f64 {
    let named = sheet.rows.iter().find(|one| one.name == row);
    cell(named.expect("a row"), column)
}

#[test]
fn few_wrong_claims_pass_and_few_right_ones_fail_under_any_law_and_number_of_levels() {
    let laws = sheet(&RULE, "laws");
    for row in &laws.rows {
        assert!(cell(row, "wrong pass") <= 0.015, "{row:?}");
        assert!(!row.declared || cell(row, "true fail") <= 0.04, "{row:?}");
    }
    assert!(value(laws, ALL, "wrong pass") <= 0.002 && value(laws, ALL, "true fail") <= 0.01);
}

#[test]
fn pure_powers_always_pass() {
    let pure = &sheet(&RULE, "laws").rows[0];
    let columns = [
        "wrong pass",
        "true fail",
        "inconclusive",
        "interval holds the order",
    ];
    assert_eq!(
        columns.map(|column| cell(pure, column)),
        [0.0, 0.0, 0.0, 1.0]
    );
}

#[test]
fn more_levels_decide_more_and_added_ones_cost_less() {
    let levels = sheet(&RULE, "levels");
    let passes =
        ["4 levels", "5 levels", "6 levels", "8 levels"].map(|row| value(levels, row, "true pass"));
    assert!(
        passes.windows(2).all(|pair| pair[1] > pair[0]),
        "{passes:?}"
    );
    assert!(value(levels, "added up to 8", "true pass") > passes[3]);
    assert!(
        value(levels, "added up to 8", "levels") < 6.5
            && value(levels, "8 levels", "levels") == 8.0
    );
    for row in &levels.rows {
        assert!(
            cell(row, "visibly wrong pass") <= 0.006 && cell(row, "wrong pass") <= 0.015,
            "{row:?}"
        );
    }
}

#[test]
fn the_rule_errs_less_than_the_others() {
    for key in ["rules", "rules-wide"] {
        let rules = sheet(&RULE, key);
        let [ours, others @ ..] = &rules.rows[..] else {
            panic!("no rules")
        };
        for (tolerance, off) in CLAIMS {
            let wrong = |row| cell(row, &wrong_pass(tolerance, off));
            let least = others[1..].iter().map(wrong).fold(1.0, f64::min);
            assert!(
                wrong(ours) < 0.1 * least,
                "±{tolerance}: {} {least}",
                wrong(ours)
            );
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_sheets() {
    // NaN, for claims that no law has, is not equal to itself.
    let text = |seed: u64| format!("{:?} {:?}", of_the_rule(1, seed), of_noise(1, seed));
    assert_eq!(text(7), text(7));
    assert_ne!(text(7), text(8));
}
