//! Scene files that are refused, with place, value found and values allowed.

use super::super::says;
use super::{TIME, refusal, refuses, scene};

#[test]
fn a_wrong_key_or_value_is_named_with_its_place_and_what_is_allowed() {
    for (head, pieces) in [
        (
            "[beam]\nzeta = -1",
            "dir/beam.toml:2:8: beam.zeta: found -1; expected a finite number >= 0",
        ),
        (
            "[beam]\n  a = nan",
            "dir/beam.toml:2:7: beam.a: found nan; expected a finite number",
        ),
        (
            "[beam]\na = inf",
            "beam.a: found inf; expected a finite number",
        ),
        (
            "[beam]\na = 1e400",
            "beam.a: found 1e400; expected a finite number",
        ),
        (
            "[beam]\nbeta = \"1\"",
            "2:8: beam.beta: found the text \"1\"; expected a finite number",
        ),
        (
            "[beam]\nbeta = [1]",
            "beam.beta: found the list [1]; expected a finite number",
        ),
        (
            "[beam]\nbeta = true",
            "beam.beta: found true; expected a finite number",
        ),
        (
            "[beam]\nbeta = {}",
            "beam.beta: found an empty table; expected a finite number",
        ),
        (
            "[beam]\n\nzetta = 1",
            "3:1: beam.zetta: unknown key `zetta`, did you mean `zeta`?; expected zeta, a,",
        ),
        (
            "[beam]\nwidth = 1",
            "2:1: beam.width: unknown key `width`; expected zeta, a, rho, beta, theta_a",
        ),
        ("beam = 3", "1:8: beam: found 3; expected a table"),
        (
            "[baem]",
            "1:2: baem: unknown key `baem`, did you mean `beam`?; expected beam, obstacles, initial",
        ),
        (
            "[obstacles]\nepsilon = 0",
            "2:11: obstacles.epsilon: found 0; expected a finite number > 0",
        ),
        (
            "[obstacles]\ng1 = 0.1",
            "obstacles.g1: found 0.1; expected a finite number <= 0",
        ),
        (
            "[initial]\nu = 0",
            "2:5: initial.u: found 0; expected a function of x in quotes",
        ),
        (
            "[initial]\nv = \"x\"",
            "2:1: initial.v: unknown key `v` … expected u, u_t, phi, phi_t, theta",
        ),
        (
            "[mesh]\nelements = 0",
            "2:12: mesh.elements: found 0; expected a whole number >= 1",
        ),
        (
            "[mesh]\nelements = -4",
            "mesh.elements: found -4; expected a whole number >= 1",
        ),
        (
            "[mesh]\nelements = 1e3",
            "mesh.elements: found 1e3; expected a whole number >= 1",
        ),
        (
            "[mesh]\nelements = 4\nnodes = [0, 1]",
            "2:12: mesh.elements: found 4 beside nodes; expected either",
        ),
        (
            "[mesh]\nmap = \"s\"\nnodes = [0, 1]",
            "2:7: mesh.map: found the text \"s\" beside nodes",
        ),
        (
            "[mesh]\nmap = \"1/s\"",
            "2:7: mesh.map: the value is inf at s = 0",
        ),
        (
            "[mesh]\nmap = \"2*s\"",
            "mesh.map: its mesh: node 100: expected 1, found 2",
        ),
        (
            "[mesh]\nmap = \"s+sin(2*pi*s)\"",
            "mesh.map: its mesh: nodes … expected strictly increasing nodes, found ",
        ),
        (
            "[mesh]\nnodes = 3",
            "mesh.nodes: found 3; expected a list of at least two numbers",
        ),
        (
            "[mesh]\nnodes = [0]",
            "mesh.nodes: found the list [0]; expected a list of at least two numbers",
        ),
        (
            "[mesh]\nnodes = [0.1, 1]",
            "2:10: mesh.nodes[0]: node 0: expected 0, found 0.1",
        ),
        (
            "[mesh]\nnodes = [0,\n 0.5, 0.5, 1]",
            "3:7: mesh.nodes[2]: nodes 1 and 2: expected strictly increasing nodes, found 0.5 and 0.5",
        ),
        (
            "[mesh]\nnodes = [0, \"a\", 1]",
            "mesh.nodes[1]: found the text \"a\"; expected a finite number",
        ),
    ] {
        refuses(&format!("{head}\n{TIME}"), pieces);
    }
}

#[test]
fn a_wrong_time_table_is_named() {
    for (text, pieces) in [
        (
            "",
            "dir/beam.toml:1:1: time: missing; expected a table: the method, its steps",
        ),
        (
            "\n[time]\ndt = 0.1",
            "2:1: time.t_end: missing; expected a finite number > 0",
        ),
        (
            "[time]\nt_end = 0.1",
            "1:1: time.dt: missing; expected a finite number > 0",
        ),
        (
            "[time]\ndt = 0\nt_end = 1",
            "2:6: time.dt: found 0; expected a finite number > 0",
        ),
        (
            "[time]\ndt = 0.1\nt_end = -1",
            "3:9: time.t_end: found -1; expected a finite number > 0",
        ),
        (
            "[time]\ndt = 0.3\nt_end = 1",
            "time.dt: found 0.3, which is 3.33 … nearest being 0.3333333333333333 (3",
        ),
        (
            "[time]\ndt = 3\nt_end = 1",
            "time.dt: found 3.0 … the nearest being 1.0 (1 steps)",
        ),
        (
            "[time]\ndt = 1e-11\nt_end = 1",
            "time.dt: found 1e-11, which is 1.000e11 steps … at most 1e10 steps",
        ),
        (
            "[time]\ndt = 1e-300\nt_end = 1e300",
            "time.dt: found 1e-300, which is inf steps … at most 1e10 steps",
        ),
        (
            "[time]\nstep = 1",
            "2:1: time.step: unknown key `step` … scheme, dt, t_end, solver, tolerance",
        ),
    ] {
        refuses(text, pieces);
    }
    for (line, pieces) in [
        (
            "scheme = \"mid-point\"",
            "4:10: time.scheme: found the text \"mid-point\" (did you mean \"midpoint\"?)",
        ),
        (
            "scheme = \"rk4\"",
            "time.scheme: found the text \"rk4\"; expected \"euler-crank-nicolson\", \"midpoint\"",
        ),
        (
            "solver = 1",
            "time.solver: found 1; expected \"newton\", \"fixed-point\"",
        ),
        (
            "tolerance = 0.0",
            "time.tolerance: found 0.0; expected a finite number > 0",
        ),
        (
            "max_iterations = 0",
            "time.max_iterations: found 0; expected a whole number >= 1",
        ),
        (
            "iterations = 2",
            "time.iterations: found solver \"newton\" … \"fixed-point\"",
        ),
        (
            "solver = \"fixed-point\"\niterations = 0",
            "time.iterations: found 0; expected a whole number >= 1",
        ),
        (
            "solver = \"fixed-point\"\niterations = 2\ntolerance = 1e-9",
            "time.tolerance: found a second rule … `iterations` alone",
        ),
    ] {
        refuses(&format!("[time]\ndt = 0.1\nt_end = 1\n{line}"), pieces);
    }
}

#[test]
fn the_dt_that_a_refusal_names_is_accepted() {
    for (dt, t_end) in [
        (0.3, 1.0),
        (0.7, 1.0),
        (1e-3, 0.98765),
        (3.0, 1.0),
        (0.012, 7.3),
        (2e-5, 0.31415926),
    ] {
        let text = |dt: f64| format!("[time]\ndt = {dt:?}\nt_end = {t_end:?}");
        let message = refusal(&text(dt));
        let nearest = message
            .split("nearest being ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next());
        let nearest: f64 = nearest
            .and_then(|dt| dt.parse().ok())
            .unwrap_or_else(|| panic!("{message}"));
        let steps = scene(&text(nearest)).steps() as f64;
        assert!((steps * nearest - t_end).abs() <= 1e-15 * t_end);
        // Neither neighbour is closer to the written value.
        for neighbour in [steps - 1.0, steps + 1.0]
            .into_iter()
            .filter(|steps| *steps > 0.0)
        {
            assert!(
                (t_end / neighbour - dt).abs() >= (nearest - dt).abs(),
                "{message}"
            );
        }
    }
}

#[test]
fn a_mesh_that_does_not_fit_into_memory_is_refused_with_its_size() {
    let message = refusal(&format!("[mesh]\nelements = 1_000_000_000\n{TIME}"));
    says(
        &message,
        "2:12: mesh.elements: found 1_000_000_000; expected … <= 8589934",
    );
    refuses(
        &format!("[mesh]\nelements = 99999999999999999999\n{TIME}"),
        "mesh.elements: found 9999",
    );
}

#[test]
fn a_mistake_in_a_function_is_shown_inside_its_text() {
    let message = refusal(&format!("[initial]\ntheta = \"x*(1-y)\"\n{TIME}"));
    says(
        &message,
        "dir/beam.toml:2:15: initial.theta: unknown name `y`; expected one of x pi e … \n    x*(1-y)\n",
    );
    assert_eq!(message.lines().nth(2), Some("         ^"));
    // An escape shifts the text: the message then points at the whole value.
    refuses(
        &format!("[initial]\nu = \"\\u0078+y\"\n{TIME}"),
        "2:5: initial.u: unknown name `y`",
    );
    refuses(
        &format!("[initial]\nu = '''\nx+y'''\n{TIME}"),
        "3:3: initial.u: unknown name `y`",
    );
}

#[test]
fn initial_data_must_be_finite_at_every_node() {
    refuses(
        &format!("[initial]\nu = \"x/(x-1)\"\n{TIME}"),
        "2:5: initial.u: the value is … at x = 1;",
    );
    // A pole between the samples of the check, and at a node.
    let text = format!("[initial]\nu = \"x/(x-0.12345)\"\n[mesh]\nnodes = [0, 0.12345, 1]\n{TIME}");
    refuses(&text, "initial.u: the value is inf at x = 0.12345");
}

#[test]
fn initial_data_must_meet_the_boundary_conditions() {
    for key in ["u", "u_t", "phi", "phi_t"] {
        let text = format!("[initial]\n{key} = \"1e-9+x\"\n{TIME}");
        let words = format!("initial.{key}: found {key}(0) = 1e-9; expected {key}(0) = 0.0");
        refuses(&text, &format!("dir/beam.toml:2: … : {words}"));
    }
    let theta = |theta: &str, theta_a: f64| {
        format!("[beam]\ntheta_a = {theta_a:?}\n[initial]\n{theta}\n{TIME}")
    };
    refuses(
        &theta("theta = \"x\"", 0.0),
        "4:9: initial.theta: found theta(1) = 1.0; expected theta(1) = 0.0",
    );
    refuses(
        &theta("theta = \"1-x\"", 20.0),
        "found theta(0) = 1.0; expected theta(0) = 20.0",
    );
    refuses(
        &theta("", 20.0),
        "3:1: initial.theta: found nothing, which means 0 … theta(0) = 20.0",
    );
    let no_table = format!("[beam]\ntheta_a = 20\n{TIME}");
    refuses(
        &no_table,
        "initial.theta: found nothing, which means 0 … beam.theta_a",
    );
}
