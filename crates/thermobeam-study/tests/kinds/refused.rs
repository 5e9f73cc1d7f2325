//! Study files with errors.

use convergence_study::{Header, KindRow, internal::input};

use super::{file, text};

/// The message about a study file with `from` replaced by `to`.
#[track_caller]
pub(crate) fn refusal(row: &KindRow, name: &str, from: &str, to: &str) -> String {
    let changed = text(name).replacen(from, to, 1);
    assert_ne!(changed, text(name), "{name} has no {from}");
    let read = input::parse_beside(
        &changed,
        &file(&format!("changed-{name}")),
        |root, folder| (row.read)(Header::from_document(root)?, root, folder),
    );
    read.err()
        .unwrap_or_else(|| panic!("{name} with {to} is read"))
        .to_string()
}
