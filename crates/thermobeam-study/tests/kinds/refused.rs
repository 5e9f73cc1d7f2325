//! Study files with errors.

use convergence_study::KindRow;
use convergence_study_tests::says;
use thermobeam_study::kinds::KINDS;

use super::{file, text};

/// Files of the repository, a piece of their text and what stands in its place, and the words of
/// the message.
const REFUSED: [(&str, &str, &str, &str); 89] = [
    (
        "any-order-space.toml",
        "over = \"space\"",
        "over = \"mesh\"",
        "run.over",
    ),
    (
        "any-order-space.toml",
        "t_end = 0.3",
        "t_end = -0.3",
        "run.t_end",
    ),
    (
        "any-order-space.toml",
        "time_degree = 4",
        "time_degree = 6",
        "run.time_degree",
    ),
    (
        "any-order-space.toml",
        "degree = 1\n",
        "degree = 41\n",
        "degree",
    ),
    (
        "any-order-space.toml",
        "[16, 32, 64, 128, 256]",
        "[16, 32]",
        "elements",
    ),
    (
        "any-order-space.toml",
        "[16, 32, 64, 128, 256]",
        "[16, 64, 32]",
        "elements",
    ),
    (
        "any-order-space.toml",
        "tolerance = 0.01",
        "tolerance = 0",
        "tolerance",
    ),
    (
        "any-order-space.toml",
        "0.8*s + 0.2*s^2",
        "0.8*s",
        "run.map",
    ),
    (
        "any-order-time.toml",
        "degree = 3",
        "degree = 3\ntime_degree = 1",
        "time_degree",
    ),
    (
        "any-order-degree.toml",
        "factor = 5.0",
        "factor = 1.0",
        "factor",
    ),
    (
        "any-order-degree.toml",
        "factor = 5.0",
        "tolerance = 0.1",
        "tolerance",
    ),
    (
        "any-order-degree.toml",
        "[run]",
        "[control]\n[run]",
        "control",
    ),
    (
        "any-order-degree.toml",
        "[run]",
        "[control]\na = 0.5\n[run]",
        "control.a",
    ),
    (
        "any-order-degree.toml",
        "[run]",
        "[control]\nepsilon = 0.5\n[run]",
        "control.epsilon",
    ),
    (
        "any-order-vibration.toml",
        "modes = [1, 2, 5]",
        "modes = []",
        "vibration.modes",
    ),
    (
        "any-order-vibration.toml",
        "modes = [1, 2, 5]",
        "modes = [0]",
        "vibration.modes",
    ),
    (
        "any-order-vibration.toml",
        "zeta = 0.1",
        "zeta = -0.1",
        "vibration.zeta",
    ),
    (
        "any-order-vibration.toml",
        "[vibration]",
        "[beam]\na = 0.0\n[vibration]",
        "beam",
    ),
    (
        "extremes.toml",
        "name = \"hat\"",
        "name = \"velocity-step\"",
        "a name that no other case has",
    ),
    (
        "extremes.toml",
        "ends = \"indefinite\"",
        "ends = \"well\"",
        "ends",
    ),
    ("extremes.toml", "drift = 1e-11", "drift = 0", "drift"),
    ("extremes.toml", "zeta = 0.0", "zeta = -1.0", "beam.zeta"),
    (
        "corollary-3.2.toml",
        "beta = -0.5\nrho = 0.0",
        "beta = -0.72\nrho = 0.0",
        "beta > -0.7116",
    ),
    (
        "random-scenes-quick.toml",
        "batches = 2",
        "batches = 0",
        "random.batches",
    ),
    (
        "random-scenes-quick.toml",
        "[random]",
        "[[random-scenes]]",
        "random-scenes",
    ),
    (
        "random-scenes-quick.toml",
        "[random]",
        "[energy]\n[random]",
        "energy.scenes: missing",
    ),
    (
        "random-scenes-quick.toml",
        "[random]",
        "[[case]]\nname = \"a\"\nclaim = \"b\"\nends = \"answer\"\ntime = { dt = 1, t_end = 1 }\n[random]",
        "random: found a second table; expected one of the tables [energy]",
    ),
    (
        "energy-decay.toml",
        "tolerance = 1e-14",
        "tolerance = 0.0",
        "energy.tolerance",
    ),
    (
        "energy-decay.toml",
        "schemes = [\"euler-crank-nicolson\", \"midpoint\"]",
        "schemes = []",
        "energy.schemes",
    ),
    (
        "frequencies.toml",
        "[16, 32",
        "[32, 16",
        "frequencies.elements",
    ),
    ("frequencies.toml", "count = 8", "count = 17", "<= 16"),
    (
        "frequencies.toml",
        "order = 2.0",
        "order = -2.0",
        "frequencies.order",
    ),
    (
        "frequencies.toml",
        "count = 8",
        "count = 8\nfirst = 9",
        "frequencies.first",
    ),
    (
        "frequencies.toml",
        "count = 8",
        "count = 8\ndegree = 0",
        "frequencies.degree",
    ),
    (
        "frequencies.toml",
        "count = 8",
        "count = 8\ndegree = 41",
        "frequencies.degree",
    ),
    (
        "frequencies.toml",
        "count = 8",
        "count = 8\nmap = \"s^2 - 1\"",
        "frequencies.map",
    ),
    (
        "iterations.toml",
        "iterations_per_step = 4.3",
        "iterations = 4.3",
        "case[0].most.iterations: unknown key",
    ),
    (
        "iterations.toml",
        "iterations_per_step = 4.3",
        "iterations_per_step = 0",
        "case[0].most.iterations_per_step: found 0",
    ),
    (
        "iterations.toml",
        "iterations_per_step = 4.3\n",
        "",
        "case[0].most.iterations_per_step: missing",
    ),
    (
        "iterations.toml",
        "iterations_per_step = 2.0",
        "unsolved = 1.0",
        "case[3].most.unsolved: found a bound for dg",
    ),
    (
        "iterations.toml",
        "[case.most]\niterations_per_step = 4.3\n",
        "",
        "case[0].answer: missing",
    ),
    (
        "iterations.toml",
        "ends = \"answer\"",
        "ends = \"indefinite\"",
        "case[0].most: found bounds",
    ),
    (
        "whole-scenes.toml",
        "[case.answer]\nwithin",
        "[case.other]\nwithin",
        "case[0].other: unknown key",
    ),
    (
        "whole-scenes.toml",
        "within = 1e-9\n",
        "",
        "case[0].answer.within: missing",
    ),
    (
        "whole-scenes.toml",
        "u_tip = ",
        "utip = ",
        "case[0].answer.utip: unknown key",
    ),
    (
        "whole-scenes.toml",
        "ends = \"answer\"",
        "ends = \"indefinite\"",
        "case[0].answer: found an answer",
    ),
    (
        "whole-scenes.toml",
        "name = \"midpoint\"",
        "name = \"listed-nodes\"",
        "a second \"listed-nodes\"",
    ),
    (
        "whole-scenes.toml",
        "t_end = 1.0",
        "t_end = -1.0",
        "case[0].time.t_end: found -1.0",
    ),
    (
        "reference-space.toml",
        "[8, 16,",
        "[8, 20,",
        "a multiple of 8, the level before",
    ),
    (
        "reference-space.toml",
        "[8, 16, 32, 64, 128]",
        "[8, 16, 32, 64]",
        "as many as elements",
    ),
    (
        "reference-space.toml",
        "[200, 800,",
        "[400, 800,",
        "or by its square",
    ),
    (
        "reference-space.toml",
        "degree = 18",
        "degree = 24",
        "two tables [[reference]] that differ in elements",
    ),
    (
        "reference-space.toml",
        "growth = 1.5",
        "growth = 0.5",
        "growth",
    ),
    (
        "reference-space.toml",
        "degree = 18",
        "degree = 24",
        "two with the same degree",
    ),
    (
        "reference-space.toml",
        "\ndt = 0.006",
        "\ndt = 1e-20",
        "reference[1].dt: found 1e-20, which is",
    ),
    (
        "reference-space.toml",
        "\nelements = 2\n",
        "\nelements = 8000000\n",
        "reference[1].elements: found 8000000, which would take",
    ),
    (
        "reference-space.toml",
        "samples = 10",
        "samples = 7",
        "a multiple of samples = 7",
    ),
    (
        "reference-space.toml",
        "paper-1-beta-0",
        "paper-1-beta-00",
        "scene.file: found the text",
    ),
    (
        "reference-space.toml",
        "quantity = \"tip\"",
        "quantity = \"tips\"",
        "did you mean \"tip\"?",
    ),
    (
        "reference-space.toml",
        "axis = \"both\"",
        "axis = \"space\"",
        "refine.axis",
    ),
    (
        "reference-space.toml",
        "axis = \"both\"\nelements = [8, 16, 32, 64, 128]",
        "axis = \"time\"\nelements = 32",
        "of 32 elements of degree 1",
    ),
    (
        "reference-space.toml",
        "quantity = \"rotation\"",
        "quantity = \"tip\"",
        "found \"tip\" a second time",
    ),
    (
        "stability-coarse.toml",
        "over = \"epsilon\"",
        "over = \"rho\"",
        "map.over",
    ),
    (
        "stability-coarse.toml",
        "dt = [1e-6, 10.0]",
        "dt = [10.0, 1e-6]",
        "map.dt",
    ),
    (
        "stability-coarse.toml",
        "range = [1e-8, 10.0]",
        "range = [0.0, 10.0]",
        "map.range",
    ),
    (
        "stability-coarse.toml",
        "points = 12",
        "points = 1",
        "map.points",
    ),
    (
        "stability-coarse.toml",
        "lines = [1e-6, 1e-3]",
        "lines = []",
        "map.lines",
    ),
    (
        "stability-coarse.toml",
        "lines = [1e-6, 1e-3]",
        "lines = [0.0]",
        "map.lines[0]",
    ),
    (
        "stability-coarse.toml",
        "[map]",
        "[maps]",
        "did you mean `map`?",
    ),
    (
        "fixed-point.toml",
        "zeta = [0.01, 0.1, 1.0]",
        "zeta = [0.0]",
        "contraction.zeta[0]",
    ),
    (
        "fixed-point.toml",
        "zeta = [0.01, 0.1, 1.0]",
        "zeta = []",
        "contraction.zeta",
    ),
    (
        "fixed-point.toml",
        "steps = 3000",
        "steps = 0",
        "comparison.steps",
    ),
    (
        "fixed-point.toml",
        "paper-1-beta-0.toml",
        "paper-1-beta-00.toml",
        "comparison.scene",
    ),
    (
        "vibration-time.toml",
        "a = 0.0",
        "a = 0.1",
        "beam.a: found 0.1",
    ),
    (
        "vibration-time.toml",
        "rho = 0.0\n",
        "",
        "beam.rho: found 1.0",
    ),
    (
        "vibration-time.toml",
        "index = 2",
        "index = 17",
        "found 17; expected a whole number >= 1 and <= 16",
    ),
    (
        "vibration-time.toml",
        "amplitude = 0.1",
        "amplitude = 0.0",
        "a mode that does not move",
    ),
    (
        "vibration-time.toml",
        "[[mode]]",
        "[[modes]]",
        "unknown key `modes`, did you mean `mode`?",
    ),
    ("vibration-time.toml", "isolate", "isolated", "isolated"),
    (
        "vibration-time.toml",
        "zeta = 0.1",
        "zeta = -0.1",
        "beam.zeta",
    ),
    (
        "theorem-3.4-space.toml",
        "order = 1.0",
        "order = \"<= 1\"",
        "order … number > 0",
    ),
    (
        "theorem-3.4-space.toml",
        "order = 1.0",
        "order = \">= 0\"",
        "order … number > 0",
    ),
    (
        "theorem-3.4-space.toml",
        "order = 1.0",
        "order = \"1\"",
        "order … number > 0",
    ),
    (
        "theorem-3.4-space.toml",
        "order = 1.0",
        "order = -1",
        "order … number > 0",
    ),
    (
        "theorem-3.4-space.toml",
        "order = 1.0",
        "order = 1.0\nconstant = [2.0, 1.0]",
        "constant … the smaller first",
    ),
    (
        "theorem-3.4-space.toml",
        "order = 1.0",
        "order = 1.0\nconstant = [1.0, 2.0, 3.0]",
        "constant: found the list [1.0, 2.0, 3.0]; expected two numbers",
    ),
    (
        "stability-h.toml",
        "dt = [1e-6, 10.0]",
        "dt = [1e-6, 10.0, 20.0]",
        "dt: found the list [1e-6, 10.0, 20.0]",
    ),
    (
        "theorem-3.4-space.toml",
        "isolate = true",
        "isolate = false",
        "constant: found a study whose constant is not known",
    ),
    (
        "theorem-3.4-space.toml",
        "isolate = true",
        "isolate = true\nmap = \"s^2\"",
        "constant: found a study whose constant is not known",
    ),
];

#[test]
fn a_study_file_with_an_error_is_refused_with_the_field() {
    for (name, from, to, words) in REFUSED {
        let sound = text(name);
        let changed = sound.replacen(from, to, 1);
        assert_ne!(changed, sound, "{name} has no {from}");
        let read = KindRow::parse_any(&KINDS, &changed, &file("changed.toml"));
        let message = read
            .err()
            .unwrap_or_else(|| panic!("{name} with {to} is read"));
        assert!(says(&message.to_string(), words), "{name}, {to}: {message}");
    }
}

#[test]
fn a_study_of_solvers_without_a_part_is_refused() {
    let empty = "[study]\nid = \"a\"\nclaim = \"b\"\ntier = \"quick\"\nkind = \"solvers\"\n";
    let message = KindRow::parse_any(&KINDS, empty, "a.toml".as_ref())
        .err()
        .expect("no part");
    assert!(
        says(&message.to_string(), "contraction, comparison, map"),
        "{message}"
    );
}
