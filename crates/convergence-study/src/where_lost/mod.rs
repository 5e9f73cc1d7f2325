//! Where the order of a study is lost: what the variants of its solution show, each of which
//! switches off a part of the solver.
//!
//! | file | holds |
//! | --- | --- |
//! | `decide.rs` | what follows from the variants in which the order comes back |
//! | `fate.rs` | whether it does |
//! | `words.rs` | the table of variants, the conclusion |
//! | `figure.rs` | the rates by variant |

mod decide;
mod fate;
mod figure;
mod words;

use crate::judge::verdict::Verdict;
use crate::run::{Fate, Located, VariantRate, VariantRates};
use crate::study::Outcome;
use crate::study::variants::{LeftOutVariant, SolverPart, Variant, Variants};
use decide::{Examined, decide};
use fate::{Sized, fate};

pub use figure::figure;
pub(crate) use words::summary_of_located;
pub use words::text_of_located;

/// The errors whose rates do not pass; values without an exact solution are not compared.
pub fn lost(outcome: &Outcome) -> Vec<String> {
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

/// The place of the variant that is run first, if there is one: its errors are not those of the
/// study unless the solver ignores it, for with a bubble the solution is no polynomial of low
/// degree, for which schemes are exact.
pub fn probe(variants: &Variants) -> Option<usize> {
    let has_bubble = |variant: &Variant| {
        matches!(
            variant.switches_off,
            SolverPart::BothFaces(_) | SolverPart::AllFaces | SolverPart::AllFacesAndInitial
        )
    };
    variants.usable.iter().position(has_bubble)
}

/// Whether the errors are those of the study in every variant: the solver does not notice it.
pub fn is_unnoticed(base: &Outcome, ran: &[&Outcome]) -> bool {
    let is_same = |outcome: &&Outcome| {
        let mut levels = base.levels.iter().zip(&outcome.levels);
        levels.all(|(base, variant)| base.errors == variant.errors)
    };
    !ran.is_empty() && ran.iter().all(is_same)
}

/// Where the order of errors is lost.
///
/// * `base`: the study that has lost it, in the errors of [`lost`].
/// * `ran`: the study with each of the usable variants, in their order.
pub fn located(base: &Outcome, variants: &Variants, ran: &[&Outcome]) -> Located {
    let errors = lost(base);
    let of_base = Sized {
        outcome: base,
        size: variants.size,
    };
    let mut examined = vec![];
    let mut rows = vec![];
    for (variant, outcome) in variants.usable.iter().zip(ran) {
        let size = variant.size;
        let fate = fate(&errors, of_base, Sized { outcome, size });
        let part = variant.switches_off.clone();
        examined.push(Examined { part, fate });
        let rates = errors.iter().filter_map(|error| {
            Some(VariantRate {
                error: error.clone(),
                rate: outcome.rate(error)?.clone(),
            })
        });
        rows.push(VariantRates {
            name: variant.name.clone(),
            switches_off: variant.switches_off.clone(),
            order: fate,
            rates: rates.collect(),
            left_out: None,
        });
    }
    for LeftOutVariant {
        name,
        switches_off,
        why,
    } in &variants.left_out
    {
        let part = switches_off.clone();
        let fate = Fate::Unknown;
        examined.push(Examined { part, fate });
        rows.push(VariantRates {
            name: name.clone(),
            switches_off: switches_off.clone(),
            order: fate,
            rates: vec![],
            left_out: Some(why.clone()),
        });
    }
    let conclusion = decide(&examined);
    let tendency = errors.iter().find_map(|error| base.rate(error)?.tendency);
    Located {
        named: conclusion.named(),
        conclusion: words::sentence(&conclusion, &rows, tendency, variants),
        variants: rows,
    }
}
