//! The last verdict as a badge for a README.

use crate::judge::verdict::Verdict;

/// What is verified, on the left.
const LABEL: &str = "verification";

/// Pixels of a letter of 11 px, on the wide side.
const LETTER: usize = 7;

/// An SVG picture, 20 px high, that needs no font of its own and loads nothing.
pub fn badge(verdict: Verdict) -> String {
    let colour = match verdict {
        Verdict::Pass => "#2a7d2e",
        Verdict::Inconclusive => "#8a6100",
        Verdict::Fail => "#b3261e",
    };
    let name = verdict.name();
    let [left, right] = [LABEL, name].map(|text| text.len() * LETTER + 10);
    let (width, middles) = (left + right, [left / 2, left + right / 2]);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"20\" role=\"img\">\n\
         <title>{LABEL}: {name}</title>\n\
         <rect width=\"{left}\" height=\"20\" fill=\"#555555\"/>\n\
         <rect x=\"{left}\" width=\"{right}\" height=\"20\" fill=\"{colour}\"/>\n\
         <g fill=\"#ffffff\" font-family=\"sans-serif\" font-size=\"11\" text-anchor=\"middle\">\n\
         <text x=\"{}\" y=\"14\">{LABEL}</text>\n<text x=\"{}\" y=\"14\">{name}</text>\n</g>\n</svg>\n",
        middles[0], middles[1],
    )
}
