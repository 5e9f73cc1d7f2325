//! What the templates see of a run, as JSON: its record in words and tables.

use serde_json::{Value, json};

use super::Findings;
use super::changes::Changes;
use super::tables::{rate_row, tables};
use super::words::{key_numbers, summary};
use crate::project::{Front, Statement};
use crate::run::{Finished, advice, items_not_passed, not_passed};
use crate::study::Tier;
use crate::study::outcome::{Figure, Table};
use crate::text::columns::Columns;
use crate::text::lists::distinct;
use crate::text::number::RATE_PLACES;

/// Most figures of a study that are committed; the others are on the page.
const COMMITTED: usize = 3;

impl Findings<'_> {
    /// * `rates`: the picture of the rates nearest to a failure.
    pub(super) fn context(&self, rates: Option<&Figure>) -> Value {
        let record = self.record;
        let studies = self.in_order().into_iter();
        let studies = studies.map(|(label, study)| self.study(label, study));
        let diagnosis = record.diagnosis.as_ref();
        json!({
            "verdict": record.verdict,
            "scope": record.scope,
            "command": record.command,
            "program": self.project.command,
            "sentence": self.sentence(),
            "has_baseline": record.changes.is_some(),
            "see_also": self.see_also,
            "is_rest": self.is_rest(),
            "origin": self.provenance.map(|origin| origin.sentences()),
            "diagnosis": diagnosis.map_or(vec![], |found| found.lines()),
            "moves": Changes::of(self, false),
            "front": self.front(),
            "rates": rates.map(|figure| picture(figure, "")),
            "studies": studies.collect::<Value>(),
        })
    }

    /// Whether the report next to it lists the studies of the quick tier.
    fn is_rest(&self) -> bool {
        self.record.scope == Tier::Full.name() && self.see_also.is_some()
    }

    /// Whether the report lists a study, which the page always does.
    fn lists(&self, study: &Finished) -> bool {
        !self.is_rest() || study.header.tier == Tier::Full || !study.outcome.verdict.is_pass()
    }

    /// The studies that do not pass, the clearest first; then the others by the property they
    /// claim, in the project's order of groups. Each has the label of its group.
    fn in_order(&self) -> Vec<(&str, &Finished)> {
        let studies = &self.record.studies;
        let diagnosis = self.record.diagnosis.as_ref();
        let clearest = diagnosis.map_or(&[][..], |found| &found.clearest);
        let mut failing = not_passed(studies);
        failing.sort_by_key(|study| {
            let place = clearest.iter().position(|clear| *clear == study.header.id);
            place.unwrap_or(usize::MAX)
        });
        let failing = failing.into_iter().map(|study| ("did not pass", study));
        let passing = studies
            .iter()
            .filter(|study| study.outcome.verdict.is_pass());
        let mut passing: Vec<(&str, &Finished)> =
            passing.map(|study| (&*study.header.group, study)).collect();
        let known = self.project.groups.iter().copied();
        let groups = distinct(known.chain(passing.iter().map(|(group, _)| *group)));
        passing.sort_by_key(|(group, _)| groups.iter().position(|known| known == group));
        failing.chain(passing).collect()
    }

    fn study(&self, label: &str, finished: &Finished) -> Value {
        let Finished {
            header, outcome, ..
        } = finished;
        let items = items_not_passed(finished).into_iter();
        let where_lost = finished.where_lost.as_ref();
        let figures = outcome.figures.iter();
        let figures = figures.map(|figure| picture(figure, &header.id));
        json!({
            "id": header.id,
            "claim": header.claim,
            "tier": header.tier,
            "kind": header.kind,
            "label": label,
            "is_listed": self.lists(finished),
            "verdict": outcome.verdict,
            "summary": summary(outcome),
            "key_numbers": key_numbers(outcome),
            "not_passed": items.map(|item| item.line).collect::<Value>(),
            "lost": where_lost.map(|where_lost| &where_lost.conclusion),
            "advice": advice(finished),
            "rates": outcome.rates.iter().map(rate_row).collect::<Value>(),
            "tables": tables(finished).iter().map(table).collect::<Value>(),
            "figures": figures.collect::<Value>(),
            "committed": self.committed(finished),
        })
    }

    /// How many figures of a study are committed: of one that passes not its only one if an earlier
    /// study has one with the same caption.
    fn committed(&self, finished: &Finished) -> usize {
        let same = |only: &Figure| self.figures().find(|figure| figure.caption == only.caption);
        match &finished.outcome.figures[..] {
            _ if !self.lists(finished) => 0,
            all if !finished.outcome.verdict.is_pass() => all.len(),
            [only] if same(only).is_some_and(|first| first.file != only.file) => 0,
            all => all.len().min(COMMITTED),
        }
    }

    /// What is verified, by a run that passes; null if it has none of the studies.
    fn front(&self) -> Value {
        let Front {
            subject,
            picture: file,
            finding,
            statements,
            plot,
            verified,
        } = self.project.front;
        let mut answered = vec![];
        for Statement { text, study, rate } in statements {
            let mut all = self.record.studies.iter();
            let found = all.find(|known| known.header.id == *study);
            if let Some(found) = found.filter(|study| self.lists(study)) {
                // The rate of this name, or the study's key numbers.
                let rate = found.outcome.rate(rate);
                let answer = rate.map_or_else(
                    || key_numbers(&found.outcome),
                    |rate| format!("rate {}", rate.against(RATE_PLACES)),
                );
                answered.push(json!({"text": text, "answer": answer, "study": study}));
            }
        }
        if !self.record.verdict.is_pass() || answered.is_empty() {
            return Value::Null;
        }
        json!({
            "subject": subject,
            "picture": self.picture(file, subject),
            "finding": finding,
            "statements": answered,
            "plot": self.picture(plot, ""),
            "verified": verified,
        })
    }

    /// The figure of that file, if a study drew it; with its own caption, if none is given.
    fn picture(&self, file: &str, caption: &str) -> Option<Value> {
        let mut all = self.figures();
        let figure = all.find(|figure| figure.file == file)?;
        let mut found = picture(figure, "");
        if !caption.is_empty() {
            found["caption"] = caption.into();
        }
        Some(found)
    }
}

/// A figure; its name is that of its file without the id of its study and without its ending.
fn picture(figure: &Figure, id: &str) -> Value {
    let Figure { file, caption, .. } = figure;
    let name = file.strip_suffix(".svg").unwrap_or(file);
    let own = name
        .strip_prefix(id)
        .and_then(|name| name.strip_prefix('-'));
    json!({"file": file, "name": own.unwrap_or(name), "caption": caption, "svg": figure.svg()})
}

fn table(Table { title, head, rows }: &Table) -> Value {
    let columns = Columns::of(head, rows);
    let is_numeric: Vec<bool> = (0..head.len()).map(|k| columns.is_numeric(k)).collect();
    json!({"title": title, "head": head, "is_numeric": is_numeric, "rows": rows})
}
