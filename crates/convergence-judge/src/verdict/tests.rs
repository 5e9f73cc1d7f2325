//! Tests that the units of steps and errors decide nothing.

use super::{Judge, Level, Verdict};
use crate::random::SplitMix;

/// Lengths and times in units that people use, and numbers of no kind.
const UNITS: [f64; 12] = [
    1.0,
    2.0,
    10.0,
    1e3,
    1e-3,
    1e-6,
    1e-9,
    0.3048,
    0.0254,
    60.0,
    86_400.0,
    1.234_567_8,
];

fn levels(steps: &[f64], errors: &[f64], [h, e]: [f64; 2]) -> Vec<Level> {
    let levels = steps.iter().zip(errors);
    let level = |(step, error): (&f64, &f64)| Level {
        step: h * step,
        error: e * error,
    };
    levels.map(level).collect()
}

/// Steps, and errors whose rates are repeated, round numbers, or pollute and scatter.
fn table(random: &mut SplitMix) -> [Vec<f64>; 2] {
    let count = 3 + (5.0 * random.uniform()) as usize;
    let ratio = [2.0, 2.0, 3.0, 4.0, 10.0, 1.5][(6.0 * random.uniform()) as usize];
    let steps: Vec<f64> = (0..count)
        .map(|k| 0.4 * f64::powi(ratio, -(k as i32)))
        .collect();
    let kind = (4.0 * random.uniform()) as usize;
    let a = random.uniform();
    let mut errors = vec![0.1 + random.uniform()];
    for k in 1..count {
        let rate = match kind {
            // Rates of whole halves of an order, which meet every threshold of the rule.
            0 => 0.5 * (8.0 * random.uniform()).floor() - 0.5,
            // The order, but for the last level or two.
            1 if k + 2 < count => 2.0,
            1 => 2.0 + 0.01 * (100.0 * random.uniform() - 50.0).round(),
            2 => 2.0 + a * steps[k],
            _ => 2.0 + 0.2 * (random.uniform() - 0.5),
        };
        errors.push(errors[k - 1] / ratio.powf(rate));
    }
    // As a table prints them, but for the last digits.
    let printed = |error: &f64| format!("{error:.9e}").parse().unwrap_or(*error);
    let is_printed = random.uniform() < 0.5;
    let printed: Vec<f64> = errors.iter().map(printed).collect();
    [steps, if is_printed { printed } else { errors }]
}

#[test]
fn a_thousand_tables_have_one_verdict_and_one_reason_in_all_units() {
    let mut random = SplitMix::new(75);
    let judges = [0.25, 0.1, 0.01].map(|tolerance| Judge::new(tolerance).expect("a tolerance"));
    let mut verdicts = [0; 3];
    for number in 0..1000 {
        let [steps, errors] = table(&mut random);
        for judge in &judges {
            for order in [2.0, 1.5] {
                let found = |units: [f64; 2]| {
                    let levels = levels(&steps, &errors, units);
                    judge.judge_read(&judge.read(&levels), order).code
                };
                let expected = found([1.0; 2]);
                verdicts[expected.verdict() as usize] += 1;
                for h in UNITS {
                    for e in UNITS {
                        assert_eq!(
                            found([h, e]),
                            expected,
                            "table {number}: {steps:?} {errors:?} in {h}, {e}, claim {order} ± {}",
                            judge.tolerance()
                        );
                    }
                }
            }
        }
    }
    assert!(verdicts.iter().all(|count| *count > 500), "{verdicts:?}");
    assert_eq!(Verdict::Fail as usize, 2);
}
