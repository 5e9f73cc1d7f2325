//! `--where`: runs a study whose order is lost with the variants of its manufactured solution.

use std::path::Path;

use manufacture::{Manufacture, Sampling};

use super::exit::Unusable;
use super::running::watched_with;
use crate::input::read_text;
use crate::run::{self, Effort, Finished};
use crate::study::variants::Variants;
use crate::study::{Outcome, Study};
use crate::where_lost::{figure, is_unnoticed, located, lost, probe};

/// A study whose order is lost.
struct LostOrder<'s> {
    study: &'s dyn Study,
    /// Its place among the studies that have ended.
    place: usize,
    variants: Variants,
}

/// Whether a study has variants: its own, or those of a file of `manufacture`.
pub(super) fn has_variants(study: &dyn Study) -> bool {
    study.manufactured().is_some() || study.variants().is_some()
}

/// Refuses studies without variants, before anything is run.
///
/// # Errors
/// The first study without variants.
pub(super) fn require(studies: &[Box<dyn Study>]) -> Result<(), Unusable> {
    let without = studies.iter().find(|study| !has_variants(study.as_ref()));
    without.map_or(Ok(()), |study| Err(no_file(&study.header().id)))
}

/// A study, or all of them, without a file of `manufacture`.
pub(super) fn no_file(id: &str) -> Unusable {
    Unusable::because(&format!(
        "{id}: --where: found no `manufacture` in [program]; expected the file from which \
         `manufacture FILE --variants --language LANGUAGE` wrote the module that the program uses"
    ))
}

/// Finds where the order of each study is lost that does not pass, as far as its variants tell.
/// Studies without variants are left as they are, and so are those with a case without a result.
///
/// * `finished`: what the studies found, in their order.
///
/// # Errors
/// A file of `manufacture` that cannot be used, a variant that does not run, and a program that
/// does not notice the variant.
pub(super) fn locate(
    studies: &[Box<dyn Study>],
    finished: &mut [Finished],
    effort: Effort,
    quiet: bool,
) -> Result<(), Unusable> {
    let searches = searches(studies, finished)?;
    let empty = |search: &LostOrder<'_>| vec![None; search.variants.usable.len()];
    let mut ran: Vec<Vec<Option<Finished>>> = searches.iter().map(empty).collect();
    // A program that ignores the variable is refused after one variant.
    for is_probe in [true, false] {
        run_variants(&searches, is_probe, &mut ran, effort, quiet)?;
        for (search, ran) in searches.iter().zip(&ran) {
            refuse(&finished[search.place], &search.variants, ran)?;
        }
    }
    for (search, ran) in searches.iter().zip(ran) {
        let LostOrder {
            place, variants, ..
        } = search;
        let of_search: Vec<Finished> = ran.into_iter().flatten().collect();
        let base = &mut finished[*place];
        let outcomes: Vec<&Outcome> = of_search.iter().map(|ran| &ran.outcome).collect();
        let located = located(&base.outcome, variants, &outcomes);
        let figure = figure(&base.header, &base.outcome, &located);
        base.outcome.figures.extend(figure);
        base.located = Some(located);
    }
    Ok(())
}

/// Runs the probe of each search, or all other variants, in one pool.
///
/// * `ran`: for each search and each of its variants what it found, if it was run.
fn run_variants(
    searches: &[LostOrder<'_>],
    is_probe: bool,
    ran: &mut [Vec<Option<Finished>>],
    effort: Effort,
    quiet: bool,
) -> Result<(), Unusable> {
    let mut runs = vec![];
    let mut slots = vec![];
    for (search, ran) in searches.iter().zip(ran) {
        let probe = probe(&search.variants);
        let variants = search.variants.usable.iter().zip(ran).enumerate();
        for (place, (variant, slot)) in variants {
            if (probe == Some(place)) == is_probe
                && let Some(run) = search.study.with_variant(&variant.name)
            {
                runs.push(run);
                slots.push(slot);
            }
        }
    }
    if runs.is_empty() {
        return Ok(());
    }
    let finished = watched_with(&runs, quiet, false, |progress| {
        run::run(&runs, effort, progress)
    })?;
    for (slot, finished) in slots.into_iter().zip(finished) {
        *slot = Some(finished);
    }
    Ok(())
}

fn searches<'s>(
    studies: &'s [Box<dyn Study>],
    finished: &[Finished],
) -> Result<Vec<LostOrder<'s>>, Unusable> {
    let mut searches = vec![];
    for (place, finished) in finished.iter().enumerate() {
        let mut studies = studies.iter();
        let study = studies.find(|study| study.header().id == finished.header.id);
        let Some(study) = study.filter(|study| has_variants(study.as_ref())) else {
            continue;
        };
        if lost(&finished.outcome).is_empty() || !finished.failed_cases.is_empty() {
            continue;
        }
        let variants = match study.manufactured() {
            Some(file) => variants_of(file)?,
            None => study.variants(),
        };
        searches.extend(variants.map(|variants| LostOrder {
            study: study.as_ref(),
            place,
            variants,
        }));
    }
    Ok(searches)
}

/// Refuses variants that do not run, or that the program does not notice.
fn refuse(base: &Finished, variants: &Variants, ran: &[Option<Finished>]) -> Result<(), Unusable> {
    let id = &base.header.id;
    for (variant, finished) in variants.usable.iter().zip(ran) {
        let failed = finished.as_ref().map(|ran| ran.failed_cases.as_slice());
        if let Some([failed, ..]) = failed {
            return Err(Unusable::because(&format!(
                "{id}: --where: the variant {} does not run: {}: {}",
                variant.name, failed.label, failed.reason
            )));
        }
    }
    let outcomes: Vec<&Outcome> = ran.iter().flatten().map(|ran| &ran.outcome).collect();
    if is_unnoticed(&base.outcome, &outcomes) {
        return Err(Unusable::because(&format!(
            "{id}: --where: the errors do not change with the variant: the program does not notice \
             the variable MANUFACTURE_VARIANT of its environment. Likely reasons: its module was \
             written without --variants; it uses or was compiled with an older module; it is \
             started by something that does not pass the environment on, as MPI on other hosts \
             (`mpirun -x MANUFACTURE_VARIANT`), a container or a queue"
        )));
    }
    Ok(())
}

/// The variants of a file of `manufacture`, as its modules describe them to other programs.
fn variants_of(file: &Path) -> Result<Option<Variants>, Unusable> {
    let name = file.display().to_string();
    let manufacture = Manufacture::parse(&read_text(file)?, &name)?;
    let of_file = manufacture.variants(&Sampling::default())?;
    let description = serde_json::to_value(of_file.description());
    let variants = description.and_then(serde_json::from_value);
    variants.map_err(|error| Unusable::because(&error.to_string()))
}

#[cfg(test)]
mod tests {
    use manufacture::Switch;

    use crate::study::variants::SolverPart;

    #[test]
    fn each_part_of_a_file_is_one_of_the_search() {
        let name = || "x_max".to_owned();
        for (switch, part) in [
            (Switch::Coordinate(name()), SolverPart::Coordinate(name())),
            (Switch::Time(name()), SolverPart::Time(name())),
            (Switch::Face(name()), SolverPart::Face(name())),
            (Switch::BothFaces(name()), SolverPart::BothFaces(name())),
            (Switch::AllFaces, SolverPart::AllFaces),
            (Switch::AllFacesBut(name()), SolverPart::AllFacesBut(name())),
            (Switch::Initial, SolverPart::Initial),
            (Switch::AllFacesAndInitial, SolverPart::AllFacesAndInitial),
            (Switch::Parameter(name()), SolverPart::Parameter(name())),
            (Switch::Field(name()), SolverPart::Field(name())),
        ] {
            let read: SolverPart =
                serde_json::from_value(serde_json::to_value(switch).unwrap()).unwrap();
            assert_eq!(read, part);
        }
    }
}
