//! The check: what is right, what is wrong, and what a test with this solution would not notice.

mod approach;
mod blindness;
mod descent;
mod domain;
pub(crate) mod emitted;
mod general;
pub(crate) mod margin;
mod parameters;
mod reach;
pub(crate) mod second_way;
mod surface;
mod symmetry;
mod terms;
mod unseen;

use serde::Serialize;

use crate::arithmetic::NodeId;
use crate::arithmetic::SAME;
use crate::arithmetic::tape::SizedValue;
use crate::derive::{DerivedQuantity, Part, Role, components};
use crate::manufacture::Sampling;
use crate::model::Model;
use crate::problem::InputError;
use crate::sample::Sampler;

/// A condition may be missed by this times the size.
const CONDITION: f64 = 1e-12;

/// Points of each part of the domain where values are computed a second way.
const SECOND_WAY: usize = 200;

/// Those of a variant, which has the operators of its file.
const SECOND_WAY_OF_VARIANTS: usize = 40;

/// Something that the check found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// A word for programs.
    pub code: &'static str,
    /// The path of a key of the file.
    #[serde(rename = "where")]
    pub key: String,
    /// In words.
    pub text: String,
    /// The number that the finding is about.
    pub value: Option<f64>,
    /// It fails the check; otherwise it is a note.
    #[serde(skip)]
    pub fails: bool,
}

impl Finding {
    /// Whether it is the same thing about the same key.
    fn is_like(&self, other: &Self) -> bool {
        self.code == other.code && self.key == other.key
    }
}

/// How much each term of an equation contributes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Share {
    /// The equation.
    pub equation: String,
    /// The term.
    pub term: String,
    /// Its root mean square over that of the largest term of the equation.
    pub share: f64,
}

/// The result of a check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// `pass` or `fail`.
    pub verdict: &'static str,
    /// What was found, failures first.
    pub findings: Vec<Finding>,
    /// The shares of all terms.
    pub shares: Vec<Share>,
    /// The points at which poles and ends of the domain were looked for.
    pub domain_points: usize,
}

impl Check {
    /// Adds findings, and takes them into account in the verdict; with `is_strict` notes fail, too.
    pub fn add(&mut self, findings: Vec<Finding>, is_strict: bool) {
        self.findings.extend(findings);
        self.findings.sort_by_key(|finding| !finding.fails);
        let mut findings = self.findings.iter();
        let fails = findings.any(|finding| finding.fails || is_strict);
        self.verdict = if fails { "fail" } else { "pass" };
    }
}

/// The quantities of a part at its points.
pub(crate) struct Sampled<'m> {
    pub(crate) part: Part,
    pub(crate) quantities: &'m [DerivedQuantity<NodeId>],
    pub(crate) points: Vec<Vec<f64>>,
    /// For each point, for each quantity, its components.
    pub(crate) values: Vec<Vec<Vec<SizedValue>>>,
}

impl<'m> Sampled<'m> {
    pub(crate) fn new(model: &'m Model, part: Part, points: Vec<Vec<f64>>) -> Self {
        let quantities = model.part(part);
        let rows = model.rows(quantities);
        Self {
            part,
            quantities,
            values: points.iter().map(|point| rows.at(point).tensors).collect(),
            points,
        }
    }

    /// The values of a quantity over the points.
    pub(crate) fn over(&self, index: usize) -> impl Iterator<Item = (&[f64], &[SizedValue])> {
        let points = self.points.iter().zip(&self.values);
        points.map(move |(point, values)| (point.as_slice(), values[index].as_slice()))
    }
}

/// Whether it is zero but for rounding.
pub(crate) fn is_zero(values: &[SizedValue]) -> bool {
    values.iter().all(|v| v.value.abs() <= SAME * v.size)
}

/// Whether two values are equal but for rounding.
pub(crate) fn is_same(a: &SizedValue, b: &SizedValue) -> bool {
    (a.value - b.value).abs() <= SAME * a.size.max(b.size)
}

/// A model at its points, and what makes it wrong.
struct Judged<'m> {
    sampler: Sampler<'m>,
    /// The parts whose values are finite.
    regular: Vec<Sampled<'m>>,
    findings: Vec<Finding>,
    domain_points: usize,
}

/// What is wrong with a variant at so many points of each part: failures, and notes on its domain.
///
/// # Errors
/// A pole, and a part without points.
pub(crate) fn failures(model: &Model, sampling: &Sampling) -> Result<Vec<Finding>, InputError> {
    Ok(judged(model, sampling, SECOND_WAY_OF_VARIANTS)?.findings)
}

/// * `second`: points of each part where values are computed a second way.
fn judged<'m>(
    model: &'m Model,
    sampling: &Sampling,
    second: usize,
) -> Result<Judged<'m>, InputError> {
    let Sampling { seed, points, .. } = *sampling;
    let mut sampler = Sampler::new(model, seed);
    let domain::Examined {
        mut findings,
        points: domain_points,
    } = domain::examine(model, seed)?;
    let mut regular = vec![];
    for (part, _) in &model.parts {
        // Data that depend on nothing need no more points than others: one rule for all.
        let sampled = Sampled::new(model, *part, sampler.points(*part, points)?);
        let singular = singular(model, &sampled);
        if singular.is_empty() {
            findings.extend(second_way::compare(model, &sampled, second)?);
            findings.extend(conditions(model, &sampled));
            findings.extend(not_zero(model, &sampled));
            regular.push(sampled);
        } else {
            let is_new = |new: &Finding| !findings.iter().any(|known| known.is_like(new));
            let new: Vec<Finding> = singular.into_iter().filter(is_new).collect();
            findings.extend(new);
        }
    }
    Ok(Judged {
        sampler,
        regular,
        findings,
        domain_points,
    })
}

/// Checks a model at so many points of each part.
pub(crate) fn check(model: &Model, sampling: &Sampling) -> Result<Check, InputError> {
    let Judged {
        mut sampler,
        regular,
        mut findings,
        domain_points,
    } = judged(model, sampling, SECOND_WAY)?;
    let mut shares = vec![];
    for sampled in &regular {
        if sampled.part == Part::Interior {
            findings.extend(blindness::interior(model, sampled));
            findings.extend(surface::sources(model, sampled, &sampler));
            findings.extend(symmetry::symmetric(model, sampled));
            let terms = terms::of_equations(model, sampled);
            findings.extend(terms.findings);
            shares = terms.shares;
        } else {
            findings.extend(blindness::data(model, sampled));
        }
    }
    findings.extend(parameters::unseen(model, &regular));
    findings.extend(reach::unreached(model, &regular));
    findings.extend(blindness::switches(model, &mut sampler));
    findings.extend(blindness::initial_mismatch(model, &mut sampler)?);
    let mut check = Check {
        verdict: "pass",
        findings: vec![],
        shares,
        domain_points,
    };
    check.add(findings, sampling.is_strict);
    Ok(check)
}

pub(crate) fn finding(code: &'static str, key: &str, text: String, value: Option<f64>) -> Finding {
    let fails = matches!(
        code,
        "second-way" | "emitted" | "condition-violated" | "not-positive" | "not-zero" | "singular"
    );
    Finding {
        code,
        key: key.to_owned(),
        text,
        value,
        fails,
    }
}

fn singular(model: &Model, sampled: &Sampled<'_>) -> Vec<Finding> {
    let mut findings = vec![];
    for (index, quantity) in sampled.quantities.iter().enumerate() {
        let mut entries = sampled.over(index);
        let worst = entries.find(|entry| entry.1.iter().any(|v| !v.value.is_finite()));
        if let Some((point, values)) = worst {
            let names = components(&model.problem, &quantity.name, &quantity.tensor.shape);
            let mut pairs = names.iter().zip(values);
            let Some((name, value)) = pairs.find(|pair| !pair.1.value.is_finite()) else {
                continue;
            };
            let what = role_words(quantity.role);
            let at = model.place_in_words(point);
            let text = format!("{what} {name} is {} at {at}", value.value);
            findings.push(finding("singular", &quantity.place.key, text, None));
        }
    }
    findings
}

pub(crate) fn role_words(role: Role) -> &'static str {
    match role {
        Role::Exact => "the exact",
        Role::Gradient => "the gradient of",
        Role::Source => "the source",
        Role::Positive | Role::Zero => "the required",
        Role::Level => "the level",
        Role::Normal => "the normal of",
        Role::Datum => "the datum",
        Role::Condition | Role::InitialCondition => "the value required of",
        Role::Initial => "the initial",
        Role::Definition => "the definition",
        Role::Term => "the term",
        Role::Sources => "the sources",
    }
}

/// A datum that is not the value that it must have.
struct Violation<'s> {
    quantity: &'s DerivedQuantity<NodeId>,
    difference: f64,
    point: &'s [f64],
}

/// Data that differ from the values that they must have, each where it differs most.
fn violations<'s>(sampled: &'s Sampled<'_>) -> Vec<Violation<'s>> {
    let mut violations = vec![];
    for (index, quantity) in sampled.quantities.iter().enumerate() {
        if !matches!(quantity.role, Role::Condition | Role::InitialCondition) {
            continue;
        }
        // The datum follows its condition.
        let mut worst: Option<Violation<'_>> = None;
        for ((point, expected), (_, found)) in sampled.over(index).zip(sampled.over(index + 1)) {
            for (expected, found) in expected.iter().zip(found) {
                let difference = (expected.value - found.value).abs();
                let is_wrong = difference > CONDITION * (expected.size + found.size);
                if is_wrong
                    && worst
                        .as_ref()
                        .is_none_or(|known| difference > known.difference)
                {
                    worst = Some(Violation {
                        quantity,
                        difference,
                        point,
                    });
                }
            }
        }
        violations.extend(worst);
    }
    violations
}

fn conditions(model: &Model, sampled: &Sampled<'_>) -> Vec<Finding> {
    let violations = violations(sampled).into_iter();
    let findings = violations.map(|violation| {
        let Violation {
            quantity,
            difference,
            point,
        } = violation;
        let at = model.place_in_words(point);
        let text = format!("differs from its `is` by {difference:.3e} at {at}");
        let key = &quantity.place.key;
        finding("condition-violated", key, text, Some(difference))
    });
    findings.collect()
}

/// What must be zero, and is not.
fn not_zero(model: &Model, sampled: &Sampled<'_>) -> Vec<Finding> {
    let mut findings = vec![];
    for (index, quantity) in sampled.quantities.iter().enumerate() {
        let mut entries = sampled.over(index);
        if quantity.role == Role::Zero
            && let Some((point, values)) = entries.find(|entry| !is_zero(entry.1))
        {
            let name = &quantity.name;
            let value = values.iter().map(|v| v.value.abs()).fold(0.0, f64::max);
            let at = model.place_in_words(point);
            let text = format!("`{name}` is {value:.3e} at {at}; required to be zero");
            findings.push(finding("not-zero", &quantity.place.key, text, Some(value)));
        }
    }
    findings
}
