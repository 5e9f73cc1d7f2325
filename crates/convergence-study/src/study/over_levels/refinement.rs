//! What is refined, and a level of it.

use crate::text::named::NamedNumber;

/// What is refined from level to level.
///
/// ```
/// use convergence_study::{RefinedIn, levels};
///
/// // The explicit Euler method for x' = -x: its error at t = 1.
/// let error = |n: usize| (-1f64).exp() - (1.0 - 1.0 / n as f64).powi(n as i32);
/// levels([8, 16, 32, 64, 128], error).counting("steps", RefinedIn::Time).claim("error", 1.0).assert_passes();
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RefinedIn {
    /// The mesh.
    Space,
    /// The time step.
    Time,
    /// Both together.
    Both,
}

impl RefinedIn {
    /// All of them.
    pub const ALL: [RefinedIn; 3] = [RefinedIn::Space, RefinedIn::Time, RefinedIn::Both];

    /// The name in study files.
    pub fn name(self) -> &'static str {
        match self {
            RefinedIn::Space => "space",
            RefinedIn::Time => "time",
            RefinedIn::Both => "both",
        }
    }

    /// The step that is refined, as the label of an axis of a figure.
    pub fn label(self) -> &'static str {
        match self {
            RefinedIn::Space => "mesh width h",
            RefinedIn::Time => "time step dt",
            RefinedIn::Both => "mesh width h and time step dt, refined together",
        }
    }
}

/// One level of refinement.
///
/// ```
/// use convergence_study::{NamedNumber, Refinement};
///
/// let level = Refinement::new("n = 64".to_owned(), &[("n", 64)], 1.0 / 64.0);
/// assert_eq!(level.parameters, [NamedNumber::new("n", 64.0)]);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Refinement {
    /// What identifies it, in words, such as `n = 64, 20 steps`.
    pub label: String,
    /// Its parameters by name, such as elements and steps.
    pub parameters: Vec<NamedNumber>,
    /// The step over which the errors are judged: h, dt, or h = c dt.
    pub step: f64,
}

impl Refinement {
    /// * `parameters`: counts by name, such as elements and steps.
    pub fn new(label: String, parameters: &[(&str, usize)], step: f64) -> Self {
        let parameters = parameters
            .iter()
            .map(|(name, count)| NamedNumber::new(*name, *count as f64))
            .collect();
        Self {
            label,
            parameters,
            step,
        }
    }
}
