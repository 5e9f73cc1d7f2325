//! Every beam is stepped by `run`: no other code calls a step of a motion, a simulation or lanes.

use std::fs;
use std::path::PathBuf;

use super::{code, files, root};

/// Crates above the solver, and their folders of sources.
const SOURCES: [&str; 3] = [
    "crates/thermobeam-study/src",
    "crates/thermobeam-cli/src",
    "xtask/src",
];

/// Files that call a step, with the number of calls.
const CALLS: [(&str, usize); 5] = [
    // The loop.
    ("run/mod.rs", 1),
    // The steps themselves: each method's own.
    ("run/driver.rs", 2),
    ("run/dg.rs", 1),
    // Several beams at once, in lanes.
    ("run/together.rs", 3),
    // Steps are timed without anything around them.
    ("bench/step_time.rs", 2),
];

/// Calls of what does steps. A `step` without a limit is that of two beams side by side, which
/// are stepped by `run`.
fn calls(code: &str) -> usize {
    let calls = |name: &str| {
        let method = code.matches(&format!(".{name}(")).count();
        let path = code.matches(&format!("::{name}(")).count();
        method + path
    };
    let all: usize = ["step", "step_once", "advance", "stepped"]
        .map(calls)
        .into_iter()
        .sum();
    all - code.matches(".step()").count()
}

#[test]
fn no_code_but_the_loop_steps_a_beam() {
    let sources: Vec<PathBuf> = SOURCES
        .iter()
        .flat_map(|folder| files(&root().join(folder), &["rs"]))
        .collect();
    assert!(sources.len() > 70, "{}", sources.len());
    let mut seen = 0;
    for path in sources {
        let text = fs::read_to_string(&path).expect("a source");
        let name = path.display().to_string().replace('\\', "/");
        let known = CALLS
            .iter()
            .find(|(file, _)| name.ends_with(&format!("src/{file}")));
        seen += usize::from(known.is_some());
        let expected = known.map_or(0, |(_, count)| *count);
        assert_eq!(calls(&code(&text)), expected, "calls of a step in {name}");
    }
    assert_eq!(seen, CALLS.len());
}

#[test]
fn a_call_of_a_step_is_found() {
    for (text, count) in [
        ("let report = motion.step(t_end)?;", 1),
        ("driver\n    .step(\n        until,\n    )", 1),
        ("Motion::step(&mut motion, 1.0)", 1),
        ("simulation.step_once()?; ensemble.step_once();", 2),
        ("let n = simulation.steps(); both.step()?;", 0),
        ("// motion.step(1.0)\nlet x = 1;", 0),
        (
            "fn f() {}\n#[cfg(test)]\nmod tests { fn g() { motion.step(1.0) } }",
            0,
        ),
    ] {
        assert_eq!(calls(&code(text)), count, "{text}");
    }
}
