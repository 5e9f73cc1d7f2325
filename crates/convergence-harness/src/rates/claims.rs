//! The orders that are claimed, and the claim for each column.

use super::{Request, Source, columns};
use crate::input::advice::{Argument, Text};
use crate::input::error_table::{RateTable, names::position};
use crate::judge::claims::{Claim, order_from_text};
use crate::text::names::{did_you_mean, nearest};

/// An order that is claimed, for one column or for all.
#[derive(Debug, Clone, PartialEq)]
pub struct Claimed {
    /// As the caller has written it.
    pub text: String,
    /// The column; `None` for all.
    pub name: Option<String>,
    /// The order, > 0.
    pub order: f64,
    /// Whether a higher rate agrees with it.
    pub at_least: bool,
}

/// A value of `--order`.
///
/// # Errors
/// What was expected.
pub fn claimed(text: &str) -> Result<Claimed, String> {
    let at = text
        .rfind(">=")
        .or_else(|| text.rfind('=').map(|at| at + 1));
    let (name, order) = text.split_at(at.unwrap_or(0));
    let name = name.trim_end();
    let order = order_from_text(order).filter(|_| name.is_empty() || name.ends_with('='));
    let (order, at_least) = order
        .ok_or("expected a number > 0, '>=P' with such a number P, or NAME= before one of them")?;
    Ok(Claimed {
        text: text.to_owned(),
        name: name.strip_suffix('=').map(str::to_owned),
        order,
        at_least,
    })
}

/// The claims for each column of each table. Each column that is named must be in one of them.
pub(super) fn claims(
    request: &Request,
    sources: &[Source],
) -> Result<Vec<Vec<Option<Claim>>>, Text> {
    let all: Vec<&str> = sources
        .iter()
        .flat_map(|source| columns(&source.table))
        .map(|column| column.name.as_str())
        .collect();
    for claimed in &request.claims {
        let is_in = |source: &Source, name: &str| {
            let names = columns(&source.table).map(|column| column.name.as_str());
            position(names, name).is_some()
        };
        if let Some(name) = &claimed.name
            && !sources.iter().any(|source| is_in(source, name))
        {
            return Err(unknown(name, &claimed.text, &all));
        }
    }
    let claims = sources
        .iter()
        .map(|source| claims_of(request, &source.table));
    claims.collect()
}

/// The claim for each column; `None` without one.
fn claims_of(request: &Request, table: &RateTable) -> Result<Vec<Option<Claim>>, Text> {
    let names: Vec<&str> = columns(table).map(|column| column.name.as_str()).collect();
    // The last entry is the claim for all columns.
    let mut of: Vec<Option<&Claimed>> = vec![None; names.len() + 1];
    for claimed in &request.claims {
        let place = claimed.name.as_deref().map_or(Some(names.len()), |name| {
            position(names.iter().copied(), name)
        });
        // Another table has the column.
        let Some(k) = place else { continue };
        if let Some(first) = of[k].replace(claimed) {
            return Err(repeated(first, claimed, names.get(k).copied()));
        }
    }
    let claim = |(k, name): (usize, &&str)| match of[k].or(of[names.len()]) {
        Some(claimed) if claimed.at_least && k >= table.columns.len() => {
            let order = format!("'>={}'", claimed.order);
            Err(Text::from("expected an order alone for values; found ")
                + Argument::Order.with(&order)
                + format!(" for `{name}`"))
        }
        Some(claimed) => Ok(Some(Claim {
            at_least: claimed.at_least,
            ..Claim::new(claimed.order, request.tolerance)
        })),
        None => Ok(None),
    };
    names.iter().enumerate().map(claim).collect()
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
