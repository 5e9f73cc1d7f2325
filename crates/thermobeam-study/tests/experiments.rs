//! The studies of the paper's experiments and of steady states: they pass, and they can fail.

use crate::study::untyped::Measured;
use convergence_study::judge::verdict::Verdict;
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::Outcome;
use std::collections::BTreeSet;
use std::path::PathBuf;
use thermobeam_study::kinds::{self, Study};

type Results = Vec<Result<Measured, CaseFailure>>;

fn path(file: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../studies").join(file)
}

/// A study that has run.
struct Ran {
    study: Box<dyn Study>,
    results: Results,
}

impl Ran {
    fn new(file: &str) -> Self {
        let study = study::read(&path(file)).unwrap_or_else(|error| panic!("{error}"));
        let results = (0..study.cases().len()).map(|index| study.run(index)).collect();
        Self { study, results }
    }

    fn case(&self, label: &str) -> usize {
        let cases = self.study.cases();
        cases.iter().position(|case| case.label == label).unwrap_or_else(|| panic!("{label} is none of {cases:?}"))
    }

    /// The outcome when one number is another.
    fn with(&self, case: usize, name: &str, planted: f64) -> Outcome {
        let mut results = self.results.clone();
        let measured = results[case].as_mut().expect("a result");
        let value = measured.values.iter_mut().find(|(key, _)| key == name);
        value.unwrap_or_else(|| panic!("{name} is not measured")).1 = planted;
        self.study.conclude(&results)
    }

    #[track_caller]
    fn catches(&self, label: &str, name: &str, planted: f64) {
        let outcome = self.with(self.case(label), name, planted);
        assert_ne!(outcome.verdict, Verdict::Pass, "{label}: {name} = {planted} passes");
    }

    /// No number may be NaN, whether a claim rests on it or not.
    fn refuses_nan(&self) {
        for (case, result) in self.results.iter().enumerate() {
            for (name, _) in &result.as_ref().expect("a result").values {
                let outcome = self.with(case, name, f64::NAN);
                assert_eq!(outcome.verdict, Verdict::Fail, "{name} of case {case} may be NaN");
            }
        }
    }

    /// What holds for every study.
    #[track_caller]
    fn is_sound(&self) {
        let outcome = self.study.conclude(&self.results);
        let id = &self.study.header().id;
        let failures: Vec<_> = outcome.checks.iter().filter(|check| check.verdict != Verdict::Pass).collect();
        assert_eq!(outcome.verdict, Verdict::Pass, "{failures:?} {:?}", outcome.rates);
        assert_eq!(self.study.conclude(&self.results), outcome, "not reproducible");

        let mut failed = self.results.clone();
        failed[0] = Err(CaseFailure { reason: "planted".into() });
        let failed = self.study.conclude(&failed);
        assert_eq!(failed.verdict, Verdict::Fail);
        assert!(failed.checks.iter().any(|check| check.evidence.contains("planted")));
        assert_eq!(self.study.conclude(&self.results[1..]).verdict, Verdict::Fail, "a result is missing");

        self.refuses_nan();

        let quantities: BTreeSet<&String> = outcome.quantities.iter().map(|quantity| &quantity.name).collect();
        assert_eq!(quantities.len(), outcome.quantities.len(), "two quantities of one name");
        assert!(outcome.quantities.iter().all(|quantity| quantity.value.is_finite() && quantity.tolerance > 0.0));
        for figure in &outcome.figures {
            assert!(figure.file.starts_with(&format!("{id}-")) && figure.file.ends_with(".svg"), "{}", figure.file);
            assert!(!figure.svg.contains("not drawn"), "{} has points that cannot be drawn", figure.file);
        }
        for table in &outcome.tables {
            assert!(table.rows.iter().all(|row| row.len() == table.head.len()), "{}", table.title);
        }
    }
}

#[test]
fn every_claim_of_section_5_can_fail() {
    let ran = Ran::new("section-5.toml");
    ran.is_sound();
    let straight = "paper-1-beta-0";
    ran.catches(straight, "energy", 1e-5);
    ran.catches(straight, "largest_field", 0.01);
    ran.catches(straight, "largest_increase", 1e-10);
    ran.catches(straight, "first_upper", 3.0);
    ran.catches(straight, "first_lower", 3.0);
    ran.catches(straight, "frequency", 0.9);
    ran.catches(straight, "frequency", 0.1);
    ran.catches(straight, "phi_amplitude", 0.5);
    let resting = "paper-2-beta-minus-0.5";
    ran.catches(resting, "contact_force", 0.0);
    ran.catches(resting, "exact_contact", 0.0);
    ran.catches(resting, "exact_stable", 0.0);
    ran.catches(resting, "distance", 0.01);
    ran.catches("paper-2-beta-5", "contact_force", 1e-3);
    ran.catches("paper-3-beta-minus-0.8", "u_tip", 0.0);
    ran.catches("to rest, beta = -0.45", "states", 3.0);
    ran.catches("to rest, beta = -0.6", "states", 3.0);
    ran.catches("to rest, beta = -0.6", "u_tip", 0.05);
    ran.catches("to rest, beta = -0.72", "states", 1.0);
    ran.catches("to rest, beta = -0.72", "stable", 1.0);
    ran.catches("to rest, beta = -0.72", "u_tip", 0.0);
    ran.catches("to rest, beta = -0.72", "nearest_stable", 0.0);
}

#[test]
fn every_claim_about_end_states_can_fail() {
    let ran = Ran::new("equilibria.toml");
    ran.is_sound();
    let finest = "paper-2-beta-5, n = 160";
    ran.catches(finest, "u", 2e-6);
    ran.catches(finest, "φ", 2e-6);
    ran.catches(finest, "u_tip", 0.0141797);
    ran.catches(finest, "contact", 1.0);
    ran.catches("paper-2-beta-5, n = 40", "u", 1e-5);
    ran.catches("paper-1-beta-0, n = 160", "u", 2e-6);
}

#[test]
fn every_claim_about_branches_can_fail() {
    let ran = Ran::new("bifurcation.toml");
    ran.is_sound();
    ran.catches("branches, θ_A = 0", "ambiguous", 1.0);
    ran.catches("branches, θ_A = 0", "event_low", -0.7);
    ran.catches("branches, θ_A = 0", "event_high", -0.72);
    ran.catches("branches, θ_A = 20", "event_low", 0.0);
    ran.catches("buckling force, n = 64", "force", 0.7116);
    ran.catches("buckling force, n = 128", "force", 0.711606);
    ran.catches("to rest, θ_A = 0, β = -0.71", "u_tip", 0.01);
    ran.catches("to rest, θ_A = 0, β = -0.715", "u_tip", 0.0);
    ran.catches("to rest, θ_A = 20, β = 1", "stable", 0.0);
    ran.catches("to rest, θ_A = 20, β = 1", "distance", 0.01);
    let mut results = ran.results.clone();
    let heated = results[ran.case("branches, θ_A = 20")].as_mut().unwrap();
    heated.series.iter_mut().find(|(name, _)| name == "count").unwrap().1[5].1 = 3.0;
    assert_eq!(ran.study.conclude(&results).verdict, Verdict::Fail, "a second steady state of the heated beam");
}

#[test]
fn no_claim_holds_without_numbers() {
    for file in ["section-5.toml", "equilibria.toml", "bifurcation.toml"] {
        let study = study::read(&path(file)).unwrap_or_else(|error| panic!("{error}"));
        let outcome = study.conclude(&vec![Ok(Measured::default()); study.cases().len()]);
        // That every case has a result is true, and says nothing.
        let holding: Vec<_> = outcome.checks[1..].iter().filter(|check| check.verdict == Verdict::Pass).collect();
        assert!(holding.is_empty(), "{holding:?}");
        assert!(outcome.rates.iter().all(|(_, rate)| rate.verdict != Verdict::Pass));
    }
}

#[test]
fn a_case_gives_the_same_result_every_time() {
    let study = study::read(&path("equilibria.toml")).unwrap_or_else(|error| panic!("{error}"));
    let index = study.cases().iter().position(|case| case.label == "paper-3-beta-minus-0.8, n = 20").unwrap();
    assert_eq!(study.run(index), study.run(index));
}

#[test]
fn the_full_study_reads_like_the_quick_one() {
    let study = study::read(&path("section-5-full.toml")).unwrap_or_else(|error| panic!("{error}"));
    let quick = study::read(&path("section-5.toml")).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(study.cases().len(), quick.cases().len());
    assert!(study.cases()[0].cost > 10.0 * quick.cases()[0].cost);
}

#[test]
fn complaints_name_the_field() {
    use thermobeam_study::kinds::{
        FromFile, bifurcation::BifurcationStudy, equilibrium::EndStates, experiment::Experiments,
    };
    let complaint = |file: &str, from: &str, to: &str| {
        let text = std::fs::read_to_string(path(file)).unwrap();
        assert!(text.contains(from), "{file} has no {from}");
        let (text, name) = (text.replacen(from, to, 1), path(file));
        let error = match file {
            "section-5.toml" => Experiments::parse(&text, &name).err(),
            "equilibria.toml" => EndStates::parse(&text, &name).err(),
            _ => BifurcationStudy::parse(&text, &name).err(),
        };
        error.unwrap_or_else(|| panic!("{file} with {to} is read")).to_string()
    };
    for (file, from, to, field) in [
        ("section-5.toml", "rate = 1e-8", "rate = -1", "run.rate"),
        ("section-5.toml", "\"upper\", \"free\"", "\"upper\"", "experiments.rests"),
        ("section-5.toml", "paper-1-beta-5", "paper-1-beta-minus-0.5", "experiments.first"),
        ("section-5.toml", "window", "windows", "run.windows"),
        ("section-5.toml", "[-1.0, -0.9", "[-0.9, -1.0", "steady.beta"),
        ("equilibria.toml", "[20, 40, 80, 160]", "[20, 40]", "run.elements"),
        ("equilibria.toml", "tolerance = 0.02", "tolerance = 0.6", "expect.tolerance"),
        ("equilibria.toml", "paper-1-beta-5", "impact-5", "impact-5"),
        ("bifurcation.toml", "beta = [-1.0, 1.0]", "beta = [1.0, -1.0]", "diagram.beta"),
        ("bifurcation.toml", "distance = 1e-3", "distance = \"far\"", "rest.distance"),
    ] {
        let found = complaint(file, from, to);
        assert!(found.contains(field), "{found}");
    }
}
