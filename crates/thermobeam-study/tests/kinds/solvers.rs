//! The two solvers: the studies of each part pass, and fail on each of their claims.

use super::planted::{defects, each_fails, verdict_with};
use super::typed::{Runs, changed, counted, leaves_one_out, passes_but_not_without_each_case};
use super::{parsed, read, text};
use convergence_study::{Kind, Outcome, Verdict, run_one};
use thermobeam_study::kinds::solvers::{
    Agreement, Boundary, Contraction, FixedPointStep, MapPoint, NewtonSteps, SolverResult, Solvers,
};

fn row(found: &mut SolverResult) -> &mut Vec<MapPoint> {
    if let SolverResult::Row(row) = found {
        &mut row.points
    } else {
        panic!("no row: {found:?}")
    }
}

fn boundary(found: &mut SolverResult) -> &mut Boundary {
    if let SolverResult::Boundary(line) = found {
        line
    } else {
        panic!("no boundary: {found:?}")
    }
}

fn newton(found: &mut SolverResult) -> &mut NewtonSteps {
    row(found)[3].newton.as_mut().expect("steps")
}

fn crossing(found: &mut SolverResult) -> &mut FixedPointStep {
    boundary(found).found.as_mut().expect("a boundary")
}

fn contraction(found: &mut SolverResult) -> &mut Contraction {
    if let SolverResult::Contraction(contraction) = found {
        contraction
    } else {
        panic!("no contraction: {found:?}")
    }
}

fn agreement(found: &mut SolverResult) -> &mut Agreement {
    if let SolverResult::Comparison(agreement) = found {
        agreement
    } else {
        panic!("no comparison: {found:?}")
    }
}

#[test]
fn the_coarse_map_passes_but_not_without_each_case_and_fails_on_each_claim() {
    let study: Solvers = read("stability-coarse.toml");
    let sound = passes_but_not_without_each_case(&study);
    // The first row is the stiffest; its shortest step converges, its longest does not.
    each_fails(
        &study,
        &sound,
        0,
        defects!(|found| [
            row(found)[0].step.converged = false,
            row(found)[11].step.converged = true,
            row(found)[0].step.alpha = f64::NAN,
            row(found)[0].step.gamma = f64::NAN,
            row(found)[0].step.contraction = Some(f64::NAN),
            row(found)[0].newton_completes = false,
            row(found).iter_mut().for_each(|point| point.newton = None),
            row(found).truncate(5),
            newton(found).iterations = 31,
            newton(found).iterations = usize::MAX,
            newton(found).contact_force = 0.0,
            newton(found).contact_force = -1.0,
            newton(found).contact_force = f64::NAN,
            newton(found).worst.open = 1.1,
            newton(found).worst.open = f64::NAN,
            newton(found).worst.risen = 1.1,
            newton(found).worst.risen = f64::NAN,
            newton(found).worst.residual = f64::INFINITY,
            newton(found).worst.residual = f64::NAN,
        ]),
    );
    lines_fail(&study, &sound, 12);
    let items = ["points for convergence", "points for the balance"];
    let reason = "factors near 1, which predict nothing";
    leaves_one_out(&study, &sound, 0, [items[0], reason], |found| {
        row(found)[0].step.alpha = 0.9;
    });
    let reason = "no step by Newton's method";
    leaves_one_out(&study, &sound, 0, [items[1], reason], |found| {
        row(found)[0].newton = None;
    });
    for items in items {
        leaves_one_out(&study, &sound, 0, [items, "without a result"], |found| {
            row(found).pop();
        });
    }
    let boundaries = "boundaries for alpha = 1 alone";
    for gamma in [0.02, f64::NAN] {
        leaves_one_out(
            &study,
            &sound,
            12,
            [boundaries, "gamma takes part"],
            |found| {
                crossing(found).gamma = gamma;
            },
        );
    }
    let reason = "no boundary on the map";
    leaves_one_out(&study, &sound, 12, [boundaries, reason], |found| {
        boundary(found).found = None;
    });
    // Where α decides nowhere, there is no distance to it.
    let nowhere = changed::<Solvers>(&sound, |_, found| {
        if let SolverResult::Boundary(line) = found {
            line.found.as_mut().expect("a boundary").gamma = 0.02;
        }
    });
    let outcome = study.judge(&nowhere);
    assert!(
        outcome.headline.to_string().starts_with("no boundary"),
        "{}",
        outcome.headline
    );
    assert_eq!(
        counted(&outcome, boundaries)
            .expect("none is judged")
            .judged,
        0
    );
}

/// Each boundary must be at α = 1; the results from `first` onwards are lines.
fn lines_fail(study: &Solvers, sound: &Runs<Solvers>, first: usize) {
    for index in first..sound.len() {
        each_fails(
            study,
            sound,
            index,
            defects!(|found| [
                boundary(found).found = None,
                boundary(found).predicted = None,
                boundary(found).predicted = Some(f64::NAN),
                crossing(found).alpha = 1.03,
                crossing(found).alpha = 0.97,
                crossing(found).alpha = f64::NAN,
                crossing(found).gamma = f64::INFINITY,
            ]),
        );
    }
}

#[test]
fn the_fixed_point_passes_but_not_without_each_case_and_fails_on_each_claim() {
    let study: Solvers = read("fixed-point.toml");
    let mut sound = passes_but_not_without_each_case(&study);
    let mut settled = 0;
    let mut compared = 0;
    for index in 0..sound.len() {
        let found = sound[index].found.as_mut().expect("a result");
        if let SolverResult::Comparison(_) = found {
            compared += 1;
            each_fails(
                &study,
                &sound,
                index,
                defects!(|found| [
                    agreement(found).solvers.distance = 1e-4,
                    agreement(found).solvers.distance = f64::NAN,
                ]),
            );
            continue;
        }
        let Contraction {
            iterations,
            measured,
            radius,
            ..
        } = *contraction(found);
        let with = |change: &dyn Fn(&mut Contraction)| {
            verdict_with(&study, &sound, index, |found| change(contraction(found)))
        };
        each_fails(
            &study,
            &sound,
            index,
            defects!(|found| [
                contraction(found).alpha = f64::NAN,
                contraction(found).gamma = f64::NAN,
                contraction(found).deviation = 1.1e-3,
                contraction(found).deviation = f64::NAN,
                contraction(found).measured = f64::NAN,
                contraction(found).radius = f64::NAN,
            ]),
        );
        // With fewer iterations other eigenvalues still take part.
        let is_settled = iterations >= 5;
        settled += usize::from(is_settled);
        for wrong in [1.02, 0.98] {
            for verdict in [
                with(&|found| found.measured = wrong * measured),
                with(&|found| found.radius = wrong * radius),
            ] {
                assert_eq!(
                    verdict == Verdict::Fail,
                    is_settled,
                    "case {index}, {wrong}"
                );
            }
        }
    }
    assert_eq!((settled, compared), (39, 4));
    let factors = |outcome: &Outcome| {
        let count = counted(outcome, "factors").expect("some are left out");
        (count.judged, count.asked)
    };
    assert_eq!(factors(&study.judge(&sound)), (39, 45));
    for index in 0..45 {
        let Contraction { iterations, .. } =
            *contraction(sound[index].found.as_mut().expect("a result"));
        if iterations >= 5 {
            let reason = "fewer than 5 iterations";
            leaves_one_out(&study, &sound, index, ["factors", reason], |found| {
                contraction(found).iterations = 4;
            });
        }
    }
    // No point with a known factor: no distance of the factor.
    let unsettled = changed::<Solvers>(&sound, |_, found| {
        if let SolverResult::Contraction(point) = found {
            point.iterations = 4;
        }
    });
    let outcome = study.judge(&unsettled);
    assert_eq!(factors(&outcome), (0, 45));
    assert!(
        outcome.headline.to_string().contains("no factor is known"),
        "{}",
        outcome.headline
    );
}

#[test]
fn the_comparison_of_solvers_meets_an_obstacle_and_speaks_of_shade_only_then() {
    let caption = |study: &Solvers| {
        let mut figures = run_one(study).figures;
        figures.retain(|figure| figure.file.ends_with("-iterations.svg"));
        let figure = figures.pop().expect("a figure of iterations");
        (
            figure.caption.contains("shaded"),
            figure.svg.contains("in contact"),
        )
    };
    assert_eq!(caption(&read("fixed-point.toml")), (true, true));
    let early = text("fixed-point.toml").replace("steps = 3000", "steps = 100");
    assert_eq!(caption(&parsed(&early)), (false, false));
}

#[test]
fn a_study_may_have_several_parts() {
    let parts = text("stability-coarse.toml")
        .replace("points = 12", "points = 3")
        .replace("[1e-6, 1e-3]", "[1e-3]")
        + "\n[contraction]\nelements = 20\ndt = [1e-3]\nepsilon = [1e-3]\nzeta = [0.1]\n";
    let study: Solvers = parsed(&parts);
    let outcome = run_one(&study);
    assert_eq!(
        (
            study.cases().len(),
            outcome.tables.len(),
            outcome.figures.len()
        ),
        (5, 2, 5)
    );
    assert!(
        outcome
            .summary
            .to_string()
            .contains("to 0.0 % at 1; 9 points"),
        "{}",
        outcome.summary
    );
}
