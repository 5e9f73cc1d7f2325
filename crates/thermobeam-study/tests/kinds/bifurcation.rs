use convergence_judge::interval::Interval;
use convergence_study::Verdict;
use thermobeam_study::studies::bifurcation::{AtRest, BifurcationResult, Diagram, study};

use super::planted::verdict_with;
use super::typed::passes_but_not_without_each_case;

fn diagram(change: fn(&mut Diagram)) -> Box<dyn Fn(&mut BifurcationResult)> {
    Box::new(move |found| match found {
        BifurcationResult::Diagram(diagram) => change(diagram),
        _ => panic!("no diagram"),
    })
}

fn force(value: f64) -> Box<dyn Fn(&mut BifurcationResult)> {
    Box::new(move |found| *found = BifurcationResult::Force(value))
}

fn rest(change: fn(&mut AtRest)) -> Box<dyn Fn(&mut BifurcationResult)> {
    Box::new(move |found| match found {
        BifurcationResult::Rest(rest) => change(rest),
        _ => panic!("no run to rest"),
    })
}

#[test]
fn each_claim_can_fail() {
    let study = study().kind;
    let sound = passes_but_not_without_each_case(&study);
    let unstable =
        |rest: &mut AtRest| rest.nearest.as_mut().expect("a steady state").state.stable = false;
    for (number, (label, plant)) in [
        (
            "branches, θ_A = 0",
            diagram(|diagram| diagram.ambiguous = 1),
        ),
        (
            "branches, θ_A = 0",
            diagram(|diagram| diagram.branches.clear()),
        ),
        (
            "branches, θ_A = 0",
            diagram(|diagram| diagram.event.low = -0.7),
        ),
        (
            "branches, θ_A = 0",
            diagram(|diagram| diagram.event.high = -0.72),
        ),
        (
            "branches, θ_A = 0",
            diagram(|diagram| diagram.event.high = f64::NAN),
        ),
        (
            "branches, θ_A = 20",
            diagram(|diagram| diagram.event.low = 0.0),
        ),
        (
            "branches, θ_A = 20",
            diagram(|diagram| diagram.event = Interval::around(f64::NAN, 0.0)),
        ),
        (
            "branches, θ_A = 20",
            diagram(|diagram| diagram.counts[5].1 = 3),
        ),
        (
            "branches, θ_A = 20",
            diagram(|diagram| diagram.counts.clear()),
        ),
        (
            "branches, θ_A = 0",
            diagram(|diagram| diagram.proved = Interval::around(f64::NAN, 0.0)),
        ),
        (
            "branches, θ_A = 20",
            diagram(|diagram| diagram.proved = Interval::around(0.2, 0.0)),
        ),
        ("buckling force, n = 64", force(0.7116)),
        ("buckling force, n = 128", force(0.711606)),
        ("buckling force, n = 8", force(f64::NAN)),
        (
            "to rest, θ_A = 0, β = -0.71",
            rest(|rest| rest.tip[0] = 0.01),
        ),
        (
            "to rest, θ_A = 0, β = -0.715",
            rest(|rest| rest.tip[0] = 0.0),
        ),
        (
            "to rest, θ_A = 20, β = 1",
            rest(|rest| rest.tip[0] = f64::NAN),
        ),
        ("to rest, θ_A = 20, β = 1", rest(unstable)),
        ("to rest, θ_A = 20, β = 1", rest(|rest| rest.nearest = None)),
        (
            "to rest, θ_A = 20, β = 1",
            rest(|rest| rest.nearest.as_mut().expect("a steady state").distance = 0.01),
        ),
        (
            "to rest, θ_A = 20, β = 1",
            rest(|rest| rest.nearest.as_mut().expect("a steady state").distance = f64::NAN),
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let case = sound
            .iter()
            .position(|ran| ran.case.label == label)
            .unwrap_or_else(|| panic!("no case {label}"));
        assert_ne!(
            verdict_with(&study, &sound, case, plant),
            Verdict::Pass,
            "defect {number}, in {label}"
        );
    }
}
