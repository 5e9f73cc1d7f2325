//! The page of the benchmark, with its figures.

use convergence_study::{Project, Table};
use thermobeam_study::error::{ErrorMeasure, Errors};
use thermobeam_study::kinds::work_precision::compared::{self, Costed, cheapest};
use thermobeam_study::kinds::work_precision::method::METHODS;

use super::{Problem, REPEATS};

/// A figure of the page.
pub(super) struct Drawing {
    /// Name of the file.
    pub(super) file: String,
    /// What it shows.
    caption: String,
    /// The picture.
    pub(super) svg: String,
}

impl Problem {
    fn costed(&self, measure: ErrorMeasure) -> Vec<Costed> {
        let costed = self.runs.iter().map(|run| Costed {
            method: run.method.to_owned(),
            resolution: run.resolution.clone(),
            error: Errors {
                norm: run.norm,
                tip: run.tip,
            }
            .of(measure),
            cost: run.seconds,
        });
        costed.collect()
    }

    /// Error over seconds, in each measure.
    pub(super) fn drawings(&self) -> Vec<Drawing> {
        let drawings = ErrorMeasure::ALL.map(|measure| {
            let title = format!("Error in {} over run time, by method", measure.in_words());
            let [seconds, error] = ["run time (CPU seconds)", "largest error (dimensionless)"];
            let runs = self.costed(measure);
            Drawing {
                file: format!("{}-{}-seconds.svg", self.study, measure.name()),
                caption: format!(
                    "{}: error in {} over CPU seconds; for each method the runs that no other run of it beats",
                    self.in_words,
                    measure.in_words()
                ),
                svg: compared::figure(&title, seconds, error, &runs),
            }
        });
        drawings.into()
    }

    /// The seconds that each method needs for the errors of the study.
    fn table(&self) -> Table {
        let rows = self.targets.iter().map(|target| {
            let runs = self.costed(target.measure);
            let seconds = METHODS.map(|method| match cheapest(&runs, method.name, target.error) {
                Some(run) => seconds_text(run.cost),
                None => "-".to_owned(),
            });
            let name = format!("{}, {:e}", target.measure.in_words(), target.error);
            [name].into_iter().chain(seconds).collect()
        });
        let rows: Vec<Vec<String>> = rows.collect();
        let title = format!("CPU seconds for an error, {}", self.in_words);
        let head = ["error in"]
            .into_iter()
            .chain(METHODS.map(|method| method.in_words));
        Table::new(title, head, rows)
    }
}

/// Two significant digits, without an exponent where that is readable.
fn seconds_text(seconds: f64) -> String {
    let digits = (1.0 - seconds.log10().floor()).max(0.0) as usize;
    if seconds < 9.5e-4 {
        format!("{seconds:.1e}")
    } else {
        format!("{seconds:.digits$}")
    }
}

/// The page without its last line, which says where it was made.
pub(super) fn page(project: &Project, problems: &[Problem], steps: &[Table]) -> String {
    let mut text = format!(
        "# Benchmarks\n\nWritten by `{} bench --out reports`; the machine is named at the end. The runs are those that the studies \
         `work-precision-*` list for these errors: no run an eighth coarser in h or dt reaches them for less counted work, which the studies \
         check. A time is that of the fastest of {REPEATS} runs, the loads of the manufactured solution included. **A dash: no listed run \
         reaches it.** Another machine gives other times: compare ratios.\n\n",
        project.command
    );
    for problem in problems {
        text += &section(&problem.table());
        for Drawing { file, caption, .. } in problem.drawings() {
            text += &format!("![{caption}](bench/{file})\n\n");
        }
    }
    text + &steps.iter().map(section).collect::<String>()
}

fn section(table: &Table) -> String {
    format!("## {}\n\n{}\n", table.title, table.markdown())
}
