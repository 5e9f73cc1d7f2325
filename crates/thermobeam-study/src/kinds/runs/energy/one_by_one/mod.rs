//! Scenes run one by one, of the table `[energy]` or of `[[case]]`.
//!
//! ```toml
//! [energy]
//! scenes = ["scenes/paper-1-beta-0.toml"]       # files beside this one
//! schemes = ["euler-crank-nicolson", "midpoint"]
//! elements = 50                                 # of the mesh, graded or uniform as below
//! map = "s"                                     # optional
//! dt = 1e-3
//! steps = 1000
//! random = 16                                   # beams with random coefficients and smooth data
//! seed = 1
//! tolerance = 1e-12                             # of rise and residual, in units of the energy
//! ```
//!
//! ```toml
//! [[case]]
//! name = "long-steps"
//! claim = "..."                # in words
//! ends = "answer"              # or "indefinite", "iteration-limit", "not-finite": the failure;
//!                              # or "unbalanced": every step is done, and one opens the balance
//! # optional: bound of the sum of all residuals, in units of the energy
//! drift = 1e-10
//! # optional: every level keeps the bound of Corollary 3.2, and all losses that of (2.9)
//! stability = true
//! # and the tables of a scene
//! [case.time]
//! dt = 10.0
//! t_end = 1000.0
//! ```

mod drawn;
pub(super) mod listed;
mod recorder;

use super::EnergyFile;
use recorder::Recorder;

use crate::kinds::prelude::*;
use crate::scene::parts::is_uniform;
use crate::{
    kinds::runs::{
        Shown,
        cases::{End, named_cases},
        checks::{Condition, all, at_most, ended},
        in_words,
        watch::{CLOSED, Worst, of_allowed},
        with_table_of_runs,
    },
    run::{ObservableMotion, driver::Driver, run_to},
};
use convergence_judge::text::number::plain_text;
use convergence_study::left_out;
use thermobeam::one_step::{Problem, Stepping};

/// A study of this kind.
#[derive(Clone)]
pub struct EnergyRuns {
    runs: Vec<EnergyRun>,
    /// Whether the figures show energy and residual over time; else they show the sum of the
    /// residuals over the steps.
    histories: bool,
}

/// A run, and what is claimed of it.
#[derive(Clone)]
struct EnergyRun {
    name: String,
    /// The scene's, or a beam with random coefficients and smooth random data.
    problem: Problem,
    stepping: Stepping,
    steps: usize,
    /// In words.
    claim: String,
    end: End,
    /// Bound of rise and residual in a step, as a share of the energy; else 1e-12 of it, or the
    /// bound on the rounding errors of the step.
    share: Option<f64>,
    /// Bound of the sum of all residuals, in units of the energy.
    drift: Option<f64>,
    /// Whether every level must keep the bound of Corollary 3.2.
    is_bounded: bool,
    is_drawn: bool,
}

/// What a run finds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EnergyHistory {
    /// How it ended.
    pub end: End,
    /// Steps done.
    pub steps: usize,
    /// Steps that ended in contact.
    pub contact_steps: usize,
    /// Most iterations in a step.
    pub most_iterations: usize,
    /// Size of the energy at t = 0: its terms without their signs.
    pub initial_energy: f64,
    /// Largest rise and residual of a step.
    pub worst: Worst,
    /// Sum of all residuals with their signs, in units of the energy.
    pub drift: f64,
    /// The larger of two numbers in units of the energy: the largest term of the balance of a step,
    /// and the largest distance of the kinetic energy from that at t = 0, which is kept in turn
    /// where nothing dissipates.
    pub moved: f64,
    /// Largest left side of (3.12) over all levels, in units of its bound; where Corollary 3.2 is
    /// claimed.
    pub of_bound: Option<f64>,
    /// Viscous and thermal losses of all steps, in units of the energy that is available for them;
    /// where Corollary 3.2 is claimed.
    pub lost: Option<f64>,
    /// The term of the balance that does not close, and the factor of it that is left over.
    pub open_term: Option<(&'static str, f64)>,
    /// Samples for the figures.
    pub samples: Vec<EnergyAt>,
}

/// A run after a number of steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyAt {
    /// Number of the step.
    pub step: usize,
    /// Its time.
    pub t: f64,
    /// The largest change of the energy in a step since the sample before, in units of the initial
    /// energy: it is negative. NaN at the start.
    pub change: f64,
    /// Sum of all residuals so far, in units of the energy.
    pub drift: f64,
}

impl EnergyHistory {
    /// A number of the completed steps, of which there may be none.
    fn of_steps(&self, name: &str, value: f64) -> Measured {
        measured("", name, (self.steps > 0).then_some(value))
    }
}

impl FromFile for EnergyRuns {
    type File = EnergyFile;

    fn from_file(file: EnergyFile, _: &Header, folder: &Path) -> Result<Self, Refusal> {
        if let Some(energy) = file.energy {
            let runs = energy.runs(folder).map_err(Refusal::within("energy"))?;
            let histories = true;
            return Ok(Self { runs, histories });
        }
        let cases = file.case.unwrap_or_default();
        let mut runs = named_cases(cases, listed::CaseTable::run, |run| &run.name)?;
        let is_claimed = runs.iter().any(|run| run.drift.is_some());
        // The drift of cases that claim a bound; of all where none does.
        for run in &mut runs {
            run.is_drawn = !run.is_bounded && (run.drift.is_some() || !is_claimed);
        }
        Ok(Self {
            runs,
            histories: false,
        })
    }

    fn named_files(file: &EnergyFile) -> Vec<&str> {
        let scenes = file.energy.iter().flat_map(listed::EnergyTable::scenes);
        scenes.map(String::as_str).collect()
    }
}

impl Kind for EnergyRuns {
    /// Number of the run.
    type Data = usize;
    type Found = EnergyHistory;

    fn cases(&self) -> Vec<Case<usize>> {
        let mut runs = vec![];
        for (place, run) in self.runs.iter().enumerate() {
            // Observing a step costs three times its solution, and a step some 100 ns in addition
            // to its elements.
            let cost = run.steps as f64 * (4.0 * run.problem.mesh.elements() as f64 + 4.0);
            let (problem, by) = (&run.problem, &run.stepping);
            let parts = Parts::new(&problem.beam, problem.obstacles.as_ref())
                .on(is_uniform(problem.mesh.nodes()))
                .by(by.scheme, by.settings.solver);
            runs.push(Case::new(run.name.clone(), cost, place).described(&parts));
        }
        runs
    }

    /// Runs to the last step, or to the step that fails: the energy and its balance in every step.
    fn run(&self, place: &usize) -> Result<EnergyHistory, CaseFailure> {
        let run = &self.runs[*place];
        let mut driver = Driver::new(run.problem.clone(), run.stepping)?;
        driver.refuse_loads("a study of the energy")?;
        let mut recorder = Recorder::new(run, &driver);
        let until = run.steps as f64 * run.stepping.dt;
        let stepped = run_to(&mut driver, until, |driver, report| {
            recorder.add(driver, report.iterations);
        });
        let Recorder { watch, found, .. } = recorder;
        Ok(EnergyHistory {
            end: End::of(stepped.err().as_ref())?,
            worst: watch.worst,
            drift: watch.drift,
            moved: max_or_nan(found.moved, watch.largest_term),
            open_term: watch.open_term(),
            ..found
        })
    }

    fn judge(&self, ran: &[Ran<usize, EnergyHistory>]) -> Outcome {
        let outcome = Outcome::of_complete(self, ran, |shown| self.judge_complete(shown));
        let title = "Largest rise and residual of a step, and the sum of all residuals, in units of the energy";
        with_table_of_runs(outcome, ran, [title, "run"], |place, found| {
            self.numbers(*place, found)
        })
    }
}

impl EnergyRuns {
    /// A run without a step has no residuals.
    fn numbers(&self, place: usize, found: &EnergyHistory) -> Vec<Measured> {
        let run = &self.runs[place];
        let mut numbers = vec![
            in_words("elements", run.problem.mesh.elements()),
            in_words("dt", plain_text(run.stepping.dt)),
            in_words("steps", found.steps),
            in_words("in contact", found.contact_steps),
            in_words("end", found.end.name()),
            in_words("most iterations", found.most_iterations),
            measured("", "initial energy", found.initial_energy).scientific(4),
            found.of_steps("rise", found.worst.rise).scientific(1),
            found
                .of_steps("residual", found.worst.residual)
                .scientific(1),
            found
                .of_steps("sum of residuals", found.drift.abs())
                .scientific(1),
            found
                .of_steps("rise over its bound", found.worst.risen)
                .hidden(),
            found
                .of_steps("residual over its bound", found.worst.open)
                .hidden(),
        ];
        if let Some(share) = found.of_bound {
            numbers.push(measured("", "of the bound (3.12)", share).fixed(3));
        }
        if let Some(lost) = found.lost {
            numbers.push(measured("", "lost of the energy (2.9)", lost).fixed(3));
        }
        numbers
    }

    fn judge_complete(&self, shown: &[Shown<'_, Self>]) -> Outcome {
        let runs: Vec<(&EnergyRun, &EnergyHistory)> = shown
            .iter()
            .map(|&(place, found)| (&self.runs[*place], found))
            .collect();
        let mut numbers = vec![];
        let mut worst = Worst::default();
        let [mut steps, mut balanced] = [0, 0];
        let mut share = 0.0;
        for (run, found) in &runs {
            numbers.push(run.claim(found));
            steps += found.steps;
            if run.end != End::Unbalanced {
                balanced += found.steps;
                worst = worst.max(found.worst);
                share = max_or_nan(share, run.share_of(found));
            }
        }
        let holding = numbers.iter();
        let holding = holding.filter(|claim| claim.holds() == Some(true)).count();
        let headline = match (steps, balanced) {
            (0, _) => "no step".to_owned(),
            (_, 0) => "no step whose balance is to close".to_owned(),
            _ => format!(
                "largest residual {:.1e} of the energy, largest change in a step {:.1e}",
                worst.residual, worst.rise
            ),
        };
        let drawn: Vec<_> = runs.into_iter().filter(|(run, _)| run.is_drawn).collect();
        let summary = format!(
            "{holding} of {} runs hold, {steps} steps: {headline}; at most {}",
            self.runs.len(),
            of_allowed(share)
        );
        numbers.push(measured("", "steps", steps as f64).recorded("steps", 1e-9));
        let without = shown
            .iter()
            .map(|(_, found)| (found.steps == 0).then_some("without a step"));
        Outcome {
            headline: headline.into(),
            left_out: left_out("runs for the balance", without)
                .into_iter()
                .collect(),
            figures: self.figure(&drawn).into_iter().collect(),
            ..Outcome::new(summary, vec![], vec![]).with_sheets([Sheet::untabled(numbers)])
        }
    }
}

impl EnergyRun {
    /// Largest rise or residual of a run in units of its bound.
    fn share_of(&self, EnergyHistory { worst, .. }: &EnergyHistory) -> f64 {
        match self.share {
            Some(tolerance) => max_or_nan(worst.residual, worst.rise) / tolerance,
            None => max_or_nan(worst.open, worst.risen),
        }
    }

    /// The end that is claimed, and the bounds of every step before.
    fn claim(&self, found: &EnergyHistory) -> Measured {
        let all_steps = self.end != End::Answer || found.steps == self.steps;
        let bound = match found.of_bound {
            Some(share) => {
                let evidence = format!("left side of (3.12) at most {share:.3} of its bound");
                at_most(share, 1.0, evidence)
            }
            None => Condition::or(!self.is_bounded, "the bound of (3.12) is not known"),
        };
        let lost = match found.lost {
            Some(lost) => {
                let evidence = format!("losses at most {lost:.3} of the energy, (2.9)");
                at_most(lost, 1.0, evidence)
            }
            None => Condition::or(!self.is_bounded, "the losses are not known"),
        };
        let of = "energy and balance";
        if self.end == End::Unbalanced {
            let open = found.worst.open;
            let open = Condition::that(open > 1.0, of_allowed(open));
            let end = ended(found.end, End::Answer, found.steps);
            return all(&self.name, of, &self.claim, [end, open]);
        }
        all(
            &self.name,
            of,
            &self.claim,
            [
                ended(found.end, self.end, found.steps),
                Condition::or(all_steps, "a step is missing"),
                self.closes(found),
                self.moves(found),
                self.drifts(found),
                bound,
                lost,
            ],
        )
    }

    /// No step opens the balance; a run without a step has nothing to bound.
    fn closes(&self, found: &EnergyHistory) -> Condition {
        if found.steps == 0 {
            return Condition::that(true, "");
        }
        let Worst { rise, residual, .. } = found.worst;
        let share = self.share_of(found);
        let allowed = of_allowed(share);
        let mut evidence =
            format!("rise {rise:.1e}, residual {residual:.1e} of the energy ({allowed})");
        if let (false, Some((term, left))) = (share <= 1.0, found.open_term) {
            evidence += &format!("; in every step the residual is {left:.3} times {term}");
        }
        at_most(share, 1.0, evidence)
    }

    /// More moves than the residual may be: of a beam at rest each scheme would close the balance.
    fn moves(&self, found: &EnergyHistory) -> Condition {
        let allowed = self.share.unwrap_or(CLOSED);
        let moved = found.moved;
        let complaint = format!(
            "nothing moves by more than {moved:.1e} of the energy: a residual of {allowed:.0e}, which is \
             allowed, would hide each mistake"
        );
        Condition::or(found.steps == 0 || moved > 10.0 * allowed, &complaint)
    }

    /// The residuals of all steps do not add up, where that is claimed.
    fn drifts(&self, found: &EnergyHistory) -> Condition {
        let drift = found.drift.abs();
        let evidence = if found.steps > 0 {
            format!("sum of all residuals {drift:.1e}")
        } else {
            String::new()
        };
        Condition::that(self.drift.is_none_or(|bound| drift <= bound), evidence)
    }

    /// The name without that of its scheme.
    fn scene(&self) -> &str {
        self.name.split(',').next().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{run::simulate, scene::Scene};

    #[test]
    fn a_beam_with_loads_is_refused() {
        let text = "[initial]\nu_t = \"x\"\n[mesh]\nelements = 4\n[time]\ndt = 0.1\nt_end = 1.0\n";
        let scene = Scene::parse(text, "s.toml").expect("a scene");
        let stepping = scene.one_step().expect("a one-step scheme");
        let result = |loaded: bool| {
            let run = EnergyRun {
                name: "s".to_owned(),
                problem: simulate::problem(&scene),
                stepping: Stepping { loaded, ..stepping },
                steps: 10,
                claim: String::new(),
                end: End::default(),
                share: None,
                drift: None,
                is_bounded: false,
                is_drawn: false,
            };
            let study = EnergyRuns {
                runs: vec![run],
                histories: false,
            };
            study.run(&0)
        };
        assert!(result(false).is_ok());
        let refused = result(true).expect_err("a refusal");
        assert!(
            refused
                .reason
                .starts_with("a study of the energy: found a beam with loads"),
            "{refused:?}"
        );
    }
}
