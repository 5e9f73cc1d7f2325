//! The studies of steady states and of rigid obstacles: they pass, and they can fail.

use convergence_study::judge::verdict::Verdict;
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::Outcome;
use std::collections::BTreeSet;
use std::path::PathBuf;
use thermobeam_study::kinds::untyped::Measured;
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
fn every_claim_about_rigid_obstacles_can_fail() {
    let ran = Ran::new("rigid-obstacles.toml");
    ran.is_sound();
    // An error at a softer obstacle would be taken for a stage before the asymptotic one, and rightly so.
    ran.catches("bouncing, ε = 1.0e-8", "penetration", 2e-7);
    ran.catches("bouncing, ε = 1.0e-7", "penetration", 2e-6);
    ran.catches("bouncing, ε = 1.0e-8", "iterations", 3.0);
    ran.catches("bouncing, ε = 1.0e-8", "most_iterations", 9.0);
    ran.catches("at rest, ε = 1.0e-8", "penetration", 1e-9);
    ran.catches("at rest, ε = 1.0e-8", "force", f64::NAN);
    ran.catches("impact, ε = 1.0e-8", "penetration", 2e-6);
    ran.catches("impact, ε = 1.0e-8", "velocity", 1.02);
    ran.catches("fixed point, ε = 1.0e-3", "converged", 0.0);
    ran.catches("fixed point, ε = 1.0e-6", "converged", 1.0);
    ran.catches("fixed point, ε = 1.0e-3", "contraction", 0.1);
    let mut results = ran.results.clone();
    results[ran.case("bouncing, ε = 1.0e-7")].as_mut().unwrap().series.clear();
    assert_ne!(ran.study.conclude(&results).verdict, Verdict::Pass, "without a motion there is no distance");
}

#[test]
fn no_claim_holds_without_numbers() {
    for file in ["equilibria.toml", "rigid-obstacles.toml"] {
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
    for (file, label) in
        [("equilibria.toml", "paper-3-beta-minus-0.8, n = 20"), ("rigid-obstacles.toml", "impact, ε = 1.0e-4")]
    {
        let study = study::read(&path(file)).unwrap_or_else(|error| panic!("{error}"));
        let index = study.cases().iter().position(|case| case.label == label).unwrap();
        assert_eq!(study.run(index), study.run(index));
    }
}

#[test]
fn complaints_name_the_field() {
    use thermobeam_study::kinds::{FromFile, equilibrium::EndStates, rigid::RigidStudy};
    let complaint = |file: &str, from: &str, to: &str| {
        let text = std::fs::read_to_string(path(file)).unwrap();
        assert!(text.contains(from), "{file} has no {from}");
        let (text, name) = (text.replacen(from, to, 1), path(file));
        let error = match file {
            "equilibria.toml" => EndStates::parse(&text, &name).err(),
            _ => RigidStudy::parse(&text, &name).err(),
        };
        error.unwrap_or_else(|| panic!("{file} with {to} is read")).to_string()
    };
    for (file, from, to, field) in [
        ("equilibria.toml", "[20, 40, 80, 160]", "[20, 40]", "run.elements"),
        ("equilibria.toml", "tolerance = 0.02", "tolerance = 0.6", "expect.tolerance"),
        ("equilibria.toml", "paper-1-beta-5", "impact-5", "impact-5"),
        ("rigid-obstacles.toml", "1e-1, 3.16e-2", "1e-1, 3.16e-1", "obstacles.epsilon"),
        ("rigid-obstacles.toml", "scenes/impact", "scenes/paper-1-beta-0", "impact.scene"),
    ] {
        let found = complaint(file, from, to);
        assert!(found.contains(field), "{found}");
    }
}
