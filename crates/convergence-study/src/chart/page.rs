//! The document: layers of shapes, groups with names, and the texts that XML accepts.

use plotters::prelude::*;

use super::Chart;
use super::layout::{Layout, TITLE_ROW, WIDTH};
use super::pen::{Area, Dashes, FONT, Point, certain, line, tenths};
use crate::text::number::significant;
use convergence_judge::verdict::Verdict;

/// A document being drawn, layer upon layer.
pub(super) struct Page {
    body: String,
    size: (u32, u32),
}

impl Page {
    pub(super) fn new(height: f64) -> Self {
        Self {
            body: String::new(),
            size: (tenths(WIDTH) as u32, tenths(height) as u32),
        }
    }

    /// Adds elements as they are.
    pub(super) fn raw(&mut self, elements: &str) {
        self.body += elements;
    }

    /// Puts what is drawn into a group with these attributes, each with a blank in front.
    pub(super) fn group(&mut self, attributes: &str, draw: impl FnOnce(&mut Self)) {
        self.body += &format!("<g{attributes}>\n");
        draw(self);
        self.body += "</g>\n";
    }

    /// Adds what is drawn.
    pub(super) fn layer(&mut self, draw: impl FnOnce(&Area<'_>)) {
        let mut text = String::new();
        {
            let area = SVGBackend::with_string(&mut text, self.size).into_drawing_area();
            draw(&area);
            certain(area.present());
        }
        // Without a document around every layer, and without attributes that all have: a third of
        // the bytes.
        let family = format!(" font-family=\"{FONT}\"");
        for line in text.lines() {
            if line.starts_with("<svg ") || line == "</svg>" {
                continue;
            }
            if line.starts_with('<') {
                let line = line.replace(" opacity=\"1\"", "").replace(&family, "");
                self.body += &line.replace(" \"/>", "\"/>");
            } else {
                // Texts stand on lines of their own, and do not start with a tag.
                self.body += line;
            }
            self.body.push('\n');
        }
    }

    /// Adds the parts of a line.
    pub(super) fn line(
        &mut self,
        parts: &[Vec<Point>],
        colour: RGBColor,
        width: f64,
        dashes: Dashes,
    ) {
        if width == 0.0 || parts.is_empty() {
            return;
        }
        let dashed = match dashes {
            "" => String::new(),
            _ => format!(" stroke-dasharray=\"{dashes}\""),
        };
        self.group(&dashed, |page| {
            page.layer(|area| {
                for part in parts {
                    line(area, part, colour, width);
                }
            });
        });
    }

    /// The document, with what is needed to read its lines back.
    pub(super) fn finish(self, chart: &Chart, layout: &Layout) -> String {
        let (width, height) = self.size;
        let mut axes = String::new();
        // Rows have no scale.
        if chart.y.rows.is_empty() {
            let plot = layout.plot.map(|px| tenths(px).to_string()).join(" ");
            axes = format!(" data-plot=\"{plot}\"");
            for (name, axis, ruler) in [("x", &chart.x, &layout.x), ("y", &chart.y, &layout.y)] {
                let scale = if ruler.is_log { "log" } else { "linear" };
                let label = escape_attribute(&axis.label);
                // The last bits of a result vary between machines.
                let [low, high] = [ruler.low, ruler.high].map(|end| significant(end, 9));
                axes +=
                    &format!(" data-{name}=\"{scale} {low} {high}\" data-{name}-label=\"{label}\"");
            }
        }
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{}\" viewBox=\"0 0 {width} {height}\" \
             role=\"img\" font-family=\"{FONT}\" stroke-linejoin=\"round\"{axes}>\n<title>{}</title>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            layout.height,
            escape(&chart.heading()),
            self.body
        )
    }
}

impl Chart {
    /// Draws charts one below the other, in one document, their plots beginning at the same place.
    ///
    /// * `description`: of the whole, as read out by screen readers.
    pub fn panels(description: &str, charts: &[Self]) -> String {
        let lefts = charts.iter().map(|chart| chart.drawn(0.0).1.plot[0]);
        let left = lefts.fold(0.0, f64::max);
        let mut body = format!("<title>{}</title>\n", escape(description));
        let mut top = 0.0;
        for chart in charts {
            let (panel, layout) = chart.drawn(left);
            body += &panel.replacen("<svg ", &format!("<svg y=\"{top}\" "), 1);
            top += layout.height;
        }
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{top}\" viewBox=\"0 0 {WIDTH} {top}\" \
         role=\"group\">\n{body}</svg>\n"
        )
    }
}

/// The end of the opening of a title.
pub(super) const TITLE_MARK: &str = " data-title=\"\">";

/// A picture of this room whose titles begin with a verdict, such as "fail: The energy falls": a
/// title says what a study claims, and the study may not have found it. Any other text as it is.
pub(crate) fn titled_by_verdict(svg: &str, verdict: Verdict) -> String {
    svg.replace(TITLE_MARK, &format!("{TITLE_MARK}{verdict}: "))
}

/// A picture of this room without its titles, for papers, where captions take their place; any
/// other text as it is. The first title leaves no blank row at the top.
pub(crate) fn without_title(svg: &str) -> String {
    let height = svg.split_once(" height=\"");
    let height = height.and_then(|(_, rest)| rest.split('"').next()?.parse::<f64>().ok());
    let Some(height) = height.filter(|_| svg.contains(TITLE_MARK)) else {
        return svg.to_owned();
    };
    let rest = height - TITLE_ROW;
    let [old, new] = [height, rest].map(|height| format!(" height=\"{height}\""));
    let mut kept = svg.replacen(&old, &new, 1);
    // Panels are measured in px, a chart in tenths.
    for unit in [1.0, 10.0] {
        let [width, top, height, rest] = [WIDTH, TITLE_ROW, height, rest].map(|px| unit * px);
        let whole = format!("viewBox=\"0 0 {width} {height}\"");
        kept = kept.replacen(&whole, &format!("viewBox=\"0 {top} {width} {rest}\""), 1);
    }
    let lines = kept.lines().filter(|line| !line.contains(TITLE_MARK));
    lines.map(|line| format!("{line}\n")).collect()
}

/// Text that XML accepts: markup escaped, control characters blanked.
pub(super) fn escape(text: &str) -> String {
    let text = printable(text).replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

/// Text for an attribute in double quotes.
pub(super) fn escape_attribute(text: &str) -> String {
    escape(text).replace('"', "&quot;")
}

pub(super) fn printable(text: &str) -> String {
    let is_blank = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    text.replace(is_blank, " ")
}
