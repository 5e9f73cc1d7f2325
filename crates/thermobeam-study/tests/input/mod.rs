//! All user input: scenes, study files, and the messages about their errors.

mod limits;
mod scene;
mod study_file;
mod unreadable;

/// Asserts that a message contains these pieces, with ` … ` between them, in this order.
#[track_caller]
fn says(message: &str, pieces: &str) {
    assert!(
        convergence_study_tests::says(message, pieces),
        "{pieces:?} is not said by\n{message}"
    );
}
