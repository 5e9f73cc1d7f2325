//! What JavaScript calls. Texts pass through the memory of the module: the page reserves a place,
//! writes a question there, asks, and reads the answer from the place that [`answer_start`] and
//! [`answer_length`] name.
//!
//! A module runs on one thread, and the page asks one question at a time; the locks are never
//! contended.
#![allow(unsafe_code)] // `no_mangle` gives a function the name by which the page calls it.

use std::sync::{Mutex, PoisonError};

static QUESTION: Mutex<Vec<u8>> = Mutex::new(Vec::new());
static ANSWER: Mutex<String> = Mutex::new(String::new());

/// Reserves a place for a question of `length` bytes.
///
/// * Returns its address in the memory of the module.
#[unsafe(no_mangle)]
extern "C" fn question_start(length: usize) -> *mut u8 {
    let mut question = QUESTION.lock().unwrap_or_else(PoisonError::into_inner);
    question.clear();
    question.resize(length, 0);
    question.as_mut_ptr()
}

/// Answers the question by [`read`](crate::read).
#[unsafe(no_mangle)]
extern "C" fn read_question() {
    answer(crate::read);
}

/// Answers the question by [`judge`](crate::judge).
#[unsafe(no_mangle)]
extern "C" fn judge_question() {
    answer(crate::judge);
}

/// Answers with the [`version`](crate::version).
#[unsafe(no_mangle)]
extern "C" fn ask_version() {
    answer(|_| crate::version().to_owned());
}

/// The address of the answer.
#[unsafe(no_mangle)]
extern "C" fn answer_start() -> *const u8 {
    let answer = ANSWER.lock().unwrap_or_else(PoisonError::into_inner);
    answer.as_ptr()
}

/// The length of the answer in bytes.
#[unsafe(no_mangle)]
extern "C" fn answer_length() -> usize {
    let answer = ANSWER.lock().unwrap_or_else(PoisonError::into_inner);
    answer.len()
}

fn answer(of: fn(&str) -> String) {
    let question = QUESTION.lock().unwrap_or_else(PoisonError::into_inner);
    let text = String::from_utf8_lossy(&question);
    *ANSWER.lock().unwrap_or_else(PoisonError::into_inner) = of(&text);
}
