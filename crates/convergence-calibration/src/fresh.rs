//! Nine error laws that were written before the rule was changed for noise: what a user of smooth
//! problems meets, noise of 0.3, 1 and 3 %, and a lower order behind that noise.
//!
//! Their numbers mean what those of the [29 laws](super::laws) mean: h = 1 on the coarsest level, H
//! on the finest, p uniform in [0.5, 4].

use convergence_judge::random::SplitMix;

use crate::laws::{Law, LawGroup, held_out};
use crate::shapes::{ErrorOfStep, Exponents};

/// Largest |a| of benign pollution 1 + a h^r, r from 1 to 4.
const BENIGN: f64 = 0.5;

/// The laws on which rules are compared.
pub const FRESH: [Law; 9] = [
    held_out(
        "h^p (1 + a h^r), r 1 to 4, |a| < 0.5",
        LawGroup::Polluted,
        |of, random| polluted(of, 0.0, random),
    ),
    held_out(
        "h^p (1 + a h + b h^2), |a|, |b| < 1/2",
        LawGroup::Polluted,
        two_powers,
    ),
    held_out("benign, noise 0.3 %", LawGroup::Scattered, |of, random| {
        polluted(of, 0.003, random)
    }),
    held_out("benign, noise 1 %", LawGroup::Scattered, |of, random| {
        polluted(of, 0.01, random)
    }),
    held_out("benign, noise 3 %", LawGroup::Scattered, |of, random| {
        polluted(of, 0.03, random)
    }),
    held_out(
        "lower order, noise 0.3 %",
        LawGroup::Emerging,
        |of, random| lower_order(of, 0.003, random),
    ),
    held_out(
        "lower order, noise 1 %",
        LawGroup::Emerging,
        |of, random| lower_order(of, 0.01, random),
    ),
    held_out(
        "lower order, noise 3 %",
        LawGroup::Emerging,
        |of, random| lower_order(of, 0.03, random),
    ),
    held_out("wrong limit, noise 1 %", LawGroup::Stagnating, wrong_limit),
];

/// Log-normal scatter of an error; σ = 0 draws as many numbers as any other.
fn scatter(sigma: f64, random: &mut SplitMix) -> f64 {
    (sigma * random.normal()).exp()
}

fn polluted(Exponents { p, .. }: Exponents, sigma: f64, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let a = random.within([-BENIGN, BENIGN]);
    let r = random.within([1.0, 4.0]);
    Box::new(move |h| h.powf(p) * (1.0 + a * h.powf(r)) * scatter(sigma, random))
}

fn two_powers(Exponents { p, .. }: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let [a, b] = [(); 2].map(|()| random.within([-0.5, 0.5]));
    Box::new(move |h| h.powf(p) * (1.0 + a * h + b * h * h).abs())
}

/// h^p + b h^order, of which the second makes up 5 to 20 % on the finest level.
fn lower_order(of: Exponents, sigma: f64, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let share = random.within([0.05, 0.2]);
    let lower = of.order.unwrap_or(of.p);
    let b = factor(of.p, lower, of.finest, share);
    Box::new(move |h| (h.powf(of.p) + b * h.powf(lower)) * scatter(sigma, random))
}

/// h^p + f with f from 5 to 20 % of the finest error.
fn wrong_limit(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let f = factor(of.p, 0.0, of.finest, random.within([0.05, 0.2]));
    Box::new(move |h| (h.powf(of.p) + f) * scatter(0.01, random))
}

/// b for which b H^q is this share of H^p + b H^q.
fn factor(p: f64, q: f64, finest: f64, share: f64) -> f64 {
    share / (1.0 - share) * finest.powf(p - q)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_scatter_by_as_much_as_they_are_said_to() {
        for sigma in [0.0, 0.003, 0.01, 0.03] {
            let mut random = SplitMix::new(22);
            let mut sum = 0.0;
            for _ in 0..4000 {
                sum += scatter(sigma, &mut random).ln().powi(2);
            }
            let deviation = (sum / 4000.0).sqrt();
            assert!((deviation - sigma).abs() <= 0.05 * sigma, "{deviation}");
        }
    }
}
