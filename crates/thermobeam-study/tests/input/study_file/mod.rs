mod refused;

use convergence_study::{Described, Document, Header, RefinedIn, Tier};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{EULER_CRANK_NICOLSON, MIDPOINT};
use thermobeam::solve::{Settings, Solver, Stopping};
use thermobeam_study::exact::norm::Norm;
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::Convergence;
use thermobeam_study::scene::Coefficients;

const STUDY: &str = "[study]\nid = \"a-1.2\"\nclaim = \"first order\"\ntier = \"quick\"\n";

const EXACT: &str = "[exact]\nu = [{ x = \"sin(x)\", t = \"cos(t)\" }]\n";

const REFINE: &str =
    "[refine]\naxis = \"space\"\nisolate = true\nelements = [4, 8]\nsteps = 20\nt_end = 1.0\n";

const EXPECT: &str = "[[expect]]\nnorm = \"velocity\"\norder = 2\ntolerance = 0.05\n";

#[track_caller]
fn described(parts: &[&str]) -> Described<Orders<Convergence>> {
    Described::parse(&parts.concat(), "s.toml".as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn spec(parts: &[&str]) -> Orders<Convergence> {
    described(parts).kind
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
    let theory = Coefficients {
        beam: Beam {
            beta: 0.5,
            ..Beam::default()
        },
        obstacles: Some(Obstacles {
            epsilon: 0.01,
            ..Obstacles::default()
        }),
    };
    let mut solver = theory;
    solver.beam.zeta = 0.101;
    solver.obstacles.as_mut().unwrap().g2 = 0.2;
    assert_eq!([spec.theory, spec.solver], [theory, solver]);
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
        (RefinedIn::Space, true, MIDPOINT)
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

/// The nodes of a mesh, with these lines in `[refine]`.
fn nodes(lines: &str, elements: usize) -> Vec<f64> {
    let lines = refine(&format!(
        "axis = \"space\"\nelements = [4]\nsteps = 2\n{lines}"
    ));
    let spec = spec(&[STUDY, EXACT, &lines, EXPECT]);
    let mesh = spec.refine.layout.mesh(elements).expect("a mesh");
    mesh.nodes().to_vec()
}

#[test]
fn a_perturbed_mesh_is_the_same_every_time_and_different_for_every_seed_and_level() {
    let first = nodes("perturb = 0.3\nseed = 1", 64);
    assert_eq!(first, nodes("perturb = 0.3\nseed = 1", 64));
    assert_ne!(first, nodes("perturb = 0.3\nseed = 2", 64));
    assert_eq!(nodes("perturb = 0.0", 64), nodes("", 64));
    let moves = |nodes: &[f64]| -> Vec<f64> {
        let n = (nodes.len() - 1) as f64;
        let moved = nodes.iter().enumerate();
        moved.map(|(i, x)| x * n - i as f64).collect()
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
    let flat = nodes("perturb = 0.9\nseed = 5", 32);
    let graded = nodes("perturb = 0.9\nseed = 5\nmap = \"s^2\"", 32);
    let mut pairs = flat.iter().zip(&graded);
    assert!(pairs.all(|(s, x)| (s.powi(2) - x).abs() <= f64::EPSILON));
}

#[test]
fn the_header_of_any_kind_is_read_without_the_rest() {
    let text = [STUDY, "kind = \"runs/energy\"\n[anything]\nelse = 1"].concat();
    let found = Document::parse(&text, "s.toml", Header::from_document).expect("a header");
    assert_eq!(
        (found.id.as_str(), found.kind.as_str(), found.tier),
        ("a-1.2", "runs/energy", Tier::Quick)
    );
    assert_eq!(
        Document::parse(STUDY, "s.toml", Header::from_document)
            .expect("a header")
            .kind,
        "orders/manufactured"
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
