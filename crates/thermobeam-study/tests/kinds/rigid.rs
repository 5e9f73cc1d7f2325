//! Obstacles becoming rigid: the study passes, and fails on each of its claims.

use super::planted::{defects, each_fails, verdict_with};
use super::typed::{leaves_one_out, passes_but_not_without_each_case};
use convergence_study::{Kind, Verdict};
use thermobeam_study::studies::rigid::{RunOf, ShownImpact, study};

#[test]
fn every_claim_about_rigid_obstacles_can_fail() {
    let study = study().kind;
    let sound = passes_but_not_without_each_case(&study);
    let position = |run: RunOf, nth: usize| {
        let of_run = |&index: &usize| sound[index].case.data.1 == run;
        (0..sound.len()).filter(of_run).nth(nth).expect("a case")
    };
    let impacts = sound.iter().filter(|ran| ran.case.data.1 == RunOf::Impact);
    let stiffest = impacts.count() - 1;
    let with = |run: RunOf, nth: usize, change: &dyn Fn(&mut ShownImpact)| {
        verdict_with(&study, &sound, position(run, nth), change)
    };
    assert_eq!(with(RunOf::Impact, 0, &|_| ()), Verdict::Pass);
    for wrong in [f64::NAN, 0.0, 2.0] {
        for run in [RunOf::Bouncing, RunOf::Rest, RunOf::Impact] {
            let verdict = with(run, stiffest, &|found| {
                *found.penetration.as_mut().expect("a penetration") *= wrong;
            });
            assert_ne!(verdict, Verdict::Pass, "{run:?} times {wrong}");
        }
    }
    let impact = position(RunOf::Impact, stiffest);
    each_fails(
        &study,
        &sound,
        impact,
        defects!(|found| [*found.velocity.as_mut().expect("a velocity") *= 1.02,]),
    );
    let rest = position(RunOf::Rest, stiffest);
    each_fails(
        &study,
        &sound,
        rest,
        defects!(|found| [found.force = Some(f64::NAN)]),
    );
    for (nth, mean) in [(0, 0.1), (stiffest, 9.0)] {
        let verdict = with(RunOf::Bouncing, nth, &|found| {
            (found.mean_iterations, found.most_iterations) = (Some(mean), 99);
        });
        assert_eq!(verdict, Verdict::Fail, "Newton's iterations of case {nth}");
    }
    // A case gives the same result every time.
    let again = &sound[position(RunOf::Impact, 6)];
    assert_eq!(again.ok(), study.run(&again.case.data).ok().as_ref());
    let tip = with(RunOf::RigidLimit, 0, &|found| {
        found.tip.truncate(3);
    });
    assert_ne!(tip, Verdict::Pass);
    // The softest obstacle has α < 0.8, the stiffest α > 1.
    for (nth, failed_at) in [(0, Some(0.5)), (stiffest, None), (0, Some(f64::NAN))] {
        let verdict = with(RunOf::FixedPoint, nth, &|found| {
            found.failed_at = failed_at;
        });
        assert_eq!(verdict, Verdict::Fail, "fixed point {nth}: {failed_at:?}");
    }
    let alpha = |index: usize| sound[index].ok().and_then(|found| found.alpha);
    let is_judged = |index: &usize| alpha(*index).is_some_and(|alpha| (0.01..0.8).contains(&alpha));
    let judged = (0..sound.len()).find(is_judged);
    let judged = judged.expect("a factor that is judged");
    each_fails(
        &study,
        &sound,
        judged,
        defects!(|found| [
            found.contraction = None,
            found.contraction = Some(f64::NAN),
            found.contraction = Some(0.9),
        ]),
    );
    let stiff = position(RunOf::FixedPoint, stiffest);
    let factor = "compliances for the factor α";
    for (index, alpha, items) in [
        (
            judged,
            0.005,
            [factor, "too few iterations to show a factor"],
        ),
        (judged, 0.9, [factor, "α near 1 or above"]),
        (
            judged,
            0.9,
            ["compliances for the end of convergence", "α just below 1"],
        ),
        (
            stiff,
            0.5,
            [
                "compliances on a fixed grid for an order",
                "a time step resolves the impact",
            ],
        ),
    ] {
        leaves_one_out(&study, &sound, index, items, |found| {
            found.alpha = Some(alpha);
        });
    }
}
