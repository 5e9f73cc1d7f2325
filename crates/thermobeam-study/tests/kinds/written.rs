use thermobeam_study::studies::written::{Pair, RunNumbers, study};

use super::*;

/// Mistakes of what writes a run, as they show in its files.
#[test]
fn each_mistake_in_what_is_written_fails() {
    let sound = Sound::run(study().kind);
    let first: fn(&mut Vec<Pair>) -> &mut RunNumbers = |pairs| &mut pairs[0].written;
    // No last level where the stride does not divide.
    sound.fails_in(
        0,
        first,
        defects!(|run| [run.rows.pop(), run.counts[2] -= 1.0]),
    );
    // Half of the viscous work, and two phases of contact in one.
    sound.fails_in(
        1,
        first,
        defects!(|run| [
            run.rows.iter_mut().for_each(|row| row[9] *= 0.5),
            run.phases[0][1] = run.phases.remove(1)[1],
        ]),
    );
    // A phase of dG that ends too late.
    sound.fails_in(
        2,
        first,
        defects!(|run| [adds_up(run), run.phases[0][1] += 2e-3]),
    );
    // The contact force of half a depth.
    sound.fails_in(
        3,
        first,
        defects!(|run| [run.rows[..5].iter_mut().for_each(|row| row[6] *= 0.5)]),
    );
    // The end of another case of the sweep.
    sound.fails(
        4,
        defects!(|pairs| [pairs[0].written.rows[0][0] = pairs[1].written.rows[0][0]]),
    );
}

/// Sums that go on from row to row.
fn adds_up(written: &mut RunNumbers) {
    let mut sums = [0.0; 6];
    for row in &mut written.rows {
        for (sum, term) in sums.iter_mut().zip(&mut row[8..]) {
            *sum += *term;
            *term = *sum;
        }
    }
}
