//! Error laws whose order is known, on meshes that people use.
//!
//! Every law is a function of the step h, h = 1 on the coarsest of m levels and H on the finest; p
//! is uniform in [0.5, 4] and all other numbers are drawn anew for each table (p in [1.5, 5] where
//! a lower order emerges). Four groups of laws:
//!
//! * *polluted*: h^p times a factor that tends to a constant, or to a power of log h. The order is
//!   p.
//! * *scattered*: h^p with log-normal scatter, an outlier, or oscillations that do not fade. The
//!   order is p.
//! * *emerging*: h^p + b h^(p - 1/2) or h^(p - 1). The order is the lower one, whatever the levels
//!   show of it.
//! * *stagnating*: plateaus, a wrong limit, growing round-off. There is no order, and every claim
//!   is wrong.

use convergence_study::judge::fit::Level;
use convergence_study::judge::random::SplitMix;

/// 3 to 12 levels, ratios 1.1 to 4: what papers use, sound or not.
pub const WIDE: Meshes = Meshes {
    levels: &[3, 4, 5, 6, 8, 12],
    ratios: &[1.1, 1.3, 2.0, 4.0],
};

/// 4 to 8 levels, ratios 1.5 to 3: what a convergence study should have.
pub const USUAL: Meshes = Meshes {
    levels: &[4, 5, 6, 8],
    ratios: &[1.5, 2.0, 3.0],
};

/// All combinations of numbers of levels and step ratios.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meshes {
    /// Numbers of levels.
    pub levels: &'static [usize],
    /// Step ratios.
    pub ratios: &'static [f64],
}

impl Meshes {
    /// Each number of levels with each ratio, which runs faster.
    pub fn each(self) -> impl Iterator<Item = (usize, f64)> {
        self.levels
            .iter()
            .flat_map(move |&levels| self.ratios.iter().map(move |&ratio| (levels, ratio)))
    }
}

/// What a law does to the order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// The factor before h^p settles.
    Polluted,
    /// The factor before h^p never settles.
    Scattered,
    /// A lower order eventually shows.
    Emerging,
    /// The error does not tend to zero.
    Stagnating,
}

/// An error law.
#[derive(Debug, Clone, Copy)]
pub struct Law {
    /// The formula.
    pub name: &'static str,
    /// What it does to the order.
    pub group: Group,
    shape: Shape,
}

/// The formulas, with the ranges of the numbers drawn.
#[derive(Debug, Clone, Copy)]
enum Shape {
    /// h^p |1 + a h^r|, a and r in these ranges.
    Pollution { a: [f64; 2], r: [f64; 2] },
    /// h^p (L - log h)^k, k = 1/2, 1 or 2, L in [0.5, 4].
    Logarithm,
    /// h^p (1 ± a) in turns, a in [0.01, 0.2].
    OddEven,
    /// h^p (1 + a h^r cos(w + f log h)), a in [0.05, 0.5], f in [1, 8].
    Oscillation { r: [f64; 2] },
    /// h^p + b h^(p - d), d = 1/2 or 1; the second term is 0.01 to 10 times the first on the finest
    /// level.
    LowerOrder,
    /// An error that does not tend to zero: of [h, H], h^p and f, f being a share of H^p and H the
    /// finest step.
    Stagnating {
        share: [f64; 2],
        error: fn([f64; 2], f64, f64) -> f64,
    },
    /// h^p / (h + h0)^g, g in [0.25, 1]
    Shifted,
    /// x / (1 + x), x = (h / h0)^p
    Saturated,
    /// h^p exp(σ h^s N)
    Noise {
        sigma: f64,
        a: [f64; 2],
        s: [f64; 2],
    },
    /// h^p, except that one level is up to 3 times too large or too small.
    Outlier,
    /// A law of another file.
    HeldOut(Formula),
}

const fn law(name: &'static str, group: Group, shape: Shape) -> Law {
    Law { name, group, shape }
}

/// A law of another file.
pub(crate) const fn held_out(name: &'static str, group: Group, formula: Formula) -> Law {
    law(name, group, Shape::HeldOut(formula))
}

const fn polluted(name: &'static str, a: [f64; 2], r: [f64; 2]) -> Law {
    law(name, Group::Polluted, Shape::Pollution { a, r })
}

const fn stagnating(
    name: &'static str,
    share: [f64; 2],
    error: fn([f64; 2], f64, f64) -> f64,
) -> Law {
    law(name, Group::Stagnating, Shape::Stagnating { share, error })
}

const fn noisy(name: &'static str, sigma: f64) -> Law {
    law(
        name,
        Group::Scattered,
        Shape::Noise {
            sigma,
            a: [0.0, 0.0],
            s: [0.0, 0.0],
        },
    )
}

/// The laws.
pub const LAWS: [Law; 29] = [
    polluted("h^p", [0.0, 0.0], [1.0, 1.0]),
    polluted(
        "h^p |1 + a h^r|, r 1 to 4, |a| < 0.5",
        [-0.5, 0.5],
        [1.0, 4.0],
    ),
    polluted(
        "h^p |1 + a h^r|, r 0.5 to 1, |a| < 0.5",
        [-0.5, 0.5],
        [0.5, 1.0],
    ),
    polluted(
        "h^p |1 + a h^r|, r 0.25 to 0.5, |a| < 0.5",
        [-0.5, 0.5],
        [0.25, 0.5],
    ),
    polluted(
        "h^p (1 + a h^(1/3)), a 0.5 to 3",
        [0.5, 3.0],
        [1.0 / 3.0, 1.0 / 3.0],
    ),
    polluted("h^p (1 + a h), a 1 to 30", [1.0, 30.0], [1.0, 1.0]),
    polluted("h^p (1 + a h^2), a 1 to 100", [1.0, 100.0], [2.0, 2.0]),
    polluted("h^p |1 - a h^r|, a 1 to 30", [-30.0, -1.0], [0.5, 2.0]),
    law("h^p (L - log h)^k", Group::Polluted, Shape::Logarithm),
    law(
        "h^p (1 ± a), odd and even",
        Group::Scattered,
        Shape::OddEven,
    ),
    law(
        "h^p (1 + a h^r cos), r 0.5 to 2",
        Group::Polluted,
        Shape::Oscillation { r: [0.5, 2.0] },
    ),
    law(
        "h^p (1 + a cos)",
        Group::Scattered,
        Shape::Oscillation { r: [0.0, 0.0] },
    ),
    law(
        "h^p + b h^(p - 1/2 or 1)",
        Group::Emerging,
        Shape::LowerOrder,
    ),
    stagnating("h^p + f, f 1 to 100 H^p", [1.0, 100.0], |_, power, f| {
        power + f
    }),
    stagnating("h^p + f, f 0.01 to 1 H^p", [0.01, 1.0], |_, power, f| {
        power + f
    }),
    stagnating("|h^p - f|", [0.01, 0.9], |_, power, f| (power - f).abs()),
    stagnating("√(h^2p + f²)", [0.1, 10.0], |_, power, f| power.hypot(f)),
    stagnating("max(h^p, f)", [0.1, 10.0], |_, power, f| power.max(f)),
    stagnating("h^p + f/h²", [0.1, 10.0], |[h, finest], power, f| {
        power + f * finest.powi(2) / (h * h)
    }),
    law("h^p / (h + h0)^g", Group::Polluted, Shape::Shifted),
    law(
        "x / (1 + x), x = (h/h0)^p",
        Group::Polluted,
        Shape::Saturated,
    ),
    noisy("noise 0.1 %", 0.001),
    noisy("noise 1 %", 0.01),
    noisy("noise 3 %", 0.03),
    noisy("noise 10 %", 0.1),
    noisy("noise 30 %", 0.3),
    law(
        "pollution, noise 1 %",
        Group::Scattered,
        Shape::Noise {
            sigma: 0.01,
            a: [-0.5, 0.5],
            s: [0.0, 0.0],
        },
    ),
    law(
        "one outlier, up to a factor of 3",
        Group::Scattered,
        Shape::Outlier,
    ),
    law(
        "noise 3 to 30 % that fades",
        Group::Scattered,
        Shape::Noise {
            sigma: 0.1,
            a: [0.0, 0.0],
            s: [0.5, 2.0],
        },
    ),
];

/// A sequence of errors with its true order.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The errors, coarsest first.
    pub levels: Vec<Level>,
    /// The exponent p of the law: the order that the coarse levels of an emerging or stagnating law
    /// show.
    pub shown: f64,
    /// The order at h → 0; `None` if the errors do not tend to zero.
    pub order: Option<f64>,
}

impl Law {
    /// Draws the numbers of the law and its errors on so many levels, each step this many times the
    /// next.
    pub(crate) fn draw(&self, levels: usize, ratio: f64, random: &mut SplitMix) -> Table {
        let steps: Vec<f64> = (0..levels).map(|k| ratio.powi(-(k as i32))).collect();
        self.draw_at(&steps, random)
    }

    /// The same for any steps, the first of them 1.
    pub(crate) fn draw_at(&self, steps: &[f64], random: &mut SplitMix) -> Table {
        let mut shown = random.within([0.5, 4.0]);
        let mut order = Some(shown);
        if self.group == Group::Emerging {
            let lower = [0.5, 1.0][random.below(2)];
            shown += 1.0;
            order = Some(shown - lower);
        } else if self.group == Group::Stagnating {
            order = None;
        }
        let mut error = self.shape.draw(shown, order, steps, random);
        let levels = steps
            .iter()
            .map(|&step| Level {
                step,
                error: error(step),
            })
            .collect();
        Table {
            levels,
            shown,
            order,
        }
    }
}

/// Draws the numbers of a law; the error is a function of the step, to be called once for each
/// step, coarsest first.
pub(crate) type Formula =
    for<'a> fn(Exponents, &'a mut SplitMix) -> Box<dyn FnMut(f64) -> f64 + 'a>;

/// The numbers that are the same for all levels of a table of a held-out law.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Exponents {
    /// The exponent that the coarse levels show.
    pub p: f64,
    /// The order, if there is one.
    pub order: Option<f64>,
    /// The finest step, H.
    pub finest: f64,
}

impl Shape {
    /// Draws the numbers of the formula.
    ///
    /// * `p`, `order`: exponent of h and order of the law.
    /// * Returns the error as a function of the step, to be called once for each step, coarsest
    ///   first.
    fn draw<'a>(
        self,
        p: f64,
        order: Option<f64>,
        steps: &'a [f64],
        random: &'a mut SplitMix,
    ) -> Box<dyn FnMut(f64) -> f64 + 'a> {
        let finest = steps[steps.len() - 1];
        match self {
            Self::Pollution { a, r } => {
                let (a, r) = (random.within(a), random.within(r));
                Box::new(move |h| h.powf(p) * (1.0 + a * h.powf(r)).abs())
            }
            Self::Logarithm => {
                let (k, l) = ([0.5, 1.0, 2.0][random.below(3)], random.within([0.5, 4.0]));
                Box::new(move |h| h.powf(p) * (l - h.ln()).powf(k))
            }
            Self::OddEven => {
                let mut a = random.within([0.01, 0.2]);
                Box::new(move |h| {
                    a = -a;
                    h.powf(p) * (1.0 + a)
                })
            }
            Self::Oscillation { r } => {
                let (a, r, frequency) = (
                    random.within([0.05, 0.5]),
                    random.within(r),
                    random.within([1.0, 8.0]),
                );
                let phase = random.within([0.0, std::f64::consts::TAU]);
                Box::new(move |h| {
                    h.powf(p) * (1.0 + a * h.powf(r) * (phase + frequency * h.ln()).cos())
                })
            }
            Self::LowerOrder => {
                let lower = p - order.unwrap_or(p);
                let b = finest.powf(lower) * log_uniform([0.01, 10.0], random);
                Box::new(move |h| h.powf(p) * (1.0 + b * h.powf(-lower)))
            }
            Self::Stagnating { share, error } => {
                let f = finest.powf(p) * log_uniform(share, random);
                Box::new(move |h| error([h, finest], h.powf(p), f))
            }
            Self::Shifted => {
                let (h0, g) = (
                    log_uniform([finest, 1.0], random),
                    random.within([0.25, 1.0]),
                );
                Box::new(move |h| h.powf(p) / (h + h0).powf(g))
            }
            Self::Saturated => {
                let h0 = log_uniform([finest, 1.0], random);
                Box::new(move |h| saturated((h / h0).powf(p)))
            }
            Self::Noise { sigma, a, s } => {
                let (a, r, s) = (
                    random.within(a),
                    random.within([1.0, 4.0]),
                    random.within(s),
                );
                let sigma = if s > 0.0 {
                    sigma * log_uniform([0.3, 3.0], random)
                } else {
                    sigma
                };
                Box::new(move |h| {
                    h.powf(p) * (1.0 + a * h.powf(r)) * (sigma * h.powf(s) * random.normal()).exp()
                })
            }
            Self::Outlier => {
                let (wrong, factor) = (
                    steps[random.below(steps.len())],
                    log_uniform([1.0 / 3.0, 3.0], random),
                );
                Box::new(move |h| h.powf(p) * if h == wrong { factor } else { 1.0 })
            }
            Self::HeldOut(formula) => formula(Exponents { p, order, finest }, random),
        }
    }
}

fn saturated(x: f64) -> f64 {
    x / (1.0 + x)
}

/// A number whose logarithm is uniform.
pub(crate) fn log_uniform([low, high]: [f64; 2], random: &mut SplitMix) -> f64 {
    random.within([low.ln(), high.ln()]).exp()
}

/// Shares of the finest error that a hidden term makes up.
pub const HIDDEN_SHARES: [f64; 5] = [0.05, 0.07, 0.10, 0.15, 0.20];

/// Errors h^p (1 + a h^r) with a term of lower order that is just about to show: b h^q, q = 0 (a
/// plateau, or with b < 0 a wrong limit), p - 1 or p - 1/2.
///
/// p is uniform in [1, 4], a = 0 in half of the tables and |a| < 0.5, r in [1, 4] in the other; the
/// order claimed is p.
///
/// * `share`: of the finest error, made up by the term.
pub(crate) fn hidden_term(levels: usize, share: f64, random: &mut SplitMix) -> Table {
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
    let level = |k: usize| {
        let step = 0.5_f64.powi(k as i32);
        Level {
            step,
            error: main(step) + b * step.powf(q),
        }
    };
    Table {
        levels: (0..levels).map(level).collect(),
        shown: p,
        order: (q > 0.0).then_some(q),
    }
}

/// Eight errors of second order with a wrong limit, `|h^2 (1 + a h^r) ± f|`: a in [-0.9, 3], r = 1
/// or 2, f from 1 to 90 % of the finest error.
pub(crate) fn wrong_limit(random: &mut SplitMix) -> Table {
    let (a, r) = (random.within([-0.9, 3.0]), [1.0, 2.0][random.below(2)]);
    let main = |h: f64| h * h * (1.0 + a * h.powf(r));
    let f = main(0.5_f64.powi(7)) * log_uniform([0.01, 0.9], random) * [1.0, -1.0][random.below(2)];
    eight(2.0, None, |h| (main(h) + f).abs())
}

/// Eight errors h^p (1 + a h) + b h^(p - 1): a and b of either sign, |a| from 0.1 to 10, the last
/// term 10 to 22 % of the finest error of the others.
pub(crate) fn three_terms(random: &mut SplitMix) -> Table {
    let (p, mut sign) = (random.within([1.0, 4.0]), || [1.0, -1.0][random.below(2)]);
    let (one, other) = (sign(), sign());
    let a = one * log_uniform([0.1, 10.0], random);
    let main = |h: f64| h.powf(p) * (1.0 + a * h);
    let finest = 0.5_f64.powi(7);
    let b = other * main(finest).abs() * random.within([0.1, 0.22]) * finest.powf(1.0 - p);
    eight(p, Some(p - 1.0), |h| (main(h) + b * h.powf(p - 1.0)).abs())
}

fn eight(shown: f64, order: Option<f64>, error: impl Fn(f64) -> f64) -> Table {
    let steps = (0..8).map(|k| 0.5_f64.powi(k));
    Table {
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
    use convergence_study::judge::fit::pairwise_rates;

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

    #[test]
    fn the_meshes_are_all_combinations() {
        assert_eq!(
            (WIDE.each().count(), USUAL.each().count(), LAWS.len()),
            (24, 12, 29)
        );
    }
}
