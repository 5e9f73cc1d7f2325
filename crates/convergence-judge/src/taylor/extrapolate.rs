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
/// the smallest [bar](bar_of).
///
/// * `points`: x, falling; `values`: those there; `noises`: how far each may be off.
pub(super) fn to_zero(points: &[f64], values: &[f64], noises: &[f64]) -> Extrapolated {
    let rows = rows(points, values, noises);
    let mut best = Extrapolated {
        value: values.last().copied().unwrap_or(f64::NAN),
        bar: f64::INFINITY,
    };
    for (row, three) in rows.windows(3).enumerate() {
        for column in 1..three[1].len() {
            let shrinks_by = points[row + 2] / points[row + 1 - column];
            let bar = bar_of(three, column, shrinks_by);
            if bar < best.bar {
                let value = three[1][column].value;
                best = Extrapolated { value, bar };
            }
        }
    }
    best
}

/// The rows of the scheme. Entry k of row i is the value at zero of the polynomial through the
/// points i - k to i; its bar is the noise of the values times the weights with which they enter.
fn rows(points: &[f64], values: &[f64], noises: &[f64]) -> Vec<Vec<Extrapolated>> {
    let mut rows: Vec<Vec<Extrapolated>> = vec![];
    for (row, ((point, value), noise)) in points.iter().zip(values).zip(noises).enumerate() {
        let mut entries = vec![Extrapolated {
            value: *value,
            bar: *noise,
        }];
        for column in 1..=row.min(MOST_COLUMNS) {
            let left = entries[column - 1];
            let upper_left = rows[row - 1][column - 1];
            let weight = 1.0 / (points[row - column] / point - 1.0);
            entries.push(Extrapolated {
                value: left.value + weight * (left.value - upper_left.value),
                bar: left.bar + weight * (left.bar + upper_left.bar),
            });
        }
        rows.push(entries);
    }
    rows
}

/// How far an entry of the middle one of three rows may be off: its largest difference from its
/// neighbours, and its noise.
///
/// The neighbours to the left and above are entries of lower degree, which may agree by chance: the
/// quotients 1 + x/8 - x² of x + x²/8 - x³ are 1.0025 at 0.1 and at 0.025, and so is the line
/// through them at 0, where 1 is right. The entry below, of the next finer points, tells: the error
/// of the entry is c times the product of its points, that of the one below c times the product of
/// its own, smaller by `shrinks_by`, which is the finest point over the coarsest. So the difference
/// of both is the error times 1 - `shrinks_by`, but for noise. Entries of the last row have no
/// witness, and are not taken.
///
/// The noise of the entry below is larger: by the ratio of two points, which is 4. Where it hides
/// that difference, four times the noise of the entry itself is as large.
fn bar_of(three: &[Vec<Extrapolated>], column: usize, shrinks_by: f64) -> f64 {
    let [above, entries, below] = [0, 1, 2].map(|row| &three[row]);
    let entry = entries[column];
    let off = |other: &Extrapolated| (entry.value - other.value).abs();
    let coarser = [
        entries.get(column - 1),
        above.get(column - 1),
        above.get(column),
    ];
    let coarser = coarser.into_iter().flatten().map(off);
    let finer = off(&below[column]) / (1.0 - shrinks_by);
    coarser.fold(finer, f64::max) + NOISE_MARGIN * entry.bar
}

/// The noise of N values: their divided difference of order N - 1, which is zero for values of a
/// polynomial of degree N - 2, over the root of the sum of its squared weights.
pub(super) fn noise_of<const N: usize>(points: [f64; N], values: [f64; N]) -> f64 {
    let weights: [f64; N] = std::array::from_fn(|place| {
        let others = (0..N).filter(|other| *other != place);
        1.0 / others
            .map(|other| points[place] - points[other])
            .product::<f64>()
    });
    let difference: f64 = weights.iter().zip(values).map(|(w, v)| w * v).sum();
    let size: f64 = weights.iter().map(|w| w * w).sum();
    difference.abs() / size.sqrt()
}
