//! An interval of a parameter, as studies sample it.

use super::prelude::*;
use convergence_study::file::Finite;

/// Two ends, ascending; positive on a logarithmic scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SampledInterval {
    pub(crate) low: f64,
    pub(crate) high: f64,
    is_logarithmic: bool,
}

impl SampledInterval {
    /// The interval with these ends.
    ///
    /// # Errors
    /// They do not ascend, or one is not positive on a logarithmic scale.
    pub(crate) fn new(
        path: &str,
        ends: [Finite; 2],
        is_logarithmic: bool,
    ) -> Result<Self, Refusal> {
        let [low, high] = ends.map(Finite::get);
        if low < high && (!is_logarithmic || low > 0.0) {
            return Ok(Self {
                low,
                high,
                is_logarithmic,
            });
        }
        let positive = if is_logarithmic { " > 0" } else { "" };
        Err(Refusal::written(
            path,
            format!("two ascending numbers{positive}"),
        ))
    }

    /// Values from the first end to the last, equally spaced on its scale.
    ///
    /// * `points`: at least 2.
    pub(crate) fn values(&self, points: usize) -> Vec<f64> {
        (0..points)
            .map(|k| self.value(k as f64 / (points - 1) as f64))
            .collect()
    }

    /// * `share`: of the way from the first end to the last.
    fn value(&self, share: f64) -> f64 {
        let Self { low, high, .. } = *self;
        if self.is_logarithmic {
            low * (high / low).powf(share)
        } else {
            low + (high - low) * share
        }
    }
}

#[cfg(test)]
mod tests {
    use super::SampledInterval;

    #[test]
    fn values_are_equally_spaced_on_the_scale_of_the_interval() {
        let [linear, logarithmic] = [false, true].map(|is_logarithmic| {
            let [low, high] = [1.0, 100.0];
            let interval = SampledInterval {
                low,
                high,
                is_logarithmic,
            };
            interval.values(3)
        });
        assert_eq!(linear, [1.0, 50.5, 100.0]);
        assert_eq!(logarithmic, [1.0, 10.0, 100.0]);
    }
}
