//! The orders that are claimed, and the claim for each column.

use std::str::FromStr;

use super::{Column, Request, SourceTable};
use crate::input::advice::{Argument, Text};
use crate::input::table::names::{is_degree, position};
use crate::text::names::{did_you_mean, nearest};
use crate::text::number::plain_text;
use crate::text::visible::visible;
use convergence_judge::claims::{Bound, Claim, order_from_text, order_of_factor};

/// An order that is claimed, for one column or for all.
#[derive(Debug, Clone, PartialEq)]
pub struct Claimed {
    /// As the caller has written it.
    pub(crate) text: String,
    /// The column, of all tables or behind the name of one, as in `Table 2:L2`; `None` for all.
    pub(crate) name: Option<String>,
    /// The order.
    order: ClaimedOrder,
    /// Which higher rates agree with it, too.
    bound: Bound,
}

impl Claimed {
    /// * `text`: as the caller has written the claim.
    /// * `name`: of the column, of all tables or behind the name of one, as in `Table 2:L2`; `None`
    ///   for all.
    /// * `order`: a number > 0.
    /// * `bound`: which higher rates agree with it, too.
    pub fn new(text: String, name: Option<String>, order: f64, bound: Bound) -> Self {
        Self {
            text,
            name,
            order: ClaimedOrder::Number(order),
            bound,
        }
    }
}

/// An order, as a number or by the degree of the elements of each table.
#[derive(Debug, Clone, PartialEq)]
enum ClaimedOrder {
    /// A number > 0.
    Number(f64),
    /// `p + 1` and the like: the degree that all rows of a table share, plus a number.
    Degree(f64),
}

impl ClaimedOrder {
    /// `p`, `p+1`, `degree-1`.
    fn of_degree(text: &str) -> Option<Self> {
        let end = text.find(['+', '-']).unwrap_or(text.len());
        let (name, plus) = text.split_at(end);
        let plus: String = plus.split_whitespace().collect();
        let plus = if plus.is_empty() { "0" } else { &plus };
        let plus = plus.parse().ok().filter(|plus| f64::is_finite(*plus))?;
        is_degree(name.trim()).then_some(Self::Degree(plus))
    }
}

/// A value of `--order`; the error says what was expected.
impl FromStr for Claimed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let at = text
            .rfind(">=")
            .or_else(|| text.rfind('=').map(|at| at + 1));
        let (name, order) = text.split_at(at.unwrap_or(0));
        let name = name.trim_end();
        let number = order_from_text(order).map(|(number, _)| ClaimedOrder::Number(number));
        let (bound, order) = Bound::split(order);
        let order = number.or_else(|| ClaimedOrder::of_degree(order));
        let order = order.filter(|_| name.is_empty() || name.ends_with('='));
        let order = order.ok_or(
            "expected a number > 0, '>=P' with such a number P, or NAME= before one of them; P may be p + 1, with the degree p of each table, and '>=P..' takes any higher rate",
        )?;
        Ok(Self {
            text: text.to_owned(),
            name: name.strip_suffix('=').map(str::to_owned),
            order,
            bound,
        })
    }
}

/// What a claim is about in one table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Place {
    /// Whether the claim names the table.
    is_own: bool,
    /// The number of the column; `None` for all.
    column: Option<usize>,
}

/// The claims for each column of each table. Each claim must be the closest one of a column.
pub(super) fn claims(
    request: &Request,
    sources: &[SourceTable],
) -> Result<Vec<Vec<Option<Claim>>>, Text> {
    // Where headings have numbers, those are meant.
    let is_numbered = sources.iter().any(|source| has_number(&source.table.name));
    let numbers = (1..).map(|number| (!is_numbered).then_some(number));
    let tables = numbers
        .zip(sources)
        .map(|(number, source)| TableNames { number, source });
    for claimed in &request.claims {
        if tables.clone().all(|table| claimed.place(table).is_none()) {
            let all = sources.iter().flat_map(|source| source.table.all());
            let names: Vec<&str> = all.map(|column| column.name.as_str()).collect();
            return Err(claimed.unknown(&names));
        }
    }
    let mut all = vec![];
    let mut used: Vec<&Claimed> = vec![];
    for table in tables {
        let closest = closest_claims(request, table)?;
        used.extend(closest.iter().flatten());
        all.push(claims_of(request, table.source, closest)?);
    }
    let is_used = |claimed: &Claimed| used.iter().any(|one| std::ptr::eq(*one, claimed));
    match request.claims.iter().find(|claimed| !is_used(claimed)) {
        Some(idle) => Err(Argument::Order.with(&idle.text)
            + ": expected a column that it judges; found a closer claim for each"),
        None => Ok(all),
    }
}

/// What claims call a table.
#[derive(Clone, Copy)]
struct TableNames<'s> {
    /// From 1; `None` where headings have numbers of their own.
    number: Option<usize>,
    source: &'s SourceTable,
}

/// Whether a heading begins as `Table 2` does.
fn has_number(heading: &str) -> bool {
    let heading = heading.to_lowercase();
    let number = heading.strip_prefix("table ").map(str::trim_start);
    number.is_some_and(|number| number.starts_with(|c: char| c.is_ascii_digit()))
}

impl TableNames<'_> {
    /// Whether a name is the heading, or what stands before its colon, or else the number.
    fn are(&self, name: &str) -> bool {
        let name = name.trim().to_lowercase();
        let heading = self.source.table.name.to_lowercase();
        let start = heading.split(':').next().unwrap_or_default();
        let number = self.number.map(|number| number.to_string());
        let number = number.is_some_and(|n| name == n || name == format!("table {n}"));
        [heading.as_str(), start.trim_end()].contains(&name.as_str()) || number
    }
}

/// The closest claim for each column; `None` without one. A claim about this table goes before one
/// about all, and one about a column before one about all columns.
fn closest_claims<'c>(
    request: &'c Request,
    table: TableNames<'_>,
) -> Result<Vec<Option<&'c Claimed>>, Text> {
    let mut placed: Vec<(Place, &Claimed)> = vec![];
    for claimed in &request.claims {
        // Another table has the column.
        let Some(place) = claimed.place(table) else {
            continue;
        };
        if let Some((_, first)) = placed.iter().find(|(known, _)| *known == place) {
            return Err(claimed.repeats(first));
        }
        placed.push((place, claimed));
    }
    let columns = table.source.table.all().enumerate();
    Ok(columns
        .map(|(k, column)| closest(&placed, k, column))
        .collect())
}

fn claims_of(
    request: &Request,
    source: &SourceTable,
    closest: Vec<Option<&Claimed>>,
) -> Result<Vec<Option<Claim>>, Text> {
    let columns = source.table.all().zip(closest).enumerate();
    let claims = columns.map(|(k, (column, claimed))| match claimed {
        Some(claimed) if claimed.bound.is_least() && k >= source.table.columns.len() => {
            Err(Text::from("expected an order alone for values; found ")
                + Argument::Order.with(&claimed.text)
                + format!(" for `{}`", column.name))
        }
        Some(claimed) => claimed.claim(claimed.order(source)?, request).map(Some),
        None => Ok(None),
    });
    claims.collect()
}

/// The claim that names the column most closely: of its own table first, then by its name.
fn closest<'c>(placed: &[(Place, &'c Claimed)], k: usize, column: &Column) -> Option<&'c Claimed> {
    // What the caller has not chosen has an order only by its own name.
    let all = column.is_chosen.then_some(None);
    let columns = [Some(Some(k)), all].into_iter().flatten();
    let own = columns.clone().map(|column| (true, column));
    let mut places = own.chain(columns.map(|column| (false, column)));
    places.find_map(|(is_own, column)| {
        let place = Place { is_own, column };
        let mut placed = placed.iter();
        placed.find_map(|(known, claimed)| (*known == place).then_some(*claimed))
    })
}

impl Claimed {
    /// What it is about in a table: `L2`, or `Table 2:L2` behind the heading or the number of the
    /// table, or `Table 2:` for all its columns; `None` if the table has no such column.
    fn place(&self, table: TableNames<'_>) -> Option<Place> {
        let all = Place {
            is_own: false,
            column: None,
        };
        let Some(name) = &self.name else {
            return Some(all);
        };
        let names = || table.source.table.all().map(|column| column.name.as_str());
        if let Some(column) = position(names(), name) {
            let column = Some(column);
            return Some(Place { column, ..all });
        }
        let (of_table, name) = name.rsplit_once(':')?;
        let is_own = table.are(of_table);
        let column = match name.trim() {
            "" => None,
            name => Some(position(names(), name)?),
        };
        is_own.then_some(Place { is_own, column })
    }

    /// The claim of a number, which is an order or a factor.
    fn claim(&self, number: f64, request: &Request) -> Result<Claim, Text> {
        let bound = match self.bound {
            bound if !request.by_factor => bound,
            // No scheme gains an order over the degree: any larger factor may be right.
            bound if bound.is_least() => Bound::AnyAbove,
            _ => Bound::Both,
        };
        let usual = match request.by_factor {
            true if number <= 1.0 => {
                let words = format!("expected a factor > 1; found {}", self.text);
                return Err(words.into());
            }
            true => Claim::usual(order_of_factor(number), bound),
            false => Claim::usual(number, bound),
        };
        let tolerance = request.tolerance.unwrap_or(usual.tolerance);
        if request.tolerance.is_some() && tolerance >= usual.order {
            let order = plain_text(usual.order);
            let words =
                format!("expected a tolerance less than the order {order}; found {tolerance}");
            return Err(words.into());
        }
        Ok(Claim { tolerance, ..usual })
    }

    /// The order that is claimed of a table.
    fn order(&self, source: &SourceTable) -> Result<f64, Text> {
        let plus = match self.order {
            ClaimedOrder::Number(order) => return Ok(order),
            ClaimedOrder::Degree(plus) => plus,
        };
        let order = source.table.degree.map(|degree| f64::from(degree) + plus);
        order.filter(|order| *order > 0.0 && order.is_finite()).ok_or_else(|| {
            let found = order.map_or("none".to_owned(), |order| format!("an order of {order}"));
            Argument::Order.with(&self.text)
                + format!(
                    ": expected the degree of each table, in its heading as `p = 2` or in a column `p`, and an order > 0; found {found} for `{}`",
                    visible(&source.name)
                )
        })
    }

    /// The refusal of a second claim for a column, or for all columns.
    fn repeats(&self, first: &Self) -> Text {
        let found = Argument::Order.with(&self.text);
        match &self.name {
            Some(name) => {
                found + format!(": expected each column once; found `{name}` a second time")
            }
            None => {
                Text::from("expected one order for all columns, and ")
                    + Argument::Order.with("NAME=P")
                    + " for others; found "
                    + Argument::Order.with(&first.text)
                    + " and "
                    + found
            }
        }
    }

    /// The refusal of a claim about a column that is not judged.
    fn unknown(&self, names: &[&str]) -> Text {
        /// Most names that a message lists.
        const LISTED: usize = 12;
        let name = self.name.as_deref().unwrap_or_default();
        let more = if names.len() > LISTED { ", ..." } else { "" };
        let hint = if name.contains(['=', ',']) {
            Text::from("; repeat ") + Argument::Order.alone() + " for each column"
        } else {
            did_you_mean(&nearest(name, names.iter().copied()).map(str::to_owned)).into()
        };
        let known = names[..names.len().min(LISTED)].join(", ") + more;
        Argument::Order.with(&self.text)
            + format!(": expected a column of errors: {known}; found `{name}`")
            + hint
    }
}

#[cfg(test)]
mod tests {
    use super::{Bound, Claimed};

    #[test]
    fn a_claim_of_a_degree_may_take_any_higher_rate() {
        let claimed: Claimed = "L2=>=p+1..".parse().expect("a claim");
        assert_eq!(claimed.bound, Bound::AnyAbove);
    }
}
