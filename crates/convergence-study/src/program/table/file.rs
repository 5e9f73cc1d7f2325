//! Files of the kind `table`.

use std::path::Path;

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::file::{Makers, Narrow, one_name};
use super::super::sources::SourceFile;
use super::ExistingTable;
use crate::input::table::{Choice, LineRange};
use crate::input::{AllowedText, Number, OneOf, Positive, Range, Refusal};
use crate::rates::{Claimed, Request};
use crate::study::{Lines, Order};
use convergence_judge::claims::Bound;

/// A table or a log that exists.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TableFile {
    /// the table, and how it is read
    table: TableTable,
    /// a column, and what is claimed of it
    expect: Vec<ExpectTable>,
}

/// The table `[table]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TableTable {
    /// the file with the table, relative to this file
    file: String,
    /// the files that it was made from, relative to this file: if they change and the table does
    /// not, the study is inconclusive
    inputs: Vec<String>,
    /// the column of the step, of a count or of levels: its name, or its number from 1
    step: Option<String>,
    /// names for all columns, instead of those in the table
    names: Option<Vec<String>>,
    /// the column of the step counts cells, unknowns or steps in so many dimensions
    dim: Option<Positive>,
    /// the column of the step numbers the levels, each with a step so many times as small
    ratio: Option<Number<AboveOne>>,
    /// the lines where the table is, from 1, such as "3-9"
    lines: Option<Vec<String>>,
    /// rows with equal steps are samples, which make the error in this way
    samples: Option<OneOf<Makers>>,
    /// a thousand times the round-off: fine levels with errors up to it are dropped; without it
    /// none
    floor: Option<Positive>,
    /// the size of the solution, which says what may be round-off
    #[schemars(extend("default" = 1))]
    scale: Option<Positive>,
    /// how far the rates may be from their orders; without it 0.25, at most half of the order, a
    /// quarter of a least one
    tolerance: Option<Number<Narrow>>,
}

/// A table `[[expect]]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ExpectTable {
    /// the name of a column of errors, behind the heading of a table of several and a colon
    error: Option<AllowedText<Lines>>,
    /// the name of a column of values without exact solution
    value: Option<AllowedText<Lines>>,
    /// the order, or the least order
    order: Order,
}

/// Ratios of steps.
#[derive(Debug, Clone, Copy)]
enum AboveOne {}

impl Range for AboveOne {
    const ENDS: &'static [(&'static str, f64)] = &[("exclusiveMinimum", 1.0)];
}

impl TableFile {
    /// The study.
    ///
    /// * `folder`: the folder of the file.
    pub(super) fn table(self, folder: &Path) -> Result<ExistingTable, Refusal> {
        let in_table = Refusal::within("table");
        let file = SourceFile::new("file", &self.table.file, folder).map_err(&in_table)?;
        let inputs = &self.table.inputs;
        if inputs.is_empty() {
            let allowed = "at least one file that the table was made from";
            return Err(in_table(Refusal::written("inputs", allowed)));
        }
        let inputs = SourceFile::all("inputs", inputs, folder).map_err(&in_table)?;
        if self.expect.is_empty() {
            let allowed = "at least one table [[expect]] with error or value, and order";
            return Err(Refusal::written("expect", allowed));
        }
        let tolerance = self.table.tolerance.map(Number::get);
        let values = self.expect.iter().filter_map(|table| table.value.clone());
        let values = values.map(AllowedText::get).collect();
        let claims = Refusal::of_each("expect", self.expect, |table| table.claimed(tolerance))?;
        let floor = self.table.floor.map_or(0.0, Positive::get);
        let scale = self.table.scale.map(Positive::get);
        let choice = self.table.choice(values).map_err(&in_table)?;
        let request = Request {
            claims,
            tolerance,
            floor,
            scale,
            choice,
            ..Request::default()
        };
        Ok(ExistingTable {
            file,
            inputs,
            request,
        })
    }
}

impl TableTable {
    /// How the table is read.
    fn choice(self, values: Vec<String>) -> Result<Choice, Refusal> {
        let samples = self.samples.map(|of| of.value);
        let others = self.floor.is_some() || self.ratio.is_some() || !values.is_empty();
        if samples.is_some() && others {
            let allowed = "samples without floor, ratio and values";
            return Err(Refusal::written("samples", allowed));
        }
        let lines = self.lines.unwrap_or_default().into_iter().enumerate();
        let lines = lines.map(|(k, text)| {
            let read: Result<LineRange, String> = text.parse();
            read.map_err(|allowed| {
                let allowed = allowed.trim_start_matches("expected ").to_owned();
                Refusal::written(format!("lines[{k}]"), allowed)
            })
        });
        Ok(Choice {
            step: self.step,
            names: self.names,
            dim: self.dim.map(Positive::get),
            ratio: self.ratio.map(Number::get),
            lines: lines.collect::<Result<_, _>>()?,
            values,
            samples,
            ..Choice::default()
        })
    }
}

impl ExpectTable {
    fn claimed(self, tolerance: Option<f64>) -> Result<Claimed, Refusal> {
        let Order { order, bound } = self.order;
        if tolerance.is_some_and(|tolerance| tolerance >= order) {
            let allowed = "an order above the tolerance";
            return Err(Refusal::written("order", allowed));
        }
        let is_value = self.value.is_some();
        let allowed = "the name of a column of errors, or `value` with that of values";
        let name = one_name(self.error, self.value, allowed)?;
        if is_value && bound != Bound::Both {
            return Err(Refusal::written("order", "an order alone, for values"));
        }
        let text = format!("{name}={}", bound.written(order));
        Ok(Claimed::new(text, Some(name), order, bound))
    }
}
