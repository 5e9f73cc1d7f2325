//! The published numbers of the rule.

use std::sync::LazyLock;

use convergence_study::judge::calibration::{
    ALL, Row, Sheet, bars::of_the_bars, grids::of_grids, of_the_rule,
};

static RULE: LazyLock<Vec<Sheet>> = LazyLock::new(|| of_the_rule(20, 1).expect("usable settings"));

fn sheet<'s>(sheets: &'s [Sheet], key: &str) -> &'s Sheet {
    sheets
        .iter()
        .find(|sheet| sheet.key == key)
        .expect("a sheet")
}

fn value(sheet: &Sheet, row: &str, column: &str) -> f64 {
    let row = sheet
        .rows
        .iter()
        .find(|known| known.name == row)
        .expect("a row");
    row.values[sheet
        .columns
        .iter()
        .position(|known| known == column)
        .expect("a column")]
}

fn declared(sheet: &Sheet) -> impl Iterator<Item = &Row> {
    sheet.rows.iter().filter(|row| row.declared)
}

#[test]
fn few_wrong_claims_pass_and_few_right_ones_fail_under_any_law_and_number_of_levels() {
    let laws = sheet(&RULE, "laws");
    for row in &laws.rows {
        assert!(row.values[0] <= 0.015, "{row:?}");
        assert!(!row.declared || row.values[1] <= 0.04, "{row:?}");
    }
    assert!(value(laws, ALL, "wrong pass") <= 0.002 && value(laws, ALL, "true fail") <= 0.01);
}

#[test]
fn intervals_hold_the_order_under_every_declared_law() {
    let laws = sheet(&RULE, "laws");
    assert_eq!(declared(laws).count(), 12);
    for row in declared(laws) {
        assert!(row.values[3] >= 0.86, "{row:?}");
    }
    assert!(value(laws, ALL, "interval holds the order") >= 0.94);
}

#[test]
fn pure_powers_always_pass() {
    let pure = &sheet(&RULE, "laws").rows[0];
    assert_eq!(pure.values, [0.0, 0.0, 0.0, 1.0]);
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
        assert!(row.values[3] <= 0.006 && row.values[2] <= 0.015, "{row:?}");
    }
}

#[test]
fn the_rule_errs_less_than_the_others() {
    for key in ["rules", "rules-wide"] {
        let rules = sheet(&RULE, key);
        let [ours, others @ ..] = &rules.rows[..] else {
            panic!("no rules")
        };
        for (name, wrong) in rules.columns.iter().zip(0..).step_by(3) {
            let least = others[1..]
                .iter()
                .map(|row| row.values[wrong])
                .fold(1.0, f64::min);
            assert!(
                ours.values[wrong] < 0.1 * least,
                "{name}: {} {least}",
                ours.values[wrong]
            );
        }
    }
}

#[test]
fn hidden_terms_and_wrong_limits_rarely_pass_and_no_coarse_level_excuses_one() {
    for (key, most) in [("hidden-8", 0.06), ("hidden-wide", 0.06)] {
        assert!(
            value(sheet(&RULE, key), "this rule", "10 %") <= most,
            "{key}"
        );
    }
    let limits = sheet(&RULE, "limits");
    assert!(
        limits.rows.iter().all(|row| row.values[1] == 0.0),
        "{limits:?}"
    );
    assert!(
        value(limits, "±0.1", "wrong limit passes") <= 0.2,
        "{limits:?}"
    );
    assert!(
        value(limits, "±0.2", "three terms pass") <= 0.15,
        "{limits:?}"
    );
}

#[test]
fn constants_are_held_and_too_high_a_least_order_rarely_passes() {
    for row in &sheet(&RULE, "claims").rows {
        let [too_much, .., holds, _, fails, wrong] = row.values[..] else {
            panic!("{row:?}")
        };
        assert!(
            too_much <= 0.02 && holds >= 0.95 && fails <= 0.005 && wrong <= 0.005,
            "{row:?}"
        );
    }
}

#[test]
fn no_grid_passes_whose_errors_do_not_tend_to_zero() {
    let grids = of_grids(120, 5).expect("usable settings");
    for row in &grids[0].rows {
        let [
            _,
            fail,
            holds,
            hidden,
            constant,
            squares,
            _,
            noisy_fail,
            noisy_holds,
        ] = row.values[..]
        else {
            panic!("{row:?}")
        };
        assert!(
            fail == 0.0 && holds >= 0.95 && hidden <= 0.02 && constant == 0.0 && squares <= 0.02,
            "{row:?}"
        );
        assert!(noisy_fail <= 0.02 && noisy_holds >= 0.88, "{row:?}");
    }
    let sound: Vec<f64> = grids[0].rows.iter().map(|row| row.values[0]).collect();
    assert!(
        sound.windows(2).all(|pair| pair[1] > pair[0]) && sound[2] > 0.9,
        "{sound:?}"
    );
}

#[test]
fn the_same_seed_gives_the_same_sheets() {
    // NaN, for claims that no law has, is not equal to itself.
    let text = |seed: u64| format!("{:?} {:?}", of_the_rule(1, seed), of_the_bars(1, seed));
    assert_eq!(text(7), text(7));
    assert_ne!(text(7), text(8));
}
