//! The loads, derived a second time: the weak form of (1.1) and (1.3), for random solutions,
//! coefficients and meshes.
//!
//! The loads are computed from the strong form with automatic derivatives. Here they are those of
//! the weak form, with s = u_x - φ:
//!
//! ```text
//! F_u(y) = (u_tt, y) + (N u_x + s + ζ s_t, y_x) + g(u(1)) y(1)                 for y(0) = 0
//! F_φ(χ) = (φ_tt, χ) + (φ_x + ζ φ_xt, χ_x) - (s + ζ s_t, χ) - a (θ, χ_x)       for χ(0) = 0
//! F_θ(η) = (θ_t, η) + (θ_x, η_x) + a (φ_xt, η)                                 for η(0) = η(1) = 0
//! ```
//!
//! The stress and the moment at x = 1 are natural boundary conditions, and `(θ_x, χ) = -(θ, χ_x)`
//! because θ(1) = 0. Derivatives in closed form, quadrature and basis functions are written here, N
//! and g from their definitions in the paper.

use crate::prelude::*;
use std::f64::consts::PI;

const CASES: u64 = 200;

/// Agreement, relative to the largest load of an equation.
const AGREEMENT: f64 = 1e-10;

/// A beam that is not heated, and obstacles whose compliance has this logarithm at least.
pub(crate) fn beam(random: &mut SplitMix, log_epsilon: f64) -> (Beam, Obstacles) {
    let beam = Beam {
        zeta: random.within([0.0, 1.0]),
        a: random.within([-1.0, 1.0]),
        rho: random.within([0.0, 3.0]),
        beta: random.within([-1.0, 3.0]),
        theta_a: 0.0,
    };
    let obstacles = Obstacles {
        epsilon: 10f64.powf(random.within([log_epsilon, 0.0])),
        g1: random.within([-0.4, 0.0]),
        g2: random.within([0.0, 0.4]),
    };
    (beam, obstacles)
}

/// Nodes of so many elements, whose lengths differ by factors up to 3.
pub(crate) fn nodes(random: &mut SplitMix, elements: usize) -> Vec<f64> {
    let mut nodes = vec![0.0];
    for _ in 0..elements {
        nodes.push(nodes[nodes.len() - 1] + random.within([0.5, 1.5]));
    }
    let end = nodes[nodes.len() - 1];
    nodes.iter_mut().for_each(|x| *x /= end);
    nodes
}

/// `(c0 + c1 s + c2 s² + c3 s³) sin(k s + d) exp(m s)`.
struct Function {
    polynomial: [f64; 4],
    wave: [f64; 2],
    growth: f64,
}

impl Function {
    fn random(random: &mut SplitMix, polynomial: [f64; 4]) -> Self {
        let wave = [random.within([0.5, 7.0]), random.within([0.0, 2.0 * PI])];
        Self {
            polynomial,
            wave,
            growth: random.within([-1.5, 1.5]),
        }
    }

    fn text(&self, s: &str) -> String {
        let ([c0, c1, c2, c3], [k, d], m) = (self.polynomial, self.wave, self.growth);
        format!(
            "(({c0}) + ({c1})*{s} + ({c2})*{s}^2 + ({c3})*{s}^3)*sin({k}*{s} + {d})*exp(({m})*{s})"
        )
    }

    /// Value, first and second derivative, in closed form.
    fn derivatives(&self, s: f64) -> [f64; 3] {
        let ([c0, c1, c2, c3], [k, d], m) = (self.polynomial, self.wave, self.growth);
        let polynomial = [
            c0 + s * (c1 + s * (c2 + s * c3)),
            c1 + s * (2.0 * c2 + 3.0 * s * c3),
            2.0 * c2 + 6.0 * s * c3,
        ];
        let (sin, cos) = (k * s + d).sin_cos();
        let e = (m * s).exp();
        product(
            product(polynomial, [sin, k * cos, -k * k * sin]),
            [e, m * e, m * m * e],
        )
    }
}

/// Value, first and second derivative of a product.
fn product(f: [f64; 3], g: [f64; 3]) -> [f64; 3] {
    [
        f[0] * g[0],
        f[1] * g[0] + f[0] * g[1],
        f[2] * g[0] + 2.0 * f[1] * g[1] + f[0] * g[2],
    ]
}

/// A product X(x) T(t) at the time of its case.
struct Term {
    x: Function,
    t: Function,
    /// T, T' and T''.
    factors: [f64; 3],
}

impl Term {
    /// A product that meets the boundary conditions: zero at x = 0 for u and φ, at x = 1 for θ.
    fn random(random: &mut SplitMix, is_heat: bool, t: f64) -> Self {
        let [b0, b1, b2] = [(); 3].map(|()| random.within([-1.0, 1.0]));
        let polynomial = if is_heat {
            [b0, b1 - b0, b2 - b1, -b2]
        } else {
            [0.0, b0, b1, b2]
        };
        let of_time = [(); 4].map(|()| random.within([-1.0, 1.0]));
        let [x, of_time] =
            [polynomial, of_time].map(|polynomial| Function::random(random, polynomial));
        Self {
            x,
            factors: of_time.derivatives(t),
            t: of_time,
        }
    }
}

/// A random problem with its exact solution.
struct Case {
    beam: Beam,
    obstacles: Obstacles,
    nodes: Vec<f64>,
    t: f64,
    /// The products of u, φ and θ.
    fields: [Vec<Term>; 3],
}

impl Case {
    fn random(seed: u64) -> Self {
        let random = &mut SplitMix::new(seed);
        let (beam, obstacles) = beam(random, -3.0);
        let elements = 32 + random.below(17);
        let nodes = nodes(random, elements);
        let t = random.within([0.0, 1.0]);
        let fields = [false, false, true].map(|is_heat| {
            let count = 1 + random.below(2);
            (0..count)
                .map(|_| Term::random(random, is_heat, t))
                .collect()
        });
        Self {
            beam,
            obstacles,
            nodes,
            t,
            fields,
        }
    }

    fn exact(&self) -> Manufactured {
        let [u, phi, theta] = self.fields.each_ref().map(|terms| {
            let texts = terms
                .iter()
                .map(|Term { x, t, .. }| [x.text("x"), t.text("t")]);
            texts
                .map(|[x, t]| crate::fixtures::product(&x, &t))
                .collect()
        });
        Manufactured { u, phi, theta }
    }

    /// Value and slope at x of the first time derivatives of a field.
    ///
    /// * `shape`: value and slope in x of a function X.
    fn at(&self, field: usize, x: f64, shape: Shape<'_>) -> [[f64; 2]; 3] {
        let mut sum = [[0.0; 2]; 3];
        for term in &self.fields[field] {
            let [value, slope] = shape(&term.x, x);
            for (sum, factor) in sum.iter_mut().zip(term.factors) {
                sum[0] += factor * value;
                sum[1] += factor * slope;
            }
        }
        sum
    }

    /// N and g from their definitions: `N = β + ρ ∫ u_x²`, `g = ([u(1) - g2]_+ - [g1 - u(1)]_+)/ε`.
    fn forces(&self, points: &[(f64, f64)], shape: Shape<'_>) -> Forces {
        let mut square = 0.0;
        for ends in self.nodes.windows(2) {
            let half = 0.5 * (ends[1] - ends[0]);
            for (xi, weight) in points {
                square +=
                    half * weight * self.at(0, ends[0] + half * (1.0 + xi), shape)[0][1].powi(2);
            }
        }
        let Obstacles { epsilon, g1, g2 } = self.obstacles;
        let tip = self.at(0, 1.0, shape)[0][0];
        Forces {
            axial: self.beam.beta + self.beam.rho * square,
            contact: ((tip - g2).max(0.0) - (g1 - tip).max(0.0)) / epsilon,
        }
    }

    /// The weak form for every basis function of degree p; NaN where no function belongs.
    ///
    /// * `place`: row and equation of basis function m of an element, in a list of `rows` rows.
    fn weak_form(
        &self,
        degree: usize,
        shape: Shape<'_>,
        rows: usize,
        place: Place<'_>,
    ) -> (Vec<[f64; 3]>, Forces) {
        let Beam { zeta, a, .. } = self.beam;
        let (points, last) = (gauss(degree + 9), self.nodes.len() - 2);
        let forces = self.forces(&points, shape);
        let mut loads = vec![[f64::NAN; 3]; rows];
        let mut add = |equation: usize, element: usize, m: usize, value: f64| {
            let vanishes = element == 0 && m == 0 || equation == 2 && element == last && m == 1;
            if !vanishes {
                let entry = &mut loads[place(equation, element, m)][equation];
                *entry = if entry.is_nan() {
                    value
                } else {
                    *entry + value
                };
            }
        };
        let bases: Vec<_> = points.iter().map(|(xi, _)| basis(degree, *xi)).collect();
        for (element, ends) in self.nodes.windows(2).enumerate() {
            let half = 0.5 * (ends[1] - ends[0]);
            for (&(xi, weight), basis) in points.iter().zip(&bases) {
                let x = ends[0] + half * (1.0 + xi);
                let [[_, u_x], [_, u_xt], [u_tt, _]] = self.at(0, x, shape);
                let [[phi, phi_x], [phi_t, phi_xt], [phi_tt, _]] = self.at(1, x, shape);
                let [[theta, theta_x], [theta_t, _], _] = self.at(2, x, shape);
                let shear = u_x - phi + zeta * (u_xt - phi_t);
                for (m, [y, y_xi]) in basis.iter().enumerate() {
                    let (y, y_x) = (half * weight * y, weight * y_xi);
                    add(0, element, m, u_tt * y + (forces.axial * u_x + shear) * y_x);
                    add(
                        1,
                        element,
                        m,
                        phi_tt * y + (phi_x + zeta * phi_xt) * y_x - shear * y - a * theta * y_x,
                    );
                    add(2, element, m, theta_t * y + theta_x * y_x + a * phi_xt * y);
                }
            }
        }
        add(0, last, 1, forces.contact);
        (loads, forces)
    }
}

/// Value and slope in x of a function X at x, itself or its interpolant.
type Shape<'a> = &'a dyn Fn(&Function, f64) -> [f64; 2];

/// The row of basis function m of an element in an equation.
type Place<'a> = &'a dyn Fn(usize, usize, usize) -> usize;

/// P_0 ... P_n and their derivatives at ξ.
fn legendre(n: usize, xi: f64) -> Vec<[f64; 2]> {
    let mut p = vec![[1.0, 0.0], [xi, 1.0]];
    for k in 1..n {
        let (j, [[before, slope_before], [value, _]]) = (k as f64, [p[k - 1], p[k]]);
        p.push([
            ((2.0 * j + 1.0) * xi * value - j * before) / (j + 1.0),
            slope_before + (2.0 * j + 1.0) * value,
        ]);
    }
    p
}

/// Gauss points and weights on [-1, 1]: the roots of P_n by Newton's method, from Tricomi's first
/// term.
fn gauss(n: usize) -> Vec<(f64, f64)> {
    let point = |k: usize| {
        let mut xi = (PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        for _ in 0..8 {
            let [value, slope] = legendre(n, xi)[n];
            xi -= value / slope;
        }
        (xi, 2.0 / ((1.0 - xi * xi) * legendre(n, xi)[n][1].powi(2)))
    };
    (0..n).map(point).collect()
}

/// Values and slopes at ξ of the basis on [-1, 1]: the hats, and
/// `∫ P_{m-1} √((2m - 1)/2) = (P_m - P_{m-2})/√(2 (2m - 1))`.
fn basis(degree: usize, xi: f64) -> Vec<[f64; 2]> {
    let p = legendre(degree, xi);
    let mut all = vec![[0.5 * (1.0 - xi), -0.5], [0.5 * (1.0 + xi), 0.5]];
    for m in 2..=degree {
        let root = (2.0 * (2 * m - 1) as f64).sqrt();
        all.push([
            (p[m][0] - p[m - 2][0]) / root,
            (p[m][1] - p[m - 2][1]) / root,
        ]);
    }
    all
}

/// The loads and forces of the library at a time, in a list of `rows` rows.
pub(crate) fn filled(
    sources: &Sources,
    (exact, t): (&Manufactured, f64),
    obstacles: &Obstacles,
    rows: usize,
) -> (Vec<[f64; 3]>, Forces) {
    let mut factors = Factors::default();
    factors.at(exact, t);
    let forces = sources.forces(&factors.u, Some(obstacles), None);
    let mut load = vec![[f64::NAN; 3]; rows];
    sources.fill(&factors, forces, None, &mut load);
    (load, forces)
}

/// Compares the loads of the library with others, which are NaN where there is none; returns how
/// many there are.
pub(crate) fn compared(found: &[[f64; 3]], expected: &[[f64; 3]], what: &str) -> usize {
    assert_eq!(found.len(), expected.len(), "{what}");
    let mut compared = 0;
    for equation in 0..3 {
        let sizes = expected.iter().map(|row| row[equation].abs());
        let largest = sizes.fold(0.0, f64::max);
        for (row, (found, expected)) in found.iter().zip(expected).enumerate() {
            let (found, expected) = (found[equation], expected[equation]);
            if !expected.is_nan() {
                compared += 1;
                assert!(
                    (found - expected).abs() <= AGREEMENT * largest,
                    "{what}, equation {equation}, row {row}: {found}, not {expected}"
                );
            }
        }
    }
    compared
}

/// Compares the loads and forces of the library with those of the weak form.
fn compare(
    case: &Case,
    sources: &Sources,
    (expected, forces): (Vec<[f64; 3]>, Forces),
    count: usize,
    what: &str,
) {
    let solution = (&case.exact(), case.t);
    let (load, own) = filled(sources, solution, &case.obstacles, expected.len());
    for (found, expected) in [(own.axial, forces.axial), (own.contact, forces.contact)] {
        assert!(
            (found - expected).abs() <= AGREEMENT * (1.0 + expected.abs()),
            "{what}: {own:?}, not {forces:?}"
        );
    }
    let compared = compared(&load, &expected, what);
    assert_eq!(compared, count, "{what}: every basis function is compared");
}

/// The space that a simulation has.
pub(crate) fn space(mesh: Mesh, degree: usize) -> Space {
    let problem = DgProblem {
        beam: Beam::default(),
        obstacles: None,
        mesh,
        degree,
        initial: InitialFunctions::at_rest(0.0),
    };
    Dg::new(problem, DgStepping::default())
        .unwrap()
        .space()
        .clone()
}

#[test]
fn loads_are_those_of_the_weak_form_for_random_solutions_coefficients_and_meshes() {
    let mut phases = [0; 3];
    for seed in 0..CASES {
        let case = Case::random(seed);
        let (exact, mesh) = (case.exact(), Mesh::from_nodes(case.nodes.clone()).unwrap());
        let n = mesh.elements();
        let itself = |of_x: &Function, x: f64| {
            let [value, slope, _] = of_x.derivatives(x);
            [value, slope]
        };
        let interpolant = |of_x: &Function, x: f64| {
            let i = case.nodes.partition_point(|node| *node <= x).clamp(1, n) - 1;
            let (left, h) = (
                of_x.derivatives(case.nodes[i])[0],
                case.nodes[i + 1] - case.nodes[i],
            );
            let slope = (of_x.derivatives(case.nodes[i + 1])[0] - left) / h;
            [left + slope * (x - case.nodes[i]), slope]
        };
        let node = |_: usize, element: usize, m: usize| element + m;
        let hats = case.weak_form(1, &itself, n + 1, &node);
        phases[usize::from(hats.1.contact > 0.0) + 2 * usize::from(hats.1.contact < 0.0)] += 1;
        compare(
            &case,
            &Sources::strong(&exact, &case.beam, &mesh),
            hats,
            3 * n - 1,
            &format!("case {seed}, P1"),
        );
        let interpolated = case.weak_form(1, &interpolant, n + 1, &node);
        let sources = Sources::discrete(&exact, &case.beam, &mesh);
        compare(
            &case,
            &sources,
            interpolated,
            3 * n - 1,
            &format!("case {seed}, matrices"),
        );
        let degree = 2 + seed as usize % 6;
        let space = space(mesh, degree);
        let of_degree = |equation: usize, element: usize, m: usize| {
            let (row, place) =
                space.place([Field::U, Field::Phi, Field::Theta][equation], element, m);
            assert_eq!(place, equation);
            row
        };
        let expected = case.weak_form(degree, &itself, space.blocks(), &of_degree);
        let sources = Sources::any_order(&exact, &case.beam, &space);
        compare(
            &case,
            &sources,
            expected,
            3 * n * degree - 1,
            &format!("case {seed}, degree {degree}"),
        );
    }
    assert!(
        phases.iter().all(|count| *count > 20),
        "free, upper and lower contact all occur: {phases:?}"
    );
}
