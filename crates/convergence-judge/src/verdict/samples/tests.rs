use super::*;
use crate::claims::Bound;
use crate::random::SplitMix;
use crate::verdict::Verdict;
use statrs::distribution::{ChiSquared, ContinuousCDF};

const STEPS: [f64; 5] = [1.0, 0.5, 0.25, 0.125, 0.0625];

/// Samples of this many numbers of h^rate, each times a random one.
fn samples(count: usize, of: Of, mut number: impl FnMut(f64) -> f64) -> Samples {
    let numbers = STEPS.map(|step| (0..count).map(|_| number(step)).collect());
    Samples {
        numbers: numbers.to_vec(),
        of,
        seeds: vec![],
    }
}

/// Of the errors of Monte Carlo with N = 1/h numbers, over 400 tables: how often the claim passes,
/// and how often the interval holds the order.
fn monte_carlo(order: f64, count: usize, of: Of) -> [f64; 3] {
    let mut random = SplitMix::new(7);
    let [mut passed, mut failed, mut held] = [0.0; 3];
    for _ in 0..400 {
        let samples = samples(count, of, |h| (h.sqrt() * random.normal()).abs());
        let judged = Claim::new(order, 0.25).judge_samples(&STEPS, &samples);
        passed += f64::from(u8::from(judged.verdict.is_pass()));
        failed += f64::from(u8::from(judged.verdict == Verdict::Fail));
        let interval = judged.interval.expect("a rate");
        held += f64::from(u8::from(interval.low <= 0.5 && 0.5 <= interval.high));
    }
    [passed, failed, held].map(|count| count / 400.0)
}

/// That of a mean is its standard error s/√n: to first order, the rate to a level that is known
/// exactly has it over the logarithm of the ratio of steps.
#[test]
fn leaving_out_one_number_gives_the_standard_error_of_a_mean() {
    let count = 10;
    let numbers = (0..count).map(|k| 1.0 + 1e-5 * f64::from(k));
    let samples = Samples {
        numbers: vec![numbers.collect(), vec![0.5; 10]],
        of: Of::Mean,
        seeds: vec![(0..10).collect(); 2],
    };
    // The numbers 0, 1, ..., n - 1 have the variance n (n + 1)/12.
    let standard_error = 1e-5 * (f64::from(count + 1) / 12.0).sqrt();
    let expected = FACTOR * NORMAL * standard_error / 2.0_f64.ln();
    let found = samples.jackknife(&[2.0_f64.ln(), 0.0]);
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
}

#[test]
fn means_of_samples_pass_where_they_should_and_nowhere_else() {
    for of in [Of::Mean, Of::RootMeanSquare] {
        let [passed, failed, held] = monte_carlo(0.5, 30, of);
        assert!(
            passed > 0.7 && failed < 0.02 && held > 0.95,
            "{passed} {failed} {held}"
        );
        let [passed, ..] = monte_carlo(1.0, 30, of);
        assert_eq!(passed, 0.0);
        let [passed, ..] = monte_carlo(0.5, 200, of);
        assert!(passed > 0.9, "{passed}");
    }
}

/// Such as those of a program that does not use its seed.
#[test]
fn samples_that_are_equal_on_a_level_do_not_pass() {
    let mut random = SplitMix::new(9);
    let scattered = samples(30, Of::Mean, |h| h * (1.0 + 0.1 * random.normal()));
    let judged = |samples: &Samples, order| Claim::new(order, 0.25).judge_samples(&STEPS, samples);
    assert!(judged(&scattered, 1.0).verdict.is_pass());
    let mut stale = scattered.clone();
    stale.numbers[2] = vec![STEPS[2]; 30];
    assert!(!judged(&stale, 1.0).verdict.is_pass());
    let equal = samples(30, Of::Mean, |h| h * (1.0 + 0.1 * h));
    let found = judged(&equal, 1.0);
    assert_eq!(found.code, Reason::Repeats);
    let said = "the samples of level 1 are equal";
    assert!(found.because.to_string().starts_with(said), "{found:?}");
    assert_eq!(judged(&equal, 2.0).verdict, Verdict::Fail);
}

#[test]
fn the_size_of_a_mean_of_signed_numbers_is_a_weak_error() {
    let mut random = SplitMix::new(8);
    let [mut passed, mut wrong] = [0; 2];
    for _ in 0..100 {
        let weak = samples(4000, Of::Weak, |h| 0.3 * h + 0.3 * random.normal());
        let judged = |order| Claim::new(order, 0.45).judge_samples(&STEPS, &weak);
        passed += i32::from(judged(1.0).verdict.is_pass());
        wrong += i32::from(judged(2.0).verdict.is_pass());
    }
    assert!(passed > 30 && wrong == 0, "{passed} {wrong}");
    // A level that is lost in its scatter is named, with what would do.
    let weak = samples(20, Of::Weak, |h| 0.3 * h + 0.3 * random.normal());
    let judged = Claim::new(1.0, 0.25).judge_samples(&STEPS, &weak);
    assert_eq!(judged.code, Reason::Samples);
    assert!(
        judged.because.to_string().contains("samples would"),
        "{}",
        judged.because
    );
}

#[test]
fn numbers_that_levels_share_widen_the_interval() {
    let mut random = SplitMix::new(9);
    let seeds: Vec<[f64; 2]> = (0..30)
        .map(|_| [random.normal(), random.normal()])
        .collect();
    // The rate of each seed is another one, so that levels scatter together.
    let level = |h: f64| {
        seeds
            .iter()
            .map(move |[a, b]| (0.2 * a).exp() * h.powf(1.0 + 0.3 * b))
    };
    let width = |seeds: Vec<Vec<usize>>| {
        let numbers: Vec<Vec<f64>> = STEPS.iter().map(|h| level(*h).collect()).collect();
        let kept = numbers.iter().enumerate();
        // A level that lacks seeds lacks the last ones.
        let kept = kept.map(|(k, numbers)| match seeds.get(k) {
            Some(seeds) => numbers[..seeds.len()].to_vec(),
            None => numbers.clone(),
        });
        let samples = Samples {
            numbers: kept.collect(),
            of: Of::Mean,
            seeds: seeds.clone(),
        };
        let judged = Claim::new(1.0, 0.45).judge_samples(&STEPS, &samples);
        judged.interval.expect("a rate").width()
    };
    let (unknown, shared) = (vec![], vec![(0..30).collect::<Vec<usize>>(); 5]);
    assert!(width(shared.clone()) > width(unknown.clone()));
    // One that a level has lost changes little.
    let mut lost = shared.clone();
    lost[4].pop();
    let ratio = width(lost) / width(shared);
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
    let other = |k: usize| (30 * k..30 * (k + 1)).collect();
    assert_eq!(width((0..5).map(other).collect()), width(unknown));
}

#[test]
fn broken_numbers_and_curved_errors_are_no_samples_of_a_power() {
    let mut random = SplitMix::new(10);
    let mut exact = |h: f64| h * (1.0 + 0.01 * random.normal());
    let good = samples(20, Of::Mean, &mut exact);
    let claim = Claim::new(1.0, 0.25);
    assert!(claim.judge_samples(&STEPS, &good).verdict.is_pass());
    for (level, number) in [(0, f64::NAN), (4, f64::INFINITY), (2, -0.1)] {
        let mut broken = good.clone();
        broken.numbers[level][3] = number;
        let judged = claim.judge_samples(&STEPS, &broken);
        assert_eq!(judged.verdict, Verdict::Fail, "{number}");
    }
    // Claims that tell nothing.
    for (order, tolerance) in [
        (1.0, 0.6),
        (0.3, 0.3),
        (-1.0, 0.2),
        (f64::NAN, 0.2),
        (1.0, 0.0),
    ] {
        let judged = Claim::new(order, tolerance).judge_samples(&STEPS, &good);
        assert_eq!(judged.verdict, Verdict::Inconclusive, "{order} {tolerance}");
    }
    let mut reversed = STEPS;
    reversed.reverse();
    assert!(!claim.judge_samples(&reversed, &good).verdict.is_pass());
    // A plateau far above the scatter.
    let plateau = samples(200, Of::Mean, |h| (h + 0.2) * (1.0 + 0.1 * random.normal()));
    assert!(!claim.judge_samples(&STEPS, &plateau).verdict.is_pass());
}

#[test]
fn quantiles_are_those_of_chi_square() {
    for freedom in 1..20 {
        let freedom = f64::from(freedom);
        let exact = ChiSquared::new(freedom).expect("freedom").inverse_cdf(0.99);
        let share = chi_square_99(freedom) / exact;
        assert!((share - 1.0).abs() < 0.02, "{freedom} {share}");
    }
}

#[test]
fn the_ways_to_an_error_have_names() {
    for name in ["mean", "rms", "weak"] {
        assert_eq!(
            name.parse::<Of>().map(|of| of.to_string()),
            Ok(name.to_owned())
        );
    }
    assert!("median".parse::<Of>().is_err());
}

#[test]
fn a_constant_of_samples_is_held_against_its_interval() {
    let mut random = SplitMix::new(3);
    let mut passes = |low, high| {
        let tables = (0..100).map(|_| samples(30, Of::Mean, |h| h * (1.0 + 0.1 * random.normal())));
        let claim = Claim {
            constant: Some(Interval { low, high }),
            ..Claim::new(1.0, 0.25)
        };
        let passes = |samples: Samples| claim.judge_samples(&STEPS, &samples).verdict.is_pass();
        tables.filter(|samples| passes(samples.clone())).count()
    };
    let right = passes(0.8, 1.25);
    assert!(right > 90, "{right}");
    assert_eq!(passes(1.25, 1.5), 0);
}

/// A wrong limit under a lower bound that the coarse levels exceed.
#[test]
fn a_lower_bound_passes_no_limit_behind_the_scatter_of_samples() {
    let mut random = SplitMix::new(5);
    let steps: Vec<f64> = (0..8).map(|k| 0.5_f64.powi(k)).collect();
    let mut passes = |limit: f64| {
        let mut number = |h: &f64| (h * h + limit) * (1.0 + 0.3 * random.normal());
        let mut level = |h| (0..30).map(|_| number(h)).collect();
        let tables = (0..100).map(|_| Samples {
            numbers: steps.iter().map(&mut level).collect(),
            of: Of::Mean,
            seeds: vec![],
        });
        let claim = Claim::usual(1.0, Bound::AtLeast);
        let pass = |samples: &Samples| claim.judge_samples(&steps, samples).verdict.is_pass();
        tables.filter(pass).count()
    };
    let [sound, wrong] = [0.0, 0.3 * 0.5_f64.powi(14)].map(&mut passes);
    assert!(sound > 80 && wrong < 8, "{sound} {wrong}");
}
