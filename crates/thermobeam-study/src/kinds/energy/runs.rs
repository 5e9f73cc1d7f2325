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
//! random = 16                                   # beams with random coefficients and random smooth data
//! seed = 1
//! tolerance = 1e-12                             # of rise and residual, in units of the energy
//! ```
//!
//! ```toml
//! [[case]]
//! name = "long-steps"
//! claim = "..."                # in words
//! ends = "answer"              # or "indefinite", "iteration-limit", "not-finite": the failure
//! drift = 1e-10                # optional: bound of the sum of all residuals, in units of the energy
//! stability = true             # optional: every level keeps the bound of Corollary 3.2; needs theta_a = 0
//! # and the tables of a scene
//! [case.time]
//! dt = 10.0
//! t_end = 1000.0
//! ```

use thermobeam::energy::Energy;
use thermobeam::norms::slope_squared;

use super::{End, Worst, named_cases};
use crate::kinds::prelude::*;
use crate::kinds::runs::watch::{EnergyWatch, SOLVED, of_allowed};
use crate::kinds::tables::Layout;
use crate::scene;

/// Samples of a run, about.
const SAMPLES: usize = 400;

/// Steps from one computation of the energy's size to the next.
const SCALED: usize = 8;

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
pub struct Found {
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
    /// Largest left side of (3.12) over all levels, in units of its bound; where Corollary 3.2 is
    /// claimed.
    pub of_bound: Option<f64>,
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
    /// The energy.
    pub energy: f64,
    /// Largest residual of a step so far, in units of the initial energy.
    pub residual: f64,
    /// Sum of all residuals so far, in units of the energy.
    pub drift: f64,
}

impl FromFile for EnergyRuns {
    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let energy = root.section("energy")?;
        let runs = energy
            .as_ref()
            .map_or_else(|| cases(root), |section| listed(section, folder))?;
        Ok(Self {
            runs,
            histories: energy.is_some(),
        })
    }
}

/// The runs of `[energy]`: every scene, then every random beam, by each scheme in turn.
fn listed(section: &Section<'_>, folder: &Path) -> Result<Vec<EnergyRun>, InputError> {
    section.allow(&[
        "scenes",
        "schemes",
        "elements",
        "map",
        "dt",
        "steps",
        "random",
        "seed",
        "tolerance",
    ])?;
    let names = SCHEMES.map(|scheme| (scheme.name, scheme));
    let scheme = |item: &Field<'_>| item.choice(&names);
    let schemes = section.list("schemes", "a list of at least one scheme", scheme, |list| {
        !list.is_empty()
    })?;
    let count = |key: &str| {
        section
            .get(key)
            .map_or(Ok(0), |field| field.count(0..=usize::MAX))
    };
    let random = count("random")?;
    if let Some(field) = section.get("random") {
        limits::cases(&field, &[random, schemes.len()])?;
    }
    let seed = count("seed")? as u64;
    let field = section.require("elements", "a number of elements")?;
    let elements = tables::elements(&field)?;
    let mesh = tables::checked_mesh(
        Layout::read(section, &[elements], None)?.mesh(elements),
        &field,
    )?;
    let (dt, tolerance) = (section.positive("dt")?, section.positive("tolerance")?);
    let steps = section.count("steps", 1..=limits::STEPS)?;
    let scene = |item: &Field<'_>| {
        Ok(Scene {
            mesh: mesh.clone(),
            ..Scene::read(item.file(folder)?)?
        })
    };
    let scenes = section.list(
        "scenes",
        "a list of scene files beside this one",
        scene,
        |_| true,
    )?;
    let settings = Settings {
        stopping: Stopping::below(SOLVED),
        ..Settings::default()
    };
    let by_scheme = |name: String, is_scene: bool, problem: Problem| {
        schemes
            .iter()
            .enumerate()
            .map(move |(k, &scheme)| EnergyRun {
                name: format!("{name}, {}", scheme.name),
                // Random beams and further schemes would crowd the figures.
                is_drawn: k == 0 && is_scene,
                problem: problem.clone(),
                stepping: Stepping {
                    scheme,
                    settings,
                    dt,
                    loaded: false,
                },
                steps,
                claim: "the energy falls and its balance closes".to_owned(),
                end: End::Answer,
                share: Some(tolerance),
                drift: None,
                is_bounded: false,
            })
    };
    let of_scene = |scene: Scene| by_scheme(scene.name.clone(), true, simulate::problem(&scene));
    let smooth = |k: u64| {
        by_scheme(
            format!("random-{k}"),
            false,
            super::smooth(&mesh, seed.wrapping_add(k)),
        )
    };
    Ok(scenes
        .into_iter()
        .flat_map(of_scene)
        .chain((0..random as u64).flat_map(smooth))
        .collect())
}

/// The runs of `[[case]]`.
fn cases(root: &Section<'_>) -> Result<Vec<EnergyRun>, InputError> {
    let mut runs = named_cases(root, case)?;
    let bounded = runs.iter().any(|run| run.drift.is_some());
    // The drift of cases that claim a bound; of all where none does.
    runs.iter_mut()
        .for_each(|run| run.is_drawn = !run.is_bounded && (run.drift.is_some() || !bounded));
    Ok(runs)
}

fn case(section: &Section<'_>, name: String) -> Result<EnergyRun, InputError> {
    section.allow(
        &[
            &["name", "claim", "ends", "drift", "stability"],
            &scene::TABLES[..],
        ]
        .concat(),
    )?;
    let scene = Scene::from_tables(section, name.clone())?;
    let stepping = scene
        .one_step()
        .map_err(|error| section.refuse("time.scheme", "dg", error.to_string()))?;
    let newton = stepping.settings.solver == Solver::Newton;
    // The balance holds for the exact solution of a step only.
    let settings = if newton {
        Settings {
            stopping: Stopping::below(SOLVED),
            ..stepping.settings
        }
    } else {
        stepping.settings
    };
    let is_bounded = section
        .get("stability")
        .map_or(Ok(false), |field| field.boolean())?;
    if is_bounded && stability(&scene.beam, scene.obstacles.as_ref(), 1.0).is_none() {
        let allowed = "theta_a = 0, and rho > 0 or beta > -0.7116";
        return Err(section.refuse(
            "stability",
            "a beam for which Corollary 3.2 states nothing",
            allowed,
        ));
    }
    Ok(EnergyRun {
        name,
        is_bounded,
        claim: section.require("claim", "a text")?.text()?.to_owned(),
        end: section
            .require("ends", "\"answer\" or an error")?
            .choice(&End::ALL)?,
        drift: section
            .get("drift")
            .map(|field| field.positive())
            .transpose()?,
        share: None,
        stepping: Stepping {
            settings,
            ..stepping
        },
        steps: scene.steps(),
        is_drawn: false,
        problem: simulate::problem(&scene),
    })
}

impl Kind for EnergyRuns {
    /// Number of the run.
    type Data = usize;
    type Found = Found;

    fn cases(&self) -> Vec<Case<usize>> {
        // Observing a step costs three times its solution, and a step some 100 ns in addition to
        // its elements.
        let cost =
            |run: &EnergyRun| run.steps as f64 * (4.0 * run.problem.mesh.elements() as f64 + 4.0);
        let case = |(data, run): (usize, &EnergyRun)| Case::new(run.name.clone(), cost(run), data);
        self.runs.iter().enumerate().map(case).collect()
    }

    fn run(&self, index: &usize) -> Result<Found, CaseFailure> {
        self.runs[*index].run()
    }

    fn judge(&self, ran: &[Ran<usize, Found>]) -> Outcome {
        let found: Vec<(&EnergyRun, &Found)> = ran
            .iter()
            .filter_map(|ran| Some((&self.runs[ran.case.data], ran.ok()?)))
            .collect();
        let mut checks = vec![completion(ran, Found::not_finite)];
        checks.extend(found.iter().map(|(run, found)| run.check(found)));
        let holding = checks
            .iter()
            .skip(1)
            .filter(|check| check.verdict == Verdict::Pass)
            .count();
        let steps: usize = found.iter().map(|(_, found)| found.steps).sum();
        let Worst { residual, rise, .. } = found
            .iter()
            .fold(Worst::default(), |worst, (_, found)| worst.max(found.worst));
        let share = of_allowed(
            found
                .iter()
                .map(|(run, found)| run.share_of(found))
                .fold(0.0, max_or_nan),
        );
        let headline = if steps > 0 {
            format!(
                "largest residual {residual:.1e} of the energy, largest change in a step {rise:.1e}"
            )
        } else {
            "no step".to_owned()
        };
        let summary = format!(
            "{holding} of {} runs hold, {steps} steps: {headline}; at most {share}",
            self.runs.len()
        );
        let rows: Vec<_> = found
            .iter()
            .map(|(run, found)| (vec![run.name.clone()], run.readings(found)))
            .collect();
        let title = "Largest rise and residual of a step, and the sum of all residuals, in units of the energy";
        let left_out = |ran: &Ran<usize, Found>| match ran.ok() {
            None => Some(NO_RESULT),
            Some(found) => (found.steps == 0).then_some("without a step"),
        };
        Outcome {
            headline,
            coverage: vec![Coverage::of(
                "runs for the balance",
                ran.iter().map(left_out),
            )],
            tables: [readings::table(title, &["run"], &rows)]
                .into_iter()
                .chain(self.balance(&found))
                .collect(),
            figures: self.figures(&found),
            quantities: vec![Quantity::new("steps", steps as f64, 1e-9)],
            ..Outcome::new(summary, vec![], checks)
        }
    }
}

impl EnergyRun {
    /// Runs to the last step, or to the step that fails: the energy and its balance in every step.
    fn run(&self) -> Result<Found, CaseFailure> {
        let mut driver = Driver::new(self.problem.clone(), self.stepping)?;
        driver.refuse_loads("a study of the energy")?;
        let (simulation, level) = (driver.simulation(), driver.level());
        let mut watch = EnergyWatch::new(simulation.energy_scale(level));
        let energy = simulation.energy(level);
        let Energy {
            kinetic,
            shear,
            bending,
            thermal,
            kirchhoff,
            contact,
            lifting,
        } = energy;
        let initial_energy =
            kinetic + shear + bending + thermal + kirchhoff.abs() + contact + lifting.abs();
        let start = EnergyAt {
            step: 0,
            t: simulation.t(),
            energy: energy.total(),
            residual: 0.0,
            drift: 0.0,
        };
        let mut found = Found {
            initial_energy,
            samples: vec![start],
            ..Found::default()
        };
        let bound = self.bound(energy.total());
        let lengths = simulation.lengths().to_vec();
        let share = |level: &Level, energy: &Energy| {
            bound.map(|bound| self.size(&lengths, level, energy) / bound)
        };
        found.of_bound = share(level, &energy);
        let (every, mut residual) = (self.steps.div_ceil(SAMPLES), 0.0);
        let until = self.steps as f64 * self.stepping.dt;
        let ended = run_to(&mut driver, until, |driver, report| {
            let (simulation, old, new) = (driver.simulation(), driver.old_level(), driver.level());
            let step = simulation.step();
            found.steps = step;
            found.contact_steps += usize::from(new.contact_force != 0.0);
            found.most_iterations = report.iterations.max(found.most_iterations);
            // The scale only grows, so that leaving a level out makes the bounds stricter.
            let scale = if step % SCALED == 1 {
                simulation.energy_scale(new)
            } else {
                0.0
            };
            let balance = simulation.balance(old, new);
            watch.add(&balance, scale, || simulation.rounding(old, new));
            residual = max_or_nan(residual, balance.residual.abs() / initial_energy);
            if let Some(of_bound) = &mut found.of_bound {
                let reached = share(new, &simulation.energy(new)).unwrap_or(f64::NAN);
                *of_bound = max_or_nan(*of_bound, reached);
            }
            if step % every == 0 || step == self.steps {
                let (t, energy, drift) =
                    (simulation.t(), simulation.energy(new).total(), watch.drift);
                found.samples.push(EnergyAt {
                    step,
                    t,
                    energy,
                    residual,
                    drift,
                });
            }
        });
        found.end = End::of(ended.err().as_ref())?;
        Ok(Found {
            worst: watch.worst,
            drift: watch.drift,
            open_term: watch.open_term(),
            ..found
        })
    }

    /// The bound of (3.12), if Corollary 3.2 is claimed of the run.
    fn bound(&self, initial_energy: f64) -> Option<f64> {
        let Problem {
            beam, obstacles, ..
        } = &self.problem;
        if self.is_bounded {
            stability(beam, obstacles.as_ref(), initial_energy)
        } else {
            None
        }
    }

    /// The left side of (3.12): norms of a level, and its penetration.
    fn size(&self, lengths: &[f64], level: &Level, energy: &Energy) -> f64 {
        let penetration = self
            .problem
            .obstacles
            .map_or(0.0, |obstacles| 2.0 * obstacles.epsilon * energy.contact);
        let Energy {
            kinetic,
            shear,
            bending,
            thermal,
            ..
        } = energy;
        2.0 * (kinetic + shear + bending + thermal) + slope_squared(lengths, &level.u) + penetration
    }

    /// Largest rise or residual of a run in units of its bound.
    fn share_of(&self, Found { worst, .. }: &Found) -> f64 {
        match self.share {
            Some(tolerance) => max_or_nan(worst.residual, worst.rise) / tolerance,
            None => max_or_nan(worst.open, worst.risen),
        }
    }

    /// The end that is claimed, and the bounds of every step before; a run without a step has
    /// nothing to bound.
    fn check(&self, found: &Found) -> Check {
        let Found {
            end,
            steps,
            worst,
            drift,
            ..
        } = found;
        let ended = *end == self.end && (*end != End::Answer || *steps == self.steps);
        let share = self.share_of(found);
        let drifted = self.drift.is_none_or(|bound| drift.abs() <= bound);
        let mut evidence = format!("{} after {steps} steps", end.name());
        if *steps > 0 {
            let (rise, residual, allowed) = (worst.rise, worst.residual, of_allowed(share));
            evidence +=
                &format!("; rise {rise:.1e}, residual {residual:.1e} of the energy ({allowed})");
            evidence += &format!("; sum of all residuals {:.1e}", drift.abs());
        }
        let closes = *steps == 0 || share <= 1.0;
        if let (false, Some((term, left))) = (closes, found.open_term) {
            evidence += &format!("; in every step the residual is {left:.3} times {term}");
        }
        let mut is_bounded = true;
        if let Some(of_bound) = found.of_bound {
            evidence += &format!("; left side of (3.12) at most {of_bound:.3} of its bound");
            is_bounded = of_bound <= 1.0;
        }
        let holds = ended && closes && drifted && is_bounded;
        let subject = Subject::of("energy and balance")
            .in_case(&self.name)
            .by(ItemMethod::of_scheme(&self.stepping.scheme));
        Check::that(holds, self.claim.clone(), evidence).about(subject)
    }

    fn readings(&self, found: &Found) -> Vec<Reading> {
        let of_steps = |name: &str, value: f64| {
            Reading::new(name, (found.steps > 0).then_some(value)).scientific(1)
        };
        vec![
            Reading::text("elements", self.problem.mesh.elements().to_string()),
            Reading::text("dt", plain_text(self.stepping.dt)),
            Reading::text("steps", found.steps.to_string()),
            Reading::text("in contact", found.contact_steps.to_string()),
            Reading::text("end", found.end.name()),
            Reading::text("most iterations", found.most_iterations.to_string()),
            Reading::new("initial energy", found.initial_energy).scientific(4),
            of_steps("rise", found.worst.rise),
            of_steps("residual", found.worst.residual),
            of_steps("sum of residuals", found.drift.abs()),
        ]
        .into_iter()
        .chain(
            found
                .of_bound
                .map(|share| Reading::new("of the bound (3.12)", share).fixed(3)),
        )
        .collect()
    }

    /// The name without that of its scheme.
    fn scene(&self) -> &str {
        self.name.split(',').next().unwrap_or_default()
    }
}

impl Found {
    /// A run without a step has no rise.
    fn not_finite(&self) -> Vec<String> {
        let bound = self.of_bound.map(|share| ("left side of (3.12)", share));
        let numbers = [
            ("initial energy", self.initial_energy),
            ("sum of residuals", self.drift),
        ]
        .into_iter()
        .chain(bound);
        let named = self
            .worst
            .named()
            .into_iter()
            .filter(|(name, _)| self.steps > 0 || *name != "rise");
        not_finite(numbers.chain(named))
    }
}

/// The constant c of Corollary 3.2, by the energy E^0 at t = 0 (THEORY.md derives it); `None` where
/// nothing is stated.
fn stability(beam: &Beam, obstacles: Option<&Obstacles>, initial_energy: f64) -> Option<f64> {
    let Beam {
        beta, rho, theta_a, ..
    } = *beam;
    // Share of ½ (‖u_x - φ‖² + ‖φ_x‖²) that the term of the axial force leaves.
    let left = if rho > 0.0 {
        1.0
    } else {
        1.0 + beta.min(0.0) / BUCKLING
    };
    let constant = if rho > 0.0 && beta > 0.0 {
        beta * beta / (4.0 * rho)
    } else {
        0.0
    };
    let epsilon = obstacles.map_or(0.0, |obstacles| obstacles.epsilon);
    let largest = max_or_nan((1.0 + 1.0 / BUCKLING) / left, epsilon);
    (theta_a == 0.0 && left > 0.0).then_some(2.0 * largest * (initial_energy - constant))
}

impl EnergyRuns {
    fn figures(&self, found: &[(&EnergyRun, &Found)]) -> Vec<Figure> {
        let drawn: Vec<&(&EnergyRun, &Found)> =
            found.iter().filter(|(run, _)| run.is_drawn).collect();
        if drawn.is_empty() {
            return vec![];
        }
        let series = |point: fn(&Found, &EnergyAt) -> (f64, f64)| -> Vec<plots::Series> {
            let curve = |(run, found): &&(&EnergyRun, &Found)| {
                plots::Series::new(
                    run.scene(),
                    found.samples.iter().map(|sample| point(found, sample)),
                )
            };
            drawn.iter().map(curve).collect()
        };
        // A line for each bound of the drift that the runs drawn must keep.
        if !self.histories {
            let mut bounds: Vec<f64> = drawn.iter().filter_map(|(run, _)| run.drift).collect();
            bounds.sort_by(f64::total_cmp);
            bounds.dedup();
            let allowed = |value: f64| plots::Guide {
                label: "allowed".to_owned(),
                value,
            };
            let drifts = not_zero(series(|_, sample| (sample.step as f64, sample.drift.abs())));
            let drift = Xy {
                x: plots::Axis::linear("steps"),
                guides: bounds.into_iter().map(allowed).collect(),
                ..plots::history(plots::Axis::log("|sum of residuals| / energy"), &drifts)
            };
            let caption = "Sum of the signed residuals of the energy balance up to each step.";
            let title = "The residuals of the balance do not add up";
            return vec![Figure::new("drift", caption, drift.titled(title).draw())];
        }
        let looks = looks(drawn.iter().map(|(run, _)| run.scene()));
        let energies = series(|found, sample| (sample.t, sample.energy / found.initial_energy));
        let energy = plots::history(plots::Axis::linear("energy E / initial energy"), &energies)
            .with_looks(&looks)
            .titled("The energy never rises");
        let caption = "The energy, in units of its initial size: it never rises.";
        vec![Figure::new("energy", caption, energy.draw())]
    }

    /// The largest residual of the runs drawn: it is reached within a few steps, so that a curve
    /// shows no more.
    fn balance(&self, found: &[(&EnergyRun, &Found)]) -> Option<Table> {
        let row = |(run, found): &(&EnergyRun, &Found)| {
            vec![
                run.scene().to_owned(),
                format!("{:.1e}", found.worst.residual),
                run.share.map_or_else(String::new, plain_text),
            ]
        };
        let rows: Vec<Vec<String>> = found
            .iter()
            .filter(|(run, _)| run.is_drawn)
            .map(row)
            .collect();
        let title = "Largest residual of the energy balance in a step, over the initial energy";
        let head = ["scene", "residual", "allowed"];
        (self.histories && !rows.is_empty()).then(|| Table::new(title, head, rows))
    }
}

/// Without values of exactly zero, such as that of the start: they have no place on a logarithmic
/// axis.
fn not_zero(mut series: Vec<plots::Series>) -> Vec<plots::Series> {
    series
        .iter_mut()
        .for_each(|series| series.points.retain(|(_, value)| *value != 0.0));
    series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beam_with_loads_is_refused() {
        let text = "[initial]\nu_t = \"x\"\n[mesh]\nelements = 4\n[time]\ndt = 0.1\nt_end = 1.0\n";
        let scene = Scene::parse(text, "s.toml").expect("a scene");
        let stepping = scene.one_step().expect("a one-step scheme");
        let run = |loaded: bool| EnergyRun {
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
        assert!(run(false).run().is_ok());
        let refused = run(true).run().expect_err("a refusal");
        assert!(
            refused
                .reason
                .starts_with("a study of the energy: found a beam with loads"),
            "{refused:?}"
        );
    }
}
