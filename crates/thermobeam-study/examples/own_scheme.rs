//! Your own time scheme, judged by the studies that judge the others.
//!
//! A scheme is a row of data. What judges shares nothing with what is judged, so the study gets its
//! formulas a second time. A method outside this form is judged by its errors, as in the example
//! `own_rates`.
//!
//! `cargo run -p thermobeam-study --example own_scheme`

#![allow(clippy::disallowed_methods, reason = "an example of the solver alone")]

use std::error::Error;

use convergence_judge::text::number::max_or_nan;
use convergence_study::{FromFile as _, Verdict, run_one};
use thermobeam::mesh::Mesh;
use thermobeam::one_step::{InitialValues, OneStep, Problem, Stepping};
use thermobeam::parameters::{Beam, Obstacles};
use thermobeam::scheme::{ContactRule, Scheme};
use thermobeam::solve::Settings;
use thermobeam_exact::formulas::SchemeFormulas;
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::Convergence;

/// Between the paper's scheme (V = v) and midpoint (V the mean): three quarters of the new
/// velocity, and contact by the discrete gradient. It damps half as much as the paper's and is
/// still of first order.
const MINE: Scheme = Scheme {
    name: "three-quarters",
    order: 1.0,
    inertia: 4.0 / 3.0,
    contact: ContactRule::DiscreteGradient,
    source: "V = 3/4 v + 1/4 v0",
};

/// The same as formulas of the loads: a wrong entry in either changes the order.
const FORMULAS: SchemeFormulas = SchemeFormulas::Own {
    inertia: 4.0 / 3.0,
    has_discrete_gradient: true,
};

const STUDY: &str = r#"
    study = { id = "my-scheme", claim = "The order of a scheme in time", tier = "quick" }
    exact.u = [{ x = "0.3*sin(1.3*pi*x)", t = "cos(3*t) + 0.2*t" }]
    exact.phi = [{ x = "0.4*x*exp(-x)", t = "sin(2*t) + 0.5" }]
    refine = { axis = "time", isolate = true, elements = 8, steps = [64, 128, 256, 512, 1024], t_end = 1.0, tolerance = 1e-13 }
    expect = [{ norm = "superclose", order = 1.0, tolerance = 0.02 }]
"#;

/// The verdict on an order in dt.
fn judged(scheme: Scheme, order: f64) -> Result<(Verdict, String), Box<dyn Error>> {
    let mut study = Orders::<Convergence>::parse(STUDY, "my-scheme.toml".as_ref())?;
    study.refine.scheme = scheme;
    study.formulas = Some(FORMULAS);
    study.expect[0].1.order = order;
    let outcome = run_one(&study);
    Ok((outcome.verdict, outcome.rates[0].rate.reason.to_string()))
}

/// The largest residual of the energy's balance over a swing between the obstacles.
fn balance(scheme: Scheme) -> Result<f64, Box<dyn Error>> {
    let mesh = Mesh::uniform(50)?;
    let initial = InitialValues {
        u_t: mesh.nodes().to_vec(),
        ..InitialValues::at_rest(&mesh, 0.0)
    };
    let problem = Problem {
        beam: Beam::default(),
        obstacles: Some(Obstacles::default()),
        mesh,
        initial,
    };
    let stepping = Stepping {
        scheme,
        settings: Settings::default(),
        dt: 1e-3,
        loaded: false,
    };
    let mut simulation = OneStep::new(problem, stepping)?;
    let (mut old, mut largest) = (simulation.level(), 0.0_f64);
    for _ in 0..2000 {
        simulation.step_once()?;
        let new = simulation.level();
        largest = max_or_nan(largest, simulation.balance(&old, &new).residual.abs());
        old = new;
    }
    Ok(largest)
}

fn main() -> Result<(), Box<dyn Error>> {
    let (first, second) = (judged(MINE, 1.0)?, judged(MINE, 2.0)?);
    println!(
        "claimed 1: {}, {}\nclaimed 2: {}, {}",
        first.0, first.1, second.0, second.1
    );
    let residual = balance(MINE)?;
    println!("balance of the energy: {residual:.1e}");
    assert!((first.0, second.0) == (Verdict::Pass, Verdict::Fail) && residual < 1e-11);
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
