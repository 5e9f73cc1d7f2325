//! `rates FILE...`: errors of any code, judged by the rule of the studies.

use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

use clap::Args;

use super::exit::{CommandOutcome, Unusable};
use super::flags::{Flags, Titles, number};
use super::github;
use super::screen::{self, Format};
use crate::project::Project;
use crate::rates::{
    self, Choice, Claimed, Judgement, LineRange, NotJudged, Request, Tables, figure, markdown,
    verdict_in_markdown,
};
use crate::report::{Suite, junit_of};
use crate::run::Item;
use crate::store::atomic;
use crate::text::visible;
use convergence_judge::verdict::{Of, Verdict};

/// The file below --out with tables, figures and verdicts.
const PAGE: &str = "rates.md";
/// How it begins.
const HEADING: &str = "# Rates of ";

/// The file with the verdicts for continuous integration.
const JUNIT: &str = "junit.xml";

/// Judge tables of step sizes and errors made elsewhere
///
/// The input may be tables, logs, lists or JSON. Every number is a step, an error that is judged,
/// or was set aside, by arithmetic that can be checked: the first line says each, with the reason.
/// Several tables of one file are judged each under its heading, and the worst verdict decides.
/// Exit status 0 if every rate with a claim agrees with its order, 1 if one does not, the data
/// cannot tell, nothing is claimed in a table or a table cannot be read beside others, 2 if no
/// table can be read, or only by another command, which the message has.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The tables; `-` is standard input, which is read without a file, too
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The order that theory claims, for all columns or as NAME=P for one, '>=P' for the least,
    /// '>=P..' if any higher rate will do; may be repeated. Without one nothing passes
    ///
    /// P may be p, p+1, p-1 for the degree p of each table, in a column p or in the heading, as in
    /// 'Degree = 2'. TABLE:NAME=P is about one table, by its heading or as 'Table 2'.
    #[arg(long, value_name = "[NAME=]P", allow_negative_numbers = true)]
    order: Vec<Claimed>,
    /// The factor by which errors fall for each unit of a count or a degree, where convergence is
    /// exponential, in place of an order: F, '>=F', NAME=F; may be repeated
    #[arg(long, value_name = "[NAME=]F", conflicts_with_all = ["order", "values", "dim", "ratio"])]
    factor: Vec<Claimed>,
    /// How far the rate may be from the order, above or below: 0 < T < 0.5, and less than the
    /// order. Without it 0.25, but at most half of the order, and a quarter of the least one
    #[arg(long, value_name = "T", value_parser = number, allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Round-off, in the unit of the errors: the finest levels are dropped as long as their errors
    /// are not above E; 0 drops none. If you know the round-off, give a thousand times as much
    ///
    /// A level above the floor is kept, and so are all levels coarser than it. Where a floor would
    /// make it pass, and the finest errors are near the round-off of the solution, it is offered.
    #[arg(
        long,
        value_name = "E",
        default_value_t = 0.0,
        value_parser = number,
        allow_negative_numbers = true
    )]
    floor: f64,
    /// The size of the solution, which says what round-off is; 1 without it
    #[arg(long, value_name = "S", value_parser = number, allow_negative_numbers = true)]
    scale: Option<f64>,
    /// The relative round-off of numbers, as 1.2e-7 of single precision; that of double precision
    /// without it
    #[arg(long, value_name = "EPS", value_parser = number, allow_negative_numbers = true)]
    eps: Option<f64>,
    /// The column of the step, of a count or of levels: its name, or its number from 1
    #[arg(long, value_name = "COLUMN")]
    step: Option<String>,
    /// The columns of errors, by name or number, separated by commas; without it all that
    /// are nothing else
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    columns: Option<Vec<String>>,
    /// Columns of values, which tend to an unknown limit: their differences are judged
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    values: Vec<String>,
    /// Names for all columns, instead of those in the table
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    names: Option<Vec<String>>,
    /// The column of the step counts cells, unknowns or steps in D dimensions: h = count^(-1/D)
    #[arg(long, value_name = "D", value_parser = above(0.0), allow_negative_numbers = true)]
    dim: Option<f64>,
    /// The column of the step numbers the levels of refinement, each with a step R times as small:
    /// h = R^(-level)
    #[arg(long, value_name = "R", value_parser = above(1.0), conflicts_with = "dim", allow_negative_numbers = true)]
    ratio: Option<f64>,
    /// Rows with equal steps are samples, at least ten of each step: their scatter says how well
    /// the level is known. A column `seed`, `sample` or `run` says which belong together
    #[arg(long, conflicts_with_all = ["values", "ratio", "factor", "floor"])]
    samples: bool,
    /// What samples make an error: `mean`, `rms` (root mean square), or `weak`, the size of the
    /// mean of signed numbers
    #[arg(long, value_name = "OF", requires = "samples", default_value_t)]
    of: Of,
    /// The lines where a table is, from 1; may be repeated. Others are no doubt, unless they tell
    /// of a failure or are the next row
    #[arg(long, value_name = "A-B", value_delimiter = ',')]
    lines: Vec<LineRange>,
    /// Columns without a claim count, too: then nothing passes
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    titles: Titles,
    #[command(flatten)]
    flags: Flags,
}

/// A number on the command line above this one.
fn above(least: f64) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| {
        let number = text.parse().ok();
        let number = number.filter(|number| *number > least && f64::is_finite(*number));
        number.ok_or_else(|| format!("expected a number > {least}"))
    }
}

/// Judges the tables, prints rates and verdicts, and writes the files requested.
///
/// # Errors
/// Tables or claims that cannot be used, and a folder that cannot be written.
pub(super) fn run(project: &Project, arguments: &Arguments) -> CommandOutcome {
    let request = arguments.request();
    let files = arguments.files()?;
    let refused = |refusal| refuse(project, arguments, &refusal);
    let mut sources = vec![];
    for file in &files {
        sources.extend(rates::read(Tables::File(file), &request.choice()).map_err(refused)?);
    }
    let findings = rates::judgements(project.command, &sources, &request).map_err(refused)?;
    let verdict = rates::verdict_of(&findings);
    let flags = &arguments.flags;
    if let Some(folder) = &flags.out {
        arguments.refuse_others(project, &files, findings.len())?;
        write(project, &findings, folder, arguments.titles)?;
    }
    let words = match flags.format {
        Format::Csv => rates::csv(&findings),
        Format::Md => rates::rows_in_markdown(&findings),
        Format::Latex => rates::latex(&findings),
        Format::Text | Format::Json => {
            let text = rates::text_of_all(&findings, flags.quiet, screen::verdict);
            text + &report_in(flags)
        }
    };
    Ok(flags.show("rates", verdict, &rates::object_of_all(&findings), &words)?)
}

/// Where the report is, if there is one.
fn report_in(flags: &Flags) -> String {
    match &flags.out {
        Some(folder) if !flags.quiet => {
            let page = visible::path(&folder.join(PAGE));
            format!("report: {page}\n")
        }
        _ => String::new(),
    }
}

/// The refusal in the words of the command line; with `--format json` it is printed as an object,
/// too.
fn refuse(project: &Project, arguments: &Arguments, refusal: &NotJudged) -> Unusable {
    let file = match refusal {
        NotJudged::Table { file, .. } => file,
        NotJudged::Claim(_) | NotJudged::Rule(_) => "FILE",
    };
    let surface = arguments.request().command_line(project.command, file);
    match arguments.flags.print_refusal(&refusal.object(&surface)) {
        Ok(()) => Unusable::because(&refusal.words(&surface)),
        Err(error) => error.into(),
    }
}

impl Arguments {
    /// What the arguments say, but for the files.
    fn request(&self) -> Request {
        Request {
            claims: [&self.order[..], &self.factor].concat(),
            by_factor: !self.factor.is_empty(),
            tolerance: self.tolerance,
            floor: self.floor,
            scale: self.scale,
            eps: self.eps,
            choice: Choice {
                step: self.step.clone(),
                columns: self.columns.clone(),
                values: self.values.clone(),
                names: self.names.clone(),
                lines: self.lines.clone(),
                dim: self.dim,
                ratio: self.ratio,
                samples: self.samples.then_some(self.of),
                ..Choice::default()
            },
            all: self.all,
        }
    }

    /// Refuses a folder where the tables that are judged, or files of somebody else, would be lost.
    fn refuse_others(
        &self,
        project: &Project,
        tables: &[String],
        figures: usize,
    ) -> io::Result<()> {
        // Up to the name of the project.
        let suites = junit_of(project.name, &[])?;
        let suites = suites.split_inclusive('"').take(6).collect::<String>();
        let mut own = vec![(PAGE.to_owned(), HEADING), (JUNIT.to_owned(), &*suites)];
        own.extend((0..figures).map(|k| (figure_name(k, figures), Flags::SVG)));
        self.flags.refuse_others("rates", own, tables)
    }

    /// The files; without one standard input, unless it is a terminal.
    fn files(&self) -> Result<Vec<String>, Unusable> {
        if !self.files.is_empty() {
            let files = self.files.iter().map(|file| file.display().to_string());
            let files: Vec<String> = files.collect();
            if files.iter().filter(|file| *file == "-").count() > 1 {
                let problem = "rates: found `-` twice; expected standard input once";
                return Err(Unusable::because(problem));
            }
            return Ok(files);
        }
        if io::stdin().is_terminal() {
            return Err(Unusable::because(
                "rates: found no FILE; expected a table, or one that another program writes to standard input",
            ));
        }
        Ok(vec!["-".to_owned()])
    }
}

/// The name of the figure of a table, from 0: that of an only one is `rates.svg`, those of several
/// are `rates-1.svg`, ...
fn figure_name(k: usize, tables: usize) -> String {
    match tables {
        1 => "rates.svg".to_owned(),
        _ => format!("rates-{}.svg", k + 1),
    }
}

/// Writes figures, Markdown and JUnit XML, each atomically, and appends to the job summary of
/// GitHub.
///
/// # Errors
/// The error of the operating system, with the name of the file.
fn write(
    project: &Project,
    findings: &[Judgement<'_>],
    folder: &Path,
    titles: Titles,
) -> io::Result<()> {
    atomic::prepare_folder(folder)?;
    let mut pages = vec![];
    for (k, judgement) in findings.iter().enumerate() {
        let name = figure_name(k, findings.len());
        atomic::write(&folder.join(&name), titles.of(figure(judgement)))?;
        let picture = format!("![Errors over steps]({name})\n\n");
        pages.push(markdown(judgement, &picture));
    }
    pages.extend(verdict_in_markdown(findings));
    atomic::write(&folder.join(PAGE), pages.join("\n"))?;
    let suites: Vec<Suite<'_>> = findings.iter().map(suite).collect();
    let junit = junit_of(project.name, &suites)?;
    atomic::write(&folder.join(JUNIT), junit)?;
    // A picture would need an address on the web.
    for judgement in findings {
        github::summarise(|| Ok(markdown(judgement, "")));
    }
    Ok(())
}

/// A test case for each column that decides, or one that does not pass for want of a claim; for
/// equal columns, of which those with claims do not pass; for doubts; for each column set aside.
fn suite<'j>(judgement: &'j Judgement<'_>) -> Suite<'j> {
    let table = &judgement.source.table;
    let sentence = rates::sentence(judgement);
    let mut cases = vec![];
    for judged in judgement.deciding() {
        let claim = judged.claim.map_or(String::new(), |claim| {
            format!(": order {}{}", claim.bound.words(), claim.order)
        });
        let name = judged.column.name.clone() + &claim;
        cases.push(Item::new(name, judged.rate.verdict, judged.answer()));
    }
    if cases.is_empty() {
        cases.push(Item::new("a claim", judgement.verdict(), &*sentence));
    }
    let unclaimed = judgement.equals.iter().filter(|equal| !equal.are_claimed);
    cases.extend(unclaimed.map(|equal| Item::new(equal.to_string(), Verdict::Pass, "")));
    let boundary = judgement.boundary.iter();
    cases.extend(boundary.map(|loss| Item::new(&*loss.claim, loss.verdict, &*loss.evidence)));
    if !table.doubts.is_empty() {
        cases.push(Item::new("the table", Verdict::Inconclusive, sentence));
    }
    let skipped = table.left_out.iter().cloned();
    Suite {
        skipped: skipped.map(|one| (one.column, one.because)).collect(),
        ..Suite::new(&judgement.source.name, cases)
    }
}

#[cfg(test)]
mod tests {
    use clap::Args;

    use super::Arguments;
    use crate::rates::Argument;

    #[test]
    fn every_argument_of_a_message_is_an_option_of_the_command() {
        let command = Arguments::augment_args(clap::Command::new("rates"));
        for argument in Argument::ALL {
            let mut options = command.get_arguments();
            let option = options
                .find(|option| option.get_long() == Some(argument.name()))
                .unwrap_or_else(|| panic!("no --{}", argument.name()));
            let names = option.get_value_names().expect("a value");
            assert_eq!(names, [argument.placeholder()], "{}", argument.name());
        }
    }
}
