//! Errors over a grid of mesh widths and time steps: both orders are judged, drawn and guarded in
//! one way.

#[cfg(feature = "reports")]
use std::collections::HashSet;

#[cfg(feature = "reports")]
use super::outcome::Figure;
use super::outcome::{Check, NamedRate, Outcome};
use super::over_levels::Claim;
use super::subject::Subject;
#[cfg(feature = "reports")]
use crate::chart::{Axis, Chart, Columns, Series};
use crate::text::number::plain_text;
#[cfg(feature = "reports")]
use crate::text::number::{order_text, short_text};
use convergence_judge::grid::{Adding, ErrorMisfit, GridErrors, SpaceTime};
use convergence_judge::verdict::{RateVerdict, Verdict};

/// Root mean square misfit in log e up to which contributions are considered to add.
const MISFIT: f64 = 0.1;
/// The same of one error that stands out: three times as much, as of what scatters.
const MISFIT_OF_ONE: f64 = 0.3;
/// Steps with a smaller relative difference are equal.
const SAME_STEP: f64 = 1e-9;

/// Whether two steps are not equal.
fn differ(one: f64, other: f64) -> bool {
    (one / other - 1.0).abs() > SAME_STEP
}

/// One error on a grid, and the claim about it.
#[derive(Debug, Clone, PartialEq)]
pub struct GridColumn {
    /// Its name.
    pub name: String,
    /// The order in h.
    pub space: Claim,
    /// The order in dt.
    pub time: Claim,
    /// The errors, for each point of the grid; NaN without a result: the fit then uses the others,
    /// and a check fails.
    pub errors: Vec<f64>,
}

/// Errors on all pairs of mesh widths and time steps.
///
/// ```
/// use convergence_study::{Claim, Grid, GridColumn, SpaceTime};
///
/// let steps = [0.4, 0.2, 0.1, 0.05, 0.025];
/// let mut points = vec![];
/// for h in steps {
///     points.extend(steps.map(|dt| SpaceTime { space: h, time: dt }));
/// }
/// let column = GridColumn {
///     name: "L2".to_owned(),
///     space: Claim::new(2.0, 0.2),
///     time: Claim::new(1.0, 0.2),
///     errors: points.iter().map(|point| point.space * point.space + 0.5 * point.time).collect(),
/// };
/// let grid = Grid { points, times: steps.len(), columns: vec![column], squares_add: false };
/// let outcome = grid.judge();
/// assert!(outcome.verdict.is_pass(), "{}", outcome.summary);
/// assert_eq!(outcome.rates[1].name, "L2 in dt");
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Mesh widths and time steps of all points, time steps first; both coarse to fine.
    pub points: Vec<SpaceTime<f64>>,
    /// The number of time steps for each mesh width.
    pub times: usize,
    /// The errors.
    pub columns: Vec<GridColumn>,
    /// Whether theory says that the squares of the contributions of space and time add, which are
    /// then orthogonal; otherwise it is not known, and they or their squares are taken to add,
    /// whichever describes the errors better.
    pub squares_add: bool,
}

/// How far the errors are from a sum of contributions, and their squares from a sum of squares.
#[derive(Clone, Copy)]
struct Misfits {
    plain: f64,
    squares: f64,
    /// The error that is farthest from the better of the two, if it stands out.
    outlier: Option<ErrorMisfit>,
}

impl Grid {
    /// Judges both orders of each error, `L2 in h` and `L2 in dt`, by
    /// [`grid`](convergence_judge::grid); for each error a check of how the contributions add.
    pub fn judge(&self) -> Outcome {
        self.judge_unless(|_, rate| rate)
    }

    /// The same with what else speaks against the rates of an error.
    pub(crate) fn judge_unless(
        &self,
        unless: impl Fn(&GridColumn, RateVerdict) -> RateVerdict,
    ) -> Outcome {
        let steps = self.steps();
        if let Some(different) = self.off_grid(&steps) {
            let claim = "every mesh width is combined with the same time steps".to_owned();
            let check = Check::new(Verdict::Inconclusive, claim, different);
            return Outcome::new("", vec![], vec![check.about(Subject::of("steps"))]);
        }
        let mut rates = vec![];
        let mut checks = vec![];
        for column in &self.columns {
            let errors = GridErrors {
                h: &steps.space,
                dt: &steps.time,
                errors: &column.errors,
            };
            let [plain, squares] = [Adding::Plain, Adding::Squares].map(|way| errors.misfit(way));
            let adding = if self.squares_add || squares <= plain {
                Adding::Squares
            } else {
                Adding::Plain
            };
            let misfits = Misfits {
                plain,
                squares,
                outlier: errors.outlier(adding),
            };
            let missing = self.without_result(column);
            let names = ["h", "dt"].map(|step| format!("{} in {step}", column.name));
            let claims = SpaceTime {
                space: column.space.band(),
                time: column.time.band(),
            };
            match errors.judge(adding, claims) {
                Ok(SpaceTime { space, time }) => {
                    for (name, mut rate) in names.into_iter().zip([space, time]) {
                        if !missing.is_empty() {
                            rate = rate.without_result(self.points.len(), &missing);
                        }
                        rates.push(NamedRate::new(name, unless(column, rate)));
                    }
                }
                // Readers of study files have already refused such a tolerance.
                Err(error) => {
                    checks.extend(names.map(|name| {
                        let subject = Subject::of(&name);
                        Check::that(false, name, error.to_string()).about(subject)
                    }));
                }
            }
            checks.push(self.judge_model(&column.name, misfits));
        }
        Outcome::new("", rates, checks).summed_up_by_rates("")
    }

    /// The points without a result.
    fn without_result(&self, column: &GridColumn) -> Vec<String> {
        let missing = self
            .points
            .iter()
            .zip(&column.errors)
            .filter(|(_, error)| error.is_nan());
        missing
            .map(|(SpaceTime { space, time }, _)| {
                format!("h = {}, dt = {}", plain_text(*space), plain_text(*time))
            })
            .collect()
    }

    /// The mesh widths at the finest time step, and the time steps on the finest mesh.
    fn steps(&self) -> SpaceTime<Vec<f64>> {
        let times = self.times.max(1);
        let finest = self.points.chunks(times).last().unwrap_or_default();
        let rows = self.points.chunks(times);
        SpaceTime {
            space: rows
                .filter_map(|row| row.last())
                .map(|point| point.space)
                .collect(),
            time: finest.iter().map(|point| point.time).collect(),
        }
    }

    /// The first point whose mesh width or time step differs from that of its row and column.
    fn off_grid(&self, steps: &SpaceTime<Vec<f64>>) -> Option<String> {
        self.points.iter().enumerate().find_map(|(index, point)| {
            let h = steps.space[index / self.times.max(1)];
            let dt = *steps.time.get(index % self.times.max(1))?;
            let off = differ(point.space, h) || differ(point.time, dt);
            off.then(|| {
                format!(
                    "expected h = {h}, dt = {dt}, found h = {}, dt = {}",
                    point.space, point.time
                )
            })
        })
    }

    #[cfg(feature = "reports")]
    /// Each error over the mesh width, with a line for each time step, as a picture
    /// `over-h-<name>.svg`.
    ///
    /// * `rates`: what [`judge`](Self::judge) has found, which the titles say.
    /// * `label`: an error, by its name, as the vertical axis shows it.
    pub fn figures(&self, rates: &[NamedRate], label: impl Fn(&str) -> String) -> Vec<Figure> {
        let columns = self.columns.iter().zip(self.figure_names());
        columns
            .map(|(column, name)| self.figure(column, rates, label(&column.name), &name))
            .collect()
    }

    /// What the figures of the errors are called: with the numbers of the errors where two would
    /// have one name, as those of `u` and `U` on file systems that ignore case.
    #[cfg(feature = "reports")]
    fn figure_names(&self) -> Vec<String> {
        let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '.' | '_');
        let names = self.columns.iter().map(|column| {
            let name = column.name.replace(|c: char| !is_plain(c), "-");
            format!("over-h-{name}")
        });
        let mut names: Vec<String> = names.collect();
        let distinct: HashSet<String> = names.iter().map(|name| name.to_lowercase()).collect();
        if distinct.len() < names.len() {
            for (k, name) in names.iter_mut().enumerate() {
                *name += &format!("-{}", k + 1);
            }
        }
        names
    }

    #[cfg(feature = "reports")]
    /// An error over the mesh width.
    ///
    /// * `label`: of the vertical axis.
    /// * `name`: of the figure.
    fn figure(
        &self,
        column: &GridColumn,
        rates: &[NamedRate],
        label: String,
        name: &str,
    ) -> Figure {
        let own = format!("{} in ", column.name);
        let mut own = rates.iter().filter(|rate| rate.name.starts_with(&own));
        let title = if own.all(|rate| rate.rate.verdict.is_pass()) {
            "Errors fall with h until the error of dt is left"
        } else {
            "The orders in h and dt are not confirmed"
        };
        let chart = self.chart(column, label).titled(title);
        let caption = format!(
            "Error `{}` over the mesh width, with a line for each time step: of order {} (triangle) where the error \
             of the time step is small.",
            column.name,
            order_text(column.space.order)
        );
        Figure::of(name, caption, chart)
    }

    /// A line for each time step, drawn from the points of the grid.
    #[cfg(feature = "reports")]
    fn chart(&self, column: &GridColumn, label: String) -> Chart {
        let mut table = Columns::default();
        let mut series = vec![];
        for k in 0..self.times {
            let dt = self.points.get(k).map_or(f64::NAN, |point| point.time);
            let name = format!("dt = {}", short_text(dt));
            let every = self.times.max(1);
            let meshes = self.points.iter().skip(k).step_by(every);
            let [over, of] = ["h", &column.name].map(|column| format!("{column}, {name}"));
            table.push(&over, meshes.map(|point| point.space));
            table.push(&of, column.errors.iter().copied().skip(k).step_by(every));
            series.push(Series::errors(name, over, of));
        }
        Chart {
            series,
            slopes: vec![column.space.order],
            ..Chart::new(table, Axis::log("mesh width h"), Axis::log(label))
        }
    }

    /// Judges whether the contributions of space and time add as the fit assumes.
    fn judge_model(&self, name: &str, misfits: Misfits) -> Check {
        let Misfits {
            plain,
            squares,
            outlier,
        } = misfits;
        let outlier = outlier.filter(|outlier| outlier.misfit > MISFIT_OF_ONE);
        let mut evidence = format!(
            "misfit {squares:.2e} of the squares, {plain:.2e} of the sum; at most {MISFIT} is taken for none"
        );
        if let Some(ErrorMisfit { h, dt, misfit }) = outlier {
            let [h, dt] = [h, dt].map(plain_text);
            evidence += &format!(
                "; {misfit:.2e} of the error at h = {h}, dt = {dt}, at most {MISFIT_OF_ONE} of one that stands out: \
                 is that run as the others are?"
            );
        }
        let subject = Subject::of("sum of errors").in_case(name);
        if self.squares_add {
            let claim = "the squares of space and time error add";
            let holds = squares < plain && squares <= MISFIT && outlier.is_none();
            return Check::that(holds, claim, evidence).about(subject);
        }
        // Nobody claimed it: if it does not hold, the orders are unknown.
        let verdict = if plain.min(squares) <= MISFIT && outlier.is_none() {
            Verdict::Pass
        } else {
            Verdict::Inconclusive
        };
        let claim = "the errors of space and time add, or their squares";
        Check::new(verdict, claim, evidence).about(subject)
    }
}
