//! Ten error laws, seen twice and not fitted: they were written before the last two constants of
//! the rule were chosen, and measured when each of these was.
//!
//! Their numbers mean what those of the [29 laws](super::laws) mean: h = 1 on the coarsest level, H
//! on the finest, p uniform in [0.5, 4].

use crate::laws::{Law, LawGroup, held_out};
use crate::shapes::{ErrorOfStep, Exponents, log_uniform};
use convergence_judge::random::SplitMix;

/// The laws.
pub const HELD_OUT: [Law; 10] = [
    held_out(
        "h^p (1 + a s (1 - s)), s the fraction of c/h",
        LawGroup::Scattered,
        interface,
    ),
    held_out("√(h^2p + a² h^(2p+2))", LawGroup::Polluted, two_components),
    held_out("max(h^p, a h^(p+1))", LawGroup::Polluted, two_places),
    held_out("h^p (1 + a exp(-h/h0))", LawGroup::Polluted, layer),
    held_out("tanh((h/h0)^p)", LawGroup::Polluted, bounded),
    held_out("h^p (1 + a h^p)", LawGroup::Polluted, dispersion),
    held_out("(h / (1 - h/n))^p", LawGroup::Polluted, nodes_for_elements),
    held_out(
        "h^p + b h^(p - d) |log h|",
        LawGroup::Emerging,
        lower_order_with_a_logarithm,
    ),
    held_out(
        "h^p + b h^(p - d) |N|",
        LawGroup::Emerging,
        lower_order_at_random,
    ),
    held_out("h^p (1 + 1 % N) + f", LawGroup::Stagnating, noisy_limit),
];

/// An interface at c that the mesh does not resolve: it lies anywhere in its element. a in [0, 1].
fn interface(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let (a, c) = (random.uniform(), random.within([1.0, 10.0]));
    Box::new(move |h| {
        let s = (c / h).fract();
        h.powf(of.p) * (1.0 + a * s * (1.0 - s))
    })
}

/// The norm of two components, the second of a higher order. a from 0.3 to 10.
fn two_components(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let a = log_uniform([0.3, 10.0], random);
    Box::new(move |h| h.powf(of.p) * (a * h).hypot(1.0))
}

/// A maximum that moves from one place to another. a from 1 to 10.
fn two_places(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let a = log_uniform([1.0, 10.0], random);
    Box::new(move |h| h.powf(of.p) * (a * h).max(1.0))
}

/// A layer of the width h0, from 0.05 to 5, that only fine meshes see. a in [-0.5, 3].
fn layer(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let (a, h0) = (random.within([-0.5, 3.0]), log_uniform([0.05, 5.0], random));
    Box::new(move |h| h.powf(of.p) * (1.0 + a * (-h / h0).exp()))
}

/// An error that cannot exceed the solution, with a sharper bend than x / (1 + x). h0 from 0.1
/// to 10.
fn bounded(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let h0 = log_uniform([0.1, 10.0], random);
    Box::new(move |h| (h / h0).powf(of.p).tanh())
}

/// Pollution by dispersion: twice the order of the scheme. a from 0.3 to 30.
fn dispersion(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let a = log_uniform([0.3, 30.0], random);
    Box::new(move |h| h.powf(of.p) * (1.0 + a * h.powf(of.p)))
}

/// One over the number of nodes taken for one over the number of elements. n from 2 to 20 nodes on
/// the coarsest level.
fn nodes_for_elements(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let n = log_uniform([2.0, 20.0], random);
    Box::new(move |h| (h / (1.0 - h / n)).powf(of.p))
}

/// A lower order with a logarithm. The second term is 0.01 to 10 times the first on the finest
/// level.
fn lower_order_with_a_logarithm(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let lower = of.order.unwrap_or(of.p);
    let b = of.finest.powf(of.p - lower) / of.finest.ln().abs() * log_uniform([0.01, 10.0], random);
    Box::new(move |h| h.powf(of.p) + b * h.powf(lower) * h.ln().abs())
}

/// A lower order whose constant is another on each mesh. The second term is 0.01 to 10 times the
/// first on the finest level.
fn lower_order_at_random(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let lower = of.order.unwrap_or(of.p);
    let b = of.finest.powf(of.p - lower) * log_uniform([0.01, 10.0], random);
    Box::new(move |h| h.powf(of.p) + b * h.powf(lower) * random.normal().abs())
}

/// A wrong limit, 0.03 to 3 times the finest error, below noise of 1 %.
fn noisy_limit(of: Exponents, random: &mut SplitMix) -> ErrorOfStep<'_> {
    let f = of.finest.powf(of.p) * log_uniform([0.03, 3.0], random);
    Box::new(move |h| h.powf(of.p) * (0.01 * random.normal()).exp() + f)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::LAWS;
    use convergence_judge::fit::pairwise_rates;

    /// On steps that reach far enough the rate is the order, whatever numbers were drawn.
    #[test]
    fn each_law_has_the_order_that_it_says() {
        let mut random = SplitMix::new(11);
        for law in LAWS.iter().chain(&HELD_OUT) {
            for _ in 0..20 {
                let table = law.draw(60, 2.0, &mut random);
                let finest = pairwise_rates(&table.levels)[58];
                match (law.group, table.order) {
                    (LawGroup::Stagnating, order) => assert!(order.is_none(), "{}", law.name),
                    (LawGroup::Emerging, Some(order)) => {
                        assert!(order < table.shown, "{}", law.name);
                    }
                    // log h changes by one part in forty: the exponent of the logarithm shows.
                    (LawGroup::Polluted, Some(order)) => {
                        assert!(
                            (finest - order).abs() < 0.05,
                            "{}: {finest} {order}",
                            law.name
                        );
                    }
                    (LawGroup::Scattered, Some(order)) => {
                        let mean = (table.levels[0].error / table.levels[59].error).log2() / 59.0;
                        assert!((mean - order).abs() < 0.1, "{}: {mean} {order}", law.name);
                    }
                    _ => panic!("{} has no order", law.name),
                }
            }
        }
    }
}
