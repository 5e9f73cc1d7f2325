//! Exact solutions: sums of products of a function of x and a function of t, and their time factors
//! T, T', T'' and the like at one time, exact or in the time-discrete form of a scheme.

use crate::function::Factor;

/// A product X(x) T(t).
#[derive(Debug, Clone)]
pub struct Product {
    /// X, a function of x; finite on [0, 1] with its first two derivatives.
    pub x: Factor,
    /// T, a function of t; finite on [0, t_end] with its first two derivatives.
    pub t: Factor,
}

/// An exact solution: a sum of products for each field; an empty sum is 0.
#[derive(Debug, Clone, Default)]
pub struct Manufactured {
    /// Displacement; each X is 0 at x = 0.
    pub u: Vec<Product>,
    /// Rotation; each X is 0 at x = 0.
    pub phi: Vec<Product>,
    /// Physical temperature; the sum is θ_A at x = 0 and 0 at x = 1.
    pub theta: Vec<Product>,
}

impl Manufactured {
    /// u(1, t).
    pub fn tip(&self, t: f64) -> f64 {
        self.u
            .iter()
            .map(|product| product.x.eval(1.0) * product.t.eval(t))
            .sum()
    }
}

/// Time factors of one field: value, first and second derivative for each product.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FieldFactors {
    /// T_j.
    pub value: Vec<f64>,
    /// T_j'.
    pub rate: Vec<f64>,
    /// T_j''.
    pub acceleration: Vec<f64>,
}

/// Time factors of all three fields at one time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Factors {
    /// Of the displacement.
    pub u: FieldFactors,
    /// Of the rotation.
    pub phi: FieldFactors,
    /// Of the physical temperature.
    pub theta: FieldFactors,
}

impl FieldFactors {
    fn at(&mut self, products: &[Product], t: f64) {
        self.value.clear();
        self.rate.clear();
        self.acceleration.clear();
        for product in products {
            let [value, rate, acceleration] = product.t.derivatives(t);
            self.value.push(value);
            self.rate.push(rate);
            self.acceleration.push(acceleration);
        }
    }

    /// The time-discrete form of a sequence of values over a step: mean, difference quotient, and
    /// inertia term.
    ///
    /// `old` and `new` contain the values at both ends of the step and the velocities v of the
    /// sequence. The new velocity is set to `inertia * V + (1 - inertia) v_old` with
    /// `V = (T_n - T_{n-1})/dt`: V for the paper's scheme, `2 V - v_old` for the midpoint rule. The
    /// acceleration is `(V - v_old) inertia/dt`.
    fn of_step(&mut self, old: &FieldFactors, new: &mut FieldFactors, inertia: f64, dt: f64) {
        self.value.clear();
        self.rate.clear();
        self.acceleration.clear();
        for j in 0..old.value.len() {
            let velocity = (new.value[j] - old.value[j]) / dt;
            self.value.push(0.5 * (old.value[j] + new.value[j]));
            self.rate.push(velocity);
            self.acceleration
                .push(inertia / dt * (velocity - old.rate[j]));
            new.rate[j] = inertia * velocity + (1.0 - inertia) * old.rate[j];
        }
    }
}

impl Factors {
    /// Sets the exact factors at time t.
    pub fn at(&mut self, exact: &Manufactured, t: f64) {
        self.u.at(&exact.u, t);
        self.phi.at(&exact.phi, t);
        self.theta.at(&exact.theta, t);
    }

    /// Sets the factors of the scheme's time-discrete operator for the step from `old` to `new`,
    /// and the velocities of `new`.
    ///
    /// * `inertia`: that of the [scheme](crate::formulas::SchemeFormulas::inertia).
    /// * `dt`: the time step.
    pub fn of_step(&mut self, old: &Factors, new: &mut Factors, inertia: f64, dt: f64) {
        self.u.of_step(&old.u, &mut new.u, inertia, dt);
        self.phi.of_step(&old.phi, &mut new.phi, inertia, dt);
        self.theta.of_step(&old.theta, &mut new.theta, inertia, dt);
    }
}
