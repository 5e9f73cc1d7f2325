//! How many of the items that a study was asked about it has judged, and why not the others. A
//! summary of judged items alone sounds like one of all items, so each summary says it.

use crate::text::lists::grouped;

/// The reason why an item of a case that failed is not judged.
pub(crate) const NO_RESULT: &str = "without a result";

/// How many items are judged, such as `35 of 45 points judged; 10 not: fewer than 5 iterations`;
/// `None` if all are.
///
/// * `items`: what they are, in the plural.
/// * `reasons`: for each item the reason why it was left out; `None` if it was judged.
pub fn left_out<'r>(
    items: &str,
    reasons: impl IntoIterator<Item = Option<&'r str>>,
) -> Option<String> {
    let reasons: Vec<Option<&str>> = reasons.into_iter().collect();
    let groups = grouped(reasons.iter().flatten().map(|reason| (*reason, ())));
    let words = match &groups[..] {
        [] => return None,
        [(only, _)] => (*only).to_owned(),
        several => {
            let each = several.iter();
            let each = each.map(|(reason, items)| format!("{} {reason}", items.len()));
            each.collect::<Vec<_>>().join(", ")
        }
    };
    let all = reasons.len();
    let not = reasons.into_iter().flatten().count();
    let judged = all - not;
    Some(format!(
        "{judged} of {all} {items} judged; {not} not: {words}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_counted_by_the_reason_why_they_were_left_out() {
        let reasons = [None, Some("short"), None, Some("failed"), Some("short")];
        let words = left_out("points", reasons).unwrap();
        assert_eq!(words, "2 of 5 points judged; 3 not: 2 short, 1 failed");
        let words = left_out("points", [None, Some("short")]).unwrap();
        assert_eq!(words, "1 of 2 points judged; 1 not: short");
        assert_eq!(left_out("points", [None, None]), None);
    }
}
