//! Everything that a user can write: scenes, study files, and what is said when they are wrong.

mod limits;
mod scene;
mod study_file;
mod unreadable;

/// Asserts that a message holds each of these pieces, in this order.
#[track_caller]
fn says(message: &str, pieces: &[&str]) {
    let mut rest = message;
    for piece in pieces {
        match rest.split_once(piece) {
            Some((_, after)) => rest = after,
            None => panic!("not said, or not in this order: {piece:?}\n{message}"),
        }
    }
}
