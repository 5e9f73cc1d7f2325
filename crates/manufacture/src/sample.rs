//! Points of the domain and of its faces, drawn at random, the same for the same seed.

use crate::derive::{Part, Role};
use crate::model::{Model, TensorRows};
use crate::problem::{InputError, Surface, System};

/// Points keep this distance from a switch of `abs`, `min`, `max`, `where`, `heaviside`.
const FROM_SWITCHES: f64 = 1e-6;

/// Points keep this share of the interval from an axis, where 1/r is not evaluated.
pub(crate) const FROM_AXIS: f64 = 1e-6;

/// Draws for each point that is wanted before a domain counts as empty.
const TRIES: usize = 1000;

/// Random numbers: `splitmix64` by Vigna, which has a period of 2^64 and needs no table.
#[derive(Debug, Clone)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub(crate) fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Draws points of a model's domain.
pub(crate) struct Sampler<'m> {
    model: &'m Model,
    random: Random,
    /// The levels, in the order of [`Sampler::level_faces`].
    levels: TensorRows<'m>,
    level_faces: Vec<String>,
}

impl<'m> Sampler<'m> {
    pub(crate) fn new(model: &'m Model, seed: u64) -> Self {
        let levels: Vec<_> = model.of_role(Role::Level).collect();
        Self {
            model,
            random: Random(seed),
            levels: TensorRows::new(&model.graph, levels.iter().map(|level| &level.tensor)),
            level_faces: levels.iter().map(|level| level.name.clone()).collect(),
        }
    }

    /// Points of a part of the domain, away from all switches of its quantities.
    pub(crate) fn points(&mut self, part: Part, count: usize) -> Result<Vec<Vec<f64>>, InputError> {
        let quantities = self.model.part(part);
        let rows = TensorRows::new(&self.model.graph, quantities.iter().map(|q| &q.tensor));
        let mut points = vec![];
        let mut is_empty = true;
        for _ in 0..count.saturating_mul(TRIES) {
            if points.len() == count {
                break;
            }
            let Some(point) = self.draw(part) else {
                continue;
            };
            is_empty = false;
            let switches = rows.at(&point).switches;
            if !switches.iter().any(|switch| switch.abs() < FROM_SWITCHES) {
                points.push(point);
            }
        }
        if points.len() == count {
            return Ok(points);
        }
        if is_empty && !self.level_faces.is_empty() {
            return Err(self.without_inside(part, count.saturating_mul(TRIES)));
        }
        let (place, what) = match part {
            Part::Face(index) => {
                let face = &self.model.problem.faces[index];
                (face.name.as_str(), "face")
            }
            _ => ("", "domain"),
        };
        let problem = format!(
            "{what} {place}: expected points away from switches, found {} in {} draws",
            points.len(),
            count.saturating_mul(TRIES)
        );
        Err(InputError::whole(&self.model.problem.file, problem))
    }

    /// The error of levels that leave no domain, or of a level that is zero nowhere in it.
    fn without_inside(&self, part: Part, draws: usize) -> InputError {
        let problem = &self.model.problem;
        let own = match part {
            Part::Face(index) => Some(&problem.faces[index]),
            _ => None,
        };
        if let Some(face) = own
            && matches!(face.surface, Surface::Level(_))
        {
            return face.place.error(format!(
                "the level is zero nowhere in the domain, in {draws} draws; expected a level that is negative inside \
                 the domain and positive outside, with both signs in the box"
            ));
        }
        let names = self.level_faces.join(", ");
        let words = format!(
            "no point of the box is inside, in {draws} draws; expected the level of {names} to be negative inside the domain"
        );
        let mut faces = problem.faces.iter();
        match faces.find(|face| self.level_faces.contains(&face.name)) {
            Some(face) => face.place.error(words),
            None => InputError::whole(&problem.file, words),
        }
    }

    /// A point of the box, for `Initial` at the first time.
    fn in_box(&mut self) -> Vec<f64> {
        let problem = &self.model.problem;
        let mut point = vec![];
        for (index, [low, high]) in problem.intervals.iter().enumerate() {
            let is_radius = index == 0 && problem.system != System::Cartesian;
            let nearest = if is_radius { FROM_AXIS } else { 0.0 };
            let share = nearest + (1.0 - nearest) * self.random.share();
            point.push(low + share * (high - low));
        }
        point
    }

    /// Whether all levels but that of one face are negative.
    fn is_inside(&self, point: &[f64], but: Option<&str>) -> bool {
        let values = self.levels.at(point).tensors;
        let mut levels = self.level_faces.iter().zip(values);
        levels.all(|(face, value)| Some(face.as_str()) == but || value[0].value < 0.0)
    }

    pub(crate) fn is_in_domain(&self, point: &[f64]) -> bool {
        let intervals = &self.model.problem.intervals;
        let mut pairs = point.iter().zip(intervals);
        pairs.all(|(x, [low, high])| low <= x && x <= high) && self.is_inside(point, None)
    }

    fn draw(&mut self, part: Part) -> Option<Vec<f64>> {
        let mut point = self.in_box();
        let mut face_name = None;
        match part {
            Part::Interior => (),
            Part::Initial => {
                if let (Some(first), Some(time)) =
                    (self.model.problem.first_time(), point.last_mut())
                {
                    *time = first;
                }
            }
            Part::Face(index) => {
                let face = &self.model.problem.faces[index];
                match face.surface {
                    Surface::Side {
                        coordinate,
                        is_upper,
                    } => {
                        let [low, high] = self.model.problem.intervals[coordinate];
                        point[coordinate] = if is_upper { high } else { low };
                        self.keep_from_axis(&mut point);
                    }
                    Surface::Level(_) => {
                        face_name = Some(face.name.as_str());
                        point = self.on_level(&face.name, point)?;
                    }
                }
            }
        }
        self.is_inside(&point, face_name).then_some(point)
    }

    fn keep_from_axis(&self, point: &mut [f64]) {
        let problem = &self.model.problem;
        if problem.system != System::Cartesian {
            let [low, high] = problem.intervals[0];
            point[0] = point[0].max(low + FROM_AXIS * (high - low));
        }
    }

    /// The zero of a level between two points of the box where it has different signs, to the last
    /// digit.
    fn on_level(&mut self, face: &str, start: Vec<f64>) -> Option<Vec<f64>> {
        let place = self.level_faces.iter().position(|name| name == face)?;
        let mut end = self.in_box();
        if self.model.problem.time.is_some() {
            *end.last_mut()? = *start.last()?;
        }
        let between = |share: f64| -> Vec<f64> {
            let pairs = start.iter().zip(&end);
            pairs.map(|(a, b)| a + share * (b - a)).collect()
        };
        let level = |share: f64| self.levels.at(&between(share)).tensors[place][0].value;
        let first = level(0.0);
        if !(first * level(1.0) < 0.0) {
            return None;
        }
        let mut bracket = [0.0, 1.0];
        for _ in 0..60 {
            let middle = 0.5 * (bracket[0] + bracket[1]);
            let is_left = level(middle) * first > 0.0;
            bracket[usize::from(!is_left)] = middle;
        }
        Some(between(bracket[0]))
    }
}
