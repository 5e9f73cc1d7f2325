//! Numbers that a case finds, each declared once: shown in tables, checked for NaN, guarded by the
//! baseline.

use super::outcome::{Quantity, Table};
use super::subject::Subject;
use crate::text::lists::distinct;

/// How the baseline guards a number.
#[derive(Debug, Clone, PartialEq)]
struct Guard {
    name: String,
    subject: Subject,
    /// Relative change tolerated.
    tolerance: f64,
}

/// A number that a case finds.
///
/// ```
/// use convergence_study::Reading;
///
/// // Shown as `1.25e-3` in a table, and guarded by the baseline to six digits.
/// let force = Reading::new("force", 1.25e-3).scientific(2).guarded_in("n = 64", "force", 1e-6);
/// assert_eq!(force.value, Some(1.25e-3));
/// ```
#[derive(Debug, Clone, PartialEq)]
#[must_use = "a reading counts in the tables and outcomes that hold it"]
pub struct Reading {
    /// Its name, which is the head of its column in a table.
    pub name: String,
    /// The number; `None` if it may be missing.
    pub value: Option<f64>,
    /// Its text in a table; `None` if no table shows it.
    text: Option<String>,
    /// The name under which the baseline guards it, and the relative change tolerated.
    guard: Option<Guard>,
}

impl Reading {
    /// A number that is neither shown in tables nor guarded.
    pub fn new(name: impl Into<String>, value: impl Into<Option<f64>>) -> Self {
        Self {
            name: name.into(),
            value: value.into(),
            text: None,
            guard: None,
        }
    }

    /// A cell that is not a number.
    pub fn text(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            text: Some(text.into()),
            ..Self::new(name, None)
        }
    }

    /// The same number, shown in tables; as a dash if it is missing.
    pub fn shown(self, text: impl Fn(f64) -> String) -> Self {
        Self {
            text: Some(self.value.map_or_else(|| "-".to_owned(), text)),
            ..self
        }
    }

    /// The same number, shown with this many digits after the first.
    pub fn scientific(self, digits: usize) -> Self {
        self.shown(|value| format!("{value:.digits$e}"))
    }

    /// The same number, shown with this many digits after the point.
    pub fn fixed(self, digits: usize) -> Self {
        self.shown(|value| format!("{value:.digits$}"))
    }

    /// The same number, guarded by the baseline.
    ///
    /// * `tolerance`: relative change tolerated.
    pub fn guarded(self, name: impl Into<String>, tolerance: f64) -> Self {
        let name = name.into();
        let guard = Guard {
            subject: Subject::of(&name),
            name,
            tolerance,
        };
        Self {
            guard: Some(guard),
            ..self
        }
    }

    /// The same number, guarded as this quantity of a case, under the name `case: quantity`.
    ///
    /// * `tolerance`: relative change tolerated.
    pub fn guarded_in(
        self,
        case: impl Into<String>,
        quantity: impl Into<String>,
        tolerance: f64,
    ) -> Self {
        let case = case.into();
        let quantity = quantity.into();
        let guard = Guard {
            name: format!("{case}: {quantity}"),
            subject: Subject::of(quantity).in_case(case),
            tolerance,
        };
        Self {
            guard: Some(guard),
            ..self
        }
    }

    /// The number that the baseline guards, NaN without a value; `None` if it guards none.
    fn quantity(&self) -> Option<Quantity> {
        let Guard {
            name,
            subject,
            tolerance,
        } = self.guard.clone()?;
        let value = self.value.unwrap_or(f64::NAN);
        Some(Quantity::new(name, value, tolerance).about(subject))
    }

    /// The guarded number is about this subject.
    pub fn about(mut self, subject: Subject) -> Self {
        if let Some(guard) = &mut self.guard {
            guard.subject = subject;
        }
        self
    }
}

/// Names of the readings that are NaN or infinite, for
/// [`completion_check`](super::kind::completion_check).
pub fn not_finite(readings: &[Reading]) -> Vec<String> {
    let broken = readings
        .iter()
        .filter(|reading| reading.value.is_some_and(|value| !value.is_finite()));
    broken.map(|reading| reading.name.clone()).collect()
}

/// The readings that the baseline guards; one without a value is NaN.
pub fn guarded<'r>(readings: impl IntoIterator<Item = &'r Reading>) -> Vec<Quantity> {
    readings.into_iter().filter_map(Reading::quantity).collect()
}

/// The readings that are shown, one column each; a dash for a missing one.
///
/// * `rows`: the leading cells of a row, which are not readings, and its readings.
pub fn table(
    title: impl Into<String>,
    first: &[&str],
    rows: &[(Vec<String>, Vec<Reading>)],
) -> Table {
    let with_text = rows
        .iter()
        .flat_map(|(_, readings)| readings)
        .filter(|reading| reading.text.is_some());
    let names = distinct(with_text.map(|reading| reading.name.as_str()));
    let rows = rows.iter().map(|(first, readings)| {
        let mut row = first.clone();
        row.extend(names.iter().map(|name| cell(readings, name)));
        row
    });
    Table::new(title, first.iter().chain(&names).copied(), rows)
}

/// The text of the reading of that name; a dash for a missing one.
fn cell(readings: &[Reading], name: &str) -> String {
    let reading = readings.iter().find(|reading| reading.name == name);
    let text = reading.and_then(|reading| reading.text.clone());
    text.unwrap_or_else(|| "-".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_declaration_gives_completion_table_and_guarded_numbers() {
        let readings = |force: f64, time: Option<f64>| {
            let force = Reading::new("force", force)
                .scientific(1)
                .guarded("peak", 1e-6);
            vec![
                force,
                Reading::new("time", time).fixed(2),
                Reading::new("size", f64::NAN),
            ]
        };
        let rows = [
            (vec!["a".to_owned()], readings(0.25, None)),
            (vec!["b".to_owned()], readings(f64::NAN, Some(1.0))),
            (vec!["c".to_owned()], vec![Reading::text("end", "rest")]),
        ];
        let table = table("t", &["case"], &rows);
        assert_eq!(table.head, ["case", "force", "time", "end"]);
        assert_eq!(
            table.rows,
            [
                ["a", "2.5e-1", "-", "-"],
                ["b", "NaN", "1.00", "-"],
                ["c", "-", "-", "rest"]
            ]
        );
        assert_eq!(not_finite(&rows[0].1), ["size"]);
        assert_eq!(not_finite(&rows[1].1), ["force", "size"]);
        assert_eq!(guarded(&rows[0].1), [Quantity::new("peak", 0.25, 1e-6)]);
        assert!(
            guarded([&Reading::new("x", None).guarded("x", 0.1)])[0]
                .value
                .is_nan()
        );
    }
}
