//! Tests on cases drawn at random, with the seed in `.cargo/config.toml`: the same cases at every
//! run.
//!
//! A case that fails is kept in `proptest-regressions`, and tried first from then on.

use proptest::test_runner::Config;

/// * `cases`: their number, which `PROPTEST_CASES` raises.
pub(crate) fn at_least(cases: u32) -> Config {
    let config = Config::default();
    let more = std::env::var_os("PROPTEST_CASES").map_or(0, |_| config.cases);
    Config {
        cases: cases.max(more),
        ..config
    }
}
