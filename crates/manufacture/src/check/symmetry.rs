//! Fields that are unchanged or reversed by a reflection, an exchange or a shift: superconvergence
//! for free.

use super::{Finding, Sampled, finding, is_same};
use crate::arithmetic::NodeId;
use crate::arithmetic::tape::SizedValue;
use crate::derive::{DerivedQuantity, Role};
use crate::model::Model;

/// Moves a point to its image.
type PointMap = Box<dyn Fn(&mut [f64])>;

/// A map of the box onto itself.
struct Map {
    words: String,
    /// The coordinates that change.
    axes: Vec<usize>,
    apply: PointMap,
}

fn maps(model: &Model) -> Vec<Map> {
    let intervals = &model.problem.intervals;
    let names = model.problem.coordinates.iter().enumerate();
    let mut maps = vec![];
    for (axis, name) in names.clone() {
        let [low, high] = intervals[axis];
        maps.push(Map {
            words: format!("reflecting {name}"),
            axes: vec![axis],
            apply: Box::new(move |point| point[axis] = low + high - point[axis]),
        });
        let half = 0.5 * (high - low);
        maps.push(Map {
            words: format!("shifting {name} by half its interval"),
            axes: vec![axis],
            // From its end to its beginning.
            apply: Box::new(move |point| {
                let is_upper = point[axis] >= low + half;
                point[axis] += if is_upper { -half } else { half };
            }),
        });
        for (other, second) in names.clone().skip(axis + 1) {
            if intervals[axis] == intervals[other] {
                maps.push(Map {
                    words: format!("exchanging {name} and {second}"),
                    axes: vec![axis, other],
                    apply: Box::new(move |point| point.swap(axis, other)),
                });
            }
        }
    }
    maps
}

/// Whether a component is the same at all points and images, or reversed at all.
fn is_unchanged(pairs: &[(Vec<SizedValue>, Vec<SizedValue>)], component: usize) -> bool {
    [1.0, -1.0].into_iter().any(|sign| {
        pairs.iter().all(|(value, image)| {
            let image = SizedValue {
                value: sign * image[component].value,
                ..image[component]
            };
            is_same(&value[component], &image)
        })
    })
}

fn depends(model: &Model, field: &DerivedQuantity<NodeId>, axis: usize) -> bool {
    let mut parts = field.tensor.parts.iter();
    parts.any(|part| model.graph.depends_on(*part, axis))
}

pub(super) fn symmetric(model: &Model, sampled: &Sampled<'_>) -> Vec<Finding> {
    let mut findings = vec![];
    let fields = sampled.quantities.iter().enumerate();
    for (index, field) in fields.filter(|entry| entry.1.role == Role::Exact) {
        let rows = model.rows([field]);
        for Map { words, axes, apply } in maps(model) {
            if !axes.iter().all(|axis| depends(model, field, *axis)) {
                continue;
            }
            let mut pairs = vec![];
            for (point, values) in sampled.over(index) {
                let mut image = point.to_vec();
                apply(&mut image);
                pairs.push((values.to_vec(), rows.at(&image).tensors.remove(0)));
            }
            let mut components = 0..field.tensor.parts.len();
            if components.all(|component| is_unchanged(&pairs, component)) {
                let text = format!(
                    "unchanged or reversed by {words}: errors may cancel, and a mistake with that symmetry is not noticed"
                );
                findings.push(finding("symmetric", &field.place.key, text, None));
            }
        }
    }
    findings
}
