//! Sources on a surface, which values at points do not hold.
//!
//! A choice of `abs`, `min`, `max`, `where` or `heaviside` is differentiated on each side. If what is
//! differentiated jumps from one side to the other, its derivative has a part on the surface between
//! them, too: of the strength of the jump, or the derivative of such a part.
//!
//! Let the choice go over within a width w, and let S_w be the source then, S the one of both sides.
//! Along a line through the surface, over 20 w to both sides,
//!
//! ```text
//! M_0 = ∫ (S_w - S) ds,    M_1 = ∫ s (S_w - S) ds
//! ```
//!
//! go to zero with w if there is nothing on the surface, and to its strength otherwise. It does not
//! matter whether a term has it, as long as the terms have it together: `k` and the gradient of `u`
//! may jump where `k*grad(u)` does not.
//!
//! What rounding leaves of a moment is measured: the rule of midpoints is as good as exact, so its
//! results with more points differ by rounding alone.

use super::{Finding, Sampled, finding};
use crate::arithmetic::tape::Tape;
use crate::arithmetic::{Node, NodeId};
use crate::derive::{DerivedQuantity, Role};
use crate::model::{Model, TensorRows};
use crate::sample::Sampler;

/// Widths of a step, as shares of the largest difference that the choice compares.
const WIDTHS: [f64; 2] = [1e-3, 1e-4];

/// A moment that is at least this share of the one of ten times the width does not go to zero.
const STAYS: f64 = 0.5;

/// A moment that is less than this share of the largest value of the source is nothing: the domain is
/// about 1 long.
const NEGLIGIBLE: f64 = 1e-8;

/// A moment that is not this many times as large as its rounding is nothing.
const ABOVE_ROUNDING: f64 = 1e3;

/// The line ends at this many widths: tanh is 1 there but for 1e-17.
const REACH: i32 = 20;

/// Points for each width. The rule of midpoints is exact for S_w - S but for exp(-4 π^2): tanh(s/w) has
/// its poles at a distance of π w/2 from the line.
const POINTS_PER_WIDTH: [i32; 3] = [4, 5, 6];

/// Places that are looked at on each surface.
const PLACES: usize = 4;

/// Pairs of points that are tried for them.
const PAIRS: usize = 40;

/// One finding for each equation whose source has a part on a surface inside the domain.
pub(super) fn sources(model: &Model, sampled: &Sampled<'_>, sampler: &Sampler<'_>) -> Vec<Finding> {
    let sources: Vec<_> = sources_of(model).collect();
    let rows = model.rows(sources.iter().copied());
    // A choice may be in no source: the derivative of a step is zero on both sides.
    let nodes = (0..model.graph.len() as u32).map(NodeId);
    let choices = nodes.filter(|id| matches!(model.graph.node(*id), Node::Choose(..)));
    let choices = Tape::new(&model.graph, &choices.collect::<Vec<_>>());
    let points = sampled.points.iter();
    let switches: Vec<Vec<f64>> = points.map(|point| choices.at(point).switches).collect();
    let mut findings: Vec<Finding> = vec![];
    for switch in 0..switches.first().map_or(0, Vec::len) {
        let surface = Surface {
            sampler,
            choices: &choices,
            switch,
            sides: sampler.sides(sampled.part),
            scale: switches
                .iter()
                .map(|all| all[switch].abs())
                .fold(0.0, f64::max),
        };
        let of_sides = |sign: f64| {
            let pairs = sampled.points.iter().zip(&switches);
            pairs
                .filter(move |pair| pair.1[switch] * sign > 0.0)
                .map(|pair| pair.0)
        };
        let pairs = of_sides(1.0).zip(of_sides(-1.0)).take(PAIRS);
        let lines = pairs.filter_map(|(one, other)| surface.line_between(one, other));
        let lines: Vec<Line> = lines.take(PLACES).collect();
        let steps = WIDTHS.map(|share| model.with_steps_of(share * surface.scale));
        // Without values beyond a branch nothing is known.
        let ([Ok(wide), Ok(thin)], false) = (steps, lines.is_empty()) else {
            continue;
        };
        let [wide, thin] = [&wide, &thin].map(|model| model.rows(sources_of(model)));
        for line in lines {
            let wide = line.on_surface(&wide, &rows, WIDTHS[0]);
            let thin = line.on_surface(&thin, &rows, WIDTHS[1]);
            for ((source, wide), thin) in sources.iter().zip(&wide).zip(&thin) {
                let mut pairs = wide.iter().zip(thin);
                let is_known = findings.iter().any(|known| known.key == source.place.key);
                let least = NEGLIGIBLE * largest(sampled, &source.name);
                if !is_known && pairs.any(|(wide, thin)| thin.stays(wide, least)) {
                    findings.push(found(model, source, &line));
                }
            }
        }
    }
    findings
}

fn sources_of(model: &Model) -> impl Iterator<Item = &DerivedQuantity<NodeId>> {
    model.of_role(Role::Source)
}

/// The largest absolute value of a source.
fn largest(sampled: &Sampled<'_>, source: &str) -> f64 {
    let mut quantities = sampled.quantities.iter();
    let place = quantities.position(|q| q.role == Role::Source && q.name == source);
    let values = place.into_iter().flat_map(|place| sampled.over(place));
    let values = values.flat_map(|(_, components)| components);
    values.map(|at| at.value.abs()).fold(0.0, f64::max)
}

fn found(model: &Model, source: &DerivedQuantity<NodeId>, line: &Line) -> Finding {
    let at = model.place_in_words(&line.middle);
    let text = format!(
        "what is differentiated jumps at a switch of abs, min, max, where or heaviside, at about {at}: \
         its derivative is a source on that surface, too, which the values of the source do not hold"
    );
    finding("surface-source", &source.place.key, text, None)
}

/// M_0 or M_1 of a component.
struct Moment {
    value: f64,
    rounding: f64,
}

impl Moment {
    /// Whether it goes to something else than zero.
    ///
    /// * `wide`: the moment with the larger width.
    /// * `least`: one up to this is nothing.
    fn stays(&self, wide: &Moment, least: f64) -> bool {
        let least = least.max(ABOVE_ROUNDING * self.rounding);
        self.value.abs() > least.max(STAYS * wide.value.abs())
    }
}

/// Where two sides of a switch meet.
struct Surface<'s, 'm> {
    sampler: &'s Sampler<'m>,
    choices: &'s Tape<'m>,
    switch: usize,
    sides: Vec<[f64; 2]>,
    /// The largest difference that is compared.
    scale: f64,
}

impl Surface<'_, '_> {
    /// The difference that is compared, as a share of the largest.
    fn difference(&self, point: &[f64]) -> f64 {
        self.choices.at(point).switches[self.switch] / self.scale
    }

    /// The line across the surface between two points on both sides; `None` if it leaves the domain.
    fn line_between(&self, one: &[f64], other: &[f64]) -> Option<Line> {
        const HALVINGS: usize = 60;
        let [mut one, mut other] = [one.to_vec(), other.to_vec()];
        let sign = self.difference(&one);
        for _ in 0..HALVINGS {
            let middle: Vec<f64> = one
                .iter()
                .zip(&other)
                .map(|(a, b)| a + 0.5 * (b - a))
                .collect();
            let is_near = self.difference(&middle) * sign > 0.0;
            *(if is_near { &mut one } else { &mut other }) = middle;
        }
        let line = self.line_at(one);
        let ends = [-1.0, 1.0].map(|side| line.at(side * f64::from(REACH) * WIDTHS[0]));
        let is_inside = ends.iter().all(|end| {
            let mut pairs = end.iter().zip(&self.sides);
            pairs.all(|(x, [low, high])| (low..=high).contains(&x))
                && self.sampler.is_inside(end, None)
        });
        is_inside.then_some(line)
    }

    /// The line down the steepest slope of the difference, in lengths of the sides.
    fn line_at(&self, middle: Vec<f64>) -> Line {
        const STEP: f64 = 1e-5;
        let mut along = vec![];
        let mut square = 0.0;
        for (axis, [low, high]) in self.sides.iter().enumerate() {
            let moved = |by: f64| {
                let mut point = middle.clone();
                point[axis] += by * (high - low);
                self.difference(&point)
            };
            let slope = (moved(STEP) - moved(-STEP)) / (2.0 * STEP);
            square += slope * slope;
            along.push(slope * (high - low));
        }
        Line {
            along: along.iter().map(|part| part / square).collect(),
            middle,
        }
    }
}

/// A line across a surface. Its parameter s is the difference that is compared, as a share of the
/// largest.
struct Line {
    middle: Vec<f64>,
    along: Vec<f64>,
}

impl Line {
    fn at(&self, s: f64) -> Vec<f64> {
        let pairs = self.middle.iter().zip(&self.along);
        pairs.map(|(x, along)| x + s * along).collect()
    }

    /// M_0 and M_1 of each component of each source.
    ///
    /// * `smooth`, `sharp`: S_w and S.
    fn on_surface(
        &self,
        smooth: &TensorRows<'_>,
        sharp: &TensorRows<'_>,
        width: f64,
    ) -> Vec<Vec<Moment>> {
        let few_to_many = POINTS_PER_WIDTH.map(|points| self.moments(smooth, sharp, width, points));
        let of_source = |source: usize| {
            let parts = 0..few_to_many[0][source].len();
            let moments = parts.map(|part| {
                let [few, more, most] = few_to_many.each_ref().map(|moments| moments[source][part]);
                Moment {
                    value: most,
                    rounding: (most - more).abs().max((most - few).abs()),
                }
            });
            moments.collect()
        };
        (0..few_to_many[0].len()).map(of_source).collect()
    }

    /// The integrals of each component of each source and, behind each, of it times s, by so many
    /// points for each width.
    fn moments(
        &self,
        smooth: &TensorRows<'_>,
        sharp: &TensorRows<'_>,
        width: f64,
        points: i32,
    ) -> Vec<Vec<f64>> {
        let step = width / f64::from(points);
        let mut moments: Vec<Vec<f64>> = vec![];
        for place in -REACH * points..REACH * points {
            let s = (f64::from(place) + 0.5) * step;
            let [smooth, sharp] = [smooth, sharp].map(|rows| rows.at(&self.at(s)).tensors);
            let parts = smooth.iter().zip(&sharp).map(|(smooth, sharp)| {
                let pairs = smooth.iter().zip(sharp);
                let parts = pairs.map(|(smooth, sharp)| (smooth.value - sharp.value) * step);
                parts.flat_map(|part| [part, part * s]).collect()
            });
            let parts: Vec<Vec<f64>> = parts.collect();
            if moments.is_empty() {
                moments = parts;
                continue;
            }
            for (moment, part) in moments.iter_mut().flatten().zip(parts.iter().flatten()) {
                *moment += part;
            }
        }
        moments
    }
}
