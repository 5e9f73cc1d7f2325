//! Which edit of the file gives the values of the other program?

use super::bench::Alteration;
use super::candidates::EditKind;
use super::cause::{Cause, Nearest, Unexplained, place_and_text};
use super::search::EditSearch;
use super::solve::{Curve, Sample, columns};
use super::trial::{FAR_FETCHED, NEW_NUMBER, Near, Trial, attempt, cost, sample};
use super::whole::Component;
use crate::fit::Column;

/// Points at which candidates are tried; those that fit are held against all points.
const TRIAL_POINTS: usize = 8;

/// An edit that fits at the points of the trial.
#[derive(Debug, Clone)]
struct Match {
    candidate: usize,
    factor: f64,
    /// Of the components of the quantity, those that fit.
    fits: Vec<bool>,
    /// The values of all components at fresh points.
    fresh: Vec<Column>,
    /// All components of the answer that fit.
    breadth: usize,
}

/// What an explanation says.
pub(super) struct Explained {
    pub(super) cause: Cause,
    /// Other edits that fit and have other values at fresh points, or other terms.
    pub(super) alternatives: Vec<String>,
}

impl Explained {
    pub(super) fn plain(cause: Cause) -> Self {
        Self {
            cause,
            alternatives: vec![],
        }
    }
}

/// A single edit that explains a component.
struct Single {
    explained: Explained,
    /// Its number is not simple: another kind of mistake is more likely.
    is_far_fetched: bool,
}

/// What all single edits gave.
#[derive(Default)]
struct Tried {
    count: usize,
    matches: Vec<Match>,
    near: Vec<Near>,
}

/// Whether two edits have the same values at fresh points.
fn is_same(first: &[f64], second: &[f64]) -> bool {
    const SAME: f64 = 1e-9;
    let largest = first.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let mut pairs = first.iter().zip(second);
    pairs.all(|(a, b)| (a - b).abs() <= SAME * largest)
}

impl<'a, 'm> EditSearch<'a, 'm> {
    /// Points where the values of the other program are most different, and others.
    fn trial(&self, wrong: &[&Component<'a, 'm>]) -> Vec<usize> {
        let count = self.right.points.len();
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
        let last = places.split_off((TRIAL_POINTS / 2).min(count));
        let mut last = last;
        last.sort_unstable();
        places.extend(last.into_iter().take(TRIAL_POINTS / 2));
        places
    }

    /// Explains components of one quantity, each by itself.
    pub(super) fn explain(&mut self, quantity: usize, wrong: &[usize]) -> Vec<Explained> {
        let components = self.of_quantity(quantity);
        let all = self.components;
        let wrong: Vec<&Component<'a, 'm>> = wrong.iter().map(|place| &all[*place]).collect();
        let places = self.trial(&wrong);
        let points: Vec<Vec<f64>> = places
            .iter()
            .map(|place| self.right.points[*place].clone())
            .collect();
        let samples: Vec<Sample> = components
            .iter()
            .map(|component| sample(component, &places))
            .collect();
        let is_wrong: Vec<bool> = components
            .iter()
            .map(|component| wrong.iter().any(|other| other.place == component.place))
            .collect();
        let trial = Trial {
            points,
            samples,
            is_wrong,
        };
        let mut tried = Tried::default();
        for is_rare in [false, true] {
            if !self.are_explained(&tried, &trial) {
                self.singles(quantity, &trial, is_rare, &mut tried);
            }
        }
        for found in &mut tried.matches {
            found.breadth = self.breadth(quantity, found);
        }
        self.order(&mut tried.matches);
        let mut explained = vec![];
        for component in &wrong {
            let single = self.single(component, &components, &tried);
            let [near, far] = match single {
                Some(single) if single.is_far_fetched => [None, Some(single.explained)],
                Some(single) => [Some(single.explained), None],
                None => [None, None],
            };
            let single = near.or_else(|| self.of_whole(component)).or(far);
            explained.push(match single {
                Some(single) => single,
                None => Explained::plain(Cause::None(Unexplained {
                    nearest: self.nearest(quantity, &tried),
                    edits: tried.count,
                    is_cut: self.bench.is_exhausted(),
                })),
            });
        }
        explained
    }

    /// All single edits of a quantity.
    fn singles(&mut self, quantity: usize, trial: &Trial, is_rare: bool, tried: &mut Tried) {
        let name = self.name(quantity);
        let fresh = self.fresh.clone();
        for place in 0..self.candidates.len() {
            let candidate = self.candidates[place].clone();
            let reaches = match &candidate.alteration {
                Alteration::Rewrite(rewrite) => self.bench.reaches(&rewrite.home, name),
                _ => true,
            };
            if !reaches || candidate.is_rare != is_rare {
                continue;
            }
            if self.bench.is_exhausted() {
                break;
            }
            let seen = self
                .bench
                .altered(Some(&candidate.alteration), name, |altered| {
                    let mut curve = Curve::new(altered.evaluation(), &trial.points);
                    let outcome = attempt(&mut curve, &candidate, trial);
                    let evaluation = altered.evaluation();
                    let matches = outcome.factors.into_iter().map(|factor| Match {
                        candidate: place,
                        factor,
                        fits: trial.fits(curve.at(factor)),
                        fresh: columns(&fresh, |point| evaluation.at(point, factor)),
                        breadth: 0,
                    });
                    (matches.collect::<Vec<_>>(), outcome.near)
                });
            tried.count += 1;
            let Some((matches, near)) = seen else {
                continue;
            };
            tried.matches.extend(matches);
            tried.near.extend(near.map(|near| Near {
                candidate: place,
                ..near
            }));
        }
    }

    /// Whether each component that is wrong has an edit without a new number.
    fn are_explained(&self, tried: &Tried, trial: &Trial) -> bool {
        let near =
            |found: &&Match| cost(&self.candidates[found.candidate], found.factor) < NEW_NUMBER;
        let is_wrong = trial.is_wrong.iter().enumerate();
        let mut wrong = is_wrong.filter(|entry| *entry.1).map(|entry| entry.0);
        wrong.all(|place| {
            tried
                .matches
                .iter()
                .filter(near)
                .any(|found| found.fits[place])
        })
    }

    /// The number of all components that an edit explains, or leaves right.
    fn breadth(&mut self, quantity: usize, found: &Match) -> usize {
        let own = found.fits.iter().filter(|fits| **fits).count();
        let candidate = self.candidates[found.candidate].clone();
        let mut others = 0;
        for other in 0..self.right.quantities.len() {
            let components = self.of_quantity(other);
            if other == quantity || components.is_empty() {
                continue;
            }
            let reaches = match &candidate.alteration {
                Alteration::Rewrite(rewrite) => self.bench.reaches(&rewrite.home, self.name(other)),
                _ => true,
            };
            if !reaches {
                let right = components.iter().filter(|c| c.is_right());
                others += right.count();
                continue;
            }
            let places: Vec<usize> = (0..self.right.points.len().min(TRIAL_POINTS)).collect();
            let points = self.right.points[..places.len()].to_vec();
            let factor = found.factor;
            let name = self.name(other);
            let seen = self
                .bench
                .altered(Some(&candidate.alteration), name, |altered| {
                    Curve::new(altered.evaluation(), &points)
                        .at(factor)
                        .to_vec()
                });
            let Some(columns) = seen else { continue };
            let fitting = components
                .iter()
                .map(|component| sample(component, &places))
                .filter(|sample| sample.fits(&columns[sample.component]));
            others += fitting.count();
        }
        own + others
    }

    /// Those that explain most first; of these the smallest, then those nearest to a term.
    fn order(&self, matches: &mut [Match]) {
        let key = |found: &Match| {
            let size = self.size(found.candidate, found.factor);
            (usize::MAX - found.breadth, size)
        };
        matches.sort_by_key(key);
    }

    /// The best edit that explains a component at all points.
    fn single(
        &mut self,
        component: &Component<'a, 'm>,
        components: &[&Component<'a, 'm>],
        tried: &Tried,
    ) -> Option<Single> {
        let column = components
            .iter()
            .position(|other| other.place == component.place)?;
        let mut groups: Vec<&Match> = vec![];
        let mut best: Option<&Match> = None;
        let mut alternatives = vec![];
        for found in tried.matches.iter().filter(|found| found.fits[column]) {
            let is_same = |other: &&Match| {
                let place = component.place.component;
                is_same(&other.fresh[place], &found.fresh[place])
            };
            let is_known = groups.iter().any(is_same);
            if is_known {
                let is_best = best.as_ref().is_some_and(is_same);
                alternatives.extend(is_best.then(|| self.other_term(best, found)).flatten());
                continue;
            }
            let alteration = self.candidates[found.candidate].alteration.clone();
            if !self.fits_everywhere(component, &alteration, found.factor) {
                continue;
            }
            groups.push(found);
            if best.is_none() {
                best = Some(found);
            } else {
                let named = self.named(component.place.quantity, found.candidate, found.factor);
                alternatives.push(place_and_text(&named, &self.right.model.problem.file));
            }
        }
        let best = best?;
        let named = self.named(component.place.quantity, best.candidate, best.factor);
        Some(Single {
            is_far_fetched: cost(&self.candidates[best.candidate], best.factor) >= FAR_FETCHED,
            explained: Explained {
                cause: Cause::Edit(named),
                alternatives,
            },
        })
    }

    /// Another term with the same effect: no point tells them apart.
    fn other_term(&self, best: Option<&Match>, found: &Match) -> Option<String> {
        let best = best?;
        let [first, second] = [best, found].map(|found| &self.candidates[found.candidate]);
        let are_terms = first.change == EditKind::Term && second.change == EditKind::Term;
        if !are_terms {
            return None;
        }
        let named = self.named(0, found.candidate, found.factor);
        Some(format!("{} times {}", named.label?, found.factor))
    }

    fn of_whole(&self, component: &Component<'_, '_>) -> Option<Explained> {
        let cause = component
            .of_time()
            .or_else(|| component.of_exchange())
            .or_else(|| component.of_parameters())
            .or_else(|| component.of_terms())?;
        Some(Explained::plain(cause))
    }

    /// The two edits that come nearest.
    fn nearest(&self, quantity: usize, tried: &Tried) -> Vec<Nearest> {
        let mut near: Vec<&Near> = tried.near.iter().collect();
        near.sort_by(|a, b| a.left.total_cmp(&b.left));
        near.into_iter()
            .filter(|near| near.left < 1.0)
            .take(2)
            .map(|near| Nearest {
                named: self.named(quantity, near.candidate, near.factor),
                left: near.left,
            })
            .collect()
    }
}
