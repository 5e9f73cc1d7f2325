//! `new study NAME`, `new scene NAME`, `new any-order-scene NAME`: a file to begin with.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use thermobeam_study::scene::template::{Template, is_name};

use convergence_study::cli::exit::{Ended, Outcome, Unusable};
use convergence_study::cli::output;
use convergence_study::text::visible;

/// Write a commented study or scene that runs as it is
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// What to begin
    #[arg(value_enum)]
    what: What,
    /// Its name: small letters, digits, `.` and `-`
    #[arg(value_parser = name)]
    name: String,
    /// The folder for NAME.toml, which must exist; default: the current one
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
    /// Say nothing where all is well
    #[arg(long, short)]
    quiet: bool,
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

fn name(text: &str) -> Result<String, String> {
    if is_name(text) { Ok(text.to_owned()) } else { Err("expected small letters a-z, digits, `.` and `-`".to_owned()) }
}

/// Runs the command. A file that is there is never written over.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let (template, command) = match arguments.what {
        What::Study => (Template::Study, "study"),
        What::Scene => (Template::Scene, "run"),
        What::AnyOrderScene => (Template::AnyOrderScene, "run"),
    };
    let file = format!("{}.toml", arguments.name);
    let path = arguments.dir.as_ref().map_or_else(|| PathBuf::from(&file), |folder| folder.join(&file));
    let unusable = |error: std::io::Error| match error.kind() {
        ErrorKind::AlreadyExists => Unusable::because(&format!(
            "{}: expected a new file, found one of that name; take another name, or remove the file first",
            visible::path(&path)
        )),
        _ => Unusable::file(&path, &error),
    };
    let mut file = OpenOptions::new().write(true).create_new(true).open(&path).map_err(unusable)?;
    file.write_all(template.text(&arguments.name).as_bytes()).map_err(unusable)?;
    if !arguments.quiet {
        let path = path.display();
        let mut text = format!("wrote {path}\nnow  cargo xtask {command} {path}\n");
        if arguments.what == What::Study {
            text += &format!("and  cargo xtask explain {path}\n");
        }
        output::print(&text)?;
    }
    Ok(Ended::Well)
}
