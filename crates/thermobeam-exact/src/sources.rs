//! Loads of a manufactured solution.
//!
//! From the strong form (1.1), with N = N(u(t)):
//!
//! ```text
//! f_u = u_tt - (1 + N) u_xx + φ_x - ζ (u_xxt - φ_xt)
//! f_φ = φ_tt - φ_xx - u_x + φ - ζ (φ_xxt + u_xt - φ_t) + a θ_x
//! f_θ = θ_t - θ_xx + a φ_xt
//! ```
//!
//! tested with the hats, plus what (1.3) leaves at x = 1: `σ(1, t) + g(u(1, t))` in the first equation and
//! `φ_x + ζ φ_xt` in the second. The solver discretises the weak form, so the two paths share nothing but the problem.
//! θ is the physical temperature; its lifting θ_A (1 - x) is harmonic and drops out of f_θ, and the solver's own term
//! `a θ_A` is the part of `a θ_x` that it carries.

use crate::factors::Factors;
use crate::quadrature::RULE;
use crate::solution::{Manufactured, Product};
use thermobeam::assembly::{Tridiagonal, coupling, mass, stiffness};
use thermobeam::mesh::Mesh;
use thermobeam::parameters::Beam;

/// Panels of the quadrature for ∫ X_j' X_k' over [0, 1], independent of the mesh.
const PANELS: usize = 256;

/// The time coefficient that a space vector is multiplied with; the index is that of the product.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Coefficient {
    /// T''.
    Inertia(usize),
    /// T + ζ T' + N T: what the tension of (1.1) makes of u_x.
    Tension(usize),
    /// T + ζ T': the shear's part of u_x.
    Shear(usize),
    /// S''.
    TurnInertia(usize),
    /// S + ζ S'.
    Turn(usize),
    /// S'.
    TurnRate(usize),
    /// Q.
    Heat(usize),
    /// Q'.
    HeatRate(usize),
}

/// A space vector of one equation (0: u, 1: φ, 2: θ) with its coefficient.
#[derive(Debug, Clone)]
struct Term {
    equation: usize,
    coefficient: Coefficient,
    vector: Vec<f64>,
}

/// Which of the two boundary loads at x = 1 to leave out; only a negative control leaves one out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BoundaryLoads {
    /// Both are there.
    Both,
    /// σ(1, t) + g is dropped.
    WithoutStress,
    /// φ_x + ζ φ_xt is dropped.
    WithoutMoment,
}

/// All space vectors of a manufactured solution on a mesh.
#[derive(Debug, Clone)]
pub struct Sources {
    beam: Beam,
    terms: Vec<Term>,
    /// ∫ X_j' X_k', row by row.
    gram: Vec<f64>,
    /// X_j(1).
    tip: Vec<f64>,
    boundary: Boundary,
}

/// Values at x = 1 that the boundary loads are made of; zero where the space vectors hold them already.
#[derive(Debug, Clone, Default)]
struct Boundary {
    /// X_j'(1).
    u_slope: Vec<f64>,
    /// Y_k(1).
    phi: Vec<f64>,
    /// Y_k'(1).
    phi_slope: Vec<f64>,
}

/// The space integrals of one product: (X, N_i), (X', N_i), and the weak second derivative.
struct Vectors {
    value: Vec<f64>,
    slope: Vec<f64>,
    /// `-(X'', N_i)`, which lacks `X'(1) δ_in` to be `(X', N_i')`.
    curvature: Vec<f64>,
    /// X(1), and what the boundary loads still need of it.
    tip: f64,
    boundary_value: f64,
    boundary_slope: f64,
}

impl Vectors {
    fn strong(product: &Product, mesh: &Mesh) -> Self {
        let nodes = mesh.nodes();
        let zeros = vec![0.0; nodes.len()];
        let (mut value, mut slope, mut curvature) = (zeros.clone(), zeros.clone(), zeros);
        for (i, ends) in nodes.windows(2).enumerate() {
            let h = ends[1] - ends[0];
            for (s, weight) in RULE {
                let [x, x1, x2] = product.x.derivatives(ends[0] + s * h);
                for (node, hat) in [(i, 1.0 - s), (i + 1, s)] {
                    let weight = weight * h * hat;
                    value[node] += weight * x;
                    slope[node] += weight * x1;
                    curvature[node] -= weight * x2;
                }
            }
        }
        let [tip, tip_slope, _] = product.x.derivatives(1.0);
        Self { value, slope, curvature, tip, boundary_value: tip, boundary_slope: tip_slope }
    }

    /// The same for the nodal interpolant, with the scheme's own matrices.
    fn discrete(product: &Product, matrices: &Matrices, mesh: &Mesh) -> Self {
        let nodal = nodal(product, mesh);
        let tip = nodal[nodal.len() - 1];
        Self {
            value: matrices.mass.multiply(&nodal),
            slope: matrices.slope.multiply(&nodal),
            curvature: matrices.stiffness.multiply(&nodal),
            tip,
            // -C φ = Cᵀ φ - φ(1) e for P1 functions too.
            boundary_value: tip,
            // K u holds the derivative at the end already.
            boundary_slope: 0.0,
        }
    }
}

struct Matrices {
    mass: Tridiagonal,
    stiffness: Tridiagonal,
    /// Cᵀ: (u_x, N_i).
    slope: Tridiagonal,
}

/// X of a product at the nodes of a mesh; exactly zero at x = 0 where it is zero up to its rounding error.
pub fn nodal(product: &Product, mesh: &Mesh) -> Vec<f64> {
    let mut values: Vec<f64> = mesh.nodes().iter().map(|&x| product.x.eval(x)).collect();
    // Zero up to round-off by the boundary condition of u and φ; θ may start at θ_A.
    if values[0].abs() < product.x.roundoff(1.0) {
        values[0] = 0.0;
    }
    values
}

/// The products of a manufactured solution at the nodes of a mesh.
#[derive(Debug, Clone)]
pub struct Nodal {
    /// X_j of the displacement, n + 1 values each.
    pub u: Vec<Vec<f64>>,
    /// Y_k of the rotation.
    pub phi: Vec<Vec<f64>>,
    /// Z_l of the temperature.
    pub theta: Vec<Vec<f64>>,
}

impl Nodal {
    /// Evaluates each product once at each node.
    pub fn of(exact: &Manufactured, mesh: &Mesh) -> Self {
        let of = |products: &[Product]| products.iter().map(|product| nodal(product, mesh)).collect();
        Self { u: of(&exact.u), phi: of(&exact.phi), theta: of(&exact.theta) }
    }
}

impl Sources {
    /// From the strong form.
    pub fn strong(exact: &Manufactured, beam: &Beam, mesh: &Mesh) -> Self {
        let vectors = |products: &[Product]| products.iter().map(|p| Vectors::strong(p, mesh)).collect::<Vec<_>>();
        Self::assemble(exact, beam, vectors, continuous_gram(&exact.u))
    }

    /// From the discrete matrices applied to the nodal interpolant: the space error is then exactly zero.
    pub fn discrete(exact: &Manufactured, beam: &Beam, mesh: &Mesh) -> Self {
        let matrices = Matrices { mass: mass(mesh), stiffness: stiffness(mesh), slope: coupling(mesh).transpose() };
        let vectors =
            |products: &[Product]| products.iter().map(|p| Vectors::discrete(p, &matrices, mesh)).collect::<Vec<_>>();
        let nodal: Vec<_> = exact.u.iter().map(|product| nodal(product, mesh)).collect();
        let mut gram = vec![];
        for left in &nodal {
            let image = matrices.stiffness.multiply(left);
            gram.extend(nodal.iter().map(|right| right.iter().zip(&image).map(|(a, b)| a * b).sum::<f64>()));
        }
        Self::assemble(exact, beam, vectors, gram)
    }

    fn assemble(
        exact: &Manufactured,
        beam: &Beam,
        vectors: impl Fn(&[Product]) -> Vec<Vectors>,
        gram: Vec<f64>,
    ) -> Self {
        let mut terms = vec![];
        let mut add = |equation: usize, coefficient: Coefficient, vector: Vec<f64>| {
            terms.push(Term { equation, coefficient, vector });
        };
        let (u, phi) = (vectors(&exact.u), vectors(&exact.phi));
        let tip = u.iter().map(|vectors| vectors.tip).collect();
        let boundary = Boundary {
            u_slope: u.iter().map(|vectors| vectors.boundary_slope).collect(),
            phi: phi.iter().map(|vectors| vectors.boundary_value).collect(),
            phi_slope: phi.iter().map(|vectors| vectors.boundary_slope).collect(),
        };
        for (j, v) in u.into_iter().enumerate() {
            add(0, Coefficient::Inertia(j), v.value);
            add(0, Coefficient::Tension(j), v.curvature);
            add(1, Coefficient::Shear(j), v.slope.iter().map(|s| -s).collect());
        }
        for (k, v) in phi.into_iter().enumerate() {
            add(1, Coefficient::Turn(k), v.curvature.iter().zip(&v.value).map(|(c, y)| c + y).collect());
            add(1, Coefficient::TurnInertia(k), v.value);
            add(2, Coefficient::TurnRate(k), v.slope.iter().map(|s| beam.a * s).collect());
            add(0, Coefficient::Turn(k), v.slope);
        }
        for (l, v) in vectors(&exact.theta).into_iter().enumerate() {
            add(1, Coefficient::Heat(l), v.slope.iter().map(|s| beam.a * s).collect());
            // θ's test functions vanish at both ends: no boundary load.
            add(2, Coefficient::Heat(l), v.curvature);
            add(2, Coefficient::HeatRate(l), v.value);
        }
        Self { beam: *beam, terms, gram, tip, boundary }
    }

    /// N(u) of the exact solution with the factors T_j.
    pub fn axial_force(&self, factors: &[f64]) -> f64 {
        let n = factors.len();
        let mut slope_squared = 0.0;
        for j in 0..n {
            for k in 0..n {
                slope_squared += self.gram[j * n + k] * factors[j] * factors[k];
            }
        }
        self.beam.axial_force(slope_squared)
    }

    /// u(1) of the exact solution with the factors T_j.
    pub fn tip(&self, factors: &[f64]) -> f64 {
        factors.iter().zip(&self.tip).map(|(t, x)| t * x).sum()
    }

    /// Writes `(F_u, F_φ, F_θ)` for the given factors, axial force N and contact force.
    pub fn fill(
        &self,
        factors: &Factors,
        n_value: f64,
        contact_force: f64,
        loads: BoundaryLoads,
        load: &mut [[f64; 3]],
    ) {
        load.fill([0.0; 3]);
        for term in &self.terms {
            let coefficient = self.coefficient(term.coefficient, factors, n_value);
            for (load, entry) in load.iter_mut().zip(&term.vector) {
                load[term.equation] += coefficient * entry;
            }
        }
        let tip = load.len() - 1;
        if loads != BoundaryLoads::WithoutStress {
            load[tip][0] += self.tip_stress(factors, n_value) + contact_force;
        }
        if loads != BoundaryLoads::WithoutMoment {
            load[tip][1] += self.tip_moment(factors);
        }
    }

    /// σ(1, t).
    fn tip_stress(&self, factors: &Factors, n_value: f64) -> f64 {
        let u = |j| self.coefficient(Coefficient::Tension(j), factors, n_value);
        let phi = |k| self.coefficient(Coefficient::Turn(k), factors, n_value);
        let Boundary { u_slope, phi: phi_tip, .. } = &self.boundary;
        let stretch: f64 = u_slope.iter().enumerate().map(|(j, slope)| slope * u(j)).sum();
        stretch - phi_tip.iter().enumerate().map(|(k, value)| value * phi(k)).sum::<f64>()
    }

    /// φ_x(1, t) + ζ φ_xt(1, t).
    fn tip_moment(&self, factors: &Factors) -> f64 {
        let phi = |k| self.coefficient(Coefficient::Turn(k), factors, 0.0);
        self.boundary.phi_slope.iter().enumerate().map(|(k, slope)| slope * phi(k)).sum()
    }

    fn coefficient(&self, coefficient: Coefficient, factors: &Factors, n_value: f64) -> f64 {
        let zeta = self.beam.zeta;
        let Factors { u, phi, theta } = factors;
        match coefficient {
            Coefficient::Inertia(j) => u.acceleration[j],
            Coefficient::Tension(j) => (1.0 + n_value) * u.value[j] + zeta * u.rate[j],
            Coefficient::Shear(j) => u.value[j] + zeta * u.rate[j],
            Coefficient::TurnInertia(k) => phi.acceleration[k],
            Coefficient::Turn(k) => phi.value[k] + zeta * phi.rate[k],
            Coefficient::TurnRate(k) => phi.rate[k],
            Coefficient::Heat(l) => theta.value[l],
            Coefficient::HeatRate(l) => theta.rate[l],
        }
    }
}

/// `∫ X_j' X_k'` over [0, 1].
fn continuous_gram(products: &[Product]) -> Vec<f64> {
    let n = products.len();
    let mut gram = vec![0.0; n * n];
    let h = 1.0 / PANELS as f64;
    for panel in 0..PANELS {
        for (s, weight) in RULE {
            let x = (panel as f64 + s) * h;
            let slopes: Vec<f64> = products.iter().map(|product| product.x.derivatives(x)[1]).collect();
            for j in 0..n {
                for k in 0..n {
                    gram[j * n + k] += weight * h * slopes[j] * slopes[k];
                }
            }
        }
    }
    gram
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::{Expression, Variable};

    fn product(x: &str) -> Product {
        let parse = |text, variable| Expression::parse(text, variable).unwrap();
        Product { x: parse(x, Variable::X).into(), t: parse("1", Variable::T).into() }
    }

    #[test]
    fn strong_and_weak_form_give_the_same_load_to_quadrature_accuracy() {
        for (x, elements) in [("0.3*sin(1.3*pi*x)", 16), ("0.4*x*exp(-x)", 16), ("x^2*cos(2*x)", 24)] {
            let product = product(x);
            let mesh = Mesh::mapped(elements, |s| 0.4 * s + 0.6 * s * s).unwrap();
            let mut strong = Vectors::strong(&product, &mesh).curvature;
            *strong.last_mut().unwrap() += Vectors::strong(&product, &mesh).boundary_slope;
            // (X', N_i') on each element is an exact difference of X: no quadrature, no second derivative.
            let nodes = mesh.nodes();
            let flux: Vec<f64> =
                nodes.windows(2).map(|e| (product.x.eval(e[1]) - product.x.eval(e[0])) / (e[1] - e[0])).collect();
            for i in 1..nodes.len() {
                let weak = flux[i - 1] - flux.get(i).copied().unwrap_or(0.0);
                assert!((strong[i] - weak).abs() < 1e-12, "{x}, node {i}: {} {weak}", strong[i]);
            }
        }
    }

    #[test]
    fn the_axial_force_is_that_of_the_exact_slope() {
        let exact = Manufactured { u: vec![product("sin(pi*x)"), product("x^2")], ..Manufactured::default() };
        let beam = Beam { beta: 0.5, rho: 2.0, ..Beam::default() };
        let mesh = Mesh::uniform(4).unwrap();
        let sources = Sources::strong(&exact, &beam, &mesh);
        // ∫ (3 π cos πx + 2·2x)² = 9π²/2 + 24π ∫ x cos πx + 16/3, and ∫ x cos πx = -2/π².
        let pi = std::f64::consts::PI;
        let square = 4.5 * pi * pi - 48.0 / pi + 16.0 / 3.0;
        assert!((sources.axial_force(&[3.0, 2.0]) - (0.5 + 2.0 * square)).abs() < 1e-12);
    }
}
