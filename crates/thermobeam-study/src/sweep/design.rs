//! How values are combined into cases.

use super::{Key, MOST_CASES};
use convergence_study::judge::random::SplitMix;
use convergence_study::store::content_hash;

/// A grid, or samples drawn beforehand.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Design {
    /// The values of each key; every combination, the last key running fastest.
    Grid(Vec<Vec<f64>>),
    /// The values of each key, one for each sample, and the base scene's dt and t_end where the one must divide the other.
    Latin { samples: usize, values: Vec<Vec<f64>>, steps: Option<(f64, f64)> },
}

impl Design {
    /// The number of cases; more than [`MOST_CASES`] where it would overflow.
    pub(super) fn cases(&self) -> usize {
        match self {
            Self::Grid(values) => values
                .iter()
                .try_fold(1_usize, |product, values| product.checked_mul(values.len()))
                .unwrap_or(MOST_CASES + 1),
            Self::Latin { samples, .. } => *samples,
        }
    }

    /// The values of case `index`, one for each key.
    pub(super) fn values(&self, index: usize, keys: &[Key]) -> Vec<f64> {
        match self {
            Self::Grid(values) => combination(values, index),
            Self::Latin { values, steps, .. } => {
                let drawn = values.iter().map(|values| values[index]).collect();
                match *steps {
                    Some((dt, t_end)) => with_whole_steps(drawn, keys, dt, t_end),
                    None => drawn,
                }
            }
        }
    }
}

fn combination(values: &[Vec<f64>], index: usize) -> Vec<f64> {
    let mut rest = index;
    let mut chosen: Vec<f64> = values
        .iter()
        .rev()
        .map(|values| {
            let value = values[rest % values.len()];
            rest /= values.len();
            value
        })
        .collect();
    chosen.reverse();
    chosen
}

/// Rounds a drawn dt, or t_end where it alone varies, so that dt divides t_end.
fn with_whole_steps(mut drawn: Vec<f64>, keys: &[Key], dt: f64, t_end: f64) -> Vec<f64> {
    let place = |name| keys.iter().position(|key| key.is("time", name));
    let t_end_drawn = place("t_end").map(|place| drawn[place]).unwrap_or(t_end);
    match (place("dt"), place("t_end")) {
        (Some(place), _) => drawn[place] = t_end_drawn / (t_end_drawn / drawn[place]).round().max(1.0),
        (None, Some(place)) => drawn[place] = dt * (drawn[place] / dt).round().max(1.0),
        (None, None) => {}
    }
    drawn
}

/// `samples` numbers in [0, 1), one in each of as many slices, in random order.
///
/// The order depends on the seed and the key alone: adding a key does not change the numbers of the others.
pub(super) fn stratified(samples: usize, seed: u64, key: Key) -> Vec<f64> {
    let mut random = SplitMix::new(SplitMix::new(seed).next_u64() ^ content_hash(key.path().as_bytes()));
    let mut slices: Vec<usize> = (0..samples).collect();
    // The shuffle of Fisher and Yates.
    for last in (1..samples).rev() {
        slices.swap(last, random.below(last + 1));
    }
    slices.into_iter().map(|slice| (slice as f64 + random.uniform()) / samples as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::key::KEYS;

    #[test]
    fn every_slice_holds_one_number() {
        for samples in [1, 2, 7, 1000] {
            let mut slices: Vec<usize> =
                stratified(samples, 3, KEYS[0]).iter().map(|x| (x * samples as f64) as usize).collect();
            slices.sort_unstable();
            assert_eq!(slices, (0..samples).collect::<Vec<_>>());
        }
        assert_ne!(stratified(50, 3, KEYS[0]), stratified(50, 3, KEYS[1]));
        assert_ne!(stratified(50, 3, KEYS[0]), stratified(50, 4, KEYS[0]));
    }

    #[test]
    fn every_combination_comes_once_and_the_last_key_runs_fastest() {
        let design = Design::Grid(vec![vec![1.0, 2.0], vec![3.0, 4.0, 5.0]]);
        let cases: Vec<_> = (0..design.cases()).map(|index| design.values(index, &KEYS[..2])).collect();
        assert_eq!(cases, [[1.0, 3.0], [1.0, 4.0], [1.0, 5.0], [2.0, 3.0], [2.0, 4.0], [2.0, 5.0]]);
        let huge = Design::Grid(vec![vec![0.0; 1 << 13]; 6]);
        assert!(huge.cases() > MOST_CASES);
    }
}
