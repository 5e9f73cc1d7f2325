//! Frequencies of the beam on P1 elements against the exact ones: order 2, from above.
//!
//! Rayleigh and Ritz: the frequencies of a subspace lie above those of the beam, and their error is the square of the
//! modes' error in the energy, h². For high modes `ω_h - ω` is `ω³h²/24` to leading order.

use super::ladder::{self, Family, Ladder};
use super::{FromFile, Study};
use crate::expression::{Expression, Variable};
use crate::functions::FunctionField;
use crate::limits;
use crate::shared_tables as tables;
use crate::study::untyped::{Case, Measured};
use crate::study_file::{Axis, Header};
use convergence_study::input::{self, InputError, Section};
use convergence_study::judge::verdict::RateVerdict;
use convergence_study::study::CaseFailure;
use convergence_study::study::outcome::{Check, Outcome, Table};
use convergence_study::text::number::max_or_nan;
use std::path::Path;
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::vibration::{discrete_frequencies, frequencies};

/// The name in study files.
pub const KIND: &str = "frequencies";

/// Bound on the frequency equation at the exact frequencies, in rounding errors of its terms.
///
/// Between neighbours the determinant is of order 1, near a frequency its slope is of order 1 too: 16 of them mean 14 digits.
const ROUNDING_ERRORS: f64 = 16.0;

/// A study of frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct Frequencies {
    header: Header,
    count: usize,
    elements: Vec<usize>,
    map: Option<Expression>,
    order: f64,
    tolerance: f64,
}

impl FromFile for Frequencies {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, |root, _| Self::from_document(root))
    }
}

impl Frequencies {
    fn from_document(root: &Section<'_>) -> Result<Self, InputError> {
        root.allow(&["study", "frequencies"])?;
        let section = root.require("frequencies", "a table with count, elements, order and tolerance")?.section()?;
        section.allow(&["count", "elements", "map", "order", "tolerance"])?;
        let positive = "a finite number > 0";
        let number = |key: &str| section.require(key, positive)?.number_where(positive, |value| value > 0.0);
        let elements = increasing(&section)?;
        // A mesh has two frequencies per element, the upper ones of no use.
        let count = section.require("count", "a whole number >= 1")?.count(1..=elements[0].min(limits::MODES))?;
        let study = Self {
            header: Header::from_document(root)?,
            count,
            map: map(&section, &elements)?,
            elements,
            order: number("order")?,
            tolerance: number("tolerance")?,
        };
        Ok(study)
    }

    fn mesh(&self, elements: usize) -> Result<Mesh, MeshError> {
        Mesh::mapped(elements, |s| self.map.as_ref().map_or(s, |map| map.eval(s)))
    }

    fn ladder(&self, results: &[Result<Measured, CaseFailure>]) -> Ladder {
        let exact = frequencies(self.count);
        let error = |level: usize, mode: usize| ladder::value(results, level, &name(mode)) - exact[mode];
        let family = |mode: usize| Family {
            name: name(mode),
            errors: (0..self.elements.len()).map(|level| error(level, mode)).collect(),
            order: self.order,
            tolerance: self.tolerance,
        };
        Ladder {
            axis: Axis::Space,
            steps: self.elements.iter().map(|&n| self.mesh(n).map_or(f64::NAN, |mesh| mesh.size())).collect(),
            families: (0..self.count).map(family).collect(),
        }
    }

    fn table(&self, ladder: &Ladder, rates: &[(String, RateVerdict)]) -> Table {
        let finest = self.elements.len() - 1;
        let h = ladder.steps[finest];
        let row = |(mode, omega): (usize, f64)| {
            let (error, rate) = (ladder.families[mode].errors[finest], &rates[mode].1);
            let interval = rate.interval.map_or_else(|| "-".into(), |[low, high]| format!("{low:.4} to {high:.4}"));
            vec![
                (mode + 1).to_string(),
                format!("{omega:.11}"),
                format!("{:.11}", omega + error),
                format!("{error:.3e}"),
                format!("{:.3}", error / (omega.powi(3) * h * h / 24.0)),
                rate.fitted.map_or_else(|| "-".into(), |rate| format!("{rate:.4}")),
                interval,
                rate.verdict.to_string(),
            ]
        };
        let head = ["mode", "ω exact", "ω_h", "ω_h - ω", "over ω³h²/24", "rate", "95 % interval", "verdict"];
        Table {
            title: format!("The first {} frequencies, exact and on {} elements", self.count, self.elements[finest]),
            head: head.map(str::to_owned).into(),
            rows: frequencies(self.count).into_iter().enumerate().map(row).collect(),
        }
    }
}

fn name(mode: usize) -> String {
    format!("omega-{}", mode + 1)
}

fn increasing(section: &Section<'_>) -> Result<Vec<usize>, InputError> {
    let allowed = "a list of increasing whole numbers >= 1";
    let field = section.require("elements", allowed)?;
    let items = field.items(allowed)?;
    let elements = items.iter().map(tables::elements).collect::<Result<Vec<_>, _>>()?;
    let increases = elements.windows(2).all(|pair| pair[0] < pair[1]) && !elements.is_empty();
    if increases { Ok(elements) } else { Err(field.refuse_as_written(allowed)) }
}

fn map(section: &Section<'_>, elements: &[usize]) -> Result<Option<Expression>, InputError> {
    let Some(field) = section.get("map") else { return Ok(None) };
    let map = field.expression(Variable::S)?;
    field.finite(&map, 1.0, 0)?;
    for &elements in elements {
        tables::checked_mesh(Mesh::mapped(elements, |s| map.eval(s)), &field)?;
    }
    Ok(Some(map))
}

/// `1 + C+ C- - ω² S+ S-` at x = 1 for ω > 1, half the determinant of the boundary conditions, by plain sines.
fn determinant(omega: f64) -> f64 {
    let [plus, minus] = [omega * omega - omega, omega * omega + omega].map(f64::sqrt);
    1.0 + plus.cos() * minus.cos() - omega * omega * (plus.sin() / plus) * (minus.sin() / minus)
}

fn check_equation(count: usize) -> Check {
    let rounding = |omega: f64| determinant(omega).abs() / (f64::EPSILON * (1.0 + omega));
    let worst = frequencies(count).into_iter().map(rounding).fold(0.0, max_or_nan);
    Check::that(
        worst <= ROUNDING_ERRORS,
        "the exact frequencies solve the frequency equation 1 + C+ C- - ω² S+ S- = 0",
        format!("largest residual {worst:.1} rounding errors, allowed {ROUNDING_ERRORS}"),
    )
}

fn check_above(ladder: &Ladder) -> Check {
    let least = ladder.families.iter().flat_map(|family| &family.errors).fold(f64::INFINITY, |least, &error| {
        // A NaN must stay.
        if least.is_nan() || least <= error { least } else { error }
    });
    Check::that(
        least > 0.0,
        "every discrete frequency lies above the exact one",
        format!("the smallest ω_h - ω of all levels and modes is {least:.3e}"),
    )
}

impl Study for Frequencies {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        // Bisection to the last bit is some 60 counts for each frequency.
        let case = |&n: &usize| Case { label: format!("n = {n}"), cost: 60.0 * (n * self.count) as f64 };
        self.elements.iter().map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let found = discrete_frequencies(&self.mesh(self.elements[index])?, self.count)?;
        let mut measured = Measured::default();
        found.into_iter().enumerate().for_each(|(mode, omega)| measured.push(name(mode), omega));
        Ok(measured)
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let ladder = self.ladder(results);
        let rates = ladder.judge();
        let checks = vec![ladder::completion(&self.cases(), results), check_equation(self.count), check_above(&ladder)];
        let figure = ladder.figure(
            format!("{}-errors.svg", self.header.id),
            "Discrete frequencies, ω_h - ω",
            format!("Errors of the first {} frequencies on P1 elements over the mesh width.", self.count),
            &rates,
        );
        Outcome {
            tables: vec![self.table(&ladder, &rates)],
            figures: vec![figure],
            quantities: ladder.quantities(&rates),
            ..Outcome::new(ladder::summary(&rates), rates, checks)
        }
    }
}
