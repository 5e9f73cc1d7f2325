use super::remainder::Approach;
use super::{Level, ROUND_OFF, floor};

/// A relative uncertainty m of e is one of s m e^s of e^s.
#[test]
fn differences_of_powers_must_exceed_the_uncertainty_of_powers() {
    let levels = [4.0, 2.0].map(|error| Level { step: 0.1, error });
    for power in [1.0, 2.0] {
        let uncertain = floor(&levels, 0.0, power).powf(power);
        let expected = power * ROUND_OFF * 2.0_f64.powf(power);
        assert!((uncertain / expected - 1.0).abs() < 1e-12, "{uncertain}");
    }
}

const EQUAL: [f64; 5] = [0.16, 0.08, 0.04, 0.02, 0.01];
const FAR: [f64; 5] = [0.16, 0.08, 0.04, 0.02, 0.00125];

/// Of `A^s = h^(s p) (1 + a h^r)`, a small.
#[test]
fn rates_that_approach_the_order_give_the_contribution_at_the_finest_level() {
    for steps in [EQUAL, FAR, [0.16, 0.1, 0.04, 0.03, 0.01]] {
        for (power, order, exponent) in [(1.0, 2.0, 1.0), (2.0, 1.0, 0.5), (1.0, 0.5, 2.0)] {
            let pollution = 1e-3;
            let error = |h: f64| {
                let power_of_error = h.powf(power * order) * (1.0 + pollution * h.powf(exponent));
                power_of_error.powf(1.0 / power)
            };
            let errors = steps.map(|step| Level {
                step,
                error: error(step),
            });
            let approach = Approach::new(&errors, 4, power, order);
            let found = power * approach.finest(exponent) - 1.0;
            let without = power * approach.finest(64.0) - 1.0;
            assert!(
                found.abs() < 1e-2 * without.abs(),
                "{steps:?} {order}: {found:e}, {without:e}"
            );
            let exponent_read = approach.exponent();
            assert!(
                (exponent_read - exponent).abs() < 0.3,
                "{steps:?}: {exponent_read}"
            );
        }
    }
}

#[test]
fn what_fades_at_once_or_not_at_all_is_taken_to_fade_as_the_bounds_say() {
    for (rates, expected) in [
        ([2.4, 2.2, 2.1], 1.0),
        ([2.4, 2.4, 2.4], 0.4),
        ([2.4, 2.4, 1.9], 2.0),
    ] {
        // The differences have these rates: the errors are their sums, below the finest one with
        // the rate 2.
        let mut differences = vec![1.0];
        for rate in rates {
            let last: f64 = differences[differences.len() - 1];
            differences.push(last / 2.0_f64.powf(rate));
        }
        let finest = differences[3] / 3.0;
        let errors: [Level; 5] = std::array::from_fn(|k| Level {
            step: EQUAL[k],
            error: finest + differences[k..].iter().sum::<f64>(),
        });
        let found = Approach::new(&errors, 4, 1.0, 2.0).exponent();
        assert!((found - expected).abs() < 1e-6, "{rates:?}: {found}");
    }
}
