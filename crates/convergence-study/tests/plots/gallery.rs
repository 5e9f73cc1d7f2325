//! Made-up data that look like the real thing, one set per figure.

use convergence_judge::judge::verdict::PowerLaw;
use convergence_study::internal::plots::xy::Xy;
use convergence_study::internal::plots::*;
use convergence_study::{Band, Interval, Verdict};

/// Every figure, drawn.
pub(crate) fn gallery() -> Vec<(&'static str, String)> {
    vec![
        ("convergence-space", over_h(&space_errors())),
        (
            "convergence-time",
            convergence(over_dt(), &time_errors(), &[]),
        ),
        ("surface", surface(&error_surface())),
        ("history-long", long_history(100_000).draw()),
        ("history-energy", energy_history().draw()),
        ("history-log", balance_history().draw()),
        ("space-time", space_time(&wave(400, 200))),
        ("iterations", iteration_counts().draw()),
        ("parameter-map", surface(&stability_map())),
        (
            "work-precision",
            work_precision("run time (s)", "error in u(T) (dimensionless)", &costs())
                .titled("The midpoint rule reaches every error first")
                .draw(),
        ),
        ("forest", over_tolerances()),
        ("variants", over_variants()),
        ("hostile", hostile().draw()),
    ]
}

fn series(label: &str, points: Vec<(f64, f64)>) -> Series {
    Series {
        label: label.into(),
        points,
    }
}

fn errors(label: &str, constant: f64, order: f64, steps: &[f64]) -> ErrorSeries {
    let points: Vec<_> = steps
        .iter()
        .map(|&h| (h, constant * h.powf(order) * (1.0 + 0.3 * h)))
        .collect();
    ErrorSeries {
        label: label.into(),
        points,
        order: Some(order),
        fit: Some(PowerLaw::new(order * 1.002, constant)),
        ..ErrorSeries::default()
    }
}

pub(crate) fn over_h(series: &[ErrorSeries]) -> String {
    let xy = Xy::of_errors("mesh width h").titled("Errors fall with h as the triangles do");
    convergence(xy, series, &[])
}

pub(crate) fn space_errors() -> Vec<ErrorSeries> {
    let h: Vec<f64> = (3..=12).map(|k| 0.5_f64.powi(k)).collect();
    let mut norms = vec![
        errors("velocity", 0.75, 2.0, &h),
        errors("shear", 0.96, 1.0, &h),
        errors("rotation-rate", 0.24, 2.0, &h),
        errors("curvature", 0.19, 1.0, &h),
        errors("temperature", 1.06, 2.0, &h),
        errors("energy norm", 1.3, 1.0, &h),
        errors("to the projection", 0.48, 2.0, &h),
    ];
    // Coarse levels that the rate does not use.
    norms[0].used = Some(3..10);
    // A norm that hides another one.
    norms.push(ErrorSeries {
        label: "energy norm, lumped".into(),
        ..norms[5].clone()
    });
    norms
}

pub(crate) fn time_errors() -> Vec<ErrorSeries> {
    let dt: Vec<f64> = (4..=10).map(|k| 0.5_f64.powi(k)).collect();
    let mut euler = errors("euler-crank-nicolson", 1.2, 1.0, &dt);
    euler.fit = None;
    vec![euler, errors("midpoint", 0.8, 2.0, &dt)]
}

pub(crate) fn over_dt() -> Xy {
    let title = Some("Time isolated: error over dt".into());
    Xy {
        title,
        guides: vec![Guide {
            label: "round-off".into(),
            value: 1e-8,
        }],
        ..Xy::of_errors("time step dt")
    }
}

pub(crate) fn error_surface() -> ColouredCells {
    let h: Vec<f64> = (2..=9).map(|k| 0.5_f64.powi(k)).collect();
    let values = h
        .iter()
        .map(|h| h.iter_dt().map(|dt| (0.9 * h).hypot(1.2 * dt)).collect())
        .collect();
    ColouredCells {
        title: Some("The error falls with both".into()),
        x: Axis::log("time step dt"),
        y: Axis::log("mesh width h"),
        z: Axis::log("error in the energy norm"),
        x_values: 1.0.iter_dt().collect(),
        y_values: h,
        values,
        ..ColouredCells::default()
    }
}

trait Steps {
    fn iter_dt(&self) -> Box<dyn Iterator<Item = f64>>;
}

impl Steps for f64 {
    fn iter_dt(&self) -> Box<dyn Iterator<Item = f64>> {
        Box::new((2..=10).map(|k| 0.5_f64.powi(k)))
    }
}

/// Decaying oscillations between two stops.
fn position(t: f64) -> f64 {
    let free = 0.16 * (-0.25 * t).exp() * (9.0 * t).sin() + 0.004 * (60.0 * t).sin();
    free.clamp(-0.0105, 0.1004)
}

fn stop_phases(t_end: f64) -> Phases {
    let mut intervals: Vec<(f64, f64)> = Vec::new();
    let mut start = None;
    for k in 0..20_000 {
        let t = t_end * f64::from(k) / 20_000.0;
        let touches = position(t) <= -0.01 || position(t) >= 0.1;
        match (touches, start) {
            (true, None) => start = Some(t),
            (false, Some(from)) => {
                intervals.push((from, t));
                start = None;
            }
            _ => {}
        }
    }
    Phases {
        label: "at a stop".into(),
        intervals,
    }
}

pub(crate) fn long_history(samples: u32) -> Xy {
    let t = |k: u32| 10.0 * f64::from(k) / f64::from(samples);
    let curves = [
        series(
            "euler-crank-nicolson",
            (0..samples).map(|k| (t(k), position(t(k)))).collect(),
        ),
        series(
            "midpoint",
            (0..samples)
                .map(|k| (t(k), 0.7 * position(t(k) + 0.05)))
                .collect(),
        ),
    ];
    Xy {
        guides: vec![
            Guide {
                label: "g₁ = −0.01".into(),
                value: -0.01,
            },
            Guide {
                label: "g₂ = 0.1".into(),
                value: 0.1,
            },
        ],
        title: Some("The body stays between its stops".into()),
        phases: stop_phases(10.0),
        ..history(Axis::linear("displacement u(t) (dimensionless)"), &curves)
    }
}

pub(crate) fn energy_history() -> Xy {
    let t = |k: u32| 10.0 * f64::from(k) / 2000.0;
    let energy = |beta: f64, rate: f64| {
        (0..2000)
            .map(|k| {
                (
                    t(k),
                    0.25 * beta * beta
                        + 4.0 * (-rate * t(k)).exp() * (1.0 + 0.1 * (5.0 * t(k)).cos()),
                )
            })
            .collect()
    };
    let curves = [
        series("β = 0", energy(0.0, 0.5)),
        series("β = −2", energy(2.0, 0.9)),
        series("β = 2.1", energy(2.1, 1.4)),
    ];
    Xy {
        title: Some("Energy falls to its level at rest".into()),
        guides: vec![
            Guide {
                label: "β²/(4ρ)".into(),
                value: 1.0,
            },
            Guide {
                label: "2.1²/(4ρ)".into(),
                value: 1.1025,
            },
        ],
        ..history(Axis::linear("energy E (dimensionless)"), &curves)
    }
}

pub(crate) fn balance_history() -> Xy {
    let noise = |k: u32| f64::from(k.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24);
    let residual = |scale: f64, seed: u32| {
        (0..30_000)
            .map(|k| {
                (
                    f64::from(k) / 3000.0,
                    if k == 7 { 0.0 } else { scale * noise(k + seed) },
                )
            })
            .collect()
    };
    let curves = [
        series("newton", residual(5e-15, 1)),
        series("fixed-point", residual(3e-11, 2)),
    ];
    Xy {
        title: Some("The balance closes to round-off".into()),
        phases: stop_phases(10.0),
        ..history(Axis::log("residual of the energy balance"), &curves)
    }
}

pub(crate) fn wave(frames: u32, nodes: u32) -> SpaceTime {
    let times: Vec<f64> = (0..frames)
        .map(|n| 10.0 * f64::from(n) / f64::from(frames - 1))
        .collect();
    let x: Vec<f64> = (0..nodes)
        .map(|i| f64::from(i) / f64::from(nodes - 1))
        .collect();
    let field = |t: f64, x: f64| {
        position(t) * x * x * (3.0 - x) / 2.0
            + 0.02 * (-0.1 * t).exp() * (7.85 * x).sin() * (19.0 * t).cos()
    };
    SpaceTime {
        title: Some("Waves run to the free end and back".into()),
        label: "displacement u (dimensionless)".into(),
        frames: times
            .iter()
            .map(|&t| x.iter().map(|&x| field(t, x)).collect())
            .collect(),
        times,
        nodes: x,
    }
}

pub(crate) fn iteration_counts() -> Xy {
    let phases = stop_phases(3.0);
    let is_stopped = |t: f64| phases.intervals.iter().any(|&(a, b)| a <= t && t <= b);
    let count = |base: f64, more: f64| {
        (1..=3000)
            .map(|k| {
                (
                    f64::from(k) * 1e-3,
                    base + if is_stopped(f64::from(k) * 1e-3) {
                        more
                    } else {
                        0.0
                    },
                )
            })
            .collect()
    };
    let curves = [
        series("fixed point", count(5.0, 7.0)),
        series("newton", count(2.0, 1.0)),
    ];
    Xy {
        title: Some("More iterations at a stop".into()),
        phases: phases.clone(),
        ..iterations(&curves)
    }
}

pub(crate) fn stability_map() -> ColouredCells {
    let dt: Vec<f64> = (0..33)
        .map(|k| 10f64.powf(-5.0 + 0.1 * f64::from(k)))
        .collect();
    let eps: Vec<f64> = (0..25)
        .map(|k| 10f64.powf(-4.0 + 0.1 * f64::from(k)))
        .collect();
    let alpha = |dt: f64, eps: f64| dt.powf(1.5) / (eps * 0.1_f64.sqrt());
    let count = |a: f64| {
        if a < 1.0 {
            (23.0 / -a.ln()).ceil().clamp(2.0, 100.0)
        } else {
            f64::NAN
        }
    };
    let grid = |f: &dyn Fn(f64) -> f64| -> Vec<Vec<f64>> {
        eps.iter()
            .map(|&e| dt.iter().map(|&d| f(alpha(d, e))).collect())
            .collect()
    };
    let marked = grid(&|a| if a < 1.0 { 0.0 } else { 1.0 });
    let boundary = |factor: f64| {
        dt.iter()
            .map(|&d| (d, factor * alpha(d, 1.0)))
            .filter(|p| p.1 < 2.5e-2 && p.1 > 1e-4)
            .collect()
    };
    ColouredCells {
        title: Some("The fixed point fails where α reaches 1".into()),
        x: Axis::log("time step dt"),
        y: Axis::log("compliance ε (dimensionless)"),
        z: Axis::log("iterations per step"),
        values: grid(&count),
        x_values: dt.clone(),
        y_values: eps.clone(),
        marked: marked
            .iter()
            .map(|row| row.iter().map(|&v| v > 0.0).collect())
            .collect(),
        marked_label: "diverged".into(),
        boundaries: vec![
            series("predicted, α = 1", boundary(1.0)),
            series("measured", boundary(1.12)),
        ],
    }
}

pub(crate) fn costs() -> Vec<Series> {
    let run = |label: &str, c: f64, p: f64| {
        series(
            label,
            (0..7)
                .map(|k| (2e-3 * 2f64.powi(k), c * 0.5_f64.powf(p * f64::from(k))))
                .collect(),
        )
    };
    vec![
        run("euler-crank-nicolson, newton", 3e-2, 1.0),
        run("euler-crank-nicolson, fixed point", 8e-2, 1.0),
        run("midpoint, newton", 1e-2, 2.0),
    ]
}

/// Labels too long, markup, values that cannot be drawn, hardly any range.
pub(crate) fn hostile() -> Xy {
    let y = Axis::log(
        "a vertical label that goes on & on <for ever> and then for a little longer than that",
    );
    let curves = [
        series(
            "a series whose name does not fit into a legend of any reasonable width, whatever one may try to do",
            vec![
                (0.0, 1.0),
                (1.0, f64::NAN),
                (2.0, 1.000_000_1),
                (f64::INFINITY, 1.0),
                (3.0, -1.0),
            ],
        ),
        series("<b>&\u{0}", vec![(0.5, 1.000_000_05)]),
    ];
    Xy {
        title: Some(
            "A title so long that no page could ever hold it, not even one that was twice as wide as this one".into(),
        ),
        ..history(y, &curves)
    }
}

/// Rates that pass, that do not, that lie beyond the plot, and one that is missing.
pub(crate) fn all_rates() -> Vec<ForestRow> {
    let row = |label: &str, rate: Option<(f64, f64)>, verdict| ForestRow {
        label: label.into(),
        numbers: "1.000 to 1.004, claimed 1 ± 0.05".into(),
        value: rate.map(|(value, _)| value),
        interval: rate.map(|(value, half)| Interval::around(value, half)),
        verdict,
    };
    vec![
        row("lost-order: L2", Some((-20.0, 0.1)), Verdict::Fail),
        row("lost-order: H1", None, Verdict::Inconclusive),
        row("scattered: L2", Some((0.4, 1.1)), Verdict::Inconclusive),
        row("scattered: H1", Some((0.2, 3.0)), Verdict::Inconclusive),
        row("first-order: L2", Some((0.1, 0.2)), Verdict::Pass),
        row("first-order: H1", Some((-0.3, 0.1)), Verdict::Pass),
    ]
}

fn over_tolerances() -> String {
    forest("All rates", &ForestAxis::in_tolerances(), &all_rates())
}

/// Rates by variant of a solution.
fn over_variants() -> String {
    let claim = Band {
        order: 2.0,
        tolerance: 0.25,
    };
    let mut rows = all_rates();
    for (row, value) in rows.iter_mut().zip([-20.0, 1.0, 1.1, 0.2, 2.0, 1.98]) {
        row.value = Some(value);
        row.interval = Some(Interval::around(value, 0.1));
    }
    let rates: Vec<f64> = rows.iter().filter_map(|row| row.value).collect();
    let axis = ForestAxis::of_rates(claim, rates, ["back", "undecided", "lost"]);
    forest("The order comes back without x", &axis, &rows)
}
