//! The wording of the beam's findings decides nothing: studies of the beam with planted defects
//! lead to the same conclusions when each of their texts is a random word.
//!
//! The fake studies of `convergence-study`, `tests/verification/texts.rs`, have the same test; here
//! the texts are those of real kinds.

use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use convergence_study::{
    Finished, Project, Study, Verdict,
    internal::{
        run::{Item, not_passed, run},
        store::{
            Baseline, GuardedChange,
            diagnosis::{Diagnosis, diagnose},
        },
        study::{StudyFile, outcome::settle},
    },
};
use serde_json::Value;

/// The keys of texts for people, in a study as JSON.
const TEXTS: [&str; 7] = [
    "claim",
    "evidence",
    "summary",
    "after_rates",
    "headline",
    "because",
    "reason",
];

const LINEAR: &str = r#"
[study]
id = "linear"
claim = "The order in space"
tier = "quick"

[beam]
zeta = 0.1
a = 0.5
rho = 0.0

[exact]
u = [{ x = "0.3*sin(1.3*pi*x)", t = "cos(3*t) + 0.2*t" }]
phi = [{ x = "0.4*x*exp(-x)", t = "sin(2*t) + 0.5" }]
theta = [{ x = "(1+x)*sin(pi*x)", t = "exp(-t)" }]

[refine]
axis = "space"
isolate = true
elements = [16, 32, 64, 128]
steps = 10
t_end = 0.5
tolerance = 1e-13

[[expect]]
norm = "theorem-3.4"
order = ORDER
tolerance = 0.02
"#;

const FREQUENCIES: &str = r#"
[study]
id = "frequencies"
claim = "Frequencies converge at second order"
tier = "quick"
kind = "orders/frequencies"

[frequencies]
count = 4
elements = [16, 32, 64, 128]
order = 2.0
tolerance = 0.05
"#;

const ENERGY: &str = r#"
[study]
id = "energy"
claim = "The energy never rises, and its balance closes"
tier = "quick"
kind = "runs/energy"

[energy]
scenes = ["scenes/paper-1-beta-0.toml", "scenes/paper-1-beta-5.toml"]
schemes = ["euler-crank-nicolson", "midpoint"]
elements = 8
map = "s + 0.1*sin(2*pi*s)"
dt = 1e-3
steps = 50
random = 2
seed = 1
tolerance = TOLERANCE
"#;

const CONTROLS: &str = r#"
[study]
id = "controls"
claim = "Each fault is noticed"
tier = "quick"
kind = "detects"

[controls]
relative = 1e-2
studies = ["linear.toml"]
elements = [16, 32, 64, 128]
"#;

const OTHERS: usize = 6;

/// The studies, run on one thread.
///
/// * `order`: claimed of `linear`.
/// * `tolerance`: of the balance of the energy.
fn studies(order: &str, tolerance: &str) -> Vec<Box<dyn Study>> {
    let folder = tempfile::tempdir().unwrap();
    let scenes = folder.path().join("scenes");
    fs::create_dir(&scenes).unwrap();
    let ours = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies/scenes");
    for scene in ["paper-1-beta-0.toml", "paper-1-beta-5.toml"] {
        fs::copy(ours.join(scene), scenes.join(scene)).unwrap();
    }
    let claimed = LINEAR.replace("ORDER", order);
    let files = [
        ("controls.toml", CONTROLS.to_owned()),
        ("linear.toml", claimed),
        ("frequencies.toml", FREQUENCIES.to_owned()),
        ("energy.toml", ENERGY.replace("TOLERANCE", tolerance)),
    ];
    // Studies that need no time steps, and pass.
    let others = (1..=OTHERS).map(|number| {
        let id = format!("other-{number}");
        let text = FREQUENCIES.replace("\"frequencies\"", &format!("\"{id}\""));
        (id + ".toml", text)
    });
    let files = files.map(|(name, text)| (name.to_owned(), text));
    let write = |(name, text): (String, String)| -> PathBuf {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let paths: Vec<PathBuf> = files.into_iter().chain(others).map(write).collect();
    let files = StudyFile::read_all(project().kinds, &paths).unwrap();
    files.into_iter().map(|file| file.study).collect()
}

fn finished(studies: &[Box<dyn Study>]) -> Vec<Finished> {
    run(studies, NonZeroUsize::MIN, &|_| ()).unwrap()
}

fn project() -> Project {
    thermobeam_cli::project("beam")
}

/// Replaces each text by a word that occurs nowhere else, and counts them.
fn reword(value: &mut Value, count: &mut usize) {
    match value {
        Value::Object(fields) => {
            for (key, value) in fields {
                if TEXTS.contains(&key.as_str()) && value.is_string() {
                    *count += 1;
                    *value = Value::from(format!("word{count}"));
                } else {
                    reword(value, count);
                }
            }
        }
        Value::Array(items) => items.iter_mut().for_each(|item| reword(item, count)),
        _ => {}
    }
}

/// The same study with a word in place of each text of its outcome.
fn reworded(study: &Finished, count: &mut usize) -> Finished {
    let mut outcome = serde_json::to_value(&study.outcome).unwrap();
    reword(&mut outcome, count);
    Finished {
        outcome: serde_json::from_value(outcome).unwrap(),
        ..study.clone()
    }
}

/// What is concluded from a run.
#[derive(Debug, PartialEq)]
struct Conclusions {
    verdicts: Vec<Verdict>,
    /// The studies that did not pass, with the verdicts of their items.
    order: Vec<(String, Vec<Verdict>)>,
    changes: Vec<GuardedChange>,
    diagnosis: Diagnosis,
    /// Of failing checks by quantity: the diagnosis quotes their claims, so it has no words here.
    failing_checks: Vec<usize>,
}

fn conclusions(read: &[Box<dyn Study>], studies: &[Finished], baseline: &Baseline) -> Conclusions {
    let changes = baseline.compare(studies, None);
    let mut diagnosis = diagnose(&project(), read, studies, &changes).expect("a run that fails");
    let checks = std::mem::take(&mut diagnosis.checks);
    let verdict = |study: &Finished| settle(&study.header.id, study.outcome.clone()).verdict;
    let order = not_passed(studies).into_iter().map(|study| {
        let verdicts = study.items.iter().map(Item::verdict).collect();
        (study.id().to_owned(), verdicts)
    });
    Conclusions {
        verdicts: studies.iter().map(verdict).collect(),
        order: order.collect(),
        changes,
        diagnosis,
        failing_checks: checks.into_iter().map(|(_, count)| count).collect(),
    }
}

#[test]
fn random_words_in_place_of_the_beams_texts_change_no_conclusion() {
    let mut baseline = Baseline::default();
    let read = studies("1.0", "1e-10");
    let sound = finished(&read);
    // Small controls miss some faults, so they have no baseline.
    baseline.bless(&sound[1..], None, None).unwrap();
    let mut failing = finished(&studies("3.0", "1e-30"));
    for (study, sound) in failing.iter_mut().zip(&sound) {
        // The defect is one of the code, not a claim that somebody changed.
        study.header = sound.header.clone();
        // A defect of the stepping moves all numbers of runs in time.
        let moved = match study.header.id.as_str() {
            "controls" | "linear" | "energy" => usize::MAX,
            "frequencies" => 1,
            _ => 0,
        };
        for quantity in study.outcome.quantities.iter_mut().take(moved) {
            quantity.value *= 1.5;
        }
    }
    let mut count = 0;
    let others: Vec<Finished> = failing
        .iter()
        .map(|study| reworded(study, &mut count))
        .collect();
    assert!(count > 60, "{count}");
    let before = conclusions(&read, &failing, &baseline);
    // What needs no time steps passes, so a setting separates it from what fails.
    let passing = before.verdicts.iter().filter(|verdict| verdict.is_pass());
    assert_eq!(
        (passing.count(), before.verdicts.len()),
        (1 + OTHERS, 4 + OTHERS)
    );
    let diagnosis = &before.diagnosis;
    assert!(!diagnosis.contrast.settings.is_empty(), "{before:?}");
    assert!(!diagnosis.moved.is_empty(), "{before:?}");
    assert_eq!(
        before.order.last().unwrap().0,
        "controls",
        "it fails for another's sake"
    );
    assert!(
        before.failing_checks.iter().any(|count| *count > 1),
        "{before:?}"
    );
    assert!(before.changes.len() > 2, "{before:?}");
    assert!(diagnosis.claims.is_empty() && !diagnosis.first.is_empty());
    assert!(!diagnosis.look_at.is_empty(), "{before:?}");
    assert_eq!(before, conclusions(&read, &others, &baseline));
}
