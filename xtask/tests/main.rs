//! The tests of the action and of the pages, and those that read the sources, in one program.

mod action;
mod place;
mod quick_tier;
mod readme;
mod references;
mod sources;
