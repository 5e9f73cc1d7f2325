//! Studies of any kind in one form, as the runner sees them: their types are erased.

use std::mem;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::header::Header;
use super::in_code::unnoticed;
use super::kind::{Case, CaseFailure, Kind, Ran, Untested, judge};
use super::outcome::Outcome;
use super::variants::Variants;

/// A study of any kind, as the runner sees it.
pub trait Study: Send + Sync {
    /// Id, claim, tier and kind.
    fn header(&self) -> &Header;

    /// Lists the cases, with a place for the result of each.
    fn plan(&self) -> Box<dyn Plan + '_>;

    /// What it fails to test although it passes.
    fn untested(&self) -> Vec<Untested>;

    /// What it does not notice although it passes: each of its claims with a number just past it,
    /// NaN, or without a number; each guarded number that moves by twice its tolerance; each case
    /// without a result. Empty for a sound study.
    fn unnoticed(&self) -> Vec<String> {
        unnoticed(self.plan().as_ref())
    }

    /// As [`Kind::keep_answers`].
    fn keep_answers(&self, folder: &Path, may_reuse: bool);

    /// As [`Kind::manufactured`].
    fn manufactured(&self) -> Option<&Path>;

    /// As [`Kind::variants`].
    fn variants(&self) -> Option<Variants>;

    /// As [`Kind::levels`].
    fn levels(&self) -> Option<usize>;

    /// As [`Kind::with_variant`], with so many levels if their number is not fixed; its id ends
    /// with the variant.
    fn with_variant(&self, variant: &str, levels: Option<usize>) -> Option<Box<dyn Study + '_>>;
}

/// The cases of a study while they are run.
pub trait Plan: Send + Sync {
    /// Label and cost of each case.
    fn cases(&self) -> Vec<Case<()>>;

    /// Adds the case that [`Kind::more`] requests after all others have run; its number, or `None`
    /// if there are enough.
    fn more(&self) -> Option<usize>;

    /// Runs case number `index` and keeps its result.
    fn run(&self, index: usize);

    /// Replaces the result of case number `index` by a failure.
    fn fail(&self, index: usize, failure: CaseFailure);

    /// Why case number `index` has no result; `None` if it has one.
    fn failure(&self, index: usize) -> Option<CaseFailure>;

    /// Judges the results after each case has run.
    fn judge(&self) -> Outcome;

    /// The same as if case number `index` had no result.
    fn judge_without(&self, index: usize) -> Outcome;
}

/// The cases of a typed study, with a place for the result of each.
pub(crate) fn plan<K: Kind>(kind: &K) -> Box<dyn Plan + '_> {
    let ran = kind
        .cases()
        .into_iter()
        .map(|case| Ran {
            case,
            found: Err(never_run()),
        })
        .collect();
    Box::new(Typed {
        kind,
        ran: Mutex::new(ran),
    })
}

/// A typed study with its header.
#[derive(Debug, Clone, PartialEq)]
pub struct Described<K> {
    /// Id, claim, tier and kind.
    pub header: Header,
    /// What is run and judged.
    pub kind: K,
}

impl<K: Kind> Described<K> {
    /// A study in the form that the runner takes.
    pub fn boxed<'k>(header: Header, kind: K) -> Box<dyn Study + 'k>
    where
        K: 'k,
    {
        Box::new(Self { header, kind })
    }
}

impl<K: Kind> Study for Described<K> {
    fn header(&self) -> &Header {
        &self.header
    }

    fn plan(&self) -> Box<dyn Plan + '_> {
        plan(&self.kind)
    }

    fn untested(&self) -> Vec<Untested> {
        self.kind.untested()
    }

    fn keep_answers(&self, folder: &Path, may_reuse: bool) {
        self.kind.keep_answers(folder, may_reuse);
    }

    fn manufactured(&self) -> Option<&Path> {
        self.kind.manufactured()
    }

    fn variants(&self) -> Option<Variants> {
        self.kind.variants()
    }

    fn levels(&self) -> Option<usize> {
        self.kind.levels()
    }

    fn with_variant(&self, variant: &str, levels: Option<usize>) -> Option<Box<dyn Study + '_>> {
        let header = Header {
            id: format!("{} {variant}", self.header.id),
            ..self.header.clone()
        };
        let study = self.kind.with_variant(variant)?;
        let with_levels = levels.and_then(|count| study.with_levels(count));
        Some(Described::boxed(header, with_levels.unwrap_or(study)))
    }
}

/// Cases of one kind and their results.
struct Typed<'k, K: Kind> {
    kind: &'k K,
    ran: Mutex<Vec<Ran<K::Data, K::Found>>>,
}

impl<K: Kind> Typed<'_, K> {
    fn ran(&self) -> MutexGuard<'_, Vec<Ran<K::Data, K::Found>>> {
        self.ran.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn never_run() -> CaseFailure {
    CaseFailure::new("the case was not run")
}

impl<K: Kind> Plan for Typed<'_, K> {
    fn cases(&self) -> Vec<Case<()>> {
        self.ran().iter().map(|ran| ran.case.listed()).collect()
    }

    fn more(&self) -> Option<usize> {
        let mut ran = self.ran();
        let case = self.kind.more(&ran)?;
        ran.push(Ran {
            case,
            found: Err(never_run()),
        });
        Some(ran.len() - 1)
    }

    fn run(&self, index: usize) {
        let data = self.ran()[index].case.data.clone();
        let found = self.kind.run(&data);
        self.ran()[index].found = found;
    }

    fn fail(&self, index: usize, failure: CaseFailure) {
        self.ran()[index].found = Err(failure);
    }

    fn failure(&self, index: usize) -> Option<CaseFailure> {
        match &self.ran()[index].found {
            Ok(found) => self.kind.failure(found),
            Err(failure) => Some(failure.clone()),
        }
    }

    fn judge(&self) -> Outcome {
        judge(self.kind, &self.ran())
    }

    fn judge_without(&self, index: usize) -> Outcome {
        let mut ran = self.ran();
        let found = mem::replace(&mut ran[index].found, Err(never_run()));
        let outcome = judge(self.kind, &ran);
        ran[index].found = found;
        outcome
    }
}
