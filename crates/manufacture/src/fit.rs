//! Least squares with a few columns.

/// A function at the points.
pub(crate) type Column = Vec<f64>;

/// What fits best.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fitted {
    /// One for each column.
    pub(crate) factors: Vec<f64>,
    /// The norm of what is left.
    pub(crate) residual: f64,
}

/// The largest absolute value of some numbers.
pub(crate) fn largest(numbers: &[f64]) -> f64 {
    let sizes = numbers.iter().map(|number| number.abs());
    sizes.fold(0.0, f64::max)
}

/// The Euclidean norm, without overflow.
pub(crate) fn norm(column: &[f64]) -> f64 {
    let largest = largest(column);
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let sum: f64 = column.iter().map(|value| (value / largest).powi(2)).sum();
    largest * sum.sqrt()
}

fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn subtract(from: &mut [f64], times: f64, column: &[f64]) {
    for (value, other) in from.iter_mut().zip(column) {
        *value -= times * other;
    }
}

/// Takes the parts along orthonormal columns from a column, twice against loss of orthogonality.
///
/// * Returns what it has taken along each.
fn take_parts(column: &mut [f64], basis: &[Column]) -> Vec<f64> {
    let mut parts = vec![0.0; basis.len()];
    for _ in 0..2 {
        for (sum, direction) in parts.iter_mut().zip(basis) {
            let part = inner(direction, column);
            *sum += part;
            subtract(column, part, direction);
        }
    }
    parts
}

/// Columns below this share of their norm after orthogonalisation depend on those before.
const DEPENDENT: f64 = 1e-12;

/// The combination of columns that is closest to the target, by Gram-Schmidt.
///
/// A column that depends on those before it has the factor 0.
pub(crate) fn least_squares(columns: &[&Column], target: &[f64]) -> Fitted {
    let count = columns.len();
    let mut basis: Vec<Column> = vec![];
    // triangle[j][i]: the part of column j along basis vector i.
    let mut triangle: Vec<Vec<f64>> = vec![];
    for column in columns {
        let mut rest = (*column).clone();
        let mut parts = take_parts(&mut rest, &basis);
        let length = norm(&rest);
        let is_independent = length > DEPENDENT * norm(column);
        parts.push(if is_independent { length } else { 0.0 });
        let scale = if is_independent { 1.0 / length } else { 0.0 };
        basis.push(rest.iter().map(|value| value * scale).collect());
        triangle.push(parts);
    }
    let mut rest = target.to_vec();
    let sides = take_parts(&mut rest, &basis);
    let mut factors = vec![0.0; count];
    for i in (0..count).rev() {
        let known: f64 = (i + 1..count).map(|j| triangle[j][i] * factors[j]).sum();
        let pivot = triangle[i][i];
        factors[i] = if pivot == 0.0 {
            0.0
        } else {
            (sides[i] - known) / pivot
        };
    }
    Fitted {
        factors,
        residual: norm(&rest),
    }
}

/// The columns of which more than a share is left by those before them.
///
/// * `dependent`: the share of its norm that is left of a column which depends on others.
pub(crate) fn independent(columns: &[Column], dependent: f64) -> Vec<usize> {
    let mut found: Vec<usize> = vec![];
    for (place, column) in columns.iter().enumerate() {
        let before: Vec<&Column> = found.iter().map(|other| &columns[*other]).collect();
        if least_squares(&before, column).residual > dependent * norm(column) {
            found.push(place);
        }
    }
    found
}
