//! Suggestions for misspelt names.

use strsim::osa_distance;

/// The part of a message about an unknown name that suggests a known one; empty without a
/// suggestion.
pub fn did_you_mean(suggestion: &Option<String>) -> String {
    suggestion
        .as_ref()
        .map(|name| format!(", did you mean `{name}`?"))
        .unwrap_or_default()
}

/// The candidate closest to `name`; `None` if none is close enough to be a typing error.
///
/// The distance is that of optimal string alignment, ignoring case: the number of insertions,
/// deletions, replacements and swaps of neighbours. It must be at most a third of the length of
/// `name`, or 1, and less than the length of the candidate. The first of equally close candidates
/// is returned.
pub fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    // The computation of the distance takes time proportional to the product of both lengths.
    const LONGEST: usize = 40;
    let length = name
        .chars()
        .take(LONGEST + 1)
        .flat_map(char::to_lowercase)
        .count();
    if length > LONGEST {
        return None;
    }
    let (name, allowed) = (name.to_lowercase(), (length / 3).max(1));
    candidates
        .into_iter()
        .map(|candidate| (osa_distance(&name, &candidate.to_lowercase()), candidate))
        // A distance of the candidate's length means that the names have nothing in common.
        .filter(|&(distance, candidate)| {
            distance <= allowed && distance < candidate.chars().count()
        })
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
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
        assert_eq!(
            [&forty, &more].map(|name| nearest(name, [forty.as_str()])),
            [Some(forty.as_str()), None]
        );
    }

    #[test]
    fn suggestions_allow_one_edit_per_three_letters() {
        let edited = ["abcdefghX", "abcdefgXX", "abcdefXXX", "abcdeXXXX"]
            .map(|name| nearest(name, ["abcdefghi"]));
        assert_eq!(
            edited,
            [
                Some("abcdefghi"),
                Some("abcdefghi"),
                Some("abcdefghi"),
                None
            ]
        );
        assert_eq!((nearest("y", ["x"]), nearest("xx", ["x"])), (None, None));
    }
}
