//! How the k-th series of a figure is told from the others.

use super::marker::Marker;
use super::style::Dash;
use plotters::style::RGBColor;

/// Okabe and Ito's palette, told apart by all common kinds of colour vision; its yellow is too pale on white.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(170, 68, 153),
    RGBColor(230, 159, 0),
    RGBColor(34, 34, 34),
    RGBColor(86, 180, 233),
];

/// One more than the colours, so that the 8th series differs from the 1st by its marker too.
const MARKERS: [Marker; 8] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
    Marker::Inverted,
    Marker::Cross,
    Marker::Plus,
    Marker::Star,
];

const DASHES: [Dash; 5] = [Dash::Solid, Dash::Long, Dash::Dotted, Dash::Mixed, Dash::Short];

/// What sets one series apart: each of the three is enough by itself for a handful of series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Of lines and markers.
    pub colour: RGBColor,
    /// Of its points.
    pub marker: Marker,
    /// Of its line.
    pub dash: Dash,
}

/// Look of the k-th series.
pub fn look(k: usize) -> Look {
    Look { colour: COLOURS[k % COLOURS.len()], marker: MARKERS[k % MARKERS.len()], dash: DASHES[k % DASHES.len()] }
}
