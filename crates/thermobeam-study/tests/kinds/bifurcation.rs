use convergence_judge::interval::Interval;
use thermobeam_study::studies::bifurcation::{AtRest, BifurcationResult, Diagram, study};
use thermobeam_study::studies::equilibria::Nearest;

use super::*;

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
    let sound = Sound::checked(study().kind);
    sound.never_passes(
        "branches, θ_A = 0",
        defects!(|found| [
            diagram(found).ambiguous = 1,
            diagram(found).branches.clear(),
            diagram(found).event.low = -0.7,
            diagram(found).event.high = -0.72,
            diagram(found).event.high = f64::NAN,
            diagram(found).proved = Interval::around(f64::NAN, 0.0),
        ]),
    );
    sound.never_passes(
        "branches, θ_A = 20",
        defects!(|found| [
            diagram(found).event.low = 0.0,
            diagram(found).event = Interval::around(f64::NAN, 0.0),
            diagram(found).counts[5].1 = 3,
            diagram(found).counts.clear(),
            diagram(found).proved = Interval::around(0.2, 0.0),
        ]),
    );
    for (n, force) in [(64, 0.7116), (128, 0.711606), (8, f64::NAN)] {
        let label = format!("buckling force, n = {n}");
        let wrong = sound.at(&*label, |found| *found = BifurcationResult::Force(force));
        assert_ne!(wrong.verdict, Verdict::Pass, "n = {n}");
    }
    sound.never_passes(
        "to rest, θ_A = 0, β = -0.71",
        defects!(|found| [rest(found).tip[0] = 0.01]),
    );
    sound.never_passes(
        "to rest, θ_A = 0, β = -0.715",
        defects!(|found| [rest(found).tip[0] = 0.0]),
    );
    sound.never_passes(
        "to rest, θ_A = 20, β = 1",
        defects!(|found| [
            rest(found).tip[0] = f64::NAN,
            near(found).state.stable = false,
            rest(found).nearest = None,
            near(found).distance = 0.01,
            near(found).distance = f64::NAN,
        ]),
    );
}
