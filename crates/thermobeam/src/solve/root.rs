//! The safeguarded Newton iteration for the mean axial force m, used where passes with a kept
//! factorisation do not contract.

use crate::block_tridiagonal::{Block, minus_times, minus_transpose_times, times};
use crate::error::StepFailure;
use crate::lanes::{Kernel, Lane, MultiplyAdd, run_kernel};
use crate::solve::control::Progress;
use crate::solve::newton::Newton;

/// Bound on the rounding error of m, which is a sum over the elements: a bracket of this width
/// cannot be improved.
fn rounding(forces: [f64; 3]) -> f64 {
    8.0 * f64::EPSILON * forces.iter().map(|force| force.abs()).sum::<f64>()
}

/// The Newton iterate if it lies inside the bracket; otherwise the midpoint, or a larger m while
/// there is no upper end.
fn safeguarded(low: f64, high: f64, newton: f64) -> f64 {
    if low < newton && newton < high {
        newton
    } else if high.is_finite() {
        0.5 * (low + high)
    } else {
        low + (1.0 + low.abs())
    }
}

impl<T: Lane, const B: usize> Newton<T, B> {
    /// Solves `F(m) = m - ½(N(u(m)) + N(u0)) = 0` for case k, starting from m = N(u0).
    ///
    /// F <= 0 at the lower end of the initial bracket; an upper end is found during the iteration.
    ///
    /// # Errors
    /// [`StepFailure`] for an indefinite matrix, a value that is not finite, and for too many
    /// iterations.
    pub(super) fn find_root(&mut self, k: usize) -> Result<(), StepFailure> {
        self.restart(k);
        let n0 = self.controls[k].forces[0];
        let mut low = 0.5 * (self.cases[k].beam.beta + n0);
        let mut high = f64::INFINITY;
        let mut m = n0;
        let mut previous = f64::NAN;
        for _ in self.controls[k].iterations..self.max_iterations {
            self.controls[k].m = m;
            self.factorize(k, m)?;
            self.pass(Progress::Safeguarded, false);
            let bound = self.bound(k);
            let control = &mut self.controls[k];
            previous = control.increment;
            control.increment = bound.increment;
            let f = m - bound.m;
            if !f.is_finite() {
                return Err(StepFailure::NonFinite {
                    iterations: control.iterations,
                    increment: previous,
                });
            }
            let rounding = rounding([m, n0, self.cases[k].beam.beta]);
            if bound.remaining <= self.tolerance || f.abs() <= rounding {
                return Ok(());
            }
            if f < 0.0 {
                low = m;
            } else {
                high = m;
            }
            // A stiff obstacle or a large ρ amplifies the rounding errors of m in F: the sign of F
            // then changes between neighbouring numbers while |F| stays large.
            if high - low <= rounding {
                return Ok(());
            }
            let slope = run_kernel(Derivative { newton: self, k });
            m = safeguarded(low, high, m - f / slope);
        }
        let control = &self.controls[k];
        Err(StepFailure::IterationLimit {
            iterations: control.iterations,
            increment: control.increment,
            contraction: control.increment / previous,
        })
    }

    /// Resets the iterate of case k to the previous step's, because it may have diverged.
    fn restart(&mut self, k: usize) {
        self.controls[k].state = Progress::Safeguarded;
        let [iterate, before, ..] = &mut self.iterates;
        for (to, from) in iterate.iter_mut().zip(before.iter()) {
            for (to, from) in to.iter_mut().zip(from) {
                to.set_lane(k, from.lane(k));
            }
        }
    }

    /// `F'(m) = 1 + ρ dt (u_x, z_x)` with `(A + dt F'(u(1)) e eᵀ) z = K u½`, from the rank-one
    /// Kirchhoff term.
    #[inline(always)]
    fn derivative<A: MultiplyAdd>(&mut self, k: usize) -> f64 {
        let last = self.elements.len() - 1;
        let (dt, rho) = (self.cases[k].dt, self.cases[k].beam.rho);
        // u½_x = (u0 + u)_x/2 on element i.
        let mean_slope = |i: usize| {
            let [left, right] = [i - 1, i].map(|i| self.old[i][0].lane(k) + self.new[i][0].lane(k));
            0.5 * (right - left) * self.elements[i].inverse.lane(k)
        };
        let mut y = [0.0; B];
        for i in 1..=last {
            let mut right = [0.0; B];
            right[0] = mean_slope(i) - if i < last { mean_slope(i + 1) } else { 0.0 };
            y = minus_times::<A, _, _>(right, &block_of_lane(&self.nodes[i].multiplier, k), y);
            let z = times::<A, _, _>(&block_of_lane(&self.nodes[i].inverse, k), y);
            for (to, value) in self.middle[i].iter_mut().zip(z) {
                to.set_lane(k, value);
            }
        }
        let inverse = block_of_lane(&self.nodes[last].inverse, k);
        let mut z = self.middle[last].map(|component| component.lane(k));
        let stiffness = if self.cases[k].obstacles.is_some() {
            dt * self.controls[k].tip.stiffness
        } else {
            0.0
        };
        let force = stiffness * z[0] / (1.0 + stiffness * inverse[0][0]);
        z = std::array::from_fn(|c| z[c] - force * inverse[c][0]);
        let mut product = 0.0;
        for i in (1..=last).rev() {
            let next = if i > 1 {
                let middle = self.middle[i - 1].map(|component| component.lane(k));
                minus_transpose_times::<A, _, _>(
                    middle,
                    &block_of_lane(&self.nodes[i].multiplier, k),
                    z,
                )
            } else {
                [0.0; B]
            };
            let slope = (self.new[i][0].lane(k) - self.new[i - 1][0].lane(k))
                * self.elements[i].inverse.lane(k);
            product += slope * (z[0] - next[0]);
            z = next;
        }
        1.0 + rho * dt * product
    }
}

/// The block of case k.
#[inline(always)]
fn block_of_lane<T: Lane, const B: usize>(block: &Block<T, B>, k: usize) -> Block<f64, B> {
    block.map(|row| row.map(|entry| entry.lane(k)))
}

/// F'(m) for case k.
struct Derivative<'n, T, const B: usize> {
    newton: &'n mut Newton<T, B>,
    k: usize,
}

impl<T: Lane, const B: usize> Kernel for Derivative<'_, T, B> {
    type Output = f64;

    #[inline(always)]
    fn run<A: MultiplyAdd>(self) -> f64 {
        self.newton.derivative::<A>(self.k)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_newton_iterate_outside_the_bracket_is_replaced_by_the_midpoint() {
        assert_eq!(safeguarded(-1.0, 4.0, 3.5), 3.5);
        // F is already known at the ends of the bracket.
        for outside in [-7.0, -1.0, 4.0, 5.0, f64::NAN, f64::INFINITY] {
            assert_eq!(safeguarded(-1.0, 4.0, outside), 1.5, "{outside}");
        }
    }

    #[test]
    fn without_an_upper_end_the_bracket_grows_geometrically() {
        for start in [-1e9, -3.0, -1.0, -0.25, 0.0, 0.75, 1e4] {
            assert_eq!(safeguarded(start, f64::INFINITY, start + 0.5), start + 0.5);
            let ends = std::iter::successors(Some(start), |&low| {
                Some(safeguarded(low, f64::INFINITY, low))
            });
            let count = ends.take(100).take_while(|&m| m < 1e12).count();
            assert!(count < 80, "{count} extensions from {start}");
        }
    }

    #[test]
    fn the_rounding_bound_scales_with_the_forces() {
        let forces = [-0.5, 3.0, 1.25];
        assert_eq!(rounding(forces), 8.0 * f64::EPSILON * 4.75);
        for scale in [1e-6, 1e6] {
            let scaled = rounding(forces.map(|force| scale * force));
            assert!((scaled / (scale * rounding(forces)) - 1.0).abs() < 1e-12);
        }
    }
}
