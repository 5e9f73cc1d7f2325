//! Variants of exact solutions: loads, initial data and errors follow; a coefficient that is wrong
//! in the solver is named by them, and nothing else is.

use convergence_study::variants::{Search, SolverPart};

use super::*;

/// A study of the repository on coarse levels, with more in its file.
fn study(name: &str, more: &str) -> Orders<Convergence> {
    let text = text(name);
    // Along h = dt the levels of the file are used.
    let is_one_axis = !text.contains("axis = \"both\"");
    let mut lines = vec![];
    for line in text.lines() {
        let key = line.split([' ', '=']).next().unwrap_or_default();
        lines.push(match key {
            "elements" if is_one_axis && line.contains(',') => "elements = [16, 32, 64, 128, 256]",
            "steps" if is_one_axis && line.contains(',') => "steps = [256, 512, 1024, 2048, 4096]",
            // Not that of Newton's method.
            "tolerance" if !line.contains("e-") => "tolerance = 0.1",
            "[constant]" | "within" => "",
            _ => line,
        });
    }
    let text = lines.join("\n") + more;
    Orders::parse(&text, &file(name)).unwrap()
}

/// The outcome with a variant.
fn outcome(study: &Orders<Convergence>, variant: &str) -> Outcome {
    run_one(&study.with_variant(variant).unwrap())
}

#[test]
fn each_variant_of_a_right_solver_has_the_orders_of_its_study() {
    for name in [
        "theorem-3.4-space.toml",
        "theorem-3.4-time.toml",
        "theorem-3.4-coupled.toml",
        "theta-a-20-space.toml",
        "contact-throughout-space.toml",
    ] {
        let study = study(name, "");
        let variants = study.variants().unwrap();
        for variant in &variants.usable {
            let outcome = outcome(&study, &variant.name);
            for NamedRate {
                name: norm, rate, ..
            } in &outcome.rates
            {
                // Without a field the curvature may be superclose; a rate may be undecided.
                let is_reached = rate.verdict != Verdict::Fail || rate.code == Reason::TooHigh;
                assert!(
                    is_reached,
                    "{name}, {}: {norm}: {}",
                    variant.name, rate.reason
                );
            }
            assert!(variant.size > 0.0, "{name}, {}", variant.name);
        }
    }
}

#[test]
fn a_wrong_coefficient_is_named_and_no_other_part() {
    let parameter = |name: &str| vec![SolverPart::Parameter(name.to_owned())];
    for (name, control, named) in [
        ("theorem-3.4-space.toml", "a = 0.6", parameter("a")),
        ("theorem-3.4-space.toml", "rho = 2.3", parameter("rho")),
        ("theorem-3.4-time.toml", "rho = 2.3", parameter("rho")),
        // Viscosity acts on what changes in time.
        (
            "theorem-3.4-space.toml",
            "zeta = 0.12",
            vec![SolverPart::Time("t".to_owned())],
        ),
        (
            "contact-throughout-space.toml",
            "epsilon = 0.012",
            vec![SolverPart::Face("x_max".to_owned())],
        ),
    ] {
        let study = study(name, &format!("\n[control]\n{control}\n"));
        let base = run_one(&study);
        assert_eq!(base.verdict, Verdict::Fail, "{name}, {control}");
        let variants = study.variants().unwrap();
        let mut search = Search::new(&base, &variants, None);
        loop {
            let requests = search.next();
            if requests.is_empty() {
                break;
            }
            for request in requests {
                let variant = &variants.usable[request.place].name;
                search.add(request, outcome(&study, variant));
            }
        }
        let where_lost = search.where_lost();
        let text = where_lost.text();
        assert_eq!(where_lost.named, named, "{name}, {control}: {text}");
    }
}
