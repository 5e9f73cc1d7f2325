//! Names in messages: the known name closest to a misspelt one, and names quoted for a shell.

/// Longest name for which a suggestion is sought: the distance costs the product of both lengths.
const LONGEST: usize = 40;

/// The second half of a message about an unknown name; empty without a suggestion.
pub fn did_you_mean(suggestion: &Option<String>) -> String {
    suggestion
        .as_ref()
        .map(|name| format!(", did you mean `{name}`?"))
        .unwrap_or_default()
}

/// The candidate closest to `name`, or `None` if none is close enough to be a typing error.
///
/// Distance: insertions, deletions, replacements and swaps of neighbours (optimal string
/// alignment), ignoring case; at most one edit for every three letters, and at least one. The first
/// of equally close candidates wins.
pub fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let name = name.to_lowercase();
    let letters = name.chars().count();
    if letters > LONGEST {
        return None;
    }
    let most_edits = (letters / 3).max(1);
    candidates
        .into_iter()
        .map(|candidate| {
            (
                strsim::osa_distance(&name, &candidate.to_lowercase()),
                candidate,
            )
        })
        // A distance as long as the candidate itself means that none of its letters was written.
        .filter(|&(distance, candidate)| {
            distance <= most_edits && distance < candidate.chars().count()
        })
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// Candidates, those that need the fewest edits first: see [`nearest`].
pub fn by_distance<'c>(name: &str, mut candidates: Vec<&'c str>) -> Vec<&'c str> {
    let name: String = name.to_lowercase().chars().take(LONGEST).collect();
    candidates
        .sort_by_cached_key(|candidate| strsim::osa_distance(&name, &candidate.to_lowercase()));
    candidates
}

/// A word quoted for a shell, which would otherwise expand patterns.
pub fn quoted(word: &str) -> String {
    let mut characters = word.chars();
    let is_plain = characters.all(|c| c.is_alphanumeric() || "_-+.,/^:=@%".contains(c));
    if is_plain && !word.is_empty() {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_typing_error_finds_the_name_and_a_different_word_does_not() {
        let names = ["tier", "tolerance", "order", "kind"];
        let cases = [
            ("teir", Some("tier")),
            ("tear", None),
            ("TIER", Some("tier")),
            ("odrer", Some("order")),
            ("size", None),
        ];
        for (written, meant) in cases {
            assert_eq!(nearest(written, names), meant, "{written}");
        }
        assert_eq!(nearest(&"x".repeat(41), ["x".repeat(41).as_str()]), None);
    }
}
