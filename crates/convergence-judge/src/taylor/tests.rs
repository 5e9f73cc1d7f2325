//! Functions whose derivatives are known, right and wrong.

use num_dual::{Dual2_64, DualNum};

use super::{Along, DEFAULT_TO, Finding, Judged, Second};
use crate::random::SplitMix;
use crate::verdict::Verdict;

/// A function of dual numbers, which give its first two derivatives.
type Function = fn(Dual2_64) -> Dual2_64;

/// A name, J, and m.
type Row = (&'static str, Function, f64);

/// Forty functions of all sizes and curvatures. None is a parabola.
const FUNCTIONS: [Row; 40] = [
    ("exp", |x| x.exp(), 0.3),
    ("exp at -20", |x| x.exp(), -20.0),
    ("sin", |x| x.sin(), 0.7),
    ("cos", |x| x.cos(), 0.9),
    ("tan", |x| x.tan(), 0.4),
    ("ln", |x| x.ln(), 2.5),
    ("sqrt", |x| x.sqrt(), 3.0),
    ("cbrt", |x| x.cbrt(), 1.7),
    ("fifth", |x| x.powi(5), 1.3),
    ("cube", |x| x.powi(3), 1.1),
    ("fourth", |x| x.powi(4), -0.8),
    ("seventh", |x| x.powi(7), 1.2),
    ("inverse", |x| x.recip(), 0.9),
    ("inverse square", |x| x.powi(-2), 1.6),
    ("atan", |x| x.atan(), 0.6),
    ("asin", |x| x.asin(), 0.2),
    ("sinh", |x| x.sinh(), 0.8),
    ("cosh", |x| x.cosh(), 1.4),
    ("tanh", |x| x.tanh(), 0.5),
    ("gauss", |x| (-x * x).exp(), 0.3),
    ("bump", |x| (x * x + 1.0).recip(), 0.4),
    ("large", |x| x.sin() * 1e9, 0.7),
    ("small", |x| x.sin() * 1e-9, 0.7),
    ("offset", |x| x.sin() + 5.0, 0.7),
    ("fast", |x| (x * 5.0).sin(), 0.3),
    ("slow", |x| (x * 0.2).sin(), 2.0),
    ("x exp", |x| x * x.exp(), 0.2),
    ("x ln", |x| x * x.ln(), 2.0),
    ("x sin", |x| x * x.sin(), 1.0),
    ("sin cos", |x| x.sin() * x.cos(), 0.3),
    ("sin of square", |x| (x * x).sin(), 0.8),
    ("exp of sin", |x| x.sin().exp(), 0.5),
    ("logistic", |x| ((-x).exp() + 1.0).recip(), 0.9),
    ("softplus", |x| x.exp().ln_1p(), -0.4),
    ("double well", |x| (x * x - 1.0).powi(2), 0.3),
    (
        "rosenbrock",
        |x| (x - 1.0).powi(2) + (x * x - 1.0).powi(2) * 100.0,
        0.5,
    ),
    ("misfit", |x| (x.exp() - 2.0).powi(2) * 0.5, 0.4),
    ("power", |x| x.powf(2.3), 1.8),
    ("two to the", |x| (x * 2_f64.ln()).exp(), 0.1),
    ("sum", |x| x.sin() + x * x + x.exp(), 0.6),
];

/// J and its first two derivatives.
fn derived(j: Function, m: f64) -> Dual2_64 {
    j(Dual2_64::new(m, 1.0, 0.0))
}

/// J of numbers.
fn value(j: Function) -> impl Fn(f64) -> f64 {
    move |x| derived(j, x).re
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

#[test]
fn right_derivatives_of_forty_functions_pass() {
    for (name, j, m) in FUNCTIONS {
        let Dual2_64 { v1, v2, .. } = derived(j, m);
        let judged = along(value(j), m, v1, Some(v2)).judge(DEFAULT_TO);
        for (judged, known) in judged.iter().zip([v1, v2]) {
            assert!(judged.verdict().is_pass(), "{name}: {judged}");
            let size = &judged.size;
            assert!((size.found - known).abs() <= size.bar, "{name}: {size:?}");
        }
    }
}

#[test]
fn a_slope_that_is_off_by_a_part_in_a_hundred_thousand_fails() {
    for (name, j, m) in FUNCTIONS {
        let slope = derived(j, m).v1;
        let elsewhere = derived(j, m + 1e-3).v1;
        let off = [1e-3, 1e-5, -1e-5, -2.0, -1.0].map(|part| slope * (1.0 + part));
        for wrong in off.into_iter().chain([elsewhere]) {
            let judged = &along(value(j), m, wrong, None).judge(DEFAULT_TO)[0];
            assert_eq!(judged.verdict(), Verdict::Fail, "{name}, {wrong}: {judged}");
        }
    }
}

#[test]
fn a_curvature_that_lacks_a_term_fails() {
    for (name, j, m) in FUNCTIONS {
        let Dual2_64 { v1, v2, .. } = derived(j, m);
        for part in [1e-3, -1e-3, -2.0, -1.0] {
            let judged = along(value(j), m, v1, Some(v2 * (1.0 + part))).judge(DEFAULT_TO);
            let verdicts = [&judged[0], &judged[1]].map(Judged::verdict);
            let expected = [Verdict::Pass, Verdict::Fail];
            assert_eq!(verdicts, expected, "{name}, {part}: {}", judged[1]);
        }
    }
}

/// J, m, what is claimed of its derivatives there, and what is found.
type Special = (fn(f64) -> f64, f64, f64, Option<f64>, &'static [Finding]);

#[test]
fn points_and_functions_that_test_nothing_are_said_and_wrong_claims_about_them_fail() {
    use Finding::*;
    let line = |x: f64| 3.0 * x + 0.1;
    let parabola = |x: f64| x * x;
    let corner = |x: f64| (x - 0.3).max(0.0).powf(1.5) + x;
    let broken = |x: f64| if x < 0.4 { f64::NAN } else { x.exp() };
    let slope = 0.3_f64.exp();
    let rows: [Special; 14] = [
        (f64::cos, 0.0, 0.0, None, &[Vanishes]),
        (f64::cos, 0.0, 0.01, None, &[Wrong]),
        (f64::sin, 0.0, 1.0, Some(0.0), &[Right, Vanishes]),
        (parabola, 1.3, 2.6, Some(2.0), &[Right, NothingTested]),
        (parabola, 1.3, 2.6, Some(2.001), &[Right, Wrong]),
        (line, 0.7, 3.0, None, &[NothingTested]),
        (line, 0.7, 3.001, None, &[Wrong]),
        (|_| 3.7, 0.7, 0.0, None, &[NothingTested]),
        (|_| 3.7, 0.7, 0.1, None, &[Wrong]),
        // What is allowed does not hide the order: the finest remainders fall at order one.
        (f64::exp, 0.3, slope * (1.0 + 1e-7), None, &[Right]),
        (f64::exp, 0.3, slope * (1.0 + 3e-6), None, &[Wrong]),
        (f64::exp, 0.3, f64::NAN, None, &[NotFinite]),
        (broken, 0.3, 1.0, None, &[NotFinite]),
        (corner, 0.3, 1.0, None, &[OrderTooLow]),
    ];
    for (j, m, slope, curvature, expected) in rows {
        let judged = along(j, m, slope, curvature).judge(DEFAULT_TO);
        let found = judged.iter().map(|judged| &judged.finding);
        assert!(found.eq(expected), "{expected:?}: {}", judged[0]);
    }
}

/// J plus so much noise.
fn noisy<'a>(j: impl Fn(f64) -> f64 + 'a, noise: f64, seed: u64) -> impl Fn(f64) -> f64 + 'a {
    let random = std::cell::RefCell::new(SplitMix::new(seed));
    move |x| j(x) + noise * random.borrow_mut().normal()
}

/// The quotients of 5 + x + x²/8 - x³ at 0.1 and 0.025 are both 1.0025, and so is a line through
/// them at 0; 1 is right.
#[test]
fn quotients_that_agree_by_chance_are_no_derivative() {
    const PARTS: [f64; 6] = [-1e-2, 3e-6, 1e-5, 1e-4, 2.5001e-3, 1e-2];
    for k in 20..=120 {
        let square = f64::from(k) / 400.0;
        let j = move |x: f64| 5.0 + x + square * x * x - x.powi(3);
        let judge = |j: &dyn Fn(f64) -> f64, slope| {
            let along = along(j, 0.0, slope, None);
            along.judge(DEFAULT_TO).remove(0)
        };
        for part in PARTS {
            let wrong = judge(&j, 1.0 + part);
            assert_eq!(wrong.finding, Finding::Wrong, "{square}, {part}: {wrong}");
        }
        let check = |j: &dyn Fn(f64) -> f64, about: f64| {
            let right = judge(j, 1.0);
            assert_ne!(right.verdict(), Verdict::Fail, "{square}, {about}: {right}");
            for part in PARTS {
                let wrong = judge(j, 1.0 + part);
                assert!(!wrong.verdict().is_pass(), "{square}, {about}: {wrong}");
            }
        };
        for noise in [0.0, 1e-12, 1e-6] {
            check(&noisy(j, noise, k as u64), noise);
        }
        for digits in 6..=14 {
            check(&|x| printed(j(x), digits), digits as f64);
        }
        assert_eq!(judge(&j, 1.0).finding, Finding::Right, "{square}");
    }
}

/// A polynomial, of up to the fifth degree, or a sine on a line, with its derivatives at 0.
fn random_function(random: &mut SplitMix) -> (Box<dyn Fn(f64) -> f64>, f64, f64) {
    let numbers: Vec<f64> = (0..6).map(|_| random.normal()).collect();
    let [_, slope, half_curvature] = [0, 1, 2].map(|k| numbers[k]);
    if random.below(2) == 0 {
        let degree = 3 + random.below(3);
        let terms = numbers[..=degree].to_vec();
        let value = move |x: f64| terms.iter().rev().fold(0.0, |sum, term| sum * x + term);
        return (Box::new(value), slope, 2.0 * half_curvature);
    }
    let (size, fast, phase) = (numbers[3], random.within([0.3, 3.0]), numbers[5]);
    let value = move |x: f64| slope * x + size * (fast * x + phase).sin();
    let at_zero = [
        slope + size * fast * phase.cos(),
        -size * fast * fast * phase.sin(),
    ];
    (Box::new(value), at_zero[0], at_zero[1])
}

#[test]
fn right_derivatives_of_random_functions_never_fail() {
    for noise in [0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4] {
        for seed in 0..3000 {
            let (j, slope, curvature) = random_function(&mut SplitMix::new(seed));
            let along = along(noisy(j, noise, seed), 0.0, slope, Some(curvature));
            for judged in along.judge(DEFAULT_TO) {
                let is_failure = judged.verdict() == Verdict::Fail;
                assert!(!is_failure, "{noise}, {seed}: {judged}");
            }
        }
    }
}

#[test]
fn a_remainder_that_crosses_zero_tells_no_order() {
    // Its terms of second and third order cancel between ε = 0.005 and 0.1.
    for k in 5..=100 {
        let square = 1e-3 * f64::from(k);
        let j = move |x: f64| x + square * x * x - x.powi(3);
        for noise in [0.0, 1e-12, 1e-11, 1e-10, 1e-9] {
            let along = along(noisy(j, noise, k as u64), 0.0, 1.0, None);
            let judged = &along.judge(DEFAULT_TO)[0];
            let is_failure = judged.verdict() == Verdict::Fail;
            assert!(!is_failure, "{square}, {noise}: {judged}");
        }
    }
}

#[test]
fn noise_is_said_with_what_it_allows() {
    for noise in [1e-12, 1e-10, 1e-8, 1e-6] {
        for seed in 0..20 {
            let j = noisy(f64::exp, noise, seed);
            let judged = along(&j, 0.3, 0.3f64.exp(), None).judge(DEFAULT_TO);
            let found = &judged[0];
            assert_ne!(found.verdict(), Verdict::Fail, "{noise}: {found}");
            let is_shown = found.noise > noise / 5.0 && found.noise < noise * 10.0;
            assert!(is_shown, "{noise}: {found:?}");
            assert!(
                (found.size.found - 0.3f64.exp()).abs() < found.size.bar,
                "{found:?}"
            );
            let allowed = 10f64.powf(found.size.right_to().log10().ceil());
            let wrong = along(&j, 0.3, 0.3f64.exp() * (1.0 + 10.0 * allowed), None);
            assert_eq!(wrong.judge(allowed)[0].verdict(), Verdict::Fail, "{noise}");
        }
    }
}

/// The part that a noisy test advises to ask for.
fn advised(judged: &Judged) -> Option<f64> {
    let words = judged.to_string();
    let to = words.split_once("to=")?.1;
    Some(to.parse().expect("a number"))
}

#[test]
fn the_part_that_is_advised_lets_a_right_derivative_pass_or_say_why_its_order_does_not() {
    let mut passed = [0; 2];
    for digits in 5..13 {
        for (name, j, m) in FUNCTIONS {
            let j_of = value(j);
            let slope = derived(j, m).v1;
            let along = along(|x| printed(j_of(x), digits), m, slope, None);
            let Some(to) = advised(&along.judge(DEFAULT_TO)[0]) else {
                continue;
            };
            let again = &along.judge(to)[0];
            assert!(again.rate.is_some(), "{name}, {digits}, {to}: {again}");
            assert_ne!(again.verdict(), Verdict::Fail, "{name}, {digits}: {again}");
            passed[usize::from(again.verdict().is_pass())] += 1;
        }
    }
    assert!(passed[1] > 3 * passed[0], "{passed:?}");
}

#[test]
fn a_curved_j_is_no_line_where_what_is_allowed_hides_its_remainder() {
    let j = |x: f64| printed(x.exp(), 5);
    let found = &along(j, 0.3, 0.3f64.exp(), None).judge(0.1)[0];
    assert_eq!(found.finding, Finding::OrderUndecided, "{found:?}");
    assert!(
        found.to_string().ends_with("solve more accurately"),
        "{found}"
    );
}

/// A number as it is printed with so many digits after the first.
fn printed(number: f64, digits: usize) -> f64 {
    let text = format!("{number:.digits$e}");
    text.parse().expect("a number")
}

#[test]
fn a_j_of_few_digits_is_noisy_and_its_right_derivative_no_failure() {
    for digits in 2..12 {
        for (name, j, m) in FUNCTIONS {
            let j_of = value(j);
            let slope = derived(j, m).v1;
            let judged = along(|x| printed(j_of(x), digits), m, slope, None).judge(DEFAULT_TO);
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
