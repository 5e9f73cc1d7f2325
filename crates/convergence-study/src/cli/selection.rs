//! Selection of studies by tier, id or pattern.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use glob::Pattern;

use super::exit::Unusable;
use crate::study::{Header, Tier};

/// Reads a tier from the command line.
pub fn tier_parser() -> impl TypedValueParser<Value = Tier> {
    let tier = |name: String| if name == Tier::Full.name() { Tier::Full } else { Tier::Quick };
    PossibleValuesParser::new(Tier::ALL.map(Tier::name)).map(tier)
}

/// Whether each study is selected.
///
/// * `asked`: ids and patterns (`*`, `?`, `[a-z]`). If empty: every study of the tier. An id selects its study whatever
///   the tier; a pattern stays within the tier. The full tier includes the quick one.
///
/// * `list`: the command that lists all studies, for messages.
///
/// # Errors
/// A pattern that cannot be read, or one that matches nothing: a misspelt name must not pass.
pub fn select(all: &[&Header], tier: Tier, asked: &[String], list: &str) -> Result<Vec<bool>, Unusable> {
    let in_tier = |header: &Header| header.tier <= tier;
    if asked.is_empty() {
        let meant: Vec<bool> = all.iter().map(|header| in_tier(header)).collect();
        return if meant.contains(&true) {
            Ok(meant)
        } else {
            Err(Unusable::because(&format!("no study in the tier {}", tier.name())))
        };
    }
    let mut meant = vec![false; all.len()];
    for word in asked {
        let pattern =
            Pattern::new(word).map_err(|error| Unusable::because(&format!("`{word}` is not a pattern: {error}")))?;
        let matches = |header: &Header| header.id == *word || (in_tier(header) && pattern.matches(&header.id));
        let found: Vec<usize> = (0..all.len()).filter(|&i| matches(all[i])).collect();
        if found.is_empty() {
            return Err(Unusable::because(&no_match(word, &pattern, all, tier, list)));
        }
        found.into_iter().for_each(|i| meant[i] = true);
    }
    Ok(meant)
}

fn no_match(word: &str, pattern: &Pattern, all: &[&Header], tier: Tier, list: &str) -> String {
    let outside = all.iter().filter(|header| pattern.matches(&header.id)).count();
    if outside > 0 {
        return format!("`{word}` matches no study in the tier {}, and {outside} with --tier full", tier.name());
    }
    // A longer list would fill the screen.
    const FEW: usize = 12;
    let ids: Vec<&str> = all.iter().map(|header| header.id.as_str()).collect();
    let allowed = if ids.len() <= FEW { ids.join(", ") } else { format!("what `{list}` shows") };
    format!("`{word}` matches no study; expected {allowed}, or a pattern such as '*-space'")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers() -> Vec<Header> {
        let header = |(id, tier): (&str, Tier)| Header { tier, ..Header::new(id, "c") };
        [("a-space", Tier::Quick), ("a-time", Tier::Quick), ("b-space", Tier::Full)].map(header).to_vec()
    }

    fn meant(tier: Tier, asked: &[&str]) -> Result<Vec<String>, String> {
        let headers = headers();
        let asked: Vec<String> = asked.iter().map(|&word| word.to_owned()).collect();
        let meant = select(&headers.iter().collect::<Vec<_>>(), tier, &asked, "list")
            .map_err(|error| error.message().to_owned())?;
        Ok(headers.iter().zip(meant).filter(|(_, meant)| *meant).map(|(header, _)| header.id.clone()).collect())
    }

    #[test]
    fn tiers_ids_and_patterns_select() {
        for (tier, asked, expected) in [
            (Tier::Quick, &[][..], &["a-space", "a-time"][..]),
            (Tier::Full, &[], &["a-space", "a-time", "b-space"]),
            (Tier::Quick, &["b-space"], &["b-space"]),
            (Tier::Quick, &["*-space"], &["a-space"]),
            (Tier::Full, &["*-space"], &["a-space", "b-space"]),
            (Tier::Quick, &["a-t?me", "a-space", "a-*"], &["a-space", "a-time"]),
        ] {
            assert_eq!(meant(tier, asked).unwrap(), expected, "{asked:?}");
        }
    }

    #[test]
    fn a_word_without_a_match_is_an_error_even_beside_others() {
        for (asked, words) in [
            (&["a-space", "a-spice"][..], "`a-spice` matches no study; expected a-space, a-time, b-space"),
            (&["b*"], "`b*` matches no study in the tier quick, and 1 with --tier full"),
            (&["["], "`[` is not a pattern"),
            (&[""], "`` matches no study"),
        ] {
            let error = meant(Tier::Quick, asked).unwrap_err();
            assert!(error.starts_with(words), "{error}");
        }
    }
}
