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

use convergence_judge::{fit::Level, random::SplitMix};

use crate::shapes::{Formula, Shape};

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
pub enum LawGroup {
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
    pub group: LawGroup,
    shape: Shape,
}

const fn law(name: &'static str, group: LawGroup, shape: Shape) -> Law {
    Law { name, group, shape }
}

/// A law of another file.
pub(crate) const fn held_out(name: &'static str, group: LawGroup, formula: Formula) -> Law {
    law(name, group, Shape::HeldOut(formula))
}

pub(crate) const fn polluted(name: &'static str, a: [f64; 2], r: [f64; 2]) -> Law {
    law(name, LawGroup::Polluted, Shape::Pollution { a, r })
}

const fn stagnating(
    name: &'static str,
    share: [f64; 2],
    error: fn([f64; 2], f64, f64) -> f64,
) -> Law {
    law(
        name,
        LawGroup::Stagnating,
        Shape::Stagnating { share, error },
    )
}

const fn noisy(name: &'static str, sigma: f64) -> Law {
    law(
        name,
        LawGroup::Scattered,
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
    law("h^p (L - log h)^k", LawGroup::Polluted, Shape::Logarithm),
    law(
        "h^p (1 ± a), odd and even",
        LawGroup::Scattered,
        Shape::OddEven,
    ),
    law(
        "h^p (1 + a h^r cos), r 0.5 to 2",
        LawGroup::Polluted,
        Shape::Oscillation { r: [0.5, 2.0] },
    ),
    law(
        "h^p (1 + a cos)",
        LawGroup::Scattered,
        Shape::Oscillation { r: [0.0, 0.0] },
    ),
    law(
        "h^p + b h^(p - 1/2 or 1)",
        LawGroup::Emerging,
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
    law("h^p / (h + h0)^g", LawGroup::Polluted, Shape::Shifted),
    law(
        "x / (1 + x), x = (h/h0)^p",
        LawGroup::Polluted,
        Shape::Saturated,
    ),
    noisy("noise 0.1 %", 0.001),
    noisy("noise 1 %", 0.01),
    noisy("noise 3 %", 0.03),
    noisy("noise 10 %", 0.1),
    noisy("noise 30 %", 0.3),
    law(
        "pollution, noise 1 %",
        LawGroup::Scattered,
        Shape::Noise {
            sigma: 0.01,
            a: [-0.5, 0.5],
            s: [0.0, 0.0],
        },
    ),
    law(
        "one outlier, up to a factor of 3",
        LawGroup::Scattered,
        Shape::Outlier,
    ),
    law(
        "noise 3 to 30 % that fades",
        LawGroup::Scattered,
        Shape::Noise {
            sigma: 0.1,
            a: [0.0, 0.0],
            s: [0.5, 2.0],
        },
    ),
];

/// A sequence of errors with its true order.
#[derive(Debug, Clone, PartialEq)]
pub struct LawErrors {
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
    pub(crate) fn draw(&self, levels: usize, ratio: f64, random: &mut SplitMix) -> LawErrors {
        let steps: Vec<f64> = (0..levels).map(|k| ratio.powi(-(k as i32))).collect();
        self.draw_at(&steps, random)
    }

    /// The same for any steps, the first of them 1.
    pub(crate) fn draw_at(&self, steps: &[f64], random: &mut SplitMix) -> LawErrors {
        let mut shown = random.within([0.5, 4.0]);
        let mut order = Some(shown);
        if self.group == LawGroup::Emerging {
            let lower = [0.5, 1.0][random.below(2)];
            shown += 1.0;
            order = Some(shown - lower);
        } else if self.group == LawGroup::Stagnating {
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
        LawErrors {
            levels,
            shown,
            order,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_meshes_are_all_combinations() {
        assert_eq!(
            (WIDE.each().count(), USUAL.each().count(), LAWS.len()),
            (24, 12, 29)
        );
    }
}
