//! Variants of the exact solution of a study, for `--where`: loads, initial data and errors follow,
//! because all of them are made of the exact solution.
//!
//! Flat are products with weights that vanish at an end of the beam, or at the first time, with
//! their first three derivatives, one more than the largest order: x⁴ at x = 0, (1 - x)⁴ at x = 1,
//! (4x(1 - x))⁴ at both, (t/T)⁴ at t = 0. The boundary conditions remain: u and φ are 0 at x = 0,
//! and where the weight takes θ = θ_A from there, a lifting l brings it back, θ = w θ + θ_A l: it
//! falls from 1 to 0 and is as flat as the solution, 1 - x⁴, or 1 - 35x⁴ + 84x⁵ - 70x⁶ + 20x⁷ at
//! both. At the first time θ = θ_A (1 - x). Where u is flat at x = 1 the tip touches no obstacle.

use convergence_study::variants::{SolverPart, Variant, Variants};

use super::Convergence;
use crate::kinds::prelude::*;
use crate::{
    exact::{
        function::Factor,
        solution::{Manufactured, Product},
    },
    scene::Coefficients,
};

/// Where the solution is held in time: this share of the time of a study, no time of symmetry.
const MIDDLE: f64 = 0.4;

/// Claims of a variant may be this far off: what has lost half an order is lost.
const TOLERANCE: f64 = 0.25;

/// Points in x, and in t, at which the size of a solution is taken.
const POINTS: u32 = 16;

/// A function of x and its first two derivatives.
type Weight = fn(f64) -> [f64; 3];

/// How fields become flat.
struct Flat {
    weight: Weight,
    /// What is added to the temperature, in units of θ_A.
    lifting: Option<Weight>,
}

const AT_ZERO: Flat = Flat {
    weight: at_zero,
    lifting: Some(falls_to_one),
};
const AT_ONE: Flat = Flat {
    weight: at_one,
    lifting: None,
};
const AT_BOTH: Flat = Flat {
    weight: at_both,
    lifting: Some(falls_between),
};

fn at_zero(x: f64) -> [f64; 3] {
    [x.powi(4), 4.0 * x.powi(3), 12.0 * x.powi(2)]
}

fn at_one(x: f64) -> [f64; 3] {
    let [value, first, second] = at_zero(1.0 - x);
    [value, -first, second]
}

fn at_both(x: f64) -> [f64; 3] {
    // s⁴ of s = 4x(1 - x).
    let [s, slope] = [4.0 * x * (1.0 - x), 4.0 - 8.0 * x];
    let [value, first, second] = at_zero(s);
    [value, first * slope, second * slope * slope - 8.0 * first]
}

fn falls_to_one(x: f64) -> [f64; 3] {
    let [value, first, second] = at_zero(x);
    [1.0 - value, -first, -second]
}

fn falls_between(x: f64) -> [f64; 3] {
    let y = 1.0 - x;
    [
        // The smoothest of degree 7: its slope is -140 x³ (1 - x)³.
        1.0 - x.powi(4) * (35.0 + x * (-84.0 + x * (70.0 - 20.0 * x))),
        -140.0 * (x * y).powi(3),
        -420.0 * (x * y).powi(2) * (y - x),
    ]
}

/// What a variant does to a study.
struct StudyChange {
    name: &'static str,
    switches_off: fn() -> SolverPart,
    /// Whether the study has what is switched off.
    applies: fn(&Convergence) -> bool,
    change: fn(&mut Convergence),
}

const CHANGES: [StudyChange; 11] = [
    StudyChange {
        name: "constant_t",
        switches_off: || SolverPart::Time("t".to_owned()),
        // Where the error in time is exactly zero or the only one, a solution that is held shows
        // nothing: all of it is round-off.
        applies: |study| study.refine.axis != RefinedIn::Time,
        change: |study| held(&mut study.exact, MIDDLE * study.refine.t_end),
    },
    StudyChange {
        name: "flat_x_min",
        switches_off: || SolverPart::Face("x_min".to_owned()),
        applies: always,
        change: |study| study.flatten(&AT_ZERO),
    },
    StudyChange {
        name: "flat_x_max",
        switches_off: || SolverPart::Face("x_max".to_owned()),
        applies: always,
        change: |study| study.flatten(&AT_ONE),
    },
    StudyChange {
        name: "flat_x",
        switches_off: || SolverPart::BothFaces("x".to_owned()),
        applies: always,
        change: |study| study.flatten(&AT_BOTH),
    },
    StudyChange {
        name: "flat_initial",
        switches_off: || SolverPart::Initial,
        applies: always,
        change: Convergence::begin_flat,
    },
    StudyChange {
        name: "flat_everywhere",
        switches_off: || SolverPart::AllFacesAndInitial,
        applies: always,
        change: |study| {
            study.flatten(&AT_BOTH);
            study.begin_flat();
        },
    },
    StudyChange {
        name: "no_phi",
        switches_off: || SolverPart::Field("phi".to_owned()),
        applies: |study| !study.exact.phi.is_empty(),
        change: |study| study.exact.phi.clear(),
    },
    StudyChange {
        name: "no_theta",
        switches_off: || SolverPart::Field("theta".to_owned()),
        applies: |study| !study.exact.theta.is_empty() && study.theory.beam.theta_a == 0.0,
        change: |study| study.exact.theta.clear(),
    },
    StudyChange {
        name: "zero_a",
        switches_off: || SolverPart::Parameter("a".to_owned()),
        applies: |study| study.theory.beam.a != 0.0,
        change: |study| study.each(|coefficients| coefficients.beam.a = 0.0),
    },
    StudyChange {
        name: "zero_rho",
        switches_off: || SolverPart::Parameter("rho".to_owned()),
        applies: |study| study.theory.beam.rho != 0.0,
        change: |study| study.each(|coefficients| coefficients.beam.rho = 0.0),
    },
    StudyChange {
        name: "no_contact",
        // Without obstacles the force (u - g)/epsilon is not there.
        switches_off: || SolverPart::Parameter("1/epsilon".to_owned()),
        applies: |study| study.theory.obstacles.is_some(),
        change: |study| study.each(|coefficients| coefficients.obstacles = None),
    },
];

fn always(_: &Convergence) -> bool {
    true
}

impl Convergence {
    /// The variants of the exact solution.
    pub(super) fn own_variants(&self) -> Variants {
        let usable = CHANGES.iter().filter(|change| (change.applies)(self));
        let usable = usable.map(|change| Variant {
            name: change.name.to_owned(),
            switches_off: (change.switches_off)(),
            size: self.changed(change).size(),
        });
        let data = [
            ("x_min", "u, phi, theta"),
            ("x_max", "moment, shear force with contact, theta"),
        ];
        let data = data.map(|(face, names)| {
            let names = names.split(", ").map(str::to_owned).collect();
            (face.to_owned(), names)
        });
        Variants {
            size: self.size(),
            usable: usable.collect(),
            left_out: vec![],
            data: data.into(),
        }
    }

    /// The study with a variant; `None` for an unknown name.
    pub(super) fn varied(&self, name: &str) -> Option<Self> {
        let mut study = self.changed(CHANGES.iter().find(|change| change.name == name)?);
        study.constant = None;
        for (_, claim) in &mut study.expect {
            let tolerance = claim.tolerance.max(TOLERANCE);
            *claim = Claim {
                bound: claim.bound,
                ..Claim::new(claim.order, tolerance)
            };
        }
        Some(study)
    }

    fn changed(&self, change: &StudyChange) -> Self {
        let mut study = self.clone();
        (change.change)(&mut study);
        study
    }

    /// Changes the coefficients of theory and solver alike.
    fn each(&mut self, change: impl Fn(&mut Coefficients)) {
        change(&mut self.theory);
        change(&mut self.solver);
    }

    /// The root mean square of the three fields together, over [0, 1] and the time of the study.
    fn size(&self) -> f64 {
        let middles =
            |end: f64| (0..POINTS).map(move |k| (f64::from(k) + 0.5) * end / f64::from(POINTS));
        let mut sum = 0.0;
        for x in middles(1.0) {
            for t in middles(self.refine.t_end) {
                for field in [&self.exact.u, &self.exact.phi, &self.exact.theta] {
                    let products = field.iter().map(|one| one.x.eval(x) * one.t.eval(t));
                    sum += products.sum::<f64>().powi(2);
                }
            }
        }
        (sum / f64::from(POINTS * POINTS)).sqrt()
    }
}

fn fields(exact: &mut Manufactured) -> [&mut Vec<Product>; 3] {
    [&mut exact.u, &mut exact.phi, &mut exact.theta]
}

/// The solution at one time.
fn held(exact: &mut Manufactured, time: f64) {
    for product in fields(exact).into_iter().flatten() {
        let value = product.t.eval(time);
        product.t = Factor::new(move |_| [value, 0.0, 0.0]);
    }
}

impl Convergence {
    /// All fields times a weight in x.
    fn flatten(&mut self, flat: &Flat) {
        for product in fields(&mut self.exact).into_iter().flatten() {
            product.x = weighted(&product.x, flat.weight);
        }
        let theta_a = self.theory.beam.theta_a;
        if let Some(lifting) = flat.lifting.filter(|_| theta_a != 0.0) {
            self.exact.theta.push(Product {
                x: Factor::new(move |x| lifting(x).map(|part| theta_a * part)),
                t: Factor::new(|_| [1.0, 0.0, 0.0]),
            });
        }
    }

    /// All fields times (t/T)⁴; the temperature about θ_A (1 - x).
    fn begin_flat(&mut self) {
        let (t_end, theta_a) = (self.refine.t_end, self.theory.beam.theta_a);
        let weight = move |t: f64| {
            let [value, first, second] = at_zero(t / t_end);
            [value, first / t_end, second / t_end.powi(2)]
        };
        for product in fields(&mut self.exact).into_iter().flatten() {
            product.t = weighted(&product.t, weight);
        }
        if theta_a != 0.0 {
            self.exact.theta.push(Product {
                x: Factor::new(move |x| [theta_a * (1.0 - x), -theta_a, 0.0]),
                t: Factor::new(move |t| {
                    let [value, first, second] = weight(t);
                    [1.0 - value, -first, -second]
                }),
            });
        }
    }
}

/// The product of a factor and a weight.
fn weighted(factor: &Factor, weight: impl Fn(f64) -> [f64; 3] + Send + Sync + 'static) -> Factor {
    let factor = factor.clone();
    Factor::new(move |at| {
        let [f, f1, f2] = factor.derivatives(at);
        let [w, w1, w2] = weight(at);
        [f * w, f1 * w + f * w1, f2 * w + 2.0 * f1 * w1 + f * w2]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_and_liftings_have_their_derivatives_and_are_flat_where_they_must_be() {
        for (flat, is_flat) in [
            (AT_ZERO, [true, false]),
            (AT_ONE, [false, true]),
            (AT_BOTH, [true; 2]),
        ] {
            for function in [Some(flat.weight), flat.lifting].into_iter().flatten() {
                let step = 1e-5;
                for x in [0.1, 0.37, 0.5, 0.9] {
                    let [value, first, second] = function(x);
                    let [before, after] = [function(x - step), function(x + step)];
                    let difference = |k: usize| (after[k] - before[k]) / (2.0 * step);
                    assert!((difference(0) - first).abs() < 1e-7, "{x}: {value}");
                    assert!((difference(1) - second).abs() < 1e-6, "{x}: {value}");
                }
                for (end, inner) in [(0.0, step), (1.0, 1.0 - step)] {
                    if is_flat[usize::from(end == 1.0)] {
                        let [_, first, second] = function(end);
                        assert_eq!([first, second], [0.0; 2]);
                        // The second derivative grows as x², at most as that of (4x)⁴.
                        let second = function(inner)[2].abs();
                        assert!(second < 3073.0 * step * step, "{end}: {second}");
                    }
                }
            }
            if let Some(lifting) = flat.lifting {
                assert_eq!([lifting(0.0)[0], lifting(1.0)[0]], [1.0, 0.0]);
            }
        }
        assert_eq!([at_one(0.0)[0], at_zero(1.0)[0]], [1.0; 2]);
    }
}
