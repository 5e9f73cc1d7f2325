//! The name that was probably meant: a typing error away from one that exists.

/// The second half of a complaint about an unknown name.
pub fn did_you_mean(suggestion: &Option<String>) -> String {
    suggestion.as_ref().map(|name| format!(", did you mean `{name}`?")).unwrap_or_default()
}

/// The candidate closest to `name`, if it is close enough to be a typing error.
///
/// Upper and lower case count as equal; otherwise at most one edit for every three letters, and at least one edit is
/// always granted. Of equally close candidates the first is taken.
pub fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    // Nobody misspells a name this long; the distance costs the product of both lengths.
    const LONGEST: usize = 40;
    let name: Vec<char> = name.chars().take(LONGEST + 1).flat_map(char::to_lowercase).collect();
    if name.len() > LONGEST {
        return None;
    }
    let granted = (name.len() / 3).max(1);
    candidates
        .into_iter()
        .map(|candidate| (edits(&name, &candidate.to_lowercase().chars().collect::<Vec<_>>()), candidate))
        // A distance as long as the candidate itself means that nothing of it was written.
        .filter(|&(distance, candidate)| distance <= granted && distance < candidate.chars().count())
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// Optimal string alignment distance: insertions, deletions, replacements and swaps of neighbours.
fn edits(from: &[char], to: &[char]) -> usize {
    let mut before_last = vec![0; to.len() + 1];
    let mut last: Vec<usize> = (0..=to.len()).collect();
    for i in 1..=from.len() {
        let mut row = vec![i];
        for j in 1..=to.len() {
            let replaced = last[j - 1] + usize::from(from[i - 1] != to[j - 1]);
            let mut best = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1] {
                best = best.min(before_last[j - 2] + 1);
            }
            row.push(best);
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last[to.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_misspelt_name_is_suggested_and_an_unrelated_word_is_not() {
        let names = ["sin", "sinh", "sqrt", "log10", "theta_a", "elements"];
        for (written, meant) in [
            ("sine", Some("sin")),
            ("SIN", Some("sin")),
            ("sqr", Some("sqrt")),
            ("sqtr", Some("sqrt")),
            ("log", None),
            ("log01", Some("log10")),
            ("olg01", None),
            ("sinxyz", None),
            ("thetaa", Some("theta_a")),
            ("element", Some("elements")),
            ("zeta", None),
            ("", None),
        ] {
            assert_eq!(nearest(written, names), meant, "{written}");
        }
    }

    #[test]
    fn no_suggestion_for_names_longer_than_forty_characters() {
        assert_eq!(nearest(&"s".repeat(1_000_000), ["sin"]), None);
        let [forty, more] = [40, 41].map(|count| "s".repeat(count));
        assert_eq!([&forty, &more].map(|name| nearest(name, [forty.as_str()])), [Some(forty.as_str()), None]);
    }

    #[test]
    fn suggestions_allow_one_edit_per_three_letters() {
        let edited = ["abcdefghX", "abcdefgXX", "abcdefXXX", "abcdeXXXX"].map(|name| nearest(name, ["abcdefghi"]));
        assert_eq!(edited, [Some("abcdefghi"), Some("abcdefghi"), Some("abcdefghi"), None]);
        assert_eq!((nearest("y", ["x"]), nearest("xx", ["x"])), (None, None));
    }
}
