//! Newton's method on the pole-free system for (N, α, c), from an approximate state.
//!
//! The f of the scan has poles: near a pole, the distance to it, and with it the amplitude, has a
//! relative error of round-off divided by that distance. The three conditions
//!
//! `φ(0) = 0`, `εc + u(1) = g` (or c = 0), `N = β + ρ‖u'‖²`
//!
//! have no poles and are regular at every state that is neither a fold nor a bifurcation. Below
//! N = -1 the shape satisfies φ(0) = 0 and needs no α: there α = 0 replaces the first condition.

use super::law::{ForceLaw, Support};
use super::shape::Shape;

/// Iteration limit; the convergence is quadratic up to the error of the difference quotients.
const STEPS: usize = 12;

/// Relative step of the central differences, which are exact in α and c: the conditions are
/// quadratic in them.
const DIFFERENCE: f64 = 1e-5;

/// A larger first relative step indicates a fold, where the result of the scan is more accurate.
const LARGEST_FIRST_STEP: f64 = 1e-3;

/// Improves a state by Newton's method; returns it unchanged if the first step is too large.
pub(super) fn polish(law: &ForceLaw, start: Shape) -> Shape {
    if start.is_line() {
        return start;
    }
    let mut state = [1.0 / start.q, start.alpha, start.stress];
    let mut bound = LARGEST_FIRST_STEP;
    for _ in 0..STEPS {
        let Some(step) = newton_step(law, state) else {
            break;
        };
        let size = relative_size(step, state);
        // No decrease: round-off has been reached, or the start was too far away.
        if size.is_nan() || size >= bound {
            break;
        }
        (0..3).for_each(|i| state[i] -= step[i]);
        bound = 0.5 * size;
    }
    unpack(law, state)
}

/// `|ds|/|s| + max(|dα|, |dc|)/max(|α|, |c|)`.
fn relative_size(step: [f64; 3], state: [f64; 3]) -> f64 {
    let bending = state[1].abs().max(state[2].abs());
    let change = step[1].abs().max(step[2].abs());
    (step[0] / state[0]).abs() + if change == 0.0 { 0.0 } else { change / bending }
}

fn unpack(law: &ForceLaw, [s, alpha, stress]: [f64; 3]) -> Shape {
    Shape {
        q: 1.0 / s,
        alpha,
        stress,
        moment: law.moment,
    }
}

/// The three conditions.
fn residual(law: &ForceLaw, v: [f64; 3]) -> [f64; 3] {
    let shape = unpack(law, v);
    let [s, alpha, stress] = v;
    let clamped = if s > 0.0 { shape.phi(0.0) } else { alpha };
    let contact = match law.support {
        None => stress,
        Some(Support { epsilon, position }) => epsilon * stress + shape.u(1.0) - position,
    };
    [
        clamped,
        contact,
        s - (1.0 + law.beta) - law.rho * shape.slope_squared(),
    ]
}

fn newton_step(law: &ForceLaw, state: [f64; 3]) -> Option<[f64; 3]> {
    let bending = state[1].abs().max(state[2].abs());
    let mut jacobian = [[0.0; 3]; 3];
    for (column, scale) in [state[0].abs(), bending, bending].into_iter().enumerate() {
        let h = DIFFERENCE * scale;
        let (mut up, mut down) = (state, state);
        up[column] += h;
        down[column] -= h;
        let up_residual = residual(law, up);
        let down_residual = residual(law, down);
        for row in 0..3 {
            jacobian[row][column] =
                (up_residual[row] - down_residual[row]) / (up[column] - down[column]);
        }
    }
    solve(jacobian, residual(law, state))
}

fn cross(x: [f64; 3], y: [f64; 3]) -> [f64; 3] {
    [
        x[1] * y[2] - x[2] * y[1],
        x[2] * y[0] - x[0] * y[2],
        x[0] * y[1] - x[1] * y[0],
    ]
}

/// Solves a 3 x 3 system by Cramer's rule; `None` if it is singular.
fn solve(a: [[f64; 3]; 3], b: [f64; 3]) -> Option<[f64; 3]> {
    let dot = |x: [f64; 3], y: [f64; 3]| -> f64 { x.iter().zip(y).map(|(x, y)| x * y).sum() };
    let inverse_rows = [cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])];
    let determinant = dot(a[0], inverse_rows[0]);
    if determinant == 0.0 || !determinant.is_finite() {
        return None;
    }
    // The columns of the inverse are cross products of the rows of a over the determinant.
    let component = |i: usize| (0..3).map(|j| inverse_rows[j][i] * b[j]).sum::<f64>() / determinant;
    Some([component(0), component(1), component(2)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polishing_improves_a_nearby_state_and_leaves_a_distant_one_unchanged() {
        let support = Some(Support {
            epsilon: 0.5,
            position: 0.125,
        });
        let law = ForceLaw {
            moment: 0.5,
            rho: 2.0,
            support,
            ..ForceLaw::default()
        };
        // The β for which s is the state.
        for s in [0.7, 2.0, -0.5] {
            let beta = s - 1.0 - 2.0 * law.solve(s).slope_squared();
            let at = ForceLaw { beta, ..law };
            let n = |start: f64| polish(&at, law.solve(start)).n_value();
            assert!(
                (n(s * (1.0 + 1e-5)) - (s - 1.0)).abs() < 1e-14,
                "{s}: {:e}",
                n(s * (1.0 + 1e-5)) - (s - 1.0)
            );
            let far = law.solve(1.1 * s);
            assert_eq!(polish(&at, far), far, "{s}");
        }
        let line = Shape::line(-1.0);
        assert_eq!(polish(&law, line), line);
    }
}
