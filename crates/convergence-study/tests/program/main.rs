//! Studies of programs: this executable is the harness where `AS_PROJECT` is set, the solver where it is called as one, else the tests.

#[cfg(unix)]
mod kept;
#[cfg(unix)]
mod levels;
#[cfg(unix)]
mod solver;
#[cfg(unix)]
mod tests;

#[cfg(unix)]
fn main() -> std::process::ExitCode {
    tests::main()
}

/// Process groups are those of Unix.
#[cfg(not(unix))]
fn main() {}
