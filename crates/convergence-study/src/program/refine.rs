//! The table `[refine]`: the resolutions at which a program is run.

use schemars::JsonSchema;
use serde::Deserialize;

use super::launch::CaseParameter;
use crate::input::{Count, Counts, Positive, Refusal};
use crate::study::sampled::Sampled;
use crate::study::{Budget, RefinedIn, Refinement};
use crate::text::named::NamedNumber;
use convergence_judge::verdict::FEWEST_NUMBERS;

/// The table `[refine]`: a list in space, or in time, or one of each.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RefineTable {
    /// cells, increasing: h = 1/n; "auto": doubled until it is decided
    #[schemars(extend("title" = COUNTS))]
    n: Option<Counts<Whole>>,
    /// mesh widths, decreasing, in place of n
    #[schemars(extend("title" = "a list of decreasing numbers > 0"))]
    h: Option<Vec<Positive>>,
    /// time steps, increasing: dt = 1/steps; "auto" as for n
    #[schemars(extend("title" = COUNTS))]
    steps: Option<Counts<Whole>>,
    /// lengths of time steps, decreasing, in place of steps
    #[schemars(extend("title" = "a list of decreasing numbers > 0"))]
    dt: Option<Vec<Positive>>,
    /// all pairs of a list in space and one in time, instead of both together
    #[serde(default)]
    grid: bool,
    /// how often each level is run, each time with another `{seed}`: 1, 2, 3, ..., the same on all
    /// levels
    samples: Option<Count<FEWEST_NUMBERS, MOST_CASES>>,
    /// with "auto": seconds for all levels; without it 60
    #[schemars(extend("title" = "a number of seconds > 0"))]
    budget: Option<Positive>,
}

const COUNTS: &str = "a list of increasing whole numbers >= 1, or \"auto\"";

/// A count; up to the largest every whole number is a floating-point number.
type Whole = Count<1, { 1 << 53 }>;

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
    /// How many samples make a level.
    pub(super) samples: Option<usize>,
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
    pub(super) fn axis(&self) -> RefinedIn {
        match (&self.space, &self.time) {
            (Some(_), Some(_)) => RefinedIn::Both,
            (None, Some(_)) => RefinedIn::Time,
            _ => RefinedIn::Space,
        }
    }

    /// Whether a level can follow the last: counts are doubled, along one path.
    pub(super) fn can_add(&self) -> bool {
        let mut sequences = [&self.space, &self.time].into_iter().flatten();
        !self.grid && self.samples.is_none() && sequences.all(Sequence::is_count)
    }

    /// The same, beginning with levels that suit the fastest error, if the levels are left to the
    /// study.
    ///
    /// * `error`: at a count, in units of its constant.
    pub(super) fn beginning_for(mut self, error: impl Fn(f64) -> f64) -> Self {
        if self.budget.is_some() {
            let first = Budget::first_levels(error).map(|count| count as f64);
            for sequence in [&mut self.space, &mut self.time].into_iter().flatten() {
                sequence.values = first.into();
            }
        }
        self
    }

    /// The number of time steps.
    pub(super) fn times(&self) -> usize {
        self.time.as_ref().map_or(0, |time| time.values.len())
    }

    /// The level after `level` of a study that adds levels: counts are doubled.
    pub(super) fn finer(&self, level: &RefinedCase, index: usize) -> RefinedCase {
        let space = self.space.as_ref().map(|_| (2.0 / level.h).round());
        let time = self.time.as_ref().map(|_| (2.0 / level.dt).round());
        self.resolution(index, space, time)
    }

    /// All cases, coarse to fine; for a grid the time steps run fastest.
    pub(super) fn resolutions(&self) -> Vec<RefinedCase> {
        let [space, time] = [&self.space, &self.time].map(|sequence| match sequence {
            Some(sequence) => sequence.values.iter().copied().map(Some).collect(),
            None => vec![None],
        });
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

    /// The runs: of each resolution, coarse to fine, each of its samples.
    pub(super) fn cases(&self) -> Vec<RefinedCase> {
        let resolutions = self.resolutions().into_iter();
        let Some(count) = self.samples else {
            return resolutions.collect();
        };
        resolutions
            .flat_map(|level| Sampled::seeds(count).map(move |seed| level.with_seed(seed)))
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

/// NaN without a sequence or a value.
fn step(sequence: &Option<Sequence>, value: Option<f64>) -> f64 {
    sequence
        .as_ref()
        .zip(value)
        .map_or(f64::NAN, |(sequence, value)| sequence.step(value))
}

impl RefinedCase {
    /// A sample of this level.
    fn with_seed(&self, seed: usize) -> Self {
        let mut sample = self.clone();
        sample.label += &format!(", seed = {seed}");
        sample.parameters.push(("seed", seed as f64));
        sample
    }

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
}

impl RefineTable {
    /// The sequences.
    ///
    /// # Errors
    /// Lists that do not go together.
    pub(super) fn refine(&self) -> Result<Refine, Refusal> {
        let space = one_of(("n", &self.n), ("h", &self.h))?;
        let time = one_of(("steps", &self.steps), ("dt", &self.dt))?;
        let lengths =
            [&space, &time].map(|sequence| sequence.as_ref().map(|sequence| sequence.values.len()));
        match (lengths, self.grid) {
            ([None, None], _) => {
                let lists = "a list n or h, and dt or steps where time is refined";
                return Err(Refusal::missing("n", lists));
            }
            ([Some(h), Some(dt)], false) if h != dt => {
                let key = time.as_ref().map_or("dt", |time| time.name);
                let allowed = "lists of the same length, or grid = true for all pairs";
                return Err(Refusal::new(
                    key,
                    format!("{dt} values beside {h}"),
                    allowed,
                ));
            }
            ([Some(h), Some(dt)], true) if h.saturating_mul(dt) > MOST_CASES => {
                let found = format!("{h} times {dt} cases");
                return Err(Refusal::new("grid", found, format!("at most {MOST_CASES}")));
            }
            ([Some(_), None] | [None, Some(_)], true) => {
                let allowed = "true only with a list in space and one in time";
                return Err(Refusal::new("grid", "true beside one list", allowed));
            }
            _ => {}
        }
        let counts = [("n", &self.n), ("steps", &self.steps)];
        let lists = counts
            .iter()
            .filter_map(|(key, counts)| Some((*key, *counts.as_ref()? == Counts::Auto)));
        let lists: Vec<_> = lists.collect();
        let budget = Budget::read(&lists, self.grid, self.budget, BUDGET)?;
        let samples = self.samples.map(Count::get);
        let levels = lengths.into_iter().flatten().max().unwrap_or(1);
        match samples {
            Some(_) if self.grid || budget.is_some() => {
                let allowed = "samples of levels that are listed, without grid = true";
                return Err(Refusal::written("samples", allowed));
            }
            Some(count) if count.saturating_mul(levels) > MOST_CASES => {
                let found = format!("{count} samples of {levels} levels");
                let allowed = format!("at most {MOST_CASES} cases");
                return Err(Refusal::new("samples", found, allowed));
            }
            _ => {}
        }
        Ok(Refine {
            space,
            time,
            grid: self.grid,
            samples,
            budget,
        })
    }
}

/// The list under one of two names, from coarse to fine: increasing counts, or decreasing steps;
/// using both names is refused.
fn one_of(
    (count, counts): (&'static str, &Option<Counts<Whole>>),
    (step, steps): (&'static str, &Option<Vec<Positive>>),
) -> Result<Option<Sequence>, Refusal> {
    let (name, values): (_, Vec<f64>) = match (counts, steps) {
        (None, None) => return Ok(None),
        (Some(_), Some(_)) => {
            let allowed = format!("one of the two: {count} or {step}");
            return Err(Refusal::new(
                step,
                format!("{step} beside {count}"),
                allowed,
            ));
        }
        (Some(Counts::One(_)), None) => return Err(Refusal::written(count, COUNTS)),
        (Some(Counts::Auto), None) => {
            (count, Budget::FIRST_LEVELS.map(|count| count as f64).into())
        }
        (Some(Counts::List(counts)), None) => (
            count,
            counts.iter().map(|count| count.get() as f64).collect(),
        ),
        (None, Some(steps)) => (step, decreasing(step, steps)?),
    };
    if values.len() > MOST_CASES {
        let found = format!("{} values", values.len());
        return Err(Refusal::new(name, found, format!("at most {MOST_CASES}")));
    }
    Ok(Some(Sequence { name, values }))
}

/// Steps, coarse to fine.
fn decreasing(path: &str, steps: &[Positive]) -> Result<Vec<f64>, Refusal> {
    if steps.is_empty() {
        return Err(Refusal::written(path, "a list of decreasing numbers > 0"));
    }
    let mut before = f64::INFINITY;
    for (place, step) in steps.iter().map(|step| step.get()).enumerate() {
        let item = format!("{path}[{place}]");
        if !step.recip().is_finite() {
            return Err(Refusal::written(
                item,
                "a number > 0, whose inverse is finite",
            ));
        }
        if step >= before {
            let allowed = format!("a number < {before}, the level before");
            return Err(Refusal::written(item, allowed));
        }
        before = step;
    }
    Ok(steps.iter().map(|step| step.get()).collect())
}

#[cfg(test)]
mod tests {
    use super::super::launch::json;
    use super::*;
    use crate::input::Document;
    use crate::refused::each_is_refused;

    #[derive(Deserialize, JsonSchema)]
    struct File {
        refine: RefineTable,
    }

    fn read(text: &str) -> Result<Refine, String> {
        let read = Document::parse(&format!("[refine]\n{text}\n"), "a.toml", |root| {
            let file: File = root.read()?;
            let refine = file.refine.refine().map_err(Refusal::within("refine"));
            refine.map_err(|refusal| root.locate(refusal))
        });
        read.map_err(|error| error.to_string())
    }

    fn parameters(text: &str) -> Vec<String> {
        read(text)
            .unwrap()
            .resolutions()
            .iter()
            .map(|case| json(&case.parameters).trim().to_owned())
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
        each_is_refused(include_str!("refine/refused.txt"), |case| {
            read(&case.new).unwrap_err()
        });
    }
}
