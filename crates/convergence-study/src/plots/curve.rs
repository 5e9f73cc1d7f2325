//! A curve of a figure, and the parts that it is drawn in.

use super::look::{Look, Marks, look};
use super::{Series, style};
use crate::judge::verdict::PowerLaw;

/// A curve and how to draw it.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its entry in the legend; of several curves with the same name the first makes it.
    pub name: String,
    /// `(x, y)` in data coordinates, in drawing order.
    pub points: Vec<(f64, f64)>,
    /// Colour, dashes and marker.
    pub look: Look,
    /// Line width in px; 0 for markers alone.
    pub width: f64,
    /// Drawn from end to end, solid, instead of the line through the points.
    pub fit: Option<PowerLaw>,
    /// How the points are marked.
    pub marks: Marks,
    /// Whether the points are data: only those set the range and are counted when left out.
    pub is_data: bool,
}

impl Curve {
    /// The k-th series as a line, with an entry of its own.
    pub fn line(k: usize, series: &Series) -> Self {
        Self {
            name: series.label.clone(),
            points: series.points.clone(),
            look: look(k),
            width: style::LINE,
            fit: None,
            marks: Marks::None,
            is_data: true,
        }
    }

    /// The parts to draw: a fitted line before the markers, which alone are data.
    pub(super) fn parts(&self) -> Vec<Self> {
        let Some(fit) = self.fit else {
            return vec![self.clone()];
        };
        let xs = self
            .points
            .iter()
            .map(|p| p.0)
            .filter(|x| x.is_finite() && *x > 0.0);
        let first = xs.clone().fold(f64::INFINITY, f64::min);
        let last = xs.fold(0.0, f64::max);
        let points = [first, last].map(|x| (x, fit.error_at(x))).to_vec();
        let line = Self {
            points,
            look: self.solid(),
            marks: Marks::None,
            is_data: false,
            fit: None,
            ..self.clone()
        };
        vec![
            line,
            Self {
                width: 0.0,
                fit: None,
                ..self.clone()
            },
        ]
    }

    pub(super) fn solid(&self) -> Look {
        Look {
            dash: style::SOLID,
            ..self.look
        }
    }
}
