//! Values of few digits.

use super::{Column, Estimator, Level, Verdict};

/// Values that were printed with these halves of a unit of the last place.
fn column(levels: &[(f64, f64, f64)]) -> Column {
    let level = |&(step, error, _): &(f64, f64, f64)| Level { step, error };
    Column {
        name: "val".to_owned(),
        levels: levels.iter().map(level).collect(),
        halves: levels.iter().map(|(_, _, half)| *half).collect(),
        step_halves: vec![0.0; levels.len()],
        is_chosen: true,
        samples: None,
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
