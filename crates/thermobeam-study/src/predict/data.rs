//! Initial data on the meshes of a search: nodes where a mesh would miss a feature, before the
//! first run.
//!
//! Two discretisations that miss the same feature agree, so their difference says nothing about it.
//! Therefore each field of the initial data is compared with its projection (3.6) on the first
//! mesh; elements on which they differ are halved until the difference is a tenth of the wanted
//! error, or the search is refused with the field and x.
//!
//! # The measure of a difference e
//!
//! | for | u_t, φ_t, θ | u, φ |
//! | --- | --- | --- |
//! | u(1, t), φ(1, t), energy | ∫ abs(e) | ∫ abs(e_x) |
//! | the norm of Theorem 3.4 | its square, ∫ e² | ∫ e_x² |
//!
//! Let G(x, t) be the displacement at x = 1 at time t after a unit impulse at x. It is about 1 at
//! most: the step behind the front of a wave has the height 1, and viscosity only smooths it. By
//! linearity e in u_t changes u(1, t) by ∫ e G, at most by ∫ abs(e), and e in u by ∫ e G_t, at most
//! by max abs(e) <= ∫ abs(e_x). The energy changes by at most the largest value of the field times
//! the same integrals. Contact and N(u) amplify these errors as they amplify those of a step.
//!
//! A jump of u_t, φ_t or θ takes elements of 1e-4 to 1e-7 for the former; for the norm it is
//! refused.
//!
//! # What is seen
//!
//! An integral is a sum over equal parts of an element, between those of the scene's nodes that lie
//! in it. A part is at most [`NARROWEST`] long, so that a Gaussian exp(-((x - c)/w)²) of width w >=
//! 1e-4 has a point where it exceeds e^(-1/4) of its height. A narrower feature is seen only where
//! the scene has nodes, or where `abs`, `min` or `max` have a kink in it.

use thermobeam::dg::{Dg, Field};
use thermobeam::mesh::Mesh;

use super::curves::{CurveRows, Wanted};
use super::{StopReason, Unreachable};
use crate::expression::Expression;
use crate::scene::{Initial, Scene};

/// Ratio of the distances of neighbouring nodes from x = 1.
pub(super) const GRADING: f64 = 6.0;

/// Maximum number of elements.
pub(super) const MOST_ELEMENTS: usize = 512;

/// Longest distance of points of comparison: features of this width are seen.
const NARROWEST: f64 = 1e-4;

/// Points of comparison in an element, in units of p + 1.
const POINTS_PER_DEGREE: usize = 4;

/// Share of the wanted error that initial data may take.
const SHARE: f64 = 0.1;

/// Relative rounding errors of a projection.
const ROUNDING: f64 = 1e-12;

/// A change over [`SHORTEST`] that is half of that over so many times the length is a jump.
const STEEP: f64 = 8.0;

/// Shortest element that is made here: shorter ones lose digits of slopes.
const SHORTEST: f64 = 1e-7;

/// A field that is not zero.
struct NonzeroField {
    name: &'static str,
    field: Field,
    function: Expression,
}

impl NonzeroField {
    /// Whether errors of its slope count.
    fn counts_slope(&self) -> bool {
        matches!(self.field, Field::U | Field::Phi)
    }

    /// The field, or its slope, at x.
    fn at(&self, x: f64) -> f64 {
        if self.counts_slope() {
            self.function.derivatives(x)[1]
        } else {
            self.function.eval(x)
        }
    }

    /// Where the field jumps in an element by more than `least`: a difference that stays when the
    /// interval becomes shorter, down to [`SHORTEST`]. The interval is the half over which the
    /// field changes more.
    fn jump(&self, [mut from, mut to]: [f64; 2], least: f64) -> Option<f64> {
        // An element may be short itself, because of the jump.
        let mut before = self.change(from, to);
        while to - from > SHORTEST {
            if to - from > STEEP * SHORTEST {
                before = self.change(from, to);
            }
            let middle = 0.5 * (from + to);
            if self.change(from, middle) > self.change(middle, to) {
                to = middle;
            } else {
                from = middle;
            }
        }
        let last = self.change(from, to);
        (last > least && last > 0.5 * before).then_some(0.5 * (from + to))
    }

    /// By how much the field at one point differs from that at another.
    fn change(&self, from: f64, to: f64) -> f64 {
        (self.function.eval(to) - self.function.eval(from)).abs()
    }
}

/// The differences on one element.
#[derive(Clone)]
struct ElementDifferences {
    from: f64,
    to: f64,
    /// The integral of each field's difference, or of its square.
    integrals: Vec<f64>,
    /// The largest value of each field, or of its slope.
    largest: Vec<f64>,
}

/// The initial data of a scene.
pub(super) struct Data {
    fields: Vec<NonzeroField>,
    theta_a: f64,
    /// Nodes of the scene.
    nodes: Vec<f64>,
    /// Nodes that a search keeps: those that the scene lists, and the kinks.
    pub(super) kept: Vec<f64>,
    /// Points at which a field has a kink.
    pub(super) kinks: Vec<f64>,
}

impl Data {
    pub(super) fn of(scene: &Scene) -> Self {
        let Initial {
            u,
            u_t,
            phi,
            phi_t,
            theta,
        } = &scene.initial;
        let fields = [
            ("u", Field::U, u),
            ("u_t", Field::V, u_t),
            ("phi", Field::Phi, phi),
            ("phi_t", Field::W, phi_t),
            ("theta", Field::Theta, theta),
        ];
        let fields: Vec<NonzeroField> = fields
            .into_iter()
            .filter_map(|(name, field, function)| {
                Some(NonzeroField {
                    name,
                    field,
                    function: function.clone()?,
                })
            })
            .collect();
        let mut kinks: Vec<f64> = fields
            .iter()
            .flat_map(|datum| datum.function.kinks())
            .collect();
        // A function such as x/abs(x) has no value at its jump, which is then inside a short
        // element.
        kinks.retain(|&x| {
            (SHORTEST..=1.0 - SHORTEST).contains(&x)
                && fields
                    .iter()
                    .all(|datum| datum.function.eval(x).is_finite())
        });
        kinks.sort_by(f64::total_cmp);
        kinks.dedup_by(|next, x| *next - *x < SHORTEST);
        let mut kept = scene.listed.clone();
        for &x in &kinks {
            add_node(&mut kept, x, SHORTEST);
        }
        Self {
            fields,
            theta_a: scene.beam.theta_a,
            nodes: scene.mesh.nodes().to_vec(),
            kept,
            kinks,
        }
    }

    /// A scene on whose mesh the data are resolved, and whether that took new nodes.
    ///
    /// # Errors
    /// [`Unreachable::Unresolved`]: no mesh of the search resolves a field.
    pub(super) fn resolve(
        &self,
        scene: Scene,
        wanted: &Wanted,
    ) -> Result<(Scene, bool), Unreachable> {
        let (mut scene, mut elements) = (scene, vec![]);
        let first = scene.mesh.elements();
        loop {
            elements = self.compare(&scene, &elements, wanted)?;
            let Some(coarse) = self.coarse(&elements, wanted)? else {
                break;
            };
            let mut nodes = vec![];
            for (element, is_coarse) in elements.iter().zip(coarse) {
                nodes.push(element.from);
                if is_coarse {
                    nodes.push(0.5 * (element.from + element.to));
                }
            }
            nodes.push(1.0);
            scene = on(&scene, nodes, wanted)?;
        }
        if let CurveRows::Norm(_) = wanted.rows {
            self.refuse_jumps(&elements, wanted.tolerance[0])?;
        }
        let is_finer = scene.mesh.elements() > first;
        if is_finer {
            scene = on(
                &scene,
                neighbours_comparable(scene.mesh.nodes().to_vec()),
                wanted,
            )?;
        }
        Ok((scene, is_finer))
    }

    /// Refuses u_t, φ_t and θ that jump, for the norm: in the first steps the front of a jump J
    /// leaves an error of about J (ζ dt)^¼ in it. That falls so slowly that the difference to
    /// shorter steps is a third of the error.
    fn refuse_jumps(
        &self,
        elements: &[ElementDifferences],
        allowed: f64,
    ) -> Result<(), Unreachable> {
        for (k, datum) in self
            .fields
            .iter()
            .enumerate()
            .filter(|(_, datum)| !datum.counts_slope())
        {
            for element in elements {
                if let Some(x) = datum.jump([element.from, element.to], allowed) {
                    let error = element.largest[k];
                    return Err(Unreachable::Unresolved {
                        field: datum.name,
                        x,
                        error,
                        allowed,
                    });
                }
            }
        }
        Ok(())
    }

    /// The differences on all elements; those that were there before are not computed again.
    fn compare(
        &self,
        scene: &Scene,
        before: &[ElementDifferences],
        wanted: &Wanted,
    ) -> Result<Vec<ElementDifferences>, Unreachable> {
        let simulation = Dg::new(scene.dg_problem(), scene.dg_stepping()).map_err(|error| {
            Unreachable::without_comparison(wanted.tolerance[0], StopReason::of_run(error))
        })?;
        let mut before = before.iter().peekable();
        let mut elements = vec![];
        for x in scene.mesh.nodes().windows(2) {
            while before.next_if(|element| element.to <= x[0]).is_some() {}
            let known = before
                .peek()
                .filter(|element| element.from == x[0] && element.to == x[1]);
            elements.push(match known {
                Some(element) => (*element).clone(),
                None => self.element(
                    &simulation,
                    [x[0], x[1]],
                    matches!(wanted.rows, CurveRows::Norm(_)),
                ),
            });
        }
        Ok(elements)
    }

    /// The differences on one element.
    fn element(
        &self,
        simulation: &Dg,
        [from, to]: [f64; 2],
        is_squared: bool,
    ) -> ElementDifferences {
        let (space, level) = (simulation.space(), simulation.level());
        let (mut integrals, mut largest) = (
            vec![0.0; self.fields.len()],
            vec![0.0_f64; self.fields.len()],
        );
        let first = self.nodes.partition_point(|node| *node <= from);
        let inner = self.nodes[first..]
            .iter()
            .copied()
            .take_while(|node| *node < to);
        let mut left = from;
        for right in inner.chain([to]) {
            let least = POINTS_PER_DEGREE * (space.degree() + 1);
            let share =
                (least as f64 * (right - left) / (to - from)).max((right - left) / NARROWEST);
            let count = share.ceil().max(1.0) as usize;
            let part = (right - left) / count as f64;
            for x in (0..count).map(|k| left + (k as f64 + 0.5) * part) {
                let values = level.values_and_slopes(space, x);
                for (k, datum) in self.fields.iter().enumerate() {
                    let (value, slope) = values[Field::ALL
                        .iter()
                        .position(|field| *field == datum.field)
                        .unwrap_or(0)];
                    let lifting = if datum.field == Field::Theta {
                        self.theta_a * (1.0 - x)
                    } else {
                        0.0
                    };
                    let exact = datum.at(x);
                    let difference =
                        exact - lifting - if datum.counts_slope() { slope } else { value };
                    integrals[k] += part
                        * if is_squared {
                            difference * difference
                        } else {
                            difference.abs()
                        };
                    largest[k] = largest[k].max(exact.abs());
                }
            }
            left = right;
        }
        ElementDifferences {
            from,
            to,
            integrals,
            largest,
        }
    }

    /// Which elements to halve; `None` if every field is resolved.
    fn coarse(
        &self,
        elements: &[ElementDifferences],
        wanted: &Wanted,
    ) -> Result<Option<Vec<bool>>, Unreachable> {
        let mut coarse = vec![false; elements.len()];
        let Wanted {
            rows,
            tolerance: [u, phi, energy],
        } = wanted;
        for (k, datum) in self.fields.iter().enumerate() {
            let largest = elements
                .iter()
                .map(|element| element.largest[k])
                .fold(0.0, f64::max);
            let wanted = match rows {
                CurveRows::Numbers => u.min(*phi).min(energy / largest),
                CurveRows::Tip | CurveRows::Norm(_) => *u,
            };
            let allowed = (SHARE * wanted).max(ROUNDING * largest);
            let sum: f64 = elements.iter().map(|element| element.integrals[k]).sum();
            let [error, share] = match rows {
                CurveRows::Norm(_) => [sum.sqrt(), allowed * allowed],
                _ => [sum, allowed],
            };
            if error <= allowed {
                continue;
            }
            let share = 0.5 * share / elements.len() as f64;
            for (element, is_coarse) in elements.iter().zip(&mut coarse) {
                if element.integrals[k] <= share {
                    continue;
                }
                *is_coarse = true;
                let ElementDifferences { from, to, .. } = *element;
                if to - from < 2.0 * SHORTEST || elements.len() >= MOST_ELEMENTS {
                    return Err(Unreachable::Unresolved {
                        field: datum.name,
                        x: 0.5 * (from + to),
                        error,
                        allowed,
                    });
                }
            }
        }
        Ok(coarse.contains(&true).then_some(coarse))
    }
}

/// The scene on a mesh with these nodes.
fn on(scene: &Scene, nodes: Vec<f64>, wanted: &Wanted) -> Result<Scene, Unreachable> {
    let mesh = Mesh::from_nodes(nodes).map_err(|error| {
        Unreachable::without_comparison(wanted.tolerance[0], StopReason::of_run(error))
    })?;
    Ok(Scene {
        mesh,
        ..scene.clone()
    })
}

/// Adds a node, unless one is closer than `least`.
pub(super) fn add_node(nodes: &mut Vec<f64>, x: f64, least: f64) {
    let index = nodes.partition_point(|node| *node < x);
    let mut neighbours = nodes[index.saturating_sub(1)..].iter().take(2);
    if !neighbours.any(|node| (x - node).abs() < least) {
        nodes.insert(index, x);
    }
}

/// Nodes added until no element is longer than its neighbour by more than [`GRADING`]: a feature
/// widens by viscosity into the elements next to it.
fn neighbours_comparable(mut nodes: Vec<f64>) -> Vec<f64> {
    let mut i = 1;
    while i + 1 < nodes.len() {
        let [left, right] = [nodes[i] - nodes[i - 1], nodes[i + 1] - nodes[i]];
        if right > 1.1 * GRADING * left {
            nodes.insert(i + 1, nodes[i] + GRADING * left);
        } else if left > 1.1 * GRADING * right {
            nodes.insert(i, nodes[i] - GRADING * right);
            i = i.saturating_sub(1).max(1);
            continue;
        }
        i += 1;
    }
    nodes
}
