//! `--where`: runs a study whose order is lost with the variants of its manufactured solution.

use std::path::Path;

use manufacture::{Manufacture, Sampling};

use super::exit::Unusable;
use super::running::watched_with;
use crate::input::read_text;
use crate::run::{self, Effort, Finished};
use crate::study::variants::Variants;
use crate::study::{Outcome, Study};
use crate::where_lost::{figure, is_unnoticed, located, lost};

/// A study whose order is lost.
struct Search<'s> {
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
/// A file of `manufacture` that cannot be used, a variant that does not run, and a program that does
/// not notice the variant.
pub(super) fn locate(
    studies: &[Box<dyn Study>],
    finished: &mut [Finished],
    effort: Effort,
    quiet: bool,
) -> Result<(), Unusable> {
    let searches = searches(studies, finished)?;
    let mut runs = vec![];
    for Search {
        study, variants, ..
    } in &searches
    {
        for variant in &variants.usable {
            runs.extend(study.with_variant(&variant.name));
        }
    }
    let ran = watched_with(&runs, quiet, false, |progress| {
        run::run(&runs, effort, progress)
    })?;
    let mut ran = ran.into_iter();
    for Search {
        place, variants, ..
    } in &searches
    {
        let of_search: Vec<Finished> = ran.by_ref().take(variants.usable.len()).collect();
        let base = &mut finished[*place];
        refuse(base, variants, &of_search)?;
        let outcomes: Vec<&Outcome> = of_search.iter().map(|ran| &ran.outcome).collect();
        let located = located(&base.outcome, variants, &outcomes);
        let figure = figure(&base.header, &base.outcome, &located);
        base.outcome.figures.extend(figure);
        base.located = Some(located);
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
        searches.extend(variants.map(|variants| Search {
            study: study.as_ref(),
            place,
            variants,
        }));
    }
    Ok(searches)
}

/// Refuses variants that do not run, or that the program does not notice.
fn refuse(base: &Finished, variants: &Variants, ran: &[Finished]) -> Result<(), Unusable> {
    let id = &base.header.id;
    for (variant, finished) in variants.usable.iter().zip(ran) {
        if let Some(failed) = finished.failed_cases.first() {
            return Err(Unusable::because(&format!(
                "{id}: --where: the variant {} does not run: {}: {}",
                variant.name, failed.label, failed.reason
            )));
        }
    }
    let outcomes: Vec<&Outcome> = ran.iter().map(|ran| &ran.outcome).collect();
    if is_unnoticed(&base.outcome, &outcomes) {
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

    use crate::study::variants::Part;

    #[test]
    fn each_part_of_a_file_is_one_of_the_search() {
        let name = || "x_max".to_owned();
        for (switch, part) in [
            (Switch::Coordinate(name()), Part::Coordinate(name())),
            (Switch::Time(name()), Part::Time(name())),
            (Switch::Face(name()), Part::Face(name())),
            (Switch::BothFaces(name()), Part::BothFaces(name())),
            (Switch::AllFaces, Part::AllFaces),
            (Switch::AllFacesBut(name()), Part::AllFacesBut(name())),
            (Switch::Initial, Part::Initial),
            (Switch::AllFacesAndInitial, Part::AllFacesAndInitial),
            (Switch::Parameter(name()), Part::Parameter(name())),
            (Switch::Field(name()), Part::Field(name())),
        ] {
            let read: Part = serde_json::from_value(serde_json::to_value(switch).unwrap()).unwrap();
            assert_eq!(read, part);
        }
    }
}
