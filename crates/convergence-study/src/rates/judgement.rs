//! The columns of a table, judged.

use super::claims::claims;
use super::{Column, NotJudged, RateTable, Request, SourceTable};
use crate::column::{BoundaryLoss, EqualPair, INSIDE, MAX};
use crate::input::advice::Text;
use crate::input::table::Doubt;
use crate::text::number::plain_text;
use crate::text::visible::visible;
use convergence_judge::claims::{Claim, unless_algebraic};
use convergence_judge::richardson::{Estimate, Estimator};
use convergence_judge::verdict::{DEFAULT_TOLERANCE, Floor, JudgeError, RateVerdict, Verdict};

/// A column, judged.
pub(crate) struct JudgedColumn<'t> {
    pub(crate) column: &'t Column,
    pub(crate) claim: Option<Claim>,
    pub(crate) rate: RateVerdict,
    /// The same with factors for each unit of a count in place of rates, where they are claimed.
    pub(super) factors: Option<RateVerdict>,
    /// Only of a column of values, which tend to an unknown limit.
    pub(crate) estimate: Option<Estimate>,
    /// Whether its verdict counts.
    pub(super) decides: bool,
}

/// Everything that is printed and written about a table.
pub(crate) struct Judgement<'t> {
    /// The program of the caller, in the commands that advice names.
    pub(super) program: &'t str,
    pub(super) request: &'t Request,
    pub(crate) source: &'t SourceTable,
    /// Errors, then values.
    pub(crate) columns: Vec<JudgedColumn<'t>>,
    pub(super) floor: Floor,
    /// Errors that are equal in all digits.
    pub(crate) equals: Vec<EqualColumns>,
    /// Whether the boundary has a rate of its own.
    pub(crate) boundary: Option<BoundaryLoss>,
}

/// Two columns of errors that are equal on all levels, in all digits.
pub(crate) struct EqualColumns {
    pub(crate) names: [String; 2],
    /// Whether both have claims, of which then neither passes.
    pub(crate) are_claimed: bool,
}

impl std::fmt::Display for EqualColumns {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [one, other] = self.names.each_ref().map(|name| visible(name));
        write!(f, "{one} and {other} are equal in all digits")
    }
}

/// The judgements of all tables.
pub(crate) fn judgements<'t>(
    program: &'t str,
    sources: &'t [SourceTable],
    request: &'t Request,
) -> Result<Vec<Judgement<'t>>, NotJudged> {
    let floor = request.floor()?;
    if let Some(text) = without_errors(request, sources) {
        return Err(text.into());
    }
    let claims = claims(request, sources)?;
    let judgements = sources.iter().zip(claims).map(|(source, claims)| {
        let errors = source.table.columns.len();
        let columns = source.table.all().enumerate().zip(claims);
        let mut columns = columns
            .map(|((k, column), claim)| judged(column, k >= errors, claim, floor, request))
            .collect::<Result<Vec<_>, JudgeError>>()?;
        let equals = equal_columns(&mut columns);
        Ok(Judgement {
            program,
            request,
            source,
            equals,
            boundary: boundary(&columns, floor),
            columns,
            floor,
        })
    });
    judgements.collect()
}

/// What is known of the round-off of errors, if only values are judged, which would ignore it.
fn without_errors(request: &Request, sources: &[SourceTable]) -> Option<Text> {
    let given = [
        ("floor", Some(request.floor).filter(|floor| *floor > 0.0)),
        ("scale", request.scale),
        ("eps", request.eps),
    ];
    let mut given = given.into_iter();
    let (name, number) = given.find_map(|(name, number)| Some((name, number?)))?;
    let mut sources = sources.iter();
    let are_values = sources.all(|source| source.table.columns.is_empty());
    are_values.then(|| {
        Text::from(format!(
            "{name} = {}: expected a column of errors, found values alone, whose round-off is that of the largest of them",
            plain_text(number)
        ))
    })
}

/// The verdict on all tables.
pub(crate) fn verdict_of(findings: &[Judgement<'_>]) -> Verdict {
    Verdict::worst(findings.iter().map(Judgement::verdict))
}

impl Judgement<'_> {
    /// The verdict on all columns that count, and on the reading: what a failed run has printed may
    /// look right.
    pub(crate) fn verdict(&self) -> Verdict {
        let columns = self.deciding().map(|judged| judged.rate.verdict);
        let doubts = self.doubts_that_count().map(|_| Verdict::Inconclusive);
        let boundary = self.boundary.as_ref().map(|loss| loss.verdict);
        Verdict::worst(columns.chain(doubts).chain(boundary))
    }

    /// The columns of which the verdict counts.
    pub(crate) fn deciding(&self) -> impl Iterator<Item = &JudgedColumn<'_>> {
        self.columns.iter().filter(|judged| judged.decides)
    }

    /// What speaks against the verdict: not what is about an error without a claim.
    pub(crate) fn doubts_that_count(&self) -> impl Iterator<Item = &Doubt> {
        let is_idle = |doubt: &Doubt| {
            let column = doubt.column.as_ref();
            let mut columns = self.columns.iter();
            columns.any(|judged| Some(&judged.column.name) == column && !judged.decides)
        };
        let doubts = self.source.table.doubts.iter();
        doubts.filter(move |doubt| !is_idle(doubt))
    }

    /// The command with a floor that makes all columns pass that decide, if one is offered: the
    /// finest errors may be round-off.
    pub(super) fn command_with_floor(&self) -> Option<String> {
        let offered = self.columns.iter();
        let offered = offered.filter_map(|judged| judged.rate.offered_floor);
        let request = Request {
            floor: offered.reduce(f64::max)?,
            ..self.request.clone()
        };
        let floor = request.floor().ok()?;
        let passes = |judged: &JudgedColumn<'_>| match (&judged.claim, &judged.estimate) {
            (Some(claim), None) => judged.column.judge(claim, floor).verdict.is_pass(),
            _ => judged.rate.verdict.is_pass(),
        };
        let passes = self.deciding().all(passes);
        passes.then(|| request.command(self.program, &self.source.file))
    }
}

impl RateTable {
    /// The rates of all columns of errors, each against its claim: of two with claims that are equal
    /// in all digits none passes.
    ///
    /// * `claims`: one for each of [`columns`](Self::columns), or none.
    ///
    /// # Errors
    /// In words: what is claimed is not true at the boundary, by another column.
    pub fn judge(
        &self,
        claims: &[Option<Claim>],
        floor: Floor,
    ) -> Result<Vec<RateVerdict>, String> {
        let request = Request::default();
        let columns = self.columns.iter().zip(claims);
        let columns: Result<Vec<_>, JudgeError> = columns
            .map(|(column, claim)| judged(column, false, *claim, floor, &request))
            .collect();
        let mut columns = columns.map_err(|error| error.to_string())?;
        equal_columns(&mut columns);
        let is_claimed = claims.iter().any(Option::is_some);
        match boundary(&columns, floor) {
            Some(loss) if is_claimed && !loss.verdict.is_pass() => Err(loss.evidence),
            _ => Ok(columns.into_iter().map(|judged| judged.rate).collect()),
        }
    }
}

fn judged<'t>(
    column: &'t Column,
    is_value: bool,
    claim: Option<Claim>,
    floor: Floor,
    request: &Request,
) -> Result<JudgedColumn<'t>, JudgeError> {
    let tolerance = claim.map_or(request.tolerance, |claim| Some(claim.tolerance));
    let estimator = Estimator::new(tolerance.unwrap_or(DEFAULT_TOLERANCE))?;
    let order = claim.map(|claim| claim.order);
    let estimate = is_value.then(|| column.estimate(&estimator, order));
    let rate = match (&estimate, &claim) {
        (Some(estimate), _) => estimate.judged.clone(),
        (None, Some(claim)) if request.by_factor => {
            unless_algebraic(&column.levels, column.judge(claim, floor))
        }
        (None, Some(claim)) => column.judge(claim, floor),
        (None, None) => column.observe(floor),
    };
    Ok(JudgedColumn {
        column,
        claim,
        factors: request.by_factor.then(|| rate.as_factors()),
        rate,
        estimate,
        decides: request.all || claim.is_some(),
    })
}

/// Columns of errors that are equal; where both have claims, none of them passes.
fn equal_columns(columns: &mut [JudgedColumn<'_>]) -> Vec<EqualColumns> {
    // Errors come before values.
    let errors = columns.iter().filter(|judged| judged.estimate.is_none());
    let errors = errors.map(|judged| (judged.column, judged.claim.is_some()));
    let pairs = EqualPair::all(&errors.collect::<Vec<_>>());
    for k in 0..columns.len() {
        if let Some(other) = EqualPair::other(&pairs, k) {
            let rate = columns[k].rate.clone();
            columns[k].rate = rate.equal_to(&columns[other].column.name);
        }
    }
    let equals = pairs.into_iter().map(|pair| EqualColumns {
        names: [pair.first, pair.later].map(|k| columns[k].column.name.clone()),
        are_claimed: pair.are_claimed,
    });
    equals.collect()
}

/// Whether the boundary loses the order, of a table with the largest error and that inside.
fn boundary(columns: &[JudgedColumn<'_>], floor: Floor) -> Option<BoundaryLoss> {
    let named = |name: &str| {
        let mut errors = columns.iter().filter(|judged| judged.estimate.is_none());
        errors.find(|judged| judged.column.name == name)
    };
    let both = [named(MAX)?, named(INSIDE)?];
    let [max, inside] = both.map(|judged| judged.column.observe(floor));
    let passes = |name: &str| {
        named(name).is_some_and(|judged| judged.claim.is_some() && judged.rate.verdict.is_pass())
    };
    BoundaryLoss::of([MAX, INSIDE], [&max, &inside], passes)
}
