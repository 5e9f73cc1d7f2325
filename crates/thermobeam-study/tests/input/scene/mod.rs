mod refused;

use thermobeam::mesh::Mesh;
use thermobeam::one_step::Stepping;
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{EULER_CRANK_NICOLSON, MIDPOINT};
use thermobeam::solve::{Settings, Solver, Stopping};
use thermobeam_study::scene::{Initial, Scene};

const TIME: &str = "[time]\ndt = 0.1\nt_end = 1\n";

#[track_caller]
fn scene(text: &str) -> Scene {
    Scene::parse(text, "dir/beam.toml").unwrap_or_else(|error| panic!("{error}"))
}

fn one_step(scene: &Scene) -> Stepping {
    scene.one_step().expect("a one-step scheme")
}

#[track_caller]
fn refusal(text: &str) -> String {
    let error = Scene::parse(text, "dir/beam.toml").expect_err(text);
    let message = error.to_string();
    assert!((1..=3).contains(&message.lines().count()), "{message}");
    message
}

#[test]
fn what_is_left_out_is_the_papers_choice() {
    let scene = scene(TIME);
    assert_eq!(scene.name, "beam");
    assert_eq!(scene.beam, Beam::default());
    assert_eq!(scene.obstacles, None);
    assert_eq!(scene.initial, Initial::default());
    assert_eq!(scene.mesh, Mesh::uniform(100).expect("a mesh"));
    assert_eq!((scene.dt(), scene.t_end, scene.steps()), (0.1, 1.0, 10));
    assert_eq!(
        (one_step(&scene).scheme, one_step(&scene).settings),
        (EULER_CRANK_NICOLSON, Settings::default())
    );
    let with_table = Scene::parse(&format!("[obstacles]\n{TIME}"), "f").expect("a scene");
    assert_eq!(with_table.obstacles, Some(Obstacles::default()));
}

#[test]
fn every_key_arrives() {
    let scene = scene(
        r#"
        beam = { zeta = 1, a = 2, rho = 0, beta = -0.5, theta_a = 20.0 }
        obstacles = { epsilon = 1e-4, g1 = -1, g2 = 2.5 }
        [initial]
        u = "x"
        u_t = "2*x"
        phi = "3*x"
        phi_t = "4*x"
        theta = "20*(1-x)"
        [mesh]
        elements = 4
        map = "s^2"
        [time]
        dt = 0.25
        t_end = 2.0
        scheme = "midpoint"
        solver = "fixed-point"
        tolerance = 1e-9
        max_iterations = 7
        "#,
    );
    assert_eq!(
        scene.beam,
        Beam {
            zeta: 1.0,
            a: 2.0,
            rho: 0.0,
            beta: -0.5,
            theta_a: 20.0
        }
    );
    assert_eq!(
        scene.obstacles,
        Some(Obstacles {
            epsilon: 1e-4,
            g1: -1.0,
            g2: 2.5
        })
    );
    let Initial {
        u,
        u_t,
        phi,
        phi_t,
        theta,
    } = &scene.initial;
    let sources = [u, u_t, phi, phi_t, theta].map(|f| f.as_ref().map(|f| f.source()));
    assert_eq!(sources, ["x", "2*x", "3*x", "4*x", "20*(1-x)"].map(Some));
    assert_eq!(scene.mesh.nodes(), [0.0, 0.0625, 0.25, 0.5625, 1.0]);
    assert_eq!((scene.steps(), one_step(&scene).scheme), (8, MIDPOINT));
    assert_eq!(
        one_step(&scene).settings,
        Settings {
            solver: Solver::FixedPoint,
            stopping: Stopping::Converged {
                tolerance: 1e-9,
                max_iterations: 7
            },
            ..Settings::default()
        }
    );
}

#[test]
fn decimal_steps_divide_decimal_times_in_spite_of_rounding() {
    for (dt, t_end, steps) in [
        ("1e-4", "10", 100_000),
        ("0.1", "0.3", 3),
        ("0.007", "0.7", 100),
        ("1e-9", "10.0", 10_000_000_000),
    ] {
        assert_eq!(
            scene(&format!("[time]\ndt = {dt}\nt_end = {t_end}")).steps(),
            steps
        );
    }
}

#[test]
fn round_off_at_the_boundary_is_fine_whatever_the_size_of_the_function() {
    for theta in [
        "sin(pi*x)",
        "sin(1000*pi*x)",
        "1e9*sin(pi*x)",
        "1e-9*sin(pi*x)",
        "cos(pi*x/2) - (1-x)",
    ] {
        scene(&format!("[initial]\ntheta = \"{theta}\"\n{TIME}"));
    }
}
