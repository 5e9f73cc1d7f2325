//! `review`: what differs from the baseline, accepted one by one with a reason.

use std::io::{self, BufRead, IsTerminal, Write};

use glob::Pattern;
use serde::Serialize;

use super::exit::{Outcome, Unusable};
use super::flags::Flags;
use super::verify::{reason, scope};
use crate::cli::running::{Limits, Watched};
use crate::cli::{selection, workspace};
use crate::project::Project;
use crate::report::text_of_failures;
use crate::review::{self, Pending, describe, id};
use crate::store::baseline::Change;
use crate::study::{Study, Tier};
use crate::text::visible::visible;
use crate::verify::Request;

/// Run the studies and accept what differs from the baseline, one by one, with a reason
///
/// Shows of each number that has moved the old value, the new one, the tolerance, the interval of a rate, and what the study claims. On a terminal each is
/// asked for; elsewhere they are listed, and --accept takes some. The baseline keeps the reasons. Exit status 1 where something still differs or a study
/// does not pass. Reports are not written: that does `verify`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Tier of studies; full holds quick
    #[arg(long, value_parser = selection::tier_parser(), default_value = "quick")]
    tier: Tier,
    #[command(flatten)]
    limits: Limits,
    /// Changes to accept without being asked: STUDY:NAME as listed, or a pattern such as 'heat-*:rate *'; '*' for all
    #[arg(long, value_name = "ID", requires = "reason")]
    accept: Vec<String>,
    /// Why they are accepted; the baseline keeps it
    #[arg(long, value_name = "TEXT", requires = "accept", value_parser = reason)]
    reason: Option<String>,
    /// Ids or patterns of studies
    #[arg(value_name = "ID")]
    ids: Vec<String>,
    #[command(flatten)]
    flags: Flags,
}

/// What `--format json` prints.
#[derive(Serialize)]
struct Object {
    /// The changes that were accepted, each with its reason.
    accepted: Vec<Accepted>,
    /// What still differs.
    differs: Vec<String>,
}

#[derive(Serialize)]
struct Accepted {
    id: String,
    reason: String,
}

/// Runs the studies, shows what differs, and accepts what is to be accepted.
///
/// # Errors
/// Studies, a selection or a baseline that cannot be used; a change asked for that there is not, or that no baseline can take.
pub(super) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let Arguments { tier, limits, accept, reason, ids, flags } = arguments;
    let root = workspace::root()?;
    let all = workspace::studies(project, &root)?;
    let headers: Vec<_> = all.iter().map(|file| file.study.header()).collect();
    let meant = selection::select(&headers, *tier, ids, &format!("{} list", project.command))?;
    let scope = scope(*tier, ids, &all);
    let mut studies: Vec<Box<dyn Study>> =
        all.into_iter().zip(meant).filter(|(_, meant)| *meant).map(|(file, _)| file.study).collect();
    // What is accepted was computed by the programs as they are.
    studies.iter_mut().for_each(|study| study.compute_anew());
    let (effort, reports) = (flags.effort(limits.case_limit), root.join("reports"));
    let request = Request { scope, effort, bless: false, reason: None, root, reports };
    let watched = Watched::new(&studies, !flags.quiet);
    let pending = review::pending(&studies, &request, &|progress| watched.show(progress));
    watched.clear();
    let pending = pending?;
    let accepted = match reason {
        Some(reason) => asked_for(&pending.changes, accept)?.into_iter().map(|index| (index, reason.clone())).collect(),
        None if io::stdin().is_terminal() => ask(&pending, &mut io::stdin().lock(), &mut io::stderr())?,
        None => vec![],
    };
    let left = review::accept(&pending, &request, &accepted)?;
    let verdict = crate::verify::verdict(&pending.finished, &left);
    let accepted = accepted.into_iter().map(|(index, reason)| Accepted { id: id(&pending.changes[index]), reason });
    let object =
        Object { accepted: accepted.collect(), differs: left.iter().map(|change| change.to_string()).collect() };
    let sentence = sentence(object.accepted.len(), left.len());
    let whole = || {
        let taken = object
            .accepted
            .iter()
            .map(|Accepted { id, reason }| format!("accepted: {}: {}\n", visible(id), visible(reason)));
        taken.chain(left.iter().map(|change| describe(&pending, change))).chain([format!("{sentence}\n")]).collect()
    };
    // What went wrong is said in any case.
    let failed = text_of_failures(&pending.finished);
    let differs: String = if flags.quiet {
        left.iter().map(|change| visible(&change.to_string()) + "\n").collect()
    } else {
        String::new()
    };
    flags.show("review", verdict, &object, &(failed + &differs + &flags.words(verdict, &sentence, whole)))?;
    Ok(verdict.into())
}

fn sentence(accepted: usize, left: usize) -> String {
    match (accepted, left) {
        (0, 0) => "nothing differs from the baseline".to_owned(),
        (accepted, 0) => format!("{accepted} accepted, nothing else differs from the baseline"),
        (accepted, left) => {
            format!("{accepted} accepted, {left} differ from the baseline; accept with --accept ID --reason TEXT")
        }
    }
}

/// The changes that are named or matched, each once.
///
/// # Errors
/// A pattern that cannot be read, and one that matches nothing.
fn asked_for(changes: &[Change], words: &[String]) -> Result<Vec<usize>, Unusable> {
    let mut meant = vec![false; changes.len()];
    for word in words {
        let pattern = Pattern::new(word).ok();
        let found = |change: &Change| {
            id(change) == *word || pattern.as_ref().is_some_and(|pattern| pattern.matches(&id(change)))
        };
        let found: Vec<usize> = (0..changes.len()).filter(|&index| found(&changes[index])).collect();
        if found.is_empty() {
            let some: Vec<String> = changes.iter().take(3).map(|change| format!("`{}`", id(change))).collect();
            let some = if some.is_empty() { "nothing, for nothing differs".to_owned() } else { some.join(", ") };
            return Err(Unusable::because(&format!(
                "--accept: found `{word}`, which matches no change; expected one of {} such as {some}",
                changes.len()
            )));
        }
        found.into_iter().for_each(|index| meant[index] = true);
    }
    Ok((0..changes.len()).filter(|&index| meant[index]).collect())
}

/// Asks for each change whether it is accepted, and why.
fn ask(pending: &Pending, input: &mut impl BufRead, out: &mut impl Write) -> io::Result<Vec<(usize, String)>> {
    let changes = &pending.changes;
    let mut accepted: Vec<(usize, String)> = vec![];
    let (mut all, mut of_study) = (false, None);
    for (index, change) in changes.iter().enumerate() {
        write!(out, "\n{} of {}: {}", index + 1, changes.len(), describe(pending, change))?;
        if !all && of_study != Some(&change.study) {
            match answer(input, out)? {
                'n' => continue,
                'q' => break,
                'a' => all = true,
                's' => of_study = Some(&change.study),
                _ => {}
            }
            let Some(why) = ask_why(input, out, accepted.last().map(|(_, reason)| reason.as_str()))? else { break };
            accepted.push((index, why));
        } else if let Some((_, reason)) = accepted.last().cloned() {
            accepted.push((index, reason));
        }
    }
    Ok(accepted)
}

/// One of the letters; `q` where the input ends.
fn answer(input: &mut impl BufRead, out: &mut impl Write) -> io::Result<char> {
    loop {
        write!(out, "accept? [y]es, [n]o, all of this [s]tudy, [a]ll, [q]uit: ")?;
        out.flush()?;
        let mut line = String::new();
        if input.read_line(&mut line)? == 0 {
            return Ok('q');
        }
        match line.trim() {
            "y" | "n" | "s" | "a" | "q" => return Ok(line.trim().chars().next().unwrap_or('q')),
            _ => {}
        }
    }
}

/// A reason; an empty line is the one before. `None` where the input ends.
fn ask_why(input: &mut impl BufRead, out: &mut impl Write, before: Option<&str>) -> io::Result<Option<String>> {
    loop {
        let same = before.map(|before| format!(" [{}]", visible(before))).unwrap_or_default();
        write!(out, "why?{same} ")?;
        out.flush()?;
        let mut line = String::new();
        if input.read_line(&mut line)? == 0 {
            return Ok(None);
        }
        match (reason(&line), before) {
            (Ok(reason), _) => return Ok(Some(reason)),
            (Err(_), Some(before)) if line.trim().is_empty() => return Ok(Some(before.to_owned())),
            (Err(expected), _) => writeln!(out, "{expected}")?,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::baseline::Movement;

    fn pending() -> Pending {
        let change = |(study, name): (&str, &str)| Change {
            study: study.to_owned(),
            name: name.to_owned(),
            movement: Movement::Moved { from: 1.0, to: 2.0, tolerance: 0.1 },
        };
        let changes = [("a", "rate u"), ("a", "error u"), ("b", "rate u"), ("b", "error u")].map(change).to_vec();
        Pending { finished: vec![], changes }
    }

    /// What is accepted, and why, for these lines of answers.
    fn accepted(lines: &str) -> Vec<(usize, String)> {
        let mut out = vec![];
        let found = ask(&pending(), &mut lines.as_bytes(), &mut out).unwrap();
        assert!(
            String::from_utf8(out)
                .unwrap()
                .starts_with("\n1 of 4: a:rate u: moved from 1 to 2, by +100 %, tolerated 10 %\n")
        );
        found
    }

    #[test]
    fn each_change_is_asked_for_and_needs_a_reason() {
        let with =
            |indices: &[usize], reason: &str| indices.iter().map(|&k| (k, reason.to_owned())).collect::<Vec<_>>();
        assert_eq!(accepted("n\ny\nmesh\nq\n"), with(&[1], "mesh"));
        assert_eq!(accepted("a\nnew solver\n"), with(&[0, 1, 2, 3], "new solver"));
        assert_eq!(accepted("s\nmesh\nn\nn\n"), with(&[0, 1], "mesh"));
        assert_eq!(accepted("what\ny\n \nmesh\ny\n\nn\nn\n"), with(&[0, 1], "mesh"));
        assert_eq!(accepted("n\nn\nn\nn\n"), vec![]);
    }

    #[test]
    fn nothing_is_accepted_where_the_input_ends() {
        for lines in ["", "y\n", "y\n\n"] {
            assert_eq!(accepted(lines), vec![], "{lines:?}");
        }
    }

    #[test]
    fn changes_are_named_or_matched() {
        let found = |words: &[&str]| {
            let words: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
            asked_for(&pending().changes, &words).map_err(|error| error.message().to_owned())
        };
        assert_eq!(found(&["a:rate u"]), Ok(vec![0]));
        assert_eq!(found(&["*:rate *", "b:*"]), Ok(vec![0, 2, 3]));
        assert_eq!(found(&["*"]), Ok(vec![0, 1, 2, 3]));
        let error = found(&["*", "c:*"]).unwrap_err();
        assert!(
            error.starts_with("--accept: found `c:*`, which matches no change; expected one of 4 such as `a:rate u`")
        );
    }
}
