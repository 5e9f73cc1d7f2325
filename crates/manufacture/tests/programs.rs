//! Programs beside emitted files, built and run.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use foreign_tools::Tool;
use manufacture::{EmittedFile, Language};
use tempfile::TempDir;

/// What the values of a language need.
pub(crate) fn tools(language: Language) -> &'static [Tool] {
    match language {
        Language::C => &[foreign_tools::C],
        Language::Fortran => &[foreign_tools::FORTRAN],
        Language::Octave => &[foreign_tools::OCTAVE],
        Language::Python => &[foreign_tools::NUMPY],
        Language::Rust => &[foreign_tools::LINKER],
        Language::Ufl => &[foreign_tools::PYTHON],
    }
}

/// The languages that can be tried on this machine.
pub(crate) fn languages() -> impl Iterator<Item = Language> {
    let all = Language::ALL.into_iter().map(|(_, language)| language);
    all.filter(|language| foreign_tools::are_here(tools(*language)))
}

/// Runs a command line in a folder, with this variant.
pub(crate) fn run(line: &str, folder: &Path, variant: &str) -> Output {
    let mut words = line.split(' ');
    Command::new(words.next().unwrap_or_default())
        .args(words)
        .env("MANUFACTURE_VARIANT", variant)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Emitted files in a folder of their own.
pub(crate) struct Module {
    name: String,
    pub(crate) folder: TempDir,
}

impl Module {
    pub(crate) fn new(name: &str, files: Vec<EmittedFile>) -> Self {
        let folder = TempDir::new().unwrap();
        for file in files {
            fs::write(folder.path().join(file.name), file.text).unwrap();
        }
        let name = name.to_owned();
        Self { name, folder }
    }

    /// What a command line with the module's name prints; it must end well and not complain.
    #[track_caller]
    pub(crate) fn prints(&self, line: &str) -> String {
        let line = line.replace("NAME", &self.name);
        let Output {
            status,
            stdout,
            stderr,
        } = run(&line, self.folder.path(), "");
        let message = String::from_utf8_lossy(&stderr);
        assert!(status.success() && message.is_empty(), "{line}\n{message}");
        String::from_utf8(stdout).unwrap()
    }

    /// Builds a program beside the files; the command that runs it.
    pub(crate) fn built(&self, language: Language, program: &str) -> &'static str {
        let (ending, build, command) = match language {
            Language::C => (
                "c",
                "cc -std=c99 -O1 -o driver NAME.c driver.c -lm",
                "./driver",
            ),
            Language::Fortran => (
                "f90",
                "gfortran -O1 -o driver NAME.f90 driver.f90",
                "./driver",
            ),
            Language::Rust => (
                "rs",
                "rustc --edition 2021 -A warnings -o driver driver.rs",
                "./driver",
            ),
            Language::Octave => ("m", "", "octave --quiet --no-history driver.m"),
            Language::Python | Language::Ufl => ("py", "", "python3 -B driver.py"),
        };
        let file = self.folder.path().join(format!("driver.{ending}"));
        fs::write(file, program).unwrap();
        if !build.is_empty() {
            self.prints(build);
        }
        command
    }

    /// The numbers that a program prints.
    #[track_caller]
    pub(crate) fn numbers(&self, command: &str, variant: &str) -> Vec<f64> {
        let output = run(command, self.folder.path(), variant);
        assert!(output.status.success(), "{variant}: {output:?}");
        let text = String::from_utf8(output.stdout).unwrap();
        let words = text.split_whitespace();
        words.map(|word| word.parse().unwrap()).collect()
    }
}
