//! `bench`: how long things take on this machine. With `--out` written to `bench.md` there, which no verdict depends on.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use convergence_study::project::Project;
use convergence_study::store::atomic;
use convergence_study::store::provenance;
use convergence_study::study::{FromFile, Kind, Study, StudyFile, Table, Tier};
use convergence_study::{report, run as runner};
use thermobeam_study::error::evaluator::ErrorMeasure;
use thermobeam_study::kinds::work_precision::{self, WorkPrecision};
use thermobeam_study::run::{any_order_time, step_time};
use thermobeam_study::scene::Scene;

use convergence_study::cli::exit::{Ended, Outcome, Unusable};
use convergence_study::cli::flags::Flags;
use convergence_study::cli::long::LongRun;
use convergence_study::cli::output::Format;
use convergence_study::cli::{output, screen, selection, workspace};
use convergence_study::judge::verdict::Verdict;

/// Elements of the scaling table.
const ELEMENTS: [usize; 6] = [10, 100, 1_000, 10_000, 100_000, 1_000_000];

/// Where the runs of any order end: three contact events of the paper's first experiment.
const ANY_ORDER_END: f64 = 1.0;

/// Studies in the table of the costliest.
const COSTLIEST: usize = 12;

/// Time per step, and run time against error, on this machine
///
/// Takes minutes; says at the beginning how many the last one took. With --out it is also written as bench.md; the one of this
/// project is in reports.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The scene that is timed
    #[arg(long, default_value = "studies/scenes/paper-1-beta-0.toml")]
    scene: PathBuf,
    /// The tier of `verify` that is timed on one thread and on all
    #[arg(long, value_parser = selection::tier_parser(), default_value = Tier::Quick.name())]
    tier: Tier,
    #[command(flatten)]
    flags: Flags,
}

/// What `bench --format json` prints beside the verdict.
#[derive(serde::Serialize)]
struct Object<'a> {
    tables: &'a [Table],
}

/// Runs the command.
pub(crate) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let root = workspace::root()?;
    let path = if arguments.scene.exists() { arguments.scene.clone() } else { root.join(&arguments.scene) };
    let scene = Scene::read(&path)?;
    let studies = workspace::studies(project, &root)?;
    let Flags { quiet, format, out, jobs } = &arguments.flags;
    let shows = !quiet && *format == Format::Text;
    let accuracies = studies.iter().filter(|file| file.study.header().kind == work_precision::ROW.name).count();
    let what = format!("{accuracies} studies of accuracy, the tier {} on one thread and on all", arguments.tier.name());
    let clock = LongRun::begin(&format!("times of steps, {what}"), &root.join("reports/bench.md"), *quiet);
    let mut page = Page { text: heading(project, &path), folder: out.clone(), tables: vec![], shows, clock };
    page.add(step_time::ways(&scene, 100)?)?;
    page.add(step_time::ways(&scene, 1000)?)?;
    page.add(step_time::scenes(&scene, 100)?)?;
    page.add(step_time::scaling(&scene, &ELEMENTS)?)?;
    page.remark(step_time::SCALING)?;
    let any_order = any_order_time::times(&scene, scene.t_end.min(ANY_ORDER_END));
    page.add(any_order.map_err(|failure| Unusable::because(&failure.reason))?)?;
    for file in studies.iter().filter(|file| file.study.header().kind == work_precision::ROW.name) {
        accuracy(&WorkPrecision::read(&file.path)?, &mut page)?;
    }
    threads(studies, arguments.tier, screen::jobs(*jobs), &mut page)?;
    let sentence = match page.folder.as_ref().map(|folder| folder.join("bench.md")) {
        Some(file) => {
            page.text += &format!("{}\n", page.clock.ended(&root));
            atomic::write(&file, &page.text)?;
            format!("written to {}", file.display())
        }
        None => "nothing is written without --out".to_owned(),
    };
    let words = arguments.flags.words(Verdict::Pass, &sentence, || sentence.clone() + "\n");
    arguments.flags.print(Verdict::Pass, &Object { tables: &page.tables }, &words)?;
    Ok(Ended::Well)
}

/// What has been measured so far, as Markdown.
struct Page {
    text: String,
    /// Where it is written, if anywhere.
    folder: Option<PathBuf>,
    tables: Vec<Table>,
    /// Whether a table is shown as soon as it is there.
    shows: bool,
    clock: LongRun,
}

impl Page {
    /// Adds a table, and shows it.
    fn add(&mut self, table: Table) -> std::io::Result<()> {
        let head: Vec<&str> = table.head.iter().map(String::as_str).collect();
        self.text += &format!("## {}\n\n{}\n", table.title, report::markdown(&table));
        if self.shows {
            output::print(&format!("{}\n{}\n", table.title, screen::table(&head, &table.rows)))?;
        }
        self.clock.done(&table.title);
        self.tables.push(table);
        Ok(())
    }

    /// Adds a paragraph, and shows it.
    fn remark(&mut self, text: &str) -> std::io::Result<()> {
        self.text += &format!("{text}\n\n");
        if self.shows { output::print(&format!("{text}\n\n")) } else { Ok(()) }
    }

    /// Adds a figure, in a file beside the page.
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
    let name = scene.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    format!(
        "# Benchmarks\n\nWritten by `{command}`; scene {name}; the machine is named at the end. Each time is the best of several runs; \
         counts are exact. Another machine gives other times: compare ratios.\n\n"
    )
}

/// Run time against error, in every quantity.
fn accuracy(study: &WorkPrecision, page: &mut Page) -> Result<(), Unusable> {
    let runs = study.timed().map_err(|failure| Unusable::because(&failure.reason))?;
    let id = &study.header().id;
    for quantity in ErrorMeasure::ALL {
        let table = study.seconds(quantity, &runs);
        if table.rows.is_empty() {
            continue;
        }
        page.add(table)?;
        let caption = format!("{id}: error ({}) over seconds", quantity.name());
        page.draw(&format!("{id}-{}.svg", quantity.name()), &caption, &study.seconds_figure(quantity, &runs))?;
    }
    Ok(())
}

/// A tier on one thread and on `all`, and what its studies cost on one.
fn threads(files: Vec<StudyFile>, tier: Tier, all: NonZeroUsize, page: &mut Page) -> Result<(), Unusable> {
    let studies: Vec<_> =
        files.into_iter().map(|file| file.study).filter(|study| study.header().tier <= tier).collect();
    let (mut rows, mut one) = (vec![], f64::NAN);
    // Seconds of each study, and its place among them.
    let mut costs: Vec<(f64, usize)> = vec![];
    for jobs in [NonZeroUsize::MIN, all] {
        let start = Instant::now();
        let finished = runner::run(&studies, jobs, &|_| ())?;
        let seconds = start.elapsed().as_secs_f64();
        if jobs == NonZeroUsize::MIN {
            one = seconds;
            costs = finished.iter().map(|study| study.spent.busy.as_secs_f64()).zip(0..).collect();
        }
        rows.push(vec![jobs.to_string(), format!("{seconds:.2}"), format!("{:.2}", one / seconds)]);
    }
    let table = |title: String, head: [&str; 3], rows| Table { title, head: head.map(str::to_owned).to_vec(), rows };
    page.add(table(format!("The {} tier of verify", tier.name()), ["threads", "seconds", "speed-up"], rows))?;
    costs.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut rows = vec![];
    for &(seconds, place) in costs.iter().take(COSTLIEST) {
        let study = &studies[place..=place];
        let megabytes = memory(study)?.map_or("?".to_owned(), |bytes| format!("{:.0}", bytes as f64 / 1e6));
        let share = format!("{:.0} %", 100.0 * seconds / one);
        rows.push(vec![study[0].header().id.clone(), format!("{seconds:.2}"), share, megabytes]);
    }
    let head = ["study", "seconds", "share", "peak memory of the process (MB)"].map(str::to_owned).to_vec();
    page.add(Table { title: "Its costliest studies, on one thread".to_owned(), head, rows })?;
    Ok(())
}

/// The most memory that the process uses during one study on one thread, in bytes; `None` where that is not known.
fn memory(study: &[Box<dyn Study>]) -> Result<Option<u64>, Unusable> {
    let known = provenance::forget_peak_memory();
    runner::run(study, NonZeroUsize::MIN, &|_| ())?;
    Ok(provenance::peak_memory().filter(|_| known))
}
