//! Tests on cases drawn at random, with the seed in `.cargo/config.toml`: the same cases at every
//! run.
//!
//! A case that fails is kept in `proptest-regressions`, and tried first from then on.

use proptest::prelude::*;
use proptest::test_runner::Config;
use thermobeam::mesh::Mesh;

/// * `cases`: their number, which `PROPTEST_CASES` raises.
pub(crate) fn at_least(cases: u32) -> Config {
    let config = Config::default();
    let more = std::env::var_os("PROPTEST_CASES").map_or(0, |_| config.cases);
    Config {
        cases: cases.max(more),
        ..config
    }
}

/// Elements whose lengths differ by factors up to 1000, also between neighbours.
pub(crate) fn mesh(most: usize) -> impl Strategy<Value = Mesh> {
    prop::collection::vec(-3.0..0.0, 1..=most).prop_map(|logs: Vec<f64>| {
        let lengths: Vec<f64> = logs.iter().map(|log| 10f64.powf(*log)).collect();
        let total: f64 = lengths.iter().sum();
        let mut nodes = vec![0.0];
        nodes.extend(lengths.iter().scan(0.0, |x, h| {
            *x += h / total;
            Some(*x)
        }));
        nodes[lengths.len()] = 1.0;
        Mesh::from_nodes(nodes).expect("lengths of a thousandth at least")
    })
}
