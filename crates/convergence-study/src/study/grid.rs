//! Errors over a grid of mesh widths and time steps: both orders are fitted at once, and judged, drawn and guarded in one way.

use super::levels::Claim;
#[cfg(feature = "reports")]
use super::outcome::Figure;
use super::outcome::{Check, Quantity, Table};
use crate::judge::fit::{Adding, Quantiles, SurfaceFit, SurfacePoint, fit_surface_by};
use crate::judge::verdict::Verdict;
#[cfg(feature = "reports")]
use crate::plots;

/// Root mean square misfit in log e up to which the model is taken for a description of the data.
const MISFIT: f64 = 0.1;
/// Relative change of a fitted order that the baseline tolerates: the fit ends where its steps are that small.
const FIT_TOLERANCE: f64 = 1e-3;

/// One error on a grid, and what is claimed of it.
#[derive(Debug, Clone, PartialEq)]
pub struct GridColumn {
    /// Its name.
    pub name: String,
    /// The order in h; the tolerance is that of both orders.
    pub space: Claim,
    /// The order in dt.
    pub time: f64,
    /// The errors, for each point of the grid; NaN where there is no result: the fit is then that of the others, and a check fails.
    pub errors: Vec<f64>,
}

/// How the errors of space and time add up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// Theory says that their squares do: they are orthogonal.
    Squares,
    /// Nothing is known: whichever of the two describes the errors better.
    Either,
}

/// Errors on all pairs of mesh widths and time steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Mesh widths and time steps of all points, time steps first.
    pub points: Vec<[f64; 2]>,
    /// The number of time steps for each mesh width.
    pub times: usize,
    /// The errors.
    pub columns: Vec<GridColumn>,
    /// How they add up.
    pub model: Model,
}

/// What a grid says of all errors.
#[derive(Debug, Clone, PartialEq)]
pub struct GridVerdict {
    /// Both orders and the model, for each error.
    pub checks: Vec<Check>,
    /// The fits.
    pub table: Table,
    /// The fitted orders, for the baseline.
    pub quantities: Vec<Quantity>,
    /// The fitted orders in a sentence.
    pub headline: String,
}

impl Grid {
    /// Fits and judges each error.
    pub fn judge(&self) -> GridVerdict {
        let (mut checks, mut rows, mut quantities, mut headline) = (vec![], vec![], vec![], vec![]);
        for column in &self.columns {
            let name = &column.name;
            checks.extend(self.incomplete(column));
            match self.fit(column) {
                Ok(fitted) => {
                    checks.extend(self.judge_fit(column, &fitted));
                    rows.push(row(name, &fitted));
                    let fit = fitted.fit;
                    headline.push(format!("{name}: order {:.4} in h, {:.4} in dt", fit.p, fit.q));
                    for (letter, value) in [("p", fit.p), ("q", fit.q)] {
                        quantities.push(Quantity { name: format!("{letter} {name}"), value, tolerance: FIT_TOLERANCE });
                    }
                }
                Err(reason) => checks.push(Check::that(false, format!("{name}: the model can be fitted"), reason)),
            }
        }
        GridVerdict { checks, table: self.table(rows), quantities, headline: headline.join("; ") }
    }

    #[cfg(feature = "reports")]
    /// Each error over the grid, as a picture.
    ///
    /// * `id`: of the study; a picture is called `<id>-surface-<name>.svg`.
    /// * `what`: what the name of an error stands for, such as `norm`.
    pub fn figures(&self, id: &str, what: &str) -> Vec<Figure> {
        let widths: Vec<f64> = self.points.iter().step_by(self.times.max(1)).map(|[h, _]| *h).collect();
        let steps: Vec<f64> = self.points.iter().take(self.times).map(|[_, dt]| *dt).collect();
        let figure = |column: &GridColumn| {
            let at = |k: usize, j: usize| column.errors.get(j * self.times + k).copied().unwrap_or(f64::NAN);
            let svg = plots::surface(&plots::Surface {
                x: plots::Axis::log("mesh width h"),
                y: plots::Axis::log("time step dt"),
                z: plots::Axis::log(format!("error, {}", column.name)),
                x_values: widths.clone(),
                y_values: steps.clone(),
                values: (0..steps.len()).map(|k| (0..widths.len()).map(|j| at(k, j)).collect()).collect(),
                ..plots::Surface::default()
            });
            let plain = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '-' | '.' | '_') { c } else { '-' };
            Figure {
                file: format!("{id}-surface-{}.svg", column.name.chars().map(plain).collect::<String>()),
                caption: format!("Error in the {what} `{}` over mesh width and time step.", column.name),
                svg,
            }
        };
        self.columns.iter().map(figure).collect()
    }

    fn fit(&self, column: &GridColumn) -> Result<Fitted, String> {
        let point = |(&[h, dt], &error): (&[f64; 2], &f64)| SurfacePoint { h, dt, error };
        let having = self.points.iter().zip(&column.errors).filter(|(_, error)| !error.is_nan());
        let points: Vec<SurfacePoint> = having.map(point).collect();
        let fit = |adding| fit_surface_by(&points, adding, Quantiles::standard());
        let squares = fit(Adding::Squares);
        let misfit = squares.as_ref().map_or(f64::INFINITY, |fit| fit.rms);
        let is_best = squares.as_ref().is_ok_and(|fit| fit.rms <= fit.rms_additive);
        let fit = if self.model == Model::Squares || is_best { squares } else { fit(Adding::Plain).or(squares) };
        fit.map(|fit| Fitted { squares: misfit, fit }).map_err(|error| error.to_string())
    }

    /// Fails where a point has no result; nothing where all have one.
    fn incomplete(&self, GridColumn { name, errors, .. }: &GridColumn) -> Option<Check> {
        let (all, have) = (self.points.len(), errors.iter().filter(|error| !error.is_nan()).count());
        let evidence = || format!("{name}: {} of {all} cases have no result", all - have);
        (have < all).then(|| Check::that(false, format!("{name}: every case has a result"), evidence()))
    }

    /// Both orders by equivalence: passes where the interval lies inside the band, fails where it lies outside, else inconclusive.
    fn judge_fit(&self, column: &GridColumn, fitted: &Fitted) -> [Check; 3] {
        let GridColumn { name, space: Claim { order, tolerance }, time, .. } = column;
        let one = |letter: &str, order: f64, rate: f64, interval: [f64; 2]| {
            let [low, high] = interval;
            let verdict = if !(low.is_finite() && high.is_finite() && rate.is_finite()) {
                Verdict::Fail
            } else if low >= order - tolerance && high <= order + tolerance {
                Verdict::Pass
            } else if high < order - tolerance || low > order + tolerance {
                Verdict::Fail
            } else {
                Verdict::Inconclusive
            };
            Check {
                claim: format!("{name}: {letter} = {order} ± {tolerance}"),
                verdict,
                evidence: format!("{name} {letter} = {rate:.4} in [{low:.4}, {high:.4}]"),
            }
        };
        let fit = &fitted.fit;
        [
            one("p", *order, fit.p, fit.p_interval),
            one("q", *time, fit.q, fit.q_interval),
            self.judge_model(name, fitted),
        ]
    }

    fn judge_model(&self, name: &str, Fitted { squares, fit }: &Fitted) -> Check {
        let (holds, claim) = match self.model {
            Model::Squares => (fit.rms < fit.rms_additive, "the squares of space and time error add"),
            Model::Either => (true, "the errors of space and time add, or their squares"),
        };
        Check::that(
            holds && fit.rms <= MISFIT,
            format!("{name}: {claim}"),
            format!("rms misfit {squares:.4}, of the plain sum {:.4}", fit.rms_additive),
        )
    }

    fn table(&self, rows: Vec<Vec<String>>) -> Table {
        let (first, title) = match self.model {
            Model::Squares => ("norm", "Fit of e² = (C_h h^p)² + (C_t dt^q)²"),
            Model::Either => {
                ("error in", "Fit of e² = (C_h h^p)² + (C_t dt^q)² or e = C_h h^p + C_t dt^q, the better one")
            }
        };
        let head = [
            first,
            "p",
            "95 % interval",
            "q",
            "95 % interval",
            "rms misfit",
            "misfit of the plain sum",
            "joint region",
        ];
        Table { title: title.to_owned(), head: head.map(str::to_owned).to_vec(), rows }
    }
}

/// The better model of an error.
struct Fitted {
    /// Misfit of the model of squares, whether or not it is the better one.
    squares: f64,
    fit: SurfaceFit,
}

fn row(name: &str, Fitted { squares, fit }: &Fitted) -> Vec<String> {
    let interval = |[low, high]: [f64; 2]| format!("[{low:.4}, {high:.4}]");
    let [major, minor] = fit.region.semi_axes;
    vec![
        name.to_owned(),
        format!("{:.4}", fit.p),
        interval(fit.p_interval),
        format!("{:.4}", fit.q),
        interval(fit.q_interval),
        format!("{squares:.4}"),
        format!("{:.4}", fit.rms_additive),
        format!("semi-axes {major:.4}, {minor:.4} at {:.1}°", fit.region.angle.to_degrees()),
    ]
}
