//! Reads a picture back: where its marks stand, against numbers placed on its axes.

use roxmltree::Node;

use super::laws::number;

/// A series as it is drawn.
pub(crate) struct DrawnSeries {
    /// Its name in the legend.
    pub(crate) label: String,
    /// The columns of the table that it names.
    pub(crate) columns: [String; 2],
    /// Where its markers are, or the corners of its lines without any; in tenths of a px.
    pub(crate) marks: Vec<[f64; 2]>,
}

/// Pairs of numbers `x,y`.
pub(crate) fn pairs(text: &str) -> Vec<[f64; 2]> {
    let pair = |pair: &str| {
        let (x, y) = pair.split_once(',')?;
        Some([x.parse().ok()?, y.parse().ok()?])
    };
    text.split_whitespace().filter_map(pair).collect()
}

/// The middle of a marker: a disc, or a star whose corners surround it evenly.
fn middle(marker: Node<'_, '_>) -> [f64; 2] {
    if marker.has_tag_name("circle") {
        return ["cx", "cy"].map(|name| number(marker, name));
    }
    mean(&pairs(marker.attribute("points").unwrap_or_default()))
}

pub(crate) fn mean(corners: &[[f64; 2]]) -> [f64; 2] {
    let sum = |k: usize| corners.iter().map(|corner| corner[k]).sum::<f64>();
    [0, 1].map(|k| sum(k) / corners.len() as f64)
}

/// The series of a picture.
pub(crate) fn series(picture: Node<'_, '_>) -> Vec<DrawnSeries> {
    let groups = picture
        .descendants()
        .filter(|node| node.has_attribute("data-columns"));
    let one = |group: Node<'_, '_>| {
        let named = |name| group.attribute(name).unwrap_or_default();
        let (x, y) = named("data-columns").split_once('|').expect("two columns");
        let markers = group
            .descendants()
            .filter(|node| node.has_tag_name("circle") || node.has_tag_name("polygon"));
        let mut marks: Vec<_> = markers.map(middle).collect();
        if marks.is_empty() {
            let lines = group
                .descendants()
                .filter(|node| node.has_tag_name("polyline"));
            marks = lines
                .flat_map(|line| pairs(line.attribute("points").unwrap_or_default()))
                .collect();
        }
        DrawnSeries {
            label: named("data-series").to_owned(),
            columns: [x, y].map(str::to_owned),
            marks,
        }
    };
    groups.map(one).collect()
}

/// Where a value stands on an axis of a picture, in tenths of a px.
///
/// * `axis`: 0 for x, 1 for y.
pub(crate) fn place(picture: Node<'_, '_>, axis: usize, value: f64) -> f64 {
    let words = |name| -> Vec<&str> {
        picture
            .attribute(name)
            .unwrap_or_default()
            .split(' ')
            .collect()
    };
    let read = |text: &str| text.parse::<f64>().expect("a number");
    let scale = words(["data-x", "data-y"][axis]);
    let plot = words("data-plot");
    let value = if scale[0] == "log" {
        value.log10()
    } else {
        value
    };
    let fraction = (value - read(scale[1])) / (read(scale[2]) - read(scale[1]));
    let [from, to] = if axis == 0 {
        [plot[0], plot[2]]
    } else {
        [plot[3], plot[1]]
    }
    .map(read);
    from + fraction * (to - from)
}
