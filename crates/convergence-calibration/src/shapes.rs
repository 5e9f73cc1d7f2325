//! The formulas of error laws, and the numbers that each of them draws.

use convergence_judge::random::SplitMix;

/// The formulas, with the ranges of the numbers drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape {
    /// h^p |1 + a h^r|, a and r in these ranges.
    Pollution { a: [f64; 2], r: [f64; 2] },
    /// h^p (L - log h)^k, k = 1/2, 1 or 2, L in [0.5, 4].
    Logarithm,
    /// h^p (1 ± a) in turns, a in [0.01, 0.2].
    OddEven,
    /// h^p (1 + a h^r cos(w + f log h)), a in [0.05, 0.5], f in [1, 8].
    Oscillation { r: [f64; 2] },
    /// h^p + b h^(p - d), d = 1/2 or 1; the second term is 0.01 to 10 times the first on the finest
    /// level.
    LowerOrder,
    /// An error that does not tend to zero: of [h, H], h^p and f, f being a share of H^p and H the
    /// finest step.
    Stagnating {
        share: [f64; 2],
        error: fn([f64; 2], f64, f64) -> f64,
    },
    /// h^p / (h + h0)^g, g in [0.25, 1]
    Shifted,
    /// x / (1 + x), x = (h / h0)^p
    Saturated,
    /// h^p exp(σ h^s N)
    Noise {
        sigma: f64,
        a: [f64; 2],
        s: [f64; 2],
    },
    /// h^p, except that one level is up to 3 times too large or too small.
    Outlier,
    /// A law of another file.
    HeldOut(Formula),
}

/// Draws the numbers of a law; the error is a function of the step, to be called once for each
/// step, coarsest first.
pub(crate) type Formula = for<'a> fn(Exponents, &'a mut SplitMix) -> ErrorOfStep<'a>;

/// The numbers that are the same for all levels of a table of a held-out law.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Exponents {
    /// The exponent that the coarse levels show.
    pub p: f64,
    /// The order, if there is one.
    pub order: Option<f64>,
    /// The finest step, H.
    pub finest: f64,
}

impl Shape {
    /// Draws the numbers of the formula.
    ///
    /// * `p`, `order`: exponent of h and order of the law.
    /// * Returns the error as a function of the step, to be called once for each step, coarsest
    ///   first.
    pub(crate) fn draw<'a>(
        self,
        p: f64,
        order: Option<f64>,
        steps: &'a [f64],
        random: &'a mut SplitMix,
    ) -> ErrorOfStep<'a> {
        let finest = steps[steps.len() - 1];
        match self {
            Self::Pollution { a, r } => {
                let a = random.within(a);
                let r = random.within(r);
                Box::new(move |h| h.powf(p) * (1.0 + a * h.powf(r)).abs())
            }
            Self::Logarithm => {
                let k = [0.5, 1.0, 2.0][random.below(3)];
                let l = random.within([0.5, 4.0]);
                Box::new(move |h| h.powf(p) * (l - h.ln()).powf(k))
            }
            Self::OddEven => odd_even(p, random),
            Self::Oscillation { r } => oscillation(p, r, random),
            Self::LowerOrder => {
                let lower = p - order.unwrap_or(p);
                let b = finest.powf(lower) * log_uniform([0.01, 10.0], random);
                Box::new(move |h| h.powf(p) * (1.0 + b * h.powf(-lower)))
            }
            Self::Stagnating { share, error } => {
                let f = finest.powf(p) * log_uniform(share, random);
                Box::new(move |h| error([h, finest], h.powf(p), f))
            }
            Self::Shifted => shifted(p, finest, random),
            Self::Saturated => {
                let h0 = log_uniform([finest, 1.0], random);
                Box::new(move |h| saturated((h / h0).powf(p)))
            }
            Self::Noise { sigma, a, s } => noise(p, sigma, [a, s], random),
            Self::Outlier => outlier(p, steps, random),
            Self::HeldOut(formula) => formula(Exponents { p, order, finest }, random),
        }
    }
}

/// An error as a function of the step, to be called once for each step, coarsest first.
pub(crate) type ErrorOfStep<'a> = Box<dyn FnMut(f64) -> f64 + 'a>;

fn odd_even<'a>(p: f64, random: &mut SplitMix) -> ErrorOfStep<'a> {
    let mut a = random.within([0.01, 0.2]);
    Box::new(move |h| {
        a = -a;
        h.powf(p) * (1.0 + a)
    })
}

/// * `r`: range of the exponent with which the oscillations fade.
fn oscillation<'a>(p: f64, r: [f64; 2], random: &mut SplitMix) -> ErrorOfStep<'a> {
    let a = random.within([0.05, 0.5]);
    let r = random.within(r);
    let frequency = random.within([1.0, 8.0]);
    let phase = random.within([0.0, std::f64::consts::TAU]);
    Box::new(move |h| h.powf(p) * (1.0 + a * h.powf(r) * (phase + frequency * h.ln()).cos()))
}

fn shifted<'a>(p: f64, finest: f64, random: &mut SplitMix) -> ErrorOfStep<'a> {
    let h0 = log_uniform([finest, 1.0], random);
    let g = random.within([0.25, 1.0]);
    Box::new(move |h| h.powf(p) / (h + h0).powf(g))
}

/// * `sigma`: size of the noise; of noise that fades, its middle size.
/// * `a`: range of the pollution in addition; `s`: range of the exponent with which noise fades.
fn noise(p: f64, sigma: f64, [a, s]: [[f64; 2]; 2], random: &mut SplitMix) -> ErrorOfStep<'_> {
    let a = random.within(a);
    let r = random.within([1.0, 4.0]);
    let s = random.within(s);
    let sigma = if s > 0.0 {
        sigma * log_uniform([0.3, 3.0], random)
    } else {
        sigma
    };
    Box::new(move |h| {
        h.powf(p) * (1.0 + a * h.powf(r)) * (sigma * h.powf(s) * random.normal()).exp()
    })
}

fn outlier<'a>(p: f64, steps: &[f64], random: &mut SplitMix) -> ErrorOfStep<'a> {
    let wrong = steps[random.below(steps.len())];
    let factor = log_uniform([1.0 / 3.0, 3.0], random);
    Box::new(move |h| h.powf(p) * if h == wrong { factor } else { 1.0 })
}

fn saturated(x: f64) -> f64 {
    x / (1.0 + x)
}

/// A number whose logarithm is uniform.
pub(crate) fn log_uniform([low, high]: [f64; 2], random: &mut SplitMix) -> f64 {
    random.within([low.ln(), high.ln()]).exp()
}
