//! Several figures on one page, one below the other.

use std::fmt::Write;

use super::attributes::escape;
use super::style;
use super::xy::Xy;

/// Draws figures one below the other, in one document.
///
/// Each keeps its own title, axes, legend and notes, and its names and values for a page that reads
/// them.
///
/// * `description`: of the whole, as read out by screen readers.
pub fn panels(description: &str, figures: &[Xy]) -> String {
    let mut body = String::new();
    let mut top = 0.0;
    for figure in figures {
        let page = figure.drawn();
        let height = page.canvas.height();
        let placed = format!("<svg y=\"{top}\" ");
        body.push_str(&page.finish().replacen("<svg ", &placed, 1));
        top += height;
    }
    let width = style::WIDTH;
    let mut document = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{top}\" viewBox=\"0 0 {width} {top}\" role=\"group\">\n"
    );
    // Writing to a string cannot fail.
    let _ = writeln!(document, "<title>{}</title>", escape(description));
    document + &body + "</svg>\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::{Axis, Series, history};

    #[test]
    fn each_panel_lies_below_the_one_before() {
        let panel = |name: &str| {
            let series = [Series::new(name, [(0.0, 1.0), (1.0, 2.0)])];
            history(Axis::linear("y"), &series).titled(name)
        };
        let [one, other] = ["one", "other"].map(panel);
        let height = one.drawn().canvas.height();
        let document = panels("both & more", &[one, other]);
        assert_eq!(document.matches("data-plot=").count(), 2);
        assert!(document.contains("<svg y=\"0\" "), "{document}");
        assert!(document.contains(&format!("<svg y=\"{height}\" ")));
        assert!(document.contains(&format!("height=\"{}\"", 2.0 * height)));
        assert!(document.contains("<title>both &amp; more</title>"));
    }
}
