//! Transcripts: documents in Markdown that show files, commands, and what these print.
//!
//! Each heading `##` begins in a folder of its own, with the files that stand before the first one.
//!
//! - A fence with a language and a path, such as `toml studies/one.toml`, writes that file.
//! - A fence `console` has commands. A line `$ powers rates t` runs the program, with variables
//!   before it and `< FILE` behind it; words with blanks stand between `'`. `cat`, `cp`, `rm`, `ls`
//!   (all files below a folder), `same` (two files) and `sed '|old|new|' FILE`, in which `\n` is
//!   the end of a line, are there on all systems, other programs where they are.
//! - Below a command `? 1` is its exit status, which is 0 unless it is said, `2> ` begins a line of
//!   standard error, and `! ` what is printed nowhere. All other lines are standard output.
//! - A line `...` stands for any lines, `[..]` for any part of a line. Nothing else is left out.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use tempfile::TempDir;

use crate::{Ended, files::files_below, finished};

/// Runs a document as it stands.
///
/// # Panics
/// A command ends or prints otherwise than the document shows.
pub fn follow(document: &str, program: &str) {
    let (_, parts) = parts(document);
    assert!(!parts.is_empty(), "a document without `##`: {document}");
    for Part { heading, fences } in parts {
        let root = place(document);
        for fence in fences {
            fence.write(root.path());
            for block in fence.commands() {
                Shown::of(block).check(root.path(), program, heading);
            }
        }
    }
}

/// A folder with the files that stand before the first heading.
///
/// # Panics
/// There can be no such folder.
pub fn place(document: &str) -> TempDir {
    let root = tempfile::tempdir().expect("a folder");
    let (setup, _) = parts(document);
    setup.iter().for_each(|fence| fence.write(root.path()));
    root
}

struct Fence<'d> {
    head: &'d str,
    body: String,
}

impl Fence<'_> {
    /// Writes the file that this is, if it is one.
    fn write(&self, root: &Path) {
        if let Some((_, name)) = self.head.split_once(' ') {
            let path = root.join(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            fs::write(path, &self.body).expect("a file");
        }
    }

    /// The commands with what they print, if this has any.
    fn commands(&self) -> impl Iterator<Item = &str> {
        let blocks = self
            .body
            .strip_prefix("$ ")
            .unwrap_or_default()
            .split("\n$ ");
        blocks.filter(|_| self.head == "console")
    }
}

struct Part<'d> {
    heading: &'d str,
    fences: Vec<Fence<'d>>,
}

/// The fences before the first heading, and the headings with theirs.
fn parts(document: &str) -> (Vec<Fence<'_>>, Vec<Part<'_>>) {
    let mut setup = vec![];
    let mut parts: Vec<Part<'_>> = vec![];
    let mut open: Option<Fence<'_>> = None;
    for line in document.lines() {
        match &mut open {
            Some(_) if line == "```" => {
                let fences = parts.last_mut().map_or(&mut setup, |part| &mut part.fences);
                fences.extend(open.take());
            }
            Some(fence) => fence.body += &format!("{line}\n"),
            None => {
                if let Some(head) = line.strip_prefix("```") {
                    let body = String::new();
                    open = Some(Fence { head, body });
                } else if let Some(heading) = line.strip_prefix("## ") {
                    let fences = vec![];
                    parts.push(Part { heading, fences });
                }
            }
        }
    }
    assert!(open.is_none(), "a fence without its end: {document}");
    (setup, parts)
}

/// A command, and what it is to print.
#[derive(Debug, Default)]
struct Shown<'d> {
    command: &'d str,
    status: i32,
    out: Vec<&'d str>,
    err: Vec<&'d str>,
    nowhere: Vec<&'d str>,
}

impl<'d> Shown<'d> {
    fn of(block: &'d str) -> Self {
        let mut lines = block.lines();
        let mut shown = Self {
            command: lines.next().expect("a command"),
            ..Self::default()
        };
        for line in lines {
            match line.split_once(' ') {
                Some(("?", status)) => shown.status = status.parse().expect("a status"),
                Some(("2>", line)) => shown.err.push(line),
                Some(("!", words)) => shown.nowhere.push(words),
                _ => shown.out.push(line),
            }
        }
        shown
    }

    fn check(&self, root: &Path, program: &str, heading: &str) {
        let ended = ran(root, program, self.command);
        let texts = [&ended.stdout, &ended.stderr];
        let is_nowhere = |words: &&str| texts.iter().all(|text| !text.contains(*words));
        assert!(
            ended.status == Some(self.status)
                && fits(&self.out, &ended.stdout.lines().collect::<Vec<_>>())
                && fits(&self.err, &ended.stderr.lines().collect::<Vec<_>>())
                && self.nowhere.iter().all(is_nowhere),
            "{heading}\n{self:#?}\nended with {:?} and printed\n{}{}",
            ended.status,
            ended.stdout,
            ended.stderr
        );
    }
}

/// Whether lines are those that are shown.
fn fits(shown: &[&str], printed: &[&str]) -> bool {
    match (shown, printed) {
        ([], _) => printed.is_empty(),
        (["...", rest @ ..], _) => (0..=printed.len()).any(|end| fits(rest, &printed[end..])),
        ([line, rest @ ..], [found, below @ ..]) => is_line(line, found) && fits(rest, below),
        _ => false,
    }
}

fn is_line(shown: &str, found: &str) -> bool {
    let Some((start, rest)) = shown.split_once("[..]") else {
        return shown == found;
    };
    found.strip_prefix(start).is_some_and(|below| {
        let mut ends = below.char_indices().map(|(end, _)| end);
        ends.any(|end| is_line(rest, &below[end..])) || is_line(rest, "")
    })
}

/// How a command line ends.
fn ran(root: &Path, program: &str, line: &str) -> Ended {
    let quoted = line.split('\'').enumerate();
    let words = quoted.flat_map(|(place, part)| match place % 2 {
        0 => part.split_whitespace().collect(),
        _ => vec![part],
    });
    let words: Vec<&str> = words.collect();
    let (words, input) = match words[..] {
        [ref words @ .., "<", file] => (words, fs::File::open(root.join(file)).expect(file).into()),
        _ => (&words[..], Stdio::null()),
    };
    let variables = words.iter().map_while(|word| word.split_once('='));
    let words = &words[variables.clone().count()..];
    let read = |file: &str| fs::read_to_string(root.join(file)).expect(file);
    let mut stdout = String::new();
    let mut status = 0;
    match *words {
        ["cat", file] => stdout = read(file),
        ["cp", from, to] => drop(fs::copy(root.join(from), root.join(to)).expect(from)),
        ["rm", file] => fs::remove_file(root.join(file)).expect(file),
        ["same", one, other] => status = i32::from(read(one) != read(other)),
        ["ls", folder] => stdout = list(&root.join(folder)),
        ["sed", change, file] => {
            let change = change.replace("\\n", "\n");
            let parts: Vec<&str> = change.split('|').collect();
            assert!(read(file).contains(parts[1]), "{line}: {}", read(file));
            fs::write(root.join(file), read(file).replace(parts[1], parts[2])).expect(file);
        }
        _ => {
            let is_program = Path::new(program).file_stem() == Some(words[0].as_ref());
            let mut command = Command::new(if is_program { program } else { words[0] });
            for name in ["GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY"] {
                command.env_remove(name);
            }
            command.env("PATH", path_with(Path::new(program)));
            command.args(&words[1..]).envs(variables).current_dir(root);
            command
                .stdin(input)
                .stdout(Stdio::piped())
                .stderr(Stdio::piped());
            return finished(command.spawn().expect(program)).into();
        }
    }
    Ended {
        status: Some(status),
        stdout,
        stderr: String::new(),
    }
}

/// The variable PATH, on which programs next to this one are found.
fn path_with(program: &Path) -> OsString {
    let others = env::var_os("PATH").unwrap_or_default();
    let own = program.parent().map(Path::to_owned);
    env::join_paths(own.into_iter().chain(env::split_paths(&others))).expect("a PATH")
}

/// The files below a folder, if there is one.
fn list(folder: &Path) -> String {
    let files = folder.is_dir().then(|| files_below(folder));
    let mut names: Vec<String> = files
        .into_iter()
        .flatten()
        .map(|path| {
            path.strip_prefix(folder)
                .expect("below")
                .display()
                .to_string()
                + "\n"
        })
        .collect();
    names.sort();
    names.concat().replace('\\', "/")
}
