//! The files that `new program NAME` begins with.

use crate::project::Template;

/// A study of a program, and the program.
pub const TEMPLATE: Template = Template {
    name: "program",
    about: "A convergence study of a program in any language",
    files: &[(".toml", include_str!("begin/study.toml")), (".py", include_str!("begin/program.py"))],
    next: &["study", "explain"],
};
