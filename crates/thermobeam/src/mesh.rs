//! Meshes of [0, 1]: the triangulation T_h of the paper's section 3.1.

use thiserror::Error;

/// An invalid list of nodes.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MeshError {
    /// Fewer than one element.
    #[error("mesh: expected at least 1 element, found {elements}")]
    TooFew {
        /// Requested number of elements.
        elements: usize,
    },
    /// The first node is not 0 or the last not 1.
    #[error("node {index}: expected {expected}, found {found}")]
    Ends {
        /// Index of the node.
        index: usize,
        /// Its position.
        found: f64,
        /// The expected position.
        expected: f64,
    },
    /// Two neighbouring nodes that do not increase, or are not finite.
    #[error("nodes {} and {index}: expected strictly increasing nodes, found {previous} and {found}", index - 1)]
    NotIncreasing {
        /// Index of the second of the two nodes.
        index: usize,
        /// Position of the first node.
        previous: f64,
        /// Position of the second node.
        found: f64,
    },
    /// An element so short that its slopes, which are differences over h, overflow.
    #[error(
        "nodes {} and {index}: expected a distance whose inverse is finite, found {previous:?} and {found:?}: put them further \
         apart", index - 1
    )]
    TooClose {
        /// Index of the second of the two nodes.
        index: usize,
        /// Position of the first node.
        previous: f64,
        /// Position of the second node.
        found: f64,
    },
}

/// A mesh of n elements with nodes 0 = x_0 < x_1 < ... < x_n = 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    nodes: Vec<f64>,
}

impl Mesh {
    /// A uniform mesh of n elements.
    ///
    /// # Errors
    /// [`MeshError::TooFew`] for n = 0.
    pub fn uniform(elements: usize) -> Result<Self, MeshError> {
        Self::mapped(elements, |s| s)
    }

    /// The mesh with nodes `map(i/n)`; `map` must increase strictly from 0 to 1.
    ///
    /// Ends that the map misses by round-off are set to 0 and 1 exactly.
    ///
    /// # Errors
    /// [`MeshError`] for n = 0, wrong ends, or nodes that do not increase.
    pub fn mapped(elements: usize, map: impl Fn(f64) -> f64) -> Result<Self, MeshError> {
        if elements == 0 {
            return Err(MeshError::TooFew { elements });
        }
        let mut nodes: Vec<f64> = (0..=elements)
            .map(|i| map(i as f64 / elements as f64))
            .collect();
        // A map such as s + sin(2 pi s)/10 misses the ends by a few rounding errors.
        let slack = 8.0 * f64::EPSILON;
        for (index, end) in [(0, 0.0), (elements, 1.0)] {
            if (nodes[index] - end).abs() <= slack {
                nodes[index] = end;
            }
        }
        Self::from_nodes(nodes)
    }

    /// The mesh with the given nodes, which must increase strictly from 0 to 1.
    ///
    /// # Errors
    /// [`MeshError`] for fewer than two nodes, wrong ends, nodes that do not increase, or an
    /// element whose 1/h overflows.
    pub fn from_nodes(nodes: Vec<f64>) -> Result<Self, MeshError> {
        if nodes.len() < 2 {
            return Err(MeshError::TooFew {
                elements: nodes.len().saturating_sub(1),
            });
        }
        let last = nodes.len() - 1;
        for (index, expected) in [(0, 0.0), (last, 1.0)] {
            if nodes[index] != expected {
                return Err(MeshError::Ends {
                    index,
                    found: nodes[index],
                    expected,
                });
            }
        }
        for index in 1..nodes.len() {
            let (previous, found) = (nodes[index - 1], nodes[index]);
            // NaN is not ordered, and is rejected here too.
            if previous.partial_cmp(&found) != Some(std::cmp::Ordering::Less) {
                return Err(MeshError::NotIncreasing {
                    index,
                    previous,
                    found,
                });
            }
            if !(found - previous).recip().is_finite() {
                return Err(MeshError::TooClose {
                    index,
                    previous,
                    found,
                });
            }
        }
        Ok(Self { nodes })
    }

    /// Number of elements n.
    pub fn elements(&self) -> usize {
        self.nodes.len() - 1
    }

    /// The n + 1 nodes.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Length of each element, h_i = x_i - x_{i-1} for i = 1..n.
    pub fn lengths(&self) -> impl Iterator<Item = f64> + '_ {
        self.nodes.windows(2).map(|pair| pair[1] - pair[0])
    }

    /// The mesh size h, the length of the largest element.
    pub fn size(&self) -> f64 {
        self.lengths().fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mesh_ends_are_corrected_by_round_off_only() {
        let ends = |miss: f64| {
            let mesh = Mesh::mapped(4, |s| {
                miss * f64::EPSILON * (1.0 - s) + s * (1.0 + miss * f64::EPSILON)
            });
            mesh.map(|mesh| [mesh.nodes()[0], mesh.nodes()[4]])
        };
        assert_eq!(
            [ends(0.0), ends(4.0), ends(8.0)],
            [Ok([0.0, 1.0]), Ok([0.0, 1.0]), Ok([0.0, 1.0])]
        );
        assert!(matches!(ends(16.0), Err(MeshError::Ends { index: 0, .. })));
        let beyond = Mesh::mapped(4, |s| s * (1.0 + 16.0 * f64::EPSILON));
        assert!(
            matches!(beyond, Err(MeshError::Ends { index: 4, .. })),
            "{beyond:?}"
        );
    }

    #[test]
    fn an_element_whose_inverse_length_overflows_is_refused() {
        for length in [5e-324, 1e-310] {
            let mesh = Mesh::from_nodes(vec![0.0, length, 0.5, 1.0]);
            assert_eq!(
                mesh,
                Err(MeshError::TooClose {
                    index: 1,
                    previous: 0.0,
                    found: length
                })
            );
            assert!(
                mesh.unwrap_err()
                    .to_string()
                    .starts_with("nodes 0 and 1: expected a distance whose inverse is finite")
            );
        }
        assert!(Mesh::from_nodes(vec![0.0, 1e-300, 1.0]).is_ok());
    }

    #[test]
    fn the_size_of_a_mesh_is_its_largest_element() {
        let mesh = Mesh::from_nodes(vec![0.0, 0.25, 0.875, 1.0]).unwrap();
        assert_eq!((mesh.elements(), mesh.size()), (3, 0.625));
    }
}
