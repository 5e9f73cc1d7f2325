//! `report`: writes the pages of a record anew; runs nothing.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::exit::{CommandOutcome, Unusable};
use super::flags::{Flags, Titles};
use super::screen;
use crate::project::Project;
use crate::report::{picture, sentence};
use crate::store::{FIGURES, Provenance, Record};
use crate::text::visible;
use crate::verify::{Reports, is_report as is_report_in, rebuild};

/// Write the report on a record anew, without running anything
///
/// The record is results.json of a report, with its pictures in figures/, or what
/// `study --format json` printed, without pictures. The exit status is that of the run.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The record
    record: PathBuf,
    #[command(flatten)]
    titles: Titles,
    #[command(flatten)]
    flags: Flags,
}

/// Writes the report to `--out`, otherwise to the record's folder if that holds a report.
///
/// # Errors
/// A record that cannot be used, and a report that cannot be written.
pub(super) fn run(
    project: &Project,
    Arguments {
        record: path,
        titles,
        flags,
    }: &Arguments,
) -> CommandOutcome {
    let mut record = Record::read(path)?;
    let beside = path.parent().unwrap_or(Path::new(""));
    let is_report = is_report_in(beside);
    let own = is_report.then(|| beside.to_owned());
    let folder = flags.out.clone().or(own).ok_or_else(|| {
        let path = visible::path(path);
        Unusable::because(&format!(
            "{path}: found outside of a report's folder; expected --out DIR for the new report"
        ))
    })?;
    let reports = Reports::around(beside, &record.scope);
    // A failing run has left the figures of the accepted one.
    let own = reports.folder(record.verdict).to_owned();
    let pictures = if is_report_in(&own) {
        own
    } else {
        beside.to_owned()
    };
    let missing = add_pictures(&mut record, &pictures, *titles)?;
    if let Some(file) = missing.first()
        && is_report_in(&folder)
    {
        let [picture, folder] =
            [&pictures.join(FIGURES).join(file), &folder].map(|p| visible::path(p));
        return Err(Unusable::because(&format!(
            "{picture}: expected this picture of the record, found none, and {folder} would lose its own; \
             --out DIR writes the report without it"
        )));
    }
    let times = reports.provenance();
    let provenance = Provenance::read(&times)?;
    let provenance = provenance.filter(|origin| is_report && origin.command == record.command);
    let verdict = record.verdict;
    let sentence = sentence(&record.studies, record.changes.as_deref());
    let folder = rebuild(
        project,
        record,
        provenance.as_ref(),
        titles.are_kept(),
        &folder,
    )?;
    missing.iter().for_each(|file| {
        screen::tell(&format!(
            "note: no picture {}/{file}",
            visible::path(&pictures.join(FIGURES))
        ));
    });
    let words = flags.words(verdict, &sentence, || {
        format!("{verdict}: {sentence}\n{}", screen::report_in(&folder))
    });
    Ok(flags.print(
        verdict,
        &json!({"report": folder, "missing": missing}),
        &words,
    )?)
}

/// Reads the pictures of all figures; a figure without one is left out and named.
fn add_pictures(
    record: &mut Record,
    beside: &Path,
    titles: Titles,
) -> Result<Vec<String>, Unusable> {
    let mut missing = vec![];
    for study in &mut record.studies {
        for figure in std::mem::take(&mut study.outcome.figures) {
            let is_name = Path::new(&figure.file)
                .file_name()
                .is_some_and(|name| *name == *figure.file);
            let path = picture(beside, &figure.file);
            match fs::read_to_string(&path) {
                Ok(svg) if is_name => {
                    study.outcome.figures.push(figure.with_svg(titles.of(svg)));
                }
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    return Err(Unusable::file(&path, &error));
                }
                _ => missing.push(visible::visible(&figure.file)),
            }
        }
    }
    Ok(missing)
}
