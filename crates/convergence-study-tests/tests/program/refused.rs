//! What a study file may get wrong: it is refused with its place, what is found and what is
//! allowed.

use std::fs;

use convergence_study_tests::refusals::each_is_refused;
use convergence_study_tests::transcript::place;

use crate::command_line::{command, texts, visible::is_harmless};

/// Each case changes the file `s.toml` that stands at the head of a transcript.
#[test]
fn a_study_file_that_cannot_be_used_is_refused_with_its_place() {
    each_is_refused(include_str!("refused.txt"), |case| {
        let place = place(match case.kind {
            "a program" => include_str!("../transcripts/programs.md"),
            "samples" => include_str!("../transcripts/samples.md"),
            "a table" => include_str!("../transcripts/table.md"),
            _ => include_str!("../transcripts/taylor.md"),
        });
        let file = place.path().join("s.toml");
        let sound = fs::read_to_string(&file).unwrap();
        assert!(sound.contains(&case.old), "{case:?}: {sound}");
        fs::write(&file, sound.replacen(&case.old, &case.new, 1)).unwrap();
        let ended = texts(&mut command(place.path(), &["study", "s.toml"]));
        ended.refuses("error: s.toml");
        is_harmless(&ended.stderr);
        ended.stderr
    });
}
