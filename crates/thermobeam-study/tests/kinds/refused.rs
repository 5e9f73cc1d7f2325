//! Study files with errors.

use super::*;

/// Files of the repository with a piece of their text replaced, and files of their own.
#[test]
fn a_study_file_with_an_error_is_refused_with_the_field() {
    each_is_refused(include_str!("refused.txt"), |case| {
        let mut changed = case.new.clone();
        if !case.kind.is_empty() {
            let sound = text(case.kind);
            changed = sound.replacen(&case.old, &case.new, 1);
            assert_ne!(changed, sound, "{case:?}");
        }
        let read = KindRow::parse_any(&KINDS, &changed, &file("changed.toml")).err();
        read.unwrap_or_else(|| panic!("{case:?} is read"))
            .to_string()
    });
}
