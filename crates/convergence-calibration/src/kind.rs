//! The rules that judge rates, limits and grids are judged themselves, on data whose order or limit
//! is known.
//!
//! ```toml
//! [[measure]]            # what is counted
//! of = "rule"            # the sheets of the rule, that of the limits or that of the grids
//! tables = 4             # for each law and mesh
//! seed = 7919
//!
//! [[expect]]             # one share of one sheet
//! sheet = "rules"
//! column = "wrong pass, ±0.05, 0.1 off"
//! row = "this rule"      # left out: each row for which the rule answers
//! most = 0.006           # or least = ...
//! ```

use std::path::Path;

use convergence_judge::text::number::counted;
use convergence_study::{
    Case, CaseFailure, Check, Figure, Form, FromFile, Header, InputError, Key, Keys, Kind, KindRow,
    Outcome, Quantity, Ran, Section, Subject, Table, completion_check,
    internal::{
        chart::{Axis, Chart},
        study::header::{SettingWords, study},
    },
    read_study,
};

use crate::grids::of_grids;
use crate::hidden::HIDDEN_SHARES;
use crate::noise::of_noise;
use crate::rules::{CLAIMS, Rule, hidden_part, true_pass, wrong_pass};
use crate::sheet::{Sheet, SheetRow};
use crate::{CalibrationError, ELEMENTS_OF_A_TABLE, of_the_rule};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "calibration",
    keys: Calibration::KEYS,
    read: read_study::<Calibration>,
    why: "The rules that turn errors into verdicts, and values into a limit, are applied to thousands of made-up sequences and grids whose order or limit \
          is known: pure powers, polluted by higher powers, scattered, tending to a wrong limit.",
    judged: "Counted: how often a wrong claim passes, how often a right one fails, how often an interval holds the truth. Each share has its limit.",
    failure: "The rules err more often than is admitted: no verdict, and no limit, of any other study can be trusted.",
};

/// A quantity that can be counted.
#[derive(Debug)]
struct CountedQuantity {
    /// Its name in files.
    name: &'static str,
    /// Measured cost in tables of all laws and meshes, for each of `tables`.
    cost: usize,
    /// Counts on this number of tables, drawn from a seed.
    sheets: fn(usize, u64) -> Result<Vec<Sheet>, CalibrationError>,
}

static PARTS: [CountedQuantity; 3] = [
    CountedQuantity {
        name: "rule",
        cost: 3000,
        sheets: of_the_rule,
    },
    CountedQuantity {
        name: "noise",
        cost: 6,
        sheets: of_noise,
    },
    CountedQuantity {
        name: "grids",
        cost: 8,
        sheets: of_grids,
    },
];

/// A part with the number of its tables.
#[derive(Debug, Clone, Copy)]
pub struct Measure {
    of: &'static CountedQuantity,
    tables: usize,
    seed: u64,
}

impl Measure {
    fn read(section: &Section<'_>) -> Result<Self, InputError> {
        let parts = PARTS.each_ref().map(|part| (part.name, part));
        Ok(Self {
            of: section
                .require("of", "rule, noise or grids")?
                .choice(&parts)?,
            tables: section
                .require("tables", "a number of tables")?
                .count(1..=10_000)?,
            seed: section
                .require("seed", "an integer >= 0")?
                .count(0..=usize::MAX)? as u64,
        })
    }
}

/// A share with a bound.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectedShare {
    sheet: String,
    column: String,
    row: Option<String>,
    bounds: [f64; 2],
}

impl ExpectedShare {
    fn read(section: &Section<'_>) -> Result<Self, InputError> {
        let text = |key: &str| Ok(section.require(key, "a text in quotes")?.text()?.to_owned());
        let bound =
            |key: &str, open: f64| section.get(key).map_or(Ok(open), |field| field.positive());
        if section.get("most").is_some() == section.get("least").is_some() {
            return Err(section.refuse("most", "both or none of most and least", "one of the two"));
        }
        Ok(Self {
            sheet: text("sheet")?,
            column: text("column")?,
            row: section
                .get("row")
                .map(|field| field.text().map(str::to_owned))
                .transpose()?,
            bounds: [
                bound("least", f64::NEG_INFINITY)?,
                bound("most", f64::INFINITY)?,
            ],
        })
    }

    fn checks(&self, sheets: &[Sheet]) -> Vec<Check> {
        let Self {
            sheet,
            column,
            row,
            bounds: [least, most],
        } = self;
        let sheet_of_key = sheets.iter().find(|known| known.key == sheet);
        let bound = if least.is_finite() {
            format!("at least {least}")
        } else {
            format!("at most {most}")
        };
        let mut checks = vec![];
        for known in sheet_of_key.iter().flat_map(|sheet| &sheet.rows) {
            let is_selected = match row {
                Some(name) => *name == known.name,
                None => known.declared,
            };
            if let Some(value) = known.value(column).filter(|_| is_selected) {
                let check = Check::that(
                    *least <= value && value <= *most,
                    format!("{column}: {bound}"),
                    text(value),
                );
                let case = format!("{sheet}, {}", known.name);
                checks.push(check.about(Subject::of(column).in_case(case)));
            }
        }
        if checks.is_empty() {
            let evidence = match sheet_of_key {
                Some(sheet) => format!("columns: {}", sheet.columns().join("; ")),
                None => "no such sheet".to_owned(),
            };
            let row = row.as_deref().unwrap_or("each declared");
            let claim = format!("{sheet} has {column} of {row}");
            let check = Check::that(false, claim, evidence);
            checks.push(check.about(Subject::of(column).in_case(sheet)));
        }
        checks
    }
}

/// A study of this kind.
pub struct Calibration {
    measures: Vec<Measure>,
    expected: Vec<ExpectedShare>,
}

const MEASURE: [Key; 3] = [
    Key::new(
        "of",
        Form::Choice(|| PARTS.iter().map(|part| part.name).collect()),
        "what is counted",
    ),
    Key::new("tables", Form::Count(1), "tables of each law"),
    Key::new("seed", Form::Count(0), "of their random numbers"),
];
const SHARE: [Key; 3] = [
    Key::new("sheet", Form::Text, "the sheet of the share"),
    Key::new("column", Form::Text, "its column"),
    Key::new("row", Form::Text, "its row").or("each declared row"),
];
const MOST: Key = Key::new("most", Form::Positive, "an upper bound");
const LEAST: Key = Key::new("least", Form::Positive, "a lower bound");

impl FromFile for Calibration {
    const KEYS: &'static [Keys] = &[&[&[
        Key::new(
            "measure",
            Form::List(&Form::Table(&[&[&MEASURE]])),
            "what is counted, and on how many tables",
        ),
        Key::new(
            "expect",
            Form::List(&Form::Table(&[&[&SHARE, &[MOST]], &[&SHARE, &[LEAST]]])),
            "shares with their bounds",
        ),
    ]]];

    fn from_document(_: &Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        let measures = root.tables("measure", "", Measure::read)?;
        Ok(Self {
            measures,
            expected: root.tables("expect", "", ExpectedShare::read)?,
        })
    }
}

impl Kind for Calibration {
    type Data = Measure;
    type Found = Vec<Sheet>;

    /// It puts no code but the rule to the test.
    fn settings(&self, header: &Header, _subject: &Subject) -> Vec<SettingWords> {
        vec![study(header), ("kind".to_owned(), "the harness".to_owned())]
    }

    fn cases(&self) -> Vec<Case<Measure>> {
        let mut cases = vec![];
        for &data in &self.measures {
            let Measure { of, tables, .. } = data;
            let label = format!("{}, {tables} tables of each law", of.name);
            let cost = of.cost * tables * ELEMENTS_OF_A_TABLE;
            cases.push(Case::new(label, cost as f64, data));
        }
        cases
    }

    fn run(&self, &Measure { of, tables, seed }: &Measure) -> Result<Vec<Sheet>, CaseFailure> {
        (of.sheets)(tables, seed).map_err(CaseFailure::from)
    }

    fn judge(&self, ran: &[Ran<Measure, Vec<Sheet>>]) -> Outcome {
        let sheets: Vec<Sheet> = ran.iter().filter_map(Ran::ok).flatten().cloned().collect();
        let mut checks: Vec<Check> = self
            .expected
            .iter()
            .flat_map(|expected| expected.checks(&sheets))
            .collect();
        checks.push(completion_check(ran, |_| vec![]));
        let summary = format!(
            "{} shares of {} are within their limits",
            checks.len() - 1,
            counted(sheets.len(), "sheet")
        );
        Outcome {
            tables: sheets.iter().map(table).collect(),
            figures: figures(&sheets),
            quantities: sheets.iter().flat_map(guarded).collect(),
            ..Outcome::new(summary, vec![], checks)
        }
    }
}

/// The shares that the first page of the project states: rows and columns of a sheet.
const STATED: [(&str, &[&str], &[&str]); 4] = [
    (
        "benign",
        &["4 levels", "8 levels"],
        &["true pass", "wrong pass"],
    ),
    (
        "held-out",
        &["4 levels", "8 levels", "added up to 8"],
        &["true pass", "true fail", "wrong pass"],
    ),
    (
        "noisy",
        &[
            "4 levels, noise 0 %",
            "5 levels, noise 0 %",
            "6 levels, noise 0 %",
            "8 levels, noise 0 %",
        ],
        &["hidden order passes"],
    ),
    (
        "compared",
        &[
            "this rule",
            "last pair",
            "Richardson",
            "last three slopes",
            "least squares",
            "Eça-Hoekstra",
        ],
        &["true pass", "wrong pass", "half-width"],
    ),
];

/// The shares of a sheet that the first page states.
fn stated(sheet: &Sheet) -> Vec<Quantity> {
    let mut quantities = vec![];
    for (_, rows, columns) in STATED.iter().filter(|(key, ..)| *key == sheet.key) {
        for (row, column) in rows
            .iter()
            .flat_map(|row| columns.iter().map(move |column| (row, column)))
        {
            let share = sheet.row(row).and_then(|row| row.value(column));
            let case = format!("{}, {row}", sheet.key);
            let quantity =
                Quantity::new(format!("{case}: {column}"), share.unwrap_or(f64::NAN), 0.01);
            quantities.push(quantity.about(Subject::of(*column).in_case(case)));
        }
    }
    quantities
}

/// The shares of true claims that our own rule passes, and those that the first page states. Every
/// run draws the same tables, so these shares change only with the rule. A few verdicts may differ
/// on another machine.
fn guarded(sheet: &Sheet) -> Vec<Quantity> {
    let own = sheet.row(Rule::Ours.name());
    let columns = CLAIMS.map(|(tolerance, _)| true_pass(tolerance));
    let shares = columns
        .iter()
        .filter_map(|column| Some((column, own?.value(column)?)));
    let own = shares.map(|(column, share)| {
        Quantity::new(format!("{}: {column}", sheet.key), share, 0.01)
            .about(Subject::of(column).in_case(sheet.key))
    });
    own.chain(stated(sheet)).collect()
}

fn text(value: f64) -> String {
    if value.is_nan() {
        "none".to_owned()
    } else {
        format!("{value:.4}")
    }
}

fn table(sheet: &Sheet) -> Table {
    let mut rows = vec![];
    for row in &sheet.rows {
        let mut cells = vec![if row.declared {
            row.name.clone()
        } else {
            format!("({})", row.name)
        }];
        cells.extend(row.cells.iter().map(|cell| text(cell.value())));
        rows.push(cells);
    }
    let columns = sheet.columns().into_iter().map(str::to_owned);
    let head = std::iter::once(String::new()).chain(columns);
    Table::new(&sheet.title, head, rows)
}

/// A curve for each rule of a sheet.
///
/// * `show_x`: values that the axis must contain.
/// * `points`: of the curve of a row.
fn figure(
    sheet: &Sheet,
    title: &str,
    caption: &str,
    [x, y]: [Axis; 2],
    show_x: [f64; 2],
    note: String,
    points: fn(&SheetRow) -> Vec<(f64, f64)>,
) -> Figure {
    let mut chart = Chart {
        notes: vec![note],
        ..Chart::empty(x.showing(show_x), y.showing([100.0])).titled(title)
    };
    for row in &sheet.rows {
        let curve = chart.curve(&row.name, points(row));
        *curve = curve.clone().marked();
    }
    Figure::new(sheet.key, caption, chart.svg())
}

/// True claims that pass, and wrong ones, in per cent, at each tolerance.
fn trade(row: &SheetRow) -> Vec<(f64, f64)> {
    CLAIMS
        .map(|(tolerance, off)| {
            (
                percent(row, &true_pass(tolerance)),
                percent(row, &wrong_pass(tolerance, off)),
            )
        })
        .to_vec()
}

/// A share in per cent; NaN if the row does not have it.
fn percent(row: &SheetRow, column: &str) -> f64 {
    100.0 * row.value(column).unwrap_or(f64::NAN)
}

/// Tables that pass, by the share of the hidden term, both in per cent.
fn hidden(row: &SheetRow) -> Vec<(f64, f64)> {
    HIDDEN_SHARES
        .map(|share| (100.0 * share, percent(row, &hidden_part(share))))
        .to_vec()
}

/// Wrong claims that pass over true claims that pass, for each rule, and how often a lower order
/// goes unnoticed.
fn figures(sheets: &[Sheet]) -> Vec<Figure> {
    let [first, second, third] = CLAIMS.map(|(tolerance, _)| tolerance);
    let mut figures = vec![];
    if let Some(sheet) = sheets.iter().find(|sheet| sheet.key == "rules") {
        figures.push(figure(
            sheet,
            "The rule seldom passes a wrong claim",
            "What each rule pays for the true claims it passes: wrong claims that pass, too.",
            [
                Axis::linear("true claims that pass (%)"),
                Axis::log("wrong claims that pass (%)"),
            ],
            [0.0, 100.0],
            format!(
                "tolerances {first}, {second}, {third} from left to right; better: right and down"
            ),
            trade,
        ));
    }
    if let Some(sheet) = sheets.iter().find(|sheet| sheet.key == "hidden-8") {
        figures.push(figure(
            sheet,
            "How often a table passes that hides a lower order",
            "How often a term of lower order goes unnoticed, by its share of the finest error.",
            [
                Axis::linear("share of the finest error (%)"),
                Axis::linear("tables that pass (%)"),
            ],
            [4.0, 21.0],
            "better: down".to_owned(),
            hidden,
        ));
    }
    figures
}
