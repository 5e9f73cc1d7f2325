//! Tensors of any rank, and the operations that need no coordinates.

use crate::arithmetic::Algebra;
use crate::language::tree::Binary;

/// Components in the order of the rows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tensor<N> {
    pub(crate) shape: Vec<usize>,
    pub(crate) parts: Vec<N>,
}

impl<N: Clone> Tensor<N> {
    pub(crate) fn scalar(part: N) -> Self {
        Self {
            shape: vec![],
            parts: vec![part],
        }
    }

    pub(crate) fn vector(parts: Vec<N>) -> Self {
        Self {
            shape: vec![parts.len()],
            parts,
        }
    }

    /// The tensor of what is made of each component.
    pub(crate) fn map(&self, make: impl FnMut(&N) -> N) -> Self {
        Self {
            shape: self.shape.clone(),
            parts: self.parts.iter().map(make).collect(),
        }
    }

    /// The same of two tensors of one shape.
    pub(crate) fn zip(&self, other: &Self, mut make: impl FnMut(&N, &N) -> N) -> Self {
        let pairs = self.parts.iter().zip(&other.parts);
        Self {
            shape: self.shape.clone(),
            parts: pairs.map(|(a, b)| make(a, b)).collect(),
        }
    }

    pub(crate) fn rank(&self) -> usize {
        self.shape.len()
    }

    /// The component of a square tensor.
    pub(crate) fn entry(&self, row: usize, column: usize) -> &N {
        &self.parts[row * self.shape[1] + column]
    }

    /// The number of rows, if there are as many columns.
    pub(crate) fn square(&self) -> Option<usize> {
        match self.shape.as_slice() {
            [rows, columns] if rows == columns => Some(*rows),
            _ => None,
        }
    }

    pub(crate) fn transposed(&self) -> Self {
        let [rows, columns] = [self.shape[0], self.shape[1]];
        let mut parts = vec![];
        for column in 0..columns {
            for row in 0..rows {
                parts.push(self.parts[row * columns + column].clone());
            }
        }
        Self {
            shape: vec![columns, rows],
            parts,
        }
    }

    /// In words, such as `a vector of 2`.
    pub(crate) fn words(&self) -> String {
        match self.shape.as_slice() {
            [] => "a scalar".to_owned(),
            [length] => format!("a vector of {length}"),
            shape => {
                let sides: Vec<String> = shape.iter().map(usize::to_string).collect();
                format!("a tensor of {}", sides.join(" x "))
            }
        }
    }
}

/// The sum or the difference of tensors of one shape.
pub(crate) fn combine<A: Algebra>(
    algebra: &mut A,
    operator: Binary,
    left: &Tensor<A::Number>,
    right: &Tensor<A::Number>,
) -> Tensor<A::Number> {
    left.zip(right, |a, b| algebra.binary(operator, a, b))
}

/// Each component times, or divided by, a number.
pub(crate) fn scale<A: Algebra>(
    algebra: &mut A,
    operator: Binary,
    tensor: &Tensor<A::Number>,
    by: &A::Number,
) -> Tensor<A::Number> {
    tensor.map(|part| algebra.binary(operator, part, by))
}

/// The sum of products.
pub(crate) fn sum_of_products<'n, A: Algebra>(
    algebra: &mut A,
    pairs: impl Iterator<Item = (&'n A::Number, &'n A::Number)>,
) -> A::Number
where
    A::Number: 'n,
{
    let mut sum = algebra.number(0.0);
    for (a, b) in pairs {
        let product = algebra.binary(Binary::Multiply, a, b);
        sum = algebra.binary(Binary::Add, &sum, &product);
    }
    sum
}

/// The last index of the left against the first of the right.
pub(crate) fn dot<A: Algebra>(
    algebra: &mut A,
    left: &Tensor<A::Number>,
    right: &Tensor<A::Number>,
) -> Tensor<A::Number> {
    let length = right.shape[0];
    let columns = right.parts.len() / length;
    let mut parts = vec![];
    for row in left.parts.chunks(length) {
        for column in 0..columns {
            let below = right.parts.iter().skip(column).step_by(columns);
            parts.push(sum_of_products(algebra, row.iter().zip(below)));
        }
    }
    let [left, right] = [&left.shape[..left.rank() - 1], &right.shape[1..]];
    Tensor {
        shape: [left, right].concat(),
        parts,
    }
}

/// Every component of the left times every component of the right.
pub(crate) fn outer<A: Algebra>(
    algebra: &mut A,
    left: &Tensor<A::Number>,
    right: &Tensor<A::Number>,
) -> Tensor<A::Number> {
    let mut parts = vec![];
    for a in &left.parts {
        for b in &right.parts {
            parts.push(algebra.binary(Binary::Multiply, a, b));
        }
    }
    Tensor {
        shape: [left.shape.as_slice(), &right.shape].concat(),
        parts,
    }
}

/// Cofactors: `cofactor[i][j]` belongs to row i and column j. For up to three rows.
fn cofactors<A: Algebra>(
    algebra: &mut A,
    tensor: &Tensor<A::Number>,
    rows: usize,
) -> Vec<A::Number> {
    let mut cofactors = vec![];
    for i in 0..rows {
        for j in 0..rows {
            cofactors.push(match rows {
                1 => algebra.number(1.0),
                2 => {
                    let opposite = tensor.entry(1 - i, 1 - j).clone();
                    if i == j {
                        opposite
                    } else {
                        algebra.negate(&opposite)
                    }
                }
                _ => {
                    // Cyclic indices give the signs.
                    let [a, b] = [(i + 1) % 3, (i + 2) % 3];
                    let [c, d] = [(j + 1) % 3, (j + 2) % 3];
                    let [ac, bd] = [tensor.entry(a, c), tensor.entry(b, d)];
                    let [ad, bc] = [tensor.entry(a, d), tensor.entry(b, c)];
                    let first = algebra.binary(Binary::Multiply, ac, bd);
                    let second = algebra.binary(Binary::Multiply, ad, bc);
                    algebra.binary(Binary::Subtract, &first, &second)
                }
            });
        }
    }
    cofactors
}

pub(crate) fn determinant<A: Algebra>(
    algebra: &mut A,
    tensor: &Tensor<A::Number>,
    rows: usize,
) -> A::Number {
    let cofactors = cofactors(algebra, tensor, rows);
    sum_of_products(algebra, tensor.parts[..rows].iter().zip(&cofactors))
}

pub(crate) fn inverse<A: Algebra>(
    algebra: &mut A,
    tensor: &Tensor<A::Number>,
    rows: usize,
) -> Tensor<A::Number> {
    let cofactors = Tensor {
        shape: tensor.shape.clone(),
        parts: cofactors(algebra, tensor, rows),
    };
    let determinant = determinant(algebra, tensor, rows);
    scale(
        algebra,
        Binary::Divide,
        &cofactors.transposed(),
        &determinant,
    )
}

pub(crate) fn cross<A: Algebra>(
    algebra: &mut A,
    a: &[A::Number],
    b: &[A::Number],
) -> Tensor<A::Number> {
    let mut entry = |i: usize, j: usize| {
        let first = algebra.binary(Binary::Multiply, &a[i], &b[j]);
        let second = algebra.binary(Binary::Multiply, &a[j], &b[i]);
        algebra.binary(Binary::Subtract, &first, &second)
    };
    if a.len() == 2 {
        return Tensor::scalar(entry(0, 1));
    }
    Tensor::vector(vec![entry(1, 2), entry(2, 0), entry(0, 1)])
}
