//! The value at zero of a polynomial that is known at some points, but for noise.

/// A limit with its bar.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extrapolated {
    /// The limit.
    pub(super) value: f64,
    /// How far it may be off.
    pub(super) bar: f64,
}

/// Columns of the scheme of Neville and Aitken beyond which noise has the last word.
const MOST_COLUMNS: usize = 8;

/// By how much a noise may exceed its size as estimated.
const NOISE_MARGIN: f64 = 4.0;

/// The value at x = 0 by the scheme of Neville and Aitken, of which that entry is taken that has
/// the smallest bar: the largest difference from its three neighbours, and the noise of the values
/// times the sum of the weights with which they enter.
///
/// * `points`: x, falling; `values`: those there; `noises`: how far each may be off.
pub(super) fn to_zero(points: &[f64], values: &[f64], noises: &[f64]) -> Extrapolated {
    let mut best = Extrapolated {
        value: values.last().copied().unwrap_or(f64::NAN),
        bar: f64::INFINITY,
    };
    let mut above: Vec<Extrapolated> = vec![];
    for (row, ((point, value), noise)) in points.iter().zip(values).zip(noises).enumerate() {
        let mut entries = vec![Extrapolated {
            value: *value,
            bar: *noise,
        }];
        for column in 1..=row.min(MOST_COLUMNS) {
            let left = entries[column - 1];
            let upper_left = above[column - 1];
            let weight = 1.0 / (points[row - column] / point - 1.0);
            let entry = Extrapolated {
                value: left.value + weight * (left.value - upper_left.value),
                bar: left.bar + weight * (left.bar + upper_left.bar),
            };
            let neighbours = [Some(left), Some(upper_left), above.get(column).copied()];
            let neighbours = neighbours.into_iter().flatten();
            let differences = neighbours.map(|other| (entry.value - other.value).abs());
            let bar = differences.fold(0.0, f64::max) + NOISE_MARGIN * entry.bar;
            if bar < best.bar {
                best = Extrapolated {
                    value: entry.value,
                    bar,
                };
            }
            entries.push(entry);
        }
        above = entries;
    }
    best
}

/// The noise of four values: their divided difference of third order, which is zero for values of
/// a parabola, over the root of the sum of its squared weights.
pub(super) fn noise_of(points: [f64; 4], values: [f64; 4]) -> f64 {
    let weights = [0, 1, 2, 3].map(|place| {
        let others = (0..4).filter(|other| *other != place);
        1.0 / others
            .map(|other| points[place] - points[other])
            .product::<f64>()
    });
    let difference: f64 = weights.iter().zip(values).map(|(w, v)| w * v).sum();
    let size: f64 = weights.iter().map(|w| w * w).sum();
    difference.abs() / size.sqrt()
}
