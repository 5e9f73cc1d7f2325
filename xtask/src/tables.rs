//! `dev tables`: how the tables of a folder are read, against what an expert says of each.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use convergence_study::{
    Verdict,
    command_line::Unusable,
    rates::{Choice, Claimed, NotJudged, Request, Tables},
};
use serde::Deserialize;
use serde_json::Value;

/// Read the tables of a folder, and compare with its `expect.json`
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The folder
    folder: PathBuf,
}

/// What an expert says of a table.
#[derive(Debug, Deserialize)]
struct ExpertVerdict {
    file: String,
    options: Vec<String>,
    /// Exit statuses that are right.
    status: Vec<u8>,
    /// For each column of errors the verdicts that are right.
    columns: BTreeMap<String, Vec<String>>,
    tables: usize,
    judged: Option<Vec<usize>>,
    /// An error that identifies a column where its name does not.
    #[serde(default)]
    last: BTreeMap<String, f64>,
    /// Columns that are no errors: none of them passes.
    #[serde(default)]
    never: Vec<String>,
    /// Where fitted rates must lie.
    #[serde(default)]
    rate: BTreeMap<String, [f64; 2]>,
}

/// How a table was read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Class {
    Right,
    /// The first choice that the refusal offers is right.
    Offered,
    RightlyRefused,
    /// Inconclusive where an expert is sure.
    Undecided,
    Refused,
    Misread,
    FalsePass,
}

impl Class {
    fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Offered => "offered",
            Self::RightlyRefused => "rightly refused",
            Self::Undecided => "undecided",
            Self::Refused => "refused",
            Self::Misread => "misread",
            Self::FalsePass => "false pass",
        }
    }
}

/// A table with how it was read, and why this is not right.
struct JudgedTable {
    file: String,
    class: Class,
    why: String,
}

/// Prints each table and the counts; fails if a table is misread or passes falsely.
pub(crate) fn run(arguments: &Arguments) -> Result<Verdict, Unusable> {
    let all = judge_all(&arguments.folder).map_err(|error| Unusable::because(&error))?;
    for JudgedTable { file, class, why } in &all {
        println!("{:15} {file}: {why}", class.name());
    }
    let mut counts: BTreeMap<Class, usize> = BTreeMap::new();
    for judged in &all {
        *counts.entry(judged.class).or_default() += 1;
    }
    let counts = counts
        .iter()
        .map(|(class, count)| format!("{} {count}", class.name()));
    println!("{}", counts.collect::<Vec<_>>().join(", "));
    let is_bad = |judged: &JudgedTable| judged.class >= Class::Misread;
    Ok(if all.iter().any(is_bad) {
        Verdict::Fail
    } else {
        Verdict::Pass
    })
}

fn judge_all(folder: &Path) -> Result<Vec<JudgedTable>, String> {
    let path = folder.join("expect.json");
    let words = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let text = fs::read_to_string(&path).map_err(|error| words(&error))?;
    let expectations: Vec<ExpertVerdict> =
        serde_json::from_str(&text).map_err(|error| words(&error))?;
    let judged = expectations.iter().map(|expectation| {
        let path = folder.join(&expectation.file);
        let text =
            fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let (class, why) = judge(expectation, &text)?;
        Ok(JudgedTable {
            file: expectation.file.clone(),
            class,
            why,
        })
    });
    judged.collect()
}

/// What the options ask for.
fn request(options: &[String]) -> Result<Request, String> {
    let mut claims: Vec<Claimed> = vec![];
    let mut choice = Choice::default();
    for option in options.chunks(2) {
        let [name, value] = option else {
            return Err(format!("an option without a value: {option:?}"));
        };
        let number = || {
            value
                .parse::<f64>()
                .map_err(|error| format!("{name} {value}: {error}"))
        };
        match name.as_str() {
            "--order" => claims.push(value.parse()?),
            "--values" => choice.values = value.split(',').map(str::to_owned).collect(),
            "--dim" => choice.dim = Some(number()?),
            "--ratio" => choice.ratio = Some(number()?),
            _ => return Err(format!("the option {name} is not known here")),
        }
    }
    Ok(Request {
        claims,
        choice,
        ..Request::default()
    })
}

fn judge(expectation: &ExpertVerdict, text: &str) -> Result<(Class, String), String> {
    let request = request(&expectation.options)?;
    let refusal = match request.object("rates", Tables::Text(text)) {
        Ok(object) => return Ok(compare(expectation, &object)),
        Err(refusal) => refusal,
    };
    let NotJudged::Table { error, .. } = &refusal else {
        return Ok((Class::Misread, format!("{refusal:?}")));
    };
    let first = error
        .to_string()
        .lines()
        .next()
        .unwrap_or_default()
        .to_owned();
    let offered = error.offered().next().cloned().map(|choice| {
        let request = Request {
            choice,
            ..request.clone()
        };
        request.object("rates", Tables::Text(text))
    });
    let is_refusal_right = expectation.status.contains(&2);
    Ok(match offered {
        Some(Ok(object))
            if is_refusal_right
                && object["verdict"] == "pass"
                && !expectation.status.contains(&0) =>
        {
            (Class::FalsePass, "the offered choice passes".to_owned())
        }
        _ if is_refusal_right => (Class::RightlyRefused, String::new()),
        None => (Class::Refused, first),
        Some(Err(_)) => (
            Class::Refused,
            format!("the offered choice is refused, too: {first}"),
        ),
        Some(Ok(object)) => match compare(expectation, &object) {
            (Class::Right, _) => (Class::Offered, first),
            (class, why) => (class, format!("by the offered choice: {why}")),
        },
    })
}

/// What was found of a table that was read, against what is right.
fn compare(expectation: &ExpertVerdict, object: &Value) -> (Class, String) {
    let status = u8::from(object["verdict"] != "pass");
    if status == 0 && !expectation.status.contains(&0) {
        return (Class::FalsePass, "passes".to_owned());
    }
    if expectation.status == [2] {
        return (Class::Misread, "judged, an expert refuses".to_owned());
    }
    let alone = [object.clone()];
    let tables = object["tables"]
        .as_array()
        .map_or(&alone[..], Vec::as_slice);
    let with_rates = tables.iter().filter(|table| {
        table["rates"]
            .as_array()
            .is_some_and(|rates| !rates.is_empty())
    });
    let count = with_rates.count();
    let counts = expectation
        .judged
        .clone()
        .unwrap_or_else(|| vec![expectation.tables]);
    if !counts.contains(&count) {
        let why = format!("{count} tables judged, {} in the text", expectation.tables);
        return (Class::Misread, why);
    }
    let rates: Vec<&Value> = tables
        .iter()
        .filter_map(|table| table["rates"].as_array())
        .flatten()
        .collect();
    let mut undecided = None;
    for (key, verdicts) in &expectation.columns {
        let columns = columns(expectation, key, &rates);
        if columns.is_empty() && !verdicts.iter().any(|verdict| verdict == "left") {
            return (Class::Misread, format!("`{key}` is not judged"));
        }
        for rate in columns {
            match compare_rate(expectation, key, verdicts, rate) {
                (Class::Right, _) => {}
                (Class::Undecided, why) => undecided = Some(why),
                misread => return misread,
            }
        }
    }
    // Judged and failing, a column that is no error is strict; passing it would be wrong.
    for name in &expectation.never {
        let is_meant = |rate: &&&Value| words(&rate["norm"]) == words(&Value::from(name.as_str()));
        for rate in rates.iter().filter(is_meant) {
            let why = format!("`{name}` is judged as an error");
            if rate["verdict"] == "pass" {
                return (Class::Misread, why);
            }
            undecided = Some(why);
        }
    }
    if !expectation.status.contains(&status) {
        undecided = undecided.or_else(|| Some("does not pass".to_owned()));
    }
    undecided.map_or((Class::Right, String::new()), |why| (Class::Undecided, why))
}

/// The rate of a column against what is right.
fn compare_rate(
    expectation: &ExpertVerdict,
    key: &str,
    verdicts: &[String],
    rate: &Value,
) -> (Class, String) {
    let verdict = rate["verdict"].as_str().unwrap_or_default();
    let range = expectation.rate.get(key);
    if let (Some([low, high]), Some(fitted)) = (range, rate["fitted"].as_f64())
        && !(*low..=*high).contains(&fitted)
    {
        return (Class::Misread, format!("`{key}`: rate {fitted:.2}"));
    }
    let why = format!("`{key}`: {verdict}, an expert says {}", verdicts.join("/"));
    match verdicts.iter().any(|right| right == verdict) {
        true => (Class::Right, String::new()),
        false if verdict == "inconclusive" => (Class::Undecided, why),
        false => (Class::Misread, why),
    }
}

/// The columns that an expert means by a name.
fn columns<'o>(expectation: &ExpertVerdict, key: &str, rates: &[&'o Value]) -> Vec<&'o Value> {
    if let Some(last) = expectation.last.get(key) {
        return columns_with(*last, rates);
    }
    let wanted = words(&Value::from(key));
    let has_all = |rate: &&&Value| {
        let own = words(&rate["norm"]);
        wanted.iter().all(|word| own.contains(word))
    };
    let columns: Vec<&Value> = rates.iter().filter(has_all).copied().collect();
    let least = columns.iter().map(|rate| words(&rate["norm"]).len()).min();
    columns
        .into_iter()
        .filter(|rate| Some(words(&rate["norm"]).len()) == least)
        .collect()
}

fn errors(rate: &Value) -> Vec<f64> {
    let levels = rate["levels"].as_array().into_iter().flatten();
    levels.filter_map(|level| level["error"].as_f64()).collect()
}

/// The columns that end with an error, or else have it on some level, or in another unit: a
/// percentage may be read as a fraction.
fn columns_with<'o>(error: f64, rates: &[&'o Value]) -> Vec<&'o Value> {
    let is_near = |own: &f64, factor: f64| (own * factor - error).abs() <= 1e-9 * error.abs();
    let all = rates.iter().copied();
    let ends: Vec<&Value> = all
        .clone()
        .filter(|rate| errors(rate).last().is_some_and(|last| is_near(last, 1.0)))
        .collect();
    let by_factor = [1.0, 100.0, 0.01].map(|factor| {
        all.clone()
            .filter(|rate| errors(rate).iter().any(|own| is_near(own, factor)))
            .collect()
    });
    let mut all_choices = [ends].into_iter().chain(by_factor);
    all_choices
        .find(|columns| !columns.is_empty())
        .unwrap_or_default()
}

/// The words of a name.
fn words(name: &Value) -> Vec<String> {
    let name = name.as_str().unwrap_or_default().to_lowercase();
    let words = name.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    words
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{Class, Tables, judge, judge_all, request};

    /// A folder of public tables.
    fn folder(name: &str) -> std::path::PathBuf {
        let tests = "../crates/convergence-study/tests";
        Path::new(env!("CARGO_MANIFEST_DIR")).join(tests).join(name)
    }

    /// * `least`: how many are read well, or rightly refused. A table less is a loss; more are
    ///   welcome.
    #[track_caller]
    fn assert_read_well(name: &str, least: usize) {
        let all = judge_all(&folder(name)).expect("the tables");
        let bad: Vec<String> = all
            .iter()
            .filter(|judged| judged.class >= Class::Misread)
            .map(|judged| format!("{}: {:?}: {}", judged.file, judged.class, judged.why))
            .collect();
        assert!(bad.is_empty(), "{}", bad.join("\n"));
        let good = all
            .iter()
            .filter(|judged| judged.class <= Class::RightlyRefused)
            .count();
        assert!(good >= least, "{good} of {}", all.len());
    }

    #[test]
    fn no_public_table_is_misread_and_none_passes_falsely() {
        assert_read_well("public", 36);
        assert_read_well("public-2", 30);
    }

    /// Steps of two families beside each other, with the orders over one; rates as values.
    #[test]
    fn tables_that_once_passed_falsely_do_not() {
        let verdict = |name: &str| {
            let path = folder("public-2").join(name);
            let text = std::fs::read_to_string(path).expect("a table");
            let request = request(&["--order".to_owned(), "2".to_owned()]).expect("a claim");
            let object = request.object("rates", Tables::Text(&text));
            object.map_or("refused".to_owned(), |object| object["verdict"].to_string())
        };
        assert_eq!(verdict("false-fail-1-dt-beside-N.md"), "\"pass\"");
        assert_eq!(verdict("false-pass-1-dt-beside-N.md"), "\"fail\"");
        assert_eq!(verdict("false-pass-2-steps-beside-ny.md"), "\"fail\"");
        assert_eq!(verdict("false-pass-4-rates-as-values.txt"), "refused");
    }

    #[test]
    fn a_false_pass_and_a_misread_are_found() {
        let expectation = |status: &str, verdict: &str| {
            let text = format!(
                "{{\"file\": \"\", \"options\": [\"--order\", \"2\"], \"status\": [{status}], \
                 \"columns\": {{\"L2\": [\"{verdict}\"]}}, \"tables\": 1}}"
            );
            serde_json::from_str(&text).expect("an expectation")
        };
        let passes = "h,L2\n0.2,0.04\n0.1,0.01\n0.05,0.0025\n0.025,0.000625\n";
        let class = |status, verdict| {
            judge(&expectation(status, verdict), passes)
                .expect("judged")
                .0
        };
        assert_eq!(class("0", "pass"), Class::Right);
        assert_eq!(class("1", "fail"), Class::FalsePass);
        assert_eq!(class("0", "fail"), Class::Misread);
        assert_eq!(class("2", "fail"), Class::FalsePass);
    }
}
