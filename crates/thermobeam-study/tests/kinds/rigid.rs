//! Obstacles becoming rigid: the study passes, and fails on each of its claims.

use super::planted::verdict_with;
use super::typed::{leaves_one_out, passes_but_not_without_each_case};
use convergence_study::{Kind, Verdict};
use thermobeam_study::studies::rigid::{RunOf, ShownImpact, study};

#[test]
fn every_claim_about_rigid_obstacles_can_fail() {
    let study = study().kind;
    let sound = passes_but_not_without_each_case(&study);
    let position = |run: RunOf, nth: usize| {
        let of_run = sound
            .iter()
            .enumerate()
            .filter(|(_, ran)| ran.case.data.1 == run);
        of_run.map(|(index, _)| index).nth(nth).expect("a case")
    };
    let stiffest = sound
        .iter()
        .filter(|ran| ran.case.data.1 == RunOf::Impact)
        .count()
        - 1;
    let with = |run: RunOf, nth: usize, change: &dyn Fn(&mut ShownImpact)| {
        verdict_with(&study, &sound, position(run, nth), |found| change(found))
    };
    assert_eq!(with(RunOf::Impact, 0, &|_| ()), Verdict::Pass);
    for wrong in [f64::NAN, 0.0, 2.0] {
        for (run, nth) in [
            (RunOf::Bouncing, stiffest),
            (RunOf::Rest, stiffest),
            (RunOf::Impact, stiffest),
        ] {
            let verdict = with(run, nth, &|found| {
                *found.penetration.as_mut().expect("a penetration") *= wrong;
            });
            assert_ne!(verdict, Verdict::Pass, "{run:?} times {wrong}");
        }
    }
    let velocity = with(RunOf::Impact, stiffest, &|found| {
        *found.velocity.as_mut().expect("a velocity") *= 1.02;
    });
    assert_eq!(velocity, Verdict::Fail);
    let force = with(RunOf::Rest, stiffest, &|found| {
        found.force = Some(f64::NAN);
    });
    assert_eq!(force, Verdict::Fail);
    for nth in [0, stiffest] {
        let verdict = with(RunOf::Bouncing, nth, &|found| {
            (found.mean_iterations, found.most_iterations) =
                (Some(if nth == 0 { 0.1 } else { 9.0 }), 99);
        });
        assert_eq!(verdict, Verdict::Fail, "Newton's iterations of case {nth}");
    }
    let again = verdict_with(&study, &sound, position(RunOf::Impact, 6), |found| {
        assert_eq!(
            *found,
            study
                .run(&sound[position(RunOf::Impact, 6)].case.data)
                .expect("a result")
        );
    });
    assert_eq!(
        again,
        Verdict::Pass,
        "a case gives the same result every time"
    );
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
    let judged = sound.iter().position(|ran| {
        ran.ok().is_some_and(|found| {
            found
                .alpha
                .is_some_and(|alpha| (0.01..0.8).contains(&alpha))
        })
    });
    for contraction in [None, Some(f64::NAN), Some(0.9)] {
        let verdict = verdict_with(
            &study,
            &sound,
            judged.expect("a factor that is judged"),
            |found| {
                found.contraction = contraction;
            },
        );
        assert_eq!(verdict, Verdict::Fail, "{contraction:?}");
    }
    let judged = judged.expect("a factor that is judged");
    for (alpha, reason) in [
        (0.005, "too few iterations to show a factor"),
        (0.9, "α near 1 or above"),
    ] {
        let items = "compliances for the factor α";
        leaves_one_out(&study, &sound, judged, [items, reason], |found| {
            found.alpha = Some(alpha);
        });
    }
    let items = ["compliances for the end of convergence", "α just below 1"];
    leaves_one_out(&study, &sound, judged, items, |found| {
        found.alpha = Some(0.9);
    });
    let stiff = position(RunOf::FixedPoint, stiffest);
    let reason = "a time step resolves the impact";
    let items = ["compliances on a fixed grid for an order", reason];
    leaves_one_out(&study, &sound, stiff, items, |found| {
        found.alpha = Some(0.5);
    });
}
