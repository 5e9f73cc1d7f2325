use super::*;
use convergence_judge::random::SplitMix;
use num_rational::BigRational;

/// Function, argument and value of each row, the value exactly as its decimals.
fn references() -> Vec<(String, f64, BigRational)> {
    let rows = include_str!("references.txt")
        .lines()
        .filter(|line| !line.starts_with('#'));
    rows.map(|row| {
        let words: Vec<&str> = row.split(' ').collect();
        (
            words[0].to_owned(),
            words[1].parse().unwrap(),
            decimal(words[2]),
        )
    })
    .collect()
}

/// A number exactly as its decimals.
pub(crate) fn decimal(text: &str) -> BigRational {
    let (whole, digits) = text.trim_end().split_once('.').unwrap();
    let power = num_bigint::BigInt::from(10).pow(u32::try_from(digits.len()).unwrap());
    BigRational::new(format!("{whole}{digits}").parse().unwrap(), power)
}

/// Whether a finite interval has the value.
pub(crate) fn encloses(interval: Enclosure, value: &BigRational) -> bool {
    let [lo, hi] = [interval.lo, interval.hi].map(BigRational::from_float);
    lo.is_some_and(|lo| lo <= *value) && hi.is_some_and(|hi| *value <= hi)
}

fn computed(name: &str, x: f64) -> Enclosure {
    let x = Enclosure::from(x);
    match name {
        "sin" => sin_cos(x)[0],
        "cos" => sin_cos(x)[1],
        "tanh" => tanh(x),
        _ => stumpff(name[1..].parse().unwrap(), x),
    }
}

#[test]
fn each_function_encloses_its_value_of_60_digits_closely() {
    let references = references();
    assert_eq!(references.len(), 8 * 5 + 7 * 2 + 7);
    for (name, x, value) in references {
        let interval = computed(&name, x);
        assert!(encloses(interval, &value), "{name}({x}): {interval:?}");
        assert!(interval.width() < 4e-14, "{name}({x}): {interval:?}");
    }
}

/// A rounding inward: most values are not enclosed any more. A product sorts its bounds, so that a
/// few are, by chance.
#[test]
fn bounds_rounded_inward_miss_most_values() {
    let references = references();
    let is_missed = |(name, x, value): &&(String, f64, BigRational)| {
        !encloses(planted::inward(|| computed(name, *x)), value)
    };
    let missed = references.iter().filter(is_missed).count();
    assert!(
        2 * missed > references.len(),
        "{missed} of {}",
        references.len()
    );
}

/// A remainder too small: without its tail a short series misses, and with it encloses.
#[test]
fn a_series_without_its_tail_misses_its_value() {
    for (name, x, value) in references() {
        let Some(Ok(k)) = name.strip_prefix('c').map(str::parse::<u32>) else {
            continue;
        };
        for terms in 1..4 {
            let x = Enclosure::from(x);
            assert!(encloses(series(k, x, terms, TAIL), &value), "{name}");
            if x.lo.abs() > 0.1 {
                let cut = series(k, x, terms, Enclosure::from(1.0));
                assert!(!encloses(cut, &value), "{name}, {terms} terms");
            }
        }
    }
}

#[test]
fn operations_enclose_the_exact_results_of_rationals() {
    let exact = |x: f64| BigRational::from_float(x).unwrap();
    let mut random = SplitMix::new(1);
    for _ in 0..2000 {
        let mut draw = || random.within([-1.0, 1.0]) * 2.0_f64.powi(random.below(40) as i32);
        let (a, b) = (draw(), draw());
        let (x, y) = (Enclosure::from(a), Enclosure::from(b));
        assert!(encloses(x + y, &(exact(a) + exact(b))), "{a} + {b}");
        assert!(encloses(x - y, &(exact(a) - exact(b))), "{a} - {b}");
        assert!(encloses(x * y, &(exact(a) * exact(b))), "{a} * {b}");
        assert!(encloses(x / y, &(exact(a) / exact(b))), "{a} / {b}");
        let root = x.square().sqrt();
        assert!(encloses(root, &exact(a.abs())), "{a}");
    }
}

#[test]
fn a_divisor_that_may_be_zero_and_infinite_products_say_nothing() {
    let zero = Enclosure { lo: -1.0, hi: 1.0 };
    assert_eq!(Enclosure::from(1.0) / zero, Enclosure::ENTIRE);
    assert_eq!(Enclosure::ENTIRE * 0.0, Enclosure::ENTIRE);
    assert_eq!(Enclosure::from(f64::NAN) + 1.0, Enclosure::ENTIRE);
}
