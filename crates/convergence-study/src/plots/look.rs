//! Colour, marker and dashes of the k-th series of a figure.

use super::marker::Marker;
use super::style::Dash;
use plotters::style::RGBColor;

/// Okabe and Ito's palette, distinct for all common kinds of colour vision; for its yellow, too pale on white, Tol's olive.
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(170, 68, 153),
    RGBColor(230, 159, 0),
    RGBColor(34, 34, 34),
    RGBColor(86, 180, 233),
    RGBColor(128, 128, 38),
];

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

/// Look of the k-th series. The first 64 differ: from the 9th on, colours return with the next marker.
pub fn look(k: usize) -> Look {
    let marker = (k + k / COLOURS.len()) % MARKERS.len();
    Look { colour: COLOURS[k % COLOURS.len()], marker: MARKERS[marker], dash: DASHES[k % DASHES.len()] }
}
