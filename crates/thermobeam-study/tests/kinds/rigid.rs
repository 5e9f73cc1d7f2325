//! Obstacles becoming rigid: the study passes, and fails on each of its claims.

use thermobeam_study::studies::rigid::{RunOf, ShownImpact, study};

use super::*;

#[test]
fn every_claim_about_rigid_obstacles_can_fail() {
    let sound = Sound::checked(study().kind);
    let of_run = |run: RunOf| {
        let runs = sound.runs.iter().enumerate();
        let own = runs.filter(move |(_, ran)| ran.case.data.1 == run);
        own.map(|(index, _)| index)
    };
    let position = |run: RunOf, nth: usize| of_run(run).nth(nth).expect("a case");
    let stiffest = of_run(RunOf::Impact).count() - 1;
    let with = |run: RunOf, nth: usize, change: &dyn Fn(&mut ShownImpact)| -> Outcome {
        sound.at(position(run, nth), change)
    };
    for wrong in [f64::NAN, 0.0, 2.0] {
        for run in [RunOf::Bouncing, RunOf::Rest, RunOf::Impact] {
            let outcome = with(run, stiffest, &|found| {
                *found.penetration.as_mut().expect("a penetration") *= wrong;
            });
            assert_ne!(outcome.verdict, Verdict::Pass, "{run:?} times {wrong}");
        }
    }
    sound.fails(
        position(RunOf::Impact, stiffest),
        defects!(|found| [*found.velocity.as_mut().expect("a velocity") *= 1.02]),
    );
    sound.fails(
        position(RunOf::Rest, stiffest),
        defects!(|found| [found.force = Some(f64::NAN)]),
    );
    for (nth, mean) in [(0, 0.1), (stiffest, 9.0)] {
        let outcome = with(RunOf::Bouncing, nth, &|found| {
            (found.mean_iterations, found.most_iterations) = (Some(mean), 99);
        });
        let verdict = outcome.verdict;
        assert_eq!(verdict, Verdict::Fail, "Newton's iterations of case {nth}");
    }
    // A case gives the same result every time.
    let again = &sound.runs[position(RunOf::Impact, 6)];
    assert_eq!(again.ok(), sound.study.run(&again.case.data).ok().as_ref());
    let tip = with(RunOf::RigidLimit, 0, &|found| found.tip.truncate(3));
    assert_ne!(tip.verdict, Verdict::Pass);
    // The softest obstacle has α < 0.8, the stiffest α > 1.
    for (nth, failed_at) in [(0, Some(0.5)), (stiffest, None), (0, Some(f64::NAN))] {
        let outcome = with(RunOf::FixedPoint, nth, &|found| found.failed_at = failed_at);
        let verdict = outcome.verdict;
        assert_eq!(verdict, Verdict::Fail, "fixed point {nth}: {failed_at:?}");
    }
    let is_judged = |index: &usize| {
        let alpha = sound.found(*index).alpha;
        alpha.is_some_and(|alpha| (0.01..0.8).contains(&alpha))
    };
    let judged = (0..sound.runs.len()).find(is_judged);
    let judged = judged.expect("a factor that is judged");
    sound.fails(
        judged,
        defects!(|found| [
            found.contraction = None,
            found.contraction = Some(f64::NAN),
            found.contraction = Some(0.9),
        ]),
    );
    let factor = "compliances for the factor α";
    let few = "too few iterations to show a factor";
    let end = "compliances for the end of convergence";
    let order = "compliances on a fixed grid for an order";
    let resolved = "a time step resolves the impact";
    for (index, alpha, items) in [
        (judged, 0.005, [factor, few]),
        (judged, 0.9, [factor, "α near 1 or above"]),
        (judged, 0.9, [end, "α just below 1"]),
        (
            position(RunOf::FixedPoint, stiffest),
            0.5,
            [order, resolved],
        ),
    ] {
        sound.leaves_one_out(index, items, |found| found.alpha = Some(alpha));
    }
}
