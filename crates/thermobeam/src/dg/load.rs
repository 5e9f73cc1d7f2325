//! Loads: contributions to the right-hand sides, for manufactured solutions or any other purpose.

use super::time::{GaussPoint, MAX_STAGES, gauss_points};

/// Loads F_u, F_φ, F_θ on the right-hand sides of the three equations, tested with the basis functions.
///
/// [`Space::add_load`](super::Space::add_load) fills such a vector from functions of x.
pub trait Load: Send {
    /// Writes the load at time t, `(F_u, χ), (F_φ, ψ), (F_θ, η)` block by block, into `load`, which is zero initially.
    fn at(&mut self, t: f64, load: &mut [[f64; 3]]);
}

/// The loads of a step, integrated: `moments[i]` is the integral with L_i.
pub(super) struct Forcing<const S: usize> {
    pub(super) moments: Vec<Vec<[f64; 3]>>,
    load: Vec<[f64; 3]>,
    points: Vec<GaussPoint>,
}

impl<const S: usize> Forcing<S> {
    /// For this number of blocks; by q + 9 Gauss points.
    pub(super) fn new(blocks: usize) -> Self {
        let zeros = vec![[0.0; 3]; blocks];
        Self { moments: vec![zeros.clone(); S], load: zeros, points: gauss_points(S + 8) }
    }

    /// Integrates a load over the step of length h from t.
    pub(super) fn integrate(&mut self, load: &mut dyn Load, t: f64, h: f64) {
        self.moments.iter_mut().for_each(|moments| moments.fill([0.0; 3]));
        for point in &self.points {
            self.load.fill([0.0; 3]);
            load.at(t + h * point.s, &mut self.load);
            let legendre: &[f64; MAX_STAGES + 1] = &point.legendre;
            for (moments, legendre) in self.moments.iter_mut().zip(legendre) {
                let weight = h * point.weight * legendre;
                for (moment, load) in moments.iter_mut().zip(&self.load) {
                    for field in 0..3 {
                        moment[field] = weight.mul_add(load[field], moment[field]);
                    }
                }
            }
        }
    }
}
