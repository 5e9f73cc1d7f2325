//! One computation of a study, and its result or the reason why there is none.

/// One computation of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Case<D> {
    /// What distinguishes it from the study's other cases, such as `n = 64, 20 steps`.
    pub label: String,
    /// Estimate of the work, in any unit that all studies of a project share: the runner starts with the costliest case.
    pub cost: f64,
    /// What the computation needs to know.
    pub data: D,
}

/// A case after it was run: its data, and what it found.
#[derive(Debug, Clone, PartialEq)]
pub struct Ran<D, F> {
    /// The case.
    pub case: Case<D>,
    /// Its result.
    pub found: Result<F, CaseFailure>,
}

impl<D, F> Ran<D, F> {
    /// What the case found, if it completed.
    pub fn ok(&self) -> Option<&F> {
        self.found.as_ref().ok()
    }
}

/// Why a case has no result: an error of the computation, a panic caught by the runner, or the time limit.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseFailure {
    /// In words, with step, time and numbers.
    pub reason: String,
}

impl<E: std::error::Error> From<E> for CaseFailure {
    fn from(error: E) -> Self {
        Self { reason: error.to_string() }
    }
}

/// Cases without a result in words, `label: reason`; those with the same reason on one line, which counts them.
///
/// * `failed`: label and reason of each.
pub(crate) fn by_reason<'f>(failed: impl IntoIterator<Item = (&'f str, &'f str)>) -> Vec<String> {
    let mut reasons: Vec<(&str, Vec<&str>)> = vec![];
    for (label, reason) in failed {
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, labels)) => labels.push(label),
            None => reasons.push((reason, vec![label])),
        }
    }
    let line = |(reason, labels): (&str, Vec<&str>)| {
        let more = if labels.len() > 1 { format!(" and {} more", labels.len() - 1) } else { String::new() };
        format!("{}{more}: {reason}", labels[0])
    };
    reasons.into_iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::by_reason;

    #[test]
    fn a_reason_is_told_once_and_its_cases_are_counted() {
        let told = by_reason([("a", "lost"), ("b", "NaN"), ("c", "lost"), ("d", "lost")]);
        assert_eq!(told, ["a and 2 more: lost", "b: NaN"]);
        assert!(by_reason([]).is_empty());
    }
}
