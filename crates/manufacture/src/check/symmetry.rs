//! Fields that are unchanged or reversed by a reflection, an exchange or a shift: superconvergence
//! for free.

use super::{Finding, Sampled, finding, is_same};
use crate::arithmetic::NodeId;
use crate::arithmetic::tape::SizedValue;
use crate::derive::{DerivedQuantity, Role};
use crate::model::{Model, TensorRows};

/// A map of the box onto itself.
#[derive(Debug, Clone, Copy)]
enum Map {
    Reflect(usize),
    Exchange(usize, usize),
    /// By half the interval, from its end to its beginning.
    Shift(usize),
}

impl Map {
    fn all(model: &Model) -> Vec<Map> {
        let count = model.problem.coordinates.len();
        let intervals = &model.problem.intervals;
        let mut maps = vec![];
        for first in 0..count {
            maps.push(Map::Reflect(first));
            maps.push(Map::Shift(first));
            for second in first + 1..count {
                if intervals[first] == intervals[second] {
                    maps.push(Map::Exchange(first, second));
                }
            }
        }
        maps
    }

    fn apply(self, point: &[f64], intervals: &[[f64; 2]]) -> Vec<f64> {
        let mut image = point.to_vec();
        match self {
            Map::Reflect(axis) => {
                image[axis] = intervals[axis][0] + intervals[axis][1] - point[axis];
            }
            Map::Exchange(first, second) => image.swap(first, second),
            Map::Shift(axis) => {
                let [low, high] = intervals[axis];
                let half = 0.5 * (high - low);
                let is_upper = point[axis] >= low + half;
                image[axis] += if is_upper { -half } else { half };
            }
        }
        image
    }

    /// The coordinates that change.
    fn axes(self) -> Vec<usize> {
        match self {
            Map::Reflect(axis) | Map::Shift(axis) => vec![axis],
            Map::Exchange(first, second) => vec![first, second],
        }
    }

    fn words(self, names: &[String]) -> String {
        match self {
            Map::Reflect(axis) => format!("reflecting {}", names[axis]),
            Map::Exchange(first, second) => {
                format!("exchanging {} and {}", names[first], names[second])
            }
            Map::Shift(axis) => format!("shifting {} by half its interval", names[axis]),
        }
    }
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
        let rows = TensorRows::new(&model.graph, std::iter::once(&field.tensor));
        for map in Map::all(model) {
            if !map.axes().iter().all(|axis| depends(model, field, *axis)) {
                continue;
            }
            let mut pairs = vec![];
            for (point, values) in sampled.over(index) {
                let image = map.apply(point, &model.problem.intervals);
                pairs.push((values.to_vec(), rows.at(&image).tensors.remove(0)));
            }
            let mut components = 0..field.tensor.parts.len();
            if components.all(|component| is_unchanged(&pairs, component)) {
                let map = map.words(&model.problem.coordinates);
                let text = format!(
                    "unchanged or reversed by {map}: errors may cancel, and a mistake with that symmetry is not noticed"
                );
                findings.push(finding("symmetric", &field.key, text, None));
            }
        }
    }
    findings
}
