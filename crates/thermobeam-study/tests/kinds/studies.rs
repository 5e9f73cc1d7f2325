//! The studies in code: no claim, no guarded number and no run of theirs is without effect.

use convergence_study::{Tier, unnoticed};
use thermobeam_study::studies::STUDIES;

#[test]
fn every_claim_and_every_run_of_the_studies_in_code_counts() {
    for study in STUDIES.map(|study| study()) {
        if study.header().tier == Tier::Quick {
            let list = unnoticed(study.as_ref());
            assert_eq!(list, Vec::<String>::new(), "{}", study.header().id);
        }
    }
}
