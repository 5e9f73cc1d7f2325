//! One program for all tests.

mod answers;
