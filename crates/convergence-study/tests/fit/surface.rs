//! The surface over a grid of (h, dt).

use convergence_study::judge::fit::{SurfaceError, SurfacePoint, fit_surface};

use crate::quantiles;
use crate::regression::regression;

fn grid(error: impl Fn(f64, f64) -> f64) -> Vec<SurfacePoint> {
    let steps = [8.0, 16.0, 32.0, 64.0, 128.0].map(|n: f64| 1.0 / n);
    steps.iter().flat_map(|&h| steps.map(|dt| SurfacePoint { h, dt, error: error(h, dt) })).collect()
}

#[test]
fn a_surface_of_squares_is_recovered_exactly() {
    for (p, q) in [(1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (2.0, 2.0), (1.3, 0.7)] {
        let data = grid(|h, dt| (0.4 * h.powf(p)).hypot(2.5 * dt.powf(q)));
        let fit = fit_surface(&data, &quantiles()).expect("regular");
        let found = [fit.p, fit.q, fit.c_h, fit.c_t];
        let close = found.iter().zip([p, q, 0.4, 2.5]).all(|(found, exact)| (found - exact).abs() < 1e-6);
        assert!(close && fit.rms < 1e-7, "({p}, {q}): {fit:?}");
        assert!(fit.rms_additive > 100.0 * fit.rms, "the additive surface must fit worse: {fit:?}");
    }
}

/// Deterministic scatter of log e, uniform with standard deviation `deviation`.
fn scattered(seed: u64, deviation: f64, data: &mut [SurfacePoint]) {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    for point in data {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let uniform = (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        point.error *= (deviation * 12.0_f64.sqrt() * uniform).exp();
    }
}

#[test]
fn the_joint_region_holds_the_orders_95_times_in_100() {
    let (mut joint, mut single) = (0, 0);
    for seed in 0..400 {
        let mut data = grid(|h, dt| (0.4 * h).hypot(0.7 * dt));
        scattered(seed + 1, 0.03, &mut data);
        let fit = fit_surface(&data, &quantiles()).expect("regular");
        joint += usize::from(fit.region.contains(1.0, 1.0));
        single += usize::from(fit.p_interval[0] <= 1.0 && 1.0 <= fit.p_interval[1]);
        assert!((0.5..2.0).contains(&(fit.rms / 0.03)), "{}", fit.rms);
    }
    assert!((366..=394).contains(&joint), "joint {joint} of 400");
    assert!((366..=394).contains(&single), "p alone {single} of 400");
}

#[test]
fn the_border_of_the_region_is_an_ellipse_of_constant_distance() {
    let mut data = grid(|h, dt| (0.4 * h).hypot(0.7 * dt));
    scattered(7, 0.03, &mut data);
    let fit = fit_surface(&data, &quantiles()).expect("regular");
    let (spp, spq, sqq) = (fit.covariance[1][1], fit.covariance[1][3], fit.covariance[3][3]);
    // F_{2, 21} at 95 % is 3.4668.
    let distance = |dp: f64, dq: f64| {
        (sqq * dp * dp - 2.0 * spq * dp * dq + spp * dq * dq) / (spp * sqq - spq * spq) / (2.0 * 3.466_8)
    };
    let (sin, cos) = fit.region.angle.sin_cos();
    let [long, short] = fit.region.semi_axes;
    assert!(long >= short && short > 0.0);
    for k in 0..12 {
        let (t_sin, t_cos) = (f64::from(k) * 0.5).sin_cos();
        let (dp, dq) = (cos * long * t_cos - sin * short * t_sin, sin * long * t_cos + cos * short * t_sin);
        assert!((distance(dp, dq) - 1.0).abs() < 1e-4, "{}", distance(dp, dq));
        assert!(fit.region.contains(fit.p + 0.999 * dp, fit.q + 0.999 * dq));
        assert!(!fit.region.contains(fit.p + 1.001 * dp, fit.q + 1.001 * dq));
    }
    assert!(!fit.region.contains(f64::NAN, fit.q));
}

#[test]
fn a_surface_needs_enough_usable_points() {
    let data = grid(|h, dt| h + dt);
    assert_eq!(fit_surface(&data[..4], &quantiles()), Err(SurfaceError::TooFewPoints { found: 4 }));
    let mut broken = data.clone();
    broken[3].error = f64::NAN;
    assert!(matches!(fit_surface(&broken, &quantiles()), Err(SurfaceError::Unusable { index: 3, .. })));
    broken[3].error = 0.0;
    assert!(matches!(fit_surface(&broken, &quantiles()), Err(SurfaceError::Unusable { index: 3, .. })));
}

#[test]
fn a_grid_that_cannot_tell_p_gives_no_narrow_interval() {
    let fixed: Vec<SurfacePoint> = grid(|_, dt| dt).into_iter().map(|point| SurfacePoint { h: 0.1, ..point }).collect();
    match fit_surface(&fixed, &quantiles()) {
        Err(_) => {}
        Ok(fit) => assert!(fit.p_interval[1] - fit.p_interval[0] > 1.0, "{fit:?}"),
    }
}

/// At the minimum no residual can be lowered, and the covariance is rss / dof (JᵀJ)⁻¹ with a Jacobian by differences.
#[test]
fn a_surface_is_the_minimum_and_its_covariance_is_that_of_the_linearised_regression() {
    let mut data = grid(|h, dt| (0.4 * h.powf(1.1)).hypot(0.7 * dt.powf(1.8)));
    scattered(3, 0.03, &mut data);
    let fit = fit_surface(&data, &quantiles()).expect("regular");
    let residuals = |c: [f64; 4]| {
        let model = |point: &SurfacePoint| (c[0].exp() * point.h.powf(c[1])).hypot(c[2].exp() * point.dt.powf(c[3]));
        data.iter().map(|point| (model(point) / point.error).ln()).collect::<Vec<f64>>()
    };
    let found = [fit.c_h.ln(), fit.p, fit.c_t.ln(), fit.q];
    let at = residuals(found);
    let rss: f64 = at.iter().map(|residual| residual * residual).sum();
    assert!((fit.rms - (rss / 25.0).sqrt()).abs() < 1e-12);
    let derivative = |k: usize| -> Vec<f64> {
        let shifted = |by: f64| residuals(std::array::from_fn(|j| found[j] + if j == k { by } else { 0.0 }));
        shifted(1e-5).iter().zip(shifted(-1e-5)).map(|(above, below)| (above - below) / 2e-5).collect()
    };
    let linearised = regression(&[0, 1, 2, 3].map(derivative), &at);
    for k in 0..4 {
        let deviation = fit.covariance[k][k].sqrt();
        assert!(linearised.coefficients[k].abs() < 1e-4 * deviation, "Gauss and Newton would still move: {k}");
        for j in 0..4 {
            let expected = rss / 21.0 * linearised.inverse[(k, j)];
            let scale = deviation * fit.covariance[j][j].sqrt();
            assert!((fit.covariance[k][j] - expected).abs() < 1e-5 * scale, "{k} {j}: {:?}", fit.covariance);
        }
    }
    for (interval, k) in [(fit.p_interval, 1), (fit.q_interval, 3)] {
        let half = quantiles().t(21) * fit.covariance[k][k].sqrt();
        assert!((interval[0] - found[k] + half).abs() < 1e-12 && (interval[1] - found[k] - half).abs() < 1e-12);
    }
    assert_eq!((fit.dof, fit.region.centre, fit.region.confidence), (21, [fit.p, fit.q], 0.95));
}

#[test]
fn five_points_are_enough_and_steps_of_no_size_are_named() {
    let data = grid(|h, dt| h.hypot(dt));
    let five = [1, 4, 14, 20, 22].map(|k| data[k]);
    assert_eq!(fit_surface(&five, &quantiles()).map(|fit| fit.dof), Ok(1));
    for (h, dt) in [(0.0, 0.1), (0.1, -0.1), (f64::INFINITY, 0.1), (0.1, f64::NAN)] {
        let mut broken = data.clone();
        broken[7] = SurfacePoint { h, dt, error: 1.0 };
        assert!(matches!(fit_surface(&broken, &quantiles()), Err(SurfaceError::Unusable { index: 7, .. })));
    }
}

#[test]
fn the_sum_of_the_contributions_is_told_from_the_root_of_their_squares() {
    let sum = fit_surface(&grid(|h, dt| 0.4 * h.powf(1.2) + 0.7 * dt), &quantiles()).expect("regular");
    assert!(sum.rms_additive < 1e-7 && sum.rms > 1e-3, "{sum:?}");
}

/// The iteration gives up from every start; what it has then is no minimum.
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
    let found = fit_surface(&wild.map(|(h, dt, error)| SurfacePoint { h, dt, error }), &quantiles());
    assert!(matches!(found, Err(SurfaceError::NotConverged(_))), "{found:?}");
}
