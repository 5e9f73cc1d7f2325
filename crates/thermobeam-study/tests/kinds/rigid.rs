//! Obstacles becoming rigid: the study passes, and fails on each of its claims.

use crate::file;
use crate::planted::verdict_with;
use crate::typed::passes_but_not_without_each_case;
use convergence_study::judge::verdict::Verdict;
use convergence_study::study::{FromFile, Kind};
use thermobeam_study::kinds::rigid::{Found, RigidStudy, RunOf};

#[test]
fn every_claim_about_rigid_obstacles_can_fail() {
    let study = RigidStudy::read(file("rigid-obstacles.toml")).unwrap_or_else(|error| panic!("{error}"));
    let sound = passes_but_not_without_each_case(&study);
    let position = |run: RunOf, nth: usize| {
        let of_run = sound.iter().enumerate().filter(|(_, ran)| ran.case.data.run == run);
        of_run.map(|(index, _)| index).nth(nth).expect("a case")
    };
    let stiffest = sound.iter().filter(|ran| ran.case.data.run == RunOf::Impact).count() - 1;
    let with = |run: RunOf, nth: usize, change: &dyn Fn(&mut Found)| {
        verdict_with(&study, &sound, position(run, nth), |found| change(found))
    };
    assert_eq!(with(RunOf::Impact, 0, &|_| ()), Verdict::Pass);
    for wrong in [f64::NAN, 0.0, 2.0] {
        let scale = |x: &mut f64| *x *= wrong;
        for (run, nth) in [(RunOf::Bouncing, stiffest), (RunOf::Rest, stiffest), (RunOf::Impact, stiffest)] {
            let verdict = with(run, nth, &|found| match found {
                Found::Bouncing(found) => scale(&mut found.penetration),
                Found::Rest(found) => scale(&mut found.penetration),
                Found::Impact(found) => scale(&mut found.penetration),
                Found::FixedPoint(found) => scale(&mut found.alpha),
            });
            assert_ne!(verdict, Verdict::Pass, "{run:?} times {wrong}");
        }
    }
    let velocity = with(RunOf::Impact, stiffest, &|found| {
        let Found::Impact(found) = found else { panic!("no impact") };
        found.velocity *= 1.02;
    });
    assert_eq!(velocity, Verdict::Fail);
    let force = with(RunOf::Rest, stiffest, &|found| {
        let Found::Rest(found) = found else { panic!("no beam at rest") };
        found.force = f64::NAN;
    });
    assert_eq!(force, Verdict::Fail);
    for nth in [0, stiffest] {
        let verdict = with(RunOf::Bouncing, nth, &|found| {
            let Found::Bouncing(found) = found else { panic!("no bouncing beam") };
            (found.mean_iterations, found.most_iterations) = (if nth == 0 { 0.1 } else { 9.0 }, 99);
        });
        assert_eq!(verdict, Verdict::Fail, "Newton's iterations of case {nth}");
    }
    let again = verdict_with(&study, &sound, position(RunOf::Impact, 6), |found| {
        assert_eq!(*found, study.run(&sound[position(RunOf::Impact, 6)].case.data).expect("a result"));
    });
    assert_eq!(again, Verdict::Pass, "a case gives the same result every time");
    let tip = with(RunOf::RigidLimit, 0, &|found| {
        let Found::Bouncing(found) = found else { panic!("no bouncing beam") };
        found.tip.truncate(3);
    });
    assert_ne!(tip, Verdict::Pass);
    // The softest obstacle has α < 0.8, the stiffest α > 1.
    for (nth, failed_at) in [(0, Some(0.5)), (stiffest, None), (0, Some(f64::NAN))] {
        let verdict = with(RunOf::FixedPoint, nth, &|found| {
            let Found::FixedPoint(found) = found else { panic!("no fixed point") };
            found.failed_at = failed_at;
        });
        assert_eq!(verdict, Verdict::Fail, "fixed point {nth}: {failed_at:?}");
    }
    let judged = sound
        .iter()
        .position(|ran| matches!(&ran.found, Ok(Found::FixedPoint(found)) if (0.01..0.8).contains(&found.alpha)));
    for contraction in [None, Some(f64::NAN), Some(0.9)] {
        let verdict = verdict_with(&study, &sound, judged.expect("a factor that is judged"), |found| {
            let Found::FixedPoint(found) = found else { panic!("no fixed point") };
            found.contraction = contraction;
        });
        assert_eq!(verdict, Verdict::Fail, "{contraction:?}");
    }
}

#[test]
fn a_file_that_makes_no_sense_is_refused() {
    for (from, to, field) in [
        ("1e-1, 3.16e-2", "1e-1, 3.16e-1", "obstacles.epsilon"),
        ("scenes/impact", "scenes/paper-1-beta-0", "impact.scene"),
    ] {
        let name = file("rigid-obstacles.toml");
        let text = crate::text("rigid-obstacles.toml").replacen(from, to, 1);
        let error = RigidStudy::parse(&text, &name).expect_err(to).to_string();
        assert!(error.contains(field), "{error}");
    }
}
