//! J and its derivatives along a direction, which may be wrong in many ways.

const M: [f64; 3] = [0.3, -0.4, 0.9];

/// J at m + εd, and the derivatives at m.
///
/// * `mode`: what is wrong.
pub(crate) fn answer(mode: &str, eps: f64, seed: f64) -> String {
    let direction = match mode {
        // Along the first direction J is at an extremum of a coordinate it alone depends on.
        "first-vanishes" if seed == 1.0 => [0.0, 0.0, 1.0],
        _ => [seed.sin(), (2.0 * seed).cos(), (3.0 * seed).sin()],
    };
    let m = match mode {
        "stationary" => [0.0; 3],
        "first-vanishes" => [0.3, -0.4, 0.0],
        _ => M,
    };
    let point: Vec<f64> = m.iter().zip(direction).map(|(m, d)| m + eps * d).collect();
    let value = match mode {
        "outside" if eps > 0.02 => f64::NAN,
        "crash" if eps > 0.02 => std::process::abort(),
        "ignored" => misfit(&m),
        "line" => point.iter().sum(),
        "corner" => misfit(&point) + (1e-2 * eps).abs(),
        _ => misfit(&point),
    };
    let slope = |m: &[f64]| -> f64 { product(&gradient(m), &direction) };
    let slope = match mode {
        "1e-3" => slope(&m) * (1.0 + 1e-3),
        "1e-5" => slope(&m) * (1.0 - 1e-5),
        "sign" => -slope(&m),
        "component" => slope(&m) + 1e-3 * gradient(&m)[1] * direction[1],
        "elsewhere" => slope(&m.map(|x| x + 1e-3)),
        "line" => direction.iter().sum(),
        _ => slope(&m),
    };
    let terms = if mode == "hessian" { 2 } else { 3 };
    let curvature = curvature(&m[..terms], &direction);
    if mode == "digits" {
        return format!(r#"{{"values": {{"J": {value:.5}, "dJ": {slope:.12}}}}}"#);
    }
    let value = if value.is_nan() {
        "NaN".to_owned()
    } else {
        format!("{value:?}")
    };
    if eps != 0.0 {
        let failed = if mode == "failed" {
            "\nNewton did not converge"
        } else {
            ""
        };
        return format!(r#"{{"values": {{"J": {value}}}}}{failed}"#);
    }
    format!(r#"{{"values": {{"J": {value}, "dJ": {slope:?}, "d2J": {curvature:?}}}}}"#)
}

fn misfit(m: &[f64]) -> f64 {
    let terms = m.iter().enumerate();
    terms.map(|(k, x)| ((k + 1) as f64 * x).sin().powi(2)).sum()
}

fn gradient(m: &[f64]) -> Vec<f64> {
    let terms = m.iter().enumerate().map(|(k, x)| ((k + 1) as f64, x));
    terms.map(|(k, x)| k * (2.0 * k * x).sin()).collect()
}

fn curvature(m: &[f64], direction: &[f64]) -> f64 {
    let terms = m.iter().zip(direction).enumerate();
    let terms = terms.map(|(k, (x, d))| ((k + 1) as f64, x, d));
    terms
        .map(|(k, x, d)| 2.0 * k * k * (2.0 * k * x).cos() * d * d)
        .sum()
}

fn product(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}
