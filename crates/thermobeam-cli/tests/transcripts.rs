//! What the program prints, as documents show it.

use convergence_study_tests::transcript::follow;

const PROGRAM: &str = env!("CARGO_BIN_EXE_thermobeam");

#[test]
fn steady_states_are_as_their_transcript_shows() {
    follow(include_str!("transcripts/equilibria.md"), PROGRAM);
}

#[test]
fn the_first_steps_are_as_their_transcript_shows() {
    follow(include_str!("transcripts/first.md"), PROGRAM);
}

#[test]
fn time_limits_are_as_their_transcript_shows() {
    follow(include_str!("transcripts/limits.md"), PROGRAM);
}

#[test]
fn runs_are_as_their_transcript_shows() {
    follow(include_str!("transcripts/run.md"), PROGRAM);
}

#[test]
fn studies_that_cannot_be_used_and_the_list_are_as_their_transcript_shows() {
    follow(include_str!("transcripts/studies.md"), PROGRAM);
}

#[test]
fn sweeps_are_as_their_transcript_shows() {
    follow(include_str!("transcripts/sweep.md"), PROGRAM);
}
