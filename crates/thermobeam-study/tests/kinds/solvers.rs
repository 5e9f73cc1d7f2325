//! The two solvers: the studies of each part pass, and fail on each of their claims.

use thermobeam_study::kinds::solvers::{
    Agreement, Boundary, Contraction, FixedPointStep, MapPoint, NewtonSteps, SolverResult, Solvers,
};

use super::*;

fn row(found: &mut SolverResult) -> &mut Vec<MapPoint> {
    match found {
        SolverResult::Row(row) => &mut row.points,
        _ => panic!("no row: {found:?}"),
    }
}

fn boundary(found: &mut SolverResult) -> &mut Boundary {
    match found {
        SolverResult::Boundary(line) => line,
        _ => panic!("no boundary: {found:?}"),
    }
}

fn newton(found: &mut SolverResult) -> &mut NewtonSteps {
    row(found)[3].newton.as_mut().expect("steps")
}

fn crossing(found: &mut SolverResult) -> &mut FixedPointStep {
    boundary(found).found.as_mut().expect("a boundary")
}

fn contraction(found: &mut SolverResult) -> &mut Contraction {
    match found {
        SolverResult::Contraction(contraction) => contraction,
        _ => panic!("no contraction: {found:?}"),
    }
}

fn agreement(found: &mut SolverResult) -> &mut Agreement {
    match found {
        SolverResult::Comparison(agreement) => agreement,
        _ => panic!("no comparison: {found:?}"),
    }
}

#[test]
fn the_coarse_map_passes_but_not_without_each_case_and_fails_on_each_claim() {
    let sound = Sound::checked(read::<Solvers>("stability-coarse.toml"));
    // The first row is the stiffest; its shortest step converges, its longest does not.
    sound.fails_in(
        0,
        row,
        defects!(|row| [
            row[0].step.converged = false,
            row[11].step.converged = true,
            row[0].step.alpha = f64::NAN,
            row[0].step.gamma = f64::NAN,
            row[0].step.contraction = Some(f64::NAN),
            row[0].newton_completes = false,
            row.iter_mut().for_each(|point| point.newton = None),
            row.truncate(5),
        ]),
    );
    sound.fails_in(
        0,
        newton,
        defects!(|steps| [
            steps.iterations = 31,
            steps.iterations = usize::MAX,
            steps.contact_force = 0.0,
            steps.contact_force = -1.0,
            steps.contact_force = f64::NAN,
            steps.worst.open = 1.1,
            steps.worst.open = f64::NAN,
            steps.worst.risen = 1.1,
            steps.worst.risen = f64::NAN,
            steps.worst.residual = f64::INFINITY,
            steps.worst.residual = f64::NAN,
        ]),
    );
    lines_fail(&sound, 12);
    let [convergence, balance] = ["points for convergence", "points for the balance"];
    let near = [convergence, "factors near 1, which predict nothing"];
    sound.leaves_one_out(0, near, |found| row(found)[0].step.alpha = 0.9);
    let unsolved = [balance, "no step by Newton's method"];
    sound.leaves_one_out(0, unsolved, |found| row(found)[0].newton = None);
    for items in [convergence, balance] {
        sound.leaves_one_out(0, [items, "without a result"], |found| _ = row(found).pop());
    }
    let boundaries = "boundaries for alpha = 1 alone";
    for gamma in [0.02, f64::NAN] {
        let of_both = [boundaries, "gamma takes part"];
        sound.leaves_one_out(12, of_both, |found| crossing(found).gamma = gamma);
    }
    let none = [boundaries, "no boundary on the map"];
    sound.leaves_one_out(12, none, |found| boundary(found).found = None);
    // Where α decides nowhere, there is no distance to it.
    let nowhere = sound.with(|_, found| {
        if let SolverResult::Boundary(line) = found {
            line.found.as_mut().expect("a boundary").gamma = 0.02;
        }
    });
    let headline = nowhere.headline.to_string();
    assert!(headline.starts_with("no boundary"), "{headline}");
    let count = counted(&nowhere, boundaries).expect("none is judged");
    assert_eq!(count.judged, 0);
}

/// Each boundary must be at α = 1; the results from `first` onwards are lines.
fn lines_fail(sound: &Sound<Solvers>, first: usize) {
    for index in first..sound.runs.len() {
        sound.fails_in(
            index,
            boundary,
            defects!(|line| [
                line.found = None,
                line.predicted = None,
                line.predicted = Some(f64::NAN),
            ]),
        );
        sound.fails_in(
            index,
            crossing,
            defects!(|step| [
                step.alpha = 1.03,
                step.alpha = 0.97,
                step.alpha = f64::NAN,
                step.gamma = f64::INFINITY,
            ]),
        );
    }
}

/// Each number of a point of the fixed point can fail; whether its factor is known.
fn point_fails(sound: &Sound<Solvers>, index: usize, point: &Contraction) -> bool {
    sound.fails_in(
        index,
        contraction,
        defects!(|point| [
            point.alpha = f64::NAN,
            point.gamma = f64::NAN,
            point.deviation = 1.1e-3,
            point.deviation = f64::NAN,
            point.measured = f64::NAN,
            point.radius = f64::NAN,
        ]),
    );
    // With fewer iterations other eigenvalues still take part.
    let is_settled = point.iterations >= 5;
    for wrong in [1.02, 0.98] {
        let changes: [fn(&mut Contraction, f64); 2] = [
            |point, wrong| point.measured *= wrong,
            |point, wrong| point.radius *= wrong,
        ];
        for change in changes {
            let outcome = sound.at(index, |found| change(contraction(found), wrong));
            let fails = outcome.verdict == Verdict::Fail;
            assert_eq!(fails, is_settled, "case {index}, {wrong}");
        }
    }
    if is_settled {
        let items = ["factors", "fewer than 5 iterations"];
        sound.leaves_one_out(index, items, |found| contraction(found).iterations = 4);
    }
    is_settled
}

#[test]
fn the_fixed_point_passes_but_not_without_each_case_and_fails_on_each_claim() {
    let sound = Sound::checked(read::<Solvers>("fixed-point.toml"));
    let (mut settled, mut compared) = (0, 0);
    for index in 0..sound.runs.len() {
        if let SolverResult::Contraction(point) = sound.found(index) {
            settled += usize::from(point_fails(&sound, index, point));
            continue;
        }
        compared += 1;
        sound.fails_in(
            index,
            agreement,
            defects!(|compared| [
                compared.solvers.distance = 1e-4,
                compared.solvers.distance = 0.0,
                compared.solvers.distance = f64::NAN,
            ]),
        );
    }
    assert_eq!((settled, compared), (39, 4));
    let factors = |outcome: &Outcome| {
        let count = counted(outcome, "factors").expect("some are left out");
        (count.judged, count.asked)
    };
    assert_eq!(factors(&sound.with(|_, _| ())), (39, 45));
    // No point with a known factor: no distance of the factor.
    let unsettled = sound.with(|_, found| {
        if let SolverResult::Contraction(point) = found {
            point.iterations = 4;
        }
    });
    assert_eq!(factors(&unsettled), (0, 45));
    assert_eq!(unsettled.verdict, Verdict::Fail);
    let headline = unsettled.headline.to_string();
    assert!(headline.contains("no factor is known"), "{headline}");
}

#[test]
fn the_comparison_of_solvers_meets_an_obstacle_and_speaks_of_shade_only_then() {
    let text = text("fixed-point.toml");
    let early = text.replace("steps = 3000", "steps = 100");
    for (text, meets) in [(text, true), (early, false)] {
        let outcome = run_one(&parsed::<Solvers>(&text));
        let says_so = outcome
            .headline
            .to_string()
            .contains("without a step in contact");
        assert_eq!(says_so, !meets);
        let mut figures = outcome.figures;
        figures.retain(|figure| figure.file.ends_with("-iterations.svg"));
        let figure = figures.pop().expect("a figure of iterations");
        assert_eq!(figure.caption.contains("shaded"), meets);
        assert_eq!(figure.svg().contains("in contact"), meets);
    }
}

#[test]
fn a_study_may_have_several_parts() {
    let parts = text("stability-coarse.toml")
        .replace("points = 12", "points = 3")
        .replace("[1e-6, 1e-3]", "[1e-3]")
        + "\n[contraction]\nelements = 20\ndt = [1e-3]\nepsilon = [1e-3]\nzeta = [0.1]\n";
    let study: Solvers = parsed(&parts);
    let outcome = run_one(&study);
    let counts = [
        study.cases().len(),
        outcome.tables.len(),
        outcome.figures.len(),
    ];
    assert_eq!(counts, [5, 2, 5]);
    let summary = outcome.summary.to_string();
    assert!(summary.contains("to 0.0 % at 1; 9 points"), "{summary}");
}
