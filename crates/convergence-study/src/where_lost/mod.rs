//! Where the order of a study is lost: what the variants of its solution show, each of which
//! switches off a part of the solver.
//!
//! | file | holds |
//! | --- | --- |
//! | `decide.rs` | a table of variants and one rule: what follows from those in which the order comes back |
//! | `fate.rs` | whether it does |
//! | `words.rs` | the table of variants, the conclusion |
//! | `figure.rs` | the rates by variant |

mod decide;
mod fate;
mod figure;
mod words;

use crate::run::{Fate, VariantRate, VariantRates, WhereLost};
use crate::study::Outcome;
use crate::study::variants::{SolverPart, Variants};
use crate::text::named::NamedNumber;
use crate::text::number::plain_text;
use convergence_judge::verdict::Verdict;
use decide::{Examined, Table};
use fate::{Sized, fate};

pub(crate) use words::summary;

/// The errors whose rates do not pass; values without an exact solution are not compared.
pub(crate) fn lost(outcome: &Outcome) -> Vec<String> {
    let is_error = |name: &str| {
        let mut errors = outcome.levels.iter().flat_map(|level| &level.errors);
        errors.any(|error| error.name == name)
    };
    let lost = outcome
        .rates
        .iter()
        .filter(|rate| rate.rate.verdict != Verdict::Pass && is_error(&rate.name));
    lost.map(|rate| rate.name.clone()).collect()
}

/// Levels of a variant at first: the fewest of which a rate has an interval.
const FIRST_LEVELS: usize = 3;

/// Levels of a variant beyond those of the study, at most.
const MORE_LEVELS: usize = 2;

/// A variant that is to be run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Request {
    /// Its place among the usable variants.
    pub place: usize,
    /// The number of levels; `None` for those of the study.
    pub levels: Option<usize>,
}

/// What a variant has shown.
struct Shown {
    outcome: Outcome,
    /// The number of levels that were requested.
    requested: Option<usize>,
}

/// A search for the place where the order of errors is lost: it requests variants until they name a
/// part, or nothing can. What follows from others is not run: where the order is lost, it is lost
/// wherever less is switched off; where it is back, it is back wherever more is.
pub struct Search<'s> {
    base: &'s Outcome,
    variants: &'s Variants,
    errors: Vec<String>,
    /// The number of levels of the study, if that of a variant can differ.
    levels: Option<usize>,
    /// Of each usable variant.
    shown: Vec<Option<Shown>>,
}

impl<'s> Search<'s> {
    /// * `base`: the study whose errors have lost their order.
    /// * `levels`: the number of its levels, if that of a variant can differ.
    pub fn new(base: &'s Outcome, variants: &'s Variants, levels: Option<usize>) -> Self {
        Self {
            base,
            variants,
            errors: lost(base),
            levels,
            shown: variants.usable.iter().map(|_| None).collect(),
        }
    }

    /// Whether there is anything to search for: an error whose rate does not pass.
    pub fn is_worthwhile(base: &Outcome) -> bool {
        !lost(base).is_empty()
    }

    /// What to run next; nothing if no variant can change the conclusion.
    pub fn next(&self) -> Vec<Request> {
        let probe = self.probe();
        if self.shown.iter().all(Option::is_none) && probe.is_some() {
            return self.requests(|place| Some(place) == probe);
        }
        let table = Table::new(&self.examined());
        let unseen = |rank: usize| {
            self.requests(|place| {
                let is_open = table.rows[place].fate == Fate::Unknown;
                self.rank(place) == rank && is_open && self.shown[place].is_none()
            })
        };
        let wider = |parts: Vec<SolverPart>| self.of_parts(&parts, None);
        // What explains all losses must be seen at the levels of the study.
        let explaining = self.of_parts(&table.explaining(), self.levels);
        let questions = std::iter::once(explaining)
            .chain([unseen(0)])
            // Inside or at the boundary: that is one question, before all faces.
            .chain([wider(table.open_inside())])
            .chain((1..=LAST_RANK).map(unseen))
            .chain([wider(table.may_explain_all()), wider(table.open())]);
        let mut questions = questions.filter(|requests| !requests.is_empty());
        questions.next().unwrap_or_default()
    }

    /// Requests for the variants of these parts.
    ///
    /// * `least`: only for those with fewer levels.
    fn of_parts(&self, parts: &[SolverPart], least: Option<usize>) -> Vec<Request> {
        let is_short = |place: usize| {
            let shown = self.shown[place].as_ref();
            least.is_none() || shown.is_some_and(|shown| shown.requested < least)
        };
        self.requests(|place| {
            parts.contains(&self.variants.usable[place].switches_off) && is_short(place)
        })
    }

    /// Keeps what a variant has shown.
    pub fn add(&mut self, request: Request, outcome: Outcome) {
        self.shown[request.place] = Some(Shown {
            outcome,
            requested: request.levels,
        });
    }

    /// Whether the errors are those of the study in every variant that was run, but for what noise
    /// leaves of them: the solver does not notice it.
    pub fn is_unnoticed(&self) -> bool {
        let is_same = |shown: &Shown| {
            let mut levels = self.base.levels.iter().zip(&shown.outcome.levels);
            levels.all(|(base, variant)| {
                let mut pairs = base.errors.iter().zip(&variant.errors);
                base.errors.len() == variant.errors.len() && pairs.all(|(a, b)| is_noise(a, b))
            })
        };
        let mut shown = self.shown.iter().flatten().peekable();
        shown.peek().is_some() && shown.all(is_same)
    }

    /// The variant that is run first: its errors are not those of the study unless the solver
    /// ignores it, for with a bubble the solution is no polynomial of low degree, for which schemes
    /// are exact. Of these the one that switches off most.
    fn probe(&self) -> Option<usize> {
        let mut ranked: Vec<usize> = (0..self.shown.len()).collect();
        ranked.retain(|place| {
            let part = &self.variants.usable[*place].switches_off;
            matches!(
                part,
                SolverPart::BothFaces(_) | SolverPart::AllFaces | SolverPart::AllFacesAndInitial
            )
        });
        ranked.into_iter().min_by_key(|place| self.rank(*place))
    }

    /// When a variant is run: those that exclude most others first.
    fn rank(&self, place: usize) -> usize {
        match self.variants.usable[place].switches_off {
            SolverPart::Coordinate(_)
            | SolverPart::Time(_)
            | SolverPart::Parameter(_)
            | SolverPart::Field(_)
            | SolverPart::AllFacesAndInitial => 0,
            SolverPart::AllFaces | SolverPart::Initial => 1,
            SolverPart::BothFaces(_) => 2,
            SolverPart::Face(_) => 3,
            SolverPart::AllFacesBut(_) => LAST_RANK,
        }
    }

    /// Requests for these variants, if they can be run with more levels than before.
    fn requests(&self, is_wanted: impl Fn(usize) -> bool) -> Vec<Request> {
        let places = (0..self.shown.len()).filter(|place| is_wanted(*place));
        let requests = places.filter_map(|place| {
            let levels = match (&self.shown[place], self.levels) {
                (None, levels) => levels.map(|listed| listed.min(FIRST_LEVELS)),
                (Some(shown), Some(listed)) => {
                    let requested = shown.requested?;
                    // Fewer than requested: the next one takes too long.
                    let is_last = shown.outcome.levels.len() < requested;
                    (!is_last && requested < listed + MORE_LEVELS).then_some(())?;
                    Some(requested + 1)
                }
                (Some(_), None) => return None,
            };
            Some(Request { place, levels })
        });
        requests.collect()
    }

    /// What became of the order of these errors in a usable variant.
    fn fate(&self, errors: &[String], place: usize) -> Fate {
        let base = Sized {
            outcome: self.base,
            size: self.variants.size,
        };
        let Some(Shown { outcome, .. }) = &self.shown[place] else {
            return Fate::Unknown;
        };
        let size = self.variants.usable[place].size;
        fate(errors, base, Sized { outcome, size })
    }

    fn examined(&self) -> Vec<Examined> {
        let usable = self.variants.usable.iter().enumerate();
        let usable = usable.map(|(place, variant)| Examined {
            part: variant.switches_off.clone(),
            fate: self.fate(&self.errors, place),
        });
        let left_out = self.variants.left_out.iter().map(|variant| Examined {
            part: variant.switches_off.clone(),
            fate: Fate::Unknown,
        });
        usable.chain(left_out).collect()
    }

    /// Where the order is lost.
    pub fn where_lost(&self) -> WhereLost {
        let table = Table::new(&self.examined());
        let conclusion = table.conclusion();
        let usable = self.variants.usable.iter().map(|one| (&one.name, None));
        let left_out = self.variants.left_out.iter();
        let left_out = left_out.map(|one| (&one.name, Some(one.why.clone())));
        let mut rows = vec![];
        for (place, (name, left_out)) in usable.chain(left_out).enumerate() {
            let shown = self.shown.get(place).and_then(Option::as_ref);
            let outcome = shown.map(|shown| &shown.outcome);
            let rates = self.errors.iter().filter_map(|error| {
                Some(VariantRate {
                    error: error.clone(),
                    rate: outcome?.rate(error)?.clone(),
                })
            });
            let mut rates: Vec<VariantRate> = rates.collect();
            let row = &table.rows[place];
            rates.sort_by_cached_key(|rate| {
                self.fate(std::slice::from_ref(&rate.error), place) != row.measured
            });
            rows.push(VariantRates {
                name: name.clone(),
                switches_off: row.part.clone(),
                order: row.fate,
                rates,
                left_out,
                next: outcome.and_then(finer),
            });
        }
        let mut errors = self.errors.iter();
        let tendency = errors.find_map(|error| self.base.rate(error)?.tendency);
        WhereLost {
            named: conclusion.named(),
            conclusion: words::sentence(&conclusion, &rows, tendency, self.variants),
            variants: rows,
        }
    }
}

const LAST_RANK: usize = 4;

/// Errors of two solutions differ by more than this share of them.
const NOISE: f64 = 1e-6;

/// Whether two errors of one name differ by noise alone.
fn is_noise(one: &NamedNumber, other: &NamedNumber) -> bool {
    let largest = one.value.abs().max(other.value.abs());
    one.name == other.name && (one.value - other.value).abs() <= NOISE * largest
}

/// The level after the last of an outcome, in words: parameters that grow are doubled.
fn finer(outcome: &Outcome) -> Option<String> {
    let [.., before, last] = outcome.levels.as_slice() else {
        return None;
    };
    let growing = last.parameters.iter().filter(|parameter| {
        let smaller = before.parameter(&parameter.name);
        smaller.is_some_and(|smaller| smaller < parameter.value)
    });
    let doubled = growing.map(|parameter| {
        let value = plain_text(2.0 * parameter.value);
        format!("{} = {value}", parameter.name)
    });
    let doubled: Vec<String> = doubled.collect();
    (!doubled.is_empty()).then(|| doubled.join(", "))
}
