//! The surface over a grid of (h, dt).

use thermobeam_study::kinds::work_precision::law::{GridPoint, fit_surface};

fn grid(error: impl Fn(f64, f64) -> f64) -> Vec<GridPoint> {
    let steps = [8.0, 16.0, 32.0, 64.0, 128.0].map(|n: f64| 1.0 / n);
    steps
        .iter()
        .flat_map(|&h| {
            steps.map(|dt| GridPoint {
                h,
                dt,
                error: error(h, dt),
                ..GridPoint::default()
            })
        })
        .collect()
}

fn refused(points: &[GridPoint]) -> String {
    fit_surface(points).expect_err("a refusal")
}

#[test]
fn a_surface_of_squares_is_recovered_exactly() {
    for (p, q) in [(1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (2.0, 2.0), (1.3, 0.7)] {
        let data = grid(|h, dt| (0.4 * h.powf(p)).hypot(2.5 * dt.powf(q)));
        let fit = fit_surface(&data).expect("regular");
        let found = [fit.p, fit.q, fit.c_h, fit.c_t];
        let close = found
            .iter()
            .zip([p, q, 0.4, 2.5])
            .all(|(found, exact)| (found - exact).abs() < 1e-6);
        assert!(close && fit.rms < 1e-7, "({p}, {q}): {fit:?}");
    }
}

/// Deterministic scatter of log e, uniform with standard deviation `deviation`.
fn scattered(seed: u64, deviation: f64, data: &mut [GridPoint]) {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    for point in data {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let uniform = (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        point.error *= (deviation * 12.0_f64.sqrt() * uniform).exp();
    }
}

#[test]
fn a_surface_needs_enough_usable_points() {
    let data = grid(|h, dt| h + dt);
    assert!(refused(&data[..4]).starts_with("4 points: at least 5"));
    let mut broken = data.clone();
    broken[3].error = f64::NAN;
    assert!(refused(&broken).starts_with("point 3: "));
    broken[3].error = 0.0;
    assert!(refused(&broken).starts_with("point 3: "));
}

/// At the minimum no residual can be lowered.
#[test]
fn a_surface_is_the_minimum() {
    let mut data = grid(|h, dt| (0.4 * h.powf(1.1)).hypot(0.7 * dt.powf(1.8)));
    scattered(3, 0.03, &mut data);
    let fit = fit_surface(&data).expect("regular");
    let rms = |c: [f64; 4]| {
        let model = |point: &GridPoint| {
            (c[0].exp() * point.h.powf(c[1])).hypot(c[2].exp() * point.dt.powf(c[3]))
        };
        (data
            .iter()
            .map(|point| (model(point) / point.error).ln().powi(2))
            .sum::<f64>()
            / data.len() as f64)
            .sqrt()
    };
    let found = [fit.c_h.ln(), fit.p, fit.c_t.ln(), fit.q];
    assert!(
        (fit.rms - rms(found)).abs() < 1e-12 && (0.5..2.0).contains(&(fit.rms / 0.03)),
        "{fit:?}"
    );
    for k in 0..4 {
        for by in [1e-3, -1e-3] {
            let beside = std::array::from_fn(|j| found[j] + if j == k { by } else { 0.0 });
            assert!(rms(beside) > fit.rms, "{k} {by}: {fit:?}");
        }
    }
}

#[test]
fn five_points_are_enough_and_steps_of_no_size_are_named() {
    let data = grid(|h, dt| h.hypot(dt));
    let five = [1, 4, 14, 20, 22].map(|k| data[k]);
    assert!(fit_surface(&five).is_ok());
    for (h, dt) in [
        (0.0, 0.1),
        (0.1, -0.1),
        (f64::INFINITY, 0.1),
        (0.1, f64::NAN),
    ] {
        let mut broken = data.clone();
        broken[7] = GridPoint {
            h,
            dt,
            error: 1.0,
            ..GridPoint::default()
        };
        assert!(refused(&broken).starts_with("point 7: "));
    }
}

/// The iteration stops from every start before it reaches a minimum.
#[test]
fn a_fit_that_does_not_converge_is_none() {
    let (least, largest) = (5e-324, 1e308);
    let wild = [
        (least, 1.0, 1.0),
        (largest, largest, least),
        (largest, least, largest),
        (1.0, 1.0, 1.0),
        (least, largest, largest),
    ];
    let found = refused(&wild.map(|(h, dt, error)| GridPoint {
        h,
        dt,
        error,
        ..GridPoint::default()
    }));
    assert!(found.starts_with("the fit did not converge: "), "{found}");
}
