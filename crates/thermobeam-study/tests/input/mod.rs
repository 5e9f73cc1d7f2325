//! All user input: scenes, study files, and the messages about their errors.

mod limits;
mod scene;
mod study_file;
mod unreadable;

/// Asserts that a message contains each of these pieces, in this order.
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
