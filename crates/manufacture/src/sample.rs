//! Points of the domain and of its faces, drawn at random, the same for the same seed.

use crate::derive::{Part, Role};
use crate::model::{Model, TensorRows};
use crate::problem::{InputError, Surface, System};

/// Points keep this distance from a switch of `abs`, `min`, `max`, `where`, `heaviside`: a share of
/// the largest difference that it compares.
const FROM_SWITCHES: f64 = 1e-6;

/// Points keep this share of the interval from an axis, where 1/r is not evaluated.
pub(crate) const FROM_AXIS: f64 = 1e-6;

/// A point so near to an end of a side, in lengths of it, is there.
const AT_END: f64 = 1e-12;

/// Draws for each point that is wanted before a domain counts as empty.
const TRIES: usize = 1000;

/// Draws for each point that may be left out.
const FEW_TRIES: usize = 20;

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
            levels: model.rows(levels.iter().copied()),
            level_faces: levels.iter().map(|level| level.name.clone()).collect(),
        }
    }

    /// Points of a part of the domain, away from all switches of its quantities.
    pub(crate) fn points(&mut self, part: Part, count: usize) -> Result<Vec<Vec<f64>>, InputError> {
        // A switch on which all of the part lies is on the scale of its rounding.
        let switches = self.switches(part, self.model.rows(self.model.part(part)));
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
            if !switches.near(&point).contains(&true) {
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

    /// The switches of some quantities, on the scale of a part.
    pub(crate) fn switches(&self, part: Part, rows: TensorRows<'m>) -> Switches<'m> {
        const DRAWS: usize = 100;
        let mut other = Self::new(self.model, self.random.0);
        let mut scales: Vec<f64> = vec![];
        for point in (0..DRAWS).filter_map(|_| other.draw(part)) {
            let differences = rows.at(&point).switches;
            if differences.is_empty() {
                break;
            }
            scales.resize(differences.len(), 0.0);
            for (scale, difference) in scales.iter_mut().zip(differences) {
                if difference.is_finite() {
                    *scale = scale.max(difference.abs());
                }
            }
        }
        Switches { rows, scales }
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
        if let Some(face) = own {
            return face.place.error(format!(
                "no point of the face is inside the domain, in {draws} draws; expected a face that the levels leave"
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

    /// The sides of a part, those along which it does not extend of length zero; none on a level.
    pub(crate) fn sides(&self, part: Part) -> Vec<[f64; 2]> {
        let problem = &self.model.problem;
        let mut sides = problem.intervals.clone();
        match part {
            Part::Interior => (),
            Part::Initial => {
                if let (Some(first), Some(time)) = (problem.first_time(), sides.last_mut()) {
                    *time = [first; 2];
                }
            }
            Part::Face(index) => match problem.faces[index].surface {
                Surface::Level(_) => return vec![],
                Surface::Side {
                    coordinate,
                    is_upper,
                } => {
                    let end = sides[coordinate][usize::from(is_upper)];
                    sides[coordinate] = [end; 2];
                }
            },
        }
        let [low, high] = problem.intervals[0];
        if problem.system != System::Cartesian {
            sides[0] = sides[0].map(|radius| radius.max(low + FROM_AXIS * (high - low)));
        }
        sides
    }

    /// So many points inside a part, then as many on all its faces, edges and corners together.
    pub(crate) fn everywhere(&mut self, part: Part, count: usize) -> Vec<Vec<f64>> {
        let sides = self.sides(part);
        if sides.is_empty() {
            let draws = 0..TRIES * count;
            return draws.filter_map(|_| self.draw(part)).take(count).collect();
        }
        let mut boxes: Vec<Vec<[f64; 2]>> = vec![vec![]];
        for [low, high] in sides {
            let ends = [[low, high], [low; 2], [high; 2]];
            let longer = boxes
                .iter()
                .flat_map(|sides| ends.map(|end| [sides, &[end][..]].concat()));
            boxes = longer.collect();
            boxes.dedup();
        }
        let share = count.div_ceil(boxes.len());
        let mut points = vec![];
        for (place, sides) in boxes.iter().enumerate() {
            let is_point = sides.iter().all(|[low, high]| low == high);
            let wanted = match place {
                _ if is_point => 1,
                0 => count,
                _ => share,
            };
            points.extend(self.within(sides, wanted));
        }
        points
    }

    /// Points of the domain in a box.
    ///
    /// * `wanted`: their number, if the box has as many.
    pub(crate) fn within(&mut self, sides: &[[f64; 2]], wanted: usize) -> Vec<Vec<f64>> {
        let mut points = vec![];
        for _ in 0..FEW_TRIES * wanted {
            if points.len() == wanted {
                break;
            }
            let point = self.between(sides);
            if self.is_inside(&point, None) {
                points.push(point);
            }
        }
        points
    }

    /// Whether all levels but that of one face are negative.
    pub(crate) fn is_inside(&self, point: &[f64], but: Option<&str>) -> bool {
        let values = self.levels.at(point).tensors;
        let mut levels = self.level_faces.iter().zip(values);
        levels.all(|(face, value)| Some(face.as_str()) == but || value[0].value < 0.0)
    }

    /// Whether a point is on a level but for rounding, or at an end of a side along which the part
    /// extends.
    pub(crate) fn is_on_boundary(&self, part: Part, point: &[f64]) -> bool {
        let levels = self.levels.at(point).tensors;
        let mut ends = point.iter().zip(self.sides(part));
        ends.any(|(x, [low, high])| low < high && (x - low).min(high - x) <= AT_END * (high - low))
            || levels
                .iter()
                .any(|level| level[0].value.abs() <= AT_END * level[0].size)
    }

    /// A point between some sides.
    fn between(&mut self, sides: &[[f64; 2]]) -> Vec<f64> {
        let sides = sides.iter();
        let along = sides.map(|[low, high]| low + self.random.share() * (high - low));
        along.collect()
    }

    fn draw(&mut self, part: Part) -> Option<Vec<f64>> {
        let sides = self.sides(part);
        match part {
            // A level has no sides.
            Part::Face(index) if sides.is_empty() => {
                let face = self.model.problem.faces[index].name.as_str();
                let point = self.on_level(face)?;
                self.is_inside(&point, Some(face)).then_some(point)
            }
            _ => {
                let point = self.between(&sides);
                self.is_inside(&point, None).then_some(point)
            }
        }
    }

    /// The zero of a level between two points of the box where it has different signs, to the last
    /// digit.
    fn on_level(&mut self, face: &str) -> Option<Vec<f64>> {
        let place = self.level_faces.iter().position(|name| name == face)?;
        let sides = self.sides(Part::Interior);
        let start = self.between(&sides);
        let mut end = self.between(&sides);
        if self.model.problem.time.is_some() {
            *end.last_mut()? = *start.last()?;
        }
        let along = |share: f64| -> Vec<f64> {
            let pairs = start.iter().zip(&end);
            pairs.map(|(a, b)| a + share * (b - a)).collect()
        };
        let level = |share: f64| self.levels.at(&along(share)).tensors[place][0].value;
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
        Some(along(bracket[0]))
    }
}

/// The switches of `abs`, `min`, `max`, `where`, `heaviside` in some quantities.
pub(crate) struct Switches<'m> {
    rows: TensorRows<'m>,
    /// The largest difference that each of them compares.
    scales: Vec<f64>,
}

impl Switches<'_> {
    /// For each switch whether a point lies on it.
    pub(crate) fn near(&self, point: &[f64]) -> Vec<bool> {
        if self.scales.is_empty() {
            return vec![];
        }
        let differences = self.rows.at(point).switches.into_iter();
        let pairs = differences.zip(&self.scales);
        pairs
            .map(|(difference, scale)| difference.abs() < FROM_SWITCHES * scale)
            .collect()
    }

    /// Whether all of these points lie on one switch.
    pub(crate) fn have_one_below(&self, points: &[Vec<f64>]) -> bool {
        let mut below_all = vec![!points.is_empty(); self.scales.len()];
        for point in points {
            for (below_all, is_near) in below_all.iter_mut().zip(self.near(point)) {
                *below_all &= is_near;
            }
        }
        below_all.contains(&true)
    }
}
