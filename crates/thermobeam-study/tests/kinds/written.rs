use convergence_study::Kind as _;
use thermobeam_study::studies::written::{RunNumbers, study};

use super::planted::{defects, each_fails};

/// Mistakes of what writes a run, as they show in its files.
#[test]
fn each_mistake_in_what_is_written_fails() {
    let study = study().kind;
    let sound = study.run_here();
    each_fails(
        &study,
        &sound,
        0,
        defects!(|pairs| [
            // No last level where the stride does not divide.
            pairs[0].written.rows.pop(),
            pairs[0].written.counts[2] -= 1.0,
        ]),
    );
    each_fails(
        &study,
        &sound,
        1,
        defects!(|pairs| [
            // Half of the viscous work.
            pairs[0]
                .written
                .rows
                .iter_mut()
                .for_each(|row| row[9] *= 0.5),
            // Two phases of contact in one.
            pairs[0].written.phases[0][1] = pairs[0].written.phases.remove(1)[1],
        ]),
    );
    each_fails(
        &study,
        &sound,
        2,
        defects!(|pairs| [
            adds_up(&mut pairs[0].written),
            // A phase of dG that ends too late.
            pairs[0].written.phases[0][1] += 2e-3,
        ]),
    );
    each_fails(
        &study,
        &sound,
        3,
        defects!(|pairs| [
            // The contact force of half a depth.
            pairs[0].written.rows[..5]
                .iter_mut()
                .for_each(|row| row[6] *= 0.5),
        ]),
    );
    each_fails(
        &study,
        &sound,
        4,
        defects!(|pairs| [
            // The end of another case of the sweep.
            pairs[0].written.rows[0][0] = pairs[1].written.rows[0][0],
        ]),
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
