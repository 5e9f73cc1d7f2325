//! The quantity that a convergence study refines.

/// What is refined from level to level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Axis {
    /// The mesh.
    Space,
    /// The time step.
    Time,
    /// Both together.
    Both,
}

impl Axis {
    /// All axes.
    pub const ALL: [Axis; 3] = [Axis::Space, Axis::Time, Axis::Both];

    /// The name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Axis::Space => "space",
            Axis::Time => "time",
            Axis::Both => "both",
        }
    }

    /// The step that is refined, as the label of an axis of a figure.
    pub fn label(self) -> &'static str {
        match self {
            Axis::Space => "mesh width h",
            Axis::Time => "time step dt",
            Axis::Both => "mesh width h and time step dt, refined together",
        }
    }
}
