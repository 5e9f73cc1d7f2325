//! One planted defect at a time.

use convergence_study::{Kind, Verdict};

use super::typed::Runs;

/// The verdict with the result of one case changed.
pub(crate) fn verdict_with<K: Kind>(
    study: &K,
    sound: &Runs<K>,
    index: usize,
    change: impl FnOnce(&mut K::Found),
) -> Verdict
where
    K::Data: Clone,
    K::Found: Clone,
{
    let mut planted = sound.clone();
    change(planted[index].found.as_mut().expect("a result"));
    study.judge(&planted).verdict
}
