//! The tests of the tools, the workflows, the manifests, and those that read the sources, in one
//! program.

mod action;
mod bench;
mod dev;
mod gallery;
mod manifests;
mod place;
mod quick_tier;
mod readme;
mod references;
mod release;
mod site;
mod sources;
mod workflow;
