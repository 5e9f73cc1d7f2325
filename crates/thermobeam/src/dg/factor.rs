//! Elimination of a step's linear system: inner blocks of the elements, chain by chain, then nodes
//! from left to right.
//!
//! The free end comes last, so that contact changes only its pivot. Elements of equal length share
//! their elimination. The cost is proportional to the number of elements times the degree.

use super::block::{
    Block, Matrix, add, clear_column, clear_row, invert, isolate, matrix_product, multiply,
    subtract_matrix_product, subtract_product, zero,
};
use super::operator::Operator;
use super::space::{Space, degrees};
use crate::error::{StepFailure, StepMatrix};

/// Lengths equal up to rounding errors share an elimination; the residual, which decides, uses each
/// element's own.
const SAME_LENGTH: f64 = 1e-13;

/// One inner block and its couplings to the next one towards the hats.
#[derive(Debug, Clone)]
struct Link<const S: usize> {
    /// P⁻¹, where P is the block's pivot.
    inverse: Matrix<S>,
    /// The row of the next block, column of this one.
    towards: Matrix<S>,
    /// P⁻¹ times the row of this block, column of the next one.
    back: Matrix<S>,
}

/// The inner blocks of one chain, highest degree first, without the first block, which couples with
/// both hats.
#[derive(Debug, Clone)]
struct Chain<const S: usize> {
    links: Vec<Link<S>>,
    inverse: Matrix<S>,
    towards: [Matrix<S>; 2],
    back: [Matrix<S>; 2],
}

/// The elimination of the interior of an element.
#[derive(Debug, Clone)]
struct Inside<const S: usize> {
    length: f64,
    chains: Vec<Chain<S>>,
    /// The remaining matrix between the hats, row by row.
    hats: [[Matrix<S>; 2]; 2],
}

/// A node.
#[derive(Debug, Clone)]
struct FactorNode<const S: usize> {
    inverse: Matrix<S>,
    /// The matrix in the row of this node and the column of the one on its left.
    left: Matrix<S>,
    /// The inverse pivot times the matrix in the row of this node and the column of the one on its
    /// right.
    right: Matrix<S>,
}

/// The factorised matrix of a step, for the free end both without and with contact.
#[derive(Debug, Clone)]
pub(super) struct Factor<const S: usize> {
    insides: Vec<Inside<S>>,
    /// Index in `insides` for each element.
    kinds: Vec<usize>,
    nodes: Vec<FactorNode<S>>,
    tip: [Matrix<S>; 2],
}

impl<const S: usize> Factor<S> {
    /// Allocates the factorisations of a space.
    pub(super) fn new(space: &Space) -> Self {
        let mut insides: Vec<Inside<S>> = vec![];
        let mut kinds = vec![];
        for &length in &space.lengths {
            let known = insides.iter().position(|inside| inside.has_length(length));
            let kind = known.unwrap_or_else(|| {
                insides.push(Inside::new(space.degree(), length));
                insides.len() - 1
            });
            kinds.push(kind);
        }
        let node = FactorNode {
            inverse: zero(),
            left: zero(),
            right: zero(),
        };
        Self {
            insides,
            kinds,
            nodes: vec![node; space.tip() + 1],
            tip: [zero(), zero()],
        }
    }

    /// Memory of a factorisation in bytes.
    pub(super) fn bytes(&self) -> usize {
        let matrices: usize = self
            .insides
            .iter()
            .map(|inside| {
                4 + inside
                    .chains
                    .iter()
                    .map(|chain| 5 + 3 * chain.links.len())
                    .sum::<usize>()
            })
            .sum();
        (matrices + 3 * self.nodes.len() + 2) * size_of::<Matrix<S>>()
    }

    /// Factorises without allocating.
    ///
    /// * `n_value`: the axial force of the matrix, for the error only.
    ///
    /// # Errors
    /// [`StepFailure::Indefinite`] at the first pivot that is not positive: at the node, or in the
    /// element on its left.
    pub(super) fn factorize(
        &mut self,
        space: &Space,
        operator: &Operator<S>,
        n_value: f64,
    ) -> Result<(), StepFailure> {
        for (index, inside) in self.insides.iter_mut().enumerate() {
            let node = 1 + self
                .kinds
                .iter()
                .position(|kind| *kind == index)
                .unwrap_or(0);
            inside
                .factorize(space, operator)
                .map_err(indefinite(node, n_value))?;
        }
        let tip = space.tip();
        for node in 1..=tip {
            let on_left = &self.insides[self.kinds[node - 1]].hats;
            let mut pivot = on_left[1][1];
            let mut left = on_left[1][0];
            let mut right = zero();
            if node < tip {
                let on_right = &self.insides[self.kinds[node]].hats;
                add(&mut pivot, &on_right[0][0]);
                right = on_right[0][1];
                if node + 1 == tip {
                    clear_column(&mut right, 2);
                }
            } else {
                // θ~ vanishes at the free end.
                clear_row(&mut left, 2);
                isolate(&mut pivot, 2);
            }
            if node > 1 {
                subtract_matrix_product(&mut pivot, &left, &self.nodes[node - 1].right);
            }
            if node == tip {
                self.tip = [pivot, pivot];
                operator.add_contact(&mut self.tip[1]);
                invert(&mut self.tip[0]).map_err(indefinite(node, n_value))?;
                invert(&mut self.tip[1]).map_err(indefinite(node, n_value))?;
            } else {
                invert(&mut pivot).map_err(indefinite(node, n_value))?;
            }
            self.nodes[node] = FactorNode {
                inverse: pivot,
                left,
                right: matrix_product(&pivot, &right),
            };
        }
        Ok(())
    }

    /// Replaces a right-hand side, with one block for each of the space, by the solution.
    pub(super) fn solve_in_place(&self, space: &Space, in_contact: bool, x: &mut [Block<S>]) {
        let (tip, inner) = (space.tip(), space.inner());
        let (nodes, inside) = x.split_at_mut(tip + 1);
        if inner > 0 {
            for (element, blocks) in inside.chunks_exact_mut(inner).enumerate() {
                self.insides[self.kinds[element]].forward(blocks, &mut nodes[element..element + 2]);
            }
        }
        nodes[tip][2] = [0.0; S];
        for node in 1..=tip {
            let (before, from) = nodes.split_at_mut(node);
            if node > 1 {
                subtract_product(&mut from[0], &self.nodes[node].left, &before[node - 1]);
            }
            let inverse = if node == tip {
                &self.tip[usize::from(in_contact)]
            } else {
                &self.nodes[node].inverse
            };
            multiply(inverse, &mut from[0]);
        }
        for node in (1..tip).rev() {
            let (upto, beyond) = nodes.split_at_mut(node + 1);
            subtract_product(&mut upto[node], &self.nodes[node].right, &beyond[0]);
        }
        nodes[0] = [[0.0; S]; 3];
        if inner > 0 {
            for (element, blocks) in inside.chunks_exact_mut(inner).enumerate() {
                self.insides[self.kinds[element]].backward(blocks, &nodes[element..element + 2]);
            }
        }
    }
}

/// The failure of a step at a node, from the pivot there.
fn indefinite(node: usize, n_value: f64) -> impl Fn(f64) -> StepFailure {
    move |pivot| StepFailure::Indefinite {
        node,
        pivot,
        n_value,
        of: StepMatrix::AnyOrder,
    }
}

impl<const S: usize> Inside<S> {
    fn has_length(&self, length: f64) -> bool {
        (self.length - length).abs() <= SAME_LENGTH * length
    }

    fn new(degree: usize, length: f64) -> Self {
        let link = Link {
            inverse: zero(),
            towards: zero(),
            back: zero(),
        };
        let chain = Chain {
            links: vec![link; (degree / 2).saturating_sub(1)],
            inverse: zero(),
            towards: [zero(); 2],
            back: [zero(); 2],
        };
        let chains = if degree >= 2 { vec![chain; 2] } else { vec![] };
        Self {
            length,
            chains,
            hats: [[zero(); 2]; 2],
        }
    }

    fn factorize(&mut self, space: &Space, operator: &Operator<S>) -> Result<(), f64> {
        let length = self.length;
        let between =
            |row: usize, column: usize| matrix_between(space, operator, length, row, column);
        for row in 0..2 {
            for column in 0..2 {
                self.hats[row][column] = between(row, column);
            }
        }
        for (c, chain) in self.chains.iter_mut().enumerate() {
            // Local number of the chain's first block; the links lead down to it from the highest
            // degree.
            let (first, count) = (2 + c, chain.links.len());
            let mut pivot = pivot_of(space, &between, first + 2 * count);
            for (i, link) in chain.links.iter_mut().enumerate() {
                let block = first + 2 * (count - i);
                invert(&mut pivot)?;
                link.inverse = pivot;
                link.towards = between(block - 2, block);
                link.back = matrix_product(&pivot, &between(block, block - 2));
                pivot = pivot_of(space, &between, block - 2);
                subtract_matrix_product(&mut pivot, &link.towards, &link.back);
            }
            invert(&mut pivot)?;
            chain.inverse = pivot;
            for hat in 0..2 {
                chain.towards[hat] = between(hat, first);
                chain.back[hat] = matrix_product(&pivot, &between(first, hat));
            }
            for row in 0..2 {
                for column in 0..2 {
                    subtract_matrix_product(
                        &mut self.hats[row][column],
                        &chain.towards[row],
                        &chain.back[column],
                    );
                }
            }
        }
        Ok(())
    }

    fn forward(&self, blocks: &mut [Block<S>], hats: &mut [Block<S>]) {
        for (c, chain) in self.chains.iter().enumerate() {
            let mut block = c + 2 * chain.links.len();
            for link in &chain.links {
                let (lower, from) = blocks.split_at_mut(block);
                multiply(&link.inverse, &mut from[0]);
                subtract_product(&mut lower[block - 2], &link.towards, &from[0]);
                block -= 2;
            }
            multiply(&chain.inverse, &mut blocks[block]);
            for (hat, towards) in hats.iter_mut().zip(&chain.towards) {
                subtract_product(hat, towards, &blocks[block]);
            }
        }
    }

    fn backward(&self, blocks: &mut [Block<S>], hats: &[Block<S>]) {
        for (c, chain) in self.chains.iter().enumerate() {
            for (hat, back) in hats.iter().zip(&chain.back) {
                subtract_product(&mut blocks[c], back, hat);
            }
            for (i, link) in chain.links.iter().rev().enumerate() {
                let block = c + 2 * (i + 1);
                let (lower, from) = blocks.split_at_mut(block);
                subtract_product(&mut from[0], &link.back, &lower[block - 2]);
            }
        }
    }
}

/// The matrix between two blocks of an element; zero if they are not coupled.
fn matrix_between<const S: usize>(
    space: &Space,
    operator: &Operator<S>,
    length: f64,
    row: usize,
    column: usize,
) -> Matrix<S> {
    space
        .couplings
        .iter()
        .find(|coupling| coupling.row == row && coupling.column == column)
        .map_or(zero(), |coupling| operator.between(coupling, length))
}

/// The diagonal matrix of an inner block, with unit rows for coefficients beyond the degree.
fn pivot_of<const S: usize>(
    space: &Space,
    between: &impl Fn(usize, usize) -> Matrix<S>,
    block: usize,
) -> Matrix<S> {
    let mut pivot = between(block, block);
    let [u, phi] = degrees(block, space.degree());
    for (field, exists) in [(0, u), (1, phi), (2, u)] {
        if exists.is_none() {
            isolate(&mut pivot, field);
        }
    }
    pivot
}
