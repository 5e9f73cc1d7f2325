//! The table `[refine]`: the resolutions at which a program is run.

use crate::input::{Field, Form, InputError, Key, Keys, Section};
use crate::study::{Axis, Refinement, until_decided};
use crate::text::named::NamedNumber;

/// The keys of the table: a list in space, or in time, or one of each.
pub(super) const KEYS: &[Keys] = &[
    &[&[N], &TIME, &LEVELS],
    &[&[H], &TIME, &LEVELS],
    &[&[STEPS], &LEVELS],
    &[&[DT], &LEVELS],
];
const COUNTED: Form = Form::OneOf(&[Form::List(&Form::Count(1)), Form::Choice(|| vec!["auto"])]);
const N: Key = Key::new(
    "n",
    COUNTED,
    "cells, increasing: h = 1/n; `\"auto\"`: doubled until it is decided",
);
const H: Key = Key::new("h", Form::List(&Form::Positive), "mesh widths, decreasing");
const STEPS: Key = Key::new(
    "steps",
    COUNTED,
    "time steps, increasing: dt = 1/steps; `\"auto\"` as for n",
);
const DT: Key = Key::new(
    "dt",
    Form::List(&Form::Positive),
    "lengths of time steps, decreasing",
);
const TIME: [Key; 2] = [STEPS.or(""), DT.or("")];
const LEVELS: [Key; 2] = [
    Key::new(
        "grid",
        Form::Boolean,
        "all pairs of a list in space and one in time, instead of both together",
    )
    .or("false"),
    Key::new(
        "budget",
        Form::Positive,
        "with `\"auto\"`: seconds for all levels",
    )
    .or("60"),
];

/// A number passed to a case, by its name.
pub(crate) type CaseParameter = (&'static str, f64);

/// Largest count of cells or steps: up to it every whole number is a floating-point number.
const LARGEST_COUNT: usize = 1 << 53;

/// Most cases of a study: each is a process.
const MOST_CASES: usize = 10_000;

/// Default time in seconds for the levels of a study that adds levels.
pub(super) const BUDGET: f64 = 60.0;

/// Values of one parameter, coarse to fine.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sequence {
    /// `n` or `h` in space, `steps` or `dt` in time.
    name: &'static str,
    values: Vec<f64>,
}

impl Sequence {
    fn is_count(&self) -> bool {
        matches!(self.name, "n" | "steps")
    }

    /// The step of a value: itself, or one over the count.
    fn step(&self, value: f64) -> f64 {
        if self.is_count() { 1.0 / value } else { value }
    }

    /// The parameters of one value: itself and, for a count, the nominal step.
    fn parameters(&self, value: f64) -> Vec<CaseParameter> {
        match self.name {
            "n" => vec![("n", value), ("h", 1.0 / value)],
            "steps" => vec![("steps", value), ("dt", 1.0 / value)],
            name => vec![(name, value)],
        }
    }
}

/// The sequences to refine; at least one of the two.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Refine {
    pub(super) space: Option<Sequence>,
    pub(super) time: Option<Sequence>,
    /// All pairs, instead of both refined together.
    pub(super) grid: bool,
    /// Levels are added until there is a decision, for at most this many seconds.
    pub(super) budget: Option<f64>,
}

/// One case: its identification, and what its program receives.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RefinedCase {
    /// As in `[refine]`, such as `n = 8`.
    pub label: String,
    /// The values listed in `[refine]`.
    pub listed: Vec<CaseParameter>,
    /// These, the nominal steps of counts, and the number of the case.
    pub parameters: Vec<CaseParameter>,
    /// Nominal mesh width, or NaN.
    pub h: f64,
    /// Nominal time step, or NaN.
    pub dt: f64,
}

impl Refine {
    /// The refined quantity, for figures.
    pub(super) fn axis(&self) -> Axis {
        match (&self.space, &self.time) {
            (Some(_), Some(_)) => Axis::Both,
            (None, Some(_)) => Axis::Time,
            _ => Axis::Space,
        }
    }

    /// Whether a level can follow the last: counts are doubled, along one path.
    pub(super) fn can_add(&self) -> bool {
        let mut sequences = [&self.space, &self.time].into_iter().flatten();
        !self.grid && sequences.all(Sequence::is_count)
    }

    /// The number of time steps.
    pub(super) fn times(&self) -> usize {
        self.time.as_ref().map_or(0, |time| time.values.len())
    }

    /// The level after `level` of a study that adds levels: counts are doubled.
    pub(super) fn finer(&self, level: &RefinedCase, index: usize) -> RefinedCase {
        let doubled = |sequence: &Option<Sequence>, step: f64| {
            sequence.as_ref().map(|_| (2.0 / step).round())
        };
        self.resolution(
            index,
            doubled(&self.space, level.h),
            doubled(&self.time, level.dt),
        )
    }

    /// All cases, coarse to fine; for a grid the time steps run fastest.
    pub(super) fn resolutions(&self) -> Vec<RefinedCase> {
        let values = |sequence: &Option<Sequence>| match sequence {
            Some(sequence) => sequence.values.iter().copied().map(Some).collect(),
            None => vec![None],
        };
        let space = values(&self.space);
        let time = values(&self.time);
        let together = !self.grid && space.len() == time.len();
        let pairs: Vec<_> = if together {
            space.into_iter().zip(time).collect()
        } else {
            space
                .iter()
                .flat_map(|&h| time.iter().map(move |&dt| (h, dt)))
                .collect()
        };
        pairs
            .into_iter()
            .enumerate()
            .map(|(level, (h, dt))| self.resolution(level, h, dt))
            .collect()
    }

    fn resolution(&self, level: usize, in_space: Option<f64>, in_time: Option<f64>) -> RefinedCase {
        let given = [(&self.space, in_space), (&self.time, in_time)];
        let given: Vec<_> = given
            .into_iter()
            .filter_map(|(sequence, value)| sequence.as_ref().zip(value))
            .collect();
        let listed: Vec<CaseParameter> = given
            .iter()
            .map(|(sequence, value)| (sequence.name, *value))
            .collect();
        let mut parameters: Vec<CaseParameter> = given
            .iter()
            .flat_map(|(sequence, value)| sequence.parameters(*value))
            .collect();
        parameters.push(("level", level as f64));
        let step = |sequence: &Option<Sequence>, value: Option<f64>| {
            sequence
                .as_ref()
                .zip(value)
                .map_or(f64::NAN, |(sequence, value)| sequence.step(value))
        };
        let label: Vec<String> = listed
            .iter()
            .map(|(name, value)| format!("{name} = {value}"))
            .collect();
        RefinedCase {
            label: label.join(", "),
            listed,
            parameters,
            h: step(&self.space, in_space),
            dt: step(&self.time, in_time),
        }
    }
}

impl RefinedCase {
    /// Estimate of the cost: the number of cells and steps, up to factors.
    pub(super) fn cost(&self) -> f64 {
        [self.h, self.dt]
            .into_iter()
            .filter(|step| step.is_finite())
            .map(|step| 1.0 / step)
            .product()
    }

    /// The level that the errors of this case belong to.
    pub(super) fn refinement(&self, step: f64) -> Refinement {
        let parameters = self
            .listed
            .iter()
            .map(|(name, value)| NamedNumber::new(*name, *value))
            .collect();
        Refinement {
            label: self.label.clone(),
            parameters,
            step,
        }
    }

    /// Everything that the program receives, as one JSON object on one line; whole numbers have no
    /// decimal point.
    pub(super) fn json(&self) -> String {
        let entries: Vec<String> = self
            .parameters
            .iter()
            .map(|(name, value)| format!("\"{name}\": {value}"))
            .collect();
        format!("{{{}}}\n", entries.join(", "))
    }
}

/// Reads `[refine]`.
pub(super) fn refine(root: &Section<'_>) -> Result<Refine, InputError> {
    let lists = "a list n or h, and dt or steps where time is refined";
    let section = root
        .require("refine", &format!("a table with {lists}"))?
        .section()?;
    let space = one_of(&section, "n", "h")?;
    let time = one_of(&section, "steps", "dt")?;
    let grid = section
        .get("grid")
        .map_or(Ok(false), |field| field.boolean())?;
    let lengths =
        [&space, &time].map(|sequence| sequence.as_ref().map(|sequence| sequence.values.len()));
    match (lengths, grid) {
        ([None, None], _) => return Err(section.missing("n", lists)),
        ([Some(h), Some(dt)], false) if h != dt => {
            let key = time.as_ref().map_or("dt", |time| time.name);
            let found = format!("{dt} values beside {h}");
            return Err(section.refuse(
                key,
                found,
                "lists of the same length, or grid = true for all pairs",
            ));
        }
        ([Some(h), Some(dt)], true) if h.saturating_mul(dt) > MOST_CASES => {
            return Err(section.refuse(
                "grid",
                format!("{h} times {dt} cases"),
                format!("at most {MOST_CASES}"),
            ));
        }
        ([Some(_), None] | [None, Some(_)], true) => {
            return Err(section.refuse(
                "grid",
                "true beside one list",
                "true only with a list in space and one in time",
            ));
        }
        _ => {}
    }
    let budget = until_decided::budget(
        &section,
        &["n", "steps"],
        grid,
        BUDGET,
        "a number of seconds > 0",
    )?;
    Ok(Refine {
        space,
        time,
        grid,
        budget,
    })
}

/// The list under one of two names, from coarse to fine: increasing counts, or decreasing steps;
/// using both names is refused.
fn one_of(
    section: &Section<'_>,
    count: &'static str,
    step: &'static str,
) -> Result<Option<Sequence>, InputError> {
    const COUNTS: &str = "a list of increasing whole numbers >= 1, or \"auto\"";
    let number = |item: &Field<'_>| Ok(item.count(1..=LARGEST_COUNT)? as f64);
    let positive = |item: &Field<'_>| {
        item.number_where("a number > 0", |value| {
            value > 0.0 && value.recip().is_finite()
        })
    };
    let (field, name, values) = match (section.get(count), section.get(step)) {
        (None, None) => return Ok(None),
        (Some(_), Some(field)) => {
            return Err(field.refuse(
                format!("{step} beside {count}"),
                format!("one of the two: {count} or {step}"),
            ));
        }
        (Some(field), None) if until_decided::is_auto(&field) => (
            field,
            count,
            until_decided::FIRST.map(|count| count as f64).into(),
        ),
        (Some(field), None) if field.items(COUNTS)?.is_empty() => {
            return Err(field.refuse_as_written(COUNTS));
        }
        (Some(field), None) => (field, count, section.increasing(count, 1, number)?),
        (None, Some(field)) => (field, step, section.decreasing(step, 1, positive)?),
    };
    if values.len() > MOST_CASES {
        return Err(field.refuse(
            format!("{} values", values.len()),
            format!("at most {MOST_CASES}"),
        ));
    }
    Ok(Some(Sequence { name, values }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::parse;

    fn read(text: &str) -> Result<Refine, String> {
        let read = |root: &Section<'_>| {
            root.section("refine")?
                .map_or(Ok(()), |section| section.allow_only(&[], KEYS))?;
            refine(root)
        };
        parse(&format!("[refine]\n{text}\n"), "a.toml", read).map_err(|error| error.to_string())
    }

    fn parameters(text: &str) -> Vec<String> {
        read(text)
            .unwrap()
            .resolutions()
            .iter()
            .map(|case| case.json().trim().to_owned())
            .collect()
    }

    #[test]
    fn a_case_is_told_its_values_and_the_nominal_steps_of_counts() {
        assert_eq!(
            parameters("n = [8, 16]")[1],
            r#"{"n": 16, "h": 0.0625, "level": 1}"#
        );
        assert_eq!(
            parameters("h = [0.5, 1e-7]")[1],
            r#"{"h": 0.0000001, "level": 1}"#
        );
        assert_eq!(
            parameters("steps = [4]"),
            [r#"{"steps": 4, "dt": 0.25, "level": 0}"#]
        );
        let both = parameters("h = [0.5, 0.25]\ndt = [0.1, 0.05]");
        assert_eq!(
            both,
            [
                r#"{"h": 0.5, "dt": 0.1, "level": 0}"#,
                r#"{"h": 0.25, "dt": 0.05, "level": 1}"#
            ]
        );
        let grid = read("n = [2, 4]\ndt = [0.1, 0.05, 0.01]\ngrid = true")
            .unwrap()
            .resolutions();
        let labels: Vec<_> = grid.iter().map(|case| case.label.as_str()).collect();
        assert_eq!(
            labels[..4],
            [
                "n = 2, dt = 0.1",
                "n = 2, dt = 0.05",
                "n = 2, dt = 0.01",
                "n = 4, dt = 0.1"
            ]
        );
        assert_eq!((grid.len(), grid[3].cost()), (6, 40.0));
    }

    #[test]
    fn what_is_no_refinement_is_refused_with_its_line() {
        for (text, message) in [
            ("", "a.toml:1:1: refine.n: missing; expected a list n or h"),
            (
                "n = []",
                "a.toml:2:5: refine.n: found the list []; expected a list of increasing whole numbers >= 1",
            ),
            ("n = 8", "a.toml:2:5: refine.n: found 8; expected a list"),
            (
                "n = [8, 8]",
                "a.toml:2:9: refine.n[1]: found 8; expected a number > 8, the level before",
            ),
            (
                "n = [0, 8]",
                "a.toml:2:6: refine.n[0]: found 0; expected a whole number >= 1",
            ),
            (
                "h = [0.1, 0.2]",
                "refine.h[1]: found 0.2; expected a number < 0.1, the level before",
            ),
            ("h = [inf]", "refine.h[0]: found inf; expected a number > 0"),
            (
                "n = [8]\nh = [0.1]",
                "refine.h: found h beside n; expected one of the two: n or h",
            ),
            (
                "n = [8]\ndt = [0.1, 0.01]",
                "refine.dt: found 2 values beside 1; expected lists of the same length",
            ),
            (
                "n = [8]\ngrid = true",
                "refine.grid: found true beside one list",
            ),
            ("n = [8]\nlevels = 3", "unknown key `levels`"),
        ] {
            let found = read(text).unwrap_err();
            assert!(found.contains(message), "{found}");
        }
    }
}
