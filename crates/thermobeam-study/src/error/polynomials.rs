//! Errors against a run of any order in the norm of Theorem 3.4, as functions: the reference's polynomials are never
//! interpolated, so a mesh of the measured run may have any nodes and any number of elements.
//!
//! The square of the norm is a sum over Gauss points. The error of a linear element is nearly quadratic, its slope nearly
//! linear, so that few points suffice; between polynomials of degrees p and P the rule is exact.

use convergence_study::study::CaseFailure;
use convergence_study::text::number::max_or_nan;
use thermobeam::dg::{self, Field};
use thermobeam::mesh::Mesh;
use thermobeam::solve::Level;

use crate::error::Errors;

/// Gauss points in each linear element, exact to degree 11: coarse elements see polynomials of high degree.
const COARSE_POINTS: usize = 6;
/// The same on fine meshes, exact to degree 5.
const FINE_POINTS: usize = 3;
/// From this number of elements a mesh is fine.
const FINE: usize = 512;

/// A run of any order at the times of observation, in ascending order.
#[derive(Debug, Clone, PartialEq)]
pub struct Polynomials {
    space: dg::Space,
    levels: Vec<dg::Level>,
}

/// A Gauss point, with the bases of both sides there.
struct GaussPoint<P> {
    weight: f64,
    /// Place in the measured run.
    own: P,
    /// Place in the reference.
    reference: dg::Point,
}

/// Place in a linear element.
struct Linear {
    element: usize,
    /// From 0 at the left end to 1 at the right end.
    s: f64,
}

/// The functions whose squares (3.14) adds: v, u_x - φ, w, φ_x, θ.
type Integrands = [f64; 5];

impl Polynomials {
    /// * `levels`: at the times of observation.
    pub(crate) fn new(space: dg::Space, levels: Vec<dg::Level>) -> Self {
        Self { space, levels }
    }

    /// u(1) at the observation with this number.
    pub(crate) fn tip(&self, index: usize) -> f64 {
        tip(&self.space, &self.levels[index])
    }

    /// The largest distances between two runs over their common times of observation; NaN if those differ.
    pub(crate) fn distance(&self, other: &Self) -> Errors {
        if self.levels.len() != other.levels.len() || self.levels.is_empty() {
            return Errors::NAN;
        }
        let meter = other.against(self);
        let levels = other.levels.iter().enumerate();
        levels
            .map(|(index, level)| meter.errors(level, index))
            .fold(Errors::default(), Errors::worst)
    }

    /// Measures runs on this space against a reference.
    fn against<'r>(&'r self, reference: &'r Self) -> OfAnyOrder<'r> {
        OfAnyOrder::new(&self.space, reference)
    }
}

/// Measures levels of any order.
pub(crate) struct OfAnyOrder<'r> {
    space: &'r dg::Space,
    reference: &'r Polynomials,
    points: Vec<GaussPoint<dg::Point>>,
}

impl<'r> OfAnyOrder<'r> {
    /// * `space`: of the measured levels.
    pub(crate) fn new(space: &'r dg::Space, reference: &'r Polynomials) -> Self {
        let mut nodes = [space.mesh().nodes(), reference.space.mesh().nodes()].concat();
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        // Between these nodes the integrand is one polynomial of twice the higher degree.
        let gauss = dg::Space::gauss(space.degree().max(reference.space.degree()) + 1);
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
    pub(crate) fn errors(&self, level: &dg::Level, index: usize) -> Errors {
        let norm = self.reference.norm(index, &self.points, |point| {
            integrands(self.space, level, point)
        });
        let tip = (tip(self.space, level) - self.reference.tip(index)).abs();
        Errors { norm, tip }
    }
}

/// Measures levels of linear elements.
pub(crate) struct OfLinear<'r> {
    mesh: Mesh,
    reference: &'r Polynomials,
    points: Vec<GaussPoint<Linear>>,
}

impl<'r> OfLinear<'r> {
    /// * `mesh`: of the measured levels.
    pub(crate) fn new(mesh: Mesh, reference: &'r Polynomials) -> Self {
        let count = if mesh.elements() < FINE {
            COARSE_POINTS
        } else {
            FINE_POINTS
        };
        let gauss = dg::Space::gauss(count);
        let mut points = vec![];
        for (element, ends) in mesh.nodes().windows(2).enumerate() {
            let h = ends[1] - ends[0];
            for (xi, weight) in &gauss {
                let s = 0.5 * (1.0 + xi);
                points.push(GaussPoint {
                    weight: 0.5 * h * weight,
                    own: Linear { element, s },
                    reference: reference.space.locate(ends[0] + s * h),
                });
            }
        }
        Self {
            mesh,
            reference,
            points,
        }
    }

    /// The errors of a level at the observation with this number.
    pub(crate) fn errors(&self, level: &Level, index: usize) -> Errors {
        let nodes = self.mesh.nodes();
        let norm = self
            .reference
            .norm(index, &self.points, |&Linear { element: e, s }| {
                let value = |y: &[f64]| (1.0 - s) * y[e] + s * y[e + 1];
                let slope = |y: &[f64]| (y[e + 1] - y[e]) / (nodes[e + 1] - nodes[e]);
                [
                    value(&level.v),
                    slope(&level.u) - value(&level.phi),
                    value(&level.w),
                    slope(&level.phi),
                    value(&level.theta),
                ]
            });
        let tip = (level.u[level.u.len() - 1] - self.reference.tip(index)).abs();
        Errors { norm, tip }
    }
}

impl Polynomials {
    /// The norm of the difference to the functions `own`.
    fn norm<P>(
        &self,
        index: usize,
        points: &[GaussPoint<P>],
        own: impl Fn(&P) -> Integrands,
    ) -> f64 {
        let mut square = 0.0;
        for point in points {
            let exact = integrands(&self.space, &self.levels[index], &point.reference);
            for (own, exact) in own(&point.own).iter().zip(exact) {
                square += point.weight * (own - exact).powi(2);
            }
        }
        square.sqrt()
    }
}

fn integrands(space: &dg::Space, level: &dg::Level, point: &dg::Point) -> Integrands {
    let [(_, u_x), (phi, phi_x), (v, _), (w, _), (theta, _)] =
        level.values_and_slopes_at(space, point);
    [v, u_x - phi, w, phi_x, theta]
}

pub(crate) fn tip(space: &dg::Space, level: &dg::Level) -> f64 {
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
