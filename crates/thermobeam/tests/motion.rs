//! What every motion promises, by both methods.

use crate::prelude::*;

/// A beam that is thrown at its upper obstacle, by both methods of [`OneStep`] and by [`Dg`].
fn motions() -> [Box<dyn Motion>; 3] {
    let problem = DgProblem {
        beam: Beam::default(),
        obstacles: Some(Obstacles::default()),
        mesh: uniform(2),
        degree: 6,
        initial: InitialFunctions {
            u_t: Box::new(|x| x),
            ..InitialFunctions::at_rest(0.0)
        },
    };
    let linear = on_mesh(&problem, uniform(40));
    let [newton, fixed_point] =
        Solver::ALL.map(|solver| simulate(&linear, with(MIDPOINT, by(solver), 1e-3)));
    let dg = of_any_order(problem, DgStepping::default());
    [Box::new(newton), Box::new(fixed_point), Box::new(dg)]
}

#[test]
fn a_motion_ends_at_the_limit_and_stays_there() {
    for mut motion in motions() {
        assert!(!motion.has_reached(0.05) && motion.has_reached(0.0));
        motion.advance(0.05).unwrap();
        let steps = motion.steps();
        assert!((motion.t() - 0.05).abs() < 1e-15 && steps > 0);
        for limit in [0.05, 0.01, f64::NAN] {
            assert!(motion.has_reached(limit));
            assert_eq!(motion.step(limit), Ok(None));
            motion.advance(limit).unwrap();
        }
        assert_eq!(motion.steps(), steps);
        assert!(motion.step(0.06).unwrap().is_some());
        assert_eq!(motion.steps(), steps + 1);
    }
}

#[test]
fn reports_add_up_to_times_and_counts() {
    for mut motion in motions() {
        let start = motion.work();
        let mut length = 0.0;
        let mut iterations = 0;
        let mut contact_steps = 0;
        let mut highest = motion.tip_range().high;
        while let Some(report) = motion.step(0.3).unwrap() {
            length += report.dt;
            iterations += report.iterations;
            contact_steps += usize::from(report.in_contact);
            let TipRange { low, high } = motion.tip_range();
            assert!(low <= high && report.increment.is_finite(), "{report:?}");
            highest = highest.max(high);
        }
        assert!((length - motion.t()).abs() < 1e-12);
        assert!(motion.work().passes - start.passes >= iterations);
        assert!(motion.work().factorizations > 0);
        assert!(contact_steps > 0 && contact_steps < motion.steps());
        let g2 = Obstacles::default().g2;
        assert!(highest > g2 && highest < 1.2 * g2, "{highest}");
        assert!(motion.is_heated() && !motion.is_loaded());
    }
}
