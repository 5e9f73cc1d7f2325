//! Random scenes by the thousand: every coefficient over its whole range, strongly graded meshes,
//! rough data, steps up to 10.
//!
//! Newton's method runs eight scenes in lanes.
//!
//! A step may be refused only because its operator is not definite. With
//! `‖V_x - W‖² + ‖W_x‖² >= B ‖V_x‖²`, where B is the buckling force, it is definite if
//! `B (ζ + dt/2) + m dt/2 > 0`, and the mean axial force m is never below β. So every scene with
//! `β > -B (1 + 2 ζ/dt)` must finish with an answer.
//!
//! ```toml
//! [random]
//! # of 256 scenes, with 1 to 32 elements; the scheme changes from batch to batch
//! batches = 64
//! steps = 20
//! seed = 1
//! ```

use super::{EnergyFile, beams::wild};
use crate::kinds::prelude::*;
use crate::{
    figures,
    kinds::runs::{
        Shown,
        cases::End,
        checks::energy_and_balance,
        watch::{CLOSED, Watched, Worst, watched},
    },
    run::RunError,
    scene::limits,
};
use convergence_study::{chart, left_out};
use thermobeam::{
    kirchhoff::BUCKLING,
    mesh::MeshError,
    one_step::Problem,
    parameters::Beam,
    scheme::{SCHEMES, Scheme},
};

/// Scenes in the lanes of one solver, all with the same number of elements.
const LANES: usize = 8;
/// Groups of lanes in a batch: one for each number of elements, from 1 on.
const GROUPS: usize = 32;
/// Scenes in a batch.
const BATCH: usize = LANES * GROUPS;
/// Exceptions shown in the table.
const LISTED: usize = 12;
/// Allowed share of exceptions.
const RARE: f64 = 2e-3;
/// Cells of the map along each axis.
const CELLS: usize = 14;
/// Powers of ten that the map spans: time steps, shortest elements.
const DT: [f64; 2] = [-6.0, 1.0];
const SHORTEST: [f64; 2] = [-4.0, 0.0];
/// Drawn instead of a zero residual on the logarithmic scale.
const ZERO: f64 = 1e-18;

/// A study of random scenes.
#[derive(Debug, Clone)]
pub struct RandomScenes {
    batches: usize,
    steps: usize,
    seed: u64,
}

/// Results of one batch, or of several together.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Batch {
    /// Numbers of scenes by the way they end, in the order of [`End::ALL`].
    pub ends: [usize; End::ALL.len()],
    /// Scenes refused although their operators are definite.
    pub refused: usize,
    /// Steps of all scenes.
    pub steps: usize,
    /// Levels that the solver accepted although a number is not finite.
    pub not_finite_levels: usize,
    /// Largest rise and residual of a step.
    pub worst: Worst,
    /// For each scene the time step and the shortest element, which determine its rounding errors
    /// most, and its largest residual in units of the energy.
    pub scenes: Vec<[f64; 3]>,
}

/// The table `[random]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RandomTable {
    /// batches of random scenes
    batches: Count<1, 100_000>,
    /// steps of each scene
    steps: Count<1, { limits::STEPS }>,
    /// of the random scenes
    seed: Count<0, { u32::MAX as usize }>,
}

impl FromFile for RandomScenes {
    type File = EnergyFile;

    fn from_file(file: EnergyFile, _: &Header, _: &Path) -> Result<Self, Refusal> {
        let RandomTable {
            batches,
            steps,
            seed,
        } = file
            .random
            .ok_or_else(|| Refusal::missing("random", "random scenes"))?;
        Ok(Self {
            batches: batches.get(),
            steps: steps.get(),
            seed: seed.get() as u64,
        })
    }
}

impl Kind for RandomScenes {
    /// Number of the batch.
    type Data = usize;
    type Found = Batch;

    fn cases(&self) -> Vec<Case<usize>> {
        // 16 elements on average; an observed step costs some 100 ns per element.
        let cost = (BATCH * self.steps * GROUPS / 2) as f64 * 4.0;
        let mut cases = vec![];
        for batch in 0..self.batches {
            let label = format!("scenes {} to {}", batch * BATCH, (batch + 1) * BATCH - 1);
            cases.push(Case::new(label, cost, batch));
        }
        cases
    }

    /// Runs the scenes in lanes, each to its end.
    fn run(&self, &number: &usize) -> Result<Batch, CaseFailure> {
        let mut batch = Batch::default();
        for group in 0..GROUPS {
            self.run_group(number, group, &mut batch)?;
        }
        Ok(batch)
    }

    fn not_finite(&self, _: &usize, batch: &Batch) -> Vec<String> {
        let named = batch.worst.named();
        Measured::not_finite(&named.map(|(name, value)| measured("", name, value)))
    }

    fn judge(&self, ran: &[Ran<usize, Batch>]) -> Outcome {
        Outcome::of_complete(self, ran, |shown| self.judge_complete(shown))
    }
}

impl RandomScenes {
    fn judge_complete(&self, shown: &[Shown<'_, Self>]) -> Outcome {
        let batches = shown.iter().map(|(_, batch)| *batch);
        let total = batches.fold(Batch::default(), Batch::with);
        let scenes = self.batches * BATCH;
        let listed = exceptions(shown);
        let exceptions = listed.len();
        let [answers, indefinite, others] = total.ended();
        let solved = format!("{answers} solved, {indefinite} refused (operator not definite)");
        let largest = if total.steps > 0 {
            format!("{:.1e} of the energy", total.worst.residual)
        } else {
            "unknown without a step".to_owned()
        };
        let mut headline = format!("{scenes} scenes: {solved}");
        if others > 0 {
            headline += &format!(", {others} other failures");
        }
        let steps = total.steps;
        let above = format!("residual at most {largest}, {exceptions} above {CLOSED:.0e}");
        let summary =
            format!("{scenes} scenes, {steps} steps: {solved}, {others} other failures; {above}");
        let counts = End::ALL.iter().zip(total.ends);
        let counts =
            counts.map(|((name, _), count)| measured(*name, "scenes", count as f64).fixed(0));
        let counts = Sheet::new("How the scenes ended", "end", counts);
        let mut claims = total.claims(scenes, exceptions);
        let closes = claims.iter().all(|claim| claim.holds() == Some(true));
        // On another machine, a scene at the limit of definiteness may fall on either side.
        claims.push(measured("", "answers", answers as f64).recorded("answers", 1e-3));
        let mut outcome = Outcome {
            headline: format!("{headline}; largest residual {largest}").into(),
            left_out: total.left_out().into_iter().collect(),
            figures: vec![residuals(&total.scenes, closes)],
            ..Outcome::new(summary, vec![], vec![])
        }
        .with_sheets([counts, Sheet::untabled(claims)]);
        outcome.tables.push(self.table(&listed));
        outcome
    }

    fn scheme(&self, batch: usize) -> Scheme {
        SCHEMES[batch % SCHEMES.len()]
    }

    /// Problem and time step of a scene.
    fn problem(&self, scene: usize) -> Result<(Problem, f64), MeshError> {
        let elements = scene % BATCH / LANES + 1;
        // Far from the seeds of other studies, which are small.
        wild(elements, (self.seed << 32) + scene as u64)
    }

    /// Runs scenes with `group + 1` elements each to their ends.
    fn run_group(&self, number: usize, group: usize, batch: &mut Batch) -> Result<(), CaseFailure> {
        let first = number * BATCH + group * LANES;
        let scenes: Vec<(Problem, f64)> = (first..first + LANES)
            .map(|scene| self.problem(scene))
            .collect::<Result<_, _>>()?;
        let dt: [f64; LANES] = std::array::from_fn(|k| scenes[k].1);
        let problems = scenes.iter().map(|(problem, _)| problem.clone()).collect();
        let runs = watched(
            problems,
            &dt,
            self.scheme(number),
            self.steps,
            |_, _, level| {
                batch.steps += 1;
                batch.not_finite_levels += usize::from(!is_finite(level));
            },
        )?;
        for (Watched { worst, failure }, (problem, dt)) in runs.iter().zip(&scenes) {
            batch.ends[End::of(failure.clone().map(RunError::Step).as_ref())? as usize] += 1;
            batch.refused += usize::from(failure.is_some() && is_definite(&problem.beam, *dt));
            batch.worst = batch.worst.max(*worst);
            batch.scenes.push([*dt, shortest(problem), worst.residual]);
        }
        Ok(())
    }

    /// The largest residuals, with the causes of rounding errors: dt, the axial stiffness, and
    /// short elements.
    fn table(&self, exceptions: &[(usize, f64)]) -> Table {
        let mut rows = vec![];
        for &(scene, residual) in exceptions.iter().take(LISTED) {
            let Ok((problem, dt)) = self.problem(scene) else {
                continue;
            };
            rows.push(vec![
                scene.to_string(),
                self.scheme(scene / BATCH).name.to_owned(),
                problem.mesh.elements().to_string(),
                format!("{:.1e}", shortest(&problem)),
                format!("{dt:.2e}"),
                format!("{:.1e}", problem.beam.beta),
                format!("{:.1e}", problem.beam.rho),
                problem.obstacles.map_or("none".to_owned(), |obstacles| {
                    format!("{:.1e}", obstacles.epsilon)
                }),
                format!("{residual:.1e}"),
            ]);
        }
        let head = [
            "scene", "scheme", "elements", "shortest", "dt", "beta", "rho", "epsilon", "residual",
        ];
        let title = "Largest residuals above 1e-12: long steps (Δu as large as u) over short elements (u/h cancels)";
        Table::new(title, head, rows)
    }
}

/// Scenes with a residual above 1e-12 of the energy, largest first: number in the study, and
/// residual.
fn exceptions(shown: &[Shown<'_, RandomScenes>]) -> Vec<(usize, f64)> {
    let mut above = vec![];
    for (batch, Batch { scenes, .. }) in shown {
        for (scene, &[.., residual]) in (*batch * BATCH..).zip(scenes) {
            if !(residual <= CLOSED) {
                above.push((scene, residual));
            }
        }
    }
    above.sort_by(|a, b| b.1.total_cmp(&a.1));
    above
}

fn shortest(problem: &Problem) -> f64 {
    problem.mesh.lengths().fold(f64::INFINITY, f64::min)
}

/// Whether the operator of every step is definite for any axial force.
fn is_definite(beam: &Beam, dt: f64) -> bool {
    beam.beta > -BUCKLING * (1.0 + 2.0 * beam.zeta / dt)
}

impl Batch {
    /// The scenes that are judged to their last step; the others are judged up to the step that
    /// fails.
    fn left_out(&self) -> Option<String> {
        let [answers, indefinite, others] = self.ended();
        let mut reasons = vec![None; answers];
        reasons.extend(vec![
            Some("refused, the operator is not definite");
            indefinite
        ]);
        reasons.extend(vec![Some("ended by another failure"); others]);
        left_out("scenes to their last step", reasons)
    }

    /// The sum of both.
    fn with(mut self, other: &Self) -> Self {
        self.ends
            .iter_mut()
            .zip(other.ends)
            .for_each(|(count, more)| *count += more);
        self.refused += other.refused;
        self.steps += other.steps;
        self.not_finite_levels += other.not_finite_levels;
        self.worst = self.worst.max(other.worst);
        self.scenes.extend(&other.scenes);
        self
    }

    /// Scenes with an answer, with an indefinite operator, and with another failure.
    fn ended(&self) -> [usize; 3] {
        [
            self.ends[End::Answer as usize],
            self.ends[End::Indefinite as usize],
            self.ends[End::IterationLimit as usize] + self.ends[End::NotFinite as usize],
        ]
    }

    /// Claims about all scenes together: each is solved with finite numbers, or refused with a
    /// stated reason, and refused only where its operator is not definite.
    fn claims(&self, scenes: usize, exceptions: usize) -> Vec<Measured> {
        let ended: usize = self.ends.iter().sum();
        let [_, _, others] = self.ended();
        let rare = exceptions as f64 / scenes as f64;
        let mut claims = vec![
            none_of("", "scenes without an end", scenes.abs_diff(ended)),
            none_of(
                "",
                "levels with a number that is not finite",
                self.not_finite_levels,
            ),
            none_of(
                "",
                "scenes refused although β > -B (1 + 2ζ/dt)",
                self.refused,
            ),
            none_of(
                "",
                "scenes refused for another reason than their operator",
                others,
            ),
        ];
        claims.extend(energy_and_balance(&self.worst, true));
        claims.push(
            measured(
                "",
                "share of the scenes with a residual above 1e-12 of the energy",
                rare,
            )
            .words(format!("{rare:.1e}, {exceptions} of {scenes} scenes"))
            .must_be(Must::AtMost(RARE)),
        );
        claims
    }
}

/// The largest residual in each cell of (dt, shortest element).
///
/// * `closes`: whether the study passes, which the title says.
fn residuals(scenes: &[[f64; 3]], closes: bool) -> Figure {
    // NaN in cells without a scene.
    let mut values = vec![f64::NAN; CELLS * CELLS];
    for &[dt, shortest, residual] in scenes {
        let (Some(column), Some(row)) = (index(DT, dt), index(SHORTEST, shortest)) else {
            continue;
        };
        let cell = &mut values[row * CELLS + column];
        let residual = max_or_nan(residual, ZERO);
        *cell = if cell.is_nan() {
            residual
        } else {
            max_or_nan(*cell, residual)
        };
    }
    let [across, up] = [centres(DT), centres(SHORTEST)];
    let places = up.iter().flat_map(|y| across.iter().map(move |x| [*x, *y]));
    let cells = places.zip(values).map(|([x, y], value)| [x, y, value]);
    let axes = [
        "time step dt",
        "shortest element (dimensionless)",
        "largest residual / energy",
    ];
    let cells: Vec<_> = cells.collect();
    let chart = figures::cells(&cells, axes.map(chart::Axis::log), "no scene");
    let title = "The balance of the energy closes to round-off";
    let caption = "Largest residual of the energy balance in a step of the random scenes, in units of the energy: round-off \
                   grows with the step and with short elements.";
    Figure::of("residuals", caption, chart.titled_where(closes, title))
}

/// The cell of a value along an axis.
fn index([low, high]: [f64; 2], value: f64) -> Option<usize> {
    let at = (value.log10() - low) / (high - low) * CELLS as f64;
    (at >= 0.0).then(|| (at as usize).min(CELLS - 1))
}

fn centres([low, high]: [f64; 2]) -> Vec<f64> {
    (0..CELLS)
        .map(|k| 10f64.powf(low + (high - low) * (k as f64 + 0.5) / CELLS as f64))
        .collect()
}
