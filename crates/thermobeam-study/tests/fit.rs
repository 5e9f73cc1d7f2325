//! The readings of a rate against answers known by other means.

use thermobeam_study::fit::{
    Level, Quantiles, SurfaceError, SurfacePoint, asymptotic_range, extrapolated_rate, fit_line, fit_surface,
    pairwise_rates, rate_interval,
};

fn quantiles() -> Quantiles {
    Quantiles::new(0.95).expect("a confidence")
}

fn levels(steps: &[f64], error: impl Fn(f64) -> f64) -> Vec<Level> {
    steps.iter().map(|&step| Level { step, error: error(step) }).collect()
}

const HALVED: [f64; 6] = [0.5, 0.25, 0.125, 0.0625, 0.03125, 0.015625];
const UNEVEN: [f64; 6] = [0.5, 0.3, 0.14, 0.1, 0.04, 0.03];

#[test]
fn student_quantiles_are_those_of_the_tables() {
    for (dof, t) in [(1, 12.706_204_736), (2, 4.302_652_730), (5, 2.570_581_836), (30, 2.042_272_456)] {
        assert!((quantiles().t(dof) - t).abs() < 1e-8, "dof {dof}");
    }
    assert_eq!(quantiles().t(0), f64::INFINITY);
    assert_eq!(quantiles().t(1000), quantiles().t(30));
    assert!(Quantiles::new(1.0).is_none() && Quantiles::new(0.0).is_none() && Quantiles::new(f64::NAN).is_none());
}

#[test]
fn every_reading_of_a_pure_power_is_its_order() {
    for steps in [HALVED, UNEVEN] {
        let data = levels(&steps, |h| 3.0 * h.powf(1.7));
        assert!(pairwise_rates(&data).iter().all(|rate| (rate - 1.7).abs() < 1e-12));
        let line = fit_line(&data, &quantiles()).expect("regular");
        assert!((line.slope - 1.7).abs() < 1e-12 && (line.intercept - 3.0_f64.ln()).abs() < 1e-12);
        let fit = rate_interval(&data, &quantiles()).expect("regular");
        assert!((fit.rate - 1.7).abs() < 1e-10 && fit.interval[0] <= 1.7 && 1.7 <= fit.interval[1]);
        assert!((extrapolated_rate(&data).expect("regular") - 1.7).abs() < 1e-9);
    }
}

#[test]
fn the_interval_of_a_line_is_that_of_the_textbook() {
    // log2 h = -1, -2, -3, -4 and log2 e = -1, -2.1, -2.9, -4: slope 0.98, rss 0.018, s² = 0.009, Σ(x - mean)² = 5.
    let data: Vec<Level> = [-1.0, -2.1, -2.9, -4.0_f64]
        .iter()
        .zip(1..)
        .map(|(exponent, k)| Level { step: 0.5_f64.powi(k), error: exponent.exp2() })
        .collect();
    let line = fit_line(&data, &quantiles()).expect("regular");
    let half = 4.302_652_73 * (0.009_f64 / 5.0).sqrt();
    assert!((line.slope - 0.98).abs() < 1e-12);
    assert!((line.interval[1] - line.slope - half).abs() < 1e-8, "{line:?} {half}");
}

#[test]
fn extrapolation_of_a_constant_ratio_is_aitkens() {
    let (q1, q2, q3): (f64, f64, f64) = (0.93, 0.96, 0.98);
    let errors = [0.0, q1, q1 + q2, q1 + q2 + q3].map(|sum: f64| (-sum).exp2());
    let data: Vec<Level> = errors.iter().zip(&HALVED).map(|(&error, &step)| Level { step, error }).collect();
    let aitken = q3 - (q3 - q2).powi(2) / ((q3 - q2) - (q2 - q1));
    assert!((extrapolated_rate(&data).expect("closing in") - aitken).abs() < 1e-9);
}

#[test]
fn extrapolation_gains_digits_on_smooth_data_with_uneven_steps() {
    let data = levels(&UNEVEN.map(|h| h / 8.0), |h| h * (1.0 + h));
    let finest = pairwise_rates(&data)[4];
    let limit = extrapolated_rate(&data).expect("closing in");
    assert!((limit - 1.0).abs() < 0.1 * (finest - 1.0).abs(), "{limit} against {finest}");
}

#[test]
fn extrapolation_declines_scatter_and_too_few_levels() {
    let noisy = levels(&HALVED, |h| h * if h.log2() as i64 % 2 == 0 { 1.02 } else { 0.98 });
    assert_eq!(extrapolated_rate(&noisy), None);
    assert_eq!(extrapolated_rate(&levels(&HALVED[..3], |h| h)), None);
    assert_eq!(extrapolated_rate(&[]), None);
    assert_eq!(extrapolated_rate(&levels(&HALVED, |_| f64::NAN)), None);
}

#[test]
fn pairwise_rates_keep_what_is_not_finite() {
    let data = [1.0, f64::NAN, 0.25, 0.0, 0.1, -0.1];
    let data: Vec<Level> = data.iter().zip(&HALVED).map(|(&error, &step)| Level { step, error }).collect();
    let rates = pairwise_rates(&data);
    assert!(rates[0].is_nan() && rates[1].is_nan() && rates[4].is_nan());
    assert_eq!((rates[2], rates[3]), (f64::INFINITY, f64::NEG_INFINITY));
}

#[test]
fn the_range_never_drops_a_plateau_above_the_floor() {
    let data = levels(&HALVED, |h| h * h + 1e-3);
    assert_eq!(asymptotic_range(&data, 1e-13).at_floor, 0);
    assert_eq!(asymptotic_range(&data, 1e-3).at_floor, 6);
    assert_eq!(asymptotic_range(&[], 0.0).used, 0..0);
}

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
