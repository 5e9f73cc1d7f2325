use convergence_study::{FromFile, Kind, Outcome, Verdict};
use thermobeam_study::kinds::runs::RunStudy;
use thermobeam_study::kinds::runs::cases::End;
use thermobeam_study::kinds::runs::energy::ROW;
use thermobeam_study::kinds::runs::energy::one_by_one::{self, EnergyHistory};
use thermobeam_study::kinds::runs::energy::random::{self, Batch};

use super::file;
use super::planted::verdict_with;
use super::refused::refusal;
use super::typed::{changed, leaves_one_out, passes_but_not_without_each_case};

type EnergyRuns = RunStudy<one_by_one::EnergyRuns>;
type RandomScenes = RunStudy<random::RandomScenes>;

fn runs(name: &str) -> EnergyRuns {
    EnergyRuns::read(file(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// A change of a case's results, with its name.
type Defect<F> = (&'static str, fn(&mut F));

#[test]
fn an_energy_that_rises_and_a_balance_that_stays_open_fail() {
    let study = runs("energy-decay.toml");
    let sound = passes_but_not_without_each_case(&study);
    let planted: [Defect<EnergyHistory>; 9] = [
        ("a rise", |found| found.worst.rise = 2e-14),
        ("a residual", |found| found.worst.residual = 2e-14),
        ("a rise that is not finite", |found| {
            found.worst.rise = f64::NAN;
        }),
        ("a residual that is not finite", |found| {
            found.worst.residual = f64::NAN;
        }),
        ("a bound that is not finite", |found| {
            found.worst.open = f64::NAN;
        }),
        ("a sum that is not finite", |found| found.drift = f64::NAN),
        ("an energy that is not finite", |found| {
            found.initial_energy = f64::INFINITY;
        }),
        ("a missing step", |found| found.steps -= 1),
        ("another end", |found| found.end = End::NotFinite),
    ];
    for case in 0..sound.len() {
        for (what, plant) in planted {
            let runs = changed::<EnergyRuns>(&sound, |index, found| {
                if index == case {
                    plant(found);
                }
            });
            assert_eq!(
                study.judge(&runs).verdict,
                Verdict::Fail,
                "{what} in {}",
                sound[case].case.label
            );
        }
    }
}

#[test]
fn the_samples_of_a_run_end_with_its_last_step() {
    // 1000 steps; every third is a sample.
    for ran in runs("energy-decay.toml").run_here() {
        let found = ran.found.expect("a run");
        let last = found.samples.last().expect("samples");
        assert_eq!((last.step, found.steps), (1000, 1000), "{}", ran.case.label);
        assert!((last.t - 1.0).abs() < 1e-12 && last.change < 0.0);
    }
}

#[test]
fn each_claim_of_a_case_can_fail() {
    let study = runs("extremes.toml");
    let sound = passes_but_not_without_each_case(&study);
    let planted: [(&str, Defect<EnergyHistory>); 10] = [
        ("hat", ("another end", |found| found.end = End::Indefinite)),
        ("hat", ("a missing step", |found| found.steps = 199)),
        ("hat", ("an open balance", |found| found.worst.open = 1.1)),
        ("hat", ("a rise", |found| found.worst.risen = 1.1)),
        (
            "hat",
            ("a rise that is not finite", |found| {
                found.worst.risen = f64::NAN;
            }),
        ),
        (
            "hat",
            ("a residual that is not finite", |found| {
                found.worst.residual = f64::NAN;
            }),
        ),
        (
            "buckled-too-long-a-step",
            ("an answer", |found| found.end = End::Answer),
        ),
        (
            "compliance-1e-8-fixed-point",
            ("an answer", |found| found.end = End::Answer),
        ),
        (
            "no-viscosity-midpoint",
            ("a drift", |found| found.drift = -1.1e-11),
        ),
        (
            "no-viscosity-midpoint",
            ("a drift that is not finite", |found| found.drift = f64::NAN),
        ),
    ];
    for (label, (what, plant)) in planted {
        let case = sound
            .iter()
            .position(|ran| ran.case.label == label)
            .expect("a case");
        let runs = changed::<EnergyRuns>(&sound, |index, found| {
            if index == case {
                plant(found);
            }
        });
        assert_eq!(
            study.judge(&runs).verdict,
            Verdict::Fail,
            "{what} in {label}"
        );
    }
    let stepped = sound.iter().position(|ran| ran.case.label == "hat");
    let items = ["runs for the balance", "without a step"];
    leaves_one_out(&study, &sound, stepped.expect("a case"), items, |found| {
        found.steps = 0;
    });
    // Without a step there is no largest residual.
    let unmoved = changed::<EnergyRuns>(&sound, |_, found| found.steps = 0);
    assert_eq!(study.judge(&unmoved).headline, "no step".into());
}

/// The bound of Corollary 3.2 holds at every level, and does not depend on h or dt: the same beam
/// reaches nearly the same share of it.
#[test]
fn the_bound_of_corollary_3_2_can_fail_and_depends_on_neither_h_nor_dt() {
    let study = runs("corollary-3.2.toml");
    let sound = passes_but_not_without_each_case(&study);
    for wrong in [1.01, f64::NAN] {
        for index in [1, sound.len() - 1] {
            let above = verdict_with(&study, &sound, index, |found| found.of_bound = Some(wrong));
            assert_eq!(above, Verdict::Fail, "{wrong} of the bound in case {index}");
            let lost = verdict_with(&study, &sound, index, |found| found.lost = Some(wrong));
            assert_eq!(
                lost,
                Verdict::Fail,
                "{wrong} of the energy lost in case {index}"
            );
        }
    }
    for what in ["of_bound", "lost"] {
        let missing = verdict_with(&study, &sound, 0, |found| match what {
            "of_bound" => found.of_bound = None,
            _ => found.lost = None,
        });
        assert_eq!(missing, Verdict::Fail, "{what}");
    }
    // Losses that count twice would exceed the energy of every unheated case.
    let twice = verdict_with(&study, &sound, 0, |found| {
        found.lost = found.lost.map(|lost| 2.0 * lost);
    });
    assert_eq!(twice, Verdict::Fail);
    // Each beam without heating on two meshes by two steps, then the heated ones on a coarse and on
    // a fine pair.
    let heated = sound.len() - 4;
    let beams = heated / 4;
    let share = |index: usize| {
        sound[index]
            .found
            .as_ref()
            .expect("a run")
            .of_bound
            .expect("a share")
    };
    for index in beams..sound.len() {
        let first = if index < heated {
            index % beams
        } else {
            index - index % 2
        };
        let (coarse, here) = (share(first), share(index));
        assert!(
            (here / coarse - 1.0).abs() < 0.05,
            "{}: {here}, {coarse}",
            sound[index].case.label
        );
    }
}

#[test]
fn each_claim_of_the_random_scenes_can_fail() {
    let study = RandomScenes::read(file("random-scenes-quick.toml"))
        .unwrap_or_else(|error| panic!("{error}"));
    let sound = passes_but_not_without_each_case(&study);
    let planted: [Defect<Batch>; 12] = [
        ("a definite operator refused", |batch| batch.refused = 1),
        ("a level that is not finite", |batch| {
            batch.not_finite_levels = 1;
        }),
        ("an iteration limit", |batch| {
            batch.ends[End::Answer as usize] -= 1;
            batch.ends[End::IterationLimit as usize] += 1;
        }),
        ("an end that is not finite", |batch| {
            batch.ends[End::Answer as usize] -= 1;
            batch.ends[End::NotFinite as usize] += 1;
        }),
        ("a scene without an end", |batch| {
            batch.ends[End::Answer as usize] -= 1;
        }),
        ("exceptions", |batch| {
            batch
                .scenes
                .iter_mut()
                .take(2)
                .for_each(|[.., residual]| *residual = 1e-11);
        }),
        ("an open balance", |batch| batch.worst.open = 1.1),
        ("a rise", |batch| batch.worst.risen = 1.1),
        ("an open balance that is not finite", |batch| {
            batch.worst.open = f64::NAN;
        }),
        ("a risen energy that is not finite", |batch| {
            batch.worst.risen = f64::NAN;
        }),
        ("a rise that is not finite", |batch| {
            batch.worst.rise = f64::NAN;
        }),
        ("a residual that is not finite", |batch| {
            batch.worst.residual = f64::NAN;
        }),
    ];
    for case in 0..sound.len() {
        for (what, plant) in planted {
            let runs = changed::<RandomScenes>(&sound, |index, batch| {
                if index == case {
                    plant(batch);
                }
            });
            assert_eq!(
                study.judge(&runs).verdict,
                Verdict::Fail,
                "{what} in batch {case}"
            );
        }
        for (reason, end) in [
            ("refused, the operator is not definite", End::Indefinite),
            ("ended by another failure", End::NotFinite),
        ] {
            let items = ["scenes to their last step", reason];
            leaves_one_out(&study, &sound, case, items, |batch| {
                batch.ends[End::Answer as usize] -= 1;
                batch.ends[end as usize] += 1;
            });
        }
    }
}

#[test]
fn files_with_errors_are_refused() {
    for (name, from, to, message) in [
        (
            "extremes.toml",
            "name = \"hat\"",
            "name = \"velocity-step\"",
            "a name that no other case has",
        ),
        (
            "extremes.toml",
            "ends = \"indefinite\"",
            "ends = \"well\"",
            "ends",
        ),
        ("extremes.toml", "drift = 1e-11", "drift = 0", "drift"),
        ("extremes.toml", "zeta = 0.0", "zeta = -1.0", "beam.zeta"),
        (
            "corollary-3.2.toml",
            "beta = -0.5\nrho = 0.0",
            "beta = -0.72\nrho = 0.0",
            "beta > -0.7116",
        ),
        (
            "random-scenes-quick.toml",
            "batches = 2",
            "batches = 0",
            "random.batches",
        ),
        (
            "random-scenes-quick.toml",
            "[random]",
            "[[random-scenes]]",
            "random-scenes",
        ),
        (
            "random-scenes-quick.toml",
            "[random]",
            "[energy]\n[random]",
            "energy.scenes: missing",
        ),
        (
            "random-scenes-quick.toml",
            "[random]",
            "[[case]]\nname = \"a\"\nclaim = \"b\"\nends = \"answer\"\ntime = { dt = 1, t_end = 1 }\n[random]",
            "random: found a second table; expected one of the tables [energy]",
        ),
        (
            "energy-decay.toml",
            "tolerance = 1e-14",
            "tolerance = 0.0",
            "energy.tolerance",
        ),
        (
            "energy-decay.toml",
            "schemes = [\"euler-crank-nicolson\", \"midpoint\"]",
            "schemes = []",
            "energy.schemes",
        ),
    ] {
        let error = refusal(&ROW, name, from, to);
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn figures_begin_with_the_initial_energy_and_tables_show_what_is_allowed() {
    let study = runs("energy-decay.toml");
    let sound = passes_but_not_without_each_case(&study);
    assert!(
        sound
            .iter()
            .filter_map(|ran| ran.ok())
            .all(|found| found.samples[0].t == 0.0)
    );
    let allowed = |outcome: &Outcome, what: &str| {
        let figure = outcome
            .figures
            .iter()
            .find(|figure| figure.file.ends_with(what))
            .expect(what);
        figure.svg.contains(">allowed<") || figure.svg.contains("allowed\n")
    };
    let residuals = &study.judge(&sound).tables[1];
    assert_eq!(residuals.head, ["scene", "residual", "allowed"]);
    assert_eq!(residuals.rows.len(), 7);
    for row in &residuals.rows {
        let [residual, allowed] = [1, 2].map(|cell: usize| row[cell].parse::<f64>().unwrap());
        assert!(0.0 < residual && residual <= allowed, "{row:?}");
    }
    let study = runs("extremes.toml");
    assert!(allowed(
        &study.judge(&passes_but_not_without_each_case(&study)),
        "drift.svg"
    ));
}

/// Theorem 2.8 for every ρ: a level beyond the bound of (2.8), or a run that ends early, is no
/// pass.
#[test]
fn a_beam_of_any_rho_that_blows_up_fails() {
    let study = runs("theorem-2.8.toml");
    let sound = passes_but_not_without_each_case(&study);
    for index in 0..sound.len() {
        let beyond = verdict_with(&study, &sound, index, |found| found.of_bound = Some(1.01));
        let ended = verdict_with(&study, &sound, index, |found| found.end = End::NotFinite);
        assert_eq!([beyond, ended], [Verdict::Fail; 2], "case {index}");
    }
}
