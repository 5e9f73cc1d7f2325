//! The legend: a sample and a name of every series, band and mark, below the plot in columns.

use plotters::style::text_anchor::HPos;

use super::curve::Curve;
use super::layout::{COLUMN_GAP, EDGE, FOOT, LEGEND_ROW, Layout, SAMPLE, SAMPLE_GAP, WIDTH};
use super::page::{Page, escape_attribute};
use super::pen::{SHADE, TEXT, elide, font, write};
use super::{Chart, cells};

/// A line of the legend.
pub(super) struct Entry<'a> {
    sample: Sample<'a>,
    pub(super) label: &'a str,
}

enum Sample<'a> {
    Line(&'a Curve<'a>),
    Shade,
    Hatch,
}

/// What the chart shows, each name once.
pub(super) fn entries<'a>(chart: &'a Chart, curves: &'a [Curve<'a>]) -> Vec<Entry<'a>> {
    let mut entries: Vec<Entry<'a>> = vec![];
    let mut add = |sample, label: &'a str| {
        if !label.is_empty() && entries.iter().all(|entry| entry.label != label) {
            entries.push(Entry { sample, label });
        }
    };
    if !chart.without_legend {
        for curve in curves {
            add(Sample::Line(curve), &curve.series.label);
        }
    }
    for band in chart.bands.iter().filter(|band| !band.intervals.is_empty()) {
        add(Sample::Shade, &band.label);
    }
    if let Some(cells) = &chart.cells {
        let mut values = chart.table.column(&cells.value).iter();
        if values.any(|value| cells.is_hatched(*value)) {
            add(Sample::Hatch, &cells.missing);
        }
    }
    entries
}

/// Draws it centred on the plot, but always within the page.
pub(super) fn draw(page: &mut Page, chart: &Chart, layout: &Layout, curves: &[Curve<'_>]) {
    let Layout {
        plot,
        columns,
        column_width,
        ..
    } = *layout;
    let width = columns as f64 * column_width - COLUMN_GAP;
    let middle = 0.5 * (plot[0] + plot[2] - width);
    let left = middle.min(WIDTH - width - 0.5 * EDGE).max(0.5 * EDGE);
    for (k, Entry { sample, label }) in entries(chart, curves).into_iter().enumerate() {
        let x = left + (k % columns) as f64 * column_width;
        let y = plot[3] + FOOT + LEGEND_ROW * ((k / columns) as f64 + 0.5);
        let name = format!(" data-entry=\"{}\"", escape_attribute(label));
        page.group(&name, |page| {
            let patch = [x + 6.0, y - 8.0, x + SAMPLE - 2.0, y + 8.0];
            match sample {
                Sample::Line(curve) => draw_line(page, curve, (x, y)),
                Sample::Shade => cells::fill(page, [(patch, SHADE)]),
                Sample::Hatch => cells::hatch(page, &[patch]),
            }
            let text = elide(label, TEXT, column_width - SAMPLE - SAMPLE_GAP);
            let at = (x + SAMPLE + SAMPLE_GAP, y);
            page.layer(|area| write(area, &text, at, font(TEXT), HPos::Left));
        });
    }
}

/// A piece of a curve's line, with its marker.
fn draw_line(page: &mut Page, curve: &Curve<'_>, (x, y): (f64, f64)) {
    let style = curve.style;
    let ends = vec![(x, y), (x + SAMPLE, y)];
    page.line(&[ends], style.colour, curve.series.width, style.dashes);
    let mark = curve.sample_mark();
    page.layer(|area| style.mark(area, (x + 0.5 * SAMPLE, y), mark));
}
