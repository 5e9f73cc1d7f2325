//! Which edit of the file gives the values of the other program?

use std::collections::BTreeMap;

use super::Comparison;
use super::ask::ForeignQuantity;
use super::bench::{Bench, Points};
use super::candidates::{self, Candidate, EditKind};
use super::cause::{Named, of_terms, place_and_text};
use super::right::Right;
use super::solve::{self, Curve, Sample};
use super::text;
use super::whole::Component;
use crate::fit::Column;

/// Points at which candidates are tried; those that fit are held against all points.
const TRIAL_POINTS: usize = 8;

/// The cost of an edit with a simple number that the file does not have there.
const NEW_NUMBER: usize = 20;

/// The cost of an edit with a number that nobody writes.
const FAR_FETCHED: usize = 40;

/// Explains what another program answers, each component by itself.
///
/// * `spreads`: those of [`Right::spreads`].
/// * `fresh`: points that the program was not asked about.
pub(super) fn explain(
    right: &Right<'_>,
    spreads: &[f64],
    answers: &[ForeignQuantity],
    fresh: &[Vec<f64>],
) -> Vec<Comparison> {
    let answers = answers.iter();
    let components = answers.map(|answer| Component::new(right, spreads, answer));
    let components: Vec<Component<'_, '_>> = components.collect();
    let mut said: Vec<Option<Comparison>> = components.iter().map(Component::of_source).collect();
    let mut open: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (place, component) in components.iter().enumerate() {
        if said[place].is_none() {
            open.entry(component.quantity()).or_default().push(place);
        }
    }
    let bench = (!open.is_empty()).then(|| Bench::new(right.model, right.sampled.part));
    if let Some(bench) = bench.flatten() {
        let points = &right.sampled.points;
        let mut search = EditSearch {
            right,
            components: &components,
            fresh: bench.points(fresh),
            first: bench.points(&points[..points.len().min(TRIAL_POINTS)]),
            all: Points::plain(points),
            bench,
        };
        for (quantity, places) in open {
            let found = search.explain(quantity, &places);
            for (place, found) in places.into_iter().zip(found) {
                said[place] = Some(found);
            }
        }
    }
    let pairs = said.into_iter().zip(&components);
    pairs
        .map(|(said, component)| {
            said.unwrap_or_else(|| component.said("none", "no explanation found"))
        })
        .collect()
}

/// A search over the edits of the quantities of a question.
struct EditSearch<'a, 'm> {
    right: &'a Right<'m>,
    components: &'a [Component<'a, 'm>],
    bench: Bench<'m>,
    /// Points of the same part that nobody was asked about.
    fresh: Points,
    /// The first points of the question, and all.
    first: Points,
    all: Points,
}

/// An edit that fits at the points of the trial.
#[derive(Debug, Clone)]
struct Match<'p> {
    candidate: Candidate<'p>,
    factor: f64,
    /// Of the components that are wrong, those that fit.
    fits: Vec<bool>,
    /// The values of all components at fresh points.
    fresh: Vec<Column>,
    /// All components of the answer that fit.
    breadth: usize,
}

impl Match<'_> {
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

    /// The values of all components of a quantity after this edit.
    fn columns(
        &self,
        bench: &mut Bench<'_>,
        quantity: &str,
        points: &Points,
    ) -> Option<Vec<Column>> {
        bench.altered(Some(&self.candidate.alteration), quantity, |altered| {
            altered.columns(points, self.factor)
        })
    }
}

/// The components of a quantity that are wrong, at the points of a trial.
struct Trial {
    points: Points,
    wrong: Vec<Sample>,
}

impl Trial {
    /// Points where the values of the other program are most different, and others.
    fn new(bench: &Bench<'_>, points: &[Vec<f64>], wrong: &[&Component<'_, '_>]) -> Self {
        let mut shares = vec![0.0_f64; points.len()];
        for component in wrong {
            let differences = component.differences();
            let largest = differences.iter().copied().fold(0.0, f64::max);
            for (share, difference) in shares.iter_mut().zip(differences) {
                *share = share.max(difference / largest);
            }
        }
        let mut places: Vec<usize> = (0..points.len()).collect();
        places.sort_by(|a, b| shares[*b].total_cmp(&shares[*a]));
        let mut last = places.split_off((TRIAL_POINTS / 2).min(points.len()));
        last.sort_unstable();
        places.extend(last.into_iter().take(TRIAL_POINTS / 2));
        let wrong = wrong.iter();
        let points: Vec<Vec<f64>> = places.iter().map(|p| points[*p].clone()).collect();
        Self {
            points: bench.points(&points),
            wrong: wrong.map(|wrong| wrong.values.at(&places)).collect(),
        }
    }

    /// The factors with which an edit fits a component.
    fn factors(&self, curve: &mut Curve<'_>, kind: EditKind) -> Vec<f64> {
        let mut factors = vec![];
        for sample in &self.wrong {
            factors.extend(match kind.has_factor() {
                true => solve::factor(curve, sample),
                false => sample.fits(&curve.at(1.0)[sample.component]).then_some(1.0),
            });
        }
        factors.sort_by(f64::total_cmp);
        factors.dedup();
        factors
    }
}

impl<'m> EditSearch<'_, 'm> {
    /// Explains components of one quantity, by their places, each by itself.
    fn explain(&mut self, quantity: &str, places: &[usize]) -> Vec<Comparison> {
        let all = self.components;
        let wrong: Vec<&Component<'_, '_>> = places.iter().map(|place| &all[*place]).collect();
        let Right { model, sampled, .. } = self.right;
        let trial = Trial::new(&self.bench, &sampled.points, &wrong);
        let candidates = candidates::all(&model.problem, sampled.part, quantity);
        let edits = candidates.len();
        let mut matches = self.fitting(quantity, &trial, candidates);
        for found in &mut matches {
            found.breadth = self.breadth(found);
        }
        // Those that explain most first; of these the smallest, then those nearest to a term.
        matches.sort_by_key(|found| {
            let breadth = usize::MAX - found.breadth;
            (breadth, found.cost(), found.candidate.depth)
        });
        let mut explained = vec![];
        for (index, component) in wrong.into_iter().enumerate() {
            let said = match self.best(component, index, &matches) {
                Some(best) if best.cost < FAR_FETCHED => best.said,
                far => component
                    .of_component()
                    .or_else(|| component.of_several_terms())
                    .or(far.map(|far| far.said))
                    .unwrap_or_else(|| self.unexplained(component, edits)),
            };
            explained.push(said);
        }
        explained
    }

    /// What is said where nothing fits: where the difference is largest and where it is smallest.
    fn unexplained(&self, component: &Component<'_, '_>, edits: usize) -> Comparison {
        let differences = component.differences();
        let differences = differences.iter().zip(&self.right.sampled.points);
        let largest = differences.clone().max_by(|a, b| a.0.total_cmp(b.0));
        let smallest = differences.min_by(|a, b| a.0.total_cmp(b.0));
        let [largest, smallest] = [largest, smallest].map(|entry| {
            entry.map_or(String::new(), |(difference, point)| {
                let place = self.right.model.place_in_words(point);
                format!("{difference:.3e} at {place}")
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

    /// The candidates that fit at the points of the trial, with their factors.
    fn fitting(
        &mut self,
        quantity: &str,
        trial: &Trial,
        candidates: Vec<Candidate<'m>>,
    ) -> Vec<Match<'m>> {
        let mut matches = vec![];
        for candidate in candidates {
            if self.bench.is_exhausted() {
                break;
            }
            let alteration = Some(&candidate.alteration);
            self.bench.altered(alteration, quantity, |altered| {
                let mut curve = Curve::new(altered, &trial.points);
                for factor in trial.factors(&mut curve, candidate.kind) {
                    let columns = curve.at(factor);
                    let wrong = trial.wrong.iter();
                    matches.push(Match {
                        candidate: candidate.clone(),
                        factor,
                        fits: wrong.map(|w| w.fits(&columns[w.component])).collect(),
                        fresh: altered.columns(&self.fresh, factor),
                        breadth: 0,
                    });
                }
            });
        }
        matches
    }

    /// The number of all components that an edit explains, or leaves right.
    fn breadth(&mut self, found: &Match<'_>) -> usize {
        let places: Vec<usize> = (0..self.first.len()).collect();
        let mut breadth = 0;
        for quantity in self
            .components
            .chunk_by(|a, b| a.quantity() == b.quantity())
        {
            let columns = found.columns(&mut self.bench, quantity[0].quantity(), &self.first);
            let Some(columns) = columns else { continue };
            let fitting = quantity.iter().filter(|component| {
                let column = &columns[component.right.place];
                component.values.at(&places).fits(column)
            });
            breadth += fitting.count();
        }
        breadth
    }

    fn named(&self, component: &Component<'_, '_>, found: &Match<'_>) -> Named {
        text::named(
            &self.right.model.problem,
            &component.right.quantity.place,
            &found.candidate,
            found.factor,
        )
    }

    /// Whether an altered component has the foreign values at all points.
    fn fits_everywhere(&mut self, component: &Component<'_, '_>, found: &Match<'_>) -> bool {
        let columns = found.columns(&mut self.bench, component.quantity(), &self.all);
        columns.is_some_and(|columns| component.values.fits(&columns[component.right.place]))
    }

    /// The best edit that explains a component at all points.
    ///
    /// * `place`: of the component among those that are wrong.
    fn best(
        &mut self,
        component: &Component<'_, '_>,
        place: usize,
        matches: &[Match<'_>],
    ) -> Option<Explanation> {
        let file = &self.right.model.problem.file;
        let mut groups: Vec<&Match<'_>> = vec![];
        let mut alternatives = vec![];
        for found in matches.iter().filter(|found| found.fits[place]) {
            let mut known = groups.iter();
            if let Some(known) = known.find(|known| found.is_same(known, component.right.place)) {
                // Another term with the same effect: no point tells them apart.
                let is_term = |found: &Match<'_>| found.candidate.kind == EditKind::Term;
                if is_term(known) && is_term(found) && std::ptr::eq(*known, groups[0]) {
                    let label = &self.named(component, found).terms[0];
                    alternatives.push(format!("{label} times {}", found.factor));
                }
            } else if self.fits_everywhere(component, found) {
                if !groups.is_empty() {
                    let named = self.named(component, found);
                    alternatives.push(place_and_text(found.candidate.kind, &named.edit, file));
                }
                groups.push(found);
            }
        }
        let best = *groups.first()?;
        let Named {
            factors,
            terms,
            edit,
        } = self.named(component, best);
        let kind = best.candidate.kind;
        let mut words = match kind {
            EditKind::Term => {
                let words = of_terms(&terms, &factors, &component.right.labels());
                format!("{words} ({file}:{}:{})", edit.line, edit.column)
            }
            _ => place_and_text(kind, &edit, file),
        };
        if !alternatives.is_empty() {
            words += &format!(" (this fits as well: {})", alternatives.join(", "));
        }
        Some(Explanation {
            cost: best.cost(),
            said: Comparison {
                terms,
                factors,
                alternatives,
                edits: vec![edit.clone()],
                ..component.said(edit.kind, &words)
            },
        })
    }
}

/// What is said of the best edit, and its cost.
struct Explanation {
    cost: usize,
    said: Comparison,
}

/// How much an edit changes; those that people make most often are cheapest.
fn cost(candidate: &Candidate<'_>, factor: f64) -> usize {
    let is_lost = factor == -1.0 || factor == 0.0;
    match candidate.kind {
        EditKind::Normal | EditKind::TimeFactor => 9,
        EditKind::Term | EditKind::Summand if is_lost => 10,
        EditKind::LostFactor | EditKind::LostOperator => 10,
        EditKind::TransposedGradient | EditKind::MissingTranspose | EditKind::Held => 11,
        EditKind::Exponent if text::has_simple_number(candidate, factor) => 11,
        EditKind::TimesForOver | EditKind::Order | EditKind::Operator | EditKind::Function => 12,
        EditKind::Term | EditKind::Summand | EditKind::Part
            if text::has_simple_number(candidate, factor) =>
        {
            12
        }
        EditKind::Derivative
        | EditKind::Index
        | EditKind::Branch
        | EditKind::LostBracket
        | EditKind::Parameters
        | EditKind::Basis => 13,
        EditKind::Part if is_lost => 14,
        EditKind::LostTime
        | EditKind::OneDifferentiated
        | EditKind::TakenBelow
        | EditKind::Square => 15,
        EditKind::Name => 16,
        EditKind::Time | EditKind::Coordinates | EditKind::Parameter => 30,
        kind if kind.has_factor() && solve::is_simple(factor) => NEW_NUMBER,
        _ => FAR_FETCHED,
    }
}
