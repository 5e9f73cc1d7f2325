use convergence_judge::interval::Interval;
use convergence_study::Verdict;
use thermobeam_study::studies::bifurcation::{AtRest, BifurcationResult, Diagram, study};
use thermobeam_study::studies::equilibria::Nearest;

use super::planted::{place, verdict_with};
use super::typed::passes_but_not_without_each_case;

fn diagram(found: &mut BifurcationResult) -> &mut Diagram {
    match found {
        BifurcationResult::Diagram(diagram) => diagram,
        _ => panic!("no diagram"),
    }
}

fn rest(found: &mut BifurcationResult) -> &mut AtRest {
    match found {
        BifurcationResult::Rest(rest) => rest,
        _ => panic!("no run to rest"),
    }
}

fn near(found: &mut BifurcationResult) -> &mut Nearest {
    rest(found).nearest.as_mut().expect("a steady state")
}

#[test]
fn each_claim_can_fail() {
    let study = study().kind;
    let sound = passes_but_not_without_each_case(&study);
    type Defect = fn(&mut BifurcationResult);
    let defects: [(&str, &[Defect]); 8] = [
        (
            "branches, θ_A = 0",
            &[
                |found| diagram(found).ambiguous = 1,
                |found| diagram(found).branches.clear(),
                |found| diagram(found).event.low = -0.7,
                |found| diagram(found).event.high = -0.72,
                |found| diagram(found).event.high = f64::NAN,
                |found| diagram(found).proved = Interval::around(f64::NAN, 0.0),
            ],
        ),
        (
            "branches, θ_A = 20",
            &[
                |found| diagram(found).event.low = 0.0,
                |found| diagram(found).event = Interval::around(f64::NAN, 0.0),
                |found| diagram(found).counts[5].1 = 3,
                |found| diagram(found).counts.clear(),
                |found| diagram(found).proved = Interval::around(0.2, 0.0),
            ],
        ),
        (
            "buckling force, n = 64",
            &[|found| *found = BifurcationResult::Force(0.7116)],
        ),
        (
            "buckling force, n = 128",
            &[|found| *found = BifurcationResult::Force(0.711606)],
        ),
        (
            "buckling force, n = 8",
            &[|found| *found = BifurcationResult::Force(f64::NAN)],
        ),
        (
            "to rest, θ_A = 0, β = -0.71",
            &[|found| rest(found).tip[0] = 0.01],
        ),
        (
            "to rest, θ_A = 0, β = -0.715",
            &[|found| rest(found).tip[0] = 0.0],
        ),
        (
            "to rest, θ_A = 20, β = 1",
            &[
                |found| rest(found).tip[0] = f64::NAN,
                |found| near(found).state.stable = false,
                |found| rest(found).nearest = None,
                |found| near(found).distance = 0.01,
                |found| near(found).distance = f64::NAN,
            ],
        ),
    ];
    for (label, defects) in defects {
        for (k, defect) in defects.iter().enumerate() {
            let verdict = verdict_with(&study, &sound, place(&sound, label), defect);
            assert_ne!(verdict, Verdict::Pass, "defect {k}, in {label}");
        }
    }
}
