//! The step of a ladder: one column, by its name or as the caller says.

use std::f64::consts::E;

use super::cell::{Cell, Number};
use super::fits::{Printed, Steps, printed};
use super::grid::{Cells, Sense, moves, named};
use super::names::{Family, Measure, family, is_degree, is_level, says_error};
use super::{Choice, Offer, Refused};
use crate::input::advice::{Argument, Text};
use crate::text::number::plain_text;

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
struct Way {
    column: usize,
    kind: Kind,
    /// Of a count.
    dim: Option<f64>,
    steps: Steps,
}

/// The columns of a ladder, and what the caller says of them.
struct Columns<'t> {
    columns: &'t [Cells],
    choice: &'t Choice,
}

/// Steps from a column.
///
/// * `dim`: of a count.
pub(super) fn sizes(column: &Cells, dim: Option<f64>) -> Steps {
    let numbers = column.numbers.iter();
    match dim {
        Some(dim) => Steps::exact(numbers.map(|count| count.powf(-1.0 / dim))),
        None => Steps {
            sizes: column.numbers.clone(),
            halves: column.halves.clone(),
        },
    }
}

/// Whether two lists of steps are in proportion.
fn are_proportional(first: &Steps, second: &Steps, tolerance: f64) -> bool {
    let mut pairs = first.ratios().zip(second.ratios());
    pairs.all(|(one, other)| (other / one - 1.0).abs() <= tolerance)
}

/// Chooses the step of a ladder.
///
/// # Errors
/// No step, or several of which none is meant.
pub(super) fn step(columns: &[Cells], choice: &Choice) -> Result<Step, Refused> {
    let columns = Columns { columns, choice };
    match choice.ratio {
        Some(_) if choice.dim.is_some() => {
            let expected = Text::from("one of ") + Argument::Dim.alone() + " and ";
            let offer = choice.offer("", |choice| choice.dim = None);
            let refused = Refused::new(expected + Argument::Ratio.alone(), "both");
            Err(refused.offering([offer]))
        }
        Some(ratio) => columns.levels(ratio),
        None if choice.by_unit => columns.levels(E),
        None => columns.by_name(),
    }
}

/// The refusal of a column of steps with a cell that is none.
fn no_step(column: &Cells, cell: &Cell) -> Refused {
    let found = format!("`{}` in `{}`", cell.text, column.name);
    Refused::new("steps, finite numbers > 0 in each row", found).at(cell.line)
}

/// The columns that ways are about.
fn columns_of(ways: &[Way]) -> Vec<usize> {
    let mut columns: Vec<usize> = ways.iter().map(|way| way.column).collect();
    columns.dedup();
    columns
}

impl Columns<'_> {
    /// The step of levels, each R times as small as the one before, numbered by a column or by the
    /// rows. A factor for each unit is about one count, degree or level.
    fn levels(&self, ratio: f64) -> Result<Step, Refused> {
        let Choice { step, by_unit, .. } = self.choice;
        let is_unit = |column: &Cells| {
            matches!(family(&column.key), Some((_, Measure::Count))) || is_degree(&column.key)
        };
        let numbers_levels = |k: &usize| {
            let column = &self.columns[*k];
            let is_named = is_level(&column.key) || *by_unit && is_unit(column);
            is_named && column.is_whole() && column.varies()
        };
        let levels: Vec<usize> = match step {
            Some(name) => vec![named(self.columns, Argument::Step, name)?],
            None => (0..self.columns.len()).filter(numbers_levels).collect(),
        };
        if *by_unit && levels.len() != 1 {
            let expected = ", the count or degree that the factor is about";
            let expected = Argument::Step.with_placeholder() + expected;
            return Err(Refused::new(expected, self.quoted(levels)));
        }
        let column = levels.first().map(|k| &self.columns[*k]);
        let name = column.map_or("row", |column| &column.name);
        let rows = (0..self.columns[0].cells.len()).map(|row| row as f64);
        let numbers = column.map_or_else(|| rows.collect(), |column| column.numbers.clone());
        if moves(&numbers).is_none() {
            let line = column.map_or(0, Cells::turn);
            let expected = "numbers of levels that rise or fall";
            return Err(Refused::new(expected, format!("`{name}`")).at(line));
        }
        let base = if *by_unit {
            "exp".to_owned()
        } else {
            format!("{}^", plain_text(ratio))
        };
        Ok(Step {
            column: levels.first().copied(),
            label: format!("{base}(-{name})"),
            steps: Steps::exact(numbers.iter().map(|level| ratio.powf(-level))),
            is_said: true,
        })
    }

    /// The step that a column gives by its name, or as the caller says.
    fn by_name(&self) -> Result<Step, Refused> {
        let ways = self.candidates()?.into_iter().map(|k| self.ways(k));
        let mut ways = ways.collect::<Result<Vec<_>, _>>()?.concat();
        let candidates = columns_of(&ways);
        if candidates.is_empty() {
            return Err(self.without_step());
        }
        ways.retain(|way| moves(&way.steps.sizes).is_some());
        if ways.is_empty() {
            let expected = "steps that fall or rise from row to row";
            let line = self.columns[candidates[0]].turn();
            return Err(Refused::new(expected, self.quoted(candidates)).at(line));
        }
        let rates = self.printed_rates(&candidates);
        let fits = |way: &&Way| {
            let mut rates = rates.iter();
            rates.all(|k| self.prints(*k, Printed::Rates, &way.steps, &candidates))
        };
        let fitting: Vec<Way> = ways.iter().filter(fits).cloned().collect();
        let is_said = !rates.is_empty() && !fitting.is_empty();
        if is_said {
            ways = fitting;
        }
        if ways.iter().any(|way| way.kind != Kind::Nodes) {
            ways.retain(|way| way.kind != Kind::Nodes);
        }
        let way = if is_said {
            self.one_of_fitting(ways)?
        } else {
            self.one_dimension(self.one_family(ways)?)?
        };
        Ok(Step {
            column: Some(way.column),
            label: self.label(&way),
            steps: way.steps,
            is_said: is_said || self.choice.step.is_some(),
        })
    }

    fn quoted(&self, columns: impl IntoIterator<Item = usize>) -> String {
        let names = columns
            .into_iter()
            .map(|k| format!("`{}`", self.columns[k].name));
        names.take(12).collect::<Vec<_>>().join(", ")
    }

    /// The columns that may give the step. A step must be positive in each row.
    fn candidates(&self) -> Result<Vec<usize>, Refused> {
        if let Some(name) = &self.choice.step {
            let k = named(self.columns, Argument::Step, name)?;
            let column = &self.columns[k];
            let is_step = |cell: &Cell| cell.value().is_some_and(|step| step > 0.0);
            return match column.cells.iter().find(|cell| !is_step(cell)) {
                Some(cell) => Err(no_step(column, cell)),
                None => Ok(vec![k]),
            };
        }
        let may_be_step = |k: &usize| {
            let column = &self.columns[*k];
            let is_claimed = self.choice.claimed.contains(&column.name);
            family(&column.key).is_some() && column.varies() && column.is_positive() && !is_claimed
        };
        let named = (0..self.columns.len()).filter(may_be_step);
        let (named, others): (Vec<usize>, Vec<usize>) =
            named.partition(|k| self.columns[*k].family().is_some());
        Ok(if named.is_empty() { others } else { named })
    }

    /// The ways in which a column may give the step; none of a count with a point.
    fn ways(&self, column: usize) -> Result<Vec<Way>, Refused> {
        let cells = &self.columns[column];
        let is_size = cells.is_size();
        let way = |kind, dim| Way {
            column,
            kind,
            dim,
            steps: sizes(cells, dim),
        };
        let counts = cells.numbers.iter();
        let nodes = Way {
            steps: Steps::exact(counts.map(|count| 1.0 / (count - 1.0).max(0.5))),
            ..way(Kind::Nodes, Some(1.0))
        };
        if self.has_edges(cells)? {
            return Ok(vec![nodes, way(Kind::Edge, Some(1.0))]);
        }
        let is_count = match family(&cells.key) {
            Some((_, Measure::Count)) => !is_size,
            _ => self.choice.dim.is_some(),
        };
        let is_whole = cells.is_whole() && !is_size;
        Ok(match family(&cells.key) {
            Some((_, Measure::Count)) if !is_whole && is_count => vec![],
            _ if !is_whole || !is_count => vec![way(Kind::Step, None)],
            Some((Family::Time, Measure::Count)) => vec![way(Kind::Count, Some(1.0))],
            _ => {
                let mut words = ["node", "point", "grid"].iter();
                let is_along = words.any(|word| cells.key.contains(word)) || cells.key.len() < 3;
                let counts = self
                    .dims()
                    .into_iter()
                    .map(|dim| way(Kind::Count, Some(dim)));
                is_along
                    .then_some(nodes)
                    .into_iter()
                    .chain(counts)
                    .collect()
            }
        })
    }

    /// Whether the cells are grids such as `16x16`, of which the first edge is the count.
    ///
    /// # Errors
    /// Another dimension than 1 is asked for, or the edges are not refined alike.
    fn has_edges(&self, column: &Cells) -> Result<bool, Refused> {
        let numbers = column.cells.iter().filter_map(|cell| cell.number.as_ref());
        let last = |number: &Number| number.edges.last().copied();
        if numbers.clone().all(|number| last(number).is_none()) {
            return Ok(false);
        }
        let name = &column.name;
        if self.choice.dim.is_some_and(|dim| dim != 1.0) {
            let found = format!("`{name}`, the count along an edge");
            let offer = self.choice.offer("", |choice| choice.dim = None);
            return Err(Refused::new(Argument::Dim.with("1"), found).offering([offer]));
        }
        let last = Steps::exact(numbers.map(|number| last(number).unwrap_or_default()));
        if !are_proportional(&sizes(column, None), &last, 0.2) {
            return Err(Refused::new(
                "edges that are refined alike",
                format!("`{name}`"),
            ));
        }
        Ok(true)
    }

    /// The dimensions that a count may have.
    fn dims(&self) -> Vec<f64> {
        let says_dim = |column: &&Cells| {
            let is_named = ["dim", "dimension"].contains(&column.key.as_str());
            is_named && column.is_constant() && column.is_positive()
        };
        let said = self.columns.iter().find(says_dim);
        let known = self.choice.dim.or(said.map(|column| column.numbers[0]));
        known.map_or_else(|| vec![1.0, 2.0, 3.0], |dim| vec![dim])
    }

    /// Whether a column prints the rates, or the factors, of an error near it.
    fn prints(&self, column: usize, what: Printed, steps: &Steps, candidates: &[usize]) -> bool {
        let is_other = |k| !candidates.contains(&k);
        let mut found = printed(self.columns, column, is_other, steps);
        found.any(|(printed, _)| printed == what)
    }

    /// The columns named like rates that are no factors.
    fn printed_rates(&self, candidates: &[usize]) -> Vec<usize> {
        let rows = self.columns[0].cells.len();
        let any = Steps::exact((0..rows).map(|row| 0.5f64.powi(row as i32)));
        let are_rates = |k: &usize| {
            let is_named = self.columns[*k].is_named_rates() && self.columns[*k].has_numbers();
            is_named && !self.prints(*k, Printed::Factors, &any, candidates)
        };
        (0..self.columns.len()).filter(are_rates).collect()
    }

    fn offer(&self, way: &Way) -> Offer {
        self.choice.offer("", |choice| {
            choice.step = Some(self.columns[way.column].name.clone());
            choice.dim = way.dim.filter(|_| way.kind == Kind::Count);
        })
    }

    /// Refuses steps of both families, unless they are in proportion.
    fn one_family(&self, ways: Vec<Way>) -> Result<Vec<Way>, Refused> {
        let of = |wanted| {
            let is_wanted = move |way: &&Way| {
                family(&self.columns[way.column].key).is_some_and(|(family, _)| family == wanted)
            };
            ways.iter().filter(is_wanted)
        };
        if of(Family::Space).count() == 0 || of(Family::Time).count() == 0 {
            return Ok(ways);
        }
        let is_only = |way: &&Way| ways.iter().filter(|one| one.column == way.column).count() == 1;
        for space in of(Family::Space).filter(is_only) {
            let mut times = of(Family::Time).filter(is_only);
            let proportional = |time: &&Way| are_proportional(&space.steps, &time.steps, 0.01);
            if let Some(time) = times.find(proportional) {
                return Ok(vec![space.clone(), time.clone()]);
            }
        }
        let expected =
            Argument::Step.with_placeholder() + ": one of the steps, in space or in time";
        let offers = ways.iter().map(|way| self.offer(way));
        Err(Refused::new(expected, self.quoted(columns_of(&ways))).offering(offers))
    }

    /// The most direct way first; unknowns are not as direct as cells.
    fn sort(&self, ways: &mut [Way]) {
        let words = ["dof", "point", "node", "unknown"];
        ways.sort_by_key(|way| {
            let key = &self.columns[way.column].key;
            (way.kind, words.iter().any(|word| key.contains(word)))
        });
    }

    /// The most direct of the ways that printed rates fit, which must be one ladder.
    fn one_of_fitting(&self, mut ways: Vec<Way>) -> Result<Way, Refused> {
        self.sort(&mut ways);
        let differs = |way: &&Way| !are_proportional(&way.steps, &ways[0].steps, 0.05);
        let Some(other) = ways.iter().find(differs) else {
            return Ok(ways.swap_remove(0));
        };
        let expected = Argument::Step.with_placeholder() + " that the printed rates belong to";
        let found = self.quoted([ways[0].column, other.column]);
        let offers = [self.offer(&ways[0]), self.offer(other)];
        Err(Refused::new(expected, found).offering(offers))
    }

    /// The most direct of the ways; refuses a count of which the dimension is not known.
    fn one_dimension(&self, mut ways: Vec<Way>) -> Result<Way, Refused> {
        self.sort(&mut ways);
        let column = ways[0].column;
        ways.retain(|way| way.column == column);
        if ways.len() == 1 {
            return Ok(ways.swap_remove(0));
        }
        let Cells { key, name, .. } = &self.columns[column];
        let is_along = key.len() < 3 || name.contains("side");
        if !is_along && ways.len() > 2 {
            ways.rotate_left(1);
        }
        let offers = ways.iter().map(|way| {
            let comment = match way.dim {
                Some(2.0) => "all, in the plane",
                Some(3.0) => "all, in space",
                _ => "along an edge",
            };
            self.choice.offer(comment, |choice| choice.dim = way.dim)
        });
        let expected = format!(" for h = {name}^(-1/D), or ");
        let expected = Argument::Dim.with_placeholder() + expected;
        let expected = expected + Argument::Step.with_placeholder();
        let found = format!("the count `{name}` and no step");
        Err(Refused::new(expected, found).offering(offers))
    }

    fn label(&self, way: &Way) -> String {
        let name = &self.columns[way.column].name;
        match (way.kind, way.dim) {
            (Kind::Nodes, _) => format!("1/({name} - 1)"),
            (_, Some(1.0)) => format!("1/{name}"),
            (_, Some(dim)) => format!("{name}^(-1/{})", plain_text(dim)),
            (_, None) => name.clone(),
        }
    }

    /// Why a column that has the name of a step is none.
    fn no_step_of_its_name(&self) -> Option<Refused> {
        let is_step = |cell: &Cell| cell.value().is_some_and(|step| step > 0.0);
        let has_name = |column: &&Cells| {
            let has_numbers = column.has_numbers() || column.cells.iter().any(Cell::is_broken);
            let is_claimed = self.choice.claimed.contains(&column.name);
            column.family().is_some() && has_numbers && !is_claimed
        };
        let named = self.columns.iter().filter(has_name);
        for column in named.clone() {
            if let Some(cell) = column.cells.iter().find(|cell| !is_step(cell)) {
                return Some(no_step(column, cell));
            }
        }
        let numbers_levels = |column: &Cells| is_level(&column.key) && column.varies();
        let mut constant = named.filter(|column| column.is_constant());
        let column = constant.next()?;
        if self.columns.iter().any(numbers_levels) {
            return None;
        }
        let text = &column.cells[0].text;
        let rows = match column.cells.len() {
            1 => "the only row",
            _ => "each row",
        };
        let found = format!("`{text}` in {rows} of `{}`", column.name);
        let expected = "steps that fall or rise from row to row";
        Some(Refused::new(expected, found).at(column.turn()))
    }

    /// The refusal where no column is a step by its name.
    fn without_step(&self) -> Refused {
        if let Some(refused) = self.no_step_of_its_name() {
            return refused;
        }
        let may_be_error = |column: &Cells| {
            let mut numbers = column.cells.iter().filter_map(Cell::value);
            column.is_named_rates() || numbers.all(|number| number >= 0.0)
        };
        let is_count = |column: &&Cells| {
            let grows = column.sense() == Some(Sense::Rises) && column.is_positive();
            grows && column.is_whole() && !column.numbers_rows && !says_error(&column.key)
        };
        let counts = self.columns.iter().filter(is_count).map(|column| {
            self.choice.offer("if it counts along an edge", |choice| {
                choice.step = Some(column.name.clone());
                choice.dim = choice.dim.or(Some(1.0));
            })
        });
        let halved = self.columns.iter().all(may_be_error).then(|| {
            let comment = "if each row halves the step";
            self.choice
                .offer(comment, |choice| choice.ratio = Some(2.0))
        });
        let expected = Text::from("a column of steps: name it `h`, or say ")
            + Argument::Step.with_placeholder()
            + ", or "
            + Argument::Ratio.with_placeholder()
            + " for rows in order";
        let found = self.quoted(0..self.columns.len());
        Refused::new(expected, found).offering(counts.chain(halved))
    }
}
