//! `verify`: the main job.

mod text;

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::exit::{CommandOutcome, Unusable};
use super::flags::Flags;
use super::running::RunOptions;
use super::{list, study, workspace};
use crate::project::Project;
use crate::report::Findings;
use crate::run::{Effort, listed};
use crate::study::{Study, StudyFile, Tier};
use crate::verify::{Scope, VerifyRequest};

/// Run the studies in `studies/` and write `reports/`; or study files from anywhere
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Tier of studies; full includes quick
    #[arg(long, value_parser = workspace::tier_parser(), default_value = "quick")]
    tier: Tier,
    /// Accept the new numbers as baseline; refused if a study does not pass
    #[arg(long)]
    bless: bool,
    /// Accept also claims and tolerances that are looser, settings that changed, and what is gone
    #[arg(long, requires = "bless")]
    loosened: bool,
    /// Every study even if some fail, and every number that moved, not only the worst of each study
    #[arg(long, short, conflicts_with = "quiet")]
    verbose: bool,
    /// Only list what would run, as `list` does, with its cases and the seconds of its last run
    #[arg(long, short = 'n', conflicts_with_all = ["bless", "verbose", "durations", "where_lost"])]
    dry_run: bool,
    /// Begin no case once a study has failed; the report is then that of a selection
    #[arg(long, conflicts_with = "bless")]
    fail_fast: bool,
    /// List the slowest studies
    #[arg(long, conflicts_with = "quiet")]
    durations: bool,
    /// Ids or patterns of studies, whose reports go to reports/local/partial/; or study files,
    /// named with their ending .toml: they are run as `study` runs them
    #[arg(value_name = "ID|FILE")]
    ids: Vec<String>,
    #[command(flatten)]
    options: RunOptions,
}

/// Runs the studies, writes the reports, prints the table.
///
/// # Errors
/// Study files, a baseline or a selection that cannot be used, and reports that cannot be written.
pub(super) fn run(project: &Project, arguments: &Arguments) -> CommandOutcome {
    let options = &arguments.options;
    if let Some(files) = arguments.files()? {
        let options = options.clone();
        return study::run(project, &study::Arguments { files, options });
    }
    let started = Instant::now();
    let root = Project::root()?;
    let all = workspace::studies(project, &root)?;
    let scope = arguments.scope(&all);
    let files = workspace::select(project, all, arguments.tier, &arguments.ids)?;
    if arguments.dry_run {
        let out = None;
        let flags = Flags {
            out,
            ..options.flags.clone()
        };
        return list::show(&root, &files, &flags);
    }
    let studies: Vec<Box<dyn Study>> = files.into_iter().map(|file| file.study).collect();
    options.check(project, &studies)?;
    let reports = options.flags.out.clone();
    let request = VerifyRequest {
        scope,
        effort: Effort {
            fail_fast: arguments.fail_fast,
            ..options.effort()
        },
        bless: arguments.bless,
        loosened: arguments.loosened,
        reports: reports.unwrap_or_else(|| root.join("reports")),
        root,
    };
    let begun = request.begin(&studies)?;
    let allowed = |header: &_, label: &_| begun.allowed(header, label);
    let finished = options.run(&studies, request.effort, &allowed)?;
    let found = begun.write(project, finished)?;
    let findings = Findings::of(project, &found.record);
    let printed = options.print(&findings, || {
        arguments.text(&findings, &found, &request, started.elapsed())
    });
    printed.map_err(|error| found.blessing.added_to(error))?;
    Ok(found.record.verdict)
}

impl Arguments {
    /// The study files that are named in place of ids.
    ///
    /// # Errors
    /// Files beside ids, and options that are about the studies of the project.
    fn files(&self) -> Result<Option<Vec<PathBuf>>, Unusable> {
        let (files, ids): (Vec<_>, Vec<_>) = self
            .ids
            .iter()
            .partition(|id| workspace::is_toml(Path::new(id)));
        let Some(file) = files.first() else {
            return Ok(None);
        };
        let of_the_project = [
            (self.tier != Tier::Quick, "--tier"),
            (self.bless, "--bless"),
            (self.verbose, "--verbose"),
            (self.dry_run, "--dry-run"),
            (self.fail_fast, "--fail-fast"),
            (self.durations, "--durations"),
        ];
        let option = of_the_project.iter().find(|(is_given, _)| *is_given);
        let problem = match (ids.first(), option) {
            (Some(id), _) => format!(
                "expected ids of studies or study files; found the file `{file}` beside `{id}`"
            ),
            (None, Some((_, option))) => format!(
                "{option}: expected the studies of the project; found the file `{file}`, which is compared with no baseline"
            ),
            (None, None) => return Ok(Some(files.into_iter().map(PathBuf::from).collect())),
        };
        Err(Unusable::because(&problem))
    }

    /// What is run: the tier, if nothing is named.
    ///
    /// * `all`: all existing studies.
    fn scope(&self, all: &[StudyFile]) -> Scope {
        if !self.ids.is_empty() {
            return Scope::Selection(self.ids.clone());
        }
        let known = all.iter().map(|file| listed(file.study.as_ref()));
        Scope::Tier(self.tier, known.collect())
    }
}
