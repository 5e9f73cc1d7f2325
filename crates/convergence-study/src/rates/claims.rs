//! The orders that are claimed, and the claim for each column.

use std::str::FromStr;

use super::{Request, SourceTable, columns};
use crate::input::advice::{Argument, Text};
use crate::input::table::names::{is_degree, position};
use crate::judge::claims::{Bound, Claim, order_from_text, order_of_factor};
use crate::text::names::{did_you_mean, nearest};
use crate::text::number::plain_text;
use crate::text::visible::visible;

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
    Degree {
        /// The name of the degree.
        name: String,
        /// What is added.
        plus: f64,
    },
}

impl ClaimedOrder {
    /// `p`, `p+1`, `degree-1`.
    fn of_degree(text: &str) -> Option<Self> {
        let text = text.trim();
        let end = text.find(['+', '-']).unwrap_or(text.len());
        let (name, plus) = text.split_at(end);
        let name = name.trim();
        let plus: String = plus.split_whitespace().collect();
        let plus = if plus.is_empty() {
            0.0
        } else {
            plus.parse().ok()?
        };
        (is_degree(name) && f64::is_finite(plus)).then(|| Self::Degree {
            name: name.to_owned(),
            plus,
        })
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
struct ClaimedColumn {
    /// The number of the column; that of all columns behind the last one.
    column: usize,
    /// Whether the claim names the table.
    is_own: bool,
}

/// The claims for each column of each table. Each column that is named must be in one of them.
pub(super) fn claims(
    request: &Request,
    sources: &[SourceTable],
) -> Result<Vec<Vec<Option<Claim>>>, Text> {
    let all: Vec<&str> = sources
        .iter()
        .flat_map(|source| columns(&source.table))
        .map(|column| column.name.as_str())
        .collect();
    for claimed in &request.claims {
        let mut sources = sources.iter().enumerate();
        if let Some(name) = &claimed.name
            && !sources.any(|(k, source)| place(name, k, source).is_some())
        {
            return Err(unknown(name, &claimed.text, &all));
        }
    }
    let sources = sources.iter().enumerate();
    let claims = sources.map(|(k, source)| claims_of(request, k, source));
    claims.collect()
}

/// Where a table has the column of this name: `L2`, or `Table 2:L2` behind the heading or the
/// number of the table, or `Table 2:` for all its columns.
///
/// * `number`: of the table, from 0.
fn place(name: &str, number: usize, source: &SourceTable) -> Option<ClaimedColumn> {
    let names = || columns(&source.table).map(|column| column.name.as_str());
    if let Some(column) = position(names(), name) {
        return Some(ClaimedColumn {
            column,
            is_own: false,
        });
    }
    let (table, name) = name.rsplit_once(':')?;
    let table = table.trim().to_lowercase();
    let numbered = [format!("table {}", number + 1), (number + 1).to_string()];
    if table != source.table.name.to_lowercase() && !numbered.contains(&table) {
        return None;
    }
    let column = match name.trim() {
        "" => names().count(),
        name => position(names(), name)?,
    };
    Some(ClaimedColumn {
        column,
        is_own: true,
    })
}

/// The claim for each column; `None` without one. A claim about this table goes before one about
/// all, and one about a column before one about all columns.
fn claims_of(
    request: &Request,
    number: usize,
    source: &SourceTable,
) -> Result<Vec<Option<Claim>>, Text> {
    let names: Vec<&str> = columns(&source.table)
        .map(|column| column.name.as_str())
        .collect();
    let is_chosen: Vec<bool> = columns(&source.table)
        .map(|column| column.is_chosen)
        .collect();
    // The last entry is the claim for all columns.
    let mut general: Vec<Option<&Claimed>> = vec![None; names.len() + 1];
    let mut own = general.clone();
    for claimed in &request.claims {
        let all = ClaimedColumn {
            column: names.len(),
            is_own: false,
        };
        let place = claimed
            .name
            .as_deref()
            .map_or(Some(all), |name| place(name, number, source));
        // Another table has the column.
        let Some(ClaimedColumn { column, is_own }) = place else {
            continue;
        };
        let claims = if is_own { &mut own } else { &mut general };
        if let Some(first) = claims[column].replace(claimed) {
            return Err(repeated(first, claimed, names.get(column).copied()));
        }
    }
    let all = names.len();
    // What the caller has not chosen has an order only by its own name.
    let [own_of_all, general_of_all] = [own[all], general[all]];
    let claim_of = |(k, name): (usize, &&str)| {
        let of_all = |claimed: Option<&Claimed>| claimed.filter(|_| is_chosen[k]).cloned();
        let own = own[k].cloned().or_else(|| of_all(own_of_all));
        let claimed = own.or_else(|| general[k].cloned());
        match claimed.or_else(|| of_all(general_of_all)) {
            Some(claimed) if claimed.bound.is_least() && k >= source.table.columns.len() => {
                Err(Text::from("expected an order alone for values; found ")
                    + Argument::Order.with(&claimed.text)
                    + format!(" for `{name}`"))
            }
            Some(claimed) => claim(&claimed, order(&claimed, source)?, request).map(Some),
            None => Ok(None),
        }
    };
    names.iter().enumerate().map(claim_of).collect()
}

/// The claim of a number, which is an order or a factor.
fn claim(claimed: &Claimed, number: f64, request: &Request) -> Result<Claim, Text> {
    let expected = |what: &str, found: &str| Text::from(format!("expected {what}; found {found}"));
    let usual = if !request.by_factor {
        Claim::usual(number, claimed.bound)
    } else if number > 1.0 {
        // No scheme gains an order over the degree: any larger factor may be right.
        let is_least = claimed.bound.is_least();
        let bound = if is_least {
            Bound::AnyAbove
        } else {
            Bound::Both
        };
        Claim::usual(order_of_factor(number), bound)
    } else {
        return Err(expected("a factor > 1", &claimed.text));
    };
    match request.tolerance {
        None => Ok(usual),
        Some(tolerance) if tolerance >= usual.order => {
            let order = plain_text(usual.order);
            Err(expected(
                &format!("a tolerance less than the order {order}"),
                &tolerance.to_string(),
            ))
        }
        Some(tolerance) => Ok(Claim { tolerance, ..usual }),
    }
}

/// The order that is claimed of a table.
fn order(claimed: &Claimed, source: &SourceTable) -> Result<f64, Text> {
    let (name, plus) = match &claimed.order {
        ClaimedOrder::Number(order) => return Ok(*order),
        ClaimedOrder::Degree { name, plus } => (name, plus),
    };
    let order = source.table.degree.map(|degree| f64::from(degree) + plus);
    order.filter(|order| *order > 0.0 && order.is_finite()).ok_or_else(|| {
        let found = order.map_or("none".to_owned(), |order| format!("an order of {order}"));
        Argument::Order.with(&claimed.text)
            + format!(
                ": expected the number `{name}` of each table, in its heading as `{name} = 2` or in a column, and an order > 0; found {found} for `{}`",
                visible(&source.name)
            )
    })
}

/// The refusal of a second claim for a column, or for all columns.
fn repeated(first: &Claimed, second: &Claimed, column: Option<&str>) -> Text {
    let found = Argument::Order.with(&second.text);
    match column {
        Some(name) => found + format!(": expected each column once; found `{name}` a second time"),
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
fn unknown(name: &str, claim: &str, names: &[&str]) -> Text {
    /// Most names that a message lists.
    const LISTED: usize = 12;
    let more = if names.len() > LISTED { ", ..." } else { "" };
    let hint = if name.contains(['=', ',']) {
        Text::from("; repeat ") + Argument::Order.alone() + " for each column"
    } else {
        did_you_mean(&nearest(name, names.iter().copied()).map(str::to_owned)).into()
    };
    let known = names[..names.len().min(LISTED)].join(", ") + more;
    Argument::Order.with(claim)
        + format!(": expected a column of errors: {known}; found `{name}`")
        + hint
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
