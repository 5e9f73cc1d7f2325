//! Functions whose derivatives are known, right and wrong.

use super::{Along, DEFAULT_TO, Finding, Judged, Second};
use crate::random::SplitMix;
use crate::verdict::Verdict;

type Function = fn(f64) -> f64;

/// A name, J, J', J'' and m.
type Row = (&'static str, Function, Function, Function, f64);

/// Forty functions of all sizes and curvatures, each with its first two derivatives. None is a
/// parabola.
const FUNCTIONS: [Row; 40] = [
    ("exp", f64::exp, f64::exp, f64::exp, 0.3),
    ("exp at -20", f64::exp, f64::exp, f64::exp, -20.0),
    ("sin", f64::sin, f64::cos, |x| -x.sin(), 0.7),
    ("cos", f64::cos, |x| -x.sin(), |x| -x.cos(), 0.9),
    (
        "tan",
        f64::tan,
        |x| x.cos().powi(-2),
        |x| 2.0 * x.tan() / x.cos().powi(2),
        0.4,
    ),
    ("ln", f64::ln, |x| 1.0 / x, |x| -1.0 / (x * x), 2.5),
    (
        "sqrt",
        f64::sqrt,
        |x| 0.5 / x.sqrt(),
        |x| -0.25 * x.powf(-1.5),
        3.0,
    ),
    (
        "cbrt",
        f64::cbrt,
        |x| x.powf(-2.0 / 3.0) / 3.0,
        |x| -2.0 / 9.0 * x.powf(-5.0 / 3.0),
        1.7,
    ),
    (
        "fifth",
        |x| x.powi(5),
        |x| 5.0 * x.powi(4),
        |x| 20.0 * x.powi(3),
        1.3,
    ),
    ("cube", |x| x.powi(3), |x| 3.0 * x * x, |x| 6.0 * x, 1.1),
    (
        "fourth",
        |x| x.powi(4),
        |x| 4.0 * x.powi(3),
        |x| 12.0 * x * x,
        -0.8,
    ),
    (
        "seventh",
        |x| x.powi(7),
        |x| 7.0 * x.powi(6),
        |x| 42.0 * x.powi(5),
        1.2,
    ),
    (
        "inverse",
        |x| 1.0 / x,
        |x| -1.0 / (x * x),
        |x| 2.0 / x.powi(3),
        0.9,
    ),
    (
        "inverse square",
        |x| x.powi(-2),
        |x| -2.0 * x.powi(-3),
        |x| 6.0 * x.powi(-4),
        1.6,
    ),
    (
        "atan",
        f64::atan,
        |x| 1.0 / (1.0 + x * x),
        |x| -2.0 * x / (1.0 + x * x).powi(2),
        0.6,
    ),
    (
        "asin",
        f64::asin,
        |x| (1.0 - x * x).powf(-0.5),
        |x| x * (1.0 - x * x).powf(-1.5),
        0.2,
    ),
    ("sinh", f64::sinh, f64::cosh, f64::sinh, 0.8),
    ("cosh", f64::cosh, f64::sinh, f64::cosh, 1.4),
    (
        "tanh",
        f64::tanh,
        |x| x.cosh().powi(-2),
        |x| -2.0 * x.tanh() / x.cosh().powi(2),
        0.5,
    ),
    (
        "gauss",
        |x| (-x * x).exp(),
        |x| -2.0 * x * (-x * x).exp(),
        |x| (4.0 * x * x - 2.0) * (-x * x).exp(),
        0.3,
    ),
    (
        "bump",
        |x| (1.0 + x * x).recip(),
        |x| -2.0 * x / (1.0 + x * x).powi(2),
        |x| (6.0 * x * x - 2.0) / (1.0 + x * x).powi(3),
        0.4,
    ),
    (
        "large",
        |x| 1e9 * x.sin(),
        |x| 1e9 * x.cos(),
        |x| -1e9 * x.sin(),
        0.7,
    ),
    (
        "small",
        |x| 1e-9 * x.sin(),
        |x| 1e-9 * x.cos(),
        |x| -1e-9 * x.sin(),
        0.7,
    ),
    ("offset", |x| 5.0 + x.sin(), f64::cos, |x| -x.sin(), 0.7),
    (
        "fast",
        |x| (5.0 * x).sin(),
        |x| 5.0 * (5.0 * x).cos(),
        |x| -25.0 * (5.0 * x).sin(),
        0.3,
    ),
    (
        "slow",
        |x| (0.2 * x).sin(),
        |x| 0.2 * (0.2 * x).cos(),
        |x| -0.04 * (0.2 * x).sin(),
        2.0,
    ),
    (
        "x exp",
        |x| x * x.exp(),
        |x| (1.0 + x) * x.exp(),
        |x| (2.0 + x) * x.exp(),
        0.2,
    ),
    ("x ln", |x| x * x.ln(), |x| 1.0 + x.ln(), |x| 1.0 / x, 2.0),
    (
        "x sin",
        |x| x * x.sin(),
        |x| x.sin() + x * x.cos(),
        |x| 2.0 * x.cos() - x * x.sin(),
        1.0,
    ),
    (
        "sin cos",
        |x| x.sin() * x.cos(),
        |x| (2.0 * x).cos(),
        |x| -2.0 * (2.0 * x).sin(),
        0.3,
    ),
    (
        "sin of square",
        |x| (x * x).sin(),
        |x| 2.0 * x * (x * x).cos(),
        |x| 2.0 * (x * x).cos() - 4.0 * x * x * (x * x).sin(),
        0.8,
    ),
    (
        "exp of sin",
        |x| x.sin().exp(),
        |x| x.cos() * x.sin().exp(),
        |x| (x.cos().powi(2) - x.sin()) * x.sin().exp(),
        0.5,
    ),
    (
        "logistic",
        |x| 1.0 / (1.0 + (-x).exp()),
        |x| logistic(x) * (1.0 - logistic(x)),
        |x| logistic(x) * (1.0 - logistic(x)) * (1.0 - 2.0 * logistic(x)),
        0.9,
    ),
    (
        "softplus",
        |x| x.exp().ln_1p(),
        logistic,
        |x| logistic(x) * (1.0 - logistic(x)),
        -0.4,
    ),
    (
        "double well",
        |x| (x * x - 1.0).powi(2),
        |x| 4.0 * x * (x * x - 1.0),
        |x| 12.0 * x * x - 4.0,
        0.3,
    ),
    (
        "rosenbrock",
        |x| (1.0 - x).powi(2) + 100.0 * (1.0 - x * x).powi(2),
        |x| -2.0 * (1.0 - x) - 400.0 * x * (1.0 - x * x),
        |x| 2.0 - 400.0 + 1200.0 * x * x,
        0.5,
    ),
    (
        "misfit",
        |x| 0.5 * (x.exp() - 2.0).powi(2),
        |x| (x.exp() - 2.0) * x.exp(),
        |x| (2.0 * x.exp() - 2.0) * x.exp(),
        0.4,
    ),
    (
        "power",
        |x| x.powf(2.3),
        |x| 2.3 * x.powf(1.3),
        |x| 2.99 * x.powf(0.3),
        1.8,
    ),
    (
        "two to the",
        |x| 2f64.powf(x),
        |x| 2f64.ln() * 2f64.powf(x),
        |x| 2f64.ln().powi(2) * 2f64.powf(x),
        0.1,
    ),
    (
        "sum",
        |x| x.sin() + x * x + x.exp(),
        |x| x.cos() + 2.0 * x + x.exp(),
        |x| -x.sin() + 2.0 + x.exp(),
        0.6,
    ),
];

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

/// Steps from a tenth, each a quarter of the one before.
fn steps() -> Vec<f64> {
    (0..13).map(|k| 0.1 * 0.25f64.powi(k)).collect()
}

fn along(function: impl Fn(f64) -> f64, m: f64, slope: f64, curvature: Option<f64>) -> Along {
    let steps = steps();
    let at = |sign: f64| steps.iter().map(|step| function(m + sign * step)).collect();
    let (forward, backward): (Vec<f64>, Vec<f64>) = (at(1.0), at(-1.0));
    Along {
        here: [function(m), function(m)],
        forward,
        slope,
        second: curvature.map(|curvature| Second {
            backward,
            curvature,
        }),
        steps,
    }
}

fn verdict(judged: &[Judged]) -> Verdict {
    Verdict::worst(judged.iter().map(Judged::verdict))
}

#[test]
fn right_derivatives_of_forty_functions_pass() {
    for (name, j, slope, curvature, m) in FUNCTIONS {
        let judged = along(j, m, slope(m), Some(curvature(m))).judge(DEFAULT_TO);
        assert!(
            verdict(&judged).is_pass(),
            "{name}: {} / {}",
            judged[0],
            judged[1]
        );
        let error = (judged[0].size.found - slope(m)).abs();
        assert!(error <= judged[0].size.bar, "{name}: {:?}", judged[0].size);
        let error = (judged[1].size.found - curvature(m)).abs();
        assert!(error <= judged[1].size.bar, "{name}: {:?}", judged[1].size);
    }
}

#[test]
fn a_slope_that_is_off_by_a_part_in_a_hundred_thousand_fails() {
    for (name, j, slope, _, m) in FUNCTIONS {
        for part in [1e-3, 1e-5, -1e-5, -2.0, -1.0] {
            let judged = along(j, m, slope(m) * (1.0 + part), None).judge(DEFAULT_TO);
            assert_eq!(
                judged[0].verdict(),
                Verdict::Fail,
                "{name}, {part}: {}",
                judged[0]
            );
        }
        let elsewhere = along(j, m, slope(m + 1e-3), None).judge(DEFAULT_TO);
        assert_eq!(
            elsewhere[0].finding,
            Finding::Wrong,
            "{name}: {}",
            elsewhere[0]
        );
    }
}

#[test]
fn a_curvature_that_lacks_a_term_fails() {
    for (name, j, slope, curvature, m) in FUNCTIONS {
        for part in [1e-3, -1e-3, -2.0, -1.0] {
            let claimed = curvature(m) * (1.0 + part);
            let judged = along(j, m, slope(m), Some(claimed)).judge(DEFAULT_TO);
            assert_eq!(
                judged[1].verdict(),
                Verdict::Fail,
                "{name}, {part}: {}",
                judged[1]
            );
            assert!(judged[0].verdict().is_pass(), "{name}: {}", judged[0]);
        }
    }
}

#[test]
fn a_stationary_point_tests_no_slope() {
    let judged = along(f64::cos, 0.0, 0.0, None).judge(DEFAULT_TO);
    assert_eq!(judged[0].finding, Finding::Vanishes, "{}", judged[0]);
    let wrong = along(f64::cos, 0.0, 0.01, None).judge(DEFAULT_TO);
    assert_eq!(wrong[0].finding, Finding::Wrong, "{}", wrong[0]);
}

#[test]
fn a_turning_point_tests_no_curvature() {
    let judged = along(f64::sin, 0.0, 1.0, Some(0.0)).judge(DEFAULT_TO);
    assert_eq!(judged[0].finding, Finding::Right, "{}", judged[0]);
    assert_eq!(judged[1].finding, Finding::Vanishes, "{}", judged[1]);
}

#[test]
fn a_parabola_tests_no_curvature_and_a_wrong_one_fails() {
    let judged = along(|x| x * x, 1.3, 2.6, Some(2.0)).judge(DEFAULT_TO);
    assert_eq!(judged[0].finding, Finding::Right, "{}", judged[0]);
    assert_eq!(judged[1].finding, Finding::NothingTested, "{}", judged[1]);
    let judged = along(|x| x * x, 1.3, 2.6, Some(2.001)).judge(DEFAULT_TO);
    assert_eq!(judged[1].finding, Finding::Wrong, "{}", judged[1]);
}

#[test]
fn a_line_and_a_constant_test_nothing_and_a_wrong_slope_of_them_fails() {
    let line = along(|x| 3.0 * x + 0.1, 0.7, 3.0, None).judge(DEFAULT_TO);
    assert_eq!(line[0].finding, Finding::NothingTested, "{}", line[0]);
    let constant = along(|_| 3.7, 0.7, 0.0, None).judge(DEFAULT_TO);
    assert_eq!(
        constant[0].finding,
        Finding::NothingTested,
        "{}",
        constant[0]
    );
    for (slope, j) in [(3.001, (|x| 3.0 * x) as Function), (0.1, |_| 3.7)] {
        let wrong = along(j, 0.7, slope, None).judge(DEFAULT_TO);
        assert_eq!(wrong[0].finding, Finding::Wrong, "{}", wrong[0]);
    }
}

#[test]
fn noise_is_said_with_what_it_allows() {
    for noise in [1e-12, 1e-10, 1e-8, 1e-6] {
        for seed in 0..20 {
            let random = std::cell::RefCell::new(SplitMix::new(seed));
            let noisy = |x: f64| x.exp() + noise * random.borrow_mut().normal();
            let judged = along(noisy, 0.3, 0.3f64.exp(), None).judge(DEFAULT_TO);
            let found = &judged[0];
            assert_ne!(found.verdict(), Verdict::Fail, "{noise}: {found}");
            let is_shown = found.noise > noise / 5.0 && found.noise < noise * 10.0;
            assert!(is_shown, "{noise}: {found:?}");
            assert!(
                (found.size.found - 0.3f64.exp()).abs() < found.size.bar,
                "{found:?}"
            );
            let allowed = 10f64.powf(found.size.right_to().log10().ceil());
            let wrong = along(noisy, 0.3, 0.3f64.exp() * (1.0 + 10.0 * allowed), None);
            assert_eq!(wrong.judge(allowed)[0].verdict(), Verdict::Fail, "{noise}");
        }
    }
}

#[test]
fn what_is_allowed_does_not_hide_the_order() {
    // Off by a tenth of what is allowed: the finest remainders fall at order one, and are known.
    let judged = along(f64::exp, 0.3, 0.3f64.exp() * (1.0 + 1e-7), None).judge(DEFAULT_TO);
    assert_eq!(judged[0].finding, Finding::Right, "{}", judged[0]);
    let judged = along(f64::exp, 0.3, 0.3f64.exp() * (1.0 + 3e-6), None).judge(DEFAULT_TO);
    assert_eq!(judged[0].finding, Finding::Wrong, "{}", judged[0]);
}

#[test]
fn values_that_are_not_finite_fail() {
    let judged =
        along(|x| if x < 0.4 { f64::NAN } else { x.exp() }, 0.3, 1.0, None).judge(DEFAULT_TO);
    assert_eq!(judged[0].finding, Finding::NotFinite);
    let judged = along(f64::exp, 0.3, f64::NAN, None).judge(DEFAULT_TO);
    assert_eq!(judged[0].finding, Finding::NotFinite);
}

#[test]
fn a_corner_at_m_fails() {
    let judged = along(|x: f64| (x - 0.3).max(0.0).powf(1.5) + x, 0.3, 1.0, None).judge(DEFAULT_TO);
    assert_eq!(judged[0].finding, Finding::OrderTooLow, "{}", judged[0]);
}

/// A number as it is printed with so many digits after the first.
fn printed(number: f64, digits: usize) -> f64 {
    let text = format!("{number:.digits$e}");
    text.parse().expect("a number")
}

#[test]
fn a_j_of_few_digits_is_noisy_and_its_right_derivative_no_failure() {
    for digits in 2..12 {
        for (name, j, slope, _, m) in FUNCTIONS {
            let judged = along(|x| printed(j(x), digits), m, slope(m), None).judge(DEFAULT_TO);
            let found = &judged[0];
            assert_ne!(found.verdict(), Verdict::Fail, "{name}, {digits}: {found}");
        }
        let j = |x: f64| printed(x.exp(), digits);
        let wrong = along(j, 0.3, 2.0 * 0.3f64.exp(), None).judge(DEFAULT_TO);
        assert!(!wrong[0].verdict().is_pass(), "{digits}: {}", wrong[0]);
        // With fewer the coarsest step changes J by a few units of its last digit.
        let is_seen = wrong[0].verdict() == Verdict::Fail;
        assert!(is_seen || digits < 5, "{digits}: {}", wrong[0]);
    }
}
