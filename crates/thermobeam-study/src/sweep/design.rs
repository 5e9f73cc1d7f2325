//! The values of each key in the sweep file, and their combination into cases.

use super::{MOST_CASES, SceneKey};
use crate::scene::limits::SWEEP_VALUES;
use convergence_judge::judge::random::SplitMix;
use convergence_study::{Field, InputError, internal::store::content_hash};

/// The values of each key: those of a grid, or a number for each sample of a Latin hypercube.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Design {
    /// Every combination; the last key varies fastest.
    Grid(Vec<Vec<f64>>),
    /// Samples drawn beforehand, and the dt and t_end of all cases if dt must divide t_end.
    Latin {
        samples: usize,
        values: Vec<Vec<f64>>,
        steps: Option<(f64, f64)>,
    },
}

impl Design {
    /// The number of cases; more than [`MOST_CASES`] on overflow.
    pub(super) fn cases(&self) -> usize {
        match self {
            Self::Grid(values) => {
                let cases = values
                    .iter()
                    .try_fold(1_usize, |product, values| product.checked_mul(values.len()));
                cases.unwrap_or(MOST_CASES + 1)
            }
            Self::Latin { samples, .. } => *samples,
        }
    }

    /// The values of case `index`, one for each key.
    pub(super) fn values(&self, index: usize, keys: &[SceneKey]) -> Vec<f64> {
        match self {
            Self::Grid(values) => {
                let (mut rest, mut chosen) = (index, vec![0.0; values.len()]);
                for (chosen, values) in chosen.iter_mut().zip(values).rev() {
                    *chosen = values[rest % values.len()];
                    rest /= values.len();
                }
                chosen
            }
            Self::Latin { values, steps, .. } => {
                let drawn = values.iter().map(|values| values[index]).collect();
                match *steps {
                    Some(steps) => with_whole_steps(drawn, keys, steps),
                    None => drawn,
                }
            }
        }
    }
}

/// Rounds a drawn dt, or t_end if only t_end varies, so that dt divides t_end.
fn with_whole_steps(mut values: Vec<f64>, keys: &[SceneKey], (dt, t_end): (f64, f64)) -> Vec<f64> {
    let dt_place = keys.iter().position(|key| key.is("time", "dt"));
    let t_end_place = keys.iter().position(|key| key.is("time", "t_end"));
    match (dt_place, t_end_place) {
        (Some(place), _) => {
            let t_end = t_end_place.map_or(t_end, |place| values[place]);
            values[place] = t_end / (t_end / values[place]).round().max(1.0);
        }
        (None, Some(place)) => values[place] = dt * (values[place] / dt).round().max(1.0),
        (None, None) => {}
    }
    values
}

/// `samples` numbers in [0, 1), one in each of `samples` equal slices, in random order.
///
/// The order depends only on the seed and the key: a new key does not change the numbers of the
/// others.
pub(super) fn stratified(samples: usize, seed: u64, key: SceneKey) -> Vec<f64> {
    let mut random =
        SplitMix::new(SplitMix::new(seed).next_u64() ^ content_hash(key.path().as_bytes()));
    let mut slices: Vec<usize> = (0..samples).collect();
    // Fisher-Yates shuffle.
    for last in (1..samples).rev() {
        slices.swap(last, random.below(last + 1));
    }
    slices
        .into_iter()
        .map(|slice| (slice as f64 + random.uniform()) / samples as f64)
        .collect()
}

/// `{ from, to, scale }`.
struct ParameterRange {
    from: f64,
    to: f64,
    is_log: bool,
}

impl ParameterRange {
    fn read(field: &Field<'_>, key: SceneKey, others: &[&str]) -> Result<Self, InputError> {
        let section = field.section()?;
        section.allow(&[&["from", "to", "scale"], others].concat())?;
        let is_log = section.get("scale").map_or(Ok(false), |field| {
            field.choice(&[("linear", false), ("log", true)])
        })?;
        let end = |name: &str| {
            let field = section.require(name, "a number")?;
            let value = number(&field, key)?;
            if is_log && value <= 0.0 {
                return Err(field.refuse_as_written("a number > 0 on a logarithmic scale"));
            }
            Ok((field, value))
        };
        let (_, from) = end("from")?;
        let (to_field, to) = end("to")?;
        if to <= from {
            return Err(to_field.refuse_as_written(format!("a number > {from:?}, which is from")));
        }
        Ok(Self { from, to, is_log })
    }

    /// The value at the fraction `share` of the range, from 0 to 1.
    fn at(&self, share: f64, key: SceneKey) -> f64 {
        let Self { from, to, is_log } = *self;
        let value = if is_log {
            from * (to / from).powf(share)
        } else {
            from + (to - from) * share
        };
        // Rounded to 9 digits, on which the mathematical libraries of all machines agree.
        if key.is_whole {
            value.round()
        } else {
            format!("{value:.8e}").parse().unwrap_or(value)
        }
    }
}

fn number(field: &Field<'_>, key: SceneKey) -> Result<f64, InputError> {
    if key.is_whole {
        // The scene refuses larger numbers; these are exact as f64.
        return Ok(field.count(1..=1 << 53)? as f64);
    }
    // -0 and 0 are the same value; adding 0 gives 0 for both.
    field.number().map(|value| value + 0.0)
}

/// A varied key, its values, and their place in the file.
pub(super) struct VariedKey<'a> {
    pub(super) key: SceneKey,
    pub(super) values: Vec<f64>,
    /// Values that a scene must accept, with the fields to name otherwise.
    pub(super) probes: Vec<(f64, Field<'a>)>,
}

/// A list, or `{ from, to, count, scale }`.
pub(super) fn grid<'a>(field: Field<'a>, key: SceneKey) -> Result<VariedKey<'a>, InputError> {
    let allowed = "a list of at least one number, or { from, to, count }";
    if field.is_list() {
        let items = field.items(allowed)?;
        let values = items
            .iter()
            .map(|item| number(item, key))
            .collect::<Result<Vec<_>, _>>()?;
        if values.is_empty() {
            return Err(field.refuse_as_written(allowed));
        }
        let mut seen = std::collections::HashSet::new();
        if let Some(twice) = values
            .iter()
            .position(|value| !seen.insert(value.to_bits()))
        {
            return Err(items[twice].refuse(
                format!("{} a second time", items[twice].as_written()),
                "each number once",
            ));
        }
        return Ok(VariedKey {
            key,
            probes: values.iter().copied().zip(items).collect(),
            values,
        });
    }
    if !field.is_table() {
        return Err(field.refuse_as_written(allowed));
    }
    let range = ParameterRange::read(&field, key, &["count"])?;
    let count = field.section()?.require("count", "a whole number >= 2")?;
    let number = count.count(2..=SWEEP_VALUES)?;
    let mut values: Vec<f64> = (0..number)
        .map(|i| range.at(i as f64 / (number - 1) as f64, key))
        .collect();
    values.dedup();
    if values.len() < number {
        return Err(count.refuse(
            format!("{number}, which repeats numbers"),
            format!("at most {}", values.len()),
        ));
    }
    Ok(VariedKey {
        key,
        probes: vec![(values[0], field.clone()), (values[number - 1], field)],
        values,
    })
}

/// `{ from, to, scale }`, and the values of a Latin hypercube in it.
pub(super) fn latin<'a>(
    field: Field<'a>,
    key: SceneKey,
    samples: usize,
    seed: u64,
) -> Result<VariedKey<'a>, InputError> {
    if !field.is_table() {
        return Err(field.refuse_as_written("a range { from, to }"));
    }
    let range = ParameterRange::read(&field, key, &[])?;
    let values = stratified(samples, seed, key)
        .into_iter()
        .map(|share| range.at(share, key))
        .collect();
    Ok(VariedKey {
        key,
        values,
        probes: vec![(range.from, field.clone()), (range.to, field)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::case::KEYS;

    #[test]
    fn every_slice_holds_one_number() {
        for samples in [1, 2, 7, 1000] {
            let mut slices: Vec<usize> = stratified(samples, 3, KEYS[0])
                .iter()
                .map(|x| (x * samples as f64) as usize)
                .collect();
            slices.sort_unstable();
            assert_eq!(slices, (0..samples).collect::<Vec<_>>());
        }
        assert_ne!(stratified(50, 3, KEYS[0]), stratified(50, 3, KEYS[1]));
        assert_ne!(stratified(50, 3, KEYS[0]), stratified(50, 4, KEYS[0]));
    }

    #[test]
    fn every_combination_comes_once_and_the_last_key_runs_fastest() {
        let design = Design::Grid(vec![vec![1.0, 2.0], vec![3.0, 4.0, 5.0]]);
        let cases: Vec<_> = (0..design.cases())
            .map(|index| design.values(index, &KEYS[..2]))
            .collect();
        assert_eq!(
            cases,
            [
                [1.0, 3.0],
                [1.0, 4.0],
                [1.0, 5.0],
                [2.0, 3.0],
                [2.0, 4.0],
                [2.0, 5.0]
            ]
        );
        let huge = Design::Grid(vec![vec![0.0; 1 << 13]; 6]);
        assert!(huge.cases() > MOST_CASES);
    }
}
