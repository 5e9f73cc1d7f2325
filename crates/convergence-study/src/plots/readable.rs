//! Names and values inside a picture, for a page that reads them: a viewer alone shows nothing of it.
//!
//! | attribute | on | holds |
//! | --- | --- | --- |
//! | `data-plot` | the picture | left, top, right, bottom of the plot on the page's grid |
//! | `data-x`, `data-y` | the picture | `linear` or `log`, and the ends of the range, decimal logarithms for `log` |
//! | `data-x-label`, `data-y-label` | the picture | what the axes measure |
//! | `data-series` | what is drawn of a series | its name |
//! | `data-points` | likewise, for data | `x,y` of each point; empty for long series, whose lines tell as much |
//! | `data-entry` | an entry of the legend | the name of the series |

use super::canvas::grid;
use super::rect::Rect;
use super::ruler::Ruler;
use super::{Scale, canvas};
use std::fmt::Write;

/// A series with more points than this is read off its line, to the tenth of a pixel: values would cost more than they
/// tell.
const MOST_POINTS: usize = 200;

/// An axis of a picture: its label and its range.
pub(super) type LabelledRuler<'p> = (&'p str, &'p Ruler);

/// The attributes of a picture with axes.
pub(super) fn axes(plot: &Rect, x: LabelledRuler<'_>, y: LabelledRuler<'_>) -> String {
    let [left, top, right, bottom] = [plot.left, plot.top, plot.right, plot.bottom].map(grid);
    let mut attributes = format!(" data-plot=\"{left} {top} {right} {bottom}\"");
    for (name, (label, ruler)) in [("x", x), ("y", y)] {
        let scale = if ruler.scale == Scale::Log { "log" } else { "linear" };
        let _ = write!(attributes, " data-{name}=\"{scale} {} {}\"", ruler.lo, ruler.hi);
        let _ = write!(attributes, " data-{name}-label=\"{}\"", canvas::escape_attribute(label));
    }
    attributes
}

/// The attributes of what is drawn of a series; `points` where they are data.
pub(super) fn series(name: &str, points: Option<&[(f64, f64)]>) -> String {
    let mut attributes = format!(" data-series=\"{}\"", canvas::escape_attribute(name));
    if let Some(points) = points {
        let finite = || points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
        let listed = if finite().count() > MOST_POINTS { 0 } else { MOST_POINTS };
        let pairs: Vec<String> =
            finite().take(listed).map(|&(x, y)| format!("{:e},{:e}", rounded(x), rounded(y))).collect();
        let _ = write!(attributes, " data-points=\"{}\"", pairs.join(" "));
    }
    attributes
}

/// The attributes of a legend's entry.
pub(super) fn entry(name: &str) -> String {
    format!(" data-entry=\"{}\"", canvas::escape_attribute(name))
}

/// To five digits, so that the last bits of a result, which vary between machines, are not to be seen.
fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}
