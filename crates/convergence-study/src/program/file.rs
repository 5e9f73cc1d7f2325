//! Study files of programs. `begin/study.toml` is one, `program.md` of the book describes them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;

use super::Program;
use super::expectation::Expectation;
use super::kept::Kept;
use super::launch::{COMMAND, LaunchKeys, SECONDS};
use super::refine::{Refine, RefineTable};
use crate::input::{
    AllowedText, Choices, Number, OneOf, POSITIVE, Positive, Range, Refusal, visible,
};
use crate::study::{Claim, Constant, Lines, ORDER, Order};
use crate::text::number::plain_text;
use convergence_judge::claims::{self, Bound, order_of_factor};
use convergence_judge::verdict::{Floor, Of, WIDEST_TOLERANCE};

/// A study of a program.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ProgramFile {
    /// what is run
    program: ProgramTable,
    /// the resolutions at which it is run
    refine: RefineTable,
    /// an error or a value, and what is claimed of it
    expect: Vec<ExpectTable>,
}

/// The table `[program]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ProgramTable {
    /// the program and its arguments, without a shell; `{n}`, `{h}`, `{steps}`, `{dt}`, `{level}`
    /// stand for the resolution and `{seed}` for the sample, without them the program reads them as
    /// JSON from standard input
    #[schemars(extend("title" = COMMAND))]
    command: Vec<String>,
    /// the folder in which it runs, relative to that of this file, which it is without it
    directory: Option<String>,
    /// variables of the program's environment, beside those of the harness
    #[serde(default)]
    env: BTreeMap<String, String>,
    /// the file of `manufacture` from whose module with `--variants` the program takes its
    /// solution, for `--where`; relative to this file
    manufacture: Option<String>,
    /// files that a result depends on, relative to this file, for `cache`; those that the command
    /// names count, too
    files: Option<Vec<String>>,
    /// whether `verify` takes the answers of its last run for levels whose command and files are
    /// the same; the cheapest one is always run, and with `--bless` all are
    #[serde(default)]
    cache: bool,
    /// the time limit of a case in seconds; without it 600
    #[schemars(extend("title" = SECONDS))]
    time_limit: Option<Positive>,
    /// a thousand times the round-off: fine levels with errors up to it are dropped; without it
    /// none
    floor: Option<Positive>,
    /// the size of the solution, which says what may be round-off
    #[schemars(extend("default" = 1))]
    scale: Option<Positive>,
}

/// A table `[[expect]]`: an error or a value, with an order or a factor, or an error that is exact.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ExpectTable {
    /// the name of an error that the program answers
    error: Option<AllowedText<Lines>>,
    /// the name of a value without exact solution that it answers: judged by the differences of its
    /// levels
    value: Option<AllowedText<Lines>>,
    /// the order, or the least order; of a grid: in h
    order: Option<Order>,
    /// of a grid: the order in dt; without it that in h
    order_dt: Option<Positive>,
    /// by which the error falls with each degree, n being the degree
    factor: Option<Order>,
    /// no error is larger
    exact: Option<Positive>,
    /// the ends of the C of error = C h^order
    #[schemars(extend("title" = "two numbers > 0, the smaller first"))]
    constant: Option<Constant>,
    /// how the samples of a level make the error: their mean, the root of their mean square, or the
    /// size of the mean of signed numbers; without it "mean"
    of: Option<OneOf<Makers>>,
    /// how far the rate may be from the order; without it 0.25, at most half of the order, a
    /// quarter of a least one
    tolerance: Option<Number<Narrow>>,
}

/// Tolerances of a rate.
#[derive(Debug, Clone, Copy)]
pub(super) enum Narrow {}

impl Range for Narrow {
    const ENDS: &'static [(&'static str, f64)] = &[
        ("exclusiveMinimum", 0.0),
        ("exclusiveMaximum", WIDEST_TOLERANCE),
    ];
}

/// How samples make an error.
#[derive(Debug)]
pub(super) enum Makers {}

impl Choices for Makers {
    type Value = Of;

    fn all() -> Vec<(&'static str, Of)> {
        Of::ALL.map(|of| (of.name(), of)).to_vec()
    }
}

impl ProgramFile {
    /// The study.
    ///
    /// * `folder`: the folder of the file.
    /// * `guard`: the change of its numbers that the study tolerates, if it says so.
    pub(super) fn program(self, folder: &Path, guard: Option<f64>) -> Result<Program, Refusal> {
        let refine = self.refine.refine().map_err(Refusal::within("refine"))?;
        let expect = expectations(self.expect, &refine)?;
        let refine = refine.beginning_for(|count| fastest(&expect, count));
        let table = self.program;
        let in_program = Refusal::within("program");
        // The first run of the coarsest level; no list is empty.
        let cheapest = refine.cases().swap_remove(0);
        let values = &cheapest.parameters;
        table.fits(&refine).map_err(&in_program)?;
        let floor = table.floor();
        let manufactured = table.manufactured(folder).map_err(&in_program)?;
        let kept = table.kept_files().map_err(&in_program)?;
        let launch = table.launch_keys().launch(folder, values);
        let launch = launch.map_err(&in_program)?;
        if refine.samples.is_some() && !launch.tells("seed", values) {
            let allowed = "a command with the placeholder {seed}, which tells samples apart";
            return Err(in_program(Refusal::written("command", allowed)));
        }
        let kept =
            kept.map(|files| Kept::new(&files, folder, guard, cheapest).map_err(&in_program));
        Ok(Program {
            floor,
            manufactured,
            launch,
            kept: kept.transpose()?,
            refine,
            expect,
            most_levels: None,
        })
    }
}

/// The error at a count that falls fastest of all claimed, in units of its constant.
fn fastest(expect: &[Expectation], count: f64) -> f64 {
    let claimed = expect.iter().filter(|expected| expected.exact.is_none());
    let errors = claimed.map(|expected| {
        let step = if expected.by_degree {
            claims::step_of_degree(count)
        } else {
            1.0 / count
        };
        step.powf(expected.claim.order)
    });
    errors.fold(1.0, f64::min)
}

impl ProgramTable {
    /// The files of which answers are kept, if they are.
    fn kept_files(&self) -> Result<Option<Vec<String>>, Refusal> {
        match (&self.files, self.cache) {
            (Some(files), true) if !files.is_empty() => Ok(Some(files.clone())),
            (_, true) => {
                let allowed = "true beside `files`, all files that a result depends on";
                Err(Refusal::written("cache", allowed))
            }
            (Some(_), false) => Err(Refusal::written("files", "files beside cache = true")),
            (None, false) => Ok(None),
        }
    }

    /// Refuses what would be ignored of round-off.
    fn fits(&self, refine: &Refine) -> Result<(), Refusal> {
        let allowed = "no floor beside samples, whose scatter says how well a level is known";
        if refine.samples.is_some() && self.floor.is_some() {
            return Err(Refusal::written("floor", allowed));
        }
        let keys = [
            ("floor", self.floor.is_some()),
            ("scale", self.scale.is_some()),
        ];
        let mut keys = keys.iter().filter(|(_, is_there)| *is_there && refine.grid);
        let allowed = "no floor or scale on a grid, whose misfit says how well an error is known";
        keys.next()
            .map_or(Ok(()), |(key, _)| Err(Refusal::written(*key, allowed)))
    }

    fn launch_keys(self) -> LaunchKeys {
        LaunchKeys {
            command: self.command,
            directory: self.directory,
            env: self.env,
            time_limit: self.time_limit,
        }
    }

    /// What is known of round-off.
    fn floor(&self) -> Floor {
        let floor = self.floor.map_or(0.0, Positive::get);
        let scale = self.scale.map_or(1.0, Positive::get);
        // Both are finite and positive.
        let floor = Floor::new(floor).and_then(|floor| floor.of_scale(scale));
        floor.unwrap_or_default()
    }

    /// The file of `manufacture`; it is read when its variants are needed.
    fn manufactured(&self, folder: &Path) -> Result<Option<PathBuf>, Refusal> {
        let Some(name) = &self.manufacture else {
            return Ok(None);
        };
        let path = folder.join(name);
        if path.is_file() {
            return Ok(Some(path));
        }
        let more = format!(", but {} is no file", visible(&path.display().to_string()));
        let allowed = "a file of `manufacture`, relative to this file";
        Err(Refusal::written_and("manufacture", more, allowed))
    }
}

/// * `refine`: on a grid each error has two orders; of samples only errors are judged.
fn expectations(tables: Vec<ExpectTable>, refine: &Refine) -> Result<Vec<Expectation>, Refusal> {
    let expectations = Refusal::of_each("expect", tables, |table| {
        table.fits(refine)?;
        table.expectation(refine.grid)
    })?;
    for (place, expectation) in expectations.iter().enumerate() {
        let is_same = |earlier: &Expectation| {
            (&earlier.name, earlier.is_value) == (&expectation.name, expectation.is_value)
        };
        if expectations[..place].iter().any(is_same) {
            let found = format!("\"{}\" a second time", visible(&expectation.name));
            let path = format!("expect[{place}].{}", expectation.what());
            return Err(Refusal::new(path, found, "each name once"));
        }
    }
    let of_rates = expectations
        .iter()
        .filter(|expected| expected.exact.is_none());
    let by_degree = of_rates
        .clone()
        .filter(|expected| expected.by_degree)
        .count();
    if expectations.is_empty() {
        let allowed = "at least one table [[expect]] with error or value, and order";
        Err(Refusal::written("expect", allowed))
    } else if by_degree > 0 && by_degree < of_rates.count() {
        let found = "factor in some tables and order in others";
        let allowed = "one of the two in all of a study";
        Err(Refusal::new("expect", found, allowed))
    } else {
        Ok(expectations)
    }
}

/// The name in a table `[[expect]]`, of an error or of a value.
///
/// * `allowed`: what is missing if there is neither.
pub(super) fn one_name(
    error: Option<AllowedText<Lines>>,
    value: Option<AllowedText<Lines>>,
    allowed: &str,
) -> Result<String, Refusal> {
    match (error, value) {
        (Some(_), Some(_)) => {
            let allowed = "one of the two in each table [[expect]]";
            Err(Refusal::new("value", "value beside error", allowed))
        }
        (None, None) => Err(Refusal::missing("error", allowed)),
        (Some(name), None) | (None, Some(name)) => Ok(name.get()),
    }
}

impl ExpectTable {
    /// Refuses what samples do not have, and what has no samples.
    fn fits(&self, refine: &Refine) -> Result<(), Refusal> {
        let others = [
            ("value", self.value.is_some()),
            ("factor", self.factor.is_some()),
            ("exact", self.exact.is_some()),
        ];
        let other = others.iter().find(|(_, is_there)| *is_there);
        match (refine.samples, other) {
            (Some(_), Some((key, _))) => {
                Err(Refusal::written(*key, "error and order beside samples"))
            }
            (None, _) if self.of.is_some() => Err(Refusal::written(
                "of",
                "of only where refine.samples is given",
            )),
            _ => Ok(()),
        }
    }

    fn expectation(self, grid: bool) -> Result<Expectation, Refusal> {
        let is_value = self.value.is_some();
        if is_value && grid {
            let allowed = "error, the only one that a grid judges";
            return Err(Refusal::new("value", "value with grid = true", allowed));
        }
        let (claim, by_degree, exact) = self.claimed(grid || is_value)?;
        if self.order_dt.is_some() && !grid {
            return Err(Refusal::new(
                "order_dt",
                "order_dt without grid = true",
                "order alone",
            ));
        }
        let time = match self.order_dt {
            Some(order) => self.with_tolerance(Claim::usual(order.get(), Bound::Both))?,
            None => claim,
        };
        let allowed =
            "the name of an error that the program answers, or `value` with the name of a value";
        let name = one_name(self.error, self.value, allowed)?;
        Ok(Expectation {
            name,
            is_value,
            time,
            claim,
            by_degree,
            exact,
            of: self.of.map_or(Of::Mean, |of| of.value),
        })
    }

    /// The claim: a rate over steps, or over degrees if the flag is true; or the bound of an error
    /// that should vanish.
    ///
    /// * `plain`: whether only an order can be claimed, as for values and grids.
    fn claimed(&self, plain: bool) -> Result<(Claim, bool, Option<f64>), Refusal> {
        let others = [
            ("factor", self.factor.is_some()),
            ("exact", self.exact.is_some()),
            ("constant", self.constant.is_some()),
        ];
        let mut others = others.iter().filter(|(_, is_there)| *is_there);
        if let Some((key, _)) = others.next().filter(|_| plain) {
            return Err(Refusal::written(
                *key,
                "order alone, for values and on a grid",
            ));
        }
        let one = "one of order, factor and exact";
        match (self.order, self.factor, self.exact) {
            (_, Some(_), Some(_)) | (Some(_), _, Some(_)) => Err(Refusal::written("exact", one)),
            (Some(_), Some(_), None) => Err(Refusal::written("factor", one)),
            (None, None, None) => Err(Refusal::missing("order", ORDER)),
            (None, None, Some(exact)) => {
                let beside = [
                    ("tolerance", self.tolerance.is_some()),
                    ("constant", self.constant.is_some()),
                ];
                if let Some((key, _)) = beside.iter().find(|(_, is_there)| *is_there) {
                    return Err(Refusal::new(
                        *key,
                        format!("{key} beside exact"),
                        "exact alone",
                    ));
                }
                // There is no rate for a tolerance to apply to.
                Ok((Claim::usual(1.0, Bound::Both), false, Some(exact.get())))
            }
            (Some(order), None, None) => {
                if plain && order.bound != Bound::Both {
                    return Err(Refusal::written("order", POSITIVE));
                }
                Ok((
                    self.with_tolerance(order.claim(self.constant, None)?)?,
                    false,
                    None,
                ))
            }
            (None, Some(factor), None) => {
                if self.constant.is_some() {
                    let allowed = "two numbers > 0, the smaller first, beside order";
                    return Err(Refusal::written("constant", allowed));
                }
                if factor.order <= 1.0 {
                    let allowed = "a factor > 1, by which the error falls a degree";
                    return Err(Refusal::written("factor", allowed));
                }
                // No scheme gains an order over the degree: any larger factor may be right.
                let bound = if factor.bound.is_least() {
                    Bound::AnyAbove
                } else {
                    Bound::Both
                };
                let claim = Claim::usual(order_of_factor(factor.order), bound);
                Ok((self.with_tolerance(claim)?, true, None))
            }
        }
    }

    fn with_tolerance(&self, claim: Claim) -> Result<Claim, Refusal> {
        let tolerance = self.tolerance.map_or(claim.tolerance, Number::get);
        if self.tolerance.is_some() && tolerance >= claim.order {
            let most = WIDEST_TOLERANCE.min(claim.order);
            let allowed = format!("a number > 0 and < {}", plain_text(most));
            return Err(Refusal::written("tolerance", allowed));
        }
        Ok(Claim { tolerance, ..claim })
    }
}
