//! Studies of programs: this executable is the harness if `AS_PROJECT` is set, the solver if it is called as one, otherwise the tests.

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

/// Process groups exist only on Unix.
#[cfg(not(unix))]
fn main() {}
