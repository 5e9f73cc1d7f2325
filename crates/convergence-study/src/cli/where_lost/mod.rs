//! `--where`: runs a study whose order is lost with variants of its manufactured solution, each of
//! which switches off a part of the program, and says in which part the order is lost.
//!
//! | file | holds |
//! | --- | --- |
//! | `decide.rs` | what follows from the variants in which the order comes back |
//! | `fate.rs` | whether it does |
//! | `words.rs` | the table of variants, the conclusion |

mod decide;
mod fate;
mod words;

use manufacture::{LeftOut, Manufacture, Sampling, Switch, Variants};

use super::exit::Unusable;
use super::running::watched_with;
use crate::input::read_text;
use crate::judge::verdict::Verdict;
use crate::run::{self, Effort, Fate, Finished, Located, Part, VariantRate, VariantRates};
use crate::study::{Outcome, Study};
use decide::{Examined, decide};
use fate::{Sized, fate};

pub(super) use words::text;

/// A study whose order is lost.
struct Search<'s> {
    study: &'s dyn Study,
    /// Its place among the studies that have ended.
    place: usize,
    /// The errors whose rates do not pass.
    errors: Vec<String>,
    manufacture: Manufacture,
}

/// Refuses studies without variants, before anything is run.
///
/// # Errors
/// The first study without a file of `manufacture`.
pub(super) fn require(studies: &[Box<dyn Study>]) -> Result<(), Unusable> {
    let without = studies.iter().find(|study| study.manufactured().is_none());
    without.map_or(Ok(()), |study| Err(no_file(&study.header().id)))
}

/// A study, or all of them, without a file of `manufacture`.
pub(super) fn no_file(id: &str) -> Unusable {
    Unusable::because(&format!(
        "{id}: --where: found no `manufacture` in [program]; expected the file from which \
         `manufacture FILE --variants --language python` wrote the module that the program uses"
    ))
}

/// Finds where the order of each study is lost that does not pass, as far as its variants tell.
/// Studies without a file of `manufacture` are left as they are, and so are those with a case
/// without a result.
///
/// * `finished`: what the studies found, in their order.
///
/// # Errors
/// A file of `manufacture` that cannot be used, a variant that does not run, and a program that does
/// not notice the variant.
pub(super) fn locate(
    studies: &[Box<dyn Study>],
    finished: &mut [Finished],
    effort: Effort,
    quiet: bool,
) -> Result<(), Unusable> {
    let searches = searches(studies, finished)?;
    let sampling = Sampling::default();
    let mut variants = vec![];
    for search in &searches {
        variants.push(search.manufacture.variants(&sampling)?);
    }
    let mut runs = vec![];
    for (search, variants) in searches.iter().zip(&variants) {
        for variant in &variants.usable {
            runs.extend(search.study.with_variant(&variant.switch.variant()));
        }
    }
    let ran = watched_with(&runs, quiet, false, |progress| {
        run::run(&runs, effort, progress)
    })?;
    let mut ran = ran.into_iter();
    for (search, variants) in searches.iter().zip(&variants) {
        let of_search: Vec<Finished> = ran.by_ref().take(variants.usable.len()).collect();
        let base = &finished[search.place];
        refuse(base, variants, &of_search)?;
        let located = located(search, &base.outcome, variants, &of_search);
        finished[search.place].located = Some(located);
    }
    Ok(())
}

fn searches<'s>(
    studies: &'s [Box<dyn Study>],
    finished: &[Finished],
) -> Result<Vec<Search<'s>>, Unusable> {
    let mut searches = vec![];
    for (place, finished) in finished.iter().enumerate() {
        let mut studies = studies.iter();
        let study = studies.find(|study| study.header().id == finished.header.id);
        let Some((study, file)) = study.and_then(|study| Some((study, study.manufactured()?)))
        else {
            continue;
        };
        let errors = lost(&finished.outcome);
        if errors.is_empty() || !finished.failed_cases.is_empty() {
            continue;
        }
        let name = file.display().to_string();
        searches.push(Search {
            study: study.as_ref(),
            place,
            errors,
            manufacture: Manufacture::parse(&read_text(file)?, &name)?,
        });
    }
    Ok(searches)
}

/// The errors whose rates do not pass; values without an exact solution are not compared.
fn lost(outcome: &Outcome) -> Vec<String> {
    let is_error = |name: &str| {
        let mut errors = outcome.levels.iter().flat_map(|level| &level.errors);
        errors.any(|(known, _)| known == name)
    };
    let lost = outcome
        .rates
        .iter()
        .filter(|rate| rate.rate.verdict != Verdict::Pass && is_error(&rate.name));
    lost.map(|rate| rate.name.clone()).collect()
}

/// Refuses variants that do not run, or that the program does not notice.
fn refuse(base: &Finished, variants: &Variants<'_>, ran: &[Finished]) -> Result<(), Unusable> {
    let id = &base.header.id;
    for (variant, finished) in variants.usable.iter().zip(ran) {
        if let Some(failed) = finished.failed_cases.first() {
            return Err(Unusable::because(&format!(
                "{id}: --where: the variant {} does not run: {}: {}",
                variant.switch.variant(),
                failed.label,
                failed.reason
            )));
        }
    }
    let is_same = |finished: &Finished| {
        let levels = base.outcome.levels.iter().zip(&finished.outcome.levels);
        levels
            .into_iter()
            .all(|(base, variant)| base.errors == variant.errors)
    };
    if !ran.is_empty() && ran.iter().all(is_same) {
        return Err(Unusable::because(&format!(
            "{id}: --where: the errors are the same in all variants: the program does not notice \
             the variable MANUFACTURE_VARIANT of its environment. Likely reasons: its module was \
             written without --variants; it uses or was compiled with an older module; it is \
             started by something that does not pass the environment on, as MPI on other hosts \
             (`mpirun -x MANUFACTURE_VARIANT`), a container or a queue"
        )));
    }
    Ok(())
}

fn located(
    search: &Search<'_>,
    base: &Outcome,
    variants: &Variants<'_>,
    ran: &[Finished],
) -> Located {
    let mut examined = vec![];
    let mut rows = vec![];
    for (variant, finished) in variants.usable.iter().zip(ran) {
        let switch = &variant.switch;
        let of_variant = Sized {
            outcome: &finished.outcome,
            size: variant.size,
        };
        let of_base = Sized {
            outcome: base,
            size: variants.size,
        };
        let fate = fate(&search.errors, of_base, of_variant);
        examined.push(Examined {
            switch: switch.clone(),
            fate,
        });
        let rates = search.errors.iter().filter_map(|error| {
            Some(VariantRate {
                error: error.clone(),
                rate: finished.outcome.rate(error)?.clone(),
            })
        });
        rows.push(VariantRates {
            name: switch.variant(),
            switches_off: part(switch),
            order: fate,
            rates: rates.collect(),
        });
    }
    for LeftOut { switch, .. } in &variants.left_out {
        examined.push(Examined {
            switch: switch.clone(),
            fate: Fate::Unknown,
        });
        rows.push(VariantRates {
            name: switch.variant(),
            switches_off: part(switch),
            order: Fate::Unknown,
            rates: vec![],
        });
    }
    let conclusion = decide(&examined);
    let tendency = search
        .errors
        .iter()
        .find_map(|error| base.rate(error)?.tendency);
    Located {
        named: conclusion.named().iter().map(part).collect(),
        conclusion: words::sentence(&conclusion, &rows, tendency, variants),
        variants: rows,
    }
}

fn part(switch: &Switch) -> Part {
    Part {
        part: switch.part().to_owned(),
        name: switch.name().map(str::to_owned),
    }
}
