use convergence_study::{Kind as _, Verdict};
use thermobeam_study::studies::written::{Pair, study};

use super::planted::verdict_with;

/// Mistakes of what writes a run, as they show in its files.
#[test]
fn each_mistake_in_what_is_written_fails() {
    let study = study().kind;
    let sound = study.run_here();
    type Mistake = fn(&mut Pair);
    let planted: [(&str, usize, Mistake); 7] = [
        (
            "no last level where the stride does not divide",
            0,
            |pair| {
                pair.written.rows.pop();
            },
        ),
        ("half of the viscous work", 1, |pair| {
            pair.written.rows.iter_mut().for_each(|row| row[9] *= 0.5);
        }),
        ("sums that go on from row to row", 2, |pair| {
            let mut sums = [0.0; 6];
            for row in &mut pair.written.rows {
                for (sum, term) in sums.iter_mut().zip(&mut row[8..]) {
                    *sum += *term;
                    *term = *sum;
                }
            }
        }),
        ("two phases of contact in one", 1, |pair| {
            let second = pair.written.phases.remove(1);
            pair.written.phases[0][1] = second[1];
        }),
        ("a phase of dG that ends too late", 2, |pair| {
            pair.written.phases[0][1] += 2e-3;
        }),
        ("the contact force of half a depth", 3, |pair| {
            let force = pair.written.rows.iter_mut().map(|row| &mut row[6]);
            force.take(5).for_each(|force| *force *= 0.5);
        }),
        ("one iteration less", 0, |pair| {
            pair.written.counts[2] -= 1.0;
        }),
    ];
    for (mistake, case, plant) in planted {
        let verdict = verdict_with(&study, &sound, case, |pairs| plant(&mut pairs[0]));
        assert_eq!(verdict, Verdict::Fail, "{mistake}");
    }
    // The end of another case of the sweep.
    let verdict = verdict_with(&study, &sound, 4, |pairs| {
        let time = pairs[1].written.rows[0][0];
        pairs[0].written.rows[0][0] = time;
    });
    assert_eq!(verdict, Verdict::Fail, "the time of another case");
}
