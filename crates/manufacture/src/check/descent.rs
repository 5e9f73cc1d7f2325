//! Places where a margin goes to zero: between two points, and downhill.

use super::margin::Margin;
use crate::arithmetic::tape::{SizedValue, Tape};
use crate::sample::{Random, Sampler};

/// Most pairs of points with different signs that are bisected, and most minima that are followed.
const MOST: usize = 4;

/// A margin below this share of the largest one goes to zero.
const NEXT_TO_ZERO: f64 = 1e-14;

/// A coordinate so near to zero may be zero.
const NEAR: f64 = 1e-12;

/// The first step downhill, and the distance of the starts, in lengths of the sides.
const STEP: f64 = 0.1;

/// A point of the sample, and the margin there.
pub(super) type AtPoint<'p> = (&'p Vec<f64>, SizedValue);

/// A margin in a part of the domain.
pub(super) struct Descent<'d, 'm> {
    pub(super) margin: &'d Margin,
    pub(super) tape: Tape<'m>,
    pub(super) sampler: &'d Sampler<'m>,
    /// Of the part; none on a level, where nothing is followed.
    pub(super) sides: Vec<[f64; 2]>,
    /// The largest margin of the sample.
    pub(super) scale: f64,
}

impl Descent<'_, '_> {
    /// The margin; `None` outside the part, and where its operations are not evaluated.
    pub(super) fn at(&self, point: &[f64]) -> Option<SizedValue> {
        let mut pairs = self.sides.iter().zip(point);
        let is_in_box = pairs.all(|([low, high], x)| low <= x && x <= high);
        let is_inside = is_in_box && self.sampler.is_inside(point, None);
        is_inside.then(|| self.margin.at(&self.tape.needed(point)))?
    }

    /// Whether it is lost, or goes to zero.
    pub(super) fn is_lost(&self, at: SizedValue) -> bool {
        self.margin.is_lost(at, NEXT_TO_ZERO * self.scale)
    }

    /// Places where the margin is lost: of the sample, between two of its points, and downhill.
    pub(super) fn places(&self, sample: &[AtPoint<'_>]) -> Vec<Vec<f64>> {
        let lost = sample.iter().filter(|entry| self.is_lost(entry.1));
        let mut places: Vec<Vec<f64>> = lost.take(MOST).map(|entry| entry.0.clone()).collect();
        if self.sides.is_empty() {
            return places;
        }
        let positive = sample.iter().filter(|entry| entry.1.value > 0.0);
        let negative = sample.iter().filter(|entry| entry.1.value < 0.0);
        for (one, other) in positive.zip(negative).take(MOST) {
            places.push(self.approach(one.0, other.0));
        }
        let starts = self.starts(sample).into_iter();
        places.extend(starts.map(|start| self.down(start)));
        let places = places.into_iter().map(|point| self.snapped(point));
        places
            .filter(|point| self.at(point).is_some_and(|at| self.is_lost(at)))
            .collect()
    }

    /// The point, with zeros in place of coordinates next to zero, if the margin is lost there.
    fn snapped(&self, point: Vec<f64>) -> Vec<f64> {
        let snapped: Vec<f64> = point
            .iter()
            .map(|x| if x.abs() <= NEAR { 0.0 } else { *x })
            .collect();
        match self.at(&snapped) {
            Some(at) if self.is_lost(at) => snapped,
            _ => point,
        }
    }

    /// Points with the smallest margins, apart from each other.
    fn starts<'p>(&self, sample: &[AtPoint<'p>]) -> Vec<&'p Vec<f64>> {
        let mut sample = sample.to_vec();
        sample.sort_by(|a, b| a.1.value.abs().total_cmp(&b.1.value.abs()));
        let mut starts: Vec<&Vec<f64>> = vec![];
        for (point, _) in sample {
            let is_apart = |start: &&Vec<f64>| {
                let mut sides = self.sides.iter().zip(*start).zip(point);
                sides.any(|(([low, high], a), b)| (a - b).abs() > STEP * (high - low))
            };
            if starts.len() < MOST && starts.iter().all(is_apart) {
                starts.push(point);
            }
        }
        starts
    }

    /// The end of the way towards another point, as long as the margin is evaluated and keeps its
    /// sign; or the number behind it, if the margin is smaller there.
    fn approach(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        const HALVINGS: usize = 100;
        let value = |point: &[f64]| self.at(point).map(|at| at.value);
        let sign = value(from).map_or(1.0, f64::signum);
        let [mut near, mut far] = [from.to_vec(), to.to_vec()];
        for _ in 0..HALVINGS {
            let pairs = near.iter().zip(&far);
            let middle: Vec<f64> = pairs.map(|(a, b)| a + 0.5 * (b - a)).collect();
            match value(&middle) {
                Some(value) if value * sign > 0.0 => near = middle,
                _ => far = middle,
            }
        }
        let [before, behind] = [&near, &far].map(|point| value(point).map(f64::abs));
        if behind.is_some() && behind < before {
            far
        } else {
            near
        }
    }

    /// The end of a pattern search: steps along the axes and along as many random directions are
    /// halved when none goes down.
    fn down(&self, start: &[f64]) -> Vec<f64> {
        const SWEEPS: usize = 400;
        const SHORTEST: f64 = 1e-18;
        let mut random = Random(1);
        let mut point = start.to_vec();
        let mut before = point.clone();
        let mut step = STEP;
        for _ in 0..SWEEPS {
            let Some(here) = self.at(&point) else { break };
            // To be zero nearby, it would fall a thousand times as steeply as over the domain.
            let is_minimum = here.value.abs() > 1000.0 * step * self.scale;
            if here.value == 0.0 || is_minimum || step < SHORTEST {
                break;
            }
            let mut lowest = here.value.abs();
            let mut best = None;
            let mut around = self.around(&point, step, &mut random);
            let onwards = point
                .iter()
                .zip(&before)
                .map(|(now, before)| now + (now - before));
            around.push(onwards.collect());
            for next in around {
                let Some(there) = self.at(&next) else {
                    continue;
                };
                if self.margin.is_outside(there) {
                    return next;
                }
                let is_opposite = there.value * here.value < 0.0;
                let next = if is_opposite {
                    self.approach(&point, &next)
                } else {
                    next
                };
                let height = self.at(&next).map_or(lowest, |at| at.value.abs());
                if height < lowest {
                    lowest = height;
                    best = Some(next);
                }
            }
            match best {
                Some(next) => {
                    before = point;
                    point = next;
                }
                None => step *= 0.5,
            }
        }
        point
    }

    /// Points at a distance, in lengths of the sides, along the axes and along random directions.
    pub(super) fn around(
        &self,
        point: &[f64],
        distance: f64,
        random: &mut Random,
    ) -> Vec<Vec<f64>> {
        let axes = self.sides.len();
        let mut points = vec![];
        for number in 0..4 * axes {
            let direction = (0..axes).map(|axis| match number {
                _ if number >= 2 * axes => 2.0 * random.share() - 1.0,
                _ if number / 2 != axis => 0.0,
                _ => [-1.0, 1.0][number % 2],
            });
            let parts = point.iter().zip(direction).zip(&self.sides);
            points.push(
                parts
                    .map(|((x, along), [low, high])| {
                        (x + distance * along * (high - low)).clamp(*low, *high)
                    })
                    .collect(),
            );
        }
        points
    }
}
