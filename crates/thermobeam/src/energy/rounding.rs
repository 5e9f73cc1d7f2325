//! Bounds on the rounding errors in the energy balance: its scale, and the residual that round-off
//! can cause.
//!
//! # The residual
//!
//! The solver is backward stable: its solution satisfies the equations of the step up to a few
//! rounding errors of the *terms* of each equation, not of their sum. At a node between elements of
//! length h the largest terms are `((1 + N) u + φ)/h` and `ζ V/h`: differences of neighbouring
//! values, which cancel more on finer meshes. The balance tests the equations with Δu = dt V, Δφ =
//! dt W and dt θ, so its residual is at most
//!
//! ```text
//! c u_r Σ_e 1/h [((1 + |N|)(|u| + |φ|) + ζ (|V| + |W|)) (|Δu| + |Δφ|) + dt |θ|²] + |a| |θ| |Δφ| + h [(|V| + |W|)² + |θ|²]
//! ```
//!
//! with the largest values over the ends of an element and both levels, u_r the unit round-off and
//! c the number of such terms and operations. Relative to the energy ½ ‖u_x‖² this is about
//! `c u_r u/(h u_x)`: negligible on a mesh of a hundred elements, 1e-11 where lengths of neighbours
//! differ by a factor of 1000; it grows with dt, because Δu does.
//!
//! # Contact
//!
//! The position of the tip carries a rounding error δ of about `u_r (|u(1)| + dt |v(1)|)`; the
//! second part is the path of the tip without the obstacle, whose rounding error it keeps. The
//! contact law amplifies it to a force δ/ε, 1e-17/ε for an obstacle at 0.1. The *force* of the step
//! is hardly affected, because it is computed in closed form and enters the balance as computed;
//! the contact *energy* is evaluated at the rounded position, with an error of `|F| δ + δ²/(2ε)`.
//! In the residual this error cancels against the same error in the gap. In the change of the
//! energy it does not: a conserved energy may appear to rise by as much.

use crate::level::TimeLevel;
use crate::norms::slope_squared;
use crate::parameters::Obstacles;
use crate::scheme::SteppedBeam;

/// The constant c of the module documentation: some ten terms per equation, each of a few
/// operations, and the same number in the balance; the elimination multiplies by inverted blocks,
/// which doubles the count.
const TERMS: f64 = 64.0;
/// Rounding errors in the tip's position: of the elimination's last row, of the closed form, and of
/// `u0 + dt V`.
const TIP_TERMS: f64 = 16.0;

/// Bounds on the rounding errors in the balance of one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rounding {
    /// Bound on the residual of the balance.
    pub residual: f64,
    /// Additional bound for the change of the energy: contact energy of a rounded position.
    pub contact: f64,
}

impl Rounding {
    /// Bound on the change of the energy due to round-off, the sum of both.
    pub fn total(&self) -> f64 {
        self.residual + self.contact
    }
}

impl SteppedBeam {
    /// Bounds on the rounding errors in the balance of the step from `old` to `new`, without loads
    /// and solved to a tolerance at round-off.
    pub fn rounding(&self, old: &TimeLevel, new: &TimeLevel) -> Rounding {
        let Self {
            beam,
            obstacles,
            dt,
            ref lengths,
            ..
        } = *self;
        let stretch = slope_squared(lengths, &old.u).max(slope_squared(lengths, &new.u));
        let stiffness = 1.0 + beam.beta.abs() + beam.rho * stretch;
        let mut sum = 0.0;
        for (i, h) in lengths.iter().enumerate() {
            let u = largest(i, &new.u, &old.u);
            let phi = largest(i, &new.phi, &old.phi);
            let theta = largest(i, &new.theta, &old.theta);
            let speed = largest(i, &new.v, &old.v) + largest(i, &new.w, &old.w);
            let size = stiffness * (u + phi) + beam.zeta * speed;
            let moved = largest_change(i, &new.u, &old.u);
            let turned = largest_change(i, &new.phi, &old.phi);
            sum +=
                (size * (moved + turned) + dt * theta * theta) / h + beam.a.abs() * theta * turned;
            sum += h * (speed * speed + theta * theta);
        }
        let unit = 0.5 * f64::EPSILON;
        let contact = obstacles.map_or(0.0, |obstacles| contact(&obstacles, dt, unit, old, new));
        Rounding {
            residual: TERMS * unit * sum,
            contact,
        }
    }

    /// The scale of a level's energy, to which a residual of the balance is compared: the sum of
    /// the absolute values of its terms, the Kirchhoff term without its constant.
    pub fn energy_scale(&self, level: &TimeLevel) -> f64 {
        let stretch = slope_squared(&self.lengths, &level.u);
        self.energy(level).size(&self.beam, stretch)
    }
}

/// `2 (|F| δ + δ²/ε)`, F the larger force of the two levels, because the energies of both are
/// rounded.
fn contact(obstacles: &Obstacles, dt: f64, unit: f64, old: &TimeLevel, new: &TimeLevel) -> f64 {
    let tip = new.u.len() - 1;
    let (u, u0) = (new.u[tip], old.u[tip]);
    let force = obstacles
        .force(u)
        .abs()
        .max(obstacles.force(u0).abs())
        .max(new.contact_force.abs());
    let way = dt * new.v[tip].abs().max(old.v[tip].abs());
    let delta = TIP_TERMS * unit * (u.abs().max(u0.abs()) + way);
    2.0 * (force * delta + delta * delta / obstacles.epsilon)
}

/// The largest absolute value of two functions at the ends of element i.
#[inline]
fn largest(i: usize, y: &[f64], y0: &[f64]) -> f64 {
    let new = y[i].abs().max(y[i + 1].abs());
    let old = y0[i].abs().max(y0[i + 1].abs());
    new.max(old)
}

/// The largest absolute difference of two functions at the ends of element i.
#[inline]
fn largest_change(i: usize, y: &[f64], y0: &[f64]) -> f64 {
    (y[i] - y0[i]).abs().max((y[i + 1] - y0[i + 1]).abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Beam;

    #[test]
    fn the_energy_scale_is_the_sum_of_absolute_terms() {
        let line = vec![0.0, 0.25, 1.0];
        let beam = Beam {
            beta: -3.0,
            rho: 2.0,
            a: 0.5,
            theta_a: 4.0,
            ..Beam::default()
        };
        let obstacles = Obstacles {
            epsilon: 0.5,
            g1: -1.0,
            g2: 0.5,
        };
        let case = SteppedBeam {
            obstacles: Some(obstacles),
            ..SteppedBeam::free(beam, 1.0, &[0.25, 0.75])
        };
        let of = |level: &TimeLevel| case.energy_scale(level);
        // u = x: ½ ‖u_x‖² and, of the Kirchhoff term, |β|/2 + ρ/4; the obstacle is entered by 1/2.
        let moved = TimeLevel {
            u: line.clone(),
            ..TimeLevel::new(3)
        };
        assert!((of(&moved) - (0.5 + 1.5 + 0.5 + 0.25)).abs() < 1e-15);
        // φ = x: ½ ‖φ‖², ½ ‖φ_x‖² and |a θ_A ∫φ|.
        let turned = TimeLevel {
            phi: line.clone(),
            ..TimeLevel::new(3)
        };
        assert!((of(&turned) - (1.0 / 6.0 + 0.5 + 1.0)).abs() < 1e-15);
        let fast = TimeLevel {
            v: line.clone(),
            theta: line,
            ..TimeLevel::new(3)
        };
        assert!((of(&fast) - 2.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn the_bound_of_a_step_is_the_sum_of_its_terms() {
        let (h, dt) = (0.5, 0.1);
        let beam = Beam {
            beta: -3.0,
            rho: 2.0,
            zeta: 0.25,
            a: 0.5,
            ..Beam::default()
        };
        let still = TimeLevel::new(2);
        let terms = |level: &TimeLevel| {
            let [there, back] = [(&still, level), (level, &still)];
            let of = |(old, new)| {
                SteppedBeam::free(beam, dt, &[h])
                    .rounding(old, new)
                    .residual
                    / (32.0 * f64::EPSILON)
            };
            assert_eq!(of(there), of(back));
            of(there)
        };
        let near = |found: f64, expected: f64| {
            assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
        };
        let end = |value: f64| vec![0.0, value];
        // 1 + |β| + ρ ‖u_x‖² = 20.
        let moved = TimeLevel {
            u: end(2.0),
            ..still.clone()
        };
        let turned = TimeLevel {
            phi: end(-3.0),
            ..still.clone()
        };
        let moving = |v: f64, w: f64| TimeLevel {
            v: end(v),
            w: end(w),
            ..moved.clone()
        };
        let warm = TimeLevel {
            theta: vec![4.0, 0.0],
            ..turned.clone()
        };
        for (level, expected) in [
            (moved.clone(), 20.0 * 2.0 * 2.0 / h),
            (
                moving(-5.0, 0.0),
                (20.0 * 2.0 + 0.25 * 5.0) * 2.0 / h + h * 25.0,
            ),
            (
                moving(0.0, -5.0),
                (20.0 * 2.0 + 0.25 * 5.0) * 2.0 / h + h * 25.0,
            ),
            (
                moving(-5.0, 3.0),
                (20.0 * 2.0 + 0.25 * 8.0) * 2.0 / h + h * 64.0,
            ),
            (turned, 4.0 * 3.0 * 3.0 / h),
            (
                warm,
                (4.0 * 3.0 * 3.0 + dt * 16.0) / h + 0.5 * 4.0 * 3.0 + h * 16.0,
            ),
        ] {
            near(terms(&level), expected);
        }

        // The displacement of a node matters at either end of an element: 1 here, for values of 3.
        let [old, new] = [[2.0, 1.0], [3.0, 1.5]].map(|[a, b]| TimeLevel {
            phi: vec![0.0, a, b],
            ..TimeLevel::new(3)
        });
        let both = SteppedBeam::free(beam, dt, &[h, h])
            .rounding(&old, &new)
            .residual
            / (32.0 * f64::EPSILON);
        near(both, 2.0 * 4.0 * 3.0 / h);

        let obstacles = Obstacles {
            epsilon: 0.5,
            g1: -1.0,
            g2: 0.5,
        };
        let between = SteppedBeam {
            obstacles: Some(obstacles),
            ..SteppedBeam::free(beam, dt, &[h])
        };
        // A tip exactly at the obstacle has no force, but its rounding error has an energy that the
        // obstacle stores. The force of the step matters if it is larger than those of the law: 7
        // against 3.
        let touching = moving(5.0, 0.0);
        let at = TimeLevel {
            u: end(0.5),
            ..still.clone()
        };
        let pressed = TimeLevel {
            contact_force: -7.0,
            ..touching.clone()
        };
        let delta = 8.0 * f64::EPSILON * (2.0 + dt * 5.0);
        let delta_at = 8.0 * f64::EPSILON * 0.5;
        for (old, new, force, delta) in [
            (&still, &touching, 3.0, delta),
            (&touching, &still, 3.0, delta),
            (&at, &at, 0.0, delta_at),
            (&still, &pressed, 7.0, delta),
        ] {
            let rounding = between.rounding(old, new);
            let expected = 2.0 * (force * delta + delta * delta / 0.5);
            assert!(
                (rounding.contact / expected - 1.0).abs() < 1e-14,
                "{rounding:?}, not {expected}"
            );
            assert_eq!(rounding.total(), rounding.residual + rounding.contact);
        }
    }
}
