//! The budget as a table, and what to refine next.

use std::fmt;

use convergence_study::text::number::max_or_nan;
use serde::ser::{Serialize, SerializeStruct, Serializer};

use super::{Budget, Estimate, Source};

/// In the JSON object of a run: what dominates, the advice, and one object for each number; names are a contract.
impl Serialize for Budget {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Budget", 3)?;
        object.serialize_field("dominant", &self.dominant().map(Source::name))?;
        object.serialize_field("advice", &self.advice())?;
        object.serialize_field("quantities", &self.estimates)?;
        object.end()
    }
}

impl Serialize for Estimate {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Estimate", 7)?;
        object.serialize_field("name", self.name)?;
        object.serialize_field("value", &self.value)?;
        for source in Source::ALL {
            object.serialize_field(source.key(), &self.error(source))?;
        }
        object.serialize_field("total", &self.total())?;
        object.end()
    }
}

impl Budget {
    /// The source that carries the largest share of the errors, all numbers counting alike; `None` if all errors are zero
    /// or one is NaN.
    pub fn dominant(&self) -> Option<Source> {
        let share = |source: Source| -> f64 {
            let of = |estimate: &Estimate| {
                let total = estimate.total();
                if total == 0.0 { 0.0 } else { estimate.error(source) / total }
            };
            self.estimates.iter().map(of).sum()
        };
        let shares = Source::ALL.map(share);
        let largest = shares.iter().copied().fold(0.0, max_or_nan);
        if !(largest > 0.0) {
            return None;
        }
        Source::ALL.into_iter().zip(shares).find(|(_, share)| *share == largest).map(|(source, _)| source)
    }

    /// What to refine next, in a sentence.
    pub fn advice(&self) -> String {
        match self.dominant() {
            Some(Source::Space) => "The mesh dominates: twice the elements leave a quarter of the error.".into(),
            Some(Source::Time) if self.time_order > 1.0 => {
                "The time step dominates: half of it leaves a quarter of the error.".into()
            }
            Some(Source::Time) => {
                "The time step dominates: half of it leaves half of the error; the scheme \"midpoint\" may leave far less.".into()
            }
            Some(Source::Iteration) => "The iteration dominates: take a smaller tolerance.".into(),
            Some(Source::RoundOff) => "Round-off dominates: nothing is left to refine.".into(),
            None => "No error was found that could be told from zero.".into(),
        }
    }
}

impl fmt::Display for Budget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [elements, steps] = self.resolution;
        writeln!(f, "Estimated errors of {}: {elements} elements, {steps} time steps", self.scene)?;
        if self.measured != self.resolution {
            writeln!(f, "(values of {} elements and {} time steps)", self.measured[0], self.measured[1])?;
        }
        let head = ["", "value", "space", "rate", "time", "rate", "iteration", "round-off", "total", "mostly"];
        let rows: Vec<[String; 10]> =
            std::iter::once(head.map(str::to_owned)).chain(self.estimates.iter().map(row)).collect();
        let widths: [usize; 10] =
            std::array::from_fn(|k| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0));
        for row in &rows {
            let cells = row.iter().zip(widths).enumerate().map(|(k, (cell, width))| match k {
                0 | 9 => format!("{cell:<width$}"),
                _ => format!("{cell:>width$}"),
            });
            writeln!(f, "{}", cells.collect::<Vec<_>>().join("  ").trim_end())?;
        }
        write!(f, "{}", self.advice())
    }
}

fn row(estimate: &Estimate) -> [String; 10] {
    let error = |source| format!("{:.1e}", estimate.error(source));
    let rate = |k: usize| estimate.rates[k].map_or_else(|| "-".to_owned(), |rate| format!("{rate:.2}"));
    [
        estimate.name.to_owned(),
        format!("{:.8}", estimate.value),
        error(Source::Space),
        rate(0),
        error(Source::Time),
        rate(1),
        error(Source::Iteration),
        error(Source::RoundOff),
        format!("{:.1e}", estimate.total()),
        estimate.dominant().name().to_owned(),
    ]
}
