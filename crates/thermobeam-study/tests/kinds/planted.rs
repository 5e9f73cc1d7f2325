//! One planted defect at a time.

use convergence_study::{Kind, Ran, Verdict};

use super::typed::{Runs, changed};

/// A change of a case's result, with its name.
pub(crate) type Defect<K> = (&'static str, fn(&mut <K as Kind>::Found));

/// A change of a number, which also receives the number of the case.
pub(crate) type Change = fn(usize, f64) -> f64;

/// The verdict with the result of one case changed.
pub(crate) fn verdict_with<K: Kind>(
    study: &K,
    sound: &Runs<K>,
    index: usize,
    change: impl FnOnce(&mut K::Found),
) -> Verdict
where
    K::Found: Clone,
{
    let mut planted = sound.clone();
    change(planted[index].found.as_mut().expect("a result"));
    study.judge(&planted).verdict
}

/// The verdict with a number of each result changed; `change` also receives the number of the case.
pub(crate) fn verdict_of<K: Kind>(
    study: &K,
    sound: &Runs<K>,
    number: impl Fn(&mut K::Found) -> &mut f64,
    change: impl Fn(usize, f64) -> f64,
) -> Verdict
where
    K::Found: Clone,
{
    let planted = changed::<K>(sound, |case, found| {
        let number = number(found);
        *number = change(case, *number);
    });
    study.judge(&planted).verdict
}

/// Statements that change a result, each with its text.
macro_rules! defects {
    (|$found:ident| [$($defect:expr),+ $(,)?]) => {
        &[$((stringify!($defect), |$found| { $defect; })),+]
    };
}
pub(crate) use defects;

/// The study fails with each of these in the result of one case.
#[track_caller]
pub(crate) fn each_fails<K: Kind>(study: &K, sound: &Runs<K>, index: usize, defects: &[Defect<K>])
where
    K::Found: Clone,
{
    for (what, plant) in defects {
        let verdict = verdict_with(study, sound, index, plant);
        let label = &sound[index].case.label;
        assert_eq!(verdict, Verdict::Fail, "{what} in {label}");
    }
}

/// The study passes with none of these in the result of the case of this name.
#[track_caller]
pub(crate) fn none_passes<K: Kind>(study: &K, sound: &Runs<K>, label: &str, defects: &[Defect<K>])
where
    K::Found: Clone,
{
    for (what, plant) in defects {
        let verdict = verdict_with(study, sound, place(sound, label), plant);
        assert_ne!(verdict, Verdict::Pass, "{what} in {label}");
    }
}

/// The case of this name.
#[track_caller]
pub(crate) fn place<D, F>(sound: &[Ran<D, F>], label: &str) -> usize {
    let place = sound.iter().position(|ran| ran.case.label == label);
    place.unwrap_or_else(|| panic!("no case {label}"))
}
