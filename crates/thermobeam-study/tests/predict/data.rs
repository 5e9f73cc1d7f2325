//! Initial data with narrow features, kinks, jumps and layers.

use thermobeam::dg::{self, Dg, DgStepping};
use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam_study::predict::choice::ErrorQuantity;
use thermobeam_study::predict::{self, Unreachable};
use thermobeam_study::scene::{Method, Scene};

use super::{
    TIMES, choose, chosen, estimate, estimated, largest_difference, layered_reference, limited,
    named, parsed, run, samples,
};

#[test]
fn the_layer_at_the_start_keeps_the_error_asked_for() {
    // Initial data that violate the condition at x = 1: the error of u(1, t) peaks inside the first
    // step.
    for (zeta, target) in [(0.01, 1e-9), (0.1, 1e-8)] {
        let scene = parsed(&format!(
            "[beam]\nzeta = {zeta}\nbeta = -0.5\n[initial]\nu_t = \"2*x*sin(3*x)\"\ntheta = \"sin(pi*x)\"\n\
             [time]\nscheme = \"dg\"\nt_end = 1.0\n"
        ));
        let choice = chosen(&scene, target);
        // The chosen run, with its own steps, continues while the history ends.
        let own = samples(&run(
            &Scene {
                t_end: 0.02,
                ..choice.scene.clone()
            },
            100 * TIMES,
        ));
        for t_end in [2e-4, 4e-3] {
            let begun = |scene: &Scene| Scene {
                t_end,
                ..scene.clone()
            };
            let exact = samples(&layered_reference(&begun(&scene)));
            let every = (5e3 * t_end).round() as usize;
            let made = (1..=TIMES)
                .map(|k| (own[k * every].u_tip - exact[k].u_tip).abs())
                .fold(0.0, f64::max);
            assert!(made <= target, "to t = {t_end}: {made:e} with {choice:?}");
            assert!(made <= 1.3 * choice.error, "{made:e} with {choice:?}");
        }
    }
}

#[test]
fn short_waves_that_grow_while_the_axial_force_is_below_minus_one_do_not_exceed_the_error_asked_for()
 {
    // Degrees 9 and 13 on four elements agree to 4e-5, but both have errors of 7e-4.
    let scene = parsed(
        "[beam]\nzeta = 0.003763\na = 0.3124\nrho = 1.038\nbeta = -1.8925\ntheta_a = -4.325\n\
         [obstacles]\nepsilon = 0.0027\ng1 = -0.07874\ng2 = 0.02022\n\
         [initial]\nu = \"-0.001736*x*(x-2)\"\nu_t = \"-1.2994*x + 14.825*x*(x-1)^2\"\ntheta = \"-4.325*(1-x) - 0.535*sin(pi*x)\"\n\
         [time]\nscheme = \"dg\"\nt_end = 0.2\n",
    );
    let mesh = Mesh::mapped(16, |s| 1.0 - (1.0 - s).powf(1.6)).expect("a mesh");
    let stepping = DgStepping {
        degree: 3,
        dt: 0.003,
        restart_dt: 1e-5,
        growth: 1.2,
        ..DgStepping::default()
    };
    let exact = run(
        &Scene {
            mesh,
            degree: 16,
            method: Method::Dg(stepping),
            ..scene.clone()
        },
        TIMES,
    );
    let choice = chosen(&scene, 1e-4);
    let made = largest_difference(&run(&choice.scene, TIMES), &exact);
    assert!(
        made <= 1e-4 && made <= 1.3 * choice.error && choice.error <= 1e-4,
        "{made:e} with {choice:?}"
    );
    let budget = estimate(&Scene {
        degree: 9,
        ..scene.clone()
    })
    .expect("a budget");
    let made = largest_difference(&run(&Scene { degree: 9, ..scene }, TIMES), &exact);
    let total = estimated(&budget, "u(1) over time");
    assert!(made <= 1.3 * total, "{made:e} in {budget}");
}

/// The scene by dG on nodes that crowd at some points, down to a distance: a discretisation that no
/// search tries.
fn crowded(
    scene: &Scene,
    points: &[f64],
    least: f64,
    degree: usize,
    stepping: DgStepping,
) -> Scene {
    let distances = || {
        std::iter::successors(Some(least), |distance| Some(2.0 * distance)).take_while(|d| *d < 0.2)
    };
    let around = |x: f64| distances().flat_map(move |d| [x - d, x + d]).chain([x]);
    let mut nodes: Vec<f64> = points
        .iter()
        .flat_map(|x| around(*x))
        .chain((0..=8).map(|i| f64::from(i) / 8.0))
        .collect();
    nodes.retain(|x| (0.0..=1.0).contains(x));
    nodes.sort_by(f64::total_cmp);
    nodes.dedup_by(|next, x| *next - *x < 0.3 * least);
    *nodes.last_mut().expect("nodes") = 1.0;
    let mesh = Mesh::from_nodes(nodes).expect("nodes");
    Scene {
        mesh,
        degree,
        method: Method::Dg(stepping),
        ..scene.clone()
    }
}

const BLOW: &str = "[obstacles]\nepsilon = 1e-3\ng1 = -0.05\ng2 = 0.05\n[mesh]\nelements = 40\n[time]\nscheme = \"midpoint\"\ndt = 2e-3\n\
                    t_end = 0.5\n[initial]\nu_t = ";

const KINKED: &str = "[obstacles]\nepsilon = 1e-3\ng1 = -0.2\ng2 = 0.2\n[mesh]\nelements = 40\n[time]\nscheme = \"midpoint\"\ndt = 2e-3\n\
                      t_end = 1.0\n[initial]\nu_t = \"max(0,x-0.37)\"\nphi = \"0.3*min(x,1-x)\"\n";

/// Two scenes with a blow at x = 0.6137: all meshes without nodes there miss it.
fn blows() -> [(Scene, Scene); 2] {
    let stepping = DgStepping {
        degree: 3,
        dt: 2e-3,
        restart_dt: 1e-5,
        growth: 1.2,
        ..DgStepping::default()
    };
    [
        "\"0.3*x + 66.66666666666667*x*exp(-((x-0.6137)/0.0015)^2)\"",
        "\"200.0*x*exp(-((x-0.6137)/0.001)^2)\"",
    ]
    .map(|u_t| {
        let scene = parsed(&format!("{BLOW}{u_t}\n"));
        let exact = crowded(&scene, &[0.6137, 1.0], 5e-4, 11, stepping);
        (scene, exact)
    })
}

/// The largest distance of two runs by dG in the norm of Theorem 3.4, inside the steps of the
/// first.
fn distance_in_norm(scene: &Scene, exact: &Scene) -> f64 {
    let begun =
        |scene: &Scene| Dg::new(scene.dg_problem(), scene.dg_stepping()).expect("a problem");
    let (mut own, mut exact) = (begun(scene), begun(exact));
    let mut nodes = [own.space().mesh().nodes(), exact.space().mesh().nodes()].concat();
    nodes.sort_by(f64::total_cmp);
    let mut points = vec![];
    for x in nodes.windows(2) {
        let half = 0.5 * (x[1] - x[0]);
        points.extend(
            dg::Space::gauss(4)
                .into_iter()
                .map(|(xi, weight)| (x[0] + half * (1.0 + xi), half * weight)),
        );
    }
    let read = |simulation: &Dg, t: f64| -> Vec<[f64; 5]> {
        let mut level = simulation.level().clone();
        assert!(simulation.level_into(t, &mut level));
        let at = |(x, _): &(f64, f64)| {
            let [(_, u_x), (phi, phi_x), (v, _), (w, _), (theta, _)] =
                level.values_and_slopes(simulation.space(), *x);
            [v, u_x - phi, w, phi_x, theta]
        };
        points.iter().map(at).collect()
    };
    let mut most = 0.0_f64;
    while own.step(scene.t_end).expect("a step").is_some() {
        for part in [0.07, 0.4, 0.8] {
            let t = own.old_level().t + part * (own.t() - own.old_level().t);
            while exact.t() < t {
                exact.step(scene.t_end).expect("a step");
            }
            let rows = read(&own, t).into_iter().zip(read(&exact, t)).zip(&points);
            let square = rows.map(|((a, b), (_, weight))| {
                weight * a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
            });
            most = most.max(square.sum::<f64>().sqrt());
        }
    }
    most
}

#[test]
fn a_blow_between_the_nodes_is_in_every_error() {
    let truth = [(0.050_259_92, 1e-8), (0.050_273_96, 1e-8)];
    for ((scene, exact), (at_end, digits)) in blows().into_iter().zip(truth) {
        let exact_run = run(&exact, TIMES);
        assert!(
            (exact_run.last.u_tip - at_end).abs() < digits,
            "{:?}",
            exact_run.last
        );
        let budget = estimate(&scene).expect("a budget");
        for (name, truth) in [
            ("u(1) at the end", exact_run.last.u_tip),
            ("largest u(1)", exact_run.extremes.u_tip_max),
            ("phi(1) at the end", exact_run.last.phi_tip),
            ("energy at the end", exact_run.last.energy),
        ] {
            let of = named(&budget, name);
            let made = (of.value - truth).abs();
            assert!(
                made > 1e-4 && made <= 1.01 * of.total && of.total <= 1.01 * made,
                "{name} {made:e}: {budget}"
            );
        }
        let choice = chosen(&scene, 1e-4);
        let made = largest_difference(&run(&choice.scene, TIMES), &exact_run);
        assert!(
            made <= 1.3 * choice.error && choice.error <= 1e-4,
            "{made:e} with {choice:?}"
        );
    }
    let [(scene, exact), _] = blows();
    let (found, _) =
        limited(|work| predict::choice::choose(&scene, ErrorQuantity::Norm, 1e-2, work));
    let choice = found.expect("a run");
    // The blow spreads within 5e-6.
    let from_the_start = DgStepping {
        restart_dt: 1e-8,
        ..exact.dg_stepping()
    };
    let exact = Scene {
        method: Method::Dg(from_the_start),
        ..exact
    };
    let made = distance_in_norm(&choice.scene, &exact);
    assert!(
        made <= 1.3 * choice.error && choice.error <= 1e-2,
        "{made:e} with {choice:?}"
    );
}

#[test]
fn kinks_are_nodes_and_what_they_cost_is_in_the_error() {
    let scene = parsed(KINKED);
    let stepping = DgStepping {
        degree: 4,
        dt: 3.5e-3,
        restart_dt: 1e-9,
        growth: 1.2,
        ..DgStepping::default()
    };
    let exact = crowded(&scene, &[0.0, 0.37, 0.5, 1.0], 1e-5, 9, stepping);
    for target in [1e-1, 1e-2] {
        let (found, _) =
            limited(|work| predict::choice::choose(&scene, ErrorQuantity::Norm, target, work));
        let choice = found.unwrap_or_else(|error| panic!("{error}"));
        assert!(
            [0.37, 0.5]
                .iter()
                .all(|x| choice.scene.mesh.nodes().contains(x)),
            "{choice:?}"
        );
        let made = distance_in_norm(&choice.scene, &exact);
        assert!(
            made <= 1.3 * choice.error && choice.error <= target,
            "{target:e}: {made:e} with {choice:?}"
        );
    }
}

#[test]
fn narrow_data_are_resolved_or_refused_in_each_field_on_each_kind_of_mesh() {
    const X: f64 = 0.9137;
    let meshes = [
        "elements = 40",
        "elements = 40\nmap = \"s + 0.1*sin(2*pi*s)\"",
        "nodes = [0.0, 0.123, 0.4, 0.91, 0.95, 1.0]",
    ];
    for (field, height) in [
        ("u", 0.01),
        ("u_t", 20.0),
        ("phi", 0.1),
        ("phi_t", 20.0),
        ("theta", 20.0),
    ] {
        for width in [5e-3, 7e-4, 1e-4] {
            let of_mesh = |mesh: &str| {
                parsed(&format!(
                    "[beam]\na = 0.5\n[initial]\n{field} = \"{height:?}*exp(-((x-{X})/{width:?})^2)\"\n[mesh]\n{mesh}\n\
                     [time]\ndt = 1e-3\nt_end = 0.03\n"
                ))
            };
            let stepping = DgStepping {
                degree: 3,
                dt: 2e-3,
                restart_dt: 1e-7,
                growth: 1.25,
                ..DgStepping::default()
            };
            let exact = run(
                &crowded(&of_mesh(meshes[0]), &[X, 1.0], 0.5 * width, 11, stepping),
                200,
            );
            let moves = samples(&exact)
                .iter()
                .map(|sample| sample.u_tip.abs())
                .fold(0.0, f64::max);
            let target = 1e-2 * moves;
            for mesh in meshes {
                let scene = of_mesh(mesh);
                let choice = match choose(&scene, target) {
                    Ok(choice) => choice,
                    Err(Unreachable::Unresolved {
                        field: refused, x, ..
                    }) => {
                        assert!(
                            refused == field && (x - X).abs() < 5.0 * width,
                            "{refused} at {x}"
                        );
                        continue;
                    }
                    Err(error) => panic!("{field} of width {width:e}, {mesh}: {error}"),
                };
                let [own, exact] = [&run(&choice.scene, 200), &exact].map(samples);
                let pairs = own.iter().zip(&exact);
                let made = pairs
                    .map(|(own, exact)| (own.u_tip - exact.u_tip).abs())
                    .fold(0.0, f64::max);
                assert!(
                    made <= target,
                    "{field} of width {width:e}, {mesh}: {made:e}, not {target:e}"
                );
                let nodes = choice.scene.mesh.nodes();
                assert!(scene.listed.iter().all(|x| nodes.contains(x)), "{nodes:?}");
                assert!(
                    scene.listed.is_empty() != mesh.starts_with("nodes"),
                    "{mesh}"
                );
            }
        }
    }
}

#[test]
fn a_jump_is_resolved_for_the_free_end_and_refused_for_the_norm() {
    for jump in [
        "(x-0.6137)/abs(x-0.6137)",
        "tanh(1e9*(x-0.6137))",
        "min(1,max(0,1e9*(x-0.6137)))",
    ] {
        let scene = parsed(&format!(
            "[initial]\nu_t = \"x*{jump}\"\n[time]\nt_end = 0.1\nscheme = \"dg\"\n"
        ));
        assert!(chosen(&scene, 1e-4).error <= 1e-4);
        let (found, _) =
            limited(|work| predict::choice::choose(&scene, ErrorQuantity::Norm, 1e-2, work));
        let Err(
            error @ Unreachable::Unresolved {
                field: "u_t", x, ..
            },
        ) = found
        else {
            panic!("{jump}: {found:?}")
        };
        assert!(
            (x - 0.6137).abs() < 1e-6 && error.to_string().contains("u_t near x = 0.6137"),
            "{error}"
        );
    }
}
