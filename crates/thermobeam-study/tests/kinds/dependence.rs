use convergence_harness::judge::verdict::Verdict;
use convergence_harness::study::FromFile;
use thermobeam_study::kinds::runs::RunStudy;
use thermobeam_study::kinds::runs::dependence::{self, ROW};

use super::file;
use super::planted::verdict_with;
use super::refused::refusal;
use super::typed::passes_but_not_without_each_case;

type Dependence = RunStudy<dependence::Dependence>;

const FILE: &str = "theorem-2.6.toml";

/// A jump of a ten-millionth in the velocity, at one time, of one run with δ = 1e-6, or with δ = 0.
#[test]
fn a_jump_of_one_solution_fails() {
    let study = Dependence::read(file(FILE)).unwrap_or_else(|error| panic!("{error}"));
    let sound = passes_but_not_without_each_case(&study);
    for (case, sample) in [(4, 0), (4, 11), (0, 5)] {
        let verdict = verdict_with(&study, &sound, case, |traced| {
            traced.levels[sample].v.iter_mut().for_each(|v| *v += 1e-7);
        });
        assert_eq!(verdict, Verdict::Fail, "case {case}, sample {sample}");
        let verdict = verdict_with(&study, &sound, case, |traced| {
            traced.levels.truncate(sample);
        });
        assert_eq!(
            verdict,
            Verdict::Fail,
            "case {case} without sample {sample}"
        );
    }
}

#[test]
fn files_with_errors_are_refused() {
    for (from, to, message) in [
        (
            "paper-1-beta-0-any-order",
            "paper-1-beta-0",
            "a scene by dG",
        ),
        ("1e-2, 1e-3", "1e-3, 1e-2", "descending"),
        ("\"x^2*(1-x)^2\"", "\"x^2*(1-\"", "direction"),
    ] {
        let error = refusal(&ROW, FILE, from, to);
        assert!(error.contains(message), "{error}");
    }
}
