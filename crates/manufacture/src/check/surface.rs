//! Sources on a surface, which values at points do not hold.
//!
//! A choice of `abs`, `min`, `max`, `where` or `heaviside` is differentiated on each side. If what
//! is differentiated jumps from one side to the other, its derivative has a part on the surface
//! between them, too: of the strength of the jump, or the derivative of such a part.
//!
//! Let the choice go over within a width w along a line through the surface, and let S_w be the
//! source then, S the one of both sides. Over 20 w to both sides,
//!
//! ```text
//! M_k = ∫ s^k (S_w - S) ds
//! ```
//!
//! goes to zero with w if there is nothing on the surface, and to the strength of a part that is k
//! times differentiated otherwise. What terms have there may cancel: `k` and the gradient of `u`
//! may jump where `k*grad(u)` does not.
//!
//! What rounding leaves of a moment is measured: the rule of midpoints is as good as exact, so its
//! results with more points differ by rounding alone.

use super::{Finding, Sampled, finding};
use crate::arithmetic::graph::Steps;
use crate::arithmetic::tape::Tape;
use crate::arithmetic::{Node, NodeId};
use crate::derive::{DerivedQuantity, Role};
use crate::model::{Model, SmoothSources, TensorRows};
use crate::sample::Sampler;

/// Widths of a step, in lengths of the domain: the second pair where the first leaves it.
const WIDTHS: [[f64; 2]; 2] = [[1e-3, 1e-4], [1e-4, 1e-5]];

/// A moment that is at least this share of the one of ten times the width does not go to zero.
const STAYS: f64 = 0.5;

/// A moment that is less than this share of the largest value of the source is nothing.
const NEGLIGIBLE: f64 = 1e-8;

/// A moment that is not this many times as large as its rounding is nothing.
const ABOVE_ROUNDING: f64 = 1e3;

/// A line ends at this many widths: tanh is 1 there but for 1e-17.
const REACH: i32 = 20;

/// Points for each width. The rule of midpoints is exact for S_w - S but for exp(-4 π^2): tanh(s/w)
/// has its poles at a distance of π w/2 from the line.
const POINTS_PER_WIDTH: [i32; 3] = [4, 5, 6];

/// Places that are looked at on each surface.
const PLACES: usize = 6;

/// Pairs of points that are tried for them.
const PAIRS: usize = 100;

/// Most moments: as many as the highest order of the derivatives, but for equations of more than
/// fourth order.
const MOST_MOMENTS: usize = 4;

/// One finding for each equation whose source has a part on a surface inside the domain, or may
/// have one.
pub(super) fn sources(model: &Model, sampled: &Sampled<'_>, sampler: &Sampler<'_>) -> Vec<Finding> {
    // A choice may be in no source: the derivative of a step is zero on both sides.
    let nodes = (0..model.graph.len() as u32).map(NodeId);
    let choices = nodes.filter(|id| matches!(model.graph.node(*id), Node::Choose(..)));
    let choices = Tape::new(&model.graph, &choices.collect::<Vec<_>>());
    let points = sampled.points.iter();
    let switches: Vec<Vec<f64>> = points.map(|point| choices.at(point).switches).collect();
    if switches.first().is_none_or(Vec::is_empty) {
        return vec![];
    }
    let sources: Vec<_> = model.of_role(Role::Source).collect();
    let sharp = model.rows(sources.iter().copied());
    let sizes = sources.iter().map(|source| largest(sampled, &source.name));
    let sizes: Vec<f64> = sizes.collect();
    let mut findings: Vec<Finding> = vec![];
    for switch in 0..switches[0].len() {
        let surface = Surface {
            sampler,
            choices: &choices,
            switch,
            sides: sampler.sides(sampled.part),
        };
        let of_sides = |sign: f64| {
            let pairs = sampled.points.iter().zip(&switches);
            let pairs = pairs.filter(move |pair| pair.1[switch] * sign > 0.0);
            pairs.map(|pair| pair.0)
        };
        let pairs = of_sides(1.0).zip(of_sides(-1.0)).take(PAIRS);
        let lines = pairs.filter_map(|(one, other)| surface.lines_between(one, other));
        for [wide, thin] in lines.take(PLACES) {
            let models = [&wide, &thin].map(|line| model.with_steps(line.clone()));
            let [Ok(of_wide), Ok(of_thin)] = models else {
                continue;
            };
            let orders = model.order().clamp(1, MOST_MOMENTS);
            let of_wide = on_surface(&wide, &of_wide, &sharp, orders);
            let of_thin = on_surface(&thin, &of_thin, &sharp, orders);
            let moments = of_wide.iter().zip(&of_thin);
            for ((source, size), (of_wide, of_thin)) in sources.iter().zip(&sizes).zip(moments) {
                if findings.iter().any(|known| known.key == source.place.key) {
                    continue;
                }
                let least = NEGLIGIBLE * size;
                let mut pairs = of_wide.iter().zip(of_thin);
                if pairs.any(|(of_wide, of_thin)| of_thin.stays(of_wide, least)) {
                    findings.push(found(model, source, &thin.middle));
                } else if of_thin.iter().any(|moment| !moment.value.is_finite()) {
                    findings.push(not_examined(model, source, &thin.middle));
                }
            }
        }
    }
    findings
}

/// The largest absolute value of a source.
fn largest(sampled: &Sampled<'_>, source: &str) -> f64 {
    let mut quantities = sampled.quantities.iter();
    let place = quantities.position(|q| q.role == Role::Source && q.name == source);
    let values = place.into_iter().flat_map(|place| sampled.over(place));
    let values = values.flat_map(|(_, components)| components);
    values.map(|at| at.value.abs()).fold(0.0, f64::max)
}

fn found(model: &Model, source: &DerivedQuantity<NodeId>, at: &[f64]) -> Finding {
    let at = model.place_in_words(at);
    let text = format!(
        "what is differentiated jumps at a switch of abs, min, max, where or heaviside, at about {at}: \
         its derivative is a source on that surface, too, which the values of the source do not hold"
    );
    finding("surface-source", &source.place.key, text, None)
}

fn not_examined(model: &Model, source: &DerivedQuantity<NodeId>, at: &[f64]) -> Finding {
    let at = model.place_in_words(at);
    let text = format!(
        "a switch of abs, min, max, where or heaviside at about {at} is not examined: a branch has no \
         value beyond it; if what is differentiated jumps there, a source on that surface is missing"
    );
    finding("surface-source", &source.place.key, text, None)
}

/// M_k of a component.
struct Moment {
    value: f64,
    rounding: f64,
}

impl Moment {
    /// Whether it goes to something else than zero.
    ///
    /// * `of_wide`: the moment with the larger width.
    /// * `least`: one up to this is nothing.
    fn stays(&self, of_wide: &Moment, least: f64) -> bool {
        let least = least.max(ABOVE_ROUNDING * self.rounding);
        self.value.abs() > least.max(STAYS * of_wide.value.abs())
    }
}

/// Where two sides of a switch meet.
struct Surface<'s, 'm> {
    sampler: &'s Sampler<'m>,
    choices: &'s Tape<'m>,
    switch: usize,
    sides: Vec<[f64; 2]>,
}

impl Surface<'_, '_> {
    /// The difference that is compared.
    fn difference(&self, point: &[f64]) -> f64 {
        self.choices.at(point).switches[self.switch]
    }

    /// The lines of two widths across the surface between two points on both sides; `None` if they
    /// leave the domain.
    fn lines_between(&self, one: &[f64], other: &[f64]) -> Option<[Steps; 2]> {
        const HALVINGS: usize = 60;
        let [mut one, mut other] = [one.to_vec(), other.to_vec()];
        let sign = self.difference(&one);
        for _ in 0..HALVINGS {
            let pairs = one.iter().zip(&other);
            let middle: Vec<f64> = pairs.map(|(a, b)| a + 0.5 * (b - a)).collect();
            let is_near = self.difference(&middle) * sign > 0.0;
            *(if is_near { &mut one } else { &mut other }) = middle;
        }
        let line = self.line_at(one)?;
        let lines = WIDTHS.iter().map(|widths| {
            widths.map(|width| Steps {
                width,
                ..line.clone()
            })
        });
        let mut lines = lines.filter(|[wide, _]| self.contains(wide));
        lines.next()
    }

    /// Whether the ends of a line are inside.
    fn contains(&self, line: &Steps) -> bool {
        let ends = [-1.0, 1.0].map(|side| line.at(side * line.reach * line.width));
        ends.iter().all(|end| {
            let mut pairs = end.iter().zip(&self.sides);
            pairs.all(|(x, [low, high])| low <= x && x <= high) && self.sampler.is_inside(end, None)
        })
    }

    /// The line down the steepest slope of the difference, in lengths of the sides.
    fn line_at(&self, middle: Vec<f64>) -> Option<Steps> {
        const STEP: f64 = 1e-5;
        let lengths: Vec<f64> = self.sides.iter().map(|[low, high]| high - low).collect();
        let slopes = lengths.iter().enumerate().map(|(axis, length)| {
            let moved = |by: f64| {
                let mut point = middle.clone();
                point[axis] += by * length;
                self.difference(&point)
            };
            moved(STEP) - moved(-STEP)
        });
        let slopes: Vec<f64> = slopes.collect();
        let size = slopes.iter().map(|slope| slope * slope).sum::<f64>().sqrt();
        let along = slopes.iter().zip(lengths);
        let along = along.map(|(slope, length)| slope / size * length).collect();
        (size > 0.0).then_some(Steps {
            middle,
            along,
            width: 0.0,
            reach: f64::from(REACH),
        })
    }
}

/// The moments of each component of each source, up to so many.
fn on_surface(
    line: &Steps,
    smooth: &SmoothSources,
    sharp: &TensorRows<'_>,
    orders: usize,
) -> Vec<Vec<Moment>> {
    let smooth = smooth.rows();
    let few_to_many =
        POINTS_PER_WIDTH.map(|points| moments(line, [&smooth, sharp], orders, points));
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

/// The same by so many points for each width.
fn moments(
    line: &Steps,
    [smooth, sharp]: [&TensorRows<'_>; 2],
    orders: usize,
    points: i32,
) -> Vec<Vec<f64>> {
    let step = line.width / f64::from(points);
    let mut moments: Vec<Vec<f64>> = vec![];
    for place in -REACH * points..REACH * points {
        let s = (f64::from(place) + 0.5) * step;
        let [smooth, sharp] = [smooth, sharp].map(|rows| rows.at(&line.at(s)).tensors);
        let parts = smooth.iter().zip(&sharp).map(|(smooth, sharp)| {
            let pairs = smooth.iter().zip(sharp);
            let parts = pairs.map(|(smooth, sharp)| (smooth.value - sharp.value) * step);
            let parts = parts.flat_map(|part| (0..orders as i32).map(move |k| part * s.powi(k)));
            parts.collect()
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
