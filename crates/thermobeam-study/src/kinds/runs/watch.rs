//! The energy over the steps of a run: its largest rise, and the largest residual of its balance.

use std::ops::ControlFlow;

use thermobeam::{
    energy::{Balance, Rounding},
    error::StepError,
    one_step::Problem,
    scheme::Scheme,
    solve::{Settings, Stopping, TimeLevel},
};

use crate::kinds::prelude::*;
use crate::run::together::EnsembleDriver;
use convergence_judge::text::number::short_text;

/// Increment at which a step counts as solved: only the exact solution of a step satisfies the
/// balance.
pub(crate) const SOLVED: f64 = 1e-14;

/// Share of the energy within which the balance of a step closes, unless rounding errors explain
/// more.
pub(crate) const CLOSED: f64 = 1e-12;

/// Largest rise of the energy and largest residual of its balance, over the steps of one run or of
/// several; NaN stays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Residual of a step, in units of the energy's size.
    pub residual: f64,
    /// Change of the energy in a step, in the same units; negative if it falls in every step, -∞
    /// without steps.
    pub rise: f64,
    /// Residual in units of its bound: at most 1 if every balance closes.
    pub open: f64,
    /// Rise in units of its bound: at most 1 if the energy never rises.
    pub risen: f64,
}

impl Default for Worst {
    /// The values before the first step.
    fn default() -> Self {
        Self {
            residual: 0.0,
            rise: f64::NEG_INFINITY,
            open: 0.0,
            risen: 0.0,
        }
    }
}

impl Worst {
    /// The worse of the two in each number.
    pub fn max(self, other: Self) -> Self {
        Self {
            residual: max_or_nan(self.residual, other.residual),
            rise: max_or_nan(self.rise, other.rise),
            open: max_or_nan(self.open, other.open),
            risen: max_or_nan(self.risen, other.risen),
        }
    }

    /// The numbers and their names.
    pub(crate) fn named(&self) -> [(&'static str, f64); 4] {
        let Self {
            residual,
            rise,
            open,
            risen,
        } = *self;
        [
            ("residual", residual),
            ("rise", rise),
            ("residual over its bound", open),
            ("rise over its bound", risen),
        ]
    }
}

/// A fraction of the allowed value, in words.
pub(crate) fn of_allowed(share: f64) -> String {
    if share > 1.0 {
        return format!("{} times what is allowed", short_text(share));
    }
    let share = if share < 0.01 && share > 0.0 {
        format!("{share:.0e}")
    } else {
        format!("{share:.2}")
    };
    format!("{share} of what is allowed")
}

/// What a run has recorded so far; NaN stays.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EnergyWatch {
    /// The largest size of the energy.
    scale: f64,
    pub(crate) worst: Worst,
    /// Sum of all residuals, with their signs, in units of the energy.
    pub(crate) drift: f64,
    /// Largest term of the balance of a step, in units of the energy.
    pub(crate) largest_term: f64,
    /// Over the steps Σ r², and for each of [`TERMS`] Σ r T and Σ T².
    squares: f64,
    products: [[f64; 2]; TERMS.len()],
}

/// Terms of the balance.
const TERMS: [&str; 5] = [
    "the change of the energy",
    "the viscous loss",
    "the heat flow",
    "the jumps of the velocities",
    "the contact's gap",
];

/// Cosine between the residuals and a term's values from which on the term is named.
const ALIKE: f64 = 0.99;

impl EnergyWatch {
    /// Starts from a level whose energy has the given size.
    pub(crate) fn new(scale: f64) -> Self {
        Self {
            scale,
            worst: Worst::default(),
            drift: 0.0,
            largest_term: 0.0,
            squares: 0.0,
            products: [[0.0; 2]; TERMS.len()],
        }
    }

    /// The unit of energies: the largest size so far.
    pub(crate) fn unit(&self) -> f64 {
        max_or_nan(self.scale, f64::MIN_POSITIVE)
    }

    /// Adds a step; `rounding` is evaluated only if needed.
    pub(crate) fn add(
        &mut self,
        balance: &Balance,
        scale: f64,
        rounding: impl FnOnce() -> Rounding,
    ) {
        self.scale = max_or_nan(self.scale, scale);
        let scale = self.unit();
        let (residual, change) = (balance.residual.abs(), balance.change);
        let bound = CLOSED * scale;
        let mut step = Worst {
            residual: residual / scale,
            rise: change / scale,
            open: residual / bound,
            ..Worst::default()
        };
        self.drift += balance.residual / scale;
        self.squares += balance.residual * balance.residual;
        let terms = [
            balance.change,
            balance.viscous,
            balance.thermal,
            balance.inertial,
            balance.contact,
        ];
        for ([product, square], term) in self.products.iter_mut().zip(terms) {
            *product += balance.residual * term;
            *square += term * term;
            self.largest_term = max_or_nan(self.largest_term, term.abs() / scale);
        }
        if !(residual <= bound && change <= 0.0) {
            let rounding = rounding().total();
            if !(residual <= bound) {
                step.open = residual / max_or_nan(rounding, bound);
            }
            step.risen = change / max_or_nan(rounding, f64::MIN_POSITIVE);
        }
        self.worst = self.worst.max(step);
    }

    /// The term that does not close, and the factor of it that is left over; `None` where no term
    /// explains the residuals.
    ///
    /// A term T with a wrong factor 1 + c leaves r = c T in every step: the cosine of the angle
    /// between r and T is then 1, and c = Σ r T / Σ T².
    pub(crate) fn open_term(&self) -> Option<(&'static str, f64)> {
        let mut candidates = vec![];
        for (term, [product, square]) in TERMS.into_iter().zip(self.products) {
            let cosine = (product / (self.squares * square).sqrt()).abs();
            if cosine > ALIKE {
                candidates.push((cosine, term, product / square));
            }
        }
        let most = candidates
            .into_iter()
            .max_by(|(one, ..), (next, ..)| one.total_cmp(next));
        most.map(|(_, term, factor)| (term, factor))
    }
}

/// The results of a problem that was run in a group.
pub(crate) struct Watched {
    /// Rise of the energy and residual of its balance, over the completed steps.
    pub(crate) worst: Worst,
    /// Why it ended early, if it did.
    pub(crate) failure: Option<StepError>,
}

/// Runs problems with the same number of elements in lanes by Newton's method, each to its last or
/// failing step.
///
/// * `see`: receives each completed step: index of the problem, iterations of the step, and the new
///   level.
pub(crate) fn watched(
    problems: Vec<Problem>,
    dts: &[f64],
    scheme: Scheme,
    steps: usize,
    mut see: impl FnMut(usize, usize, &TimeLevel),
) -> Result<Vec<Watched>, CaseFailure> {
    let settings = Settings {
        stopping: Stopping::below(SOLVED),
        ..Settings::default()
    };
    let mut new = TimeLevel::new(
        problems
            .first()
            .map_or(0, |problem| problem.mesh.nodes().len()),
    );
    let mut driver = EnsembleDriver::new(problems, dts, scheme, settings)?;
    let mut watches = vec![];
    let mut old_levels = vec![];
    for k in 0..dts.len() {
        let mut level = new.clone();
        driver.ensemble().observe(k, &mut level);
        let scale = driver.ensemble().cases()[k].energy_scale(&level);
        watches.push(EnergyWatch::new(scale));
        old_levels.push(level);
    }
    driver.run(steps, |ensemble, balances| {
        for (k, balance) in balances.iter().enumerate() {
            let Ok(report) = ensemble.report(k) else {
                continue;
            };
            ensemble.observe(k, &mut new);
            see(k, report.iterations, &new);
            let case = &ensemble.cases()[k];
            let old = &mut old_levels[k];
            watches[k].add(balance, case.energy_scale(&new), || {
                case.rounding(old, &new)
            });
            std::mem::swap(old, &mut new);
        }
        ControlFlow::Continue(())
    })?;
    let mut results = vec![];
    for (k, watch) in watches.iter().enumerate() {
        results.push(Watched {
            worst: watch.worst,
            failure: driver.ensemble().report(k).err(),
        });
    }
    Ok(results)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_term_with_a_wrong_factor_is_named_with_what_it_leaves() {
        let open_term = |residual: fn(&Balance) -> f64| {
            let mut watch = EnergyWatch::new(1.0);
            for k in 1..20 {
                let (viscous, thermal) = (0.5_f64.powi(k), 0.8_f64.powi(k));
                let (inertial, contact) = (f64::from(k % 3), f64::from(k % 2));
                let change = -viscous - thermal;
                let balance = Balance {
                    change,
                    viscous,
                    thermal,
                    inertial,
                    contact,
                    load: 0.0,
                    residual: 0.0,
                };
                let balance = Balance {
                    residual: residual(&balance),
                    ..balance
                };
                watch.add(&balance, 1.0, || Rounding {
                    residual: 0.0,
                    contact: 0.0,
                });
            }
            watch.open_term()
        };
        let (term, left) = open_term(|balance| -0.5 * balance.viscous).expect("a term");
        assert!(
            term == "the viscous loss" && (left + 0.5).abs() < 1e-12,
            "{term} {left}"
        );
        assert_eq!(
            open_term(|balance| 0.25 * balance.thermal).map(|(term, _)| term),
            Some("the heat flow")
        );
        assert_eq!(
            open_term(|balance| balance.inertial - balance.contact),
            None
        );
        assert_eq!(open_term(|_| 0.0), None);
    }
}
