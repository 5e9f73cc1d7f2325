//! Numbers of few digits.

use super::{Claim, Column, Estimator, Floor, Level, Reason, Verdict};

/// Values that were printed with these halves of a unit of the last place.
fn column(levels: &[(f64, f64, f64)]) -> Column {
    let level = |&(step, error, _): &(f64, f64, f64)| Level { step, error };
    Column {
        halves: levels.iter().map(|(_, _, half)| *half).collect(),
        ..Column::exact("val", levels.iter().map(level).collect())
    }
}

#[test]
fn the_interval_of_values_holds_those_of_all_that_may_have_been_rounded_to_them() {
    let places = [
        (0.4, 1.160, 5e-4),
        (0.2, 1.040, 5e-4),
        (0.1, 1.010, 5e-4),
        (0.05, 1.0025, 5e-5),
        (0.025, 1.00063, 5e-6),
    ];
    let few = [
        (0.4, 1.32, 5e-3),
        (0.2, 1.08, 5e-3),
        (0.1, 1.02, 5e-3),
        (0.05, 1.005, 5e-4),
    ];
    let estimator = Estimator::new(0.25).expect("a tolerance");
    for (printed, verdict) in [
        (&places[..], Verdict::Pass),
        (&few[..], Verdict::Inconclusive),
    ] {
        let column = column(printed);
        let found = column.estimate(&estimator, Some(2.0));
        assert_eq!(found.judged.verdict, verdict);
        let interval = found.judged.interval.expect("a rate");
        let bar = found.bar.expect("a limit");
        let rate = found.judged.finest_rate().expect("a rate");
        for levels in column.otherwise(column.levels.len(), rate) {
            let other = super::estimated(&estimator, &levels, Some(2.0));
            if let Some(inside) = other.judged.interval {
                assert_eq!(interval.hull(inside), interval, "{inside:?}");
            }
            if let Ok(inside) = other.bar {
                let hull = bar.rate_interval.hull(inside.rate_interval);
                assert_eq!(hull, bar.rate_interval);
                assert_eq!(bar.limit.hull(inside.limit), bar.limit);
            }
        }
        let line = found.judged.line();
        let shown = line.split(['(', ')']).nth(1).expect("an interval");
        assert!(shown.contains(" to "), "{line}");
        assert!(found.judged.reason.to_string().contains(shown), "{line}");
    }
}

/// 0.02 and 0.005 may be 0.0204 and 0.0055, whose rate is 1.9, or 0.0196 and 0.0046.
#[test]
fn answers_of_one_digit_do_not_pass() {
    let claim = Claim::new(2.0, 0.25);
    let answered = |errors: &[f64]| {
        let steps = [0.4, 0.2, 0.1, 0.05].into_iter();
        let levels = steps
            .zip(errors)
            .map(|(step, &error)| Level { step, error });
        let levels: Vec<Level> = levels.collect();
        let exact = Column::exact("L2", levels.clone()).judge(&claim, Floor::NONE);
        assert!(exact.verdict.is_pass());
        Column::of_answers("L2", levels).judge(&claim, Floor::NONE)
    };
    let one = answered(&[0.3, 0.08, 0.02, 0.005]);
    assert_eq!(one.code, Reason::Digits);
    assert!(one.line().contains("1 digit: print more"), "{}", one.line());
    for more in [
        [0.32, 0.0801, 0.02, 0.005],
        [3.2e-9, 8.01e-10, 2e-10, 5e-11],
    ] {
        let more = answered(&more);
        assert!(more.verdict.is_pass(), "{}", more.line());
    }
}

/// 0.03 and 0.01 may be 0.034 and 0.0085, whose rate is 2.
#[test]
fn answers_whose_other_digits_would_pass_are_too_few() {
    let errors = [0.5, 0.13, 0.03, 0.01];
    let steps = [0.4, 0.2, 0.1, 0.05].into_iter();
    let levels = steps.zip(errors).map(|(step, error)| Level { step, error });
    let levels: Vec<Level> = levels.collect();
    let claim = Claim::new(2.0, 0.25);
    let exact = Column::exact("L2", levels.clone()).judge(&claim, Floor::NONE);
    assert!(!exact.verdict.is_pass());
    let answered = Column::of_answers("L2", levels).judge(&claim, Floor::NONE);
    assert_eq!(answered.code, Reason::Digits, "{}", answered.line());
}
