//! The result for people, programs and pages.

use std::io;
use std::path::Path;

use serde_json::{Value, json};

use super::{JudgedColumn, Judgement};
use crate::cli::explain::section;
use crate::cli::github;
use crate::input::error_table::limit;
use crate::judge::claims::Claim;
use crate::judge::fit::Level;
use crate::judge::shown::{self, MOST_PLACES, Shown};
use crate::judge::verdict::{Aside, RateVerdict, Reason, SetAside, Verdict, judged_in_words};
use crate::plots::xy::Xy;
use crate::plots::{ErrorSeries, Guide, convergence};
use crate::store::{JudgedSuite, atomic, junit_of};
use crate::text::number::{
    committed_rate, counted, error_text, order_text, pair_text, plain_text, short_text,
};
use crate::text::visible::{self, visible};

/// Most columns in the figure: more would repeat the colours.
const DRAWN: usize = 8;
/// Largest difference between two steady rates.
const STEADY: f64 = 0.2;
/// Least fall, in orders, of a steady rate where the error stops falling.
const STOP: f64 = 0.5;
/// Most levels that are predicted.
const AHEAD: i32 = 3;

impl JudgedColumn<'_> {
    /// Rate, claim, the reason unless it is a pass, and the limit of values.
    fn answer(&self) -> String {
        let rate = match self.claim {
            Claim {
                at_least: true,
                order,
                tolerance,
                ..
            } => {
                let passes = format!("at least {}", order_text(committed_rate(order - tolerance)));
                let why = if self.rate.verdict.is_pass() {
                    &passes
                } else {
                    &self.rate.because
                };
                let rate = self.rate.rate_in_words(MOST_PLACES);
                judged_in_words(&rate, &self.claim.to_string(), why)
            }
            _ => self.rate.answer(MOST_PLACES),
        };
        match self
            .estimate
            .as_ref()
            .map(|estimate| (&estimate.bar, &estimate.gci))
        {
            Some((Ok(bar), gci)) => {
                let [low, high] = pair_text(bar.limit);
                let gci = gci.map_or(String::new(), |gci| {
                    format!(", GCI ± {}", short_text(gci.half_width))
                });
                rate + &format!(
                    "; limit {} ({low} to {high}){gci}",
                    pair_text([bar.extrapolated, bar.limit[1]])[0]
                )
            }
            Some((Err(refusal), _)) => rate + &format!("; no limit: {refusal}"),
            None => rate,
        }
    }

    fn column_with_rate(&self) -> Shown<'_> {
        let late = usize::from(self.estimate.is_some());
        Shown {
            name: &self.column.name,
            levels: &self.column.levels,
            rate: &self.rate,
            late,
        }
    }
}

/// What is found in all tables: each under its name if there are several, then the verdict on all.
///
/// * `shown`: a verdict as it is printed, perhaps in its colour.
pub(super) fn text_of_all(
    findings: &[Judgement<'_>],
    verdict: Verdict,
    quiet: bool,
    shown: fn(Verdict) -> String,
) -> String {
    if let [alone] = findings {
        return text(alone, quiet, shown);
    }
    let one = |findings: &Judgement<'_>| {
        let text = text(findings, quiet, shown);
        format!("{}\n{text}\n", visible(&findings.source.name))
    };
    let tables: String = findings
        .iter()
        .filter(|findings| !(quiet && findings.verdict.is_pass()))
        .map(one)
        .collect();
    format!(
        "{tables}{}: {}\n",
        shown(verdict),
        sentence_of_all(findings)
    )
}

/// How many tables agree, or what the only one says.
fn sentence_of_all(findings: &[Judgement<'_>]) -> String {
    if let [alone] = findings {
        return sentence(alone);
    }
    let passed = findings
        .iter()
        .filter(|findings| findings.verdict.is_pass())
        .count();
    format!("{passed} of {} agree", counted(findings.len(), "table"))
}

impl Judgement<'_> {
    fn columns_with_rates(&self) -> Vec<Shown<'_>> {
        self.columns
            .iter()
            .map(JudgedColumn::column_with_rate)
            .collect()
    }
}

/// The rows of each table, separated by commas, without marks; a line with its name before each of
/// several.
pub(super) fn csv(findings: &[Judgement<'_>]) -> String {
    let cell = |cell: &String| {
        let cell = cell.trim_end_matches([' ', '_', '~', '\'']).trim();
        if cell.contains([',', '"', '\n']) {
            format!("\"{}\"", cell.replace('"', "\"\""))
        } else {
            cell.to_owned()
        }
    };
    let line = |row: &Vec<String>| row.iter().map(cell).collect::<Vec<_>>().join(",") + "\n";
    let table = |judgement: &Judgement<'_>| {
        let rows = shown::rows(
            &judgement.source.table.step,
            &judgement.columns_with_rates(),
        );
        let head = if findings.len() > 1 {
            format!("# {}\n", visible(&judgement.source.name))
        } else {
            String::new()
        };
        head + &rows.iter().map(line).collect::<String>()
    };
    findings.iter().map(table).collect::<Vec<_>>().join("\n")
}

/// The rows of each table in Markdown, with the meaning of their marks; each of several under its
/// name.
pub(super) fn rows_in_markdown(findings: &[Judgement<'_>]) -> String {
    let line = |row: &Vec<String>| {
        let cells: Vec<String> = row.iter().map(|cell| escaped(cell.trim())).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let table = |judgement: &Judgement<'_>| {
        let columns = judgement.columns_with_rates();
        let rows = shown::rows(&judgement.source.table.step, &columns);
        let head = if findings.len() > 1 {
            format!("## {}\n\n", escaped(&judgement.source.name))
        } else {
            String::new()
        };
        let rule = format!("|{}\n", " --: |".repeat(rows[0].len()));
        let body: String = rows[1..].iter().map(line).collect();
        let legend: String = shown::legend(&columns, judgement.judge.floor())
            .lines()
            .map(|line| format!("\n{}\n", escaped(line)))
            .collect();
        head + &line(&rows[0]) + &rule + &body + &legend
    };
    findings.iter().map(table).collect::<Vec<_>>().join("\n")
}

/// A text in Markdown, without markup of its own.
fn escaped(text: &str) -> String {
    let plain = |c: char| {
        if "\\|*_`<[]".contains(c) {
            vec!['\\', c]
        } else {
            vec![c]
        }
    };
    visible(text).chars().flat_map(plain).collect()
}

/// The errors with their rates, a verdict for each column, advice, and the overall verdict.
fn text(findings: &Judgement<'_>, quiet: bool, shown: fn(Verdict) -> String) -> String {
    let table = &findings.source.table;
    let columns = &findings.columns;
    let is_pass = |judged: &JudgedColumn<'_>| judged.rate.verdict == Verdict::Pass;
    let line = |judged: &JudgedColumn<'_>| {
        format!(
            "{}: {}: {}\n",
            judged.column.name,
            shown(judged.rate.verdict),
            judged.answer()
        )
    };
    let last = format!("{}: {}\n", shown(findings.verdict), sentence(findings));
    let reading = format!("{}\n", table.reading);
    if quiet {
        let lines: String = columns
            .iter()
            .filter(|judged| judged.decides && !is_pass(judged))
            .map(line)
            .collect();
        return if table.is_guessed {
            reading
        } else {
            String::new()
        } + &lines
            + &last;
    }
    let mut text = reading
        + &shown::table(
            &table.step,
            &findings.columns_with_rates(),
            findings.judge.floor(),
        )
        + "\n";
    text.extend(columns.iter().map(line));
    // Words common to several columns appear once.
    let mut said = vec![];
    for judged in columns
        .iter()
        .filter(|judged| judged.is_claimed() && !is_pass(judged))
    {
        let words = (judged.rate.kind.code(), advice(judged, findings));
        if !said.contains(&words) {
            section(&mut text, words.0, &words.1);
            said.push(words);
        }
    }
    if !columns.iter().all(JudgedColumn::is_claimed) {
        let command = format!(
            "{} rates {}",
            findings.project.command, findings.source.file
        );
        text += &format!(
            "\nclaim what theory says: {command}: --order P for all columns, --order NAME=P for one\n"
        );
    }
    text + "\n" + &last
}

/// What the reason means for a column, and what to do, using its numbers if they show more than the
/// reason.
fn advice(judged: &JudgedColumn<'_>, findings: &Judgement<'_>) -> String {
    let rate = &judged.rate;
    let name = &judged.column.name;
    let step = &findings.source.table.step;
    let general = rate.advice().unwrap_or_default();
    let errors: Vec<f64> = judged
        .column
        .levels
        .iter()
        .map(|level| level.error)
        .collect();
    let grows = |rates: &[f64]| rates.len() > 1 && rates.iter().all(|rate| *rate < 0.0);
    let stays = matches!(
        rate.kind,
        Reason::ErrorGrows | Reason::FallsAway | Reason::TooLow | Reason::ZeroError
    );
    if judged.estimate.is_some() || rate.cause.is_some() || !(stays || rate.kind.wants_a_level()) {
        general
    } else if errors
        .iter()
        .position(|error| *error == 0.0)
        .is_some_and(|zero| zero + 1 == errors.len())
    {
        format!(
            "{name} is zero on the finest level only. Is that level its own reference? Leave it out."
        )
    } else if findings
        .columns
        .iter()
        .all(|column| !column.is_claimed() || grows(&column.rate.pairwise))
    {
        format!("The errors fall as `{step}` grows. Do they stand beside their own steps?")
    } else if let Some(level) = stop(&rate.pairwise) {
        let rate = rate.pairwise[level - 1];
        let error = error_text(errors[level]);
        let causes = "the solver's tolerance, the reference solution, round-off (--floor), the error of the other axis?";
        format!(
            "{name} falls with rate {rate:.2} down to {error}, then stops. What stays there: {causes}"
        )
    } else if let Some(limit) = limit(&errors).filter(|_| may_be_zero(rate)).map(plain_text) {
        let would = format!(
            "{name} would tend to {limit}, not to zero, if its differences went on falling as the last two"
        );
        format!("{would}. If it is a value and no error: --values '{name}'. {general}")
    } else {
        general + &next_level(judged, findings).unwrap_or_default()
    }
}

/// Whether the rate may be 0, within the tolerance, and the finest levels do not say otherwise.
fn may_be_zero(rate: &RateVerdict) -> bool {
    rate.interval.is_none_or(|[low, _]| low <= rate.tolerance)
        && rate.finest_rate().is_none_or(|rate| rate < STOP)
}

/// The level down to which the error falls at a steady rate, if it stops falling there.
fn stop(rates: &[f64]) -> Option<usize> {
    let last = rates.last()?;
    (2..rates.len()).find(|&k| {
        let steady = rates[k - 1];
        let stops = rates[k..].iter().all(|rate| *rate < steady - STOP)
            && *last < 0.5 * steady
            && steady > STOP;
        stops && (rates[k - 2] - steady).abs() <= STEADY
    })
}

/// The level that would decide if the rates continued: their changes shrink as the last two did.
fn next_level(judged: &JudgedColumn<'_>, findings: &Judgement<'_>) -> Option<String> {
    let mut levels = judged.column.levels.clone();
    let rates = &judged.rate.pairwise;
    let ([.., before, finest], [.., last]) = (&levels[..], &rates[..]) else {
        return None;
    };
    let ratio = before.step / finest.step;
    let finest = finest.step;
    let mut rate = *last;
    let changes: Vec<f64> = rates.windows(2).map(|two| two[1] - two[0]).collect();
    let mut change = *changes.last()?;
    let shrinks = changes.iter().rev().nth(1).map(|before| change / before);
    let shrinks = shrinks
        .filter(|share| *share > 0.0 && *share < 1.0)
        .unwrap_or(0.5);
    if !judged.rate.kind.wants_a_level() || !rates.iter().all(|rate| *rate > 0.0) {
        return None;
    }
    for ahead in 1..=AHEAD {
        let last = levels[levels.len() - 1];
        change *= shrinks;
        rate += change;
        levels.push(Level {
            step: last.step / ratio,
            error: last.error * ratio.powf(-rate),
        });
        let next = findings.judge.judge(&levels, judged.rate.order);
        if next.verdict == Verdict::Inconclusive {
            continue;
        }
        let name = &judged.column.name;
        let step = &findings.source.table.step;
        let parts = ratio.powi(ahead) / finest;
        let is_part = step == "h" && (parts - parts.round()).abs() < 1e-9 * parts;
        let at = if is_part {
            format!("1/{}", parts.round())
        } else {
            plain_text(1.0 / parts)
        };
        let (which, are) = if ahead == 1 {
            ("Another level,", "is")
        } else {
            ("Levels down to", "are")
        };
        let half = |interval: [f64; 2]| short_text(0.5 * (interval[1] - interval[0]));
        let now = judged.rate.interval.map_or(String::new(), |now| {
            format!("interval ± {} now, ", half(now))
        });
        let then = format!(
            "{name}: {now}about ± {} then",
            next.interval.map_or(String::new(), half)
        );
        return Some(format!(
            " {which} {step} = {at}, {are} likely to decide ({then})."
        ));
    }
    None
}

/// The overall verdict in words.
fn sentence(findings: &Judgement<'_>) -> String {
    let deciding = || findings.columns.iter().filter(|column| column.decides);
    let passed = deciding()
        .filter(|column| column.rate.verdict == Verdict::Pass)
        .count();
    match deciding().count() {
        0 => "no order is claimed".to_owned(),
        1 => format!("{passed} of 1 column agrees with its order"),
        count => format!("{passed} of {count} columns agree with their orders"),
    }
}

/// What `rates --format json` prints in addition to the verdict: the object of a table, or a list of
/// several, each with its name and verdict.
pub(super) fn object_of_all(findings: &[Judgement<'_>]) -> Value {
    if let [alone] = findings {
        return object(alone);
    }
    let table = |findings: &Judgement<'_>| {
        let mut object = object(findings);
        object["table"] = json!(findings.source.name);
        object["verdict"] = json!(findings.verdict.name());
        object
    };
    json!({"tables": findings.iter().map(table).collect::<Vec<_>>()})
}

/// Rates as in `study --format json`, with the column's name as the norm's.
fn object(findings: &Judgement<'_>) -> Value {
    let rate = |judged: &JudgedColumn<'_>| {
        let mut object = json!(judged.rate);
        let level = |level: &Level| json!({"step": level.step, "error": level.error});
        let aside =
            |aside: &SetAside| json!({"level": aside.level, "because": aside.because.text()});
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
    let not_errors = findings
        .source
        .table
        .not_errors
        .iter()
        .map(|(column, because)| json!({"column": column, "because": because}));
    json!({
        "step": findings.source.table.step, "floor": findings.judge.floor(),
        "rates": findings.columns.iter().map(rate).collect::<Vec<_>>(),
        "not_errors": not_errors.collect::<Vec<_>>(), "notes": [findings.source.table.reading],
    })
}

/// Writes figures, Markdown and JUnit XML, each atomically, and appends to the job summary of
/// GitHub. The figure of an only table is `rates.svg`, those of several are `rates-1.svg`, ...
///
/// # Errors
/// The error of the operating system, with the name of the file.
pub(super) fn write(findings: &[Judgement<'_>], verdict: Verdict, folder: &Path) -> io::Result<()> {
    atomic::prepare_folder(folder)?;
    let mut pages = vec![];
    for (k, judgement) in findings.iter().enumerate() {
        let name = if findings.len() == 1 {
            "rates.svg".to_owned()
        } else {
            format!("rates-{}.svg", k + 1)
        };
        atomic::write(&folder.join(&name), figure(judgement))?;
        let picture = format!("![Errors over steps]({name})\n\n");
        pages.push(markdown(judgement, &picture));
    }
    if findings.len() > 1 {
        pages.push(format!("**{verdict}**: {}\n", sentence_of_all(findings)));
    }
    atomic::write(&folder.join("rates.md"), pages.join("\n"))?;
    let suites: Vec<JudgedSuite> = findings.iter().map(suite).collect();
    let project = findings.first().map_or("", |first| first.project.name);
    let junit = junit_of(project, &suites).map_err(io::Error::other)?;
    atomic::write(&folder.join("junit.xml"), junit)?;
    // A picture would need an address on the web.
    for judgement in findings {
        github::summarise(&markdown(judgement, ""));
    }
    Ok(())
}

/// A test case for each column that decides; without one a case that fails for want of a claim.
fn suite(findings: &Judgement<'_>) -> JudgedSuite {
    let case = |judged: &JudgedColumn<'_>| {
        let least = if judged.claim.at_least {
            "at least "
        } else {
            ""
        };
        let claim = if judged.is_claimed() {
            format!(": order {least}{}", judged.rate.order)
        } else {
            String::new()
        };
        (
            judged.column.name.clone() + &claim,
            judged.rate.verdict,
            judged.answer(),
        )
    };
    let deciding = findings.columns.iter().filter(|column| column.decides);
    let mut cases: Vec<_> = deciding.map(case).collect();
    if cases.is_empty() {
        cases.push(("a claim".to_owned(), findings.verdict, sentence(findings)));
    }
    JudgedSuite {
        name: findings.source.name.clone(),
        cases,
    }
}

/// The errors over the steps, columns with a claim first.
fn figure(findings: &Judgement<'_>) -> String {
    let mut drawn: Vec<&JudgedColumn<'_>> = findings
        .columns
        .iter()
        .filter(|judged| judged.estimate.is_none())
        .collect();
    drawn.sort_by_key(|judged| !judged.decides);
    let series = |judged: &&JudgedColumn<'_>| ErrorSeries {
        label: judged.column.name.clone(),
        points: judged
            .column
            .levels
            .iter()
            .map(|level| (level.step, level.error))
            .collect(),
        order: Some(judged.rate.order).filter(|order| !order.is_nan()),
        fit: judged.rate.power_law(),
        interval: judged.rate.interval,
        used: Some(judged.rate.used.clone()),
        ..ErrorSeries::default()
    };
    let series: Vec<ErrorSeries> = drawn.iter().take(DRAWN).map(series).collect();
    let at_floor = |judged: &&JudgedColumn<'_>| {
        judged
            .rate
            .set_aside
            .iter()
            .any(|aside| aside.because == Aside::AtFloor)
    };
    let floor = drawn.iter().any(at_floor).then(|| Guide {
        label: "floor".to_owned(),
        value: findings.judge.floor(),
    });
    let guides = floor.into_iter().collect();
    convergence(
        Xy {
            title: Some(format!(
                "Errors over {}, and the lines of their rates",
                findings.source.table.step
            )),
            guides,
            ..Xy::of_errors(&findings.source.table.step)
        },
        &series,
        &[],
    )
}

/// The printed result, as a page.
///
/// * `picture`: the link to the figure, with the empty line below it.
fn markdown(findings: &Judgement<'_>, picture: &str) -> String {
    let source = escaped(&findings.source.name);
    let text = visible::lines(&text(findings, false, plain_verdict));
    let block: String = text.lines().map(|line| format!("    {line}\n")).collect();
    format!(
        "# Rates of {source}\n\n**{}**: {}\n\n{picture}{block}",
        findings.verdict,
        sentence(findings)
    )
}

/// A verdict without a colour.
fn plain_verdict(verdict: Verdict) -> String {
    verdict.to_string()
}
