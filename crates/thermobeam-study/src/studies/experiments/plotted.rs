//! The figures as data: curves by the first discretisation, their errors by the second, the paper's
//! algorithm on top.

use convergence_study::chart::{Chart, Series};

use super::{OfExperiment, Trace, trace::SAME_TIME};
use crate::studies::paper::{ELEMENTS, Experiment, STEPS, T_END};
use crate::{figures, run::Sample};
use convergence_judge::text::number::{max_or_nan, plain_text, short_text};

/// A quantity over time.
pub(super) type Points = Vec<(f64, f64)>;

/// A figure before it is drawn.
pub(super) struct Plotted {
    pub(super) what: &'static str,
    /// Its name in the caption.
    pub(super) name: &'static str,
    /// Without the paper's algorithm.
    pub(super) chart: Chart,
    /// A panel below, with the same curves enlarged or on another scale.
    below: Option<Box<Plotted>>,
    curves: Vec<PlottedCurve>,
}

/// A curve, and the same quantity by other runs.
struct PlottedCurve {
    drawn: Points,
    second: Points,
    paper: Option<Points>,
}

/// What a figure shows of each run.
#[derive(Clone, Copy)]
pub(super) struct PlottedSeries {
    /// Its name in the legend; `None`: that of β.
    pub(super) label: Option<&'static str>,
    pub(super) value: fn(Experiment, &Sample) -> f64,
    /// The curve starts here.
    pub(super) from: f64,
    /// Whether the whole curve is shown; otherwise it ends at t_end, as in the paper.
    pub(super) until_steady: bool,
}

impl Plotted {
    /// * `what`, `name`: of the file, and in the caption; `chart`: title, axes and guides.
    pub(super) fn new(
        [what, name]: [&'static str; 2],
        chart: Chart,
        runs: &[OfExperiment<'_>],
        quantities: &[PlottedSeries],
    ) -> Self {
        let mut plotted = Self {
            what,
            name,
            chart,
            below: None,
            curves: vec![],
        };
        for (runs, quantity) in runs
            .iter()
            .flat_map(|runs| quantities.iter().map(move |quantity| (runs, quantity)))
        {
            plotted.push(runs, quantity);
        }
        plotted
    }

    /// The same with a panel below, which names the curves of both.
    pub(super) fn above(mut self, below: Plotted) -> Self {
        self.chart.without_legend = true;
        Self {
            below: Some(Box::new(below)),
            ..self
        }
    }

    fn push(&mut self, runs: &OfExperiment<'_>, quantity: &PlottedSeries) {
        let OfExperiment { experiment, .. } = *runs;
        let drawn = quantity.points(experiment, &runs.first.trace);
        let beta = experiment.beta;
        let (label, style) = match quantity.label {
            Some(label) => (label.to_owned(), self.curves.len()),
            None => (figures::beta_label(beta), figures::style_of_beta(beta)),
        };
        self.chart.curve(label, drawn.iter().copied()).style = Some(style);
        self.curves.push(PlottedCurve {
            drawn,
            second: quantity.points(experiment, &runs.second.trace),
            paper: runs
                .paper
                .map(|paper| quantity.points(experiment, &paper.trace)),
        });
    }

    /// The largest difference of the two discretisations, over the width of the line: below 1 it
    /// cannot be seen. NaN without curves.
    pub(super) fn error(&self) -> f64 {
        self.over_width(&|curve| Some(&curve.second))
    }

    /// The largest difference to other runs, over the width of the line, in all panels; NaN if some
    /// are missing.
    fn over_width(&self, other: &dyn Fn(&PlottedCurve) -> Option<&Points>) -> f64 {
        let is_log = self.chart.y.is_log;
        let differences = self.curves.iter().map(|curve| {
            other(curve).map_or(f64::NAN, |other| {
                largest_difference(is_log, &curve.drawn, other)
            })
        });
        let largest = differences.reduce(max_or_nan);
        let here = largest.unwrap_or(f64::NAN) / self.chart.line_width();
        match &self.below {
            None => here,
            Some(below) => max_or_nan(here, below.over_width(other)),
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
        let mut panels = vec![self.overlaid()];
        panels.extend(self.below.as_ref().map(|below| below.overlaid()));
        if let Some(last) = panels.last_mut() {
            last.notes.extend(self.accuracy());
        }
        match &panels[..] {
            [only] => only.svg(),
            all => Chart::panels(&self.chart.title, all),
        }
    }

    fn overlaid(&self) -> Chart {
        let mut chart = self.chart.clone();
        for (place, curve) in self.curves.iter().enumerate() {
            if let Some(points) = &curve.paper {
                chart.series[place].dashes = Some(Series::SOLID);
                let dots = chart.curve(by_the_paper(), points.iter().copied());
                dots.style = Some(INK);
                dots.dashes = Some(Series::DOTTED);
                dots.width = 1.2;
            }
        }
        chart
    }
}

/// The style in ink of the paper's algorithm, dots on the exact curve.
const INK: usize = 5;

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
    pub(super) fn points(&self, experiment: Experiment, trace: &Trace) -> Points {
        let end = if self.until_steady {
            f64::INFINITY
        } else {
            // Time levels of a one-step scheme differ from t_end by round-off.
            T_END * (1.0 + SAME_TIME)
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

/// The largest difference as far as both go, in decades on a logarithmic axis; NaN if there is
/// none, or times differ.
pub(super) fn largest_difference(is_log: bool, one: &Points, other: &Points) -> f64 {
    let place = |value: f64| if is_log { value.log10() } else { value };
    let differences = one.iter().zip(other).map(|(&(t, a), &(s, b))| {
        if (t - s).abs() > SAME_TIME * t {
            return f64::NAN;
        }
        let difference = (place(a) - place(b)).abs();
        // What has no place has no difference.
        if difference.is_finite() {
            difference
        } else {
            f64::NAN
        }
    });
    differences.reduce(max_or_nan).unwrap_or(f64::NAN)
}

/// The paper's algorithm and its resolution, for the legend.
fn by_the_paper() -> String {
    let [h, dt] = [1.0 / ELEMENTS as f64, T_END / STEPS as f64];
    format!("(4.1)-(4.5), h = {h}, δt = {}", plain_text(dt))
}
