//! How many of the items that a study was asked about it has judged, and why not the others.
//!
//! A summary of judged items alone sounds like one of all items. So the numbers are values of the
//! outcome, and each summary says them wherever they differ:
//! `35 of 45 points judged; 10 not: fewer than 5 iterations`.

use std::fmt;

use crate::text::lists::grouped;

/// The reason why an item of a case that failed is not judged.
pub(crate) const NO_RESULT: &str = "without a result";

/// The items of one sort: points, cases, pairs, statements.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Coverage {
    /// What is counted, in the plural, such as `points of the map`; unique within the study.
    pub items: String,
    /// The number of items about which the study was asked.
    pub asked: usize,
    /// The number of items that it judged.
    pub judged: usize,
    /// The other items by the reason why they were left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
}

/// Items that were not judged for one reason.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct LeftOut {
    /// Why.
    pub reason: String,
    /// The number of these items.
    pub count: usize,
}

impl Coverage {
    /// Counts items.
    ///
    /// * `items`: what they are, in the plural.
    /// * `reasons`: for each item the reason why it was left out; `None` if it was judged.
    pub fn of<R: Into<String>>(
        items: impl Into<String>,
        reasons: impl IntoIterator<Item = Option<R>>,
    ) -> Self {
        let reasons: Vec<Option<String>> = reasons
            .into_iter()
            .map(|reason| reason.map(Into::into))
            .collect();
        let total = reasons.len();
        let groups = grouped(reasons.into_iter().flatten().map(|reason| (reason, ())));
        let left_out: Vec<LeftOut> = groups
            .into_iter()
            .map(|(reason, items)| LeftOut {
                reason,
                count: items.len(),
            })
            .collect();
        Self {
            items: items.into(),
            asked: total,
            judged: total - left_out.iter().map(|left| left.count).sum::<usize>(),
            left_out,
        }
    }

    /// Counts a known number of items; those without a reason in the list have no result.
    ///
    /// * `reasons`: as in [`Coverage::of`], for the items that have a result.
    pub fn with_total<'r>(
        items: impl Into<String>,
        total: usize,
        reasons: impl Iterator<Item = Option<&'r str>>,
    ) -> Self {
        let mut reasons: Vec<_> = reasons.collect();
        reasons.resize(total.max(reasons.len()), Some(NO_RESULT));
        Self::of(items, reasons)
    }

    /// Whether every item was judged.
    pub fn is_complete(&self) -> bool {
        self.judged == self.asked
    }

    /// Whether each item is counted once: judged, or left out for a reason.
    pub(super) fn adds_up(&self) -> bool {
        let left_out: usize = self.left_out.iter().map(|left| left.count).sum();
        self.judged + left_out == self.asked
    }

    /// Adds the items of another part of the study.
    fn add(&mut self, part: Self) {
        self.asked += part.asked;
        self.judged += part.judged;
        for left in part.left_out {
            match self
                .left_out
                .iter_mut()
                .find(|own| own.reason == left.reason)
            {
                Some(own) => own.count += left.count,
                None => self.left_out.push(left),
            }
        }
    }
}

/// Adds counts to others; items of the same sort are added up.
pub(super) fn merge(all: &mut Vec<Coverage>, more: Vec<Coverage>) {
    for part in more {
        match all.iter_mut().find(|known| known.items == part.items) {
            Some(known) => known.add(part),
            None => all.push(part),
        }
    }
}

/// The counts that a reader must know, in words: those of items of which some were left out.
pub(crate) fn incomplete(all: &[Coverage]) -> Vec<String> {
    all.iter()
        .filter(|coverage| !coverage.is_complete())
        .map(Coverage::to_string)
        .collect()
}

impl fmt::Display for Coverage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            items,
            asked,
            judged,
            left_out,
        } = self;
        write!(f, "{judged} of {asked} {items} judged")?;
        let reasons: Vec<String> = match &left_out[..] {
            [] => return Ok(()),
            [only] => vec![only.reason.clone()],
            several => several
                .iter()
                .map(|left| format!("{} {}", left.count, left.reason))
                .collect(),
        };
        write!(f, "; {} not: {}", asked - judged, reasons.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_counted_by_the_reason_why_they_were_left_out() {
        let reasons = [None, Some("short"), None, Some("failed"), Some("short")];
        let coverage = Coverage::of("points", reasons);
        assert_eq!(
            coverage.to_string(),
            "2 of 5 points judged; 3 not: 2 short, 1 failed"
        );
        assert!(coverage.adds_up() && !coverage.is_complete());
        let one_reason = Coverage::of("points", [None, Some("short")]);
        assert_eq!(one_reason.to_string(), "1 of 2 points judged; 1 not: short");
        let all = Coverage::of("points", [None::<&str>, None]);
        assert_eq!(all.to_string(), "2 of 2 points judged");
        assert!(all.is_complete() && incomplete(&[all]).is_empty());
        let missing = Coverage::with_total("points", 4, [None, Some("short")].into_iter());
        assert_eq!(
            missing.to_string(),
            "1 of 4 points judged; 3 not: 1 short, 2 without a result"
        );
    }

    #[test]
    fn the_same_items_of_two_parts_are_added_up() {
        let mut all = vec![Coverage::of("points", [None, Some("short")])];
        merge(
            &mut all,
            vec![
                Coverage::of("points", [Some("failed"), Some("short")]),
                Coverage::of("pairs", [None::<&str>]),
            ],
        );
        let words: Vec<String> = all.iter().map(Coverage::to_string).collect();
        assert_eq!(
            words,
            [
                "1 of 4 points judged; 3 not: 2 short, 1 failed",
                "1 of 1 pairs judged"
            ]
        );
        assert!(all.iter().all(Coverage::adds_up));
    }
}
