//! `bench`: measures times on this machine. With `--out` it writes `bench.md` there; no verdict depends on it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use convergence_study::input;
use convergence_study::project::Project;
use convergence_study::report;
use convergence_study::store::atomic;
use convergence_study::study::{Described, Table};
use thermobeam_study::kinds::work_precision::{self, WorkPrecision};
use thermobeam_study::run::step_time;
use thermobeam_study::scene::Scene;
use thermobeam_study::timing::{self, Rival};

use convergence_study::cli::exit::{Outcome, Unusable};
use convergence_study::cli::flags::Flags;
use convergence_study::cli::running::LongRun;
use convergence_study::cli::screen::{self, Format};
use convergence_study::cli::workspace;
use convergence_study::judge::verdict::Verdict;

/// Elements of the scaling table.
const ELEMENTS: [usize; 6] = [10, 100, 1_000, 10_000, 100_000, 1_000_000];

/// The scene for the comparison with a library.
const SCENE: &str = "studies/scenes/paper-1-beta-0.toml";

/// Time per step, and run time against error, on this machine
///
/// Takes minutes; prints first how long the last one took. With --out it also writes bench.md; this project's is in reports.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The scene whose steps are timed
    #[arg(long, default_value = SCENE)]
    scene: PathBuf,
    /// Output of studies/programs/cvode.cpp on this machine: shown next to the times of dG
    #[arg(long, value_name = "FILE")]
    beside: Option<PathBuf>,
    #[command(flatten)]
    flags: Flags,
}

/// Runs the command.
pub(crate) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let root = workspace::root()?;
    let path = if arguments.scene.exists() {
        arguments.scene.clone()
    } else {
        root.join(&arguments.scene)
    };
    let scene = Scene::read(&path)?;
    let rival = arguments.beside.as_deref().map(rival).transpose()?;
    let mut studies = vec![];
    for file in workspace::studies(project, &root)? {
        if file.study.header().kind == work_precision::ROW.name {
            studies.push(Described::<WorkPrecision>::read(&file.path)?);
        }
    }
    let Flags {
        quiet, format, out, ..
    } = &arguments.flags;
    let shows = !quiet && *format == Format::Text;
    let what = format!("times of steps, {} studies of accuracy", studies.len());
    let clock = LongRun::begin(&what, &root.join("reports/bench.md"), *quiet);
    let mut page = Page {
        text: heading(project, &path),
        folder: out.clone(),
        tables: vec![],
        shows,
        clock,
    };
    let paper = root.join(SCENE);
    if paper.exists() {
        let tables = timing::beside(&Scene::read(paper)?, rival.as_ref());
        for table in tables.map_err(|failure| Unusable::because(&failure.reason))? {
            page.add(table)?;
        }
    }
    for study in &studies {
        accuracy(study, &mut page)?;
    }
    page.add(step_time::ways(&scene, 100)?)?;
    page.add(step_time::ways(&scene, 1000)?)?;
    page.add(step_time::scaling(&scene, &ELEMENTS)?)?;
    let sentence = match page.folder.as_ref().map(|folder| folder.join("bench.md")) {
        Some(file) => {
            page.text += &format!("{}\n", page.clock.ended(&root));
            atomic::write(&file, &page.text)?;
            format!("written to {}", file.display())
        }
        None => "nothing is written without --out".to_owned(),
    };
    let words = arguments
        .flags
        .words(Verdict::Pass, &sentence, || sentence.clone() + "\n");
    let tables = BTreeMap::from([("tables", &page.tables)]);
    Ok(arguments.flags.print(Verdict::Pass, &tables, &words)?)
}

/// The runs of a library, from the output of its program.
fn rival(path: &Path) -> Result<Rival, Unusable> {
    let text = input::read_text(path)?;
    Rival::parse(&text).map_err(|error| {
        Unusable::because(&format!(
            "{}: {error}; expected what studies/programs/cvode.cpp prints",
            path.display()
        ))
    })
}

/// The measurements so far, as Markdown.
struct Page {
    text: String,
    /// Destination folder, if any.
    folder: Option<PathBuf>,
    tables: Vec<Table>,
    /// Whether a table is printed as soon as it is complete.
    shows: bool,
    clock: LongRun,
}

impl Page {
    /// Adds a table, and prints it.
    fn add(&mut self, table: Table) -> std::io::Result<()> {
        let head: Vec<&str> = table.head.iter().map(String::as_str).collect();
        self.text += &format!("## {}\n\n{}\n", table.title, report::markdown(&table));
        if self.shows {
            screen::print(&format!(
                "{}\n{}\n",
                table.title,
                screen::table(&head, &table.rows)
            ))?;
        }
        self.clock.done(&table.title);
        self.tables.push(table);
        Ok(())
    }

    /// Adds a figure, in a file next to the page.
    fn draw(&mut self, name: &str, caption: &str, svg: &str) -> std::io::Result<()> {
        self.text += &format!("![{caption}](bench/{name})\n\n");
        match &self.folder {
            Some(folder) => atomic::write(&folder.join("bench").join(name), svg),
            None => Ok(()),
        }
    }
}

fn heading(project: &Project, scene: &Path) -> String {
    let command = format!("{} bench --out reports", project.command);
    let name = scene
        .file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    format!(
        "# Benchmarks\n\nWritten by `{command}`; scene {name}; the machine is named at the end. Each time is the best of several runs; \
         counts are exact. Another machine gives other times: compare ratios.\n\n"
    )
}

/// Run time against error, in every quantity.
fn accuracy(
    Described {
        header,
        kind: study,
    }: &Described<WorkPrecision>,
    page: &mut Page,
) -> Result<(), Unusable> {
    let runs = timing::timed(study).map_err(|failure| Unusable::because(&failure.reason))?;
    let id = &header.id;
    for &quantity in study.quantities() {
        let table = timing::table(id, study, quantity, &runs);
        if table.rows.is_empty() {
            continue;
        }
        page.add(table)?;
        let caption = format!("{id}: error ({}) over seconds", quantity.name());
        page.draw(
            &format!("{id}-{}.svg", quantity.name()),
            &caption,
            &timing::figure(study, quantity, &runs),
        )?;
    }
    Ok(())
}
