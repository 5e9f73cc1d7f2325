//! What `verify` prints for people.

use std::time::Duration;

use super::Arguments;
use crate::cli::screen;
use crate::report::{
    Changes, Findings, key_numbers, sentence, text_of_diagnosis, text_of_failures,
};
use crate::run::Finished;
use crate::text::number::counted;
use crate::text::visible::{self, visible};
use crate::verify::{Blessing, Verification, VerifyRequest};
use crate::where_lost;

/// Studies that `--durations` lists.
const SLOWEST: usize = 10;

/// Numbers that moved which are listed, unless all are wanted.
const LISTED: usize = 6;

impl Arguments {
    /// For a run that passes: the table of studies and the verdict. For any other: the verdict, its
    /// cause, and the clearest failures first, all visible at once.
    ///
    /// * `took`: from start to end.
    pub(super) fn text(
        &self,
        findings: &Findings<'_>,
        found: &Verification,
        request: &VerifyRequest,
        took: Duration,
    ) -> String {
        let record = findings.record;
        let studies = &record.studies;
        let moves = Changes::of(findings, self.verbose);
        let verdict = screen::verdict(record.verdict);
        let shown = if record.verdict.is_pass() {
            // Numbers that have just become the baseline are not "unchanged".
            let is_blessed = matches!(found.blessing, Blessing::Taken(_));
            let changes = record.changes.as_deref().filter(|_| !is_blessed);
            let sentence = sentence(studies, changes);
            let blessed = blessed(&found.blessing, &moves);
            vec![
                self.overview(found, request, true),
                format!("{blessed}{verdict}: {sentence}"),
            ]
        } else if let (Blessing::NotAsked, true, Some(command)) =
            (&found.blessing, moves.is_first, &moves.command)
        {
            let sentence = format!("{}; `{command}` accepts them", findings.sentence());
            vec![self.overview(found, request, true), sentence]
        } else {
            let took = match self.options.flags.quiet {
                true => String::new(),
                false => format!(" in {:.1} s", took.as_secs_f64()),
            };
            let diagnosis = record.diagnosis.as_ref();
            let clearest = diagnosis.map(|diagnosis| &*diagnosis.clearest);
            vec![
                format!("{verdict}{took}: {}", findings.sentence()),
                diagnosis.map(text_of_diagnosis).unwrap_or_default(),
                text_of_failures(studies, clearest.filter(|_| !self.verbose)),
                self.where_lost(studies),
                self.moved(&moves) + &blessed(&found.blessing, &moves),
                self.overview(found, request, self.verbose),
            ]
        };
        let shown = shown.iter().map(|part| part.trim_end());
        let shown: Vec<&str> = shown.filter(|part| !part.is_empty()).collect();
        reused(studies) + &shown.join("\n\n") + "\n"
    }

    /// Where the orders of studies are lost, if this was searched for: of several studies the parts
    /// that are named, and the conclusions; their tables if `verbose`.
    fn where_lost(&self, studies: &[Finished]) -> String {
        let searched = studies.iter();
        let searched: Vec<_> = searched
            .filter_map(|study| Some((&study.header.id, study.where_lost.as_ref()?)))
            .collect();
        let places: Vec<_> = searched.iter().map(|(_, place)| *place).collect();
        let has_tables = self.verbose || searched.len() == 1;
        let texts = searched.iter().map(|(id, place)| match has_tables {
            true => format!("{id}\n{}\n", place.text()),
            false => format!("{id}: {}\n", place.conclusion),
        });
        where_lost::summary(&places) + &texts.collect::<String>()
    }

    /// Numbers that moved, then claims that changed, under a head.
    fn moved(&self, moves: &Changes) -> String {
        let listed = if self.verbose { usize::MAX } else { LISTED };
        let more = moves.numbers.len().saturating_sub(listed);
        let mut lines = String::new();
        for change in moves.numbers.iter().take(listed) {
            lines += &format!("baseline: {}\n", visible(change));
        }
        if more > 0 {
            lines += &format!("baseline: and {more} more numbers\n");
        }
        if !moves.claims.is_empty() {
            lines += "claims changed\n";
        }
        for change in &moves.claims {
            lines += &format!("  {}\n", visible(change));
        }
        lines
    }

    /// The table of studies, or how many more fail, and where the reports are; nothing if quiet.
    fn overview(&self, found: &Verification, request: &VerifyRequest, has_table: bool) -> String {
        if self.options.flags.quiet {
            return String::new();
        }
        let record = &found.record;
        let studies = &record.studies;
        let mut text = String::new();
        if has_table {
            let rows: Vec<Vec<String>> = studies.iter().map(row).collect();
            let head = ["study", "verdict", "seconds", "key numbers"];
            text += &(screen::table_within(screen::width(), &head, &rows) + "\n");
        } else {
            let failing = studies
                .iter()
                .filter(|study| !study.outcome.verdict.is_pass());
            let shown = record
                .diagnosis
                .as_ref()
                .map_or(0, |found| found.clearest.len());
            let more = failing.count().saturating_sub(shown);
            if more > 0 {
                text += &format!("{more} more: ");
            }
            text += "--verbose lists every study and every number that changed\n";
        }
        if self.durations {
            let mut slowest: Vec<&Finished> = studies.iter().collect();
            slowest.sort_by_key(|study| std::cmp::Reverse(study.spent.busy));
            let slowest = slowest.into_iter().take(SLOWEST);
            let rows: Vec<_> = slowest
                .map(|study| vec![seconds(study), study.header.id.clone()])
                .collect();
            text += &(screen::table(&["seconds", "slowest studies"], &rows) + "\n");
        }
        // As seen from the workspace.
        let folder = found.reports.strip_prefix(&request.root);
        text += &screen::report_in(folder.unwrap_or(&found.reports));
        let what = match request.tier() {
            None => "a selection",
            Some(_) if record.verdict.is_pass() => return text,
            Some(_) => "a run that does not pass",
        };
        text + what + " leaves the committed report as it is\n"
    }
}

fn row(study: &Finished) -> Vec<String> {
    let outcome = &study.outcome;
    let verdict = outcome.verdict.to_string();
    vec![
        study.header.id.clone(),
        verdict,
        seconds(study),
        key_numbers(outcome),
    ]
}

fn seconds(study: &Finished) -> String {
    format!("{:.2}", study.spent.busy.as_secs_f64())
}

/// How many levels have the answers of an earlier run; empty if none has.
fn reused(studies: &[Finished]) -> String {
    let reusing = studies.iter().filter(|study| study.outcome.reused > 0);
    let reused = reusing.clone().map(|study| study.outcome.reused);
    let reused: usize = reused.sum();
    let cases = reusing.map(|study| study.work.len()).sum();
    match reused {
        0 => String::new(),
        _ => format!("{reused} of {} reused\n", counted(cases, "level")),
    }
}

/// What was blessed, or which command blesses.
fn blessed(blessing: &Blessing, moves: &Changes) -> String {
    match blessing {
        Blessing::Taken(loosened) => {
            let mut lines = String::new();
            for change in loosened {
                lines += &format!("loosened: {}\n", visible(&change.to_string()));
            }
            lines + "baseline: blessed, see studies/baseline.json\n"
        }
        Blessing::Refused(refusal) => {
            format!("baseline: {}\n", visible::lines(&refusal.to_string()))
        }
        Blessing::NotAsked => match &moves.command {
            Some(command) if moves.is_any => format!("if that is meant: {command}\n"),
            _ => String::new(),
        },
    }
}
