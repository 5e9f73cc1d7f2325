//! Quantities of the last step of each case of a batch, computed from the stepper's own arrays
//! without copying a level.

use crate::energy::Balance;
use crate::energy::sums::{Element, Fields, Sums};
use crate::lanes::Lane;
use crate::motion::Work;
use crate::solve::control::Progress;
use crate::solve::newton::Newton;
use crate::solve::stepper::Batch;

impl<T: Lane, const B: usize> Batch<T> for Newton<T, B> {
    fn balances(&self, balances: &mut [Balance]) {
        let sums = self.sums();
        let tip = self.old.len() - 1;
        for (k, balance) in balances
            .iter_mut()
            .enumerate()
            .filter(|(k, _)| self.controls[*k].state == Progress::Accepted)
        {
            // After the step `old` holds its new level and `new` the previous one.
            let tip = [&self.new, &self.old].map(|level| level[tip][0].lane(k));
            *balance = Balance::from_sums(
                &self.cases[k],
                &sums.of_lane(k),
                tip,
                self.controls[k].force,
            );
        }
    }

    fn work_of(&self, k: usize) -> Work {
        self.controls[k].work
    }

    fn contact_force(&self, k: usize) -> f64 {
        self.controls[k].force
    }
}

impl<T: Lane, const B: usize> Newton<T, B> {
    /// The sums over the elements of the balance, for all lanes at once.
    fn sums(&self) -> Sums<T> {
        let [velocity, before] = match &self.velocity {
            [velocity, before] if !velocity.is_empty() => [velocity, before],
            _ => [&self.iterates[1], &self.iterates[2]],
        };
        let count = self.elements.len();
        // Slices of equal length, so the compiler removes the bounds checks in the loop.
        let elements = &self.elements[..count];
        let old = &self.new[..count];
        let new = &self.old[..count];
        let (before, velocity) = (&before[..count], &velocity[..count]);
        Sums::over_cases(count - 1, 1.0 / self.cases[0].scheme.inertia, |i| Element {
            length: T::from_fn(|k| self.cases[k].lengths[i]),
            inverse: elements[i + 1].inverse,
            old: [
                fields(&old[i], &before[i]),
                fields(&old[i + 1], &before[i + 1]),
            ],
            new: [
                fields(&new[i], &velocity[i]),
                fields(&new[i + 1], &velocity[i + 1]),
            ],
        })
    }
}

#[inline(always)]
fn fields<T: Lane, const B: usize>(state: &[T; B], velocity: &[T; B]) -> Fields<T> {
    let theta = if B == 3 { state[2] } else { T::splat(0.0) };
    Fields {
        u: state[0],
        phi: state[1],
        v: velocity[0],
        w: velocity[1],
        theta,
    }
}
