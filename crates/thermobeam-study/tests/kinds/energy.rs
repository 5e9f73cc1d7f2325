use thermobeam_study::kinds::runs::energy::one_by_one::EnergyRuns;
use thermobeam_study::kinds::runs::energy::random::{Batch, RandomScenes};

use super::*;

#[test]
fn an_energy_that_rises_and_a_balance_that_stays_open_fail() {
    let sound = Sound::checked(read::<EnergyRuns>("energy-decay.toml"));
    for case in 0..sound.runs.len() {
        sound.fails(
            case,
            defects!(|found| [
                found.worst.rise = 2e-14,
                found.worst.residual = 2e-14,
                found.worst.rise = f64::NAN,
                found.worst.residual = f64::NAN,
                found.worst.open = f64::NAN,
                found.drift = f64::NAN,
                found.moved = 1e-13,
                found.moved = f64::NAN,
                found.initial_energy = f64::INFINITY,
                found.steps -= 1,
                found.end = End::NotFinite,
            ]),
        );
        let found = sound.found(case);
        let [first, last] = [&found.samples[0], found.samples.last().expect("samples")];
        // 1000 steps; every third is a sample, and the last step.
        assert_eq!((first.t, last.step, found.steps), (0.0, 1000, 1000));
        assert!((last.t - 1.0).abs() < 1e-12 && last.change < 0.0);
    }
}

/// Of a beam at rest each scheme would close the balance; so it would in a step of no length.
#[test]
fn an_energy_that_no_step_changes_fails() {
    for (initial, dt) in [("", "0.1"), ("u_t = \"x\"", "1e-300")] {
        let text = format!(
            "study = {{ id = \"a\", claim = \"b\", tier = \"quick\", kind = \"runs/energy\" }}\n[[case]]\n\
             name = \"a\"\nclaim = \"the energy falls\"\nends = \"answer\"\nmesh.elements = 10\n\
             time = {{ dt = {dt}, t_end = {dt} }}\n[case.initial]\n{initial}\n"
        );
        let study = EnergyRuns::parse(&text, Path::new("a.toml")).unwrap();
        let checks = run_one(&study).checks;
        let failing = checks.iter().find(|check| !check.verdict.is_pass());
        let words = failing.expect("a failing check").evidence.to_string();
        assert!(words.contains("nothing moves by more than"), "{words}");
    }
}

#[test]
fn each_claim_of_a_case_can_fail() {
    let sound = Sound::checked(read::<EnergyRuns>("extremes.toml"));
    sound.fails(
        "hat",
        defects!(|found| [
            found.end = End::Indefinite,
            found.steps = 199,
            found.moved = 9e-12,
            found.worst.open = 1.1,
            found.worst.risen = 1.1,
            found.worst.risen = f64::NAN,
            found.worst.residual = f64::NAN,
        ]),
    );
    for label in ["buckled-too-long-a-step", "compliance-1e-8-fixed-point"] {
        sound.fails(label, defects!(|found| [found.end = End::Answer]));
    }
    sound.fails(
        "no-viscosity-midpoint",
        defects!(|found| [found.drift = -1.1e-11, found.drift = f64::NAN]),
    );
    let items = ["runs for the balance", "without a step"];
    sound.leaves_one_out("hat", items, |found| found.steps = 0);
    // Without a step there is no largest residual.
    let unmoved = sound.with(|_, found| found.steps = 0);
    assert_eq!(unmoved.headline, "no step".into());
    let outcome = run_one(&sound.study);
    let mut figures = outcome.figures.iter();
    let drift = figures.find(|figure| figure.file.ends_with("drift.svg"));
    let svg = drift.expect("a drift").svg();
    assert!(svg.contains(">allowed<") || svg.contains("allowed\n"));
}

/// The bound of Corollary 3.2 holds at every level, and does not depend on h or dt: the same beam
/// reaches nearly the same share of it.
#[test]
fn the_bound_of_corollary_3_2_can_fail_and_depends_on_neither_h_nor_dt() {
    let sound = Sound::checked(read::<EnergyRuns>("corollary-3.2.toml"));
    let count = sound.runs.len();
    for index in [1, count - 1] {
        sound.fails(
            index,
            defects!(|found| [
                found.of_bound = Some(1.01),
                found.of_bound = Some(f64::NAN),
                found.lost = Some(1.01),
                found.lost = Some(f64::NAN),
            ]),
        );
    }
    // A loss that counts twice would exceed the energy of every unheated case.
    sound.fails(
        0,
        defects!(|found| [
            found.of_bound = None,
            found.lost = None,
            found.lost = found.lost.map(|lost| 2.0 * lost),
        ]),
    );
    // Each beam without heating on two meshes by two steps, then the heated ones on a coarse and on
    // a fine pair.
    let heated = count - 4;
    let beams = heated / 4;
    let share = |index: usize| sound.found(index).of_bound.expect("a share");
    for index in beams..count {
        let first = if index < heated {
            index % beams
        } else {
            index - index % 2
        };
        let (coarse, here) = (share(first), share(index));
        let label = &sound.runs[index].case.label;
        assert!(
            (here / coarse - 1.0).abs() < 0.05,
            "{label}: {here}, {coarse}"
        );
    }
}

/// An answer less, and an end of this kind more.
fn ends(batch: &mut Batch, end: End) {
    batch.ends[End::Answer as usize] -= 1;
    batch.ends[end as usize] += 1;
}

#[test]
fn each_claim_of_the_random_scenes_can_fail() {
    let sound = Sound::checked(read::<RandomScenes>("random-scenes-quick.toml"));
    for case in 0..sound.runs.len() {
        sound.fails(
            case,
            defects!(|batch| [
                batch.refused = 1,
                batch.not_finite_levels = 1,
                ends(batch, End::IterationLimit),
                ends(batch, End::NotFinite),
                batch.ends[End::Answer as usize] -= 1,
                batch.scenes[..2]
                    .iter_mut()
                    .for_each(|scene| scene[scene.len() - 1] = 1e-11),
                batch.worst.open = 1.1,
                batch.worst.risen = 1.1,
                batch.worst.open = f64::NAN,
                batch.worst.risen = f64::NAN,
                batch.worst.rise = f64::NAN,
                batch.worst.residual = f64::NAN,
            ]),
        );
        for (reason, end) in [
            ("refused, the operator is not definite", End::Indefinite),
            ("ended by another failure", End::NotFinite),
        ] {
            let items = ["scenes to their last step", reason];
            sound.leaves_one_out(case, items, |batch| ends(batch, end));
        }
    }
}
