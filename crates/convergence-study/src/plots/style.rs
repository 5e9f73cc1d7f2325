//! The house style of all figures: sizes, colours, dashes, widths of texts.

use plotters::style::RGBColor;

/// Page width in px. Figures are read at full and at half width, and the text sizes below allow for
/// that.
pub const WIDTH: f64 = 900.0;
/// Room between the edge of the page and everything on it, in px.
pub(crate) const EDGE: f64 = 16.0;
/// Height of the plot area in px; the page grows with its legend, the plot does not shrink.
pub(crate) const PLOT_HEIGHT: f64 = 430.0;

/// Helvetica and its metric twins first: the estimates of [`text_width`] use the widest, DejaVu
/// Sans.
pub(crate) const FONT: &str = "Helvetica, Arial, DejaVu Sans, sans-serif";
/// Text size of titles, in px.
pub const TITLE_SIZE: f64 = 22.0;
/// Text size of axis labels, in px.
pub const LABEL_SIZE: f64 = 20.0;
/// Text size of tick labels, legends and texts in the plot, in px.
pub const TICK_SIZE: f64 = 18.0;
/// Text size of notes under the plot, in px.
pub(crate) const NOTE_SIZE: f64 = 16.0;

/// Texts, axes and outlines.
pub const INK: RGBColor = RGBColor(34, 34, 34);
/// The page.
pub(crate) const WHITE: RGBColor = RGBColor(255, 255, 255);
/// Guides, notes and hatches.
pub const MUTED: RGBColor = RGBColor(96, 96, 96);
/// Grid lines at labelled ticks.
pub const GRID: RGBColor = RGBColor(214, 214, 214);
/// Grid lines at ticks without label.
pub const MINOR_GRID: RGBColor = RGBColor(238, 238, 238);
/// Shaded intervals and regions: light enough for the grid's darker lines to stay visible on it.
pub const SHADE: RGBColor = RGBColor(228, 233, 240);
/// Cells without a value.
pub(crate) const NO_VALUE: RGBColor = RGBColor(200, 200, 200);

/// Width of axes and ticks, in px.
pub const THIN: f64 = 1.2;
/// Width of curves, in px.
pub(crate) const LINE: f64 = 2.2;

/// Lengths of dashes and gaps in turn, in px; without any the line is solid. The patterns are
/// distinct in black and white.
pub(crate) type Dash = &'static [f64];
/// No gaps.
pub const SOLID: Dash = &[];
/// Long dashes.
pub const LONG: Dash = &[12.0, 5.0];
/// Short dashes.
pub const SHORT: Dash = &[6.0, 4.0];
/// Dots.
pub const DOTTED: Dash = &[2.2, 3.6];
/// Dashes and dots in turn.
pub(crate) const MIXED: Dash = &[11.0, 4.0, 2.5, 4.0];

/// Width of a text in px, estimated generously: exact widths would need font files.
pub fn text_width(text: &str, size: f64) -> f64 {
    let em: f64 = text.chars().map(glyph_width).sum();
    em * size
}

/// A text of this size cut to fit a width, both in px, ending with an ellipsis if it was cut.
pub fn elide(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut kept = String::new();
    for c in text.chars() {
        if text_width(&kept, size) + text_width("m…", size) > width {
            break;
        }
        kept.push(c);
    }
    kept + "…"
}

/// Advance of one glyph in em, after DejaVu Sans, rounded up.
fn glyph_width(c: char) -> f64 {
    match c {
        // A combining circumflex stands on the letter before it.
        '\u{302}' => 0.0,
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | 'I' | ' ' => 0.33,
        '‖' => 0.5,
        'f' | 't' | 'r' | '(' | ')' | '-' | '/' | '[' | ']' => 0.42,
        '⁰' | '¹' | '²' | '³' | '⁴'..='⁹' | '₀'..='₉' | '⁻' | 'ₕ' | 'ₓ' | 'ₜ' | 'ₙ' => {
            0.43
        }
        'm' | 'w' | 'M' | 'W' | '%' => 0.98,
        'A'..='Z' | '=' | '+' | '−' | '×' | '<' | '>' | '≥' | '≤' => 0.8,
        _ => 0.64,
    }
}
