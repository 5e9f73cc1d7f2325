//! The tests of the tools, the map and the links, in one program.

mod action;
mod dev;
mod links;
mod map;
mod quick_tier;
