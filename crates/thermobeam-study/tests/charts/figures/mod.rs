//! Made-up but realistic data, one set per figure.

use convergence_study::chart::Guide;
use thermobeam_study::figures::*;

/// Every figure of a beam, drawn.
pub(crate) fn gallery() -> Vec<(&'static str, String)> {
    vec![
        ("contraction", contraction(&contraction_factors())),
        ("bifurcation", equilibria()),
    ]
}

/// A series of a contraction.
pub(crate) fn series(label: &str, points: Vec<(f64, f64)>) -> NamedPoints {
    NamedPoints {
        label: label.into(),
        points,
    }
}

pub(crate) fn contraction_factors() -> ContractionFactors {
    let dt = |k: i32| 10f64.powf(-4.0 + 0.25 * f64::from(k));
    let alpha = |eps: f64, k: i32| dt(k).powf(1.5) / (eps * 0.1_f64.sqrt());
    let family = |eps: f64, ks: std::ops::Range<i32>| {
        ks.map(|k| (alpha(eps, k), 0.985 * alpha(eps, k))).collect()
    };
    ContractionFactors {
        title: "The fixed point contracts as predicted".into(),
        predicted: "predicted factor".into(),
        measured: vec![
            series("ε = 10⁻²", family(1e-2, 0..9)),
            series("ε = 10⁻³", family(1e-3, 0..7)),
            series("ε = 10⁻⁴", family(1e-4, 0..5)),
        ],
        estimates: series("an estimate", vec![(1e-3, 2e-3), (1e-2, 1.3e-2)]),
    }
}

/// A branch of a bifurcation.
pub(crate) fn branch(label: &str, stable: bool, points: Vec<(f64, f64)>) -> EquilibriumBranch {
    EquilibriumBranch {
        label: label.into(),
        points,
        stable,
    }
}

pub(crate) fn equilibria() -> String {
    let beta = |k: i32| -1.4 + 0.01 * f64::from(k);
    let pitchfork = |sign: f64| {
        (0..69)
            .map(|k| (beta(k), sign * 0.6 * (-0.7116 - beta(k)).max(0.0).sqrt()))
            .filter(|p| p.1.abs() < 0.1)
            .collect()
    };
    let branches = [
        branch("free", true, (69..140).map(|k| (beta(k), 0.0)).collect()),
        branch("free", false, (0..70).map(|k| (beta(k), 0.0)).collect()),
        branch("free", true, pitchfork(1.0)),
        branch(
            "upper contact",
            true,
            (0..66).map(|k| (beta(k), 0.1 + 1e-5)).collect(),
        ),
        branch(
            "lower contact",
            true,
            (0..68).map(|k| (beta(k), -0.05)).collect(),
        ),
    ];
    let obstacles = [("g₁", -0.05), ("g₂", 0.1)].map(|(label, value)| Guide {
        label: label.into(),
        value,
    });
    let ends = vec![(-1.2, 0.1), (-0.9, -0.05), (-0.72, 0.055), (-0.3, 0.0)];
    bifurcation(&Bifurcation {
        title: "Several equilibria below β = −0.7116".into(),
        branches: branches.into(),
        obstacles: obstacles.into(),
        ends,
    })
}
