//! The discrete solution at one time level.

/// The discrete solution at one time level: n + 1 nodal values of each field.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeLevel {
    /// Displacement u.
    pub u: Vec<f64>,
    /// Its velocity û.
    pub v: Vec<f64>,
    /// Rotation φ.
    pub phi: Vec<f64>,
    /// Its velocity φ̂.
    pub w: Vec<f64>,
    /// Lifted temperature θ~ = θ - θ_A (1 - x).
    pub theta: Vec<f64>,
    /// Contact force of the step that led to this level: g(u(1)), or its discrete gradient in the
    /// `midpoint` scheme.
    pub contact_force: f64,
}

impl TimeLevel {
    /// A level of zeros with the given number of nodes.
    pub fn new(nodes: usize) -> Self {
        Self {
            u: vec![0.0; nodes],
            v: vec![0.0; nodes],
            phi: vec![0.0; nodes],
            w: vec![0.0; nodes],
            theta: vec![0.0; nodes],
            contact_force: 0.0,
        }
    }

    /// Whether all nodal values of û and φ̂ are at most `speed` in size; false if one is NaN.
    pub fn is_slow(&self, speed: f64) -> bool {
        self.v.iter().chain(&self.w).all(|rate| rate.abs() <= speed)
    }

    /// Makes this level the difference of two others with the same number of nodes, without
    /// allocating.
    pub fn set_difference(&mut self, one: &TimeLevel, other: &TimeLevel) {
        let fields = [
            (&mut self.u, &one.u, &other.u),
            (&mut self.v, &one.v, &other.v),
            (&mut self.phi, &one.phi, &other.phi),
            (&mut self.w, &one.w, &other.w),
            (&mut self.theta, &one.theta, &other.theta),
        ];
        for (difference, one, other) in fields {
            for (difference, (one, other)) in difference.iter_mut().zip(one.iter().zip(other)) {
                *difference = one - other;
            }
        }
        self.contact_force = one.contact_force - other.contact_force;
    }

    /// Copies the values of a level with the same number of nodes, without allocating.
    ///
    /// The derived `clone_from` would allocate five vectors.
    pub(crate) fn copy_from(&mut self, other: &TimeLevel) {
        self.u.clone_from(&other.u);
        self.v.clone_from(&other.v);
        self.phi.clone_from(&other.phi);
        self.w.clone_from(&other.w);
        self.theta.clone_from(&other.theta);
        self.contact_force = other.contact_force;
    }
}
