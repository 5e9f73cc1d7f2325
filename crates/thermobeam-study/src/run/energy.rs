//! The energy over a run, and whether it obeys its law.

use convergence_judge::text::number::max_or_nan;
use serde::Serialize;

use super::{EnergySize, Unsound};

/// The energy over a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EnergySummary {
    /// E^0.
    pub initial: f64,
    /// E^n of the last level.
    #[serde(rename = "final")]
    pub last: f64,
    /// Largest `E^n - E^{n-1}`; negative if the energy always falls, NaN without steps.
    pub largest_increase: f64,
    /// Largest defect of the exact discrete balance, over all steps; NaN with loads.
    pub largest_balance_residual: f64,
    /// Size of the energy at t = 0, see [`EnergySize`].
    #[serde(skip)]
    pub size: f64,
    /// Whether loads act on the beam: their work may raise the energy, and is not in the balance.
    #[serde(skip)]
    pub is_loaded: bool,
}

/// A loose tolerance does not explain an error of the energy above this share of its size: every
/// step of every scheme keeps or lowers the energy, and balances its loss. Without a term in ρ the
/// energy of a buckled beam falls without bound, and errors grow with it.
const UNEXPLAINED: f64 = 1e-3;

impl EnergySummary {
    /// Checks that the energy is finite and, without loads, that it does not rise and keeps its
    /// balance, allowing for rounding and tolerance.
    ///
    /// * `now`: the size of the current level's energy; evaluated only if the size at t = 0 and the
    ///   change since do not explain an error.
    ///
    /// # Errors
    /// [`Unsound`], with the number.
    pub fn sound(&self, now: impl FnOnce() -> EnergySize) -> Result<(), Unsound> {
        for energy in [self.initial, self.last] {
            if !energy.is_finite() {
                return Err(Unsound::NotFinite(energy));
            }
        }
        if self.is_loaded {
            return Ok(());
        }
        // Below the least normal number every sum is rounded to a multiple of the least number.
        let most = UNEXPLAINED * max_or_nan(self.size, (self.last - self.initial).abs());
        let mut most = max_or_nan(most, f64::MIN_POSITIVE);
        let mut rise = self.largest_increase;
        let mut residual = self.largest_balance_residual;
        if !(rise <= most && residual <= most) {
            let EnergySize {
                terms,
                rounding,
                is_solved,
            } = now();
            most = max_or_nan(most, UNEXPLAINED * terms);
            if !is_solved {
                // A fixed number of iterations leaves a defect that nothing bounds in one step, but
                // no number of them may feed the beam. What is not finite stays NaN.
                rise = self.last - self.initial;
                residual *= 0.0;
            }
            let largest = max_or_nan(rise, residual);
            // Rounding that alone exceeds the share explains whatever it is asked to.
            if rounding > most && largest > most && largest <= most + rounding {
                return Err(Unsound::Unresolved { rounding, most });
            }
            most += rounding;
        }
        if !(rise <= most) {
            return Err(Unsound::Rise(rise));
        }
        if !(residual <= most) {
            return Err(Unsound::Imbalance(residual));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a beam without loads, whose size is that of its initial energy.
    fn summary(initial: f64, last: f64, rise: f64, residual: f64) -> EnergySummary {
        EnergySummary {
            initial,
            last,
            largest_increase: rise,
            largest_balance_residual: residual,
            size: initial.abs(),
            is_loaded: false,
        }
    }

    #[test]
    fn the_current_size_and_rounding_errors_explain_an_error() {
        let open = Err(Unsound::Imbalance(1e-9));
        let hidden = |rounding, most| Err(Unsound::Unresolved { rounding, most });
        for (residual, terms, rounding, expected) in [
            (0.0, 0.0, 0.0, Ok(())),
            (1e-9, 0.0, 0.0, open),
            (1e-9, 2e-6, 0.0, Ok(())),
            (1e-9, 0.5e-6, 0.4e-9, open),
            (1e-9, 2f64.powi(-20), 0.9e-9, Ok(())),
            // Rounding alone explains nothing.
            (1e-9, 0.0, 2e-9, hidden(2e-9, f64::MIN_POSITIVE)),
            (
                1e-9,
                2f64.powi(-21),
                2e-9,
                hidden(2e-9, UNEXPLAINED * 2f64.powi(-21)),
            ),
            (
                1e-9,
                0.0,
                f64::INFINITY,
                hidden(f64::INFINITY, f64::MIN_POSITIVE),
            ),
            (1e-9, 2e-6, f64::INFINITY, Ok(())),
        ] {
            let summary = summary(0.0, 0.0, 0.0, residual);
            let size = EnergySize {
                terms,
                rounding,
                is_solved: true,
            };
            let found = summary.sound(|| size);
            assert_eq!(found, expected, "{residual} {terms} {rounding}");
        }
    }

    #[test]
    fn of_steps_that_are_not_solved_only_a_rise_since_the_start_is_unsound() {
        let size = EnergySize {
            terms: 2.0,
            rounding: 0.0,
            is_solved: false,
        };
        let nan = f64::NAN;
        for (last, rise, residual, expected) in [
            (0.5, 0.1, 0.1, Ok(())),
            (1.001, 0.1, 0.1, Ok(())),
            (1.1, 0.01, 0.01, Err(Unsound::Rise(1.1 - 1.0))),
            (0.5, 0.1, nan, Err(Unsound::Imbalance(nan))),
        ] {
            let found = summary(1.0, last, rise, residual).sound(|| size);
            // NaN is no equal of itself.
            assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{last}");
        }
    }

    #[test]
    fn with_loads_only_a_number_that_is_not_finite_is_unsound() {
        let infinite = f64::INFINITY;
        for (last, is_loaded, expected) in [
            (6.0, false, Err(Unsound::Rise(5.0))),
            (6.0, true, Ok(())),
            (infinite, true, Err(Unsound::NotFinite(infinite))),
        ] {
            let summary = EnergySummary {
                is_loaded,
                ..summary(1.0, last, 5.0, f64::NAN)
            };
            let size = EnergySize {
                terms: 1.0,
                rounding: 0.0,
                is_solved: true,
            };
            let found = summary.sound(|| size);
            assert_eq!(found, expected, "{last}, loaded: {is_loaded}");
        }
    }

    #[test]
    fn a_rise_of_the_energy_or_an_imbalance_beyond_rounding_is_unsound_and_so_is_what_is_not_finite()
     {
        let sound = |initial: f64, last, rise, residual| {
            let now = || EnergySize {
                terms: 0.0,
                rounding: 0.0,
                is_solved: true,
            };
            summary(initial, last, rise, residual).sound(now)
        };
        // The energy's own size counts, however small it is.
        for size in [1e-30, 1e-9, 1.0, 1e9] {
            for rise in [-1.0, 0.0, 1e-12, 9e-4] {
                assert_eq!(sound(size, 0.0, rise * size, 9e-4 * size), Ok(()), "{rise}");
            }
            let [risen, open] = [[2e-3, 0.0], [-1.0, 2e-3]]
                .map(|[rise, residual]| sound(size, 0.0, rise * size, residual * size));
            assert_eq!(risen, Err(Unsound::Rise(2e-3 * size)));
            assert_eq!(open, Err(Unsound::Imbalance(2e-3 * size)));
        }
        let nan = f64::NAN;
        for (found, expected) in [
            (sound(100.0, 0.0, 2e-3, 2e-3), Ok(())),
            (sound(0.5, 0.0, 1e264, 0.0), Err(Unsound::Rise(1e264))),
            (sound(0.5, 0.0, nan, 0.0), Err(Unsound::Rise(nan))),
            (sound(0.5, 0.0, 0.0, nan), Err(Unsound::Imbalance(nan))),
            (sound(1.0, -1e21, -1.0, 1e6), Ok(())),
            (sound(1.0, 1.0, -1.0, 1e6), Err(Unsound::Imbalance(1e6))),
            (sound(1.0, nan, -1.0, 0.0), Err(Unsound::NotFinite(nan))),
        ] {
            // NaN is no equal of itself.
            assert_eq!(format!("{found:?}"), format!("{expected:?}"));
        }
        for last in [f64::INFINITY, f64::NEG_INFINITY] {
            let not_finite = Err(Unsound::NotFinite(last));
            let found = [sound(1.0, last, -1.0, 0.0), sound(last, 1.0, -1.0, 0.0)];
            assert_eq!(found, [not_finite; 2]);
        }
    }
}
