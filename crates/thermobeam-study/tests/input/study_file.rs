use convergence_study::input;
use convergence_study::study::{Axis, Described, FromFile as _, Header, Kind as _, Tier};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{EULER_CRANK_NICOLSON, MIDPOINT};
use thermobeam::solve::{Settings, Solver, Stopping};
use thermobeam_study::exact::norm::Norm;
use thermobeam_study::kinds::convergence::Convergence;
use thermobeam_study::kinds::tables::Perturbation;
use thermobeam_study::scene::Coefficients;

use super::says;

const STUDY: &str = "[study]\nid = \"a-1.2\"\nclaim = \"first order\"\ntier = \"quick\"\n";
const EXACT: &str = "[exact]\nu = [{ x = \"sin(x)\", t = \"cos(t)\" }]\n";
const REFINE: &str =
    "[refine]\naxis = \"space\"\nisolate = true\nelements = [4, 8]\nsteps = 20\nt_end = 1.0\n";
const EXPECT: &str = "[[expect]]\nnorm = \"velocity\"\norder = 2\ntolerance = 0.05\n";

#[track_caller]
fn described(parts: &[&str]) -> Described<Convergence> {
    Described::parse(&parts.concat(), "s.toml".as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn spec(parts: &[&str]) -> Convergence {
    described(parts).kind
}

#[track_caller]
fn refusal(parts: &[&str]) -> String {
    let text = parts.concat();
    let message = Convergence::parse(&text, "s.toml".as_ref())
        .expect_err(&text)
        .to_string();
    assert!((1..=3).contains(&message.lines().count()), "{message}");
    message
}

fn refine(lines: &str) -> String {
    format!("[refine]\nt_end = 1.0\n{lines}\n")
}

#[test]
fn the_contracts_example_is_a_study() {
    let Described { header, kind: spec } = described(&[r#"
        [study]
        id = "theorem-3.4-space"
        claim = "Theorem 3.4: first order in h"
        tier = "quick"
        [beam]
        beta = 0.5
        [obstacles]
        epsilon = 0.01
        [exact]
        u     = [{ x = "0.3*sin(1.3*pi*x)", t = "cos(3*t) + 0.2*t" }]
        phi   = [{ x = "0.4*x*exp(-x)", t = "sin(2*t) + 0.5" }, { x = "x", t = "1" }]
        theta = [{ x = "(1+x)*sin(pi*x)", t = "exp(-t)" }]
        [refine]
        axis = "space"
        isolate = true
        elements = [8, 16, 32, 64]
        steps = 20
        t_end = 1.0
        map = "s"
        scheme = "midpoint"
        solver = "fixed-point"
        tolerance = 1e-9
        max_iterations = 9
        [control]
        zeta = 0.101
        g2 = 0.2
        [[expect]]
        norm = "theorem-3.4"
        order = 1.0
        tolerance = 0.05
        [[expect]]
        norm = "superclose"
        order = 2
        tolerance = 0.1
        "#]);
    assert_eq!(
        (header.id.as_str(), header.tier),
        ("theorem-3.4-space", Tier::Quick)
    );
    assert_eq!(header.claim, "Theorem 3.4: first order in h");
    assert_eq!(
        spec.theory.beam,
        Beam {
            beta: 0.5,
            ..Beam::default()
        }
    );
    assert_eq!(
        spec.theory.obstacles,
        Some(Obstacles {
            epsilon: 0.01,
            ..Obstacles::default()
        })
    );
    assert_eq!(
        [
            spec.exact.u.len(),
            spec.exact.phi.len(),
            spec.exact.theta.len()
        ],
        [1, 2, 1]
    );
    assert_eq!(spec.exact.u[0].t.eval(0.5), 1.5_f64.cos() + 0.2 * 0.5);
    assert_eq!(spec.refine.cases(), [(8, 20), (16, 20), (32, 20), (64, 20)]);
    assert_eq!(
        (spec.refine.axis, spec.refine.isolate, spec.refine.scheme),
        (Axis::Space, true, MIDPOINT)
    );
    assert_eq!(
        spec.refine.settings,
        Settings {
            solver: Solver::FixedPoint,
            stopping: Stopping::Converged {
                tolerance: 1e-9,
                max_iterations: 9
            },
            ..Settings::default()
        }
    );
    assert!(
        spec.details()[0]
            .1
            .contains("differs from the sources in zeta, g2:")
    );
    assert_eq!(
        spec.solver.beam,
        Beam {
            zeta: 0.101,
            ..spec.theory.beam
        }
    );
    assert_eq!(
        spec.solver.obstacles.map(|o| (o.epsilon, o.g2)),
        Some((0.01, 0.2))
    );
    let expected: Vec<_> = spec
        .expect
        .iter()
        .map(|e| (e.0, e.1.order, e.1.tolerance))
        .collect();
    assert_eq!(
        expected,
        [(Norm::Theorem34, 1.0, 0.05), (Norm::Superclose, 2.0, 0.1)]
    );
}

#[test]
fn without_a_control_the_solver_has_the_coefficients_of_the_sources() {
    let spec = spec(&[STUDY, "[beam]\nzeta = 0.3\n", EXACT, REFINE, EXPECT]);
    assert_eq!(
        spec.solver,
        Coefficients {
            beam: Beam {
                zeta: 0.3,
                ..Beam::default()
            },
            obstacles: None
        }
    );
    assert_eq!(
        (spec.refine.scheme, spec.refine.settings),
        (EULER_CRANK_NICOLSON, Settings::default())
    );
}

#[test]
fn the_norms_have_the_names_of_the_contract_in_its_order() {
    let names = Norm::ALL.map(Norm::name);
    let contract = [
        "velocity",
        "shear",
        "rotation-rate",
        "curvature",
        "temperature",
        "theorem-3.4",
        "displacement",
    ];
    assert_eq!(names[..7], contract);
    assert_eq!(names[7], "superclose");
}

#[test]
fn levels_run_in_pairs_or_over_the_grid() {
    let cases = |lines: &str| spec(&[STUDY, EXACT, &refine(lines), EXPECT]).refine.cases();
    assert_eq!(
        cases("axis = \"time\"\nelements = 8\nsteps = [5, 10]"),
        [(8, 5), (8, 10)]
    );
    assert_eq!(
        cases("axis = \"both\"\nelements = [4, 8]\nsteps = [5, 10]"),
        [(4, 5), (8, 10)]
    );
    let grid = cases("axis = \"both\"\ngrid = true\nelements = [4, 8]\nsteps = [5, 10]");
    assert_eq!(grid, [(4, 5), (4, 10), (8, 5), (8, 10)]);
    assert_eq!(
        cases("axis = \"both\"\ngrid = true\nelements = [4, 8, 16]\nsteps = [5]").len(),
        3
    );
}

#[test]
fn a_perturbed_mesh_is_the_same_every_time_and_different_for_every_seed_and_level() {
    let nodes = |lines: &str, elements: usize| {
        let lines = format!("axis = \"space\"\nelements = [4]\nsteps = 2\n{lines}");
        let mesh = spec(&[STUDY, EXACT, &refine(&lines), EXPECT])
            .refine
            .layout
            .mesh(elements)
            .expect("a mesh");
        mesh.nodes().to_vec()
    };
    let first = nodes("perturb = 0.3\nseed = 1", 64);
    assert_eq!(first, nodes("perturb = 0.3\nseed = 1", 64));
    assert_ne!(first, nodes("perturb = 0.3\nseed = 2", 64));
    assert_eq!(nodes("perturb = 0.0", 64), nodes("", 64));
    let moves = |nodes: &[f64]| -> Vec<f64> {
        let n = (nodes.len() - 1) as f64;
        nodes
            .iter()
            .enumerate()
            .map(|(i, x)| x * n - i as f64)
            .collect()
    };
    let coarse = moves(&first);
    // At most 0.3 h / 2, and unbiased: 63 numbers of standard deviation 0.15 / sqrt(3).
    assert!(
        coarse.iter().all(|m| m.abs() <= 0.15 + 1e-13) && coarse.iter().any(|m| m.abs() > 0.12)
    );
    assert!((coarse.iter().sum::<f64>() / 63.0).abs() < 4.0 * 0.15 / (3.0f64 * 63.0).sqrt());
    let fine = moves(&nodes("perturb = 0.3\nseed = 1", 128));
    assert!(
        (1..64)
            .all(|i| (coarse[i] - fine[2 * i]).abs() > 1e-6 && (coarse[i] - fine[i]).abs() > 1e-6)
    );
}

#[test]
fn a_random_mesh_is_displaced_before_it_is_mapped() {
    let lines = "axis = \"space\"\nelements = [4]\nsteps = 2\nperturb = 0.9\nseed = 5";
    let flat = spec(&[STUDY, EXACT, &refine(lines), EXPECT])
        .refine
        .layout
        .mesh(32)
        .expect("a mesh");
    let lines = format!("{lines}\nmap = \"s^2\"");
    let graded = spec(&[STUDY, EXACT, &refine(&lines), EXPECT])
        .refine
        .layout
        .mesh(32)
        .expect("a mesh");
    assert!(
        flat.nodes()
            .iter()
            .zip(graded.nodes())
            .all(|(s, x)| (s.powi(2) - x).abs() <= f64::EPSILON)
    );
}

#[test]
fn a_wrong_header_is_named() {
    for (text, pieces) in [
        (
            "",
            &["s.toml:1:1: study: missing; expected a table with id, claim and tier"][..],
        ),
        (
            "[study]",
            &["1:1: study.id: missing; expected 1 to 100 lowercase letters, digits"],
        ),
        (
            "[study]\nid = \"A b\"",
            &["2:6: study.id: found the text \"A b\"; expected 1 to 100 lowercase letters"],
        ),
        (
            "[study]\nid = \"\"",
            &["2:6: study.id: found the text \"\""],
        ),
        (
            "[study]\nid = 3",
            &["2:6: study.id: found 3; expected a text"],
        ),
        (
            "[study]\nid = \"a\"",
            &["1:1: study.claim: missing; expected one line of text without control characters"],
        ),
        (
            "[study]\nid = \"a\"\nclaim = \" \"",
            &["3:9: study.claim: found the text \" \""],
        ),
        (
            "[study]\nid = \"a\"\nclaim = \"b\"",
            &["study.tier: missing; expected \"quick\" or \"full\""],
        ),
        (
            "[study]\nid = \"a\"\nclaim = \"b\"\ntier = \"fast\"",
            &["study.tier: found the text \"fast\"", "\"quick\", \"full\""],
        ),
        (
            "[study]\nname = \"a\"",
            &["2:1: study.name: unknown key `name`; expected id, claim, tier, kind"],
        ),
    ] {
        says(
            &input::parse(text, "s.toml", Header::from_document)
                .expect_err(text)
                .to_string(),
            pieces,
        );
        says(&refusal(&[text]), pieces);
    }
}

#[test]
fn the_header_of_any_kind_is_read_without_the_rest() {
    let text = [STUDY, "kind = \"energy\"\n[anything]\nelse = 1"].concat();
    let found = input::parse(&text, "s.toml", Header::from_document).expect("a header");
    assert_eq!(
        (found.id.as_str(), found.kind.as_str(), found.tier),
        ("a-1.2", "energy", Tier::Quick)
    );
    says(
        &refusal(&[&text]),
        &["5:8: study.kind: found \"energy\"; expected \"convergence\""],
    );
    assert_eq!(
        input::parse(STUDY, "s.toml", Header::from_document)
            .expect("a header")
            .kind,
        "convergence"
    );
}

#[test]
fn a_missing_table_or_an_unknown_one_is_named() {
    says(
        &refusal(&[STUDY, EXACT, EXPECT]),
        &["s.toml:1:1: refine: missing; expected a table with axis"],
    );
    says(
        &refusal(&[STUDY, REFINE, EXPECT]),
        &["1:1: exact: missing; expected a table with at least one of u, phi"],
    );
    says(
        &refusal(&[STUDY, EXACT, REFINE]),
        &["1:1: expect: missing; expected at least one table [[expect]]"],
    );
    says(
        &refusal(&[STUDY, "[expects]\n"]),
        &["5:2: expects: unknown key `expects`, did you mean `expect`?"],
    );
    says(
        &refusal(&[STUDY, "[beam]\nzeta = -1\n"]),
        &["6:8: beam.zeta: found -1"],
    );
    says(
        &refusal(&[STUDY, "[obstacles]\ng2 = -1\n"]),
        &["6:6: obstacles.g2: found -1"],
    );
}

#[test]
fn an_exact_solution_that_breaks_a_rule_is_named() {
    for (line, pieces) in [
        (
            "",
            &["exact: found an empty table; expected a table with at least one of u, phi, theta"][..],
        ),
        (
            "v = []",
            &["6:1: exact.v: unknown key `v`; expected u, phi, theta"],
        ),
        (
            "u = []",
            &["6:5: exact.u: found the list []; expected a list of at least one { x ="],
        ),
        (
            "u = \"x\"",
            &["exact.u: found the text \"x\"; expected a list"],
        ),
        (
            "u = [\"x\"]",
            &["exact.u[0]: found the text \"x\"; expected a table"],
        ),
        (
            "u = [{ x = \"x\" }]",
            &["6:6: exact.u[0].t: missing; expected a function of t in quotes"],
        ),
        (
            "u = [{ x = \"x\", t = \"x\" }]",
            &["6:22: exact.u[0].t: unknown name `x`; expected one of t pi e"],
        ),
        (
            "u = [{ x = \"x\", t = \"1\", s = 1 }]",
            &["exact.u[0].s: unknown key `s`; expected x, t"],
        ),
        (
            "u = [{ x = \"x\", t = \"1\" }, { x = \"1+x\", t = \"1\" }]",
            &["6:34: exact.u[1].x: found 1.0 at x = 0; expected 0"],
        ),
        (
            "phi = [{ x = \"cos(x)\", t = \"1\" }]",
            &["6:14: exact.phi[0].x: found 1.0 at x = 0"],
        ),
        (
            "u = [{ x = \"x^1.5\", t = \"1\" }]",
            &["exact.u[0].x: the second derivative is inf at x = 0"],
        ),
        (
            "u = [{ x = \"x\", t = \"1/(1-2*t)\" }]",
            &["exact.u[0].t: the value is inf at t = 0.5"],
        ),
        (
            "theta = [{ x = \"x\", t = \"t\" }]",
            &[
                "6:9: exact.theta: found theta = ",
                "at x = 1",
                "0 at x = 1 at all times",
            ],
        ),
        (
            "theta = [{ x = \"1-x\", t = \"1\" }]",
            &[
                "exact.theta: found theta = 1.0 at x = 0, t = 0.0",
                "theta = 0.0",
            ],
        ),
    ] {
        says(
            &refusal(&[STUDY, "[exact]\n", line, "\n", REFINE, EXPECT]),
            pieces,
        );
    }
    let hot = "[beam]\ntheta_a = 2\n";
    says(
        &refusal(&[STUDY, hot, EXACT, REFINE, EXPECT]),
        &["exact.theta: found theta = 0.0 at x = 0", "beam.theta_a"],
    );
}

#[test]
fn the_temperature_counts_as_a_sum_and_up_to_round_off() {
    let hot = "[beam]\ntheta_a = 2\n";
    let theta = r#"[exact]
        theta = [{ x = "1-x", t = "2+sin(30*t)" }, { x = "cos(pi*x/2)", t = "-sin(30*t)" }, { x = "sin(9*pi*x)", t = "1e6*t" }]
        "#;
    assert_eq!(
        spec(&[STUDY, hot, theta, REFINE, EXPECT]).exact.theta.len(),
        3
    );
}

#[test]
fn a_refinement_that_breaks_a_rule_is_named() {
    let space = "axis = \"space\"\nelements = [4, 8]\nsteps = 2\n";
    for (lines, pieces) in [
        (
            "",
            &["refine.axis: missing; expected \"space\", \"time\", \"both\""][..],
        ),
        (
            "axis = \"h\"",
            &["refine.axis: found the text \"h\"; expected \"space\", \"time\", \"both\""],
        ),
        (
            "axis = \"space\"\nsteps = 2",
            &["refine.elements: missing; expected a list of increasing whole numbers"],
        ),
        (
            "axis = \"space\"\nelements = 4\nsteps = 2",
            &[
                "refine.elements: found 4; expected a list",
                "axis = \"space\"",
            ],
        ),
        (
            "axis = \"space\"\nelements = []\nsteps = 2",
            &["refine.elements: found the list []; expected a list"],
        ),
        (
            "axis = \"space\"\nelements = [4, 4]\nsteps = 2",
            &["refine.elements[1]: found 4; expected a whole number > 4"],
        ),
        (
            "axis = \"space\"\nelements = [8, 4]\nsteps = 2",
            &["refine.elements[1]: found 4; expected a whole number > 8"],
        ),
        (
            "axis = \"space\"\nelements = [0, 4]\nsteps = 2",
            &["refine.elements[0]: found 0; expected a whole number >= 1"],
        ),
        (
            "axis = \"space\"\nelements = [4, 1000000000]\nsteps = 2",
            &["refine.elements[1]: found 1000000000", "465.7 GiB"],
        ),
        (
            "axis = \"space\"\nelements = [4]\nsteps = [2]",
            &["refine.steps: found the list [2]; expected a single whole"],
        ),
        (
            "axis = \"space\"\nelements = [4]\nsteps = 0",
            &["refine.steps: found 0; expected a whole number >= 1"],
        ),
        (
            "axis = \"time\"\nelements = [4]\nsteps = [2]",
            &["refine.elements: found the list [4]; expected a single"],
        ),
        (
            "axis = \"time\"\nelements = 4\nsteps = [2, 20000000000]",
            &["refine.steps[1]: found 20000000000", "<= 10000000000"],
        ),
        (
            "axis = \"both\"\nelements = [4]\nsteps = [2, 4]",
            &[
                "refine.steps: found 2 numbers of steps for 1",
                "grid = true",
            ],
        ),
        (
            "axis = \"both\"\nisolate = true\nelements = [4]\nsteps = [2]",
            &["refine.isolate: found true; expected false"],
        ),
    ] {
        says(&refusal(&[STUDY, EXACT, &refine(lines), EXPECT]), pieces);
    }
    for (line, pieces) in [
        (
            "grid = true",
            &["refine.grid: found true; expected true only where the axis is \"both\""][..],
        ),
        (
            "isolate = 1",
            &["refine.isolate: found 1; expected true or false"],
        ),
        (
            "perturb = 1",
            &["refine.perturb: found 1; expected a number >= 0 and < 1"],
        ),
        (
            "seed = 1",
            &["refine.seed: found 1 without perturb; expected perturb beside it"],
        ),
        (
            "perturb = 0.1\nseed = -1",
            &["refine.seed: found -1; expected a whole number >= 0"],
        ),
        (
            "map = \"1-s\"",
            &["refine.map: found 1.0 at s = 0; expected a map that takes 0 to 0"],
        ),
        (
            "map = \"s+0.9*sin(2*pi*s)\"",
            &[
                "refine.map: found nodes ",
                "expected a map that increases strictly",
            ],
        ),
        (
            "scheme = \"leapfrog\"",
            &["refine.scheme: found the text \"leapfrog\"; expected \"euler-crank-nicolson\""],
        ),
        (
            "level = 1",
            &[
                "refine.level: unknown key `level`; expected axis, isolate, elements, steps, grid, t_end",
            ],
        ),
    ] {
        says(
            &refusal(&[STUDY, EXACT, &refine(&format!("{space}{line}")), EXPECT]),
            pieces,
        );
    }
    says(
        &refusal(&[STUDY, EXACT, "[refine]\n", space, EXPECT]),
        &["refine.t_end: missing; expected a finite number > 0"],
    );
    let seeded = spec(&[
        STUDY,
        EXACT,
        &refine(&format!("{space}perturb = 0.5")),
        EXPECT,
    ]);
    assert_eq!(
        seeded.refine.layout.perturbation,
        Some(Perturbation {
            amount: 0.5,
            seed: 0
        })
    );
}

#[test]
fn a_control_that_controls_nothing_is_refused() {
    for (control, pieces) in [
        (
            "[control]\n",
            &["control: found an empty table; expected a table that changes at least one"][..],
        ),
        (
            "[control]\nzeta = 0.1\n",
            &["control.zeta: found 0.1, which is the value of the sources; expected another"],
        ),
        (
            "[control]\nepsilon = 0.1\n",
            &["control.epsilon: found 0.1 without a table [obstacles]; expected zeta, a,"],
        ),
        (
            "[control]\nzeta = -1\n",
            &["control.zeta: found -1; expected a finite number >= 0"],
        ),
        (
            "[obstacles]\n[control]\nepsilon = -1\n",
            &["control.epsilon: found -1; expected a finite number > 0"],
        ),
        (
            "[control]\nthetaa = 1\n",
            &["control.thetaa: unknown key `thetaa`, did you mean `theta_a`?"],
        ),
    ] {
        says(&refusal(&[STUDY, EXACT, REFINE, control, EXPECT]), pieces);
    }
}

#[test]
fn an_expectation_that_breaks_a_rule_is_named() {
    for (expect, pieces) in [
        (
            "expect = []\n",
            &["1:10: expect: found the list []; expected at least one table [[expect]]"][..],
        ),
        (
            "expect = 1\n",
            &["1:10: expect: found 1; expected at least one table [[expect]]"],
        ),
        (
            "expect = [{}]\n",
            &["expect[0].norm: missing; expected \"velocity\", \"shear\""],
        ),
        (
            "expect = [{ norm = \"veloctiy\" }]\n",
            &["expect[0].norm: found the text \"veloctiy\" (did you mean \"velocity\"?)"],
        ),
        (
            "expect = [{ norm = \"shear\" }]\n",
            &["expect[0].order: missing; expected a number > 0, or a text such as"],
        ),
        (
            "expect = [{ norm = \"shear\", order = 0 }]\n",
            &["expect[0].order: found 0; expected a finite number > 0"],
        ),
        (
            "expect = [{ norm = \"shear\", order = 1 }]\n",
            &["expect[0].tolerance: missing"],
        ),
        (
            "expect = [{ norm = \"shear\", rate = 1 }]\n",
            &["expect[0].rate: unknown key `rate`; expected norm, order"],
        ),
    ] {
        says(&refusal(&[expect, STUDY, EXACT, REFINE]), pieces);
    }
    let twice = refusal(&[STUDY, EXACT, REFINE, EXPECT, EXPECT]);
    says(
        &twice,
        &["s.toml:18:8: expect[1].norm: found \"velocity\" a second time; expected each norm once"],
    );
}
