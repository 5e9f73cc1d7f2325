//! What a judged item exercises: settings, as pairs of text, by which a diagnosis separates failing from passing items.

use super::Header;

/// A setting: its key, and its value in words that can stand alone, such as `axis` and `refined in space`.
pub type Setting = (String, String);

/// The field or norm of a judged item: its name without the level, and without the case before a colon.
///
/// * `item`: the name of a rate, the claim of a check, or the name of a guarded number.
pub fn field(item: &str) -> String {
    let item = ["error ", "rate "].iter().fold(item, |item, kind| item.strip_prefix(kind).unwrap_or(item));
    let item = item.rsplit_once(": ").map_or(item, |(_, rest)| rest);
    let is_level = |part: &&str| {
        let is_set = part.split_once(" = ").is_some_and(|(name, _)| !name.contains(' '));
        is_set || part.starts_with(|c: char| c.is_ascii_digit()) || *part == "finest level"
    };
    let parts: Vec<&str> = item.split(", ").filter(|part| !is_level(part)).collect();
    if parts.is_empty() { item.to_owned() } else { parts.join(", ") }
}

/// The setting that only the items of one study share.
pub const STUDY: &str = "study";

/// That setting: if nothing else separates, a study fails alone.
pub fn study(header: &Header) -> Setting {
    (STUDY.to_owned(), format!("{} alone", header.id))
}

/// The settings of an item that exist in any project: study, kind, field, and every value of the study's file.
///
/// * `item`: as for [`field`].
pub fn of_file(header: &Header, item: &str) -> Vec<Setting> {
    let pair = |key: &str, value: &str| (key.to_owned(), format!("{key} {value}"));
    let told = |path: &str| !path.starts_with("study.") && !path.contains('[');
    let own = [study(header), pair("field", &field(item)), pair("kind", &header.kind)];
    // Each entry of a list, such as the words of a command, is a separate setting.
    let entries = |(path, value): &Setting| {
        let entries = value.trim_matches(['[', ']']).split(", ").enumerate();
        let entry = |(k, entry): (usize, &str)| (format!("{path}[{k}]"), format!("{path} {}", entry.trim_matches('"')));
        entries.map(entry).collect::<Vec<_>>()
    };
    let of_file = header.settings.iter().filter(|(path, _)| told(path)).flat_map(entries);
    own.into_iter().chain(of_file).collect()
}

#[cfg(test)]
mod tests {
    use super::field;

    #[test]
    fn the_field_of_an_item_has_neither_level_nor_case() {
        for (item, expected) in [
            ("error shear, n = 8, 128 steps", "shear"),
            ("rate p = 1, fields", "fields"),
            ("error mean, successive, n = 16, 800 steps", "mean, successive"),
            ("case-1: u(1) at t = 1", "u(1) at t = 1"),
            ("n = 8", "n = 8"),
        ] {
            assert_eq!(field(item), expected);
        }
    }
}
