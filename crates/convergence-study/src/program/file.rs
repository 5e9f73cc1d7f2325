//! Study files of programs. `begin/study.toml` is one, `program.md` of the book describes them.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::Program;
use super::answer::Expectation;
use super::command::filled;
use super::refine::{self, CaseParameter, refine};
use crate::input::{Field, Form, InputError, Key, Section, visible};
use crate::judge::claims::Bound;
use crate::judge::claims::order_of_factor;
use crate::judge::verdict::{Floor, WIDEST_TOLERANCE};
use crate::study::{Claim, Header, read_claim};
use crate::text::number::plain_text;

/// The keys of the file.
pub(super) const KEYS: [Key; 3] = [
    Key::new("program", Form::Table(&[&[&PROGRAM]]), "what is run"),
    Key::new(
        "refine",
        Form::Table(refine::KEYS),
        "the resolutions at which it is run",
    ),
    Key::new(
        "expect",
        Form::List(&Form::Table(&[
            &[&[ERROR], &ORDER],
            &[&[ERROR], &FACTOR],
            &[&[ERROR, EXACT]],
            &[&[VALUE], &[RATE, TOLERANCE]],
        ])),
        "an error or a value, and what is claimed of it",
    ),
];

const PROGRAM: [Key; 7] = [
    Key::new(
        "command",
        Form::List(&Form::Text),
        "the program and its arguments, without a shell; `{n}`, `{h}`, `{steps}`, `{dt}`, `{level}` stand for the resolution, \
         without them the program reads it as JSON from standard input",
    ),
    Key::new(
        "directory",
        Form::Text,
        "the folder in which it runs, relative to that of this file",
    )
    .or("\".\""),
    Key::new(
        "env",
        Form::Named(&[], &Form::Text),
        "variables of the program's environment, beside those of the harness",
    )
    .or("none"),
    Key::new(
        "manufacture",
        Form::Text,
        "the file of `manufacture` from whose module with `--variants` the program takes its solution, for `--where`; relative to this file",
    )
    .or("none"),
    Key::new(
        "time_limit",
        Form::Positive,
        "the time limit of a case in seconds",
    )
    .or("600"),
    Key::new(
        "floor",
        Form::Positive,
        "a thousand times the round-off: fine levels with errors up to it are dropped",
    )
    .or("none"),
    Key::new(
        "scale",
        Form::Positive,
        "the size of the solution, which says what may be round-off",
    )
    .or("1"),
];
const ERROR: Key = Key::new(
    "error",
    Form::Text,
    "the name of an error that the program answers",
);
const VALUE: Key = Key::new(
    "value",
    Form::Text,
    "the name of a value without exact solution that it answers: judged by the differences of its levels",
);
const EXACT: Key = Key::new("exact", Form::Positive, "no error is larger");
const RATE: Key = Key::new(
    "order",
    Form::OneOf(&[Form::Positive, Form::Text]),
    "the order, or the least order as \">= 1\"; of a grid: in h",
);
const TOLERANCE: Key = Key::new(
    "tolerance",
    Form::Positive,
    "how far the rate may be from the order",
)
.or("0.25, at most half of the order, a quarter of a least one");
const ORDER: [Key; 4] = [
    RATE,
    Key::new("order_dt", Form::Positive, "of a grid: the order in dt").or("order"),
    Key::new(
        "constant",
        Form::List(&Form::Positive),
        "the ends of the C of error = C h^order",
    )
    .or(""),
    TOLERANCE,
];
const FACTOR: [Key; 2] = [
    Key::new(
        "factor",
        Form::OneOf(&[Form::Positive, Form::Text]),
        "by which the error falls with each degree, n being the degree, or at least, as \">= 5\"",
    ),
    TOLERANCE,
];

/// What is known of round-off.
fn floor(section: &Section<'_>) -> Result<Floor, InputError> {
    let number = |key: &str, default: f64| {
        section
            .get(key)
            .map_or(Ok(default), |field| field.positive())
    };
    let [floor, scale] = [number("floor", 0.0)?, number("scale", 1.0)?];
    // Both are finite and positive.
    let floor = Floor::new(floor).and_then(|floor| floor.of_scale(scale));
    Ok(floor.unwrap_or_default())
}

/// The default time limit of a case.
const TIME_LIMIT: Duration = Duration::from_secs(600);

pub(super) fn read(
    _header: &Header,
    root: &Section<'_>,
    folder: &Path,
) -> Result<Program, InputError> {
    let section = root
        .require("program", "a table with the command")?
        .section()?;
    let directory = directory(&section, folder)?;
    let refine = refine(root)?;
    let words = words(&section, &refine.resolutions()[0].parameters)?;
    let time_limit = section.get("time_limit").map_or(Ok(TIME_LIMIT), |field| {
        let allowed = "a number of seconds > 0";
        let seconds = field.number_where(allowed, |seconds| seconds > 0.0)?;
        Duration::try_from_secs_f64(seconds).map_err(|_| field.refuse_as_written(allowed))
    })?;
    let expect = expectations(root, refine.grid)?;
    Ok(Program {
        words,
        directory,
        variables: variables(&section)?,
        time_limit,
        floor: floor(&section)?,
        refine,
        expect,
        manufactured: manufactured(&section, folder)?,
        most_levels: None,
    })
}

/// The file of `manufacture`; it is read when its variants are needed.
fn manufactured(section: &Section<'_>, folder: &Path) -> Result<Option<PathBuf>, InputError> {
    let Some(field) = section.get("manufacture") else {
        return Ok(None);
    };
    let path = folder.join(field.text()?);
    if path.is_file() {
        return Ok(Some(path));
    }
    let found = format!(
        "{}, but {} is no file",
        field.as_written(),
        visible(&path.display().to_string())
    );
    Err(field.refuse(found, "a file of `manufacture`, relative to this file"))
}

/// The folder in which the program runs, as an absolute path: the program's name is relative to it,
/// too.
fn directory(section: &Section<'_>, folder: &Path) -> Result<PathBuf, InputError> {
    let here = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let Some(field) = section.get("directory") else {
        return here
            .canonicalize()
            .map_err(|error| section.refuse("directory", error.to_string(), "a folder"));
    };
    let path = here.join(field.text()?);
    let absolute = path.canonicalize().ok().filter(|path| path.is_dir());
    absolute.ok_or_else(|| {
        let found = format!(
            "{}, but {} is no folder",
            field.as_written(),
            visible(&path.display().to_string())
        );
        field.refuse(found, "a folder, relative to that of this file")
    })
}

/// The table `env`: texts by name.
fn variables(section: &Section<'_>) -> Result<Vec<(String, String)>, InputError> {
    let Some(env) = section.section("env")? else {
        return Ok(vec![]);
    };
    let mut variables = vec![];
    for name in env.keys() {
        let field = env.require(name, "a text in quotes")?;
        if name.is_empty() || name.contains(['=', '\0']) {
            let allowed = "a name of a variable, without `=`";
            return Err(field.refuse(format!("the name \"{}\"", visible(name)), allowed));
        }
        let value = field.text()?;
        if value.contains('\0') {
            return Err(field.refuse_as_written("a text without the character 0"));
        }
        variables.push((name.to_owned(), value.to_owned()));
    }
    Ok(variables)
}

fn words(section: &Section<'_>, values: &[CaseParameter]) -> Result<Vec<String>, InputError> {
    let allowed = "a list of the program and its arguments, each a text in quotes";
    let field = section.require("command", allowed)?;
    let items = field.items(allowed)?;
    let first = items
        .first()
        .ok_or_else(|| field.refuse_as_written(allowed))?;
    if first.text().is_ok_and(str::is_empty) {
        return Err(first.refuse_as_written("the name of a program"));
    }
    let word = |item: &Field<'_>| {
        if item.text()?.contains('\0') {
            return Err(item.refuse_as_written("a text without the character 0"));
        }
        item.parsed("a text in quotes", |text| {
            filled(text, values).map(|_| text.to_owned())
        })
    };
    items.iter().map(word).collect()
}

fn expectations(root: &Section<'_>, grid: bool) -> Result<Vec<Expectation>, InputError> {
    let mut names: Vec<(String, bool)> = vec![];
    let read = |section: &Section<'_>| {
        let expectation = expectation(section, grid)?;
        let name = (expectation.name.clone(), expectation.is_value);
        if names.contains(&name) {
            let found = format!("\"{}\" a second time", visible(&expectation.name));
            return Err(section.refuse(expectation.what(), found, "each name once"));
        }
        names.push(name);
        Ok(expectation)
    };
    let expectations = root.tables("expect", " with error or value, and order", read)?;
    let by_degree = expectations
        .iter()
        .filter(|expectation| expectation.by_degree)
        .count();
    let of_rates = expectations
        .iter()
        .filter(|expectation| expectation.exact.is_none())
        .count();
    if by_degree > 0 && by_degree < of_rates {
        return Err(root.refuse(
            "expect",
            "factor in some tables and order in others",
            "one of the two in all of a study",
        ));
    }
    Ok(expectations)
}

/// * `grid`: whether h and dt are refined independently; each error then has two orders.
fn expectation(section: &Section<'_>, grid: bool) -> Result<Expectation, InputError> {
    let (name, is_value) = match section.get("value") {
        Some(value) if section.get("error").is_some() => {
            return Err(value.refuse(
                "value beside error",
                "one of the two in each table [[expect]]",
            ));
        }
        Some(value) if grid => {
            return Err(value.refuse(
                "value with grid = true",
                "error, the only one that a grid judges",
            ));
        }
        Some(value) => (
            name(&value, "the name of a value that the program answers")?,
            true,
        ),
        None => {
            let allowed = "the name of an error that the program answers, or `value` with the name of a value";
            (name(&section.require("error", allowed)?, allowed)?, false)
        }
    };
    let (claim, by_degree, exact) = claimed(section, grid || is_value)?;
    let time = match section.get("order_dt") {
        Some(field) if !grid => {
            return Err(field.refuse("order_dt without grid = true", "order alone"));
        }
        Some(field) => field.positive()?,
        None => claim.order,
    };
    Ok(Expectation {
        name,
        is_value,
        claim,
        time,
        by_degree,
        exact,
    })
}

/// The claim: a rate over steps, or over degrees if the flag is true; or the bound of an error that
/// should vanish.
///
/// * `plain`: whether only an order can be claimed, as for values and grids.
fn claimed(section: &Section<'_>, plain: bool) -> Result<(Claim, bool, Option<f64>), InputError> {
    let claims = ["order", "factor", "exact"].map(|key| section.get(key));
    let other = claims[1..]
        .iter()
        .flatten()
        .next()
        .cloned()
        .or(section.get("constant"));
    if let Some(field) = other.filter(|_| plain) {
        return Err(field.refuse_as_written("order alone, for values and on a grid"));
    }
    if let [_, Some(field), Some(_)] | [Some(_), Some(field), _] | [Some(_), _, Some(field)] =
        &claims
    {
        return Err(field.refuse_as_written("one of order, factor and exact"));
    }
    if let [_, _, Some(field)] = &claims {
        if let Some(key) = ["tolerance", "constant"]
            .into_iter()
            .find(|key| section.get(key).is_some())
        {
            return Err(section.refuse(key, format!("{key} beside exact"), "exact alone"));
        }
        // There is no rate for a tolerance to apply to.
        return Ok((
            Claim::usual(1.0, Bound::Both),
            false,
            Some(field.positive()?),
        ));
    }
    if let Some(field) = claims[0].as_ref().filter(|_| plain) {
        field.positive()?;
    }
    let key = if claims[1].is_some() {
        "factor"
    } else {
        "order"
    };
    let mut claim = read_claim(section, key)?;
    if let Some(field) = &claims[1] {
        if claim.order <= 1.0 {
            return Err(field.refuse_as_written("a factor > 1, by which the error falls a degree"));
        }
        // No scheme gains an order over the degree: any larger factor may be right.
        let is_least = claim.bound.is_least();
        let bound = if is_least {
            Bound::AnyAbove
        } else {
            Bound::Both
        };
        claim = Claim {
            constant: claim.constant,
            ..Claim::usual(order_of_factor(claim.order), bound)
        };
    }
    if let Some(field) = section.get("tolerance") {
        let most = WIDEST_TOLERANCE.min(claim.order);
        let narrow = format!("a number > 0 and < {}", plain_text(most));
        claim.tolerance = field.number_where(&narrow, |number| number > 0.0 && number < most)?;
    }
    Ok((claim, claims[1].is_some(), None))
}

/// A name as in answers, without control characters.
fn name(field: &Field<'_>, allowed: &str) -> Result<String, InputError> {
    let name = field.text()?;
    let is_name = !name.is_empty() && !name.contains(char::is_control);
    if is_name {
        Ok(name.to_owned())
    } else {
        Err(field.refuse_as_written(allowed))
    }
}
