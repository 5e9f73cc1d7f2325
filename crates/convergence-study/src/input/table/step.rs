//! The step of a ladder: one column, by its name or as the caller says.

use std::f64::consts::E;

use super::cell::Cell;
use super::fits::{Printed, Steps, fit};
use super::grid::{Cells, Sense, moves, named};
use super::names::{Family, Measure, family, is_degree, is_level, says_error};
use super::{Choice, Offer, Refused};
use crate::input::advice::{Argument, Text};
use crate::text::number::plain_text;

/// Rates are looked for among this many columns on either side.
pub(super) const NEAR: usize = 40;
/// When an offer to number the rows is right.
const HALVED: &str = "if each row halves the step";
/// When an offer to take a count is right.
const ALONG: &str = "if it counts along an edge";

/// The step that was chosen.
#[derive(Debug, Clone)]
pub(super) struct Step {
    /// The column that gives it; `None` where the rows do.
    pub(super) column: Option<usize>,
    /// The column's name, `cells^(-1/2)`, `2^(-level)`.
    pub(super) label: String,
    pub(super) steps: Steps,
    /// Whether the caller, or printed rates, say which family of steps is meant.
    pub(super) is_said: bool,
}

/// How a column gives the step, the most direct way first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Step,
    /// Cells along an edge.
    Edge,
    Count,
    /// Nodes along an edge: one more than cells.
    Nodes,
}

/// A way in which a column may give the step.
#[derive(Debug, Clone)]
struct Candidate {
    column: usize,
    family: Option<Family>,
    kind: Kind,
    /// Of a count.
    dim: Option<f64>,
    steps: Steps,
}

/// The columns of a ladder, and what the caller says of them.
pub(super) struct Ladder<'t> {
    pub(super) columns: &'t [Cells],
    pub(super) choice: &'t Choice,
}

/// Steps from a column.
///
/// * `dim`: of a count.
pub(super) fn sizes(column: &Cells, dim: Option<f64>) -> Steps {
    let values = column.values().unwrap_or_default();
    match dim {
        Some(dim) => Steps::exact(values.iter().map(|count| count.powf(-1.0 / dim)).collect()),
        None => {
            let halves = column
                .cells
                .iter()
                .map(|cell| cell.number.as_ref().map_or(0.0, |one| one.half));
            Steps {
                halves: halves.collect(),
                sizes: values,
            }
        }
    }
}

/// Whether two lists of steps are in proportion.
fn are_proportional(first: &Steps, second: &Steps, tolerance: f64) -> bool {
    let ratios = |steps: &Steps| {
        steps
            .sizes
            .windows(2)
            .map(|two| two[0] / two[1])
            .collect::<Vec<_>>()
    };
    let pairs = ratios(first).into_iter().zip(ratios(second));
    pairs
        .into_iter()
        .all(|(a, b)| (a - b).abs() <= tolerance * b.abs())
}

impl Ladder<'_> {
    /// Chooses the step.
    pub(super) fn step(&self) -> Result<Step, Refused> {
        if self.choice.ratio.is_some() && self.choice.dim.is_some() {
            let expected =
                Text::from("one of ") + Argument::Dim.alone() + " and " + Argument::Ratio.alone();
            let offer = self.choice.offer("", |choice| choice.dim = None);
            return Err(Refused::new(expected, "both").offering([offer]));
        }
        if self.choice.by_unit {
            return self.levels(E, self.unit()?);
        }
        if let Some(ratio) = self.choice.ratio {
            return self.levels(ratio, self.level()?);
        }
        let candidates = self.candidates()?;
        let mut columns: Vec<usize> = candidates.iter().map(|one| one.column).collect();
        columns.dedup();
        let moving = candidates
            .into_iter()
            .filter(|one| moves(&one.steps.sizes).is_some());
        let moving: Vec<Candidate> = moving.collect();
        if moving.is_empty() && columns.is_empty() {
            return Err(self.without_step());
        }
        if moving.is_empty() {
            let expected = "steps that fall or rise from row to row";
            let line = self.columns[columns[0]].turn();
            return Err(Refused::new(expected, self.quoted(&columns)).at(line));
        }
        let printed = self.printed_rates(&columns);
        let belongs = |one: &&Candidate| {
            printed
                .iter()
                .all(|rates| self.fits(*rates, &one.steps, &columns))
        };
        let fitting: Vec<Candidate> = moving.iter().filter(belongs).cloned().collect();
        let is_said = !printed.is_empty() && !fitting.is_empty();
        let is_plain = |one: &Candidate| one.kind != Kind::Nodes;
        let mut left = if is_said { fitting } else { moving };
        if left.iter().any(is_plain) {
            left.retain(is_plain);
        }
        if !is_said {
            left = self.one_family(left)?;
        }
        let chosen = self.one(left, is_said)?;
        Ok(Step {
            column: Some(chosen.column),
            label: self.label(&chosen),
            steps: chosen.steps,
            is_said: is_said || self.choice.step.is_some(),
        })
    }

    /// The column that numbers the levels, if one does: else the rows do.
    fn level(&self) -> Result<Option<usize>, Refused> {
        let is_level = |k: &usize| is_level(&self.columns[*k].key) && self.is_numbered(*k);
        match &self.choice.step {
            Some(name) => named(self.columns, Argument::Step, name).map(Some),
            None => Ok((0..self.columns.len()).find(is_level)),
        }
    }

    /// The column of the count, the degree or the level that a factor is about.
    fn unit(&self) -> Result<Option<usize>, Refused> {
        let is_unit = |k: &usize| {
            let Cells { key, .. } = &self.columns[*k];
            let is_count = matches!(family(key), Some((_, Measure::Count)));
            (is_count || is_degree(key) || is_level(key)) && self.is_numbered(*k)
        };
        let units: Vec<usize> = match &self.choice.step {
            Some(name) => vec![named(self.columns, Argument::Step, name)?],
            None => (0..self.columns.len()).filter(is_unit).collect(),
        };
        if let [column] = units[..] {
            return Ok(Some(column));
        }
        let expected =
            Argument::Step.with_placeholder() + ", the count or degree that the factor is about";
        Err(Refused::new(expected, self.quoted(&units)))
    }

    fn is_numbered(&self, column: usize) -> bool {
        self.columns[column].is_whole() && self.columns[column].varies()
    }

    /// The step of levels, each R times as small, numbered by a column or by the rows.
    fn levels(&self, ratio: f64, column: Option<usize>) -> Result<Step, Refused> {
        let rows = || {
            (0..self.columns[0].cells.len())
                .map(|row| row as f64)
                .collect()
        };
        let numbers = column.map_or_else(|| Some(rows()), |k| self.columns[k].values());
        let name = column.map_or("row", |k| &self.columns[k].name);
        let Some(numbers) = numbers.filter(|numbers| moves(numbers).is_some()) else {
            let line = column.map_or(0, |k| self.columns[k].turn());
            let expected = "numbers of levels that rise or fall";
            return Err(Refused::new(expected, format!("`{name}`")).at(line));
        };
        let label = if self.choice.by_unit {
            format!("exp(-{name})")
        } else {
            format!("{}^(-{name})", plain_text(ratio))
        };
        let sizes = numbers.into_iter().map(|level| ratio.powf(-level));
        Ok(Step {
            column,
            label,
            steps: Steps::exact(sizes.collect()),
            is_said: true,
        })
    }

    fn quoted(&self, columns: &[usize]) -> String {
        let names = columns
            .iter()
            .take(12)
            .map(|k| format!("`{}`", self.columns[*k].name));
        names.collect::<Vec<_>>().join(", ")
    }

    /// The ways in which columns may give the step.
    fn candidates(&self) -> Result<Vec<Candidate>, Refused> {
        if let Some(name) = &self.choice.step {
            let column = named(self.columns, Argument::Step, name)?;
            let is_step = |cell: &Cell| cell.value().is_some_and(|step| step > 0.0);
            let other = self.columns[column]
                .cells
                .iter()
                .find(|cell| !is_step(cell));
            if let Some(cell) = other {
                let found = format!("`{}` in `{}`", cell.text, self.columns[column].name);
                let refused = Refused::new("steps, finite numbers > 0 in each row", found);
                return Err(refused.at(cell.line));
            }
            return self.ways(column);
        }
        let is_step = |k: &usize| {
            let column = &self.columns[*k];
            let is_claimed = self.choice.claimed.contains(&column.name);
            family(&column.key).is_some() && column.varies() && column.is_positive() && !is_claimed
        };
        let (named, others): (Vec<usize>, Vec<usize>) = (0..self.columns.len())
            .filter(is_step)
            .partition(|k| self.columns[*k].family().is_some());
        let ways = if named.is_empty() { others } else { named }
            .into_iter()
            .map(|k| self.ways(k));
        Ok(ways.collect::<Result<Vec<_>, _>>()?.concat())
    }

    fn ways(&self, column: usize) -> Result<Vec<Candidate>, Refused> {
        let key = &self.columns[column].key;
        let cells_are_whole = self.columns[column].is_whole();
        let family = family(key);
        let way = |kind, dim| Candidate {
            column,
            family: family.map(|(family, _)| family),
            kind,
            dim,
            steps: sizes(&self.columns[column], dim),
        };
        let nodes = || {
            let less = |count: &f64| 1.0 / (count - 1.0).max(0.5);
            let counts = self.columns[column].values().unwrap_or_default();
            Candidate {
                steps: Steps::exact(counts.iter().map(less).collect()),
                ..way(Kind::Nodes, Some(1.0))
            }
        };
        if self.has_edges(column)? {
            return Ok(vec![nodes(), way(Kind::Edge, Some(1.0))]);
        }
        let is_size = self.columns[column].is_size();
        match family {
            _ if !cells_are_whole || is_size => {
                let is_count = matches!(family, Some((_, Measure::Count))) && !is_size;
                Ok(if is_count {
                    vec![]
                } else {
                    vec![way(Kind::Step, None)]
                })
            }
            Some((Family::Time, Measure::Count)) => Ok(vec![way(Kind::Count, Some(1.0))]),
            Some((_, Measure::Step)) | None if self.choice.dim.is_none() => {
                Ok(vec![way(Kind::Step, None)])
            }
            _ => {
                let along = ["node", "point", "grid"]
                    .iter()
                    .any(|word| key.contains(word))
                    || key.len() < 3;
                let mut ways: Vec<Candidate> = along.then(nodes).into_iter().collect();
                ways.extend(
                    self.dims()
                        .into_iter()
                        .map(|dim| way(Kind::Count, Some(dim))),
                );
                Ok(ways)
            }
        }
    }

    /// Whether the cells are grids such as `16x16`, whose last edge is the count.
    ///
    /// # Errors
    /// Another dimension than 1 is asked for, or the edges are not refined alike.
    fn has_edges(&self, column: usize) -> Result<bool, Refused> {
        let Cells { name, cells, .. } = &self.columns[column];
        let numbers = cells.iter().filter_map(|cell| cell.number.as_ref());
        let edges: Vec<&Vec<f64>> = numbers.map(|number| &number.edges).collect();
        if edges.iter().all(|edges| edges.is_empty()) {
            return Ok(false);
        }
        if self.choice.dim.is_some_and(|dim| dim != 1.0) {
            let found = format!("`{name}`, the count along an edge");
            let offer = self.choice.offer("", |choice| choice.dim = None);
            return Err(Refused::new(Argument::Dim.with("1"), found).offering([offer]));
        }
        let last = edges.iter().map(|edges| edges.last().copied());
        let last = Steps::exact(last.map(Option::unwrap_or_default).collect());
        if !are_proportional(&sizes(&self.columns[column], None), &last, 0.2) {
            let found = format!("`{name}`");
            return Err(Refused::new("edges that are refined alike", found));
        }
        Ok(true)
    }

    /// The dimensions that a count may have.
    fn dims(&self) -> Vec<f64> {
        let is_dim = |column: &&Cells| {
            ["dim", "dimension"].contains(&column.key.as_str())
                && column.is_constant()
                && column.is_positive()
        };
        let column = self.columns.iter().find(is_dim);
        let known = self.choice.dim.or_else(|| column?.cells[0].value());
        known.map_or_else(|| vec![1.0, 2.0, 3.0], |dim| vec![dim])
    }

    /// Columns that may hold the error of printed rates, near a column.
    fn errors_near(&self, rates: usize, steps: &[usize]) -> impl Iterator<Item = &Cells> {
        let near = rates.saturating_sub(NEAR)..(rates + NEAR).min(self.columns.len());
        // A column without a name of its own has those of the error before it.
        let own = self.columns[rates].name.strip_prefix("rate of ");
        let is_error = |k: &usize| {
            let column = &self.columns[*k];
            let is_own = own.is_none_or(|own| column.name == own);
            !steps.contains(k) && is_own && column.has_numbers() && !column.is_named_rates()
        };
        near.filter(is_error)
            .map(|k| &self.columns[k])
            .collect::<Vec<_>>()
            .into_iter()
    }

    fn fits(&self, rates: usize, steps: &Steps, known: &[usize]) -> bool {
        self.errors_near(rates, known)
            .any(|error| fit(&self.columns[rates], error, steps) == Some(Printed::Rates))
    }

    /// The columns named like rates that are no factors.
    fn printed_rates(&self, steps: &[usize]) -> Vec<usize> {
        let any = Steps::exact(
            (0..self.columns[0].cells.len())
                .map(|k| 0.5f64.powi(k as i32))
                .collect(),
        );
        let are_factors = |k: usize| {
            let is_factor = |error| fit(&self.columns[k], error, &any) == Some(Printed::Factors);
            self.errors_near(k, steps).any(is_factor)
        };
        let is_printed =
            |k: &usize| self.columns[*k].is_named_rates() && self.columns[*k].has_numbers();
        (0..self.columns.len())
            .filter(is_printed)
            .filter(|k| !are_factors(*k))
            .collect()
    }

    /// Refuses steps of both families, unless they are in proportion.
    fn one_family(&self, left: Vec<Candidate>) -> Result<Vec<Candidate>, Refused> {
        let of = |family| left.iter().filter(move |one| one.family == Some(family));
        let is_known = |one: &&Candidate| {
            left.iter()
                .filter(|other| other.column == one.column)
                .count()
                == 1
        };
        if of(Family::Space).count() == 0 || of(Family::Time).count() == 0 {
            return Ok(left);
        }
        for space in of(Family::Space).filter(is_known) {
            for time in of(Family::Time).filter(is_known) {
                if are_proportional(&space.steps, &time.steps, 0.01) {
                    return Ok(vec![space.clone(), time.clone()]);
                }
            }
        }
        let mut columns: Vec<usize> = left.iter().map(|one| one.column).collect();
        columns.dedup();
        let offers = left.iter().map(|one| self.offer(one));
        let expected =
            Argument::Step.with_placeholder() + ": one of the steps, in space or in time";
        Err(Refused::new(expected, self.quoted(&columns)).offering(offers))
    }

    fn offer(&self, one: &Candidate) -> Offer {
        self.choice.offer("", |choice| {
            choice.step = Some(self.columns[one.column].name.clone());
            choice.dim = one.dim.filter(|_| one.kind == Kind::Count);
        })
    }

    /// The most direct of the ways that are left: several dimensions of one count are refused.
    fn one(&self, mut left: Vec<Candidate>, is_said: bool) -> Result<Candidate, Refused> {
        let is_unknowns = |one: &Candidate| {
            ["dof", "point", "node", "unknown"]
                .iter()
                .any(|word| self.columns[one.column].key.contains(word))
        };
        left.sort_by_key(|one| (one.kind, is_unknowns(one)));
        let first = left[0].clone();
        let differs = |one: &&Candidate| !are_proportional(&first.steps, &one.steps, 0.05);
        if is_said && let Some(other) = left.iter().find(differs) {
            let offers = [self.offer(&first), self.offer(other)];
            let expected = Argument::Step.with_placeholder() + " that the printed rates belong to";
            return Err(
                Refused::new(expected, self.quoted(&[first.column, other.column])).offering(offers),
            );
        }
        let mut same = left
            .iter()
            .filter(|one| one.column == first.column)
            .peekable();
        if is_said || same.clone().count() == 1 {
            return Ok(first);
        }
        let name = &self.columns[first.column].name;
        let offer = |one: &Candidate| {
            let comments = ["along an edge", "all, in the plane", "all, in space"];
            let comment = comments
                .get(one.dim.unwrap_or(1.0) as usize - 1)
                .copied()
                .unwrap_or_default();
            self.choice.offer(comment, |choice| choice.dim = one.dim)
        };
        let mut offers: Vec<Offer> = same.by_ref().map(offer).collect();
        let along = self.columns[first.column].key.len() < 3 || name.contains("side");
        if !along && offers.len() > 2 {
            offers.rotate_left(1);
        }
        let expected = Argument::Dim.with_placeholder()
            + format!(" for h = {name}^(-1/D), or ")
            + Argument::Step.with_placeholder();
        Err(Refused::new(expected, format!("the count `{name}` and no step")).offering(offers))
    }

    fn label(&self, one: &Candidate) -> String {
        let name = &self.columns[one.column].name;
        match (one.kind, one.dim) {
            (Kind::Nodes, _) => format!("1/({name} - 1)"),
            (_, Some(1.0)) => format!("1/{name}"),
            (_, Some(dim)) => format!("{name}^(-1/{})", plain_text(dim)),
            (_, None) => name.clone(),
        }
    }

    /// The refusal where no column is a step by its name.
    fn without_step(&self) -> Refused {
        let all: Vec<usize> = (0..self.columns.len()).collect();
        let may_be_error = |column: &Cells| {
            let numbers = column.cells.iter().filter_map(Cell::value);
            column.is_named_rates() || numbers.into_iter().all(|number| number >= 0.0)
        };
        let halved = self.columns.iter().all(may_be_error);
        let halved = halved.then(|| self.choice.offer(HALVED, |choice| choice.ratio = Some(2.0)));
        let counts = self.columns.iter().filter(|column| {
            let is_count = column.is_whole() && column.is_positive() && !column.numbers_rows();
            is_count && column.sense() == Some(Sense::Rises) && !says_error(&column.key)
        });
        let counts = counts.map(|column| {
            self.choice.offer(ALONG, |choice| {
                choice.step = Some(column.name.clone());
                choice.dim = choice.dim.or(Some(1.0));
            })
        });
        let offers: Vec<Offer> = counts.chain(halved).collect();
        let expected = Text::from("a column of steps: name it `h`, or say ")
            + Argument::Step.with_placeholder()
            + ", or "
            + Argument::Ratio.with_placeholder()
            + " for rows in order";
        Refused::new(expected, self.quoted(&all)).offering(offers)
    }
}
