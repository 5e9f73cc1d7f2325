//! Names and values in the elements of a picture, and the texts that XML accepts.
//!
//! The picture contains names and values for a page that reads them; a viewer alone does not show
//! them.
//!
//! | attribute | on | holds |
//! | --- | --- | --- |
//! | `data-plot` | the picture | left, top, right, bottom of the plot on the page's grid |
//! | `data-x`, `data-y` | the picture | `linear` or `log`, and the ends of the range, decimal logarithms for `log` |
//! | `data-x-label`, `data-y-label` | the picture | what the axes measure |
//! | `data-series` | the marks of a series | its name |
//! | `data-points` | likewise, for data | `x,y` of each point; empty for long series, whose lines give as much detail |
//! | `data-entry` | an entry of the legend | the name of the series |

use super::Scale;
use super::geometry::{Rect, grid};
use super::ruler::Ruler;
use std::fmt::Write;

/// Text that XML accepts: markup escaped, control characters blanked.
pub(crate) fn escape(text: &str) -> String {
    printable(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

/// Text for an attribute in double quotes.
pub(crate) fn escape_attribute(text: &str) -> String {
    escape(text).replace('"', "&quot;")
}

pub(super) fn printable(text: &str) -> String {
    text.chars()
        .map(|c| {
            if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') {
                ' '
            } else {
                c
            }
        })
        .collect()
}

/// A series with more points than this is read off its line, to the tenth of a pixel: its values
/// would cost too many bytes.
const MOST_POINTS: usize = 200;

/// The attributes of a picture with axes.
pub(super) fn axes(plot: &Rect, axes: [(&str, &Ruler); 2]) -> String {
    let [left, top, right, bottom] = [plot.left, plot.top, plot.right, plot.bottom].map(grid);
    let mut attributes = format!(" data-plot=\"{left} {top} {right} {bottom}\"");
    for (name, (label, ruler)) in ["x", "y"].into_iter().zip(axes) {
        let scale = if ruler.scale == Scale::Log {
            "log"
        } else {
            "linear"
        };
        let _ = write!(
            attributes,
            " data-{name}=\"{scale} {} {}\"",
            ruler.lo, ruler.hi
        );
        let _ = write!(
            attributes,
            " data-{name}-label=\"{}\"",
            escape_attribute(label)
        );
    }
    attributes
}

/// The attributes of the marks of a series; `points` if they are data.
pub(super) fn series(name: &str, points: Option<&[(f64, f64)]>) -> String {
    let mut attributes = format!(" data-series=\"{}\"", escape_attribute(name));
    if let Some(points) = points {
        let mut pairs: Vec<String> = points
            .iter()
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .take(MOST_POINTS + 1)
            .map(|&(x, y)| format!("{:e},{:e}", rounded(x), rounded(y)))
            .collect();
        if pairs.len() > MOST_POINTS {
            pairs.clear();
        }
        let _ = write!(attributes, " data-points=\"{}\"", pairs.join(" "));
    }
    attributes
}

/// The attributes of a legend's entry.
pub(super) fn entry(name: &str) -> String {
    format!(" data-entry=\"{}\"", escape_attribute(name))
}

/// To five digits, so that the last bits of a result, which vary between machines, do not show.
fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}
