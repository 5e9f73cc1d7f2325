//! Programs beside the Rust toolchain that some tests need: a shell, an interpreter, a compiler.
//!
//! `cargo test --workspace` passes on a machine that has Rust and a linker alone. A test that needs
//! more asks here first, and ends where something is missing:
//!
//! ```text
//! foreign_tools::needs!(NUMPY);
//! ```
//!
//! The line `not run: TEST: no Python with NumPy` then goes to standard error, past the capture of
//! the test's output. With `CONVERGENCE_REQUIRE_TOOLS=1`, as in continuous integration, the test
//! fails instead.

use std::io::Write;
use std::process::{Command, Stdio};

/// Ends a test where one of these programs is missing, as [`are_here`] says it.
#[macro_export]
macro_rules! needs {
    ($($tool:ident),+) => {
        if !$crate::are_here(&[$($crate::$tool),+]) {
            return;
        }
    };
}

/// The variable of the environment that turns a missing tool into a failure.
pub const REQUIRE: &str = "CONVERGENCE_REQUIRE_TOOLS";

/// A program that a test needs, and the command that succeeds where it can be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tool {
    /// What is missing, in the words of the message.
    pub name: &'static str,
    /// The command; what the test imports is imported by it.
    pub probe: &'static [&'static str],
}

/// The language awk.
pub const AWK: Tool = Tool {
    name: "awk",
    probe: &["awk", "BEGIN { exit 0 }"],
};
/// A C++ compiler.
pub const CPLUSPLUS: Tool = Tool {
    name: "c++",
    probe: &["c++", "--version"],
};
/// The shell bash.
pub const BASH: Tool = Tool {
    name: "bash",
    probe: &["bash", "-c", ":"],
};
/// Chromium, or a browser made of it, by one of the names of [`browser`].
pub const CHROMIUM: Tool = Tool {
    name: "Chromium",
    probe: &[
        "sh",
        "-c",
        "command -v chromium || command -v chromium-browser || command -v google-chrome",
    ],
};
/// A C compiler.
pub const C: Tool = Tool {
    name: "cc",
    probe: &["cc", "--version"],
};
/// `env`, which starts a program without signals ignored.
pub const ENV: Tool = Tool {
    name: "env",
    probe: &["env"],
};
/// A Fortran compiler.
pub const FORTRAN: Tool = Tool {
    name: "gfortran",
    probe: &["gfortran", "--version"],
};
/// Git.
pub const GIT: Tool = Tool {
    name: "git",
    probe: &["git", "--version"],
};
/// `kill`, which sends signals.
pub const KILL: Tool = Tool {
    name: "kill",
    probe: &["kill", "-l"],
};
/// A linker of the name that `rustc` calls when nothing else is set.
#[cfg(unix)]
pub const LINKER: Tool = C;
/// `rustc` brings the linker of this system.
#[cfg(not(unix))]
pub const LINKER: Tool = Tool {
    name: "rustc",
    probe: &["rustc", "--version"],
};
/// `mkfifo`, which makes a named pipe.
pub const MKFIFO: Tool = Tool {
    name: "mkfifo",
    probe: &["sh", "-c", "command -v mkfifo"],
};
/// Python 3 with NumPy.
pub const NUMPY: Tool = Tool {
    name: "Python with NumPy",
    probe: &["python3", "-c", "import numpy"],
};
/// The program of GNU Octave without windows.
pub const OCTAVE_CLI: Tool = Tool {
    name: "octave-cli",
    probe: &["octave-cli", "--version"],
};
/// GNU Octave.
pub const OCTAVE: Tool = Tool {
    name: "octave",
    probe: &["octave", "--version"],
};
/// Python 3 with its standard library.
pub const PYTHON: Tool = Tool {
    name: "Python",
    probe: &["python3", "-c", "import json, math"],
};
/// A POSIX shell.
pub const SHELL: Tool = Tool {
    name: "sh",
    probe: &["sh", "-c", ":"],
};
/// `touch`, which makes a file.
pub const TOUCH: Tool = Tool {
    name: "touch",
    probe: &["sh", "-c", "command -v touch"],
};
/// `timeout`, which ends a program that hangs.
pub const TIMEOUT: Tool = Tool {
    name: "timeout",
    probe: &["timeout", "--version"],
};

/// The name of the browser that [`CHROMIUM`] finds.
#[must_use]
pub fn browser() -> Option<String> {
    let output = Command::new(CHROMIUM.probe[0])
        .args(&CHROMIUM.probe[1..])
        .output();
    let text = String::from_utf8(output.ok()?.stdout).ok()?;
    let path = text.trim();
    (!path.is_empty()).then(|| path.to_owned())
}

/// Whether the tool can be used on this machine.
#[must_use]
pub fn is_here(tool: Tool) -> bool {
    let status = Command::new(tool.probe[0])
        .args(&tool.probe[1..])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    status.is_ok_and(|status| status.success())
}

/// Whether all tools of a test can be used; says on standard error what is not run otherwise.
///
/// # Panics
/// A tool is missing, and the environment has `CONVERGENCE_REQUIRE_TOOLS=1`.
#[must_use]
#[track_caller]
pub fn are_here(tools: &[Tool]) -> bool {
    let Some(missing) = first_missing(tools) else {
        return true;
    };
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    let is_required = std::env::var_os(REQUIRE).is_some_and(|value| value == "1");
    assert!(
        !is_required,
        "{REQUIRE}=1, and there is no {}",
        missing.name
    );
    // The harness of tests captures `eprintln!`, and shows it of a test that fails alone.
    let line = format!("not run: {test}: no {}\n", missing.name);
    let written = std::io::stderr().write_all(line.as_bytes());
    written.expect("standard error can be written");
    false
}

fn first_missing(tools: &[Tool]) -> Option<Tool> {
    tools.iter().copied().find(|tool| !is_here(*tool))
}

#[cfg(test)]
mod tests {
    use super::{Tool, are_here, first_missing, is_here};

    const ABSENT: Tool = Tool {
        name: "program of that name",
        probe: &["no-program-has-this-name"],
    };

    const FAILING: Tool = Tool {
        name: "rustc with that option",
        probe: &["rustc", "--no-such-option"],
    };

    const RUST: Tool = Tool {
        name: "rustc",
        probe: &["rustc", "--version"],
    };

    /// A program that starts and cannot import what a test needs is not here.
    #[test]
    fn a_tool_is_here_only_if_its_probe_succeeds() {
        assert!(is_here(RUST));
        assert!(!is_here(ABSENT));
        assert!(!is_here(FAILING));
    }

    #[test]
    fn one_missing_tool_is_enough_to_leave_a_test_out() {
        assert!(are_here(&[RUST]));
        assert_eq!(first_missing(&[RUST, ABSENT, FAILING]), Some(ABSENT));
    }
}
