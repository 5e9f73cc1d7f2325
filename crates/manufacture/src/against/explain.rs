//! Which edit of the file gives the values of the other program?

use super::Comparison;
use super::bench::Bench;
use super::candidates::{self, Candidate, EditKind};
use super::cause::{Named, TermFactor, of_terms, place_and_text};
use super::right::Right;
use super::solve::{self, Curve, Sample};
use super::text;
use super::whole::Component;
use crate::derive::Role;
use crate::fit::Column;
use crate::problem::Location;

/// Points at which candidates are tried; those that fit are held against all points.
const TRIAL_POINTS: usize = 8;

/// The cost of an edit with a simple number that the file does not have there.
const NEW_NUMBER: usize = 20;

/// The cost of an edit with a number that nobody writes.
const FAR_FETCHED: usize = 40;

/// A search over the edits of the quantities of a question.
pub(super) struct EditSearch<'a, 'm> {
    right: &'a Right<'m>,
    components: &'a [Component<'a, 'm>],
    bench: Bench,
    /// Points of the same part that nobody was asked about.
    fresh: &'a [Vec<f64>],
}

/// An edit that fits at the points of the trial.
#[derive(Debug, Clone)]
struct Match {
    candidate: Candidate,
    factor: f64,
    /// Of the components that are wrong, those that fit.
    fits: Vec<bool>,
    /// The values of all components at fresh points.
    fresh: Vec<Column>,
    /// All components of the answer that fit.
    breadth: usize,
}

impl Match {
    /// Whether two edits have the same values of a component at fresh points.
    fn is_same(&self, other: &Self, component: usize) -> bool {
        const SAME: f64 = 1e-9;
        let [first, second] = [self, other].map(|found| &found.fresh[component]);
        let largest = first.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let mut pairs = first.iter().zip(second);
        pairs.all(|(a, b)| (a - b).abs() <= SAME * largest)
    }

    fn cost(&self) -> usize {
        cost(&self.candidate, self.factor)
    }
}

/// The components of a quantity that are wrong, at the points of a trial.
struct Trial {
    points: Vec<Vec<f64>>,
    wrong: Vec<Sample>,
}

impl Trial {
    /// Points where the values of the other program are most different, and others.
    fn new(right: &Right<'_>, wrong: &[&Component<'_, '_>]) -> Self {
        let count = right.points.len();
        let mut shares = vec![0.0_f64; count];
        for component in wrong {
            let differences = component.differences();
            let largest = differences.iter().copied().fold(0.0, f64::max);
            for (share, difference) in shares.iter_mut().zip(differences) {
                *share = share.max(difference / largest);
            }
        }
        let mut places: Vec<usize> = (0..count).collect();
        places.sort_by(|a, b| shares[*b].total_cmp(&shares[*a]));
        let mut last = places.split_off((TRIAL_POINTS / 2).min(count));
        last.sort_unstable();
        places.extend(last.into_iter().take(TRIAL_POINTS / 2));
        let wrong = wrong.iter();
        Self {
            points: places.iter().map(|p| right.points[*p].clone()).collect(),
            wrong: wrong.map(|wrong| wrong.values.at(&places)).collect(),
        }
    }

    /// The factors with which an edit fits a component.
    fn factors(&self, curve: &mut Curve<'_>, change: EditKind) -> Vec<f64> {
        let mut factors = vec![];
        for sample in &self.wrong {
            factors.extend(match change.has_factor() {
                true => solve::factor(curve, sample),
                false => self.fits(curve, sample).then_some(1.0),
            });
        }
        factors.sort_by(f64::total_cmp);
        factors.dedup();
        factors
    }

    fn fits(&self, curve: &mut Curve<'_>, sample: &Sample) -> bool {
        sample.fits(&curve.at(1.0)[sample.component])
    }
}

impl<'a, 'm> EditSearch<'a, 'm> {
    /// * `fresh`: points of the same part that nobody was asked about.
    pub(super) fn new(
        right: &'a Right<'m>,
        components: &'a [Component<'a, 'm>],
        fresh: &'a [Vec<f64>],
    ) -> Option<Self> {
        Some(Self {
            right,
            components,
            bench: Bench::new(right.model, right.part)?,
            fresh,
        })
    }

    fn name(&self, quantity: usize) -> &'m str {
        &self.right.quantities[quantity].quantity.name
    }

    /// Explains components of one quantity, by their places, each by itself.
    pub(super) fn explain(
        &mut self,
        quantity: usize,
        places: &[usize],
    ) -> Vec<(usize, Comparison)> {
        let all = self.components;
        let wrong: Vec<&Component<'a, 'm>> = places.iter().map(|place| &all[*place]).collect();
        let trial = Trial::new(self.right, &wrong);
        let problem = &self.right.model.problem;
        let name = self.name(quantity);
        let (rare, frequent): (Vec<_>, Vec<_>) = candidates::all(problem, self.right.part, name)
            .into_iter()
            .partition(|candidate| candidate.is_rare);
        let mut edits = 0;
        let mut matches = vec![];
        for candidates in [frequent, rare] {
            let is_explained = |place: usize| {
                let mut matches = matches.iter();
                matches.any(|found: &Match| found.cost() < NEW_NUMBER && found.fits[place])
            };
            if !(0..wrong.len()).all(is_explained) {
                edits += candidates.len();
                self.singles(name, &trial, candidates, &mut matches);
            }
        }
        for found in &mut matches {
            found.breadth = self.breadth(found);
        }
        // Those that explain most first; of these the smallest, then those nearest to a term.
        matches.sort_by_key(|found| {
            let breadth = usize::MAX - found.breadth;
            (breadth, found.cost(), found.candidate.depth)
        });
        let mut explained = vec![];
        for (index, component) in wrong.iter().enumerate() {
            let single = self.single(component, index, &matches);
            let [near, far] = match single {
                Some((best, single)) if best.cost() >= FAR_FETCHED => [None, Some(single)],
                single => [single.map(|single| single.1), None],
            };
            let found = near
                .or_else(|| component.of_component())
                .or_else(|| component.of_several_terms())
                .or(far);
            let none = || self.unexplained(component, edits);
            explained.push((places[index], found.unwrap_or_else(none)));
        }
        explained
    }

    /// What is said where nothing fits: where the difference is largest and where it is smallest.
    fn unexplained(&self, component: &Component<'_, '_>, edits: usize) -> Comparison {
        let right = self.right;
        let differences = component.differences();
        let differences = || differences.iter().zip(&right.points);
        let largest = differences().max_by(|a, b| a.0.total_cmp(b.0));
        let smallest = differences().min_by(|a, b| a.0.total_cmp(b.0));
        let [largest, smallest] = [largest, smallest].map(|entry| {
            entry.map_or(String::new(), |(difference, point)| {
                format!("{difference:.3e} at {}", right.model.place_in_words(point))
            })
        });
        let cut = match self.bench.is_exhausted() {
            true => ", where the limit of work was reached",
            false => "",
        };
        component.said("none", &format!(
            "no explanation found by {edits} edit(s){cut}; your values differ by {largest} and by {smallest}"
        ))
    }

    /// The single edits of a quantity that fit.
    fn singles(
        &mut self,
        quantity: &str,
        trial: &Trial,
        candidates: Vec<Candidate>,
        matches: &mut Vec<Match>,
    ) {
        for candidate in candidates {
            if self.bench.is_exhausted() {
                return;
            }
            let alteration = Some(&candidate.alteration);
            let found = self.bench.altered(alteration, quantity, |altered| {
                let evaluation = altered.evaluation();
                let mut curve = Curve::new(&evaluation, &trial.points);
                let factors = trial.factors(&mut curve, candidate.change);
                let matches = factors.into_iter().map(|factor| {
                    let wrong = trial.wrong.iter();
                    let columns = curve.at(factor);
                    Match {
                        candidate: candidate.clone(),
                        factor,
                        fits: wrong.map(|w| w.fits(&columns[w.component])).collect(),
                        fresh: evaluation.columns(self.fresh, factor),
                        breadth: 0,
                    }
                });
                matches.collect::<Vec<_>>()
            });
            matches.extend(found.into_iter().flatten());
        }
    }

    /// The number of all components that an edit explains, or leaves right.
    fn breadth(&mut self, found: &Match) -> usize {
        let count = self.right.points.len().min(TRIAL_POINTS);
        let places: Vec<usize> = (0..count).collect();
        let points = &self.right.points[..count];
        let alteration = Some(&found.candidate.alteration);
        let mut breadth = 0;
        for quantity in 0..self.right.quantities.len() {
            let components = self.components.iter();
            let components = components.filter(|c| c.place.quantity == quantity);
            let name = self.name(quantity);
            let columns = self.bench.altered(alteration, name, |altered| {
                altered.evaluation().columns(points, found.factor)
            });
            let Some(columns) = columns else { continue };
            let fitting = components.filter(|component| {
                let column = &columns[component.place.component];
                component.values.at(&places).fits(column)
            });
            breadth += fitting.count();
        }
        breadth
    }

    /// Whether an altered component has the foreign values at all points.
    fn fits_everywhere(&mut self, component: &Component<'a, 'm>, found: &Match) -> bool {
        let name = self.name(component.place.quantity);
        let points = &self.right.points;
        let alteration = Some(&found.candidate.alteration);
        let fits = self.bench.altered(alteration, name, |altered| {
            let evaluation = altered.evaluation();
            let mut values = evaluation.at(points, found.factor).enumerate();
            values.all(|(place, values)| {
                let value = values[component.place.component].value;
                component.values.fits_at(place, value)
            })
        });
        fits == Some(true)
    }

    /// The best edit that explains a component at all points.
    fn single<'f>(
        &mut self,
        component: &Component<'a, 'm>,
        place: usize,
        matches: &'f [Match],
    ) -> Option<(&'f Match, Comparison)> {
        let mut groups: Vec<&Match> = vec![];
        let mut alternatives = vec![];
        for found in matches.iter().filter(|found| found.fits[place]) {
            let same = |other: &&&Match| found.is_same(other, component.place.component);
            if let Some(known) = groups.iter().find(same) {
                // Another term with the same effect: no point tells them apart.
                let are_terms = [known, found]
                    .iter()
                    .all(|found| found.candidate.change == EditKind::Term);
                if are_terms && std::ptr::eq(*known, groups[0]) {
                    let named = self.named(component, found);
                    alternatives.push(format!("{} times {}", named.terms[0], found.factor));
                }
            } else if self.fits_everywhere(component, found) {
                if !groups.is_empty() {
                    let file = &self.right.model.problem.file;
                    let Named { change, edit, .. } = self.named(component, found);
                    alternatives.push(place_and_text(change, &edit, file));
                }
                groups.push(found);
            }
        }
        let best = *groups.first()?;
        let Named {
            change,
            factors,
            terms,
            edit,
        } = self.named(component, best);
        let file = &self.right.model.problem.file;
        let mut words = match (change, factors.first()) {
            (EditKind::Term, Some(factor)) => {
                let label = terms[0].clone();
                let term = TermFactor {
                    label,
                    factor: *factor,
                };
                let words = of_terms(&[term], &self.right.labels(component.place));
                format!("{words} ({file}:{}:{})", edit.line, edit.column)
            }
            _ => place_and_text(change, &edit, file),
        };
        if !alternatives.is_empty() {
            words += &format!(" (this fits as well: {})", alternatives.join(", "));
        }
        let said = Comparison {
            terms,
            factors,
            alternatives,
            ..component.said(edit.kind, &words)
        };
        Some((
            best,
            Comparison {
                edits: vec![edit],
                ..said
            },
        ))
    }

    fn named(&self, component: &Component<'_, '_>, found: &Match) -> Named {
        let whole = place_of(self.right, component.place.quantity);
        let problem = &self.right.model.problem;
        text::named(problem, &whole, &found.candidate, found.factor)
    }
}

/// How much an edit changes; those that people make most often are cheapest.
fn cost(candidate: &Candidate, factor: f64) -> usize {
    let is_lost = factor == -1.0 || factor == 0.0;
    match candidate.change {
        EditKind::Term | EditKind::Summand if is_lost => 10,
        EditKind::LostFactor | EditKind::LostDivisor | EditKind::LostOperator => 10,
        EditKind::Normal | EditKind::TimeFactor => 9,
        EditKind::TransposedGradient | EditKind::MissingTranspose | EditKind::Held => 11,
        EditKind::Exponent if text::has_simple_number(candidate, factor) => 11,
        EditKind::TimesForOver
        | EditKind::Typed
        | EditKind::Order
        | EditKind::Operator
        | EditKind::Function => 12,
        EditKind::Derivative | EditKind::Index | EditKind::Branch | EditKind::LostBracket => 13,
        EditKind::Name => 16,
        EditKind::Term | EditKind::Summand | EditKind::Part
            if text::has_simple_number(candidate, factor) =>
        {
            12
        }
        EditKind::Parameters | EditKind::Basis => 13,
        EditKind::Part if is_lost => 14,
        EditKind::LostTime
        | EditKind::OneDifferentiated
        | EditKind::TakenBelow
        | EditKind::Square => 15,
        EditKind::Time | EditKind::Coordinates | EditKind::Parameter => 30,
        change if change.has_factor() && solve::is_simple(factor) => NEW_NUMBER,
        _ => FAR_FETCHED,
    }
}

/// Where a quantity stands in the file.
pub(super) fn place_of(right: &Right<'_>, quantity: usize) -> Location {
    let quantity = right.quantities[quantity].quantity;
    let problem = &right.model.problem;
    let mut equations = problem.equations.iter();
    let is_source = quantity.role == Role::Source;
    if let Some(equation) = equations.find(|e| is_source && e.name == quantity.name) {
        return equation.place.clone();
    }
    let mut data = problem.faces.iter().flat_map(|face| &face.data);
    let datum = data.find(|datum| datum.value.place().key.starts_with(&quantity.key));
    datum.map_or_else(
        || problem.equations[0].place.clone(),
        |d| d.value.place().clone(),
    )
}
