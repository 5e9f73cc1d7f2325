//! `new study NAME`, `new scene NAME`, `new any-order-scene NAME`: a file to begin with.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use thermobeam_study::scene::template::{Template, is_name};

use convergence_study::cli::exit::{Ended, Outcome, Unusable};
use convergence_study::cli::flags::Flags;
use convergence_study::judge::verdict::Verdict;
use convergence_study::project::Project;
use convergence_study::store::atomic;
use convergence_study::text::visible;

/// Write a commented study or scene that runs as it is
#[derive(Debug, Args)]
pub struct Arguments {
    /// What to begin
    #[arg(value_enum)]
    what: What,
    /// Its name: small letters, digits, `.` and `-`
    #[arg(value_parser = name)]
    name: String,
    #[command(flatten)]
    flags: Flags,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum What {
    /// A convergence study with a manufactured solution
    Study,
    /// A scene: a beam, how it starts, a mesh, time steps
    Scene,
    /// The same by elements of high degree and dG(q), for many digits
    AnyOrderScene,
}

/// What `new --format json` prints beside the verdict.
#[derive(serde::Serialize)]
struct Object {
    wrote: String,
}

fn name(text: &str) -> Result<String, String> {
    if is_name(text) { Ok(text.to_owned()) } else { Err("expected small letters a-z, digits, `.` and `-`".to_owned()) }
}

/// Runs the command. A file that is there is never written over.
pub(crate) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let (template, command) = match arguments.what {
        What::Study => (Template::Study, "study"),
        What::Scene => (Template::Scene, "run"),
        What::AnyOrderScene => (Template::AnyOrderScene, "run"),
    };
    let file = format!("{}.toml", arguments.name);
    let flags = &arguments.flags;
    let path = flags.out.as_ref().map_or_else(|| PathBuf::from(&file), |folder| folder.join(&file));
    let unusable = |error: std::io::Error| match error.kind() {
        ErrorKind::AlreadyExists => Unusable::because(&format!(
            "{}: expected a new file, found one of that name; take another name, or remove the file first",
            visible::path(&path)
        )),
        _ => Unusable::file(&path, &error),
    };
    if let Some(folder) = &flags.out {
        atomic::prepare_folder(folder)?;
    }
    let mut file = OpenOptions::new().write(true).create_new(true).open(&path).map_err(unusable)?;
    file.write_all(template.text(&arguments.name, project.command).as_bytes()).map_err(unusable)?;
    let (path, program) = (path.display().to_string(), project.command);
    let mut text = format!("wrote {path}\nnow  {program} {command} {path}\n");
    if arguments.what == What::Study {
        text += &format!("and  {program} explain {path}\n");
    }
    let words = flags.words(Verdict::Pass, &format!("wrote {path}"), || text);
    flags.print(Verdict::Pass, &Object { wrote: path }, &words)?;
    Ok(Ended::Well)
}
