//! Files to begin with: a study and two scenes, commented, that run as they are.

/// A kind of file that can be begun.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Template {
    /// A convergence study with a manufactured solution.
    Study,
    /// A scene.
    Scene,
    /// A scene of any order.
    AnyOrderScene,
}

impl Template {
    /// The file's text.
    ///
    /// * `name`: the study's id, or the scene's name; see [`is_name`].
    /// * `program`: what users type before a command, such as `thermobeam`.
    pub fn text(self, name: &str, program: &str) -> String {
        let text = match self {
            Self::Study => include_str!("template/study.toml"),
            Self::Scene => include_str!("template/scene.toml"),
            Self::AnyOrderScene => include_str!("template/any-order-scene.toml"),
        };
        text.replace("NAME", name).replace("PROGRAM", program)
    }
}

/// Whether a text can be a study's id and a file's name: small letters, digits, `.` and `-`, the first a letter or digit.
pub fn is_name(text: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
    text.starts_with(plain) && text.chars().all(|c| plain(c) || c == '.' || c == '-')
}
