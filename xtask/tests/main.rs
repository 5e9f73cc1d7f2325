//! The tests of the tools, the map, the links and the workflow, in one program.

mod action;
mod bench;
mod dev;
mod links;
mod manifests;
mod map;
mod quick_tier;
mod readme;
mod release;
mod reworded;
mod texts;
mod workflow;
