//! Estimated errors against true ones, where the exact answer is known.

use thermobeam::vibration::{DampedMode, Mode};
use thermobeam_study::predict::estimate::{Estimate, Source, estimate};
use thermobeam_study::scene::Scene;

const ZETA: f64 = 0.1;

/// A damped mode of the linear beam as a scene: U and Φ written out, released with U(1) = 1.
fn vibration(index: usize, stepping: &str) -> (DampedMode, Scene) {
    let mode = Mode::new(index);
    let omega = mode.omega();
    // At x = 0 the formulas of the mode say U' = -2ωA and Φ' = 2ωB.
    let (a, b) = (-mode.u_x(0.0) / (2.0 * omega), mode.phi_x(0.0) / (2.0 * omega));
    let [plus, minus] = [(omega * omega - omega).sqrt(), (omega * omega + omega).sqrt()];
    let text = format!(
        "[beam]\nzeta = {ZETA}\na = 0.0\nrho = 0.0\n[initial]\n\
         u = \"{a:?}*({:?}*sin({plus:?}*x)/{plus:?} - {:?}*sin({minus:?}*x)/{minus:?}) + {b:?}*(cos({plus:?}*x) - cos({minus:?}*x))\"\n\
         phi = \"{a:?}*(cos({plus:?}*x) - cos({minus:?}*x)) + {b:?}*{omega:?}*(sin({plus:?}*x)/{plus:?} + sin({minus:?}*x)/{minus:?})\"\n\
         {stepping}",
        1.0 - omega,
        1.0 + omega
    );
    let scene = Scene::parse(&text, "vibration.toml").unwrap_or_else(|error| panic!("{error}"));
    (DampedMode::new(mode, ZETA).expect("a viscosity"), scene)
}

fn named<'e>(estimates: &'e [Estimate], name: &str) -> &'e Estimate {
    estimates.iter().find(|estimate| estimate.name == name).unwrap_or_else(|| panic!("no {name}"))
}

#[track_caller]
fn within_a_factor_2(estimated: f64, truth: f64) {
    assert!(estimated > 0.5 * truth && estimated < 2.0 * truth, "estimated {estimated:e}, true {truth:e}");
}

#[track_caller]
fn holds_against_the_exact_vibration(index: usize, stepping: &str, source: Source) {
    let (exact, scene) = vibration(index, stepping);
    let budget = estimate(&scene).expect("a budget");
    let end = named(&budget.estimates, "u(1) at the end");
    within_a_factor_2(end.total(), (end.value - exact.factor(scene.t_end)).abs());
    let rotation = named(&budget.estimates, "phi(1) at the end");
    within_a_factor_2(rotation.total(), (rotation.value - exact.mode().phi(1.0) * exact.factor(scene.t_end)).abs());
    assert_eq!(end.dominant(), source, "{budget}");
    assert_eq!(budget.dominant(), Some(source), "{budget}");
}

#[test]
fn the_time_error_of_a_vibration_is_found() {
    holds_against_the_exact_vibration(0, "[mesh]\nelements = 64\n[time]\ndt = 0.01\nt_end = 3.0\n", Source::Time);
    holds_against_the_exact_vibration(1, "[mesh]\nelements = 64\n[time]\ndt = 0.005\nt_end = 2.0\n", Source::Time);
}

#[test]
fn the_space_error_of_a_vibration_is_found() {
    let midpoint = |elements, dt| {
        format!("[mesh]\nelements = {elements}\n[time]\ndt = {dt}\nt_end = 3.0\nscheme = \"midpoint\"\n")
    };
    holds_against_the_exact_vibration(0, &midpoint(16, 0.003), Source::Space);
    holds_against_the_exact_vibration(2, &midpoint(32, 0.001), Source::Space);
}

#[test]
fn resolutions_that_four_does_not_divide_are_served() {
    holds_against_the_exact_vibration(0, "[mesh]\nelements = 61\n[time]\ndt = 0.01\nt_end = 3.01\n", Source::Time);
    let graded = "[mesh]\nelements = 18\nmap = \"s + 0.1*sin(2*pi*s)\"\n[time]\ndt = 0.002\nt_end = 3.0\nscheme = \"midpoint\"\n";
    holds_against_the_exact_vibration(0, graded, Source::Space);
    let (_, tiny) = vibration(0, "[mesh]\nelements = 1\n[time]\ndt = 1.0\nt_end = 1.0\n");
    assert!(estimate(&tiny).expect("a budget").estimates.iter().all(|estimate| estimate.total().is_finite()));
}

const CONTACT: &str = "[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n[mesh]\nelements = 32\n";

#[test]
fn the_time_error_of_a_beam_in_contact_is_found() {
    let text = |dt: f64, scheme: &str| format!("{CONTACT}[time]\ndt = {dt}\nt_end = 1.0\nscheme = \"{scheme}\"\n");
    let budget = |text: &str| estimate(&Scene::parse(text, "s.toml").expect("a scene")).expect("a budget");
    let (found, reference) = (budget(&text(5e-4, "euler-crank-nicolson")), budget(&text(1e-4, "midpoint")));
    for name in ["u(1) at the end", "phi(1) at the end", "energy at the end", "largest u(1)"] {
        let (found, reference) = (named(&found.estimates, name), named(&reference.estimates, name));
        within_a_factor_2(found.error(Source::Time), (found.value - reference.value).abs());
    }
}

#[test]
fn a_loose_tolerance_is_found() {
    let time = "[time]\ndt = 1e-3\nt_end = 0.5\nsolver = \"fixed-point\"\ntolerance = ";
    let scene = |tolerance: &str| Scene::parse(&format!("{CONTACT}{time}{tolerance}\n"), "s.toml").expect("a scene");
    let (loose, tight) = (estimate(&scene("1e-4")).expect("a budget"), estimate(&scene("1e-11")).expect("a budget"));
    let tip = "u(1) over time";
    let truth =
        (named(&loose.estimates, "u(1) at the end").value - named(&tight.estimates, "u(1) at the end").value).abs();
    within_a_factor_2(named(&loose.estimates, "u(1) at the end").error(Source::Iteration), truth);
    assert!(
        named(&tight.estimates, tip).error(Source::Iteration)
            < 1e-3 * named(&loose.estimates, tip).error(Source::Iteration)
    );
    assert!(named(&tight.estimates, tip).error(Source::RoundOff) > 1e-17);
    assert!(named(&tight.estimates, tip).error(Source::RoundOff) < 1e-11);
}

#[test]
fn a_run_that_fails_is_named() {
    // Beyond α = 1 the fixed point diverges in contact.
    let text = format!("{CONTACT}[time]\ndt = 0.02\nt_end = 2.0\nsolver = \"fixed-point\"\n");
    let error = estimate(&Scene::parse(&text, "s.toml").expect("a scene")).expect_err("divergence");
    assert!(error.to_string().starts_with("the run with the scene's own settings: step"), "{error}");
}

#[test]
fn the_table_names_numbers_errors_and_what_to_do() {
    let (_, scene) = vibration(0, "[mesh]\nelements = 64\n[time]\ndt = 0.01\nt_end = 3.0\n");
    let text = estimate(&scene).expect("a budget").to_string();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 11, "{text}");
    assert!(lines[0].contains("vibration: 64 elements, 300 time steps"), "{text}");
    assert!(lines[10].contains("half of it leaves half of the error"), "{text}");
    println!("{text}");
}
