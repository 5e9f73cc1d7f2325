//! `--estimate-error`: the parts of the error of a run.

use thermobeam::dg::DgStepping;
use thermobeam_exact::vibration::TimeFactor;
use thermobeam_study::predict::estimate::Source;
use thermobeam_study::run::simulate::{Recording, Simulator};
use thermobeam_study::scene::{Method, Scene};

use super::{
    CONTACT, TIMES, ZETA, chosen, errors, estimate, estimated, largest_difference,
    layered_reference, named, parsed, reference, run, scene, vibration,
};

#[test]
fn no_number_of_the_budget_is_small_by_chance() {
    let of = |coefficients: &str, obstacles: &str, initial: &str, mesh: &str, time: &str| {
        parsed(&format!(
            "[beam]\n{coefficients}\n[obstacles]\n{obstacles}\n[initial]\n{initial}\ntheta = \"sin(pi*x)\"\n\
             [mesh]\n{mesh}\n[time]\nscheme = \"dg\"\nt_end = 2.0\n{time}\n"
        ))
    };
    let scenes = [
        of(
            "zeta = 0.05\nbeta = 5",
            "epsilon = 5.7303983e-4\ng1 = -0.0719352\ng2 = 0.0176838",
            "u_t = \"x\"",
            "degree = 13",
            "degree = 2\ndt = 0.04",
        ),
        of(
            "zeta = 0.01\na = 0\nrho = 5",
            "epsilon = 1.658373e-3",
            "u_t = \"20*x*(x-1)^2\"",
            "degree = 10",
            "dt = 0.01",
        ),
        of(
            "zeta = 0.01\na = 0.5\nrho = 5",
            "epsilon = 1.755948e-3\ng1 = -0.07721368\ng2 = 0.025111",
            "u = \"0.05*x^2\"\nu_t = \"2*x*sin(3*x)\"",
            "elements = 2\ndegree = 8",
            "degree = 2",
        ),
        of(
            "zeta = 1\nrho = 5\nbeta = -0.5",
            "epsilon = 2.555154e-3\ng1 = -0.0506523\ng2 = 0.03551753",
            "u_t = \"20*x*(x-1)^2\"",
            "elements = 2\ndegree = 8",
            "",
        ),
        of(
            "zeta = 1",
            "epsilon = 5.948e-4",
            "u_t = \"2*x*sin(3*x)\"",
            "elements = 3\ndegree = 12",
            "degree = 2\ndt = 0.01",
        ),
    ];
    for (number, scene) in scenes.iter().enumerate() {
        let budget = estimate(scene).expect("a budget");
        let (own, exact) = (run(scene, TIMES), layered_reference(scene));
        for (name, made) in errors(&own, &exact) {
            let total = estimated(&budget, name);
            assert!(
                made <= 1.3 * total,
                "scene {number}, {name}: {made:e} in {budget}"
            );
        }
    }
}

#[test]
fn the_parts_of_an_error_are_what_much_finer_elements_and_much_shorter_steps_take_away() {
    for (beam, target) in [("", 1e-5), ("zeta = 0.01", 1e-5), ("beta = 5", 1e-7)] {
        let choice = chosen(&scene(beam, "t_end = 1.0"), target);
        let Method::Dg(by) = choice.scene.method else {
            panic!("{choice:?}")
        };
        let shorter = DgStepping {
            dt: by.dt / 6.0,
            restart_dt: by.restart_dt / 36.0,
            growth: 1.0 + (by.growth - 1.0) / 6.0,
            ..by
        };
        let finer = Scene {
            degree: choice.scene.degree + 8,
            ..choice.scene.clone()
        };
        let shorter = Scene {
            method: Method::Dg(shorter),
            ..choice.scene.clone()
        };
        let own = run(&choice.scene, TIMES);
        for (part, other) in choice.parts.both().into_iter().zip([finer, shorter]) {
            let made = largest_difference(&own, &run(&other, TIMES));
            assert!(
                made <= 1.5 * part && *part <= 20.0 * made,
                "{beam}: {made:e}, not {part:e}, by {other:?}"
            );
        }
    }
}

#[test]
fn the_budget_of_dg_is_the_error_and_names_what_dominates() {
    let fine_space = "t_end = 0.6\ndegree = 1\ndt = 0.02";
    for (degree, time, expected) in [
        (20, fine_space, Source::Time),
        (
            5,
            "t_end = 0.6\ndegree = 4\ndt = 0.004\ngrowth = 1.1",
            Source::Space,
        ),
    ] {
        let scene = Scene {
            degree,
            ..scene("", time)
        };
        let budget = estimate(&scene).expect("a budget");
        assert_eq!(budget.dominant, Some(expected), "{budget}");
        let exact = reference(&scene);
        let own = run(&scene, TIMES);
        let (made, tip) = (
            largest_difference(&own, &exact),
            named(&budget, "u(1) over time"),
        );
        assert!(
            made <= 1.1 * tip.total && tip.total <= 1.5 * made,
            "{made:e} against {budget}"
        );
        let end = named(&budget, "u(1) at the end");
        assert_eq!(end.value, own.last.u_tip);
        assert!((end.value - exact.last.u_tip).abs() <= 1.1 * end.total);
    }
}

#[track_caller]
fn is_the_error_of_the_vibration(index: usize, stepping: &str, source: Option<Source>) {
    let (mode, scene) = vibration(index, stepping);
    let budget = estimate(&scene).expect("a budget");
    let factor = TimeFactor::new(mode.omega(), ZETA, 1.0, 0.0)
        .expect("a viscosity")
        .value(scene.t_end);
    for (name, truth) in [
        ("u(1) at the end", factor),
        ("phi(1) at the end", mode.phi(1.0) * factor),
    ] {
        let of = named(&budget, name);
        // Two digits of the error, not just its order of magnitude.
        assert!(
            (of.total - (of.value - truth).abs()).abs() <= 0.02 * of.total,
            "{name} {truth:?}: {budget}"
        );
    }
    assert_eq!(budget.dominant, source, "{budget}");
}

#[test]
fn the_errors_of_a_vibration_are_found_to_their_digits_on_any_mesh() {
    let uniform = |elements: usize, dt: f64, scheme: &str| {
        format!(
            "[mesh]\nelements = {elements}\n[time]\ndt = {dt}\nt_end = 3.0\nscheme = \"{scheme}\"\n"
        )
    };
    is_the_error_of_the_vibration(
        0,
        &uniform(64, 0.01, "euler-crank-nicolson"),
        Some(Source::Time),
    );
    is_the_error_of_the_vibration(
        1,
        &uniform(64, 0.005, "euler-crank-nicolson"),
        Some(Source::Time),
    );
    is_the_error_of_the_vibration(0, &uniform(16, 0.003, "midpoint"), Some(Source::Space));
    is_the_error_of_the_vibration(2, &uniform(32, 0.001, "midpoint"), Some(Source::Space));
    let graded = "[mesh]\nelements = 18\nmap = \"s + 0.1*sin(2*pi*s)\"\n[time]\ndt = 0.002\nt_end = 3.0\nscheme = \"midpoint\"\n";
    is_the_error_of_the_vibration(0, graded, Some(Source::Space));
    is_the_error_of_the_vibration(
        0,
        "[mesh]\nelements = 1\n[time]\ndt = 1.0\nt_end = 1.0\n",
        Some(Source::Time),
    );
}

#[test]
fn the_errors_of_a_one_step_scheme_in_contact_are_those_to_the_exact_motion() {
    for scheme in ["euler-crank-nicolson", "midpoint"] {
        let scene = parsed(&format!(
            "{CONTACT}[time]\ndt = 5e-4\nt_end = 1.0\nscheme = \"{scheme}\"\n"
        ));
        let budget = estimate(&scene).expect("a budget");
        let own = Simulator::new(&scene)
            .expect("a scene")
            .run(Recording::Summary, &mut |_, _| ());
        let exact = reference(&parsed(&format!(
            "{CONTACT}[time]\nscheme = \"dg\"\nt_end = 1.0\n"
        )));
        let last = exact.last;
        for (name, made) in [
            ("u(1) at the end", own.last.u_tip - last.u_tip),
            ("phi(1) at the end", own.last.phi_tip - last.phi_tip),
            ("energy at the end", own.last.energy - last.energy),
            (
                "largest u(1)",
                own.extremes.u_tip_max - exact.extremes.u_tip_max,
            ),
            (
                "smallest u(1)",
                own.extremes.u_tip_min - exact.extremes.u_tip_min,
            ),
        ] {
            let of = named(&budget, name);
            assert!(
                (of.total - made.abs()).abs() <= 2.0 * of.reference + 0.01 * made.abs(),
                "{name} {made:e}: {budget}"
            );
            // The reference's own error is at most a tenth of that of the number's curve.
            let curve = format!(
                "{} over time",
                name.split(' ')
                    .next()
                    .filter(|n| n.len() > 4 && *n != "largest")
                    .unwrap_or("u(1)")
            );
            let curve = budget
                .quantities
                .iter()
                .find(|of| of.name == curve)
                .unwrap_or(named(&budget, "u(1) over time"));
            assert!(of.reference <= 0.15 * curve.total, "{name}: {budget}");
        }
    }
}

#[test]
fn a_loose_tolerance_is_in_the_error() {
    let time = "[time]\ndt = 1e-3\nt_end = 0.5\nsolver = \"fixed-point\"\ntolerance = ";
    let of = |tolerance: &str| {
        estimate(&parsed(&format!("{CONTACT}{time}{tolerance}\n"))).expect("a budget")
    };
    let [loose, tight] = [of("0.03"), of("1e-11")];
    let [loose, tight] = [&loose, &tight].map(|budget| named(budget, "u(1) at the end"));
    let made = (loose.value - tight.value).abs();
    assert!(
        made > 3.0 * tight.total && (loose.total - made).abs() <= 1.1 * tight.total,
        "{loose:?} {tight:?}"
    );
}

#[test]
fn a_scene_whose_own_run_fails_has_no_budget_and_says_why() {
    // Beyond α = 1 the fixed point diverges in contact.
    let text = format!("{CONTACT}[time]\ndt = 0.02\nt_end = 2.0\nsolver = \"fixed-point\"\n");
    let error = estimate(&parsed(&text)).expect_err("divergence");
    assert!(
        error.to_string().contains("the iteration diverges"),
        "{error}"
    );
}

#[test]
fn the_table_names_numbers_errors_and_what_to_do() {
    let (_, scene) = vibration(0, "[mesh]\nelements = 64\n[time]\ndt = 0.01\nt_end = 3.0\n");
    let text = estimate(&scene).expect("a budget").to_string();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 12, "{text}");
    assert!(
        lines[2].starts_with("u(1) at the end") && lines[11].contains("half of dt"),
        "{text}"
    );
    let json = serde_json::to_value(estimate(&scene).expect("a budget")).expect("JSON");
    assert_eq!(json["dominant"], "time");
    let of = &json["quantities"][3];
    assert_eq!(
        (of["name"].as_str(), of["kind"].as_str()),
        (Some("u(1) over time"), Some("curve"))
    );
    assert!(
        of["total"].as_f64() > of["finer_steps"].as_f64() && of["reference"].as_f64() > Some(0.0),
        "{json}"
    );
}
