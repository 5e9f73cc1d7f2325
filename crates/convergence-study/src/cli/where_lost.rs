//! `--where`: runs a study whose order is lost with the variants of its manufactured solution.

use std::path::Path;

#[cfg(feature = "manufacture")]
use manufacture::{Manufacture, Sampling};

use super::exit::Unusable;
#[cfg(feature = "manufacture")]
use crate::input::Document;
use crate::run::{Finished, RunError};
use crate::study::variants::Variants;
use crate::study::{Outcome, Study};
use crate::where_lost::{Request, Search, lost};

/// Runs variants of studies.
type Run<'r> = &'r dyn Fn(&[Box<dyn Study + '_>]) -> Result<Vec<Finished>, RunError>;

/// A study whose order is lost.
struct LostOrder<'s> {
    study: &'s dyn Study,
    /// Its place among the studies that have ended.
    place: usize,
    variants: Variants,
}

/// Whether a study has variants: its own, or those of a file of `manufacture`.
fn has_variants(study: &dyn Study) -> bool {
    study.manufactured().is_some() || study.variants().is_some()
}

/// Refuses studies of which none has variants, before anything is run.
///
/// # Errors
/// There is no file of `manufacture`.
pub(super) fn require(studies: &[Box<dyn Study>]) -> Result<(), Unusable> {
    if studies.iter().any(|study| has_variants(study.as_ref())) {
        return Ok(());
    }
    let ids: Vec<&str> = studies.iter().map(|study| &*study.header().id).collect();
    let of = match ids[..] {
        [only] => only,
        _ => "no study",
    };
    Err(Unusable::because(&format!(
        "{of}: --where: found no `manufacture` in [program]; expected the file from which \
         `manufacture FILE --variants --language LANGUAGE` wrote the module that the program uses"
    )))
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
    run: Run<'_>,
) -> Result<(), Unusable> {
    let lost_orders = lost_orders(studies, finished)?;
    let outcomes = lost_orders
        .iter()
        .map(|one| finished[one.place].outcome.clone());
    let outcomes: Vec<Outcome> = outcomes.collect();
    let pairs = lost_orders.iter().zip(&outcomes);
    let searches =
        pairs.map(|(one, outcome)| Search::new(outcome, &one.variants, one.study.levels()));
    let mut searches: Vec<Search<'_>> = searches.collect();
    while run_next(&lost_orders, &mut searches, run)? {}
    for (lost_order, search) in lost_orders.iter().zip(searches) {
        let base = &mut finished[lost_order.place];
        let where_lost = search.where_lost();
        let figure = where_lost.figure(&base.header, &base.outcome);
        base.outcome.figures.extend(figure);
        base.where_lost = Some(where_lost);
    }
    Ok(())
}

/// Runs what the searches request, in one pool; whether they have requested anything.
fn run_next(
    lost_orders: &[LostOrder<'_>],
    searches: &mut [Search<'_>],
    run: Run<'_>,
) -> Result<bool, Unusable> {
    let mut runs = vec![];
    let mut requests: Vec<(usize, Request)> = vec![];
    for (number, (lost_order, search)) in lost_orders.iter().zip(searches.iter()).enumerate() {
        for request in search.next() {
            let name = &lost_order.variants.usable[request.place].name;
            if let Some(run) = lost_order.study.with_variant(name, request.levels) {
                runs.push(run);
                requests.push((number, request));
            }
        }
    }
    if runs.is_empty() {
        return Ok(false);
    }
    for ((number, request), finished) in requests.into_iter().zip(run(&runs)?) {
        let LostOrder {
            study, variants, ..
        } = &lost_orders[number];
        let id = &study.header().id;
        if let [failed, ..] = finished.failed_cases.as_slice() {
            return Err(Unusable::because(&format!(
                "{id}: --where: the variant {} does not run: {}: {}",
                variants.usable[request.place].name, failed.label, failed.reason
            )));
        }
        searches[number].add(request, finished.outcome);
    }
    for (LostOrder { study, .. }, search) in lost_orders.iter().zip(searches) {
        if search.is_unnoticed() {
            return Err(unnoticed(&study.header().id));
        }
    }
    Ok(true)
}

fn lost_orders<'s>(
    studies: &'s [Box<dyn Study>],
    finished: &[Finished],
) -> Result<Vec<LostOrder<'s>>, Unusable> {
    let mut lost_orders = vec![];
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
        lost_orders.extend(variants.map(|variants| LostOrder {
            study: study.as_ref(),
            place,
            variants,
        }));
    }
    Ok(lost_orders)
}

/// A study whose program does not notice the variant.
fn unnoticed(id: &str) -> Unusable {
    Unusable::because(&format!(
        "{id}: --where: the errors do not change with the variant: the program does not notice the \
         variable MANUFACTURE_VARIANT of its environment. Likely reasons: its module was written \
         without --variants; it uses or was compiled with an older module; it is started by \
         something that does not pass the environment on, as MPI on other hosts (`mpirun -x \
         MANUFACTURE_VARIANT`), a container or a queue"
    ))
}

/// The variants of a file of `manufacture`, as its modules describe them to other programs.
#[cfg(feature = "manufacture")]
fn variants_of(file: &Path) -> Result<Option<Variants>, Unusable> {
    let name = file.display().to_string();
    let manufacture = Manufacture::parse(&Document::text_of_file(file)?, &name)?;
    let manufacture = manufacture.with_variants(&Sampling::default())?;
    let description = serde_json::to_value(manufacture.variants());
    let variants = description.and_then(serde_json::from_value);
    variants.map_err(|error| Unusable::because(&error.to_string()))
}

/// No variants: the program was built without `manufacture`.
#[cfg(not(feature = "manufacture"))]
fn variants_of(file: &Path) -> Result<Option<Variants>, Unusable> {
    Err(Unusable::because(&format!(
        "{}: --where: found a program that was built without `manufacture`; expected one that was \
         installed, such as `convergence-study`",
        file.display()
    )))
}

#[cfg(all(test, feature = "manufacture"))]
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
