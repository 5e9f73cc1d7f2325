//! How many solutions a step of (3.7) has: Remark 3.3 and what lies beyond it. The derivation is in
//! THEORY.md, "How many solutions a step has".
//!
//! The step starts at rest, u = φ = θ = 0, so u = 0 solves it. For a given mean axial force m it is
//! linear but for the contact force F at the tip: u = -F r(m), where r is the answer to a unit load
//! with the dense matrix A(m). Every other solution has an m = β + ½ρ‖u_x‖² in (β, m*), where
//! `λ(m*) = B (ζ + dt/2) + m* dt/2 = 0`. There none is missed, since A(m) = A(0) + ½ m dt K is
//! symmetric:
//!
//! * free of contact: A(m) is singular, for an eigenvalue of (A(0), K); its vector has the size
//!   that m asks for, and both signs;
//! * in contact with g: `F = -g/(ε + r(1))`, and m is a root of `f(m) = β + ½ρ F² ‖r_x‖² - m`. In
//!   the eigenvectors r(1) is a sum of terms c²/(μ + s), s = ½ m dt, so that 1/(ε + r(1)) grows
//!   between its poles as `b + b's - Σ d²/(s - s_k)`. Since ‖r_x‖² is minus the derivative of r(1)
//!   by s, `F² ‖r_x‖²` is g² times its derivative: f is convex between two poles, where it has two
//!   roots or none. The poles are the eigenvalues of (A(0) + dt/ε e eᵀ, K), e the unit vector of
//!   the tip.

use super::prelude::*;
use crate::error::reference::largest_difference;
use crate::exact::{
    assembly::{coupling, mass, stiffness},
    dense::{Eigenpair, eigenpairs, solve},
    equilibrium::maximize,
};
use nalgebra::DMatrix;
use thermobeam::{
    bracket::bisect,
    kirchhoff::BUCKLING,
    mesh::Mesh,
    parameters::{Beam, Obstacles},
};

/// What the study says about itself.
pub const ABOUT: About = About {
    id: "solutions-of-a-step",
    claim: "Remark 3.3: a step has one solution where lambda >= 0, and three when it is long enough",
    tier: Tier::Quick,
    group: "contact",
    home: file!(),
};

/// Steps from rest, and u(1) of each solution, ascending, by a program in Python. Up to dt = 0.755
/// theory allows one solution (λ >= 0); beyond, the beam may also jump to either obstacle.
const STEPS: [(f64, &[f64]); 5] = [
    (0.5, &[0.0]),
    (0.755, &[0.0]),
    (1.5, &[0.0]),
    (2.0, &[-0.010000148780031, 0.0, 0.100000610685519]),
    (5.0, &[-0.010001325521308, 0.0, 0.100010934440796]),
];
/// Distance of a tip to its answer.
const WITHIN: f64 = 1e-9;
/// Relative change of a number that the baseline tolerates: that of round-off in dense matrices.
const GUARDED: f64 = 1e-9;

const COUNT: &str = "solutions";

/// A beam compressed beyond buckling, at rest and straight.
#[derive(Debug, Clone, PartialEq)]
pub struct Solutions {
    /// Its coefficients; θ_A = 0, so that a beam at rest stays there.
    pub beam: Beam,
    /// Its obstacles, g1 < 0 < g2.
    pub obstacles: Obstacles,
    /// Elements of its uniform mesh.
    pub elements: usize,
}

/// The solutions of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct StepSolutions {
    /// λ for m = β: at least 0 where the step has one solution.
    pub lambda: f64,
    /// u(1) of each solution, ascending.
    pub tips: Vec<f64>,
}

/// The study.
pub fn study() -> Described<Solutions> {
    ABOUT.study(Solutions {
        beam: Beam {
            beta: -0.9,
            rho: 1.0,
            zeta: 0.1,
            a: 0.017,
            theta_a: 0.0,
        },
        obstacles: Obstacles {
            epsilon: 1e-3,
            g1: -0.01,
            g2: 0.1,
        },
        elements: 20,
    })
}

impl Kind for Solutions {
    /// dt, and the tips known.
    type Data = (f64, &'static [f64]);
    type Found = StepSolutions;

    fn cases(&self) -> Vec<Case<Self::Data>> {
        let cost = 100.0 * (self.elements as f64).powi(3);
        let parts = Parts::new(&self.beam, Some(&self.obstacles));
        let parts = parts.by_the_paper(Solver::Newton);
        STEPS
            .map(|step| Case::new(case(step.0), cost, step).described(&parts))
            .to_vec()
    }

    fn run(&self, (dt, _): &Self::Data) -> Result<StepSolutions, CaseFailure> {
        let step = StepFromRest::new(self, *dt)?;
        Ok(StepSolutions {
            lambda: step.lambda(self.beam.beta),
            tips: step.tips()?,
        })
    }

    fn judge(&self, ran: &[Ran<Self::Data, StepSolutions>]) -> Outcome {
        Outcome::of_complete(self, ran, |shown| {
            let mut found = vec![];
            for ((dt, known), StepSolutions { lambda, tips }) in shown {
                let case = case(*dt);
                let count = tips.len() as f64;
                found.extend([
                    measured(&case, "λ", *lambda).recorded("lambda", GUARDED),
                    measured(&case, COUNT, count)
                        .fixed(0)
                        .must_be(Must::Count(known.len())),
                    measured(&case, "least u(1)", tips.first().copied())
                        .scientific(6)
                        .recorded("least_tip", GUARDED),
                    measured(&case, "largest u(1)", tips.last().copied())
                        .scientific(6)
                        .recorded("largest_tip", GUARDED),
                    measured(
                        &case,
                        "distance to the answers",
                        largest_difference(tips, known),
                    )
                    .scientific(1)
                    .must_be(Must::AtMost(WITHIN)),
                ]);
                if !(*lambda < 0.0) {
                    let unique = measured(&case, "solutions where λ >= 0", count);
                    found.push(unique.fixed(0).must_be(Must::Count(1)));
                }
            }
            let sheet = Sheet::new("Solutions of a step from rest", "step", found);
            Outcome::of_sheets([sheet], COUNT)
        })
    }
}

fn case(dt: f64) -> String {
    format!("dt = {dt}")
}

/// A step from rest.
struct StepFromRest<'a> {
    study: &'a Solutions,
    dt: f64,
    /// A(0) of V alone: W and Θ, which m does not concern, are eliminated.
    matrix: DMatrix<f64>,
    /// K at the nodes of u.
    stiffness: DMatrix<f64>,
}

/// The answer of u to a unit load at the tip.
struct UnitLoadResponse {
    /// r(1).
    tip: f64,
    /// ‖r_x‖².
    slope_squared: f64,
}

impl<'a> StepFromRest<'a> {
    /// # Errors
    /// [`CaseFailure`] if W and Θ cannot be eliminated.
    fn new(study: &'a Solutions, dt: f64) -> Result<Self, CaseFailure> {
        let mesh = Mesh::uniform(study.elements)?;
        let n = mesh.elements();
        let matrix = dense(study, &mesh, dt);
        let others = matrix.nrows() - n;
        let part = |at, shape| matrix.view(at, shape).into_owned();
        let of_u = part((n, 0), (others, n));
        let eliminated = solve(part((n, n), (others, others)), &of_u)
            .ok_or_else(|| CaseFailure::new("the equations of φ and θ are singular"))?;
        let k = stiffness(&mesh);
        Ok(Self {
            study,
            dt,
            matrix: part((0, 0), (n, n)) - part((0, n), (n, others)) * eliminated,
            stiffness: DMatrix::from_fn(n, n, |i, j| k.entry(i + 1, j + 1)),
        })
    }

    /// λ of THEORY.md.
    fn lambda(&self, m: f64) -> f64 {
        BUCKLING * (self.study.beam.zeta + 0.5 * self.dt) + 0.5 * m * self.dt
    }

    /// The answer for the mean axial force m; NaN if the matrix is singular to the last bit.
    fn answer(&self, m: f64) -> UnitLoadResponse {
        let n = self.study.elements;
        let matrix = &self.matrix + &self.stiffness * (0.5 * m * self.dt);
        let mut load = DMatrix::zeros(n, 1);
        load[n - 1] = self.dt;
        let Some(u) = solve(matrix, &load) else {
            return UnitLoadResponse {
                tip: f64::NAN,
                slope_squared: f64::NAN,
            };
        };
        UnitLoadResponse {
            tip: u[n - 1],
            slope_squared: u.dot(&(&self.stiffness * &u)),
        }
    }

    /// u(1) of all solutions, ascending.
    ///
    /// # Errors
    /// [`CaseFailure`] if K is not positive definite.
    fn tips(&self) -> Result<Vec<f64>, CaseFailure> {
        let mut tips = vec![0.0];
        // λ(m*) = 0.
        let end = -BUCKLING * (1.0 + 2.0 * self.study.beam.zeta / self.dt);
        if end > self.study.beam.beta {
            tips.extend(self.free_tips(end)?);
            tips.extend(self.contact_tips(end)?);
        }
        tips.sort_by(f64::total_cmp);
        Ok(tips)
    }

    /// The tips of the solutions that touch no obstacle.
    fn free_tips(&self, end: f64) -> Result<Vec<f64>, CaseFailure> {
        let Beam { beta, rho, .. } = self.study.beam;
        let Obstacles { g1, g2, .. } = self.study.obstacles;
        let mut tips = vec![];
        for Eigenpair { value, vector } in self.modes(&self.matrix)? {
            let m = self.force(value);
            if !(beta..end).contains(&m) {
                continue;
            }
            // xᵀKx = 1.
            let tip = vector[vector.len() - 1] * (2.0 * (m - beta) / rho).sqrt();
            tips.extend(
                [-tip, tip]
                    .into_iter()
                    .filter(|tip| (g1..=g2).contains(tip)),
            );
        }
        Ok(tips)
    }

    /// The tips of the solutions that touch an obstacle.
    fn contact_tips(&self, end: f64) -> Result<Vec<f64>, CaseFailure> {
        let Beam { beta, .. } = self.study.beam;
        let Obstacles {
            g1, g2, epsilon, ..
        } = self.study.obstacles;
        let n = self.study.elements;
        let mut held = self.matrix.clone();
        held[(n - 1, n - 1)] += self.dt / epsilon;
        let modes = self.modes(&held)?;
        let mut ends = vec![beta, end];
        ends.extend(
            modes
                .iter()
                .map(|mode| self.force(mode.value))
                .filter(|m| (beta..end).contains(m)),
        );
        ends.sort_by(f64::total_cmp);
        let mut tips = vec![];
        for g in [g1, g2] {
            let excess = |m: f64| self.in_contact(&self.answer(m), g).1 - m;
            for pair in ends.windows(2) {
                for m in convex_roots(excess, pair[0], pair[1]) {
                    // Contact pushes: a root with the tip before the obstacle is none.
                    let (tip, _) = self.in_contact(&self.answer(m), g);
                    let touches = tip.abs() > g.abs() && tip * g > 0.0;
                    tips.extend(touches.then_some(tip));
                }
            }
        }
        Ok(tips)
    }

    /// Eigenvalues and vectors x of a matrix in units of K, with `xᵀKx = 1`.
    fn modes(&self, matrix: &DMatrix<f64>) -> Result<Vec<Eigenpair>, CaseFailure> {
        eigenpairs(matrix, &self.stiffness)
            .ok_or_else(|| CaseFailure::new("K is not positive definite"))
    }

    /// The mean axial force m for which A(0) + ½ m dt K has an eigenvalue 0 in units of K, where
    /// A(0) has this one.
    fn force(&self, value: f64) -> f64 {
        -2.0 * value / self.dt
    }

    /// u(1), and the mean axial force that follows, in contact with an obstacle at `g`.
    fn in_contact(&self, answer: &UnitLoadResponse, g: f64) -> (f64, f64) {
        let Beam { beta, rho, .. } = self.study.beam;
        let force = -g / (self.study.obstacles.epsilon + answer.tip);
        let slope_squared = force * force * answer.slope_squared;
        (-force * answer.tip, beta + 0.5 * rho * slope_squared)
    }
}

/// The roots of a function that is convex between these ends, where it may be infinite: none, one
/// or two.
fn convex_roots(function: impl Fn(f64) -> f64, low: f64, high: f64) -> Vec<f64> {
    // Just inside: at a pole the value is round-off.
    let margin = 1e-9 * (high - low);
    let [low, high] = [low + margin, high - margin];
    let mut roots = vec![];
    let (least, _) = maximize(|x| -function(x), low, high);
    for (a, b) in [(low, least), (least, high)] {
        if function(a) * function(b) < 0.0 {
            roots.push(bisect(&function, a, b));
        }
    }
    roots
}

/// The matrix of V, W and Θ of (3.7) without axial force: u and φ at nodes 1 to n, θ at 1 to n - 1.
fn dense(study: &Solutions, mesh: &Mesh, dt: f64) -> DMatrix<f64> {
    let n = mesh.elements();
    let Beam { zeta, a, .. } = study.beam;
    let m = mass(mesh);
    let k = stiffness(mesh);
    let c = coupling(mesh);
    let (inertia, sigma) = (1.0 / dt, zeta + 0.5 * dt);
    let mut matrix = DMatrix::zeros(3 * n - 1, 3 * n - 1);
    for i in 1..=n {
        for j in 1..=n {
            let (u, w) = (i - 1, n + i - 1);
            let (of_u, of_w) = (j - 1, n + j - 1);
            let of_theta = 2 * n + j - 1;
            let (mass, stiffness) = (m.entry(i, j), k.entry(i, j));
            matrix[(u, of_u)] = inertia * mass + sigma * stiffness;
            matrix[(u, of_w)] = -sigma * c.entry(i, j);
            matrix[(w, of_u)] = -sigma * c.entry(j, i);
            matrix[(w, of_w)] = (inertia + sigma) * mass + sigma * stiffness;
            if j < n {
                matrix[(w, of_theta)] = -a * c.entry(i, j);
                // The row of θ_j and the column of φ_i.
                matrix[(of_theta, w)] = a * c.entry(i, j);
            }
            if i < n && j < n {
                matrix[(2 * n + i - 1, of_theta)] = 2.0 / dt * mass + stiffness;
            }
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::convex_roots;

    /// Two roots within a hundredth of the bracket, which signs at equal distances would not show.
    #[test]
    fn two_roots_close_to_each_other_are_both_found() {
        let near = |x: f64| (x - 0.5001) * (x - 0.5003);
        let roots = convex_roots(near, 0.0, 1.0);
        assert_eq!(roots.len(), 2, "{roots:?}");
        assert!((roots[0] - 0.5001).abs() < 1e-9 && (roots[1] - 0.5003).abs() < 1e-9);
        assert!(convex_roots(|x| near(x) + 1e-7, 0.0, 1.0).is_empty());
        // Infinite at one end, negative at the other.
        assert_eq!(convex_roots(|x| 1.0 / x - 2.0, 0.0, 1.0).len(), 1);
    }
}
