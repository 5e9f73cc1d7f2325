//! What studies, reasons for a verdict and a project's own terms mean, in words.

use std::fmt::Write;

use crate::judge::verdict::Reason;
use crate::project::Project;
use crate::study::{KindRow, Study};
use crate::text::names::nearest;

/// Every reason, for listing.
pub(crate) const REASONS: [Reason; 20] = [
    Reason::Agrees,
    Reason::NoResult,
    Reason::NonFiniteError,
    Reason::NegativeError,
    Reason::ErrorGrows,
    Reason::FallsAway,
    Reason::TooLow,
    Reason::TooHigh,
    Reason::ZeroError,
    Reason::StepsNotDecreasing,
    Reason::ClaimUnusable,
    Reason::ToleranceTooWide,
    Reason::TooFewLevels,
    Reason::NotAsymptotic,
    Reason::RoundOffFloor,
    Reason::WildRate,
    Reason::Outlier,
    Reason::LevelsTooClose,
    Reason::IntervalTooWide,
    Reason::AtTheEdge,
];

/// The name by which a reason is asked for, and what it means, with what to do next.
pub(crate) fn reason_text(reason: Reason) -> (&'static str, &'static str) {
    match reason {
        Reason::Agrees => ("agrees", "The whole interval of the rate lies within the tolerance of the order."),
        Reason::NoResult => (
            "no-result",
            "A case failed, or its answer lacks the error. The rate is that of the levels that have one; it decides nothing. Mend that case.",
        ),
        Reason::NonFiniteError => (
            "non-finite",
            "An error is NaN or infinite: a case broke down, or did not come to its end. Mend that case.",
        ),
        Reason::NegativeError => {
            ("negative", "An error is negative, which no norm can be: a sign was lost, or a difference was given.")
        }
        Reason::ErrorGrows => (
            "grows",
            "Refining does not make the error smaller, though it is above the round-off floor: no convergence. Are the levels those \
             of these errors, and is the exact solution that of the problem?",
        ),
        Reason::FallsAway => (
            "falls-away",
            "The finest rates fall, by more than half an order: the error tends to a limit that is not zero, or to a lower order. Look \
             for what does not change with the step: the reference, the solver's tolerance, the error of the other axis.",
        ),
        Reason::TooLow => (
            "too-low",
            "The whole interval lies below the band: an order is lost. Look for a term of lower order: boundary or initial data, the \
             quadrature, the first step, a coefficient at the wrong time.",
        ),
        Reason::TooHigh => (
            "too-high",
            "The whole interval lies above the band: the exact solution may be too simple, or the error not the one that was meant.",
        ),
        Reason::ZeroError => (
            "zero",
            "An error of exactly zero has no logarithm: the solution lies in the discrete space. Choose another one.",
        ),
        Reason::StepsNotDecreasing => ("steps", "Levels must be given coarse to fine, each once."),
        Reason::ClaimUnusable => (
            "claim",
            "The order and the tolerance must be positive numbers. Where no order is claimed, none is confirmed.",
        ),
        Reason::ToleranceTooWide => {
            ("tolerance", "Half an order or more on either side accepts two integer orders. Claim more narrowly.")
        }
        Reason::TooFewLevels => (
            "levels",
            "A rate with an interval needs three levels above the round-off floor; four or more make the interval narrow.",
        ),
        Reason::NotAsymptotic => (
            "asymptotic",
            "The rates are still changing, or change more and more. Add finer levels; where they scatter, take an error that \
                 does not change its sign.",
        ),
        Reason::RoundOffFloor => (
            "floor",
            "Errors so small are taken for round-off. Add coarser levels, or set a lower floor where they are known better.",
        ),
        Reason::WildRate => {
            ("wild", "A pairwise rate is more than five orders away from the claim: these levels are not one family.")
        }
        Reason::Outlier => (
            "outlier",
            "The levels before and after it lie on one line of the finest rate, and it is off by a factor of two or more. Look for what is \
             different in that case, or leave it out.",
        ),
        Reason::LevelsTooClose => (
            "close",
            "The coarsest step is less than 1.5 times the finest: a term of lower order would not show. Refine further.",
        ),
        Reason::IntervalTooWide => (
            "wide",
            "The data scatter too much for this tolerance. Add levels, take an error that does not change its sign, or claim less \
             narrowly.",
        ),
        Reason::AtTheEdge => (
            "edge",
            "The interval is narrow, but holds an end of the band: the claim is neither confirmed nor refuted.",
        ),
    }
}

/// A term of the project, a reason or a kind, in words; `None` where nothing has that name.
pub fn term(project: &Project, name: &str) -> Option<String> {
    if let Some(term) = project.terms.iter().find(|term| term.name == name) {
        let mut text = format!("{name}, {}\n", term.what);
        section(&mut text, "what it means", &format!("{}.", term.text));
        return Some(text);
    }
    for reason in REASONS {
        let (known, text) = reason_text(reason);
        if known == name {
            let mut words = format!("{name}, a reason for {}\n", reason.verdict());
            section(&mut words, "in short", &format!("{}.", reason.text()));
            section(&mut words, "what it means", text);
            return Some(words);
        }
    }
    let kind = project.kinds.iter().find(|kind| kind.name == name)?;
    let mut text = format!("{name}, a kind of study\n");
    describe(&mut text, kind, &[]);
    Some(text)
}

/// The names that [`term`] knows.
pub fn terms(project: &Project) -> Vec<&'static str> {
    groups(project).into_iter().flat_map(|(_, names)| names).collect()
}

/// The names that [`term`] knows, group by group.
pub fn contents(project: &Project) -> String {
    let mut text = "what can be explained\n".to_owned();
    for (title, names) in groups(project) {
        section(&mut text, &title, &names.join(", "));
    }
    text
}

fn groups(project: &Project) -> Vec<(String, Vec<&'static str>)> {
    let mut groups: Vec<(String, Vec<&'static str>)> = vec![];
    for term in project.terms {
        match groups.iter_mut().find(|(what, _)| *what == term.what) {
            Some((_, names)) => names.push(term.name),
            None => groups.push((term.what.to_owned(), vec![term.name])),
        }
    }
    groups.push(("reasons for a verdict".to_owned(), REASONS.iter().map(|&reason| reason_text(reason).0).collect()));
    groups.push(("kinds of study".to_owned(), project.kinds.iter().map(|kind| kind.name).collect()));
    groups
}

/// A study in words; `None` where the project does not know its kind.
pub fn study(project: &Project, study: &dyn Study) -> Option<String> {
    let header = study.header();
    let kind = project.kinds.iter().find(|kind| kind.name == header.kind)?;
    let mut text = format!("{} ({}, tier {})\n", header.id, header.kind, header.tier.name());
    section(&mut text, "what is claimed", &header.claim);
    describe(&mut text, kind, &study.details());
    Some(text)
}

/// The id or term closest to a misspelt one.
pub fn meant<'i>(project: &Project, ids: impl IntoIterator<Item = &'i str>, name: &str) -> Option<String> {
    nearest(name, ids.into_iter().chain(terms(project))).map(str::to_owned)
}

/// * `details`: paragraphs of one study, each with its title.
fn describe(text: &mut String, kind: &KindRow, details: &[(String, String)]) {
    section(text, "why it should hold", kind.why);
    details.iter().for_each(|(title, paragraph)| section(text, title, paragraph));
    section(text, "how it is judged", kind.judged);
    section(text, "what a failure would mean", kind.failure);
}

/// A title, and a paragraph with lines of at most 100 characters.
pub(crate) fn section(text: &mut String, title: &str, paragraph: &str) {
    const WIDTH: usize = 100;
    let _ = write!(text, "\n{title}\n ");
    let mut column = 1;
    for word in paragraph.split_whitespace() {
        if column + 1 + word.chars().count() > WIDTH {
            text.push_str("\n ");
            column = 1;
        }
        let _ = write!(text, " {word}");
        column += 1 + word.chars().count();
    }
    text.push('\n');
}
