//! Elements of degree p on a mesh: the storage and the couplings of each coefficient.
//!
//! # Blocks
//!
//! A *block* holds one coefficient of u, one of φ and one of θ. Blocks 0..=n belong to the nodes'
//! hats. The rest of the basis splits into two chains per element: M couples degree m of a field
//! with m ± 2 of the same field, C couples m of u or θ with m ± 1 of φ. So the even degrees of u
//! and θ couple only with the odd degrees of φ, and vice versa. Block k of chain c holds
//! `u_{2k+c}, φ_{2k+1-c}, θ_{2k+c}`, k = 1..⌊p/2⌋; it is coupled with blocks k ± 1 of its chain,
//! and for k = 1 with the two hats. This halves the bandwidth of an ordering by degree.

use super::element::{self, Basis};
use super::legendre;
use crate::mesh::Mesh;
use crate::parameters::{ParameterError, check};

/// One of the unknown functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Field {
    /// The displacement u.
    U,
    /// The rotation φ.
    Phi,
    /// The velocity u_t.
    V,
    /// The velocity φ_t.
    W,
    /// The lifted temperature θ~ = θ - θ_A (1 - x).
    Theta,
}

impl Field {
    /// All fields.
    pub const ALL: [Self; 5] = [Self::U, Self::Phi, Self::V, Self::W, Self::Theta];
}

/// The matrices M, K and C between two blocks of the reference element, rows first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Coupling {
    /// The block of the row: 0 and 1 for the hats, 2 + 2(k - 1) + c for block k of chain c.
    pub(super) row: usize,
    /// The block of the column.
    pub(super) column: usize,
    /// M between coefficients of u, and between those of θ.
    pub(super) mass_u: f64,
    /// M between coefficients of φ.
    pub(super) mass_phi: f64,
    /// K between coefficients of u, and between those of θ.
    pub(super) stiff_u: f64,
    /// K between coefficients of φ.
    pub(super) stiff_phi: f64,
    /// C, row of u (for θ it acts as Cᵀ), column of φ: `(N_φ, N_u')`.
    pub(super) u_phi: f64,
    /// Cᵀ, row of φ, column of u: `(N_u', N_φ)`.
    pub(super) phi_u: f64,
    /// C, row of φ, column of θ: `(N_θ, N_φ')`.
    pub(super) phi_theta: f64,
    /// Cᵀ, row of θ, column of φ: `(N_φ', N_θ)`.
    pub(super) theta_phi: f64,
}

/// The degrees of u (and θ) and of φ in a block of an element; `None` if the degree exceeds p.
pub(super) fn degrees(block: usize, degree: usize) -> [Option<usize>; 2] {
    if block < 2 {
        return [Some(block), Some(block)];
    }
    let (k, chain) = (block / 2, block % 2);
    [2 * k + chain, 2 * k + 1 - chain].map(|m| (m <= degree).then_some(m))
}

/// A point of the beam: its element, and the basis there. Located once, it serves all levels of a
/// space.
pub struct BeamPoint {
    element: usize,
    basis: Basis,
}

/// The space S_h of (3.2), for any degree, with u, φ and θ in one numbering.
#[derive(Debug, Clone, PartialEq)]
pub struct Space {
    mesh: Mesh,
    degree: usize,
    /// Lengths of the elements.
    pub(super) lengths: Vec<f64>,
    /// Couplings within an element.
    pub(super) couplings: Vec<Coupling>,
    /// `∫ χ` of each block's basis function of φ.
    pub(super) rotation_integrals: Vec<f64>,
}

impl Space {
    /// Elements of the given degree, 1..=[`MAX_DEGREE`](super::MAX_DEGREE), on a mesh.
    ///
    /// # Errors
    /// [`ParameterError`] for other degrees.
    pub fn new(mesh: Mesh, degree: usize) -> Result<Self, ParameterError> {
        check(
            "degree of the elements",
            degree as f64,
            (1..=element::MAX_DEGREE).contains(&degree),
            format!("an integer from 1 to {}", element::MAX_DEGREE),
        )?;
        let lengths = mesh.lengths().collect();
        let blocks = 2 + 2 * (degree / 2);
        let mut couplings = vec![];
        for row in 0..blocks {
            for column in 0..blocks {
                couplings.extend(coupling(row, column, degree));
            }
        }
        let mut space = Self {
            mesh,
            degree,
            lengths,
            couplings,
            rotation_integrals: vec![],
        };
        space.rotation_integrals = space.integrals_of_rotations();
        Ok(space)
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The degree p.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Blocks of three coefficients, including coefficients that are always zero.
    pub fn blocks(&self) -> usize {
        self.lengths.len() + 1 + self.lengths.len() * self.inner()
    }

    /// The block of the free end.
    pub(super) fn tip(&self) -> usize {
        self.lengths.len()
    }

    /// Inner blocks of an element, without its hats.
    pub(super) fn inner(&self) -> usize {
        2 * (self.degree / 2)
    }

    /// Storage index of block `local` of an element.
    pub(super) fn block(&self, element: usize, local: usize) -> usize {
        if local < 2 {
            element + local
        } else {
            self.tip() + 1 + element * self.inner() + local - 2
        }
    }

    /// Block and index in it for the coefficient of a field in degree m of an element (0 and 1: the
    /// hats).
    pub fn place(&self, field: Field, element: usize, m: usize) -> (usize, usize) {
        let phi = matches!(field, Field::Phi | Field::W);
        let place = match field {
            Field::U | Field::V => 0,
            Field::Phi | Field::W => 1,
            Field::Theta => 2,
        };
        let chain = if phi { 1 - m % 2 } else { m % 2 };
        let local = if m < 2 { m } else { 2 * (m / 2) + chain };
        (self.block(element, local), place)
    }

    /// Does the coefficient exist, and is it free? Hats at clamped ends are not.
    fn is_free(&self, field: Field, element: usize, m: usize) -> bool {
        let last = self.lengths.len() - 1;
        !(element == 0 && m == 0 || field == Field::Theta && element == last && m == 1)
    }

    /// Adds (f, χ) for every basis function χ of a field to a load, by Gauss quadrature with
    /// `points` per element.
    ///
    /// * `field`: the equation whose test functions are used; V and W stand for those of u and φ.
    /// * `load`: [`Self::blocks`] blocks of `(F_u, F_φ, F_θ)`. A point load at x = 1 belongs in
    ///   block n, the number of elements.
    pub fn add_load(
        &self,
        field: Field,
        points: &[(f64, f64)],
        f: impl Fn(f64) -> f64,
        load: &mut [[f64; 3]],
    ) {
        for (element, x) in self.mesh.nodes().windows(2).enumerate() {
            let half = 0.5 * (x[1] - x[0]);
            for &(xi, weight) in points {
                let basis = Basis::at(xi, self.degree);
                let value = half * weight * f(x[0] + half * (1.0 + xi));
                for m in (0..=self.degree).filter(|&m| self.is_free(field, element, m)) {
                    let (block, place) = self.place(field, element, m);
                    load[block][place] += value * basis.values[m];
                }
            }
        }
    }

    /// Gauss points and weights on [-1, 1], for [`Self::add_load`].
    pub fn gauss(count: usize) -> Vec<(f64, f64)> {
        legendre::gauss(count)
    }

    /// (3.6): the projection of f in the H¹ product, passed to `put` with element, block and index.
    ///
    /// It equals f at the nodes. Inside an element its coefficients are `(f - I f, N_m')` in the
    /// product of derivatives, where I interpolates at the nodes. Integration by parts removes the
    /// derivative of f: `c_m = -√((2m - 1)/2) ∫ (f - I f) P_{m-1}' dξ`.
    pub(super) fn project(
        &self,
        field: Field,
        f: impl Fn(f64) -> f64,
        mut put: impl FnMut(usize, usize, usize, f64),
    ) {
        let points = legendre::gauss(2 * self.degree + 16);
        for (element, x) in self.mesh.nodes().windows(2).enumerate() {
            let ends = [f(x[0]), f(x[1])];
            let mut coefficients = [0.0; element::MAX_DEGREE + 1];
            for &(xi, weight) in &points {
                let value = f(0.5 * ((1.0 - xi) * x[0] + (1.0 + xi) * x[1]));
                let rest = value - 0.5 * ((1.0 - xi) * ends[0] + (1.0 + xi) * ends[1]);
                let (mut values, mut slopes) = (
                    [0.0; element::MAX_DEGREE + 1],
                    [0.0; element::MAX_DEGREE + 1],
                );
                legendre::values_into(xi, &mut values[..=self.degree]);
                legendre::derivatives_into(&values[..=self.degree], &mut slopes[..=self.degree]);
                for m in 2..=self.degree {
                    coefficients[m] -=
                        weight * (0.5 * (2 * m - 1) as f64).sqrt() * rest * slopes[m - 1];
                }
            }
            coefficients[..2].copy_from_slice(&ends);
            for m in 0..=self.degree {
                let (block, place) = self.place(field, element, m);
                put(
                    element,
                    block,
                    place,
                    if self.is_free(field, element, m) {
                        coefficients[m]
                    } else {
                        0.0
                    },
                );
            }
        }
    }

    /// The element that holds x, and its basis there. Points beyond the ends belong to the
    /// outermost elements.
    pub fn locate(&self, x: f64) -> BeamPoint {
        let nodes = self.mesh.nodes();
        let element = nodes
            .partition_point(|node| *node <= x)
            .clamp(1, self.lengths.len())
            - 1;
        let xi = (2.0 * x - nodes[element] - nodes[element + 1]) / self.lengths[element];
        BeamPoint {
            element,
            basis: Basis::at(xi, self.degree),
        }
    }

    /// Value and slope of the field with the coefficients `coefficient(block, place)` at a point
    /// found by [`Self::locate`].
    pub(super) fn evaluate(
        &self,
        field: Field,
        BeamPoint { element, basis }: &BeamPoint,
        coefficient: impl Fn(usize, usize) -> f64,
    ) -> (f64, f64) {
        let (mut value, mut slope) = (0.0, 0.0);
        for m in 0..=self.degree {
            let (block, place) = self.place(field, *element, m);
            let coefficient = coefficient(block, place);
            value += coefficient * basis.values[m];
            slope += coefficient * basis.slopes[m];
        }
        (value, slope * 2.0 / self.lengths[*element])
    }

    /// The same for all fields, in the order of [`Field::ALL`]: u, v and θ share their blocks, and
    /// so do φ and w.
    ///
    /// * `coefficients`: in that order, from a block of u and one of φ.
    pub(super) fn evaluate_all(
        &self,
        BeamPoint { element, basis }: &BeamPoint,
        coefficients: impl Fn(usize, usize) -> [f64; Field::ALL.len()],
    ) -> [(f64, f64); Field::ALL.len()] {
        let mut sums = [(0.0, 0.0); Field::ALL.len()];
        for m in 0..=self.degree {
            let [u, phi] = [Field::U, Field::Phi].map(|field| self.place(field, *element, m).0);
            for ((value, slope), coefficient) in sums.iter_mut().zip(coefficients(u, phi)) {
                *value += coefficient * basis.values[m];
                *slope += coefficient * basis.slopes[m];
            }
        }
        sums.map(|(value, slope)| (value, slope * 2.0 / self.lengths[*element]))
    }
}

/// The coupling of two blocks of the reference element, if any.
fn coupling(row: usize, column: usize, degree: usize) -> Option<Coupling> {
    let [u_row, phi_row] = degrees(row, degree);
    let [u_column, phi_column] = degrees(column, degree);
    let coupling = Coupling {
        row,
        column,
        mass_u: entry(element::mass, u_row, u_column),
        mass_phi: entry(element::mass, phi_row, phi_column),
        stiff_u: entry(element::stiffness, u_row, u_column),
        stiff_phi: entry(element::stiffness, phi_row, phi_column),
        u_phi: entry(element::coupling, u_row, phi_column),
        phi_u: entry(transposed_coupling, phi_row, u_column),
        phi_theta: entry(element::coupling, phi_row, u_column),
        theta_phi: entry(transposed_coupling, u_row, phi_column),
    };
    let Coupling {
        mass_u,
        mass_phi,
        stiff_u,
        stiff_phi,
        u_phi,
        phi_u,
        phi_theta,
        theta_phi,
        ..
    } = coupling;
    let entries = [
        mass_u, mass_phi, stiff_u, stiff_phi, u_phi, phi_u, phi_theta, theta_phi,
    ];
    entries
        .iter()
        .any(|entry| *entry != 0.0)
        .then_some(coupling)
}

/// The entry of a matrix of the reference element; zero where a function does not exist.
fn entry(matrix: fn(usize, usize) -> f64, i: Option<usize>, j: Option<usize>) -> f64 {
    i.zip(j).map_or(0.0, |(i, j)| matrix(i, j))
}

fn transposed_coupling(i: usize, j: usize) -> f64 {
    element::coupling(j, i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_their_own_projections() {
        let mesh = Mesh::from_nodes(vec![0.0, 0.2, 0.7, 1.0]).unwrap();
        let polynomial = |x: f64| x * (x - 0.3) * (1.0 + 2.0 * x * x);
        let slope = |x: f64| 8.0 * x.powi(3) - 1.8 * x * x + 2.0 * x - 0.3;
        let space = Space::new(mesh, 4).unwrap();
        for field in [Field::U, Field::W] {
            let mut coefficients = vec![[0.0; 3]; space.blocks()];
            space.project(field, polynomial, |_, block, place, value| {
                coefficients[block][place] = value;
            });
            for i in 0..=50 {
                let x = f64::from(i) / 50.0;
                let (value, derivative) =
                    space.evaluate(field, &space.locate(x), |block, place| {
                        coefficients[block][place]
                    });
                assert!((value - polynomial(x)).abs() < 4e-15, "{x}: {value}");
                assert!((derivative - slope(x)).abs() < 4e-13, "{x}: {derivative}");
            }
        }
    }
}
