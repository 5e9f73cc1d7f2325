//! The figures as data: curves by the first discretisation, their errors by the second, the paper's
//! algorithm on top.

use convergence_study::internal::plots::{
    self,
    inset::{Inset, InsetFrame},
    look::{Look, look},
    ruler::on_scale,
    style,
    xy::{Curve, Xy},
};

use super::{Experiment, Trace, group::OfExperiment};
use crate::kinds::prelude::*;
use crate::{figures, run::Sample};
use convergence_judge::text::number::{plain_text, short_text};

/// A quantity over time.
pub(super) type Points = Vec<(f64, f64)>;

/// A figure before it is drawn.
pub(super) struct Plotted {
    pub(super) what: &'static str,
    /// Its name in the caption.
    pub(super) name: &'static str,
    /// Without the paper's algorithm.
    pub(super) xy: Xy,
    /// A small figure inside, and where.
    inset: Option<(Box<Plotted>, InsetFrame)>,
    curves: Vec<PlottedCurve>,
}

/// A curve, and the same quantity by other runs.
struct PlottedCurve {
    drawn: Points,
    second: Points,
    paper: Option<Points>,
    /// The paper's algorithm and its resolution, for the legend.
    by_the_paper: String,
}

/// What a figure shows of each run.
#[derive(Clone, Copy)]
pub(super) struct PlottedSeries {
    /// Its name in the legend; `None`: that of β.
    pub(super) label: Option<&'static str>,
    pub(super) value: fn(&Experiment, &Sample) -> f64,
    /// The curve starts here.
    pub(super) from: f64,
    /// Whether the whole curve is shown; otherwise it ends at the scene's t_end, as in the paper.
    pub(super) until_steady: bool,
}

impl Plotted {
    /// * `what`, `name`: of the file, and in the caption; `xy`: title, vertical axis and guides.
    pub(super) fn new(
        [what, name]: [&'static str; 2],
        xy: Xy,
        runs: &[OfExperiment<'_>],
        quantities: &[PlottedSeries],
    ) -> Self {
        let mut plotted = Self {
            what,
            name,
            xy,
            inset: None,
            curves: vec![],
        };
        plotted.xy.x = plots::Axis::linear("time t");
        for (runs, quantity) in runs
            .iter()
            .flat_map(|runs| quantities.iter().map(move |quantity| (runs, quantity)))
        {
            plotted.push(runs, quantity);
        }
        plotted
    }

    /// The same with a small figure inside.
    pub(super) fn with_inset(self, inset: Plotted, place: InsetFrame) -> Self {
        Self {
            inset: Some((Box::new(inset), place)),
            ..self
        }
    }

    fn push(&mut self, runs: &OfExperiment<'_>, quantity: &PlottedSeries) {
        let OfExperiment { experiment, .. } = *runs;
        let drawn = quantity.points(experiment, &runs.first.trace);
        let (label, look) = match quantity.label {
            Some(label) => (label.to_owned(), look(self.curves.len())),
            None => (
                figures::beta_label(&experiment.scene.beam),
                look_of(experiment),
            ),
        };
        let series = plots::Series::new(label, drawn.iter().copied());
        self.xy.curves.push(Curve {
            look,
            ..Curve::line(0, &series)
        });
        self.curves.push(PlottedCurve {
            drawn,
            second: quantity.points(experiment, &runs.second.trace),
            paper: runs
                .paper
                .map(|paper| quantity.points(experiment, &paper.trace)),
            by_the_paper: by_the_paper(experiment),
        });
    }

    /// The largest difference of the two discretisations, over the width of the line: below 1 it
    /// cannot be seen. NaN without curves.
    pub(super) fn error(&self) -> f64 {
        self.over_width(&|curve| Some(&curve.second))
    }

    /// The largest difference to other runs, over the width of the line, in the figure and its
    /// inset; NaN if some are missing.
    fn over_width(&self, other: &dyn Fn(&PlottedCurve) -> Option<&Points>) -> f64 {
        let scale = self.xy.y.scale;
        let differences = self.curves.iter().map(|curve| {
            other(curve).map_or(f64::NAN, |other| {
                largest_difference(scale, &curve.drawn, other)
            })
        });
        let largest = differences.reduce(max_or_nan);
        let here = largest.unwrap_or(f64::NAN) / self.xy.line_width();
        match &self.inset {
            None => here,
            Some((inset, place)) => max_or_nan(here, inset.over_width(other) * place.height()),
        }
    }

    /// How exact the curves are, in words.
    pub(super) fn accuracy(&self) -> Vec<String> {
        let exact = format!(
            "By dG; the error, by a second discretisation, is at most {} of the line's width",
            short_text(self.error())
        );
        let paper = self.error_of_paper().map(|error| {
            format!("The paper's algorithm is off by at most {error:.1} times that width")
        });
        [exact].into_iter().chain(paper).collect()
    }

    /// The largest difference to the paper's algorithm, over the width of the line; `None` where
    /// that was not run.
    fn error_of_paper(&self) -> Option<f64> {
        let is_there = self.curves.iter().any(|curve| curve.paper.is_some());
        is_there.then(|| self.over_width(&|curve| curve.paper.as_ref()))
    }

    /// The figure, with the paper's algorithm on top.
    pub(super) fn draw(&self) -> String {
        let mut xy = self.overlaid();
        if let Some((inset, place)) = &self.inset {
            xy.inset = Some(Inset {
                xy: Box::new(inset.overlaid()),
                place: *place,
            });
        }
        xy.notes.extend(self.accuracy());
        xy.draw()
    }

    fn overlaid(&self) -> Xy {
        let mut xy = self.xy.clone();
        for (curve, drawn) in self.curves.iter().zip(&self.xy.curves) {
            if let Some(points) = &curve.paper {
                let solid = xy
                    .curves
                    .iter_mut()
                    .filter(|other| other.name == drawn.name);
                solid.for_each(|curve| curve.look.dash = style::SOLID);
                xy.curves.push(overlay(&curve.by_the_paper, drawn, points));
            }
        }
        xy
    }
}

/// The energy within the figures' span.
pub(super) const ENERGY: PlottedSeries = PlottedSeries {
    label: None,
    value: |_, point| point.energy,
    from: 0.0,
    until_steady: false,
};

/// The displacement of the free end.
pub(super) const U_TIP: PlottedSeries = PlottedSeries {
    value: |_, point| point.u_tip,
    ..ENERGY
};

impl PlottedSeries {
    pub(super) fn points(&self, experiment: &Experiment, trace: &Trace) -> Points {
        let end = if self.until_steady {
            f64::INFINITY
        } else {
            // Time levels of a one-step scheme differ from t_end by round-off.
            experiment.scene.t_end * (1.0 + SAME_TIME)
        };
        let mut points = vec![];
        for point in &trace.points {
            if self.from <= point.t && point.t <= end {
                points.push((point.t, (self.value)(experiment, point)));
            }
        }
        points
    }
}

/// Relative difference of two times that are the same up to round-off.
const SAME_TIME: f64 = 1e-9;

/// The largest difference as far as both go; NaN if there is none, or times differ.
pub(super) fn largest_difference(scale: plots::Scale, one: &Points, other: &Points) -> f64 {
    let differences = one.iter().zip(other).map(|(&(t, a), &(s, b))| {
        if (t - s).abs() > SAME_TIME * t {
            return f64::NAN;
        }
        let [a, b] = [a, b].map(|value| on_scale(scale, value).unwrap_or(f64::NAN));
        (a - b).abs()
    });
    differences.reduce(max_or_nan).unwrap_or(f64::NAN)
}

/// The paper's algorithm as dots on the exact curve.
fn overlay(label: &str, drawn: &Curve, points: &Points) -> Curve {
    let series = plots::Series::new(label, points.iter().copied());
    Curve {
        look: Look {
            colour: style::INK,
            dash: style::DOTTED,
            ..drawn.look
        },
        width: 1.2,
        is_data: false,
        ..Curve::line(0, &series)
    }
}

fn by_the_paper(Experiment { scene, .. }: &Experiment) -> String {
    let h = 1.0 / scene.mesh.elements() as f64;
    format!("(4.1)-(4.5), h = {h}, δt = {}", plain_text(scene.dt()))
}

/// The look of a value of β, the same in all figures.
fn look_of(experiment: &Experiment) -> Look {
    look(figures::look_of_beta(experiment.scene.beam.beta))
}
