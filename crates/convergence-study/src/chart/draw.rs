//! From a chart to its document: what is below the curves, the curves, and what is around them.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::curve::Curve;
use super::glyphs::text_width;
use super::layout::{EDGE, Layout, NOTE_ROW, WIDTH};
use super::page::{Page, TITLE_MARK, escape};
use super::pen::{
    Area, GRID, INK, LABEL, MINOR_GRID, MUTED, SHADE, TEXT, THIN, TITLE, certain, elide, font,
    frame, line, tenths, write,
};
use super::triangles::triangles;
use super::{Chart, Guide, LINE, Series, cells, legend, rows};

/// From the plot down to the labels of the axis, and to its name.
const LABELS: f64 = 56.0;
const NAME: f64 = 48.0;
/// How far an axis may be extended for triangles, as a fraction, and in how many steps.
const EXTENSION: f64 = 0.06;
const EXTENSIONS: i32 = 12;
/// Labels of guides closer than this would overlap.
const APART: f64 = 21.0;
/// A thin line around cells.
const RIM: f64 = 3.0;

impl Chart {
    /// The chart as a document.
    pub fn svg(&self) -> String {
        self.drawn(0.0).0
    }

    /// The width of a series' line, measured on the vertical axis; in decades if that is
    /// logarithmic.
    pub fn line_width(&self) -> f64 {
        let Layout { y, plot, .. } = Layout::new(self, &Curve::all(self), 0.0, 0.0);
        (y.high - y.low) * LINE / (plot[3] - plot[1])
    }

    /// The title, or what the axes measure, without units.
    pub(super) fn heading(&self) -> String {
        if !self.title.is_empty() {
            return self.title.clone();
        }
        let [y, x] =
            [&self.y, &self.x].map(|axis| axis.label.split(" (").next().unwrap_or_default());
        format!("{y} over {x}")
    }

    /// The document and its layout.
    ///
    /// * `left`: its plot begins here, or further right.
    pub(super) fn drawn(&self, left: f64) -> (String, Layout) {
        let mut curves = Curve::all(self);
        let orders = self.orders(&curves);
        let mut layout = Layout::new(self, &curves, left, 0.0);
        let mut slopes = triangles(&orders, self, &layout, &curves);
        for step in 1..=EXTENSIONS {
            if slopes.is_none() {
                layout = Layout::new(self, &curves, left, EXTENSION * f64::from(step));
                slopes = triangles(&orders, self, &layout, &curves);
            }
        }
        for k in 0..curves.len() {
            if curves[k + 1..]
                .iter()
                .any(|later| later.hides(&curves[k], &layout))
            {
                curves[k].grow();
            }
        }
        let mut page = Page::new(layout.height);
        self.draw_ground(&mut page, &layout);
        self.draw_curves(&mut page, &layout, &curves);
        page.layer(|area| {
            rows::draw(area, self, &layout);
            slopes
                .iter()
                .flatten()
                .for_each(|triangle| triangle.draw(area));
            frame(area, layout.plot);
        });
        self.draw_texts(&mut page, &layout);
        legend::draw(&mut page, self, &layout, &curves);
        (page.finish(self, &layout), layout)
    }

    /// The orders with a triangle, ascending; a slope needs two logarithmic axes and a line.
    fn orders(&self, curves: &[Curve<'_>]) -> Vec<f64> {
        let of_series = self.series.iter().filter_map(|series| series.order);
        let mut orders: Vec<f64> = of_series.chain(self.slopes.iter().copied()).collect();
        let has_slopes =
            self.x.is_log && self.y.is_log && curves.iter().any(|curve| curve.points.len() > 1);
        orders.retain(|order| has_slopes && *order > 0.0 && order.is_finite());
        orders.sort_by(f64::total_cmp);
        orders.dedup();
        orders
    }

    /// Bands, cells, grid, ticks and guides.
    fn draw_ground(&self, page: &mut Page, layout: &Layout) {
        let [left, top, right, bottom] = layout.plot;
        let bands = self
            .bands
            .iter()
            .flat_map(|band| merged(&band.intervals, layout));
        // An interval shorter than a pixel leaves a trace.
        cells::fill(
            page,
            bands.map(|[from, to]| ([from, top, to.max(from + 1.0), bottom], SHADE)),
        );
        if let Some(cells) = &self.cells {
            cells.draw(self, page, layout);
        }
        page.layer(|area| certain(self.draw_mesh(area, layout)));
        let lines = self.guides.iter().map(|guide| {
            let y = layout.px((f64::NAN, guide.value)).1;
            vec![(left, y), (right, y)]
        });
        let lines: Vec<_> = lines.filter(|line| line[0].1.is_finite()).collect();
        page.line(&lines, MUTED, 1.4, Series::SHORT);
    }

    /// Grid, ticks and labels of the axes.
    fn draw_mesh(
        &self,
        area: &Area<'_>,
        layout: &Layout,
    ) -> Result<(), Box<dyn std::error::Error>> {
        let [left, top, right, bottom] = layout.plot;
        let mut chart = ChartBuilder::on(area)
            .margin_top(tenths(top))
            .margin_left(tenths(EDGE))
            .margin_right(tenths(WIDTH - right))
            .margin_bottom(tenths(layout.height - bottom - LABELS))
            .y_label_area_size(tenths(left - EDGE))
            .x_label_area_size(tenths(LABELS))
            .build_cartesian_2d(layout.x.clone(), layout.y.clone())?;
        let mut mesh = chart.configure_mesh();
        if self.cells.is_some() {
            mesh.disable_mesh();
        }
        mesh.light_line_style(MINOR_GRID.stroke_width(10))
            .bold_line_style(GRID.stroke_width(10))
            .axis_style(INK.stroke_width(12))
            .set_all_tick_mark_size(60)
            .label_style(font(TEXT))
            .axis_desc_style(font(LABEL))
            .y_desc(elide(&self.y.label, LABEL, bottom - top + EDGE))
            .draw()?;
        Ok(())
    }

    /// All curves; on cells, white rims before all of them, so that one shows through the gaps of
    /// another.
    fn draw_curves(&self, page: &mut Page, layout: &Layout, curves: &[Curve<'_>]) {
        if self.cells.is_some() {
            for curve in curves.iter().filter(|curve| curve.series.width > 0.0) {
                let line = curve.line(layout, curves.len());
                page.line(&line, WHITE, curve.series.width + RIM, "");
            }
        }
        for curve in curves {
            curve.draw(page, layout, curves.len());
        }
    }

    /// Title, name of the horizontal axis, names of guides, notes.
    fn draw_texts(&self, page: &mut Page, layout: &Layout) {
        let [left, _, right, bottom] = layout.plot;
        let title = elide(&self.heading(), TITLE, WIDTH - 2.0 * EDGE);
        let [x, y, size] = [0.5 * WIDTH, EDGE + 10.0, TITLE].map(tenths);
        page.raw(&format!(
            "<text x=\"{x}\" y=\"{y}\" dy=\"0.5ex\" text-anchor=\"middle\" font-size=\"{size}\" \
             fill=\"#222222\"{TITLE_MARK}{}</text>\n",
            escape(&title)
        ));
        page.layer(|area| {
            // A name wider than the plot ends at the edge of the page.
            let name = elide(&self.x.label, LABEL, WIDTH - 2.0 * EDGE);
            let furthest = WIDTH - EDGE - 0.5 * text_width(&name, LABEL);
            let x = (0.5 * (left + right)).min(furthest);
            write(area, &name, (x, bottom + NAME), font(LABEL), HPos::Center);
            self.draw_guides(area, layout);
            for (k, note) in layout.notes.iter().enumerate() {
                let y = layout.notes_top + NOTE_ROW * (k as f64 + 0.5);
                // A note wider than what is right of the axis begins at the edge of the page.
                let left = left.min(WIDTH - EDGE - text_width(note, TEXT)).max(EDGE);
                let note = elide(note, TEXT, WIDTH - left - EDGE);
                write(area, &note, (left, y), font(TEXT).color(&MUTED), HPos::Left);
            }
        });
    }

    /// The names of guides in the right margin, each above the one below it.
    fn draw_guides(&self, area: &Area<'_>, layout: &Layout) {
        let right = layout.plot[2];
        let mut guides: Vec<&Guide> = self.guides.iter().collect();
        guides.sort_by(|one, next| one.value.total_cmp(&next.value));
        let mut free = f64::INFINITY;
        for Guide { label, value } in guides {
            let y = layout.px((f64::NAN, *value)).1;
            if y.is_finite() {
                let at = y.min(free);
                free = at - APART;
                line(area, &[(right + 1.0, y), (right + 9.0, at)], MUTED, THIN);
                write(area, label, (right + 13.0, at), font(TEXT), HPos::Left);
            }
        }
    }
}

/// Where a value lies across the page; beyond what an axis can show, at its end.
fn across(layout: &Layout, value: f64) -> f64 {
    let [left, _, right, _] = layout.plot;
    match layout.px((value, f64::NAN)).0 {
        at if at.is_finite() => at,
        _ if value > 0.0 => right,
        _ => left,
    }
}

/// The union of intervals on the page; those closer than a pixel are one.
fn merged(intervals: &[(f64, f64)], layout: &Layout) -> Vec<[f64; 2]> {
    let known = intervals.iter().filter(|(a, b)| !a.is_nan() && !b.is_nan());
    let ends = known.map(|(a, b)| [a.min(*b), a.max(*b)].map(|end| across(layout, end)));
    let mut ends: Vec<[f64; 2]> = ends.collect();
    ends.sort_by(|one, next| one[0].total_cmp(&next[0]));
    let mut merged: Vec<[f64; 2]> = vec![];
    for [from, to] in ends {
        match merged.last_mut() {
            Some(last) if from <= last[1] + 1.0 => last[1] = last[1].max(to),
            _ => merged.push([from, to]),
        }
    }
    merged
}
