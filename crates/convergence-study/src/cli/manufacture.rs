//! `manufacture FILE`: sources and data for a chosen exact solution, checked, emitted, compared.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use manufacture::{
    Check, Comparison, EmittedFile, Finding, Language, LeftOutVariant, Manufacture, Sampling,
    Variants,
};
use serde_json::{Value, json};

use super::exit::{CommandOutcome, Unusable};
use super::flags::{Flags, refuse_loss};
use super::new::words;
use super::screen;
use crate::input::Document;
use crate::program::printed::printed;
use crate::store::atomic;
use crate::store::json as text_of;
use crate::text::names::quoted;
use convergence_judge::verdict::Verdict;

/// Below --out its object holds what is printed with `--format json`.
const NAME: &str = "manufacture";

/// More points than this fill the memory before they show what fewer do not.
const MOST_POINTS: u64 = 100_000;

/// Derive, check and write source terms and data for a chosen exact solution
///
/// Without further options: the check. Its notes say what a test with this solution would not
/// notice. Exit status 1 if the check fails, or if a foreign source differs; then no file is
/// written.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The file with coordinates, exact solution, equations and data
    file: PathBuf,
    /// Write files in these languages to the folder of --out: c, fortran, python, ufl, octave, rust
    #[arg(long, value_name = "LANGUAGE", value_delimiter = ',', value_parser = language)]
    language: Vec<Language>,
    /// List variants of the solution, each of which switches off what a part of a program can get
    /// wrong; with --language, the module holds them
    ///
    /// The environment variable MANUFACTURE_VARIANT chooses one when the program starts; without it
    /// the solution is that of the file. A program in Fortran calls choose_variant first.
    #[arg(long, conflicts_with_all = ["at", "against"])]
    variants: bool,
    /// Print the values, as one JSON object, at the points of a table: coordinates, time and
    /// optionally the face, separated by commas, under a header
    #[arg(long, value_name = "POINTS", conflicts_with_all = ["language", "against", "out"])]
    at: Option<PathBuf>,
    /// Compare with the source that a command computes, and say what is wrong with it
    ///
    /// The command reads a line of names and then a point a line; it prints a line of numbers for
    /// each point, under a line of names if there are several quantities.
    #[arg(long, value_name = "COMMAND", conflicts_with = "language", value_parser = command)]
    against: Option<String>,
    /// The face whose data the command computes
    #[arg(long, value_name = "FACE", requires = "against")]
    on: Option<String>,
    /// Time limit of the command
    #[arg(long, value_name = "SECONDS", requires = "against", default_value = "600", value_parser = Flags::seconds, allow_hyphen_values = true)]
    time_limit: Duration,
    /// The same seed draws the same points
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = at_least(0), allow_hyphen_values = true)]
    seed: u64,
    /// Random points of each part of the domain
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = between(2, MOST_POINTS), allow_hyphen_values = true)]
    points: u64,
    /// Notes fail, too
    #[arg(long)]
    strict: bool,
    #[command(flatten)]
    flags: Flags,
}

fn language(text: &str) -> Result<Language, String> {
    let known = Language::ALL.iter().find(|known| known.0 == text);
    let names = Language::ALL.map(|known| known.0).join(", ");
    known
        .map(|known| known.1)
        .ok_or(format!("expected one of {names}"))
}

/// A whole number on the command line, at least this.
fn at_least(least: u64) -> impl Fn(&str) -> Result<u64, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number| *number >= least);
        number.ok_or_else(|| format!("expected a whole number >= {least}"))
    }
}

/// A whole number on the command line, at least and at most these.
fn between(least: u64, most: u64) -> impl Fn(&str) -> Result<u64, String> + Clone {
    move |text| {
        let number = text.parse().ok();
        let number = number.filter(|number| (least..=most).contains(number));
        number.ok_or_else(|| format!("expected a whole number >= {least} and <= {most}"))
    }
}

/// A command of at least one word.
fn command(text: &str) -> Result<String, String> {
    words(text).map(|_| text.to_owned())
}

/// Reads the file, and does what is requested of it.
///
/// # Errors
/// A file, a table or a command that cannot be used.
pub(super) fn run(arguments: &Arguments) -> CommandOutcome {
    let file = arguments.file.display().to_string();
    let mut manufacture = Manufacture::parse(&Document::text_of_file(&arguments.file)?, &file)?;
    let sampling = Sampling {
        seed: arguments.seed,
        points: arguments.points as usize,
        is_strict: arguments.strict,
    };
    if let Some(table) = &arguments.at {
        return values(&manufacture, table);
    }
    if let Some(command) = &arguments.against {
        return compared_with(arguments, &manufacture, command, &sampling);
    }
    for language in &arguments.language {
        manufacture.accept(*language)?;
    }
    let mut check = manufacture.check(&sampling)?;
    if arguments.variants {
        manufacture = manufacture.with_variants(&sampling)?;
    }
    let variants = manufacture.variants();
    let files = files(arguments, &manufacture);
    check.add(
        emitted(arguments, &manufacture, &sampling)?,
        arguments.strict,
    );
    let verdict = verdict(check.verdict == "pass");
    let Written { wrote, kept } = if verdict.is_pass() {
        refuse_without_variants(arguments, variants)?;
        write(arguments, files)?
    } else {
        Written::default()
    };
    let mut object = json!({
        "name": manufacture.name(),
        "check": check,
        "wrote": wrote,
    });
    if let Some(variants) = variants {
        object["variants"] = json!(variants.usable);
        object["left_out"] = json!(variants.left_out);
    }
    let words = arguments.flags.words(verdict, &sentence(&check), || {
        let list = variants.map(list).unwrap_or_default();
        list + &report(&check, &wrote)
    });
    let failures = check.findings.iter().filter(|finding| finding.fails);
    let wrong = quietly(arguments, failures.map(line));
    print(arguments, verdict, &object, &(kept + &wrong + &words))
}

/// Refuses to write a module with variants that would have none.
fn refuse_without_variants(
    arguments: &Arguments,
    variants: Option<&Variants>,
) -> Result<(), Unusable> {
    match variants {
        Some(variants) if variants.usable.is_empty() && !arguments.language.is_empty() => {
            let file = arguments.file.display();
            let list = list(variants);
            let problem = format!("{file}: --variants: no variant can be used\n{list}");
            Err(Unusable::because(problem.trim_end()))
        }
        _ => Ok(()),
    }
}

/// What differs in the files of all languages, and in those of each variant, from the values.
fn emitted(
    arguments: &Arguments,
    manufacture: &Manufacture,
    sampling: &Sampling,
) -> Result<Vec<Finding>, Unusable> {
    let mut findings = vec![];
    if arguments.language.is_empty() {
        return Ok(findings);
    }
    let folder = std::env::temp_dir().join(format!("manufacture-{}", std::process::id()));
    let unusable = |error| Unusable::file(&folder, &error);
    fs::create_dir_all(&folder).map_err(unusable)?;
    for language in &arguments.language {
        findings.extend(manufacture.check_emitted(*language, &folder, sampling)?);
    }
    fs::remove_dir_all(&folder).map_err(unusable)?;
    Ok(findings)
}

/// The variants, and those that are left out, with the reason.
fn list(variants: &Variants) -> String {
    let usable = variants.usable.iter();
    let rows: Vec<Vec<String>> = usable
        .map(|variant| vec![variant.name.clone(), variant.switches_off.words()])
        .collect();
    let mut text = screen::table(&["variant", "switches off"], &rows);
    for LeftOutVariant { name, why, .. } in &variants.left_out {
        text += &format!("left out: {name}: {why}\n");
    }
    text.push('\n');
    text
}

fn verdict(passes: bool) -> Verdict {
    if passes { Verdict::Pass } else { Verdict::Fail }
}

fn values(manufacture: &Manufacture, table: &Path) -> CommandOutcome {
    let text = Document::text_of_file(table)?;
    let values = manufacture.at(&text, &table.display().to_string())?;
    screen::print(&text_of(&values)?)?;
    Ok(Verdict::Pass)
}

/// Prints the result, and writes its object to the folder of --out if the verdict is a pass.
fn print(arguments: &Arguments, verdict: Verdict, object: &Value, words: &str) -> CommandOutcome {
    let flags = &arguments.flags;
    Ok(match verdict {
        Verdict::Pass => flags.show(NAME, verdict, object, words)?,
        _ => flags.print(verdict, object, words)?,
    })
}

/// The files of all languages, and the study file.
fn files(arguments: &Arguments, manufacture: &Manufacture) -> Vec<EmittedFile> {
    let languages = arguments.language.iter();
    let mut files: Vec<EmittedFile> = languages
        .flat_map(|language| manufacture.emit(*language))
        .collect();
    if !files.is_empty() {
        files.extend(manufacture.study());
    }
    files
}

/// What became of the files.
#[derive(Default)]
struct Written {
    wrote: Vec<String>,
    /// A line for a study file that is not replaced.
    kept: String,
}

/// Writes the files to the folder of --out. They replace what this command has written, but no
/// study file that was edited.
fn write(arguments: &Arguments, mut files: Vec<EmittedFile>) -> Result<Written, Unusable> {
    let folder = arguments.flags.out.clone().unwrap_or_default();
    let read = [arguments.file.display().to_string()];
    let mut written = Written::default();
    for file in &files {
        let beginning = match is_study(file) {
            // It may begin with anything.
            true => String::new(),
            false => file.beginning(),
        };
        refuse_loss(&folder.join(&file.name), &beginning, &read)?;
    }
    let own: [(&str, &str); 0] = [];
    arguments.flags.refuse_others(NAME, own, &read)?;
    files.retain(|file| {
        let path = folder.join(&file.name);
        let differs = |found: Vec<u8>| found != file.text.as_bytes();
        let is_edited = is_study(file) && fs::read(&path).is_ok_and(differs);
        if is_edited {
            let path = path.display();
            written.kept += &format!(
                "kept {path}: it differs from what would be written; remove it to have that\n"
            );
        }
        !is_edited
    });
    if let Some(folder) = &arguments.flags.out {
        atomic::prepare_folder(folder)?;
    }
    for file in files {
        let path = folder.join(&file.name);
        atomic::write(&path, file.text)?;
        written.wrote.push(path.display().to_string());
    }
    if arguments.flags.out.is_some() {
        // It holds this list: it is written last.
        let object = folder.join(NAME).with_extension("json");
        written.wrote.push(object.display().to_string());
    }
    Ok(written)
}

/// Whether a file is a study, which is for the user to edit.
fn is_study(file: &EmittedFile) -> bool {
    file.name.ends_with(".study.toml")
}

fn sentence(check: &Check) -> String {
    let failures = check
        .findings
        .iter()
        .filter(|finding| finding.fails)
        .count();
    let notes = check.findings.len() - failures;
    let of_domain = ["pole", "removable", "singular"];
    let mut findings = check.findings.iter();
    let domain = match findings.any(|finding| of_domain.contains(&finding.code)) {
        true => String::new(),
        false => format!("; poles: nothing found at {} points", check.domain_points),
    };
    format!("{failures} failure(s), {notes} note(s){domain}")
}

/// What went wrong, if nothing else is to be printed but the verdict.
fn quietly(arguments: &Arguments, lines: impl Iterator<Item = String>) -> String {
    let lines = lines.filter(|_| arguments.flags.quiet);
    lines.collect()
}

/// A finding in a line.
fn line(finding: &Finding) -> String {
    let Finding {
        code,
        key,
        text,
        fails,
        ..
    } = finding;
    let kind = if *fails { "failure" } else { "note" };
    format!("{kind}: {key}: {code}: {text}\n")
}

/// The shares of all terms, the findings, and the verdict.
fn report(check: &Check, wrote: &[String]) -> String {
    let rows = check.shares.iter().map(|share| {
        vec![
            share.equation.clone(),
            format!("{:.4}", share.share),
            share.term.clone(),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let mut text = screen::table(&["equation", "share", "term"], &rows);
    text.push('\n');
    text.extend(check.findings.iter().map(line));
    for file in wrote {
        text += &format!("wrote {file}\n");
    }
    let verdict = verdict(check.verdict == "pass");
    text + &format!("{}: {}\n", screen::verdict(verdict), sentence(check))
}

/// Compares with the source that a command computes.
fn compared_with(
    arguments: &Arguments,
    manufacture: &Manufacture,
    command: &str,
    sampling: &Sampling,
) -> CommandOutcome {
    if manufacture.check(sampling)?.verdict != "pass" {
        let file = arguments.file.display().to_string();
        let run = format!("run manufacture {}", quoted(&file));
        let problem = format!("{file}: does not pass its own check: {run}");
        return Err(Unusable::because(&problem));
    }
    let question = manufacture.question(arguments.on.as_deref(), sampling)?;
    let input = question.text().to_owned();
    let words = words(command).map_err(|why| Unusable::because(&why))?;
    let answer = printed(words, input, arguments.time_limit)
        .map_err(|failure| Unusable::because(&failure.reason))?;
    let comparisons = question.compare(&answer, command)?;
    let left_out = question.left_out(&comparisons);
    compared(arguments, manufacture, &comparisons, &left_out)
}

/// * `left_out`: quantities that the answer does not name; as notes, they fail if that is strict.
fn compared(
    arguments: &Arguments,
    manufacture: &Manufacture,
    comparisons: &[Comparison],
    left_out: &[String],
) -> CommandOutcome {
    let mut equal = comparisons.iter();
    let are_equal = equal.all(|comparison| comparison.cause == "equal");
    let verdict = verdict(are_equal && (left_out.is_empty() || !arguments.strict));
    let object = json!({
        "name": manufacture.name(),
        "against": comparisons,
        "not_compared": left_out,
    });
    let differing = comparisons
        .iter()
        .filter(|comparison| comparison.cause != "equal")
        .count();
    let mut sentence = format!("{differing} of {} quantities differ", comparisons.len());
    if !left_out.is_empty() {
        sentence += &format!(", {} not compared", left_out.len());
    }
    let lines = left_out.iter();
    let left_out = lines.map(|name| format!("{name}: not compared: the answer does not name it\n"));
    let left_out: String = left_out.collect();
    let words = arguments.flags.words(verdict, &sentence, || {
        let lines = comparisons.iter();
        let text: String = lines.map(|one| format!("{}\n", one.sentence)).collect();
        let word = screen::verdict(verdict);
        format!("{text}{left_out}{word}: a cause is what fits, not a proof\n")
    });
    let wrong = comparisons.iter().filter(|one| one.cause != "equal");
    let wrong = wrong.map(|one| format!("{}\n", one.sentence));
    let wrong = quietly(arguments, wrong.chain(arguments.strict.then_some(left_out)));
    print(arguments, verdict, &object, &(wrong + &words))
}
