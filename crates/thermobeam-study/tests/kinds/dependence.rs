use convergence_study::{FromFile, Kind, Verdict, internal::study::run_cases_here};
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
    // Every tenth level is compared.
    for (case, sample) in [(4, 9), (4, 119), (0, 59)] {
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

/// In free flight the bound is nearly the difference of the data: solutions that part faster are
/// beyond it, however constant their difference/δ is.
#[test]
fn solutions_that_part_faster_than_their_bound_fail() {
    let study = Dependence::read(file(FILE)).unwrap_or_else(|error| panic!("{error}"));
    let sound = run_cases_here(&study);
    let base = sound[0].found.clone().expect("the run with δ = 0");
    let mut apart = sound.clone();
    for ran in &mut apart[1..] {
        let traced = ran.found.as_mut().expect("a run");
        for (level, of_base) in traced.levels.iter_mut().zip(&base.levels) {
            for (v, of_base) in level.v.iter_mut().zip(&of_base.v) {
                *v += 9.0 * (*v - of_base);
            }
        }
    }
    let outcome = study.judge(&apart);
    let mut failed = outcome
        .checks
        .iter()
        .filter(|check| check.verdict == Verdict::Fail);
    assert!(failed.all(|check| check.claim.to_string().contains("at most the bound")));
    assert_eq!(outcome.verdict, Verdict::Fail);
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
