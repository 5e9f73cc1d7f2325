//! Requirements on every typed kind of study, and defects planted in its results.

use convergence_study::{CaseFailure, Kind, NamedRate, Outcome, Ran, Verdict};

/// A study, and the results of all its cases.
pub(crate) struct Sound<K: Kind> {
    pub(crate) study: K,
    pub(crate) runs: Vec<Ran<K::Data, K::Found>>,
}

/// A change of a case's result or of a part of it, with its text.
pub(crate) type Defect<T> = (&'static str, fn(&mut T));

/// Statements that change a result, each with its text.
macro_rules! defects {
    (|$found:ident| [$($defect:expr),+ $(,)?]) => {
        &[$((stringify!($defect), |$found| { $defect; })),+]
    };
}
pub(crate) use defects;

/// A case, by its number or by its name.
pub(crate) trait Place {
    fn among<D, F>(&self, runs: &[Ran<D, F>]) -> usize;
}

impl Place for usize {
    fn among<D, F>(&self, _: &[Ran<D, F>]) -> usize {
        *self
    }
}

impl Place for &str {
    #[track_caller]
    fn among<D, F>(&self, runs: &[Ran<D, F>]) -> usize {
        let place = runs.iter().position(|ran| ran.case.label == *self);
        place.unwrap_or_else(|| panic!("no case {self}"))
    }
}

impl<K: Kind> Sound<K>
where
    K::Found: Clone,
{
    /// Every case is run, on this thread.
    pub(crate) fn run(study: K) -> Self {
        let runs = study.run_here();
        Self { study, runs }
    }

    /// The study passes unchanged, and fails if a case has failed or is missing: the summary then
    /// says that one case less was judged.
    #[track_caller]
    pub(crate) fn checked(study: K) -> Self {
        let sound = Self::run(study);
        let (outcome, all) = (sound.study.outcome_of(&sound.runs), sound.runs.len());
        let (verdict, words) = (outcome.verdict, report(&outcome));
        assert_eq!(verdict, Verdict::Pass, "{}: {words}", outcome.summary);
        check_shape(&outcome);
        for index in 0..all {
            let mut failed = sound.runs.clone();
            failed[index].found = Err(CaseFailure::new("planted"));
            let outcome = sound.study.outcome_of(&failed);
            assert_eq!(outcome.verdict, Verdict::Fail, "case {index} failed");
            let report = report(&outcome);
            let is_sound = report.contains("the outcome of the study is sound");
            assert!(report.contains("planted") && !is_sound, "{report}");
            let words = format!("{} of {all} cases judged; 1 not: without a result", all - 1);
            let summary = outcome.summary.to_string();
            assert!(summary.contains(&words), "{summary}");
        }
        assert_ne!(sound.study.judge(&[]).verdict, Verdict::Pass);
        sound
    }

    /// What the case of this number found.
    #[track_caller]
    pub(crate) fn found(&self, index: usize) -> &K::Found {
        self.runs[index].ok().expect("a result")
    }

    /// The same, to be changed.
    #[track_caller]
    pub(crate) fn found_mut(&mut self, place: impl Place) -> &mut K::Found {
        let place = place.among(&self.runs);
        self.runs[place].found.as_mut().expect("a result")
    }

    /// The results after `change` was applied to each; it also receives the number of the case.
    pub(crate) fn changed(
        &self,
        change: impl Fn(usize, &mut K::Found),
    ) -> Vec<Ran<K::Data, K::Found>> {
        let mut runs = self.runs.clone();
        for (index, ran) in runs.iter_mut().enumerate() {
            change(index, ran.found.as_mut().expect("a result"));
        }
        runs
    }

    /// The outcome with each result changed.
    pub(crate) fn with(&self, change: impl Fn(usize, &mut K::Found)) -> Outcome {
        self.study.judge(&self.changed(change))
    }

    /// The outcome with the result of one case changed.
    #[track_caller]
    pub(crate) fn at(&self, place: impl Place, change: impl Fn(&mut K::Found)) -> Outcome {
        let place = place.among(&self.runs);
        self.with(|index, found| {
            if index == place {
                change(found);
            }
        })
    }

    /// The verdict with a number of each result changed; `change` also receives the number of the
    /// case.
    pub(crate) fn verdict_of(
        &self,
        number: impl Fn(&mut K::Found) -> &mut f64,
        change: impl Fn(usize, f64) -> f64,
    ) -> Verdict {
        let changed = |case: usize, found: &mut K::Found| {
            let number = number(found);
            *number = change(case, *number);
        };
        self.with(changed).verdict
    }

    /// The study fails with each of these in the result of one case.
    #[track_caller]
    pub(crate) fn fails(&self, place: impl Place, defects: &[Defect<K::Found>]) {
        self.fails_in(place, |found| found, defects);
    }

    /// The same with each in a part of the result.
    #[track_caller]
    pub(crate) fn fails_in<T>(
        &self,
        place: impl Place,
        part: fn(&mut K::Found) -> &mut T,
        defects: &[Defect<T>],
    ) {
        let place = place.among(&self.runs);
        let label = &self.runs[place].case.label;
        for (what, plant) in defects {
            let verdict = self.at(place, |found| plant(part(found))).verdict;
            assert_eq!(verdict, Verdict::Fail, "{what} in {label}");
        }
    }

    /// The study passes with none of these in the result of one case.
    #[track_caller]
    pub(crate) fn never_passes(&self, label: &str, defects: &[Defect<K::Found>]) {
        for (what, plant) in defects {
            let verdict = self.at(label, plant).verdict;
            assert_ne!(verdict, Verdict::Pass, "{what} in {label}");
        }
    }

    /// A changed result leaves out one item, for that reason, and the summary says so.
    ///
    /// * `items`: what is counted.
    #[track_caller]
    pub(crate) fn leaves_one_out(
        &self,
        place: impl Place,
        [items, reason]: [&str; 2],
        change: impl Fn(&mut K::Found),
    ) {
        let mut planted = self.runs.clone();
        let found = &mut planted[place.among(&self.runs)].found;
        change(found.as_mut().expect("a result"));
        let [before, after] = [&self.runs, &planted].map(|runs| self.study.outcome_of(runs));
        let less = counted(&after, items).expect("an item that is left out");
        let (judged, of_reason) = counted(&before, items).map_or((less.asked, 0), |count| {
            (count.judged, count.of_reason(reason))
        });
        let found = (less.judged + 1, less.of_reason(reason));
        assert_eq!(found, (judged, of_reason + 1), "{less:?}");
        let summary = after.summary.to_string();
        assert!(summary.contains(&less.words), "{summary}");
    }
}

/// How many items are judged, as the words say it.
#[derive(Debug)]
pub(crate) struct Counted {
    pub(crate) judged: usize,
    pub(crate) asked: usize,
    words: String,
}

impl Counted {
    /// Those left out for this reason.
    fn of_reason(&self, reason: &str) -> usize {
        let (_, reasons) = self.words.split_once(" not: ").expect("reasons");
        if reasons == reason {
            return self.asked - self.judged;
        }
        let end = reasons.find(&format!(" {reason}"));
        let count = end.and_then(|end| reasons[..end].rsplit(' ').next()?.parse().ok());
        count.unwrap_or(0)
    }
}

/// The count of these items; `None` if all are judged.
pub(crate) fn counted(outcome: &Outcome, items: &str) -> Option<Counted> {
    let mut all = outcome.left_out.iter();
    let words = all.find(|words| words.contains(&format!(" {items} judged;")))?;
    let mut numbers = words.split(' ').filter_map(|word| word.parse().ok());
    Some(Counted {
        judged: numbers.next()?,
        asked: numbers.next()?,
        words: words.clone(),
    })
}

/// The outcome has numbers, and all that it has can be shown.
#[track_caller]
fn check_shape(outcome: &Outcome) {
    assert!(!outcome.tables.is_empty() || !outcome.levels.is_empty() || !outcome.rates.is_empty());
    assert!(!outcome.quantities.is_empty());
    for check in &outcome.checks {
        assert!(!check.subject.quantity.is_empty(), "{}", check.claim);
    }
    for quantity in &outcome.quantities {
        let is_named = !quantity.subject.quantity.is_empty();
        let is_guarded = quantity.value.is_finite() && quantity.tolerance > 0.0;
        assert!(is_named && is_guarded, "{}", quantity.name);
    }
    for figure in &outcome.figures {
        assert!(figure.svg().starts_with("<svg") && !figure.caption.is_empty());
    }
}

/// All judged items, with their evidence.
pub(crate) fn report(outcome: &Outcome) -> String {
    let rates = outcome
        .rates
        .iter()
        .map(|NamedRate { name, rate, .. }| format!("{name}: {} {}", rate.verdict, rate.reason));
    let checks = outcome.checks.iter().map(|check| {
        let statement = check.statement();
        format!("{statement}: {} {}", check.verdict, check.evidence)
    });
    rates.chain(checks).collect::<Vec<_>>().join("\n")
}

/// The claims that fail, each as it is printed.
pub(crate) fn failed(outcome: &Outcome) -> Vec<String> {
    claims(outcome, |verdict| verdict == Verdict::Fail)
}

/// The claims that do not pass.
pub(crate) fn not_passed(outcome: &Outcome) -> Vec<String> {
    claims(outcome, |verdict| verdict != Verdict::Pass)
}

fn claims(outcome: &Outcome, has: fn(Verdict) -> bool) -> Vec<String> {
    let checks = outcome.checks.iter();
    let claims = checks.filter(|check| has(check.verdict));
    claims.map(|check| check.statement()).collect()
}
