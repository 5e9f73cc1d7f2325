//! `bench`: how long things take on this machine. Written to `reports/bench.md`, which no verdict depends on.

use std::error::Error;
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use thermobeam_study::outcome::Table;
use thermobeam_study::provenance::Provenance;
use thermobeam_study::scene::Scene;
use thermobeam_study::study_file::Tier;
use thermobeam_study::{atomic, pace, runner, study};

use crate::{output, screen, workspace};

/// Elements of the scaling table.
const ELEMENTS: [usize; 6] = [10, 100, 1_000, 10_000, 100_000, 1_000_000];

/// Time per step, and run time against error, on this machine; writes reports/bench.md
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The scene that is timed
    #[arg(long, default_value = "studies/scenes/paper-1-beta-0.toml")]
    scene: std::path::PathBuf,
}

/// Runs the command.
pub(crate) fn bench(arguments: &Arguments) -> Result<ExitCode, Box<dyn Error>> {
    let root = workspace::root()?;
    let path = if arguments.scene.exists() { arguments.scene.clone() } else { root.join(&arguments.scene) };
    let scene = Scene::read(&path)?;
    let mut text = heading(&root, &path);
    let mut add = |table: Table| -> Result<(), Box<dyn Error>> {
        let section = format!("## {}\n\n{}\n", table.title, markdown(&table));
        output::print(&format!("{}\n{}\n", table.title, screen::table(&as_text(&table.head), &table.rows)))?;
        text += &section;
        Ok(())
    };
    add(pace::ways(&scene, 100)?)?;
    add(pace::ways(&scene, 1000)?)?;
    add(pace::scenes(&scene, 100)?)?;
    add(pace::scaling(&scene, &ELEMENTS)?)?;
    add(threads(&root)?)?;
    let file = root.join("reports/bench.md");
    atomic::write(&file, text)?;
    output::print(&format!("written to {}\n", file.display()))?;
    Ok(ExitCode::SUCCESS)
}

fn heading(root: &Path, scene: &Path) -> String {
    let machine = Provenance::collect(root, "cargo xtask bench".to_owned(), 1, &[]);
    let name = scene.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    format!(
        "# Benchmarks\n\nWritten by `cargo xtask bench` on {}, {} threads, {}; scene {name}. Each time is the best of nine \
         runs; counts are exact. Another machine gives other times: compare ratios.\n\n",
        machine.cpu.as_deref().unwrap_or("an unknown CPU"),
        machine.threads_available.map_or("?".to_owned(), |threads| threads.to_string()),
        machine.toolchain.as_deref().unwrap_or("an unknown toolchain"),
    )
}

/// The quick tier on one thread and on all.
fn threads(root: &Path) -> Result<Table, Box<dyn Error>> {
    let listed = workspace::studies(root)?;
    let quick = listed.iter().filter(|listed| listed.header.tier == Tier::Quick);
    let studies = quick.map(|listed| study::read(&listed.path)).collect::<Result<Vec<_>, _>>()?;
    let mut rows = vec![];
    let mut one = f64::NAN;
    for jobs in [NonZeroUsize::MIN, screen::jobs(None)] {
        let start = Instant::now();
        runner::run(&studies, jobs, &|_| ())?;
        let seconds = start.elapsed().as_secs_f64();
        if jobs == NonZeroUsize::MIN {
            one = seconds;
        }
        rows.push(vec![jobs.to_string(), format!("{seconds:.2}"), format!("{:.2}", one / seconds)]);
    }
    let head = ["threads", "seconds", "speed-up"].map(str::to_owned).to_vec();
    Ok(Table { title: "The quick tier of verify".to_owned(), head, rows })
}

fn as_text(head: &[String]) -> Vec<&str> {
    head.iter().map(String::as_str).collect()
}

fn markdown(table: &Table) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rule = format!("|{}\n", " --- |".repeat(table.head.len()));
    line(&table.head) + &rule + &table.rows.iter().map(|row| line(row)).collect::<String>()
}
