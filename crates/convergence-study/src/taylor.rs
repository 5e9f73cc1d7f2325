//! The Taylor test of a derivative, in directions drawn by a seed: steps, calls, and what is said.
//!
//! What is judged, and why, stands in [`convergence_judge::taylor`].

use std::fmt;

use serde::Serialize;

use convergence_judge::random::SplitMix;
use convergence_judge::taylor::{Along, DEFAULT_TO, Finding, Judged, Second};
use convergence_judge::verdict::Verdict;

/// Steps in a direction, coarsest first: to the noise of most functions.
const STEPS: i32 = 13;

/// Of a step to the next one.
const RATIO: f64 = 0.25;

/// How far the coarsest step goes, in units of the length of m or of 1.
pub(crate) const FARTHEST: f64 = 0.1;

/// How often the coarsest step is halved where J is not finite.
const MOST_HALVINGS: usize = 40;

/// Directions that are drawn anew for one in which a derivative is zero.
pub(crate) const MOST_DRAWN_ANEW: usize = 5;

/// Directions that are drawn, by default.
pub(crate) const DIRECTIONS: usize = 3;

/// All steps, coarsest first.
pub(crate) fn steps_from(coarsest: f64) -> Vec<f64> {
    (0..STEPS).map(|k| coarsest * RATIO.powi(k)).collect()
}

/// A test of the derivatives of J at a point m.
///
/// ```
/// use convergence_study::TaylorTest;
///
/// let m = [0.3f64, 0.7];
/// let j = |m: &[f64]| m[0].exp() * m[1].sin();
/// let gradient = [m[0].exp() * m[1].sin(), m[0].exp() * m[1].cos()];
/// let dot = |g: [f64; 2]| move |d: &[f64]| g[0] * d[0] + g[1] * d[1];
///
/// TaylorTest::at(&m).run(j, dot(gradient)).assert_passes();
///
/// // Off by a part in a hundred thousand: the rate of remainders at four steps is 1.999.
/// let wrong = TaylorTest::at(&m).run(j, dot(gradient.map(|g| g * (1.0 + 1e-5))));
/// assert!(!wrong.verdict().is_pass());
/// ```
#[derive(Debug, Clone)]
#[must_use = "a test says nothing until it is run"]
pub struct TaylorTest {
    at: Vec<f64>,
    scales: Option<Vec<f64>>,
    directions: Directions,
    seed: u64,
    to: f64,
}

#[derive(Debug, Clone)]
enum Directions {
    Drawn(usize),
    Given(Vec<Vec<f64>>),
}

/// What a Taylor test has found.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[must_use = "a verdict that is not read lets a wrong derivative pass"]
#[non_exhaustive]
pub struct TaylorFindings {
    /// The test of each direction.
    pub(crate) directions: Vec<DirectionFindings>,
}

/// What a Taylor test has found in one direction.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct DirectionFindings {
    /// The first derivative, and the second if it is tested.
    pub(crate) derivatives: Vec<Judged>,
    /// Directions that were drawn before it, in which a derivative is zero.
    pub(crate) drawn_anew: usize,
}

/// A second derivative: `d'Hd` of d, or why it is not known.
type Curvature<'f, E> = &'f mut dyn FnMut(&[f64]) -> Result<f64, E>;

impl TaylorTest {
    /// A test at m, in three directions, to a part of 1e-6.
    pub fn at(m: &[f64]) -> Self {
        Self {
            at: m.to_vec(),
            scales: None,
            directions: Directions::Drawn(DIRECTIONS),
            seed: 1,
            to: DEFAULT_TO,
        }
    }

    /// The same test with directions whose components have these sizes, one for each of m.
    pub fn scales(self, scales: &[f64]) -> Self {
        let scales = Some(scales.to_vec());
        Self { scales, ..self }
    }

    /// The same test in so many directions, at least one, drawn by a seed.
    pub fn drawn(self, count: usize, seed: u64) -> Self {
        let directions = Directions::Drawn(count.max(1));
        Self {
            directions,
            seed,
            ..self
        }
    }

    /// The same test in these directions.
    pub fn along(self, directions: &[&[f64]]) -> Self {
        let given = directions.iter().map(|direction| direction.to_vec());
        let directions = Directions::Given(given.collect());
        Self { directions, ..self }
    }

    /// The same test for derivatives that may be off by this part.
    ///
    /// # Panics
    /// Unless 0 < `to` < 1: a part of one would allow any derivative.
    #[track_caller]
    pub fn to(self, to: f64) -> Self {
        assert!(
            0.0 < to && to < 1.0,
            "to: expected a number between 0 and 1, found {to}"
        );
        Self { to, ..self }
    }

    /// Tests `slope(d) = dJ·d`, the derivative of `value(m) = J`.
    pub fn run(
        &self,
        mut value: impl FnMut(&[f64]) -> f64,
        mut slope: impl FnMut(&[f64]) -> f64,
    ) -> TaylorFindings {
        let value = |m: &[f64]| Ok::<f64, std::convert::Infallible>(value(m));
        let Ok(found) = self.try_run(value, |d| Ok(slope(d)), None);
        found
    }

    /// Tests the second derivative, too: `curvature(d) = d'Hd`.
    pub fn run_second(
        &self,
        mut value: impl FnMut(&[f64]) -> f64,
        mut slope: impl FnMut(&[f64]) -> f64,
        mut curvature: impl FnMut(&[f64]) -> f64,
    ) -> TaylorFindings {
        let value = |m: &[f64]| Ok::<f64, std::convert::Infallible>(value(m));
        let Ok(found) = self.try_run(value, |d| Ok(slope(d)), Some(&mut |d| Ok(curvature(d))));
        found
    }

    /// The same with functions that may fail.
    ///
    /// # Errors
    /// The first one of a function.
    pub fn try_run<E>(
        &self,
        mut value: impl FnMut(&[f64]) -> Result<f64, E>,
        mut slope: impl FnMut(&[f64]) -> Result<f64, E>,
        mut curvature: Option<Curvature<'_, E>>,
    ) -> Result<TaylorFindings, E> {
        let here = [value(&self.at)?, value(&self.at)?];
        let mut in_direction = |direction: &[f64]| {
            let curvature = curvature.as_mut().map(|curvature| curvature(direction));
            let slope = slope(direction)?;
            self.along_direction(here, direction, &mut value, slope, curvature.transpose()?)
        };
        let mut random = SplitMix::new(self.seed);
        let directions = match &self.directions {
            Directions::Given(given) => given
                .iter()
                .map(|direction| {
                    Ok(DirectionFindings {
                        derivatives: in_direction(direction)?,
                        drawn_anew: 0,
                    })
                })
                .collect::<Result<_, E>>()?,
            Directions::Drawn(count) => (0..*count)
                .map(|_| self.drawn_direction(&mut random, &mut in_direction))
                .collect::<Result<_, E>>()?,
        };
        Ok(TaylorFindings { directions })
    }

    /// The findings in a direction in which no derivative is zero, if one is found.
    fn drawn_direction<E>(
        &self,
        random: &mut SplitMix,
        mut test: impl FnMut(&[f64]) -> Result<Vec<Judged>, E>,
    ) -> Result<DirectionFindings, E> {
        let mut drawn_anew = 0;
        loop {
            let derivatives = test(&self.draw(random))?;
            let mut findings = derivatives.iter().map(|judged| judged.finding);
            let has_zero = findings.any(|finding| finding == Finding::Vanishes);
            if !has_zero || drawn_anew == MOST_DRAWN_ANEW {
                return Ok(DirectionFindings {
                    derivatives,
                    drawn_anew,
                });
            }
            drawn_anew += 1;
        }
    }

    /// A direction of length one: normal numbers times the scales.
    fn draw(&self, random: &mut SplitMix) -> Vec<f64> {
        let scale = |place: usize| self.scales.as_ref().map_or(1.0, |scales| scales[place]);
        let places = 0..self.at.len();
        let direction: Vec<f64> = places.map(|place| scale(place) * random.normal()).collect();
        let length = length(&direction);
        direction.iter().map(|part| part / length).collect()
    }

    fn along_direction<E>(
        &self,
        here: [f64; 2],
        direction: &[f64],
        value: &mut impl FnMut(&[f64]) -> Result<f64, E>,
        slope: f64,
        curvature: Option<f64>,
    ) -> Result<Vec<Judged>, E> {
        let mut at = |step: f64| {
            let parts = self.at.iter().zip(direction);
            let point: Vec<f64> = parts.map(|(m, d)| m + step * d).collect();
            value(&point)
        };
        let sides: &[f64] = if curvature.is_some() {
            &[1.0, -1.0]
        } else {
            &[1.0]
        };
        let mut ends_at = |step: f64| -> Result<Vec<f64>, E> {
            sides.iter().map(|side| at(side * step)).collect()
        };
        let mut coarsest = FARTHEST * length(&self.at).max(1.0) / length(direction);
        let mut ends = ends_at(coarsest)?;
        for _ in 0..MOST_HALVINGS {
            if ends.iter().all(|value| value.is_finite()) {
                break;
            }
            coarsest /= 2.0;
            ends = ends_at(coarsest)?;
        }
        let steps = steps_from(coarsest);
        // The values at the coarsest step are known.
        let mut on_side = |side: f64, end: f64| -> Result<Vec<f64>, E> {
            let finer = steps[1..].iter().map(|step| at(side * step));
            std::iter::once(Ok(end)).chain(finer).collect()
        };
        let forward = on_side(1.0, ends[0])?;
        let second = match curvature {
            Some(curvature) => Some(Second {
                backward: on_side(-1.0, ends[1])?,
                curvature,
            }),
            None => None,
        };
        let along = Along {
            steps,
            forward,
            here,
            slope,
            second,
        };
        Ok(along.judge(self.to))
    }
}

fn length(parts: &[f64]) -> f64 {
    parts.iter().map(|part| part * part).sum::<f64>().sqrt()
}

impl TaylorFindings {
    /// The worst verdict of all directions.
    #[must_use = "a verdict that is not read lets a wrong derivative pass"]
    pub fn verdict(&self) -> Verdict {
        let derivatives = self.directions.iter().flat_map(|found| &found.derivatives);
        Verdict::worst(derivatives.map(Judged::verdict))
    }

    /// Does nothing if the derivatives are right.
    ///
    /// # Panics
    /// With what was found, unless the verdict is a pass.
    #[track_caller]
    pub fn assert_passes(&self) {
        assert!(self.verdict().is_pass(), "{self}");
    }
}

impl fmt::Display for TaylorFindings {
    /// The verdict, and a line for each derivative and direction.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.verdict())?;
        for (place, found) in self.directions.iter().enumerate() {
            for judged in &found.derivatives {
                write!(
                    f,
                    "\n  direction {}: {}: {judged}",
                    place + 1,
                    judged.verdict()
                )?;
            }
            if found.drawn_anew > 0 {
                write!(
                    f,
                    "\n  direction {}: drawn {} times: a derivative is zero in those before",
                    place + 1,
                    found.drawn_anew + 1
                )?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Finding, TaylorTest};
    use convergence_judge::verdict::Verdict;

    /// J, with a different curvature in every direction.
    fn misfit(m: &[f64]) -> f64 {
        let terms = m.iter().enumerate();
        terms.map(|(k, x)| ((k + 1) as f64 * x).sin().powi(2)).sum()
    }

    fn gradient(m: &[f64]) -> Vec<f64> {
        let terms = m.iter().enumerate().map(|(k, x)| ((k + 1) as f64, x));
        terms.map(|(k, x)| k * (2.0 * k * x).sin()).collect()
    }

    fn curvature(m: &[f64], d: &[f64]) -> f64 {
        let terms = m.iter().zip(d).enumerate();
        let terms = terms.map(|(k, (x, d))| ((k + 1) as f64, x, d));
        terms
            .map(|(k, x, d)| 2.0 * k * k * (2.0 * k * x).cos() * d * d)
            .sum()
    }

    fn dot(one: &[f64], other: &[f64]) -> f64 {
        one.iter().zip(other).map(|(a, b)| a * b).sum()
    }

    const M: [f64; 5] = [0.3, -0.4, 0.9, 0.1, 0.6];

    #[test]
    fn right_derivatives_pass_in_every_direction() {
        for seed in 0..20 {
            let test = TaylorTest::at(&M).drawn(3, seed);
            let slope = |d: &[f64]| dot(&gradient(&M), d);
            test.run_second(misfit, slope, |d| curvature(&M, d))
                .assert_passes();
        }
    }

    #[test]
    fn one_wrong_component_fails() {
        for place in 0..M.len() {
            let mut wrong = gradient(&M);
            wrong[place] *= 1.0 + 1e-4;
            let found = TaylorTest::at(&M).run(misfit, |d| dot(&wrong, d));
            assert_eq!(found.verdict(), Verdict::Fail, "{place}: {found}");
        }
    }

    #[test]
    fn a_stationary_point_is_inconclusive_and_says_so() {
        let found = TaylorTest::at(&[0.0; 5]).run(misfit, |_| 0.0);
        assert_eq!(found.verdict(), Verdict::Inconclusive);
        assert_eq!(
            found.directions[0].derivatives[0].finding,
            Finding::Vanishes
        );
        assert!(found.to_string().contains("drawn 6 times"), "{found}");
    }

    #[test]
    fn the_step_is_halved_where_j_is_not_finite() {
        let found = TaylorTest::at(&[1e-3]).run(|m| m[0].ln(), |d| 1e3 * d[0]);
        assert!(found.verdict().is_pass(), "{found}");
    }

    #[test]
    #[should_panic(expected = "to: expected a number between 0 and 1, found 1")]
    fn a_part_that_allows_any_derivative_is_refused() {
        let _ = TaylorTest::at(&M).to(1.0);
    }

    #[test]
    fn scales_test_components_of_all_sizes() {
        let m = [1e6, 1e-3];
        let j = |m: &[f64]| (1e-6 * m[0]).sin() + (1e3 * m[1]).sin();
        let slope = |wrong: f64| move |d: &[f64]| 1f64.cos() * (1e-6 * d[0] + wrong * 1e3 * d[1]);
        let test = TaylorTest::at(&m).scales(&m);
        test.run(j, slope(1.0)).assert_passes();
        assert_eq!(test.run(j, slope(1.001)).verdict(), Verdict::Fail);
    }
}
