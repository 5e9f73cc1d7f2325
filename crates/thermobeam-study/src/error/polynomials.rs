//! Errors against a run of any order in the norm of Theorem 3.4, as functions: the reference's
//! polynomials are never interpolated, so a mesh of the measured run may have any nodes and any
//! number of elements.
//!
//! The square of the norm is a sum over Gauss points. The error of a linear element is nearly
//! quadratic, its slope nearly linear, so that few points suffice; between polynomials of degrees p
//! and P the rule is exact.

use convergence_judge::text::number::max_or_nan;
use convergence_study::CaseFailure;
use thermobeam::dg::{self, DgLevel, Field};

use crate::error::Errors;

/// Gauss points in each linear element, exact to degree 11: coarse elements see polynomials of high
/// degree.
const COARSE_POINTS: usize = 6;
/// The same on fine meshes, exact to degree 5.
const FINE_POINTS: usize = 3;
/// From this number of elements a mesh is fine.
const FINE: usize = 512;

/// A run of any order at the times of observation, in ascending order.
#[derive(Debug, Clone, PartialEq)]
pub struct Polynomials {
    space: dg::Space,
    levels: Vec<DgLevel>,
}

/// A Gauss point, with the bases of both sides there.
struct GaussPoint {
    weight: f64,
    /// Place in the measured run.
    own: dg::BeamPoint,
    /// Place in the reference.
    reference: dg::BeamPoint,
}

/// The functions whose squares (3.14) adds: v, u_x - φ, w, φ_x, θ.
type Integrands = [f64; 5];

impl Polynomials {
    /// * `levels`: at the times of observation.
    pub(crate) fn new(space: dg::Space, levels: Vec<DgLevel>) -> Self {
        Self { space, levels }
    }

    /// The largest distances between two runs over their common times of observation; NaN if those
    /// differ.
    pub(crate) fn distance(&self, other: &Self) -> Errors {
        if self.levels.len() != other.levels.len() || self.levels.is_empty() {
            return Errors::NAN;
        }
        let meter = OfPolynomials::new(&other.space, self);
        let levels = other.levels.iter().enumerate();
        levels
            .map(|(index, level)| meter.errors(level, index))
            .fold(Errors::default(), Errors::worst)
    }
}

/// Measures the levels of a space.
pub(crate) struct OfPolynomials<'r> {
    space: &'r dg::Space,
    reference: &'r Polynomials,
    points: Vec<GaussPoint>,
}

impl<'r> OfPolynomials<'r> {
    /// * `space`: of the measured levels.
    pub(crate) fn new(space: &'r dg::Space, reference: &'r Polynomials) -> Self {
        let (own, others) = (space.mesh().nodes(), reference.space.mesh().nodes());
        let (nodes, count) = match space.degree() {
            1 if own.len() <= FINE => (own.to_vec(), COARSE_POINTS),
            1 => (own.to_vec(), FINE_POINTS),
            // Between the nodes of both the integrand is one polynomial of twice the higher degree.
            degree => {
                let mut nodes = [own, others].concat();
                nodes.sort_by(f64::total_cmp);
                nodes.dedup();
                (nodes, degree.max(reference.space.degree()) + 1)
            }
        };
        let gauss = dg::Space::gauss(count);
        let mut points = vec![];
        for ends in nodes.windows(2) {
            let half = 0.5 * (ends[1] - ends[0]);
            for (xi, weight) in &gauss {
                let x = ends[0] + half * (1.0 + xi);
                points.push(GaussPoint {
                    weight: half * weight,
                    own: space.locate(x),
                    reference: reference.space.locate(x),
                });
            }
        }
        Self {
            space,
            reference,
            points,
        }
    }

    /// The errors of a level at the observation with this number.
    pub(crate) fn errors(&self, level: &DgLevel, index: usize) -> Errors {
        let Polynomials { space, levels } = self.reference;
        let mut square = 0.0;
        for point in &self.points {
            let own = integrands(self.space, level, &point.own);
            let exact = integrands(space, &levels[index], &point.reference);
            for (own, exact) in own.iter().zip(exact) {
                // Without optimisation a power is a call.
                let difference = own - exact;
                square += point.weight * (difference * difference);
            }
        }
        Errors {
            norm: square.sqrt(),
            tip: (tip(self.space, level) - tip(space, &levels[index])).abs(),
        }
    }
}

fn integrands(space: &dg::Space, level: &DgLevel, point: &dg::BeamPoint) -> Integrands {
    let [(_, u_x), (phi, phi_x), (v, _), (w, _), (theta, _)] =
        level.values_and_slopes_at(space, point);
    [v, u_x - phi, w, phi_x, theta]
}

fn tip(space: &dg::Space, level: &DgLevel) -> f64 {
    level.value_and_slope(space, Field::U, 1.0).0
}

impl Errors {
    /// Errors that are not known.
    pub const NAN: Self = Self {
        norm: f64::NAN,
        tip: f64::NAN,
    };

    /// The larger of each two; NaN if either is NaN.
    #[must_use]
    pub fn worst(self, other: Self) -> Self {
        Self {
            norm: max_or_nan(self.norm, other.norm),
            tip: max_or_nan(self.tip, other.tip),
        }
    }
}

/// A reference that is not there.
pub(crate) fn missing() -> CaseFailure {
    CaseFailure::new("there is nothing to measure the error against")
}

#[cfg(test)]
#[expect(clippy::disallowed_methods, reason = "single steps are compared")]
mod tests {
    use super::*;
    use crate::error::{Evaluator, free_vibration};
    use crate::run::{ObservableMotion, family::Family, levels::linear};
    use thermobeam::dg::DgStepping;
    use thermobeam::mesh::Mesh;
    use thermobeam::scheme::EULER_CRANK_NICOLSON;
    use thermobeam::solve::Settings;

    const ZETA: f64 = 0.1;

    /// The exact vibration of the lowest mode, to t = 1.
    fn vibrating() -> Family {
        let exact = free_vibration::vibration(&[(0, 0.1)], ZETA).unwrap();
        Family::of_free_solution(exact, free_vibration::beam(ZETA), 1.0)
    }

    /// Its state at the end by dG, on elements of this degree.
    fn end(family: &Family, nodes: &[f64], degree: usize) -> Polynomials {
        let stepping = DgStepping {
            degree: 4,
            dt: 0.05,
            ..DgStepping::default()
        };
        let mesh = Mesh::from_nodes(nodes.to_vec()).unwrap();
        let mut motion = family.dg(mesh, degree, stepping).unwrap();
        while motion.step(1.0).unwrap().is_some() {}
        let simulation = motion.simulation();
        Polynomials::new(simulation.space().clone(), vec![simulation.level().clone()])
    }

    fn agree(one: Errors, other: Errors) {
        for (a, b) in [(one.norm, other.norm), (one.tip, other.tip)] {
            assert!(a > 1e-8 && (a / b - 1.0).abs() < 1e-5, "{one:?}, {other:?}");
        }
    }

    #[test]
    fn errors_of_linear_elements_are_those_to_the_exact_solution() {
        let family = vibrating();
        let reference = end(&family, &[0.0, 0.7, 1.0], 14);
        for elements in [5, 40, 600] {
            let mesh = Mesh::mapped(elements, |s| 1.0 - (1.0 - s).powf(1.5)).unwrap();
            let space = dg::Space::new(mesh.clone(), 1).unwrap();
            let on = family.on_nodes(mesh);
            let settings = Settings::default();
            let mut run = on.start(EULER_CRANK_NICOLSON, settings, 20).unwrap();
            for _ in 0..20 {
                run.step(f64::INFINITY).unwrap();
            }
            let level = linear(&run.on(on.mesh()), run.motion().t());
            let errors = |reference| {
                let mut evaluator = Evaluator::new(&family, &space, reference).unwrap();
                evaluator.measure(&level, 0)
            };
            agree(errors(None), errors(Some(&reference)));
        }
    }

    #[test]
    fn errors_of_any_order_are_those_to_the_exact_solution() {
        let family = vibrating();
        let reference = end(&family, &[0.0, 0.7, 1.0], 14);
        for nodes in [&[0.0, 1.0][..], &[0.0, 0.4, 1.0]] {
            let coarse = end(&family, nodes, 3);
            let errors = |reference| {
                let mut evaluator = Evaluator::new(&family, &coarse.space, reference).unwrap();
                evaluator.measure(&coarse.levels[0], 0)
            };
            agree(errors(None), errors(Some(&reference)));
            agree(errors(None), reference.distance(&coarse));
        }
    }

    #[test]
    fn runs_with_other_times_have_no_distance() {
        let family = vibrating();
        let one = end(&family, &[0.0, 1.0], 3);
        let mut other = one.clone();
        assert_eq!(one.distance(&other), Errors::default());
        other.levels.push(other.levels[0].clone());
        assert!(one.distance(&other).norm.is_nan());
    }
}
