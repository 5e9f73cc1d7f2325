//! The tests of the tools, the workflow, and those that read the sources, in one program.

mod action;
mod bench;
mod dev;
mod quick_tier;
mod readme;
mod reworded;
mod sources;
mod workflow;
