//! The scheme (3.7)-(3.8) and its semi-discrete limit as dense systems, written from the equations.
//!
//! No unknown is eliminated: u, v, φ, w at the nodes 1..n and θ~ at the nodes 1..n-1, stacked in
//! this order.

use super::p1::over_all_nodes;
use crate::prelude::*;
use nalgebra::{DMatrix, DVector};

/// Position of the tip at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Between,
    Above,
    Below,
}

pub(crate) struct Dense {
    beam: Beam,
    obstacles: Option<Obstacles>,
    n: usize,
    /// M, K and C at the nodes 1..n.
    m: DMatrix<f64>,
    k: DMatrix<f64>,
    c: DMatrix<f64>,
    /// `a θ_A C (1 - x)`.
    lift: DVector<f64>,
}

/// The unknowns at one time; θ~ at the nodes 1..n-1.
#[derive(Clone)]
pub(crate) struct State {
    pub(crate) u: DVector<f64>,
    pub(crate) v: DVector<f64>,
    pub(crate) phi: DVector<f64>,
    pub(crate) w: DVector<f64>,
    pub(crate) theta: DVector<f64>,
}

impl State {
    pub(crate) fn from_level(level: &TimeLevel) -> Self {
        let n = level.u.len() - 1;
        let free = |y: &[f64]| DVector::from_column_slice(&y[1..=n]);
        let theta = DVector::from_column_slice(&level.theta[1..n]);
        Self {
            u: free(&level.u),
            v: free(&level.v),
            phi: free(&level.phi),
            w: free(&level.w),
            theta,
        }
    }

    pub(crate) fn to_level(&self) -> TimeLevel {
        let mut level = TimeLevel::new(self.u.len() + 1);
        level.u[1..].copy_from_slice(self.u.as_slice());
        level.v[1..].copy_from_slice(self.v.as_slice());
        level.phi[1..].copy_from_slice(self.phi.as_slice());
        level.w[1..].copy_from_slice(self.w.as_slice());
        level.theta[1..self.u.len()].copy_from_slice(self.theta.as_slice());
        level
    }

    pub(crate) fn stack(&self) -> DVector<f64> {
        let parts = [&self.u, &self.v, &self.phi, &self.w, &self.theta];
        let values: Vec<f64> = parts.iter().flat_map(|part| part.iter().copied()).collect();
        DVector::from_vec(values)
    }

    pub(crate) fn unstack(y: &DVector<f64>, n: usize) -> Self {
        let part = |k: usize, length: usize| y.rows(k * n, length).into_owned();
        Self {
            u: part(0, n),
            v: part(1, n),
            phi: part(2, n),
            w: part(3, n),
            theta: part(4, n - 1),
        }
    }
}

impl Dense {
    pub(crate) fn new(problem: &Problem) -> Self {
        let (mesh, beam) = (&problem.mesh, problem.beam);
        let n = mesh.elements();
        let [m, k, c] = over_all_nodes(mesh);
        let steady =
            DVector::from_iterator(n + 1, mesh.nodes().iter().map(|x| beam.theta_a * (1.0 - x)));
        let lift = (&c * steady * beam.a).rows(1, n).into_owned();
        let free = |matrix: DMatrix<f64>| matrix.view((1, 1), (n, n)).into_owned();
        Self {
            beam,
            obstacles: problem.obstacles,
            n,
            m: free(m),
            k: free(k),
            c: free(c),
            lift,
        }
    }

    pub(crate) fn initial(&self, problem: &Problem) -> State {
        let initial = &problem.initial;
        let mut level = TimeLevel::new(self.n + 1);
        level.u.clone_from(&initial.u);
        level.v.clone_from(&initial.u_t);
        level.phi.clone_from(&initial.phi);
        level.w.clone_from(&initial.phi_t);
        for (i, x) in problem.mesh.nodes().iter().enumerate() {
            level.theta[i] = initial.theta[i] - self.beam.theta_a * (1.0 - x);
        }
        State::from_level(&level)
    }

    fn axial_force(&self, u: &DVector<f64>) -> f64 {
        self.beam.beta + self.beam.rho * u.dot(&(&self.k * u))
    }

    /// M, K restricted to the nodes of θ~, and the columns of C there.
    fn of_theta(&self) -> [DMatrix<f64>; 3] {
        let inner = self.n - 1;
        [
            self.m.view((0, 0), (inner, inner)).into_owned(),
            self.k.view((0, 0), (inner, inner)).into_owned(),
            self.c.columns(0, inner).into_owned(),
        ]
    }

    /// Time derivative of the semi-discrete solution, which both schemes approximate.
    pub(crate) fn rate(&self) -> impl Fn(&State) -> State + '_ {
        let [m_theta, k_theta, c_theta] = self.of_theta();
        let inverse = self.m.clone().try_inverse().unwrap();
        let inverse_theta = if self.n > 1 {
            m_theta.try_inverse().unwrap()
        } else {
            m_theta
        };
        move |y| {
            let (zeta, a) = (self.beam.zeta, self.beam.a);
            let mut force = &self.c * (&y.phi + &y.w * zeta)
                - &self.k * (&y.u * (1.0 + self.axial_force(&y.u)) + &y.v * zeta);
            let tip = self.n - 1;
            if let Some(o) = self.obstacles {
                force[tip] -= ((y.u[tip] - o.g2).max(0.0) - (o.g1 - y.u[tip]).max(0.0)) / o.epsilon;
            }
            let turn = &y.phi + &y.w * zeta;
            let moment = self.c.transpose() * (&y.u + &y.v * zeta) - (&self.k + &self.m) * turn
                + &c_theta * &y.theta * a
                + &self.lift;
            let heat = -(&k_theta * &y.theta) - c_theta.transpose() * &y.w * a;
            State {
                u: y.v.clone(),
                v: &inverse * force,
                phi: y.w.clone(),
                w: &inverse * moment,
                theta: &inverse_theta * heat,
            }
        }
    }

    /// One step by Newton's method on the whole system. Each side of the obstacles is tried; the
    /// consistent one is returned.
    pub(crate) fn step(
        &self,
        scheme: &Scheme,
        dt: f64,
        old: &State,
        load: &[[f64; 3]],
    ) -> Option<State> {
        let sides: &[Side] = if self.obstacles.is_some() {
            &[Side::Between, Side::Above, Side::Below]
        } else {
            &[Side::Between]
        };
        let step = Step {
            dense: self,
            scheme,
            dt,
            old,
            load,
        };
        sides.iter().find_map(|&side| step.solve(side))
    }

    fn side(&self, tip: f64) -> Side {
        match self.obstacles {
            Some(o) if tip > o.g2 => Side::Above,
            Some(o) if tip < o.g1 => Side::Below,
            _ => Side::Between,
        }
    }

    /// G, G' and G'' for a tip on the given side.
    fn potential(&self, side: Side, tip: f64) -> [f64; 3] {
        let Some(o) = self.obstacles else {
            return [0.0; 3];
        };
        let spring = |depth: f64| {
            [
                0.5 * depth * depth / o.epsilon,
                depth / o.epsilon,
                1.0 / o.epsilon,
            ]
        };
        match side {
            Side::Between => [0.0; 3],
            Side::Above => spring(tip - o.g2),
            Side::Below => spring(tip - o.g1),
        }
    }
}

/// The data of a step.
struct Step<'a> {
    dense: &'a Dense,
    scheme: &'a Scheme,
    dt: f64,
    old: &'a State,
    load: &'a [[f64; 3]],
}

impl Step<'_> {
    fn solve(&self, side: Side) -> Option<State> {
        self.starts(side)
            .into_iter()
            .find_map(|tip| self.solve_from(tip, side))
    }

    /// Initial tips on the given side. The discrete gradient is strongly curved: Newton's method
    /// needs a start near the root, or on the side from which it does not overshoot.
    fn starts(&self, side: Side) -> Vec<f64> {
        let old = self.old.u[self.dense.n - 1];
        let Some(o) = self.dense.obstacles else {
            return vec![old];
        };
        let depths = [0.1 * o.epsilon, o.epsilon, 1e-3, 1e-2, 0.1, 1.0];
        match side {
            Side::Between if self.dense.side(old) == side => vec![old],
            Side::Between if old > o.g2 => vec![o.g2, 0.5 * (o.g1 + o.g2), o.g1],
            Side::Between => vec![o.g1, 0.5 * (o.g1 + o.g2), o.g2],
            Side::Above => depths.map(|depth| o.g2 + depth).to_vec(),
            Side::Below => depths.map(|depth| o.g1 - depth).to_vec(),
        }
    }

    fn solve_from(&self, tip: f64, side: Side) -> Option<State> {
        let n = self.dense.n;
        let mut y = self.old.stack();
        y[n - 1] = tip;
        let mut last = f64::INFINITY;
        for _ in 0..100 {
            let correction = self
                .jacobian(&y, side)
                .lu()
                .solve(&self.residual(&y, side))?;
            y -= &correction;
            let size = correction.amax() / y.amax();
            // Iterate until the corrections are round-off and stop decreasing.
            if size <= 1e-12 && !(size < 0.5 * last) {
                return Some(State::unstack(&y, n))
                    .filter(|new| self.dense.side(new.u[n - 1]) == side);
            }
            last = size;
        }
        None
    }

    /// The velocity of the step: v itself, or the mean of both levels.
    fn carry(&self, new: &DVector<f64>, old: &DVector<f64>) -> DVector<f64> {
        let share = 1.0 / self.scheme.inertia;
        new * share + old * (1.0 - share)
    }

    /// `½(N(u) + N(u0))`.
    fn mean_axial_force(&self, u: &DVector<f64>) -> f64 {
        0.5 * (self.dense.axial_force(u) + self.dense.axial_force(&self.old.u))
    }

    /// Residual of the first equation of (3.7), (3.8) for u, the second equation, (3.8) for φ, and
    /// the third equation.
    fn residual(&self, y: &DVector<f64>, side: Side) -> DVector<f64> {
        let Dense {
            beam,
            n,
            m,
            k,
            c,
            lift,
            ..
        } = self.dense;
        let (n, dt, old, zeta, a) = (*n, self.dt, self.old, beam.zeta, beam.a);
        let new = State::unstack(y, n);
        let [m_theta, k_theta, c_theta] = self.dense.of_theta();
        let load = |component: usize, count: usize| {
            DVector::from_fn(count, |i, _| {
                self.load.get(i + 1).map_or(0.0, |load| load[component])
            })
        };
        let (v, w) = (self.carry(&new.v, &old.v), self.carry(&new.w, &old.w));
        let [u_half, phi_half, theta_half] = [
            (&new.u, &old.u),
            (&new.phi, &old.phi),
            (&new.theta, &old.theta),
        ]
        .map(|(new, old)| (new + old) * 0.5);
        let mean_n = self.mean_axial_force(&new.u);
        let mut in_u = m * (&new.v - &old.v) / dt + k * &u_half * (1.0 + mean_n) - c * &phi_half
            + (k * &v - c * &w) * zeta
            - load(0, n);
        in_u[n - 1] += self.contact(side, new.u[n - 1]).0;
        let in_phi = m * (&new.w - &old.w) / dt + (k + m) * &phi_half - c.transpose() * &u_half
            + ((m + k) * &w - c.transpose() * &v) * zeta
            - &c_theta * &theta_half * a
            - lift
            - load(1, n);
        let in_theta = &m_theta * (&new.theta - &old.theta) / dt
            + &k_theta * &theta_half
            + c_theta.transpose() * &w * a
            - load(2, n - 1);
        let mut r = DVector::zeros(5 * n - 1);
        for (row, part) in [
            in_u,
            &new.u - &old.u - &v * dt,
            in_phi,
            &new.phi - &old.phi - &w * dt,
            in_theta,
        ]
        .into_iter()
        .enumerate()
        {
            r.rows_mut(row * n, part.len()).copy_from(&part);
        }
        r
    }

    /// Derivative of [`Self::residual`] with respect to (u, v, φ, w, θ~).
    fn jacobian(&self, y: &DVector<f64>, side: Side) -> DMatrix<f64> {
        let Dense {
            beam, n, m, k, c, ..
        } = self.dense;
        let (n, dt, zeta, a) = (*n, self.dt, beam.zeta, beam.a);
        let new = State::unstack(y, n);
        let [m_theta, k_theta, c_theta] = self.dense.of_theta();
        let share = 1.0 / self.scheme.inertia;
        let mut j = DMatrix::zeros(5 * n - 1, 5 * n - 1);
        let mut put = |row: usize, column: usize, block: DMatrix<f64>| {
            j.view_mut((row * n, column * n), block.shape())
                .copy_from(&block);
        };
        let one = || DMatrix::identity(n, n);
        // d/du of ½(N(u) + N(u0)) K u½: N'(u) = 2ρ (K u)ᵀ.
        let u_half = (&new.u + &self.old.u) * 0.5;
        let rank_one = k * &u_half * (k * &new.u).transpose() * beam.rho;
        let mut u_by_u = k * (0.5 * (1.0 + self.mean_axial_force(&new.u))) + rank_one;
        u_by_u[(n - 1, n - 1)] += self.contact(side, new.u[n - 1]).1;
        put(0, 0, u_by_u);
        put(0, 1, m / dt + k * (zeta * share));
        put(0, 2, c * -0.5);
        put(0, 3, c * (-zeta * share));
        put(1, 0, one());
        put(1, 1, one() * (-dt * share));
        put(2, 0, c.transpose() * -0.5);
        put(2, 1, c.transpose() * (-zeta * share));
        put(2, 2, (k + m) * 0.5);
        put(2, 3, m / dt + (m + k) * (zeta * share));
        put(2, 4, &c_theta * (-0.5 * a));
        put(3, 2, one());
        put(3, 3, one() * (-dt * share));
        put(4, 3, c_theta.transpose() * (a * share));
        put(4, 4, m_theta / dt + k_theta * 0.5);
        j
    }

    /// The contact force and its derivative.
    fn contact(&self, side: Side, tip: f64) -> (f64, f64) {
        let start = self.old.u[self.dense.n - 1];
        let [g, dg, ddg] = self.dense.potential(side, tip);
        match self.scheme.contact {
            ContactRule::Implicit => (dg, ddg),
            // G is a parabola on one side: its difference quotient is the mean of the slopes.
            ContactRule::DiscreteGradient if self.dense.side(start) == side => {
                (0.5 * (dg + self.dense.potential(side, start)[1]), 0.5 * ddg)
            }
            ContactRule::DiscreteGradient => {
                let quotient =
                    (g - self.dense.potential(self.dense.side(start), start)[0]) / (tip - start);
                (quotient, (dg - quotient) / (tip - start))
            }
        }
    }
}
