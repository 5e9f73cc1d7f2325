//! Kinds of study, each tested with its own files and with planted defects: a check that cannot
//! fail proves nothing.

mod altered;
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
mod projection;
mod refused;
mod rigid;
mod scenes;
mod self_convergence;
mod solutions;
mod solvers;
mod sound;
mod studies;
mod untested;
mod variants;
mod vibration;
mod work_precision;
mod written;

use std::path::{Path, PathBuf};

use convergence_study::{
    CaseFailure, FromFile, Kind, KindRow, NamedRate, Outcome, Reason, Verdict, run_one,
};
use convergence_study_tests::refusals::each_is_refused;
use sound::{Sound, counted, defects, failed, not_passed, report};
use thermobeam_exact::equilibrium::Phase;
use thermobeam_study::exact::norm::{Norm, Norms};
use thermobeam_study::kinds::KINDS;
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::{Convergence, Prepared};
use thermobeam_study::kinds::runs::cases::End;

/// Defects or numbers, each after its name.
type Named<T, const N: usize> = [(&'static str, T); N];

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
