//! The curve that a rate belongs to.

/// `error = constant · step^rate`, a straight line in a figure with logarithmic axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PowerLaw {
    /// Observed exponent.
    pub rate: f64,
    /// Error at step 1.
    pub constant: f64,
}

impl PowerLaw {
    /// The error that the law gives for a step.
    ///
    /// ```
    /// use convergence_judge::judge::verdict::judge_pairs;
    ///
    /// let errors = [0.4, 0.2, 0.1, 0.05].map(|h: f64| (h, 3.0 * h * h));
    /// let law = judge_pairs(errors, 2.0, 0.05).power_law().expect("four levels give a rate");
    /// assert!((law.error_at(0.01) - 3e-4).abs() < 1e-12);
    /// ```
    pub fn error_at(&self, step: f64) -> f64 {
        self.constant * step.powf(self.rate)
    }
}
