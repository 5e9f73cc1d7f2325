//! Made-up data that look like the real thing, one set per figure.

use crate::chart::*;
use crate::{Band as Claimed, Interval, Verdict};
use convergence_judge::verdict::judge_pairs;

/// Every figure, drawn.
pub(crate) fn gallery() -> Vec<(&'static str, String)> {
    vec![
        ("errors", errors_over_h().svg()),
        (
            "errors-without-rates",
            over_h(&[("L2", 0.8, 1.0), ("H1", 1.2, 1.0)]).svg(),
        ),
        ("history", long_history(100_000).svg()),
        ("history-log", noise(30_000, 2).svg()),
        ("cells", stability_map().svg()),
        ("field", field(200, 110).svg()),
        ("forest", deviations(all_rates()).titled("All rates").svg()),
        (
            "variants",
            over_variants()
                .titled("The order comes back without x")
                .svg(),
        ),
        ("hostile", hostile().svg()),
    ]
}

/// Steps, and errors of these orders over them: name, constant and order.
pub(crate) fn over_h(norms: &[(&str, f64, f64)]) -> Chart {
    let h: Vec<f64> = (3..=12).map(|k| 0.5_f64.powi(k)).collect();
    let mut table = Columns::new([("h", h.clone())]);
    let mut series = vec![];
    for (name, constant, order) in norms {
        table.push(
            *name,
            h.iter()
                .map(|h| constant * h.powf(*order) * (1.0 + 0.3 * h)),
        );
        series.push(Series::errors(*name, "h", *name));
    }
    Chart {
        series,
        ..Chart::new(table, Axis::log("mesh width h"), Axis::log("error"))
    }
    .titled("Errors fall with h as the triangles do")
}

/// The same with orders and the lines of their rates.
pub(crate) fn judged(norms: &[(&str, f64, f64)]) -> Chart {
    let mut chart = over_h(norms);
    for (series, (_, constant, order)) in chart.series.iter_mut().zip(norms) {
        let steps = (3..=12).map(|k| 0.5_f64.powi(k));
        let rate = judge_pairs(steps.map(|h| (h, constant * h.powf(*order))), *order, 0.1);
        *series = series.clone().claiming(*order).judged(&rate);
    }
    chart
}

/// Norms of two orders, of which one lies on another, and of which one does not use all levels.
pub(crate) fn errors_over_h() -> Chart {
    let mut chart = judged(&[
        ("velocity", 0.75, 2.0),
        ("shear", 0.96, 1.0),
        ("rotation-rate", 0.24, 2.0),
        ("curvature", 0.19, 1.0),
        ("temperature", 1.06, 2.0),
        ("energy norm", 1.3, 1.0),
        ("to the projection", 0.48, 2.0),
        ("energy norm, lumped", 1.301, 1.0),
    ]);
    chart.series[0].used = Some(3..10);
    chart.guides.push(Guide {
        label: "round-off".into(),
        value: 1e-8,
    });
    chart
}

/// Decaying oscillations between two stops.
fn position(t: f64) -> f64 {
    let free = 0.16 * (-0.25 * t).exp() * (9.0 * t).sin() + 0.004 * (60.0 * t).sin();
    free.clamp(-0.0105, 0.1004)
}

/// Between stops, shaded where it touches one.
pub(crate) fn long_history(samples: u32) -> Chart {
    let t = |k: u32| 10.0 * f64::from(k) / f64::from(samples);
    let guide = |label: &str, value| Guide {
        label: label.into(),
        value,
    };
    let touches = (0..2000)
        .map(|k| f64::from(k) / 200.0)
        .filter(|t| position(*t) >= 0.1);
    let y = Axis::linear("displacement u(t) (dimensionless)");
    let mut chart = Chart {
        guides: vec![guide("g₁ = −0.01", -0.01), guide("g₂ = 0.1", 0.1)],
        bands: vec![Shade {
            label: "at a stop".into(),
            intervals: touches.map(|t| (t, t + 0.005)).collect(),
        }],
        ..Chart::empty(Axis::linear("time t"), y)
    };
    chart.curve(
        "euler-crank-nicolson",
        (0..samples).map(|k| (t(k), position(t(k)))),
    );
    chart.curve(
        "midpoint",
        (0..samples).map(|k| (t(k), 0.7 * position(t(k) + 0.05))),
    );
    chart.titled("The body stays between its stops")
}

fn random(k: u32) -> f64 {
    f64::from(k.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24)
}

/// Noise on a logarithmic axis, once exactly zero.
pub(crate) fn noise(samples: u32, curves: u32) -> Chart {
    let y = Axis::log("residual of the balance");
    let mut chart = Chart::empty(Axis::linear("time t"), y);
    for curve in 0..curves {
        let scale = 1e-15 * 10f64.powf(f64::from(curve));
        let value = |k: u32| {
            if k == 7 {
                0.0
            } else {
                scale * random(k + curve)
            }
        };
        chart.curve(
            format!("series {curve}"),
            (0..samples).map(|k| (f64::from(k), value(k))),
        );
    }
    chart.titled("The balance closes to round-off")
}

/// Two scales of the same curves.
pub(crate) fn both_panels() -> String {
    let panel = |y: Axis, without_legend| {
        let mut chart = Chart {
            without_legend,
            ..Chart::empty(Axis::linear("time t"), y)
        };
        for (name, rate) in [("slow", 0.5), ("fast", 2.0)] {
            chart.curve(
                name,
                (0..100)
                    .map(|k| 0.1 * f64::from(k))
                    .map(|t| (t, (-rate * t).exp())),
            );
        }
        chart
    };
    let above = panel(Axis::linear("energy E"), false).titled("The energy falls");
    let below = panel(Axis::log("energy E"), false).titled("It falls exponentially");
    Chart::panels("Both scales", &[above, below])
}

/// Iterations over two parameters, hatched where they diverge, with the limit.
pub(crate) fn stability_map() -> Chart {
    let power = |from: f64, k: i32| 10f64.powf(from + 0.1 * f64::from(k));
    let mut columns = [vec![], vec![], vec![]];
    for (dt, eps) in (0..25).flat_map(|j| (0..33).map(move |k| (power(-5.0, k), power(-4.0, j)))) {
        let alpha = dt.powf(1.5) / (eps * 0.1_f64.sqrt());
        let count = if alpha < 1.0 {
            (23.0 / -alpha.ln()).ceil()
        } else {
            f64::NAN
        };
        columns
            .iter_mut()
            .zip([dt, eps, count])
            .for_each(|(column, value)| column.push(value));
    }
    let names = ["dt", "eps", "iterations"];
    let cells = Cells {
        x: "dt".into(),
        y: "eps".into(),
        value: "iterations".into(),
        colours: Axis::log("iterations per step"),
        missing: "diverged".into(),
    };
    let y = Axis::log("compliance ε (dimensionless)");
    let mut chart = Chart {
        cells: Some(cells),
        ..Chart::new(
            Columns::new(names.into_iter().zip(columns)),
            Axis::log("time step dt"),
            y,
        )
    };
    let limit = (0..33)
        .map(|k| power(-5.0, k))
        .map(|dt| (dt, dt.powf(1.5) / 0.1_f64.sqrt()));
    chart.curve(
        "predicted, α = 1",
        limit.filter(|(_, eps)| (1e-4..2.5e-2).contains(eps)),
    );
    chart.titled("The fixed point fails where α reaches 1")
}

/// Noise of both signs, which has no equal neighbours.
pub(crate) fn field(columns: u32, rows: u32) -> Chart {
    let cells = (0..rows).flat_map(|j| {
        (0..columns).map(move |k| [f64::from(k), f64::from(j), random(k + j * j) - 0.4])
    });
    let cells: Vec<[f64; 3]> = cells.collect();
    let column = |k: usize| cells.iter().map(|cell| cell[k]).collect::<Vec<f64>>();
    let table = Columns::new([("t", column(0)), ("x", column(1)), ("u", column(2))]);
    let cells = Cells {
        x: "t".into(),
        y: "x".into(),
        value: "u".into(),
        colours: Axis::linear("displacement u (dimensionless)").showing([0.0]),
        missing: String::new(),
    };
    Chart {
        cells: Some(cells),
        ..Chart::new(table, Axis::linear("time t"), Axis::linear("position x"))
    }
    .titled("Waves run to the free end and back")
}

/// Labels too long, markup, values that cannot be drawn, hardly any range.
pub(crate) fn hostile() -> Chart {
    let y = Axis::log(
        "a vertical label that goes on & on <for ever> and then for a little longer than that",
    );
    let mut chart = Chart::empty(Axis::linear("time t"), y);
    chart.curve(
        "a series whose name does not fit into a legend of any reasonable width, whatever one may try to do",
        [(0.0, 1.0), (1.0, f64::NAN), (2.0, 1.000_000_1), (f64::INFINITY, 1.0), (3.0, -1.0)],
    );
    chart.curve("<b>&\u{0}", [(0.5, 1.000_000_05)]);
    chart.titled("A title so long that no page could ever hold it, not even one that was twice as wide as this one")
}

/// Rates that pass, that do not, that lie beyond the plot, and one that is missing.
pub(crate) fn all_rates() -> Vec<Row> {
    let row = |name: &str, rate: Option<(f64, f64)>, verdict| Row {
        name: name.into(),
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

/// Rates by variant of a solution.
pub(crate) fn over_variants() -> Chart {
    let claim = Claimed {
        order: 2.0,
        tolerance: 0.25,
    };
    let mut rows = all_rates();
    for (row, value) in rows.iter_mut().zip([-20.0, 1.0, 1.1, 0.2, 2.0, 1.98]) {
        row.value = Some(value);
        row.interval = Some(Interval::around(value, 0.1));
    }
    rates_of(claim, ["back", "undecided", "lost"], rows)
}
