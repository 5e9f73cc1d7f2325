//! What the templates see of a run: its record, with the numbers as they are read.

use serde::Serialize;

use super::tables::{rate_row, tables};
use super::words::{blessing, can_be_blessed, key_numbers, summary};
use super::{Findings, SeeAlso};
use crate::judge::verdict::Verdict;
use crate::project::{Front, Statement};
use crate::run::{Finished, Item, NotPassed, not_passed};
use crate::store::{GuardedChange, Movement, without_baseline};
use crate::study::Tier;
use crate::study::outcome::{Figure, Table};
use crate::text::columns::Columns;
use crate::text::lists;
use crate::text::number::{RATE_PLACES, short_text};

/// Most figures of a study that are committed; the others are on the page.
const COMMITTED: usize = 3;

/// What the templates of the report see.
#[derive(Serialize)]
pub(super) struct Context<'f> {
    verdict: Verdict,
    sentence: String,
    scope: &'f str,
    command: &'f str,
    has_baseline: bool,
    see_also: Option<SeeAlso>,
    /// Whether the report next to it lists the studies of the quick tier.
    is_rest: bool,
    /// Where the run comes from.
    origin: Vec<String>,
    diagnosis: Vec<(&'static str, String)>,
    changes: Changes<'f>,
    front: Option<FrontView<'f>>,
    /// The picture of the rates nearest to a failure.
    rates: Option<Picture<'f>>,
    has_rates: bool,
    /// The studies that do not pass are the first group.
    groups: Vec<Group<'f>>,
    studies: usize,
    passing: usize,
}

#[derive(Serialize)]
struct Group<'f> {
    label: &'f str,
    passes: bool,
    studies: Vec<StudyView<'f>>,
}

#[derive(Serialize)]
struct StudyView<'f> {
    id: &'f str,
    claim: &'f str,
    tier: Tier,
    kind: &'f str,
    verdict: Verdict,
    summary: String,
    key_numbers: String,
    /// Runs it again.
    command: String,
    /// Whether the Markdown lists it.
    is_listed: bool,
    not_passed: Vec<String>,
    /// Where its order is lost.
    lost: Option<&'f str>,
    advice: Vec<String>,
    rates: Vec<Vec<String>>,
    tables: Vec<TableView>,
    figures: Vec<Picture<'f>>,
    /// How many of the figures are committed.
    committed: usize,
}

#[derive(Serialize)]
struct TableView {
    title: String,
    columns: Vec<Column>,
    rows: Vec<Vec<String>>,
}

#[derive(Serialize)]
struct Column {
    head: String,
    is_numeric: bool,
}

#[derive(Serialize)]
struct Picture<'f> {
    file: &'f str,
    /// The file without the id of its study and without its ending.
    name: &'f str,
    caption: &'f str,
    svg: &'f str,
}

/// What is verified, by a run that passes.
#[derive(Serialize)]
struct FrontView<'f> {
    subject: &'f str,
    picture: Option<Picture<'f>>,
    finding: &'f str,
    statements: Vec<StatementView<'f>>,
    plot: Option<Picture<'f>>,
    verified: &'f str,
}

#[derive(Serialize)]
struct StatementView<'f> {
    text: &'f str,
    /// The numbers of the study that answer it.
    answer: String,
    study: &'f str,
}

/// What differs from the baseline, and how to accept it.
#[derive(Serialize, Default)]
struct Changes<'f> {
    claims: Vec<Change<'f>>,
    /// Numbers of studies that pass, the worst of each.
    worst: Vec<Worst<'f>>,
    numbers: Option<TableView>,
    /// The command that accepts all of it, if it would be accepted.
    command: String,
    refused: bool,
    /// Whether there was no baseline.
    is_first: bool,
}

#[derive(Serialize)]
struct Change<'f> {
    study: &'f str,
    name: &'f str,
    movement: String,
}

#[derive(Serialize)]
struct Worst<'f> {
    study: &'f str,
    count: usize,
    name: &'f str,
    movement: String,
    /// By how many times its tolerance it moved.
    times: String,
}

impl<'f> Context<'f> {
    /// * `rates`: the picture of the rates nearest to a failure.
    pub(super) fn of(findings: &Findings<'f>, rates: Option<&'f Figure>) -> Self {
        let record = findings.record;
        let studies = &record.studies;
        let is_rest = record.scope == Tier::Full.name() && findings.see_also.is_some();
        let groups = groups(findings, is_rest);
        let passing = studies
            .iter()
            .filter(|study| study.outcome.verdict.is_pass());
        let listed = |id: &str| {
            let mut all = groups.iter().flat_map(|group| &group.studies);
            all.any(|study| study.id == id && study.is_listed)
        };
        Self {
            verdict: record.verdict,
            sentence: findings.sentence(),
            scope: &record.scope,
            command: &record.command,
            has_baseline: record.changes.is_some(),
            see_also: findings.see_also,
            is_rest,
            origin: findings
                .provenance
                .map_or(vec![], |provenance| provenance.sentences()),
            diagnosis: record
                .diagnosis
                .as_ref()
                .map_or(vec![], |diagnosis| diagnosis.lines()),
            changes: Changes::of(findings),
            front: FrontView::of(findings, is_rest, &listed),
            rates: rates.map(|figure| picture(figure, "")),
            has_rates: studies.iter().any(|study| !study.outcome.rates.is_empty()),
            studies: studies.len(),
            passing: passing.count(),
            groups,
        }
    }
}

/// The studies that do not pass, the clearest first; then the others by the property they claim, in
/// the project's order of groups.
fn groups<'f>(findings: &Findings<'f>, is_rest: bool) -> Vec<Group<'f>> {
    let Findings {
        project, record, ..
    } = *findings;
    let mut captions = vec![];
    let mut views: Vec<StudyView<'f>> = record
        .studies
        .iter()
        .map(|study| view(findings, study, is_rest, &mut captions))
        .collect();
    let mut take = |id: &str| {
        let place = views.iter().position(|view| view.id == id);
        views.remove(place.expect("each study has a view"))
    };
    let clearest = record
        .diagnosis
        .as_ref()
        .map_or(&[][..], |found| &found.clearest);
    let mut failing: Vec<&str> = not_passed(&record.studies)
        .iter()
        .map(NotPassed::id)
        .collect();
    failing.sort_by_key(|id| {
        let place = clearest.iter().position(|clear| clear == id);
        place.unwrap_or(usize::MAX)
    });
    let mut groups = vec![Group {
        label: "did not pass",
        passes: false,
        studies: failing.into_iter().map(&mut take).collect(),
    }];
    let passing = record
        .studies
        .iter()
        .filter(|study| study.outcome.verdict.is_pass());
    let mut labelled = lists::grouped(
        passing.map(|study| (study.header.group.as_str(), study.header.id.as_str())),
    );
    labelled.sort_by_key(|(label, _)| {
        let place = project.groups.iter().position(|known| known == label);
        place.unwrap_or(usize::MAX)
    });
    groups.extend(labelled.into_iter().map(|(label, ids)| Group {
        label,
        passes: true,
        studies: ids.into_iter().map(&mut take).collect(),
    }));
    groups.retain(|group| !group.studies.is_empty());
    groups
}

/// * `captions`: of the figures so far. If the only figure of a study that passes has such a
///   caption, it is not committed.
fn view<'f>(
    findings: &Findings<'f>,
    finished: &'f Finished,
    is_rest: bool,
    captions: &mut Vec<&'f str>,
) -> StudyView<'f> {
    let Finished {
        header, outcome, ..
    } = finished;
    let failing = NotPassed::of(finished);
    let is_listed = !is_rest || header.tier == Tier::Full || failing.is_some();
    let committed = match &outcome.figures[..] {
        _ if !is_listed => 0,
        all if failing.is_some() => all.len(),
        [only] if captions.contains(&only.caption.as_str()) => 0,
        all => all.len().min(COMMITTED),
    };
    captions.extend(outcome.figures.iter().map(|figure| figure.caption.as_str()));
    StudyView {
        id: &header.id,
        claim: &header.claim,
        tier: header.tier,
        kind: &header.kind,
        verdict: outcome.verdict,
        summary: summary(outcome),
        key_numbers: key_numbers(outcome),
        command: findings.command_for(finished),
        is_listed,
        not_passed: failing.as_ref().map_or(vec![], |failing| {
            failing.items.iter().map(Item::to_string).collect()
        }),
        lost: finished
            .located
            .as_ref()
            .map(|located| located.conclusion.as_str()),
        advice: failing.map_or(vec![], |failing| failing.advice()),
        rates: outcome.rates.iter().map(rate_row).collect(),
        tables: tables(finished).into_iter().map(TableView::of).collect(),
        figures: outcome
            .figures
            .iter()
            .map(|figure| picture(figure, &header.id))
            .collect(),
        committed,
    }
}

fn picture<'f>(figure: &'f Figure, id: &str) -> Picture<'f> {
    let name = figure.file.strip_suffix(".svg").unwrap_or(&figure.file);
    let own = name
        .strip_prefix(id)
        .and_then(|name| name.strip_prefix('-'));
    Picture {
        file: &figure.file,
        name: own.unwrap_or(name),
        caption: &figure.caption,
        svg: &figure.svg,
    }
}

impl TableView {
    fn of(Table { title, head, rows }: Table) -> Self {
        let columns = Columns::of(&head, &rows);
        let column = |(k, head)| Column {
            head,
            is_numeric: columns.is_numeric(k),
        };
        Self {
            title,
            columns: head.into_iter().enumerate().map(column).collect(),
            rows,
        }
    }
}

impl<'f> FrontView<'f> {
    /// `None` if the run does not pass, or has none of the studies.
    ///
    /// * `is_rest`: whether the report next to it has all but the statements.
    fn of(
        findings: &Findings<'f>,
        is_rest: bool,
        is_listed: &dyn Fn(&str) -> bool,
    ) -> Option<Self> {
        let record = findings.record;
        let Front {
            subject,
            picture: file,
            finding,
            statements,
            plot,
            verified,
        } = findings.project.front;
        let mut answered = vec![];
        for Statement { text, study, rate } in statements {
            let found = record
                .studies
                .iter()
                .find(|known| known.header.id == *study);
            if let Some(found) = found.filter(|_| is_listed(study)) {
                let answer = answer(found, rate);
                answered.push(StatementView {
                    text,
                    answer,
                    study,
                });
            }
        }
        if !record.verdict.is_pass() || answered.is_empty() {
            return None;
        }
        let figure = |file: &str| {
            let mut all = record
                .studies
                .iter()
                .flat_map(|study| &study.outcome.figures);
            all.find(|figure| figure.file == file && !is_rest)
        };
        let only_here = |text: &'static str| if is_rest { "" } else { text };
        Some(Self {
            subject,
            picture: figure(file).map(|figure| Picture {
                caption: subject,
                ..picture(figure, "")
            }),
            finding: only_here(finding),
            statements: answered,
            plot: figure(plot).map(|figure| picture(figure, "")),
            verified: only_here(verified),
        })
    }
}

/// The numbers of a study that answer a statement: the rate of this name, or its key numbers.
fn answer(study: &Finished, name: &str) -> String {
    let rate = study.outcome.rate(name);
    let rate = rate.map(|rate| format!("rate {}", rate.against(RATE_PLACES)));
    rate.unwrap_or_else(|| key_numbers(&study.outcome))
}

impl<'f> Changes<'f> {
    fn of(findings: &Findings<'f>) -> Self {
        let record = findings.record;
        let moves = record.moves();
        if moves.is_empty() {
            return Self::default();
        }
        let refused = !can_be_blessed(&record.studies);
        let command = if refused {
            String::new()
        } else {
            blessing(findings.project, &record.command, &record.studies, moves)
        };
        let acceptance = Self {
            command,
            refused,
            ..Self::default()
        };
        if without_baseline(&record.studies, moves).is_some() {
            return Self {
                is_first: true,
                ..acceptance
            };
        }
        // Numbers of studies that fail move for the same cause.
        let passes = |id: &str| {
            let mut all = record.studies.iter();
            !all.any(|study| study.header.id == id && !study.outcome.verdict.is_pass())
        };
        let (claims, numbers): (Vec<_>, Vec<_>) = moves
            .iter()
            .filter(|change| change.movement.is_of_claims() || passes(&change.study))
            .partition(|change| change.movement.is_of_claims());
        let rows = numbers.iter().map(|change| {
            let movement = change.movement.to_string();
            vec![change.study.clone(), change.name.clone(), movement]
        });
        let all = Table::new("All numbers", ["study", "number", "change"], rows);
        Self {
            claims: claims.into_iter().map(Change::of).collect(),
            worst: worst_of_each(&numbers),
            numbers: (!all.rows.is_empty()).then(|| TableView::of(all)),
            ..acceptance
        }
    }
}

impl<'f> Change<'f> {
    fn of(change: &'f GuardedChange) -> Self {
        Self {
            study: &change.study,
            name: &change.name,
            movement: change.movement.to_string(),
        }
    }
}

/// The worst number of each study, the farthest first.
fn worst_of_each<'f>(numbers: &[&'f GuardedChange]) -> Vec<Worst<'f>> {
    let mut studies: Vec<(&GuardedChange, usize)> = numbers
        .chunk_by(|one, next| one.study == next.study)
        .filter_map(|of_study| {
            // Of equals the first.
            let all = of_study.iter().rev().copied();
            let worst = all.max_by(|a, b| weight(a).total_cmp(&weight(b)))?;
            Some((worst, of_study.len()))
        })
        .collect();
    studies.sort_by(|(a, _), (b, _)| weight(b).total_cmp(&weight(a)));
    let row = |(change, count): (&'f GuardedChange, usize)| Worst {
        study: &change.study,
        count,
        name: &change.name,
        movement: change.movement.to_string(),
        times: times(&change.movement),
    };
    studies.into_iter().map(row).collect()
}

fn weight(change: &GuardedChange) -> f64 {
    change.movement.weight()
}

/// By how many times its tolerance a number has moved, with two digits; a dash if that is
/// undefined.
fn times(movement: &Movement) -> String {
    let weight = movement.weight();
    if weight == 0.0 || !weight.is_finite() {
        return "-".to_owned();
    }
    short_text(weight)
}
