//! The program that the studies of these tests run.

#[cfg(unix)]
mod differentiable;
#[cfg(unix)]
mod misbehaving;
#[cfg(unix)]
mod random;

/// Process groups exist only on Unix.
fn main() {
    #[cfg(unix)]
    misbehaving::main();
}
