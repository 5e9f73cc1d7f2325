#![doc = include_str!("../README.md")]
//!
//! # The files of this crate
//!
//! | folder or file | holds |
//! | --- | --- |
//! | `language/`, `problem/` | text to tree; a file, read and checked, each message with its place |
//! | `arithmetic/` | the graph of expressions with its derivatives, its evaluation with sizes, Taylor jets, quadrature |
//! | `derive/` | tensors, four coordinate systems, operators: generic in the arithmetic; the quantities of a file |
//! | `model.rs`, `sample.rs`, `fit.rs` | a file as one graph and as jets; points of domains and faces; least squares |
//! | `check/`, `against/` | what is right, wrong, or not noticed; foreign sources and their causes |
//! | `variants/` | other solutions, each of which switches off a part of a program |
//! | `emit/`, `at.rs` | a module as plain data, `emit/module.rs`, which templates print; operators by a row for each language; values at points as JSON |
//!
//! Jets walk the tree and share no rule of derivatives with the graph. Named terms are summed in
//! alphabetical order, so that the emitted bytes do not depend on the order of keys.

#[cfg(feature = "problems")]
mod against;
#[cfg(feature = "problems")]
mod arithmetic;
#[cfg(feature = "problems")]
mod at;
#[cfg(feature = "problems")]
pub mod check;
#[cfg(feature = "problems")]
mod derive;
#[cfg(feature = "problems")]
pub mod emit;
#[cfg(feature = "problems")]
mod fit;
// What only files need of it is not used without them.
#[cfg_attr(not(feature = "problems"), allow(dead_code, unused_imports))]
pub mod language;
#[cfg(feature = "problems")]
mod manufacture;
#[cfg(feature = "problems")]
mod model;
#[cfg(feature = "problems")]
mod problem;
#[cfg(feature = "problems")]
mod sample;
#[cfg(feature = "problems")]
mod variants;

#[cfg(feature = "problems")]
pub use against::{Comparison, Edit, Question};
#[cfg(feature = "problems")]
pub use check::{Check, Finding, Share};
#[cfg(feature = "problems")]
pub use emit::{EmittedFile, Language};
#[cfg(feature = "problems")]
pub use manufacture::{Manufacture, Sampling};
#[cfg(feature = "problems")]
pub use problem::{InputError, ProblemFile};
#[cfg(feature = "problems")]
pub use variants::{LeftOutVariant, Switch, Variant, Variants};
