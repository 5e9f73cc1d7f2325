//! The result for people, programs and pages.

use std::fmt::Write;
use std::io;
use std::path::Path;

use serde_json::{Value, json};

use super::{JudgedColumn, Judgement, advice};
use crate::cli::{github, screen};
use crate::explain::section;
use crate::judge::claims::Claim;
use crate::judge::fit::Level;
use crate::judge::shown::{self, MOST_PLACES, Shown};
use crate::judge::verdict::{Aside, SetAside, Verdict};
use crate::plots::{Convergence, ErrorSeries, Guide, convergence};
use crate::store::{atomic, junit};
use crate::text::number::{order_text, pair_text, short_text};
use crate::text::visible::{self, visible};

/// Most columns in the figure: more would have the colours of the first.
const DRAWN: usize = 8;

impl JudgedColumn<'_> {
    /// Rate, claim, the reason where that is not a pass, and the limit of values.
    fn found(&self) -> String {
        let found = match self.claim {
            Claim { at_least: true, order, tolerance, .. } => {
                let passes = format!("at least {}, not {}", order_text(order), order_text(order - 2.0 * tolerance));
                let why = if self.rate.verdict.is_pass() { &passes } else { &self.rate.because };
                format!("{}, claimed {}: {why}", self.rate.rate_in_words(MOST_PLACES), self.claim)
            }
            _ => self.shown().found(),
        };
        match self.estimate.as_ref().map(|estimate| (&estimate.bar, &estimate.gci)) {
            Some((Ok(bar), gci)) => {
                let [low, high] = pair_text(bar.limit);
                let gci = gci.map_or(String::new(), |gci| format!(", GCI ± {}", short_text(gci.half_width)));
                found + &format!("; limit {} ({low} to {high}){gci}", pair_text([bar.extrapolated, bar.limit[1]])[0])
            }
            Some((Err(refusal), _)) => found + &format!("; no limit: {refusal}"),
            None => found,
        }
    }

    fn shown(&self) -> Shown<'_> {
        let late = usize::from(self.estimate.is_some());
        Shown { name: &self.column.name, levels: &self.column.levels, rate: &self.rate, late }
    }
}

/// The errors with the rates beside them, a verdict for each column, what to do, and the verdict on all.
pub(super) fn text(findings: &Judgement<'_>, quiet: bool) -> String {
    let mut text = String::new();
    if !quiet || findings.table.is_guessed {
        text += &format!("{}\n", findings.table.reading);
    }
    if !quiet {
        let columns: Vec<Shown<'_>> = findings.columns.iter().map(JudgedColumn::shown).collect();
        text += &(shown::table(&findings.table.step, &columns, findings.judge.floor()) + "\n");
    }
    for judged in
        findings.columns.iter().filter(|judged| !quiet || (judged.decides && judged.rate.verdict != Verdict::Pass))
    {
        let _ = writeln!(text, "{}: {}: {}", judged.column.name, screen::verdict(judged.rate.verdict), judged.found());
    }
    if !quiet {
        // The same words for several columns stand once.
        let mut advice: Vec<(&str, String)> = vec![];
        for judged in
            findings.columns.iter().filter(|judged| judged.is_claimed() && judged.rate.verdict != Verdict::Pass)
        {
            let words = (judged.rate.kind.code(), advice::words(judged, findings));
            if !advice.contains(&words) {
                advice.push(words);
            }
        }
        advice.iter().for_each(|(reason, words)| section(&mut text, reason, words));
        if findings.columns.iter().any(|judged| !judged.is_claimed()) {
            let (command, source) = (findings.project.command, &findings.source);
            let _ = writeln!(
                text,
                "\nclaim what theory says: {command} rates {source}: --order P for all columns, --order NAME=P for one"
            );
        }
        text.push('\n');
    }
    text + &format!("{}: {}\n", screen::verdict(findings.verdict), sentence(findings))
}

/// The overall verdict in words.
fn sentence(findings: &Judgement<'_>) -> String {
    let deciding = || findings.columns.iter().filter(|column| column.decides);
    let passed = deciding().filter(|column| column.rate.verdict == Verdict::Pass).count();
    match deciding().count() {
        0 => "no order is claimed".to_owned(),
        1 => format!("{passed} of 1 column agrees with its order"),
        count => format!("{passed} of {count} columns agree with their orders"),
    }
}

/// What `rates --format json` prints, beside the verdict: rates as in `study --format json`, the column's name for
/// the norm's.
pub(super) fn object(findings: &Judgement<'_>) -> Value {
    let rate = |judged: &JudgedColumn<'_>| {
        let mut object = json!(judged.rate);
        let level = |level: &Level| json!({"step": level.step, "error": level.error});
        let aside = |aside: &SetAside| json!({"level": aside.level, "because": aside.because.text()});
        object["norm"] = json!(judged.column.name);
        object["decides"] = json!(judged.decides);
        object["at_least"] = json!(judged.claim.at_least);
        object["levels"] = judged.column.levels.iter().map(level).collect();
        object["set_aside"] = judged.rate.set_aside.iter().map(aside).collect();
        if !judged.is_claimed() {
            object["reason"] = json!("no order is claimed");
        }
        if let Some(Ok(bar)) = judged.estimate.as_ref().map(|estimate| &estimate.bar) {
            object["limit"] = json!({"value": bar.extrapolated, "interval": bar.limit});
        }
        if let Some(Ok(gci)) = judged.estimate.as_ref().map(|estimate| &estimate.gci) {
            object["gci"] = json!(gci.half_width);
        }
        object
    };
    let not_errors =
        findings.table.not_errors.iter().map(|(column, because)| json!({"column": column, "because": because}));
    json!({
        "step": findings.table.step, "floor": findings.judge.floor(),
        "rates": findings.columns.iter().map(rate).collect::<Vec<_>>(),
        "not_errors": not_errors.collect::<Vec<_>>(), "notes": [findings.table.reading],
    })
}

/// Writes figure, Markdown and JUnit XML, each as a whole, and appends to the job summary of GitHub.
///
/// # Errors
/// That of the operating system, with the name of the file.
pub(super) fn write(findings: &Judgement<'_>, folder: &Path) -> io::Result<()> {
    atomic::prepare_folder(folder)?;
    atomic::write(&folder.join("rates.svg"), figure(findings))?;
    atomic::write(&folder.join("rates.md"), markdown(findings, "![Errors over steps](rates.svg)\n\n"))?;
    let case = |judged: &JudgedColumn<'_>| {
        let least = if judged.claim.at_least { "at least " } else { "" };
        let claim = if judged.is_claimed() { format!(": order {least}{}", judged.rate.order) } else { String::new() };
        (judged.column.name.clone() + &claim, judged.rate.verdict, judged.found())
    };
    let mut cases: Vec<_> = findings.columns.iter().filter(|column| column.decides).map(case).collect();
    if cases.is_empty() {
        cases.push(("a claim".to_owned(), findings.verdict, sentence(findings)));
    }
    let junit = junit::junit_of(findings.project.name, &findings.source, &cases).map_err(io::Error::other)?;
    atomic::write(&folder.join("junit.xml"), junit)?;
    // A picture would have to be somewhere on the web.
    github::summarise(&markdown(findings, ""));
    Ok(())
}

/// The errors over the steps, columns with a claim first.
fn figure(findings: &Judgement<'_>) -> String {
    let mut drawn: Vec<&JudgedColumn<'_>> =
        findings.columns.iter().filter(|judged| judged.estimate.is_none()).collect();
    drawn.sort_by_key(|judged| !judged.decides);
    let series = |judged: &&JudgedColumn<'_>| ErrorSeries {
        label: judged.column.name.clone(),
        points: judged.column.levels.iter().map(|level| (level.step, level.error)).collect(),
        order: Some(judged.rate.order).filter(|order| !order.is_nan()),
        fit: judged.rate.power_law(),
        interval: judged.rate.interval,
        used: Some(judged.rate.used.clone()),
        ..ErrorSeries::default()
    };
    let series: Vec<ErrorSeries> = drawn.iter().take(DRAWN).map(series).collect();
    let at_floor =
        |judged: &&JudgedColumn<'_>| judged.rate.set_aside.iter().any(|aside| aside.because == Aside::AtFloor);
    let floor = drawn.iter().any(at_floor).then(|| Guide { label: "floor".to_owned(), value: findings.judge.floor() });
    let (x_label, y_label) = (findings.table.step.clone(), "error".to_owned());
    convergence(&Convergence { x_label, y_label, series, floor, ..Convergence::default() })
}

/// What is printed, as a page.
///
/// * `picture`: where the figure goes, with the empty line below it.
fn markdown(findings: &Judgement<'_>, picture: &str) -> String {
    let plain = |c: char| if "\\|*_`<[]".contains(c) { vec!['\\', c] } else { vec![c] };
    let source: String = visible(&findings.source).chars().flat_map(plain).collect();
    let text = visible::lines(&text(findings, false));
    let block: String = text.lines().map(|line| format!("    {line}\n")).collect();
    format!("# Rates of {source}\n\n**{}**: {}\n\n{picture}{block}", findings.verdict, sentence(findings))
}
