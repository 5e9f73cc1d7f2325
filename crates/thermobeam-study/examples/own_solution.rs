//! Your own manufactured solution, in Rust and in TOML: the same study.
//!
//! `cargo run -p thermobeam-study --example own_solution`

use std::error::Error;

use convergence_study::{Claim, FromFile as _, RefinedIn, run_one};
use thermobeam::parameters::Beam;
use thermobeam::scheme::EULER_CRANK_NICOLSON;
use thermobeam::solve::{Settings, Stopping};
use thermobeam_study::exact::norm::Norm;
use thermobeam_study::exact::solution::{Manufactured, Product};
use thermobeam_study::expression::{Expression, ExpressionError, Variable};
use thermobeam_study::kinds::orders::Orders;
use thermobeam_study::kinds::orders::manufactured::Convergence;
use thermobeam_study::kinds::tables::{Layout, Refine};
use thermobeam_study::scene::Coefficients;

const TOML: &str = r#"
    study = { id = "my-own", claim = "Second order to the interpolant", tier = "quick" }
    exact.u = [{ x = "sin(2*x)", t = "cos(t)" }]
    exact.phi = [{ x = "x^2", t = "exp(-t)" }]
    refine = { axis = "space", isolate = true, elements = [16, 32, 64, 128, 256], steps = 10, t_end = 1.0, tolerance = 1e-13 }
    expect = [{ norm = "superclose", order = 2.0, tolerance = 0.02 }]
"#;

fn product(x: &str, t: &str) -> Result<Vec<Product>, ExpressionError> {
    let (x, t) = (
        Expression::parse(x, Variable::X)?,
        Expression::parse(t, Variable::T)?,
    );
    Ok(vec![Product {
        x: x.into(),
        t: t.into(),
    }])
}

fn in_rust() -> Result<Orders<Convergence>, ExpressionError> {
    let exact = Manufactured {
        u: product("sin(2*x)", "cos(t)")?,
        phi: product("x^2", "exp(-t)")?,
        theta: vec![],
    };
    let refine = Refine {
        axis: RefinedIn::Space,
        isolate: true,
        elements: vec![16, 32, 64, 128, 256],
        steps: vec![10],
        grid: false,
        budget: None,
        t_end: 1.0,
        layout: Layout::default(),
        scheme: EULER_CRANK_NICOLSON,
        settings: Settings {
            stopping: Stopping::below(1e-13),
            ..Settings::default()
        },
    };
    let theory = Coefficients {
        beam: Beam::default(),
        obstacles: None,
    };
    Ok(Orders(Convergence {
        theory,
        solver: theory,
        exact,
        refine,
        expect: vec![(Norm::Superclose, Claim::new(2.0, 0.02))],
        constant: None,
        formulas: None,
    }))
}

fn main() -> Result<(), Box<dyn Error>> {
    let (rust, toml) = (
        in_rust()?,
        Orders::<Convergence>::parse(TOML, "my-own.toml".as_ref())?,
    );
    // Cases are pure: they may run in any order, on any thread.
    let (rust, toml) = (run_one(&rust), run_one(&toml));
    for (level, error) in rust
        .levels
        .iter()
        .map(|level| (level, level.error("superclose")))
    {
        println!(
            "n = {:3}   superclose {error:.4e}",
            level.parameter("elements").unwrap_or(f64::NAN)
        );
    }
    println!("{}: {}", rust.verdict, rust.rates[0].rate.reason);
    assert_eq!(rust.levels, toml.levels);
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
