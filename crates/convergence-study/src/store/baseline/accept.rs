//! One change taken for the baseline, and no other.

use super::change::{Change, Movement};
use super::claims::{self, Claim};
use super::{Baseline, Guarded, Refusal, acceptable};
use crate::run::Finished;

impl Baseline {
    /// Takes one of the changes that [`Baseline::compare`] has found; all others stay as they are.
    ///
    /// * `reason`: kept beside the number or the claim.
    ///
    /// # Errors
    /// [`Refusal`], and the baseline stays as it was: as for [`Baseline::bless`], the study must pass.
    pub fn accept(&mut self, finished: &[Finished], change: &Change, reason: &str) -> Result<(), Refusal> {
        let Change { study, name, movement } = change;
        let ran = finished.iter().find(|finished| finished.header.id == *study);
        ran.map_or(Ok(()), acceptable)?;
        let why = || Some(reason.to_owned());
        match (movement, ran) {
            (Movement::Vanished { .. }, _) => {
                self.studies.get_mut(study).into_iter().for_each(|guarded| drop(guarded.remove(name)));
            }
            (Movement::VanishedFile { .. }, _) => {
                self.studies.remove(study);
                self.claims.get_mut(study).into_iter().for_each(|claims| claims::withdraw(claims, Some(reason)));
            }
            (_, None) => return Err(Refusal::NotRun { study: study.clone() }),
            (Movement::NewFile { .. }, Some(ran)) => {
                let guarded = self.guards(study);
                claims::bless(&ran.header, self.claims.entry(study.clone()).or_default(), guarded, Some(reason));
            }
            (Movement::Claim { to, .. }, Some(_)) => {
                let claim = Claim { value: to.clone(), reason: why() };
                self.claims.entry(study.clone()).or_default().insert(name.clone(), claim);
            }
            (Movement::Moved { .. } | Movement::Tolerance { .. } | Movement::New { .. }, Some(ran)) => {
                let found = ran.outcome.quantities.iter().find(|quantity| quantity.name == *name);
                let new = found.map(|found| Guarded { value: found.value, tolerance: found.tolerance, reason: why() });
                self.studies.entry(study.clone()).or_default().extend(new.map(|new| (name.clone(), new)));
            }
        }
        self.studies.retain(|_, guarded| !guarded.is_empty());
        Ok(())
    }
}
