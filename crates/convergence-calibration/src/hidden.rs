//! Errors with a term of lower order that is just about to show.

use convergence_judge::{fit::Level, random::SplitMix};

use crate::laws::LawErrors;
use crate::shapes::log_uniform;

/// Shares of the finest error that a hidden term makes up.
pub const HIDDEN_SHARES: [f64; 5] = [0.05, 0.07, 0.10, 0.15, 0.20];

/// Errors h^p (1 + a h^r) with a term of lower order that is just about to show: b h^q, q = 0 (a
/// plateau, or with b < 0 a wrong limit), p - 1 or p - 1/2.
///
/// p is uniform in [1, 4], a = 0 in half of the tables and |a| < 0.5, r in [1, 4] in the other; the
/// order claimed is p.
///
/// * `share`: of the finest error, made up by the term.
pub(crate) fn hidden_term(levels: usize, share: f64, random: &mut SplitMix) -> LawErrors {
    let p = random.within([1.0, 4.0]);
    let (q, sign) = [(0.0, 1.0), (0.0, -1.0), (p - 1.0, 1.0), (p - 0.5, 1.0)][random.below(4)];
    let a = if random.below(2) == 0 {
        0.0
    } else {
        random.within([-0.5, 0.5])
    };
    let r = random.within([1.0, 4.0]);
    let finest = 0.5_f64.powi(levels as i32 - 1);
    let main = |h: f64| h.powf(p) * (1.0 + a * h.powf(r));
    // b H^q = share (main + b H^q)
    let b = sign * main(finest) * share / (1.0 - sign * share) / finest.powf(q);
    let mut table = LawErrors {
        levels: vec![],
        shown: p,
        order: (q > 0.0).then_some(q),
    };
    for k in 0..levels {
        let step = 0.5_f64.powi(k as i32);
        table.levels.push(Level {
            step,
            error: main(step) + b * step.powf(q),
        });
    }
    table
}

/// Eight errors of second order with a wrong limit, `|h^2 (1 + a h^r) ± f|`: a in [-0.9, 3], r = 1
/// or 2, f from 1 to 90 % of the finest error.
pub(crate) fn wrong_limit(random: &mut SplitMix) -> LawErrors {
    let (a, r) = (random.within([-0.9, 3.0]), [1.0, 2.0][random.below(2)]);
    let main = |h: f64| h * h * (1.0 + a * h.powf(r));
    let f = main(0.5_f64.powi(7)) * log_uniform([0.01, 0.9], random) * [1.0, -1.0][random.below(2)];
    eight(2.0, None, |h| (main(h) + f).abs())
}

/// Eight errors h^p (1 + a h) + b h^(p - 1): a and b of either sign, |a| from 0.1 to 10, the last
/// term 10 to 22 % of the finest error of the others.
pub(crate) fn three_terms(random: &mut SplitMix) -> LawErrors {
    let p = random.within([1.0, 4.0]);
    let sign_of_a = [1.0, -1.0][random.below(2)];
    let sign_of_b = [1.0, -1.0][random.below(2)];
    let a = sign_of_a * log_uniform([0.1, 10.0], random);
    let main = |h: f64| h.powf(p) * (1.0 + a * h);
    let finest = 0.5_f64.powi(7);
    let b = sign_of_b * main(finest).abs() * random.within([0.1, 0.22]) * finest.powf(1.0 - p);
    eight(p, Some(p - 1.0), |h| (main(h) + b * h.powf(p - 1.0)).abs())
}

fn eight(shown: f64, order: Option<f64>, error: impl Fn(f64) -> f64) -> LawErrors {
    let steps = (0..8).map(|k| 0.5_f64.powi(k));
    LawErrors {
        levels: steps
            .map(|step| Level {
                step,
                error: error(step),
            })
            .collect(),
        shown,
        order,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use convergence_judge::fit::pairwise_rates;

    #[test]
    fn a_hidden_term_has_its_share_of_the_finest_error() {
        let mut random = SplitMix::new(12);
        for share in HIDDEN_SHARES {
            for _ in 0..50 {
                let table = hidden_term(8, share, &mut random);
                let rates = pairwise_rates(&table.levels);
                // Without other pollution (half of the tables), the first rate is p except for what
                // is left of the term there.
                assert!(
                    table.levels.iter().all(|level| level.error > 0.0)
                        && rates.iter().all(|rate| rate.is_finite())
                );
                assert!(
                    (rates[6] - table.shown).abs() > 0.01 * share,
                    "{share} leaves a trace: {rates:?}"
                );
                assert!(table.order.is_none_or(|order| order < table.shown));
            }
        }
    }

    #[test]
    fn wrong_limits_and_three_terms_are_what_they_are_called() {
        let mut random = SplitMix::new(13);
        for _ in 0..100 {
            let table = wrong_limit(&mut random);
            assert!(table.levels.len() == 8 && table.order.is_none() && table.shown == 2.0);
            let rates = pairwise_rates(&three_terms(&mut random).levels);
            assert!(
                rates.len() == 7 && rates.iter().all(|rate| rate.is_finite()),
                "{rates:?}"
            );
        }
    }
}
