//! The contact law at the free end: its force g of (1.3), its energy G of (2.5), and the tip
//! equation in closed form.
//!
//! `g(u) = ([u - g2]_+ - [g1 - u]_+)/ε` and `G(u) = ([u - g2]_+² + [g1 - u]_+²)/(2ε)`, hence G' = g
//! (the paper defines them after (2.3) and (2.5)).
//!
//! For given mean axial force a step is linear except for one scalar equation at the tip,
//! `u + c F(u) = r`: r is the tip's position without obstacles, `c = dt [A⁻¹]_nn` its compliance
//! over the step, and F the contact force. F is piecewise linear for the implicit rule; for the
//! discrete gradient some pieces are a quadratic over a linear function. It is nondecreasing, so
//! the root is unique and r determines the piece that contains it: for every ε it is computed
//! without iteration.

use crate::parameters::Obstacles;
use crate::scheme::ContactRule;

/// A change of phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactEvent {
    /// Time of the change.
    pub t: f64,
    /// The phase before.
    pub from: Phase,
    /// The phase from now on.
    pub to: Phase,
}

/// The contact phase of the free end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Phase {
    /// It touches nothing: `g₁ <= u(1) <= g₂`.
    Free,
    /// It is on the upper obstacle: `u(1) >= g₂`.
    Upper,
    /// It is on the lower obstacle: `u(1) <= g₁`.
    Lower,
}

impl Phase {
    /// The phase of a free end at u, which is free if it just touches; with `g_1 = g_2` there is no
    /// free phase.
    pub(crate) fn of(u: f64, obstacles: Option<&Obstacles>) -> Self {
        match obstacles {
            Some(obstacles) if u > obstacles.g2 => Phase::Upper,
            Some(obstacles) if u < obstacles.g1 => Phase::Lower,
            Some(obstacles) if obstacles.g1 == obstacles.g2 => Phase::Upper,
            _ => Phase::Free,
        }
    }

    /// Position of the touched obstacle.
    pub(crate) fn obstacle(self, obstacles: Option<&Obstacles>) -> Option<f64> {
        match self {
            Phase::Free => None,
            Phase::Lower => obstacles.map(|obstacles| obstacles.g1),
            Phase::Upper => obstacles.map(|obstacles| obstacles.g2),
        }
    }
}

/// Tip displacement and contact force at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tip {
    /// u(1).
    pub u: f64,
    /// The force F, positive at the upper obstacle.
    pub force: f64,
    /// dF/du(1), for the derivative in Newton's method.
    pub stiffness: f64,
}

impl Tip {
    /// The same at obstacles that are reflected at u = 0.
    fn mirrored(self) -> Self {
        Self {
            u: -self.u,
            force: -self.force,
            stiffness: self.stiffness,
        }
    }
}

impl Obstacles {
    /// Contact force g(u(1)); the boundary condition of (1.3) is σ(1, t) = -g.
    pub fn force(&self, u: f64) -> f64 {
        self.depth(u) / self.epsilon
    }

    /// Slope of the contact force over u(1) while the free end is in contact: 1/ε, or half of it
    /// for the discrete gradient, in which u at the old level has the other half.
    pub(crate) fn slope(&self, rule: ContactRule) -> f64 {
        match rule {
            ContactRule::Implicit => 1.0 / self.epsilon,
            ContactRule::DiscreteGradient => 0.5 / self.epsilon,
        }
    }

    /// Time scale of the peak of an impact: `t* = (ε √ζ)^(2/3)`, or ε if viscosity is negligible (ζ
    /// < ε).
    ///
    /// The penetration is largest at 1.65 t*; contact lasts longer, for every ε. `THEORY.md`,
    /// "Penetration of an impact"; without viscosity the penetration δ of the tip obeys
    /// `δ' = ν - δ/ε`, with the velocity ν of the impact.
    pub fn impact_time(&self, zeta: f64) -> f64 {
        (self.epsilon * zeta.sqrt())
            .powf(2.0 / 3.0)
            .max(self.epsilon)
    }

    /// Contact energy G(u(1)) of (2.5).
    pub fn potential(&self, u: f64) -> f64 {
        let depth = self.depth(u);
        0.5 * depth * depth / self.epsilon
    }

    /// Penetration: positive above g2, negative below g1, zero between them; NaN for NaN.
    fn depth(&self, u: f64) -> f64 {
        if u > self.g2 {
            u - self.g2
        } else if u < self.g1 {
            u - self.g1
        } else {
            0.0 * u
        }
    }

    /// The discrete gradient `(G(u) - G(u0))/(u - u0)`, without cancellation; g(u) for u = u0.
    ///
    /// Exact up to a few rounding errors of u, u0, g1 and g2, divided by ε.
    pub fn discrete_gradient(&self, u: f64, u0: f64) -> f64 {
        let (depth, depth0) = (self.depth(u), self.depth(u0));
        let double = 2.0 * self.epsilon;
        let beyond_the_same = (depth > 0.0 && depth0 > 0.0) || (depth < 0.0 && depth0 < 0.0);
        if beyond_the_same {
            // depth - depth0 = u - u0.
            (depth + depth0) / double
        } else if depth == 0.0 && depth0 == 0.0 {
            0.0
        } else {
            // One obstacle lies between u and u0: their difference is nonzero and at least as large
            // as each depth.
            (depth.abs() - depth0.abs()) * (depth.abs() + depth0.abs()) / (double * (u - u0))
        }
    }

    /// Solves `u + c F(u) = r` for u and F.
    ///
    /// * `rule`: the contact rule of the scheme, which defines F.
    /// * `r`, `c`: position without obstacles, and compliance c > 0.
    /// * `u0`: the tip at the start of the step.
    pub fn solve_tip(&self, rule: ContactRule, r: f64, c: f64, u0: f64) -> Tip {
        match rule {
            ContactRule::Implicit => self.solve_implicit(r, c),
            ContactRule::DiscreteGradient => self.solve_gradient(r, c, u0),
        }
    }

    /// F = g: beyond an obstacle at γ, `u - γ = (r - γ)/(1 + c/ε)`.
    fn solve_implicit(&self, r: f64, c: f64) -> Tip {
        let wall = if r > self.g2 {
            self.g2
        } else if r < self.g1 {
            self.g1
        } else {
            return Tip {
                u: r,
                force: 0.0 * r,
                stiffness: 0.0,
            };
        };
        // With ε + c the force has full relative accuracy for small ε.
        let force = (r - wall) / (self.epsilon + c);
        Tip {
            u: wall + self.epsilon * force,
            force,
            stiffness: 1.0 / self.epsilon,
        }
    }

    /// F = discrete gradient: the values of the left-hand side at both obstacles select the piece.
    fn solve_gradient(&self, r: f64, c: f64, u0: f64) -> Tip {
        let mirrored = Obstacles {
            epsilon: self.epsilon,
            g1: -self.g2,
            g2: -self.g1,
        };
        if r >= self.g2 + c * self.discrete_gradient(self.g2, u0) {
            self.solve_above(r, c, u0)
        } else if r <= self.g1 + c * self.discrete_gradient(self.g1, u0) {
            mirrored.solve_above(-r, c, -u0).mirrored()
        } else if u0 > self.g2 {
            self.solve_leaving(r, c, u0)
        } else if u0 < self.g1 {
            mirrored.solve_leaving(-r, c, -u0).mirrored()
        } else {
            Tip {
                u: r,
                force: 0.0 * r,
                stiffness: 0.0,
            }
        }
    }

    /// The tip ends above g2, at depth p >= 0.
    fn solve_above(&self, r: f64, c: f64, u0: f64) -> Tip {
        let double = 2.0 * self.epsilon;
        let p0 = u0 - self.g2;
        if p0 >= 0.0 {
            // Above g2 before and after the step: F = (p + p0)/(2ε), linear in p.
            let force = (r - self.g2 + p0) / (double + c);
            return Tip {
                u: self.g2 + (double * force - p0),
                force,
                stiffness: 1.0 / double,
            };
        }
        // From d = -p0 below g2: F = (p² - q²)/(2ε (p + d)), q the depth of u0 below g1. With s =
        // r - g2 = p + c F (2ε + c) p² + 2ε (d - s) p - (2ε s d + c q²) = 0, of which p is the
        // root >= 0. F computed from p would lose the digits common to p² and q². It is the smaller
        // root of c (2ε + c) F² - 2 b F + (s - q) (s + q) = 0, 2 b = 2ε (s + d) + 2 c s, with the
        // same discriminant as p.
        let d = -p0;
        let s = r - self.g2;
        let q = (self.g1 - u0).max(0.0);
        let p = positive_root(
            double + c,
            double * (d - s),
            (double * s * d + c * q * q).max(0.0),
        );
        let root = (double + c) * p + self.epsilon * (d - s);
        let b = self.epsilon * (s + d) + c * s;
        let force = if b > 0.0 {
            (s - q) * (s + q) / (b + root)
        } else {
            (b - root) / (c * (double + c))
        };
        Tip {
            u: self.g2 + p,
            force,
            stiffness: (p / self.epsilon - force) / (p + d),
        }
    }

    /// The tip starts above g2 and ends between the obstacles, d below its start: F = G0/d, d² -
    /// (u0 - r) d = c G0.
    fn solve_leaving(&self, r: f64, c: f64, u0: f64) -> Tip {
        let g0 = self.potential(u0);
        let d = positive_root(1.0, r - u0, c * g0);
        let force = g0 / d;
        Tip {
            u: u0 - d,
            force,
            stiffness: force / d,
        }
    }
}

/// The root x >= 0 of `a x² + b x - c = 0` for a > 0, c >= 0, without cancellation.
fn positive_root(a: f64, b: f64, c: f64) -> f64 {
    let root = (b * b + 4.0 * a * c).sqrt();
    if b > 0.0 {
        2.0 * c / (b + root)
    } else {
        (root - b) / (2.0 * a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The tip at the start of a step: arbitrary, or within a few rounding errors of an obstacle of
    /// the default pair.
    fn start() -> impl Strategy<Value = f64> {
        let Obstacles { g1, g2, .. } = Obstacles::default();
        let near = (any::<bool>(), -4..5i32).prop_map(move |(upper, ulps)| {
            (if upper { g2 } else { g1 }) * (1.0 + f64::from(ulps) * f64::EPSILON)
        });
        prop_oneof![3 => -0.3..0.3f64, 1 => near]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn the_tip_equation_is_solved_from_any_start(
            r in -0.5..0.5f64, log_c in -12.0..2.0f64, u0 in start(), log_epsilon in -8.0..0.0f64, gradient: bool,
        ) {
            let obstacles = Obstacles { epsilon: 10f64.powf(log_epsilon), ..Obstacles::default() };
            let rule = if gradient { ContactRule::DiscreteGradient } else { ContactRule::Implicit };
            let c = 10f64.powf(log_c);
            let tip = obstacles.solve_tip(rule, r, c, u0);
            // All lengths are below 1, which bounds their rounding errors.
            let rounding = f64::EPSILON;
            // The residual of the equation with the returned force.
            let residual = tip.u + c * tip.force - r;
            prop_assert!(residual.abs() <= 8.0 * rounding * (1.0 + c * tip.force.abs()), "{:e}", residual);
            // The force agrees with the law up to a few rounding errors of u(1), which the law
            // amplifies by 1/ε.
            let law = if gradient { obstacles.discrete_gradient(tip.u, u0) } else { obstacles.force(tip.u) };
            let lost = 4.0 * rounding / obstacles.epsilon + 8.0 * rounding * tip.force.abs();
            prop_assert!((law - tip.force).abs() <= lost, "{} {}, {:e}", law, tip.force, lost);
        }

        #[test]
        fn the_stiffness_of_the_tip_is_the_derivative_of_its_force(
            r in -0.5..0.5f64, log_c in -3.0..0.0f64, u0 in -0.3..0.3f64, gradient: bool,
        ) {
            let obstacles = Obstacles::default();
            let rule = if gradient { ContactRule::DiscreteGradient } else { ContactRule::Implicit };
            let tip = |r| obstacles.solve_tip(rule, r, 10f64.powf(log_c), u0);
            let (low, high) = (tip(r - 1e-7), tip(r + 1e-7));
            // No derivative at a kink, and only a one-sided one if the end of the step coincides
            // with its start.
            let side = |u: f64| (u > obstacles.g2, u < obstacles.g1);
            prop_assume!(side(low.u) == side(high.u) && (tip(r).u - u0).abs() > 1e-2);
            let quotient = (high.force - low.force) / (high.u - low.u);
            prop_assert!((tip(r).stiffness - quotient).abs() <= 1e-3 * (1.0 + quotient.abs()), "{}", quotient);
        }

        #[test]
        fn the_discrete_gradient_is_the_difference_quotient(u in -0.3..0.3f64, u0 in -0.3..0.3f64) {
            let obstacles = Obstacles::default();
            let work = obstacles.discrete_gradient(u, u0) * (u - u0);
            let energy = obstacles.potential(u) - obstacles.potential(u0);
            let scale = obstacles.potential(u) + obstacles.potential(u0);
            prop_assert!((work - energy).abs() <= 8.0 * f64::EPSILON * scale, "{} {}", work, energy);
        }
    }

    #[test]
    fn the_positive_root_is_computed_without_cancellation() {
        // x² + b x = c, for large b of either sign.
        for (b, c, root) in [
            (1e9, 1.0, 1e-9),
            (-1e9, 1.0, 1e9),
            (0.0, 4.0, 2.0),
            (0.0, 0.0, 0.0),
            (3.0, 0.0, 0.0),
            (3.0, 4.0, 1.0),
        ] {
            assert!(
                (positive_root(1.0, b, c) - root).abs() <= 1e-15 * root,
                "{b} {c}"
            );
        }
        assert_eq!(positive_root(2.0, 2.0, 12.0), 2.0);
    }

    #[test]
    fn a_tip_between_the_obstacles_has_no_contact_force() {
        for rule in [ContactRule::Implicit, ContactRule::DiscreteGradient] {
            for r in [0.0, -0.0, 0.05, -0.005] {
                let tip = Obstacles::default().solve_tip(rule, r, 1.0, 0.0);
                assert_eq!([tip.u, tip.force, tip.stiffness], [r, 0.0, 0.0]);
            }
        }
    }

    #[test]
    fn a_nan_at_the_tip_propagates() {
        let tip = Obstacles::default().solve_tip(ContactRule::Implicit, f64::NAN, 1.0, 0.0);
        assert!(tip.u.is_nan() && tip.force.is_nan());
        assert!(Obstacles::default().force(f64::NAN).is_nan());
    }
}
