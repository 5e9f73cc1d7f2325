//! What study files claim, value by value: a claim changes only where a reason is given.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::change::{Change, Movement};
use crate::study::Header;

/// The name under which a study file is new or has vanished as a whole.
const WHOLE_FILE: &str = "study file";

/// The value that stands for a whole file after it has vanished.
pub(super) const ID: &str = "study.id";

/// A value of a study file as it was blessed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlessedClaim {
    /// Its text in the form of [`Header::settings`]; `null` where it was withdrawn.
    pub value: Option<String>,
    /// Why it was changed or withdrawn; nothing for the first value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// The claims of one study, by the dotted path of the value.
pub(super) type Claims = BTreeMap<String, BlessedClaim>;

/// What differs between the claims as they were blessed and the file as it is: by path; one change for a file that is new.
///
/// * `guarded`: how many numbers of the study are guarded.
pub(super) fn changes(header: &Header, blessed: Option<&Claims>, guarded: usize) -> Vec<Change> {
    let Header { id, settings, .. } = header;
    let standing = standing(blessed);
    if standing.is_empty() {
        let new = Change::new(id, WHOLE_FILE, Movement::NewFile { values: settings.len(), guarded });
        return if settings.is_empty() { vec![] } else { vec![new] };
    }
    let mut paths: BTreeMap<&str, [Option<&str>; 2]> =
        standing.into_iter().map(|(path, value)| (path, [Some(value), None])).collect();
    for (path, value) in settings {
        paths.entry(path).or_default()[1] = Some(value);
    }
    let changed = paths.iter().map(|(path, values)| (*path, *values)).filter(|(_, [from, to])| from != to);
    let change = |(path, [from, to]): (&str, [Option<&str>; 2])| {
        let [from, to] = [from, to].map(|value| value.map(str::to_owned));
        Change::new(id, path, Movement::Claim { from, to, entry: entry(path, &paths) })
    };
    changed.map(change).collect()
}

/// Keys by which an entry of a list says what it is about.
const ENTRY_KEYS: [&str; 5] = ["norm", "error", "value", "quantity", "name"];

/// What the entry of a list that holds a value is about, by another value of the same entry.
///
/// * `paths`: the former and the present value by path.
fn entry(path: &str, paths: &BTreeMap<&str, [Option<&str>; 2]>) -> Option<String> {
    let (entry, _) = path.rsplit_once('.').filter(|(entry, _)| entry.ends_with(']'))?;
    let [from, to] = ENTRY_KEYS.iter().find_map(|key| paths.get(format!("{entry}.{key}").as_str()))?;
    to.or(*from).map(|value| value.trim_matches('"').to_owned())
}

/// The change of a study whose file has vanished; nothing where its claims were withdrawn before.
pub(super) fn vanished(id: &str, blessed: &Claims) -> Option<Change> {
    let values = standing(Some(blessed)).len();
    (values > 0).then(|| Change::new(id, WHOLE_FILE, Movement::VanishedFile { values }))
}

/// The values that have not been withdrawn.
fn standing(blessed: Option<&Claims>) -> Vec<(&str, &str)> {
    let claims = blessed.into_iter().flatten();
    claims.filter_map(|(path, claim)| Some((path.as_str(), claim.value.as_deref()?))).collect()
}
