//! Kinds of study, each tested with its own files and with planted defects: a check that cannot
//! fail proves nothing.

mod any_order;
mod bifurcation;
mod convergence;
mod dependence;
mod energy;
mod equilibrium;
mod experiments;
mod faults;
mod frequencies;
mod manufactured;
mod planted;
mod projection;
mod refused;
mod rigid;
mod scenes;
mod self_convergence;
mod solutions;
mod solvers;
mod studies;
mod typed;
mod untested;
mod variants;
mod vibration;
mod work_precision;
mod written;

use std::path::{Path, PathBuf};

use convergence_study::FromFile;

/// A file of the repository's `studies/`.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../studies")
        .join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(file(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A study of the repository.
#[track_caller]
fn read<K: FromFile>(name: &str) -> K {
    parsed(&text(name))
}

/// A study of this text, in the folder of those of the repository.
#[track_caller]
fn parsed<K: FromFile>(text: &str) -> K {
    K::parse(text, &file("changed.toml")).unwrap_or_else(|error| panic!("{error}"))
}
