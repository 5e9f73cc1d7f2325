//! Changes against the baseline, shortened: hundreds of numbers may change at once.

use crate::store::baseline::Change;
use crate::text::visible::visible;

/// Changes of a study that are listed one by one.
const LISTED: usize = 3;

/// Claims that changed, under a head. Of numbers one line each, too; of a study with many, their number and those of most
/// weight, unless all are wanted.
pub(super) fn lines(changes: &[Change], all: bool) -> String {
    let studies = changes.chunk_by(|one, next| one.study == next.study);
    let numbers: String = studies.map(|of_study| of_one_study(of_study, all)).collect();
    let claims: String = changes.iter().filter(|change| change.movement.needs_a_reason()).map(claim).collect();
    if claims.is_empty() { numbers } else { format!("{numbers}claims changed\n{claims}") }
}

fn claim(change: &Change) -> String {
    format!("  {}\n", visible(&change.words()))
}

fn of_one_study(changes: &[Change], all: bool) -> String {
    let numbers: Vec<&Change> = changes.iter().filter(|change| !change.movement.needs_a_reason()).collect();
    if all || numbers.len() <= LISTED { each(numbers) } else { condensed(numbers) }
}

fn each<'c>(changes: impl IntoIterator<Item = &'c Change>) -> String {
    changes.into_iter().map(|change| format!("baseline: {}\n", visible(&change.to_string()))).collect()
}

fn condensed(changes: Vec<&Change>) -> String {
    let (study, rest) = (&changes[0].study, changes.len() - LISTED);
    let mut heaviest = changes.clone();
    // A stable order: of equals the first ones.
    heaviest.sort_by(|a, b| b.movement.weight().total_cmp(&a.movement.weight()));
    heaviest.truncate(LISTED);
    each(heaviest) + &format!("baseline: {study}: and {rest} more; --verbose and the report list all\n")
}

#[cfg(test)]
mod tests {
    use super::lines;
    use crate::store::baseline::{Change, Movement};

    fn moved(study: &str, name: &str, to: f64) -> Change {
        let movement = Movement::Moved { from: 1.0, to, tolerance: 1e-3 };
        Change { study: study.to_owned(), name: name.to_owned(), movement }
    }

    #[test]
    fn of_many_changes_the_largest_are_listed() {
        let mut changes: Vec<Change> = (0..10).map(|i| moved("many", &format!("n{i}"), 1.1 + f64::from(i))).collect();
        changes[0].movement = Movement::Vanished { value: 1.0 };
        changes.push(moved("few", "m", 2.0));
        let text = lines(&changes, false);
        let listed: Vec<&str> = text.lines().map(|line| line.split(' ').nth(2).unwrap()).collect();
        assert_eq!(listed, ["n0", "n9", "n8", "and", "m"], "{text}");
        assert!(text.contains("many: and 7 more"), "{text}");
        assert_eq!(lines(&changes, true).lines().count(), 11);
    }
}
