//! The verdict as a badge for a project's page: a picture, and the numbers of one for a service
//! that draws badges.

use serde_json::json;

use crate::judge::verdict::Verdict;
use crate::store::Record;

/// The text on the left of the badge.
const LABEL: &str = "orders";

/// Pixels of a letter; the two texts are stretched to their places, so that all fonts fit.
const LETTER: usize = 7;

/// Pixels on both sides of a text.
const MARGIN: usize = 6;

/// The text on the right, and its colour.
struct Badge {
    message: String,
    colour: &'static str,
}

impl Badge {
    /// How many studies pass; if not all do, how many fail, or how many are undecided. If all pass
    /// and the run does not, numbers differ from the baseline, or have none.
    fn new(record: &Record) -> Self {
        let count = |verdict| {
            let studies = record.studies.iter();
            let found = studies.filter(|finished| finished.outcome.verdict == verdict);
            found.count()
        };
        let [failed, undecided] = [Verdict::Fail, Verdict::Inconclusive].map(count);
        let (message, colour) = if failed > 0 {
            (format!("{failed} lost"), "#b3261e")
        } else if undecided > 0 {
            (format!("{undecided} undecided"), "#946200")
        } else if record.verdict == Verdict::Pass {
            (format!("{} verified", record.studies.len()), "#2e7d32")
        } else {
            ("not accepted".to_owned(), "#b3261e")
        };
        Self { message, colour }
    }
}

/// The picture, as SVG: the same bytes for the same record.
pub(super) fn svg(record: &Record) -> String {
    let Badge { message, colour } = Badge::new(record);
    let [label, text] = [LABEL, &message].map(|text| text.len() * LETTER);
    let left = label + 2 * MARGIN;
    let width = left + text + 2 * MARGIN;
    let place = left + MARGIN;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"20\" role=\"img\" aria-label=\"{LABEL}: {message}\">\n\
         <title>{LABEL}: {message}</title>\n\
         <rect width=\"{width}\" height=\"20\" rx=\"3\" fill=\"#444\"/>\n\
         <path d=\"M{left} 0H{width}V20H{left}Z\" fill=\"{colour}\"/>\n\
         <g fill=\"#fff\" font-family=\"Verdana,sans-serif\" font-size=\"11\">\n\
         <text x=\"{MARGIN}\" y=\"14\" textLength=\"{label}\">{LABEL}</text>\n\
         <text x=\"{place}\" y=\"14\" textLength=\"{text}\">{message}</text>\n\
         </g>\n\
         </svg>\n"
    )
}

/// The object that shields.io takes as an endpoint.
pub(super) fn endpoint(record: &Record) -> String {
    let Badge { message, colour } = Badge::new(record);
    let object = json!({"schemaVersion": 1, "label": LABEL, "message": message, "color": colour});
    format!("{object}\n")
}
