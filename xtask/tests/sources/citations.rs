//! The sources cite equations of the paper, and only those that exist.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::{crate_folder, files};

/// The numbered equations of Bernardi and Copetti, with their meaning.
const EQUATIONS: [(&str, &str); 44] = [
    ("1.1", "equations of the beam"),
    ("1.2", "initial conditions"),
    ("1.3", "boundary conditions"),
    ("2.1", "spaces H¹_* and H¹_0"),
    ("2.2", "variational problem"),
    ("2.3", "axial force N(u)"),
    ("2.4", "space of the solution"),
    ("2.5", "energy E(t)"),
    ("2.6", "the energy decreases"),
    ("2.7", "regularity of the initial data"),
    ("2.8", "E(t) <= E(0)"),
    ("2.9", "bound on the dissipation"),
    ("2.10", "bound on u_x"),
    ("2.11", "bound on u_xt"),
    ("2.12", "zero initial data of a difference of solutions"),
    ("2.13", "variational problem of a difference of solutions"),
    ("2.14", "problem linearised by a given axial force"),
    ("2.15", "first-order system"),
    ("3.1", "mean of two time levels"),
    ("3.2", "space of piecewise linear functions"),
    ("3.3", "its subspaces with boundary conditions"),
    ("3.4", "projection error in L²"),
    ("3.5", "projection error in L² and H¹ for smooth functions"),
    ("3.6", "projection of the initial data"),
    ("3.7", "discrete problem"),
    ("3.8", "update of displacement and rotation"),
    ("3.9", "discrete energy"),
    ("3.10", "the discrete energy decreases"),
    (
        "3.11",
        "regularity of the initial data of the discrete problem",
    ),
    ("3.12", "stability of the discrete solution"),
    ("3.13", "regularity for the error estimate"),
    ("3.14", "error estimate of Theorem 3.4"),
    ("3.15", "discrete errors of the proof"),
    ("3.16", "recurrence of the squared discrete error Z_n"),
    ("4.1", "initial iterate"),
    ("4.2", "problem of one iteration"),
    ("4.3", "notation of the iterates"),
    ("4.4", "homogeneous system of the proof of Proposition 4.1"),
    ("4.5", "end of the iteration"),
    ("5.1", "coefficients of the experiments"),
    ("5.2", "mesh and time step of the experiments"),
    ("5.3", "initial displacement and velocity"),
    ("5.4", "initial temperature of the first experiment"),
    ("5.5", "initial temperature of the second experiment"),
];

/// The equations that the crate implements: each is cited in the implementing file, not just in
/// lib.rs.
const IMPLEMENTED: [(&str, &str); 14] = [
    ("1.1", "parameters.rs"),
    ("1.2", "one_step.rs"),
    ("1.3", "contact.rs"),
    ("2.3", "kirchhoff.rs"),
    ("2.5", "contact.rs"),
    ("3.6", "one_step.rs"),
    ("3.7", "solve/sweeps.rs"),
    ("3.8", "solve/sweeps.rs"),
    ("3.9", "energy.rs"),
    ("3.14", "norms.rs"),
    ("4.1", "solve/fixed_point.rs"),
    ("4.2", "solve/fixed_point.rs"),
    ("4.3", "solve/fixed_point.rs"),
    ("4.5", "solve/fixed_point.rs"),
];

/// Equation numbers `(chapter.number)` in a text; the argument of a call such as `f(2.5)` does not
/// count.
fn numbers(text: &str) -> impl Iterator<Item = &str> {
    text.match_indices('(').filter_map(|(at, _)| {
        let is_call = text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let (inside, _) = text[at + 1..].split_once(')')?;
        let (chapter, number) = inside.split_once('.')?;
        let is_chapter = matches!(chapter.as_bytes(), [b'1'..=b'9']);
        let is_number = matches!(
            number.as_bytes(),
            [b'1'..=b'9'] | [b'1'..=b'9', b'0'..=b'9']
        );
        (!is_call && is_chapter && is_number).then_some(inside)
    })
}

/// The comments of a Rust source, or the whole text of any other file.
fn prose(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("a source file");
    if path.extension().is_none_or(|extension| extension != "rs") {
        return text;
    }
    text.lines()
        .filter_map(|line| line.split_once("//"))
        .map(|(_, comment)| format!("{comment}\n"))
        .collect()
}

/// Cited numbers by file, for the solver and the exact solutions.
fn citations() -> BTreeMap<PathBuf, BTreeSet<String>> {
    let folders = ["thermobeam", "thermobeam-exact"].map(crate_folder);
    let paths = folders
        .iter()
        .flat_map(|folder| files(folder, &["rs", "md"]));
    let cited = |path: PathBuf| {
        let set = numbers(&prose(&path)).map(str::to_owned).collect();
        (path, set)
    };
    paths.map(cited).collect()
}

/// Citations of numbers that the paper does not have.
fn unknown<'a>(cited: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    cited
        .into_iter()
        .filter(|number| EQUATIONS.iter().all(|(known, _)| known != number))
        .collect()
}

#[test]
fn every_cited_equation_is_in_the_paper() {
    let mut count = 0;
    for (path, cited) in citations() {
        count += cited.len();
        assert_eq!(
            unknown(cited.iter().map(String::as_str)),
            [""; 0],
            "{}",
            path.display()
        );
    }
    assert!(count > 50, "{count} citations");
    assert_eq!(
        unknown(numbers(
            "the scheme (3.7), its limit (3.17), and (4.6); f(2.5), (12.5), (0.5)"
        )),
        ["3.17", "4.6"]
    );
}

#[test]
fn every_implemented_equation_is_cited_where_it_is_implemented() {
    let source = crate_folder("thermobeam").join("src");
    let citations = citations();
    for (number, file) in IMPLEMENTED {
        assert!(
            citations[&source.join(file)].contains(number),
            "({number}) is not cited in src/{file}"
        );
    }
}
