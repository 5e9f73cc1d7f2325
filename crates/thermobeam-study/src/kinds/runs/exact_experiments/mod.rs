//! The experiments of Section 5 by the scheme of any order: values to ten decimals, and the error
//! of the paper's own scheme.
//!
//! Two different discretisations (degree, elements, degree in time, steps) of one scene must agree.
//! What they agree on is then the reference for the scene's own scheme at its own resolution, over
//! the whole time.
//!
//! ```toml
//! [experiments]
//! scenes = ["scenes/paper-1-beta-0.toml"]   # one-step scenes; their own scheme is compared
//! times = [1.0, 10.0]
//! agreement = 1e-10                         # of the two discretisations, in every number
//! compare = true                            # run the scenes' own schemes as well
//!
//! [[discretisations]]                       # two of them
//! elements = 1
//! degree = 20
//! time_degree = 3
//! dt = 0.02
//! restart_dt = 5e-4
//! growth = 1.5
//! ```

mod judge;

use thermobeam::dg::ContactEvent;

use super::{Findings, Listing, Results, RunStudy, Runs};
use crate::kinds::prelude::*;
use crate::{
    figures,
    kinds::{
        settings::{CONTACT, Exercise, Integration},
        tables::{DISCRETISATIONS, Discretisation, discretisations},
    },
    run::{
        Sample,
        simulate::{Recording, Simulator},
    },
    scene::Scene,
};
use convergence_study::{
    Coverage,
    internal::chart::{self, Chart, Guide},
};
use judge::{OfScene, events};

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/exact-experiments",
    keys: ExactExperiments::KEYS,
    schema: None,
    read: read_study::<RunStudy<ExactExperiments>>,
    why: "Elements of high degree and dG(q), with contact located to round-off, converge so fast that some hundred steps give ten \
          digits. Two discretisations that share neither mesh nor degrees nor steps make different errors.",
    judged: "Both must agree at each time listed within the tolerance, in the state of the free end and the energy, and on every \
             contact event. The energy must fall, its balance close to round-off.",
    failure: "One of the two is not resolved: raise the degrees or lower the steps of both and see which one moves.",
};

/// Times at which the free end is compared over the whole time.
const TIP_TIMES: usize = 1000;

/// What a run shows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ShownStates {
    /// States at the times listed.
    pub states: Vec<Sample>,
    /// Contact events; none by the scene's own scheme, which does not locate them.
    pub events: Vec<ContactEvent>,
    /// `(t, u(1, t))` at equally spaced times.
    pub tip: Vec<(f64, f64)>,
    /// Steps.
    pub steps: usize,
    /// Largest residual of the balance over E0, and largest change of the energy in a step.
    pub balance: [f64; 2],
}

/// A study of experiments.
pub struct ExactExperiments {
    scenes: Vec<Scene>,
    times: Vec<f64>,
    discretisations: [Discretisation; 2],
    agreement: f64,
    /// Whether the scenes' own schemes are run and compared.
    compare: bool,
}

/// A scene, and how it is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SceneRun {
    /// The place of the scene.
    pub scene: usize,
    /// The number of the discretisation; `None`: the scene's own scheme, mesh and steps.
    pub by: Option<usize>,
}

const EXPERIMENTS: Keys = &[&[
    Key::new(
        "scenes",
        Form::List(&Form::Text),
        "scene files, relative to this file",
    ),
    Key::new(
        "times",
        Form::List(&Form::Positive),
        "times of comparison, increasing",
    ),
    Key::new(
        "agreement",
        Form::Positive,
        "distance allowed between both discretisations",
    ),
    Key::new(
        "compare",
        Form::Boolean,
        "the scenes' own schemes are compared with them",
    )
    .or("false"),
]];

impl Runs for ExactExperiments {
    const KEYS: &'static [Keys] = &[&[&[
        Key::new("experiments", Form::Table(&[EXPERIMENTS]), "the scenes"),
        DISCRETISATIONS,
    ]]];

    type Run = SceneRun;
    type Shown = ShownStates;

    fn from_document(root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        let section = root.table("experiments", EXPERIMENTS)?;
        let scene = |item: &Field<'_>| Scene::read_one_step(item, folder);
        let allowed = "a list of at least one scene file";
        let scenes = section.list("scenes", allowed, scene, |list| !list.is_empty())?;
        let end = scenes
            .iter()
            .map(|scene| scene.t_end)
            .fold(f64::INFINITY, f64::min);
        let allowed = format!(
            "a list of increasing times > 0, the last at most {end:?}, where the first scene ends"
        );
        let fits = |times: &[f64]| {
            increases(times)
                && times.first().is_some_and(|t| *t > 0.0)
                && times.last().is_some_and(|t| *t <= end)
        };
        let times = section.list("times", &allowed, Field::number, fits)?;
        let agreement = section.positive("agreement")?;
        let compare = section
            .get("compare")
            .map_or(Ok(false), |field| field.boolean())?;
        if compare {
            comparable(&section, &scenes, &times)?;
        }
        let t_end = times.last().copied().unwrap_or_default();
        let discretisations = discretisations(root, "discretisations", None, t_end)?;
        Ok(Self {
            scenes,
            times,
            discretisations,
            agreement,
            compare,
        })
    }

    fn exercise(&self, case: Option<&str>) -> Exercise {
        Exercise::of_scenes(CONTACT, Integration::AnyOrder, &self.scenes, case)
    }

    fn runs(&self) -> Vec<Case<SceneRun>> {
        let by_all = [Some(0), Some(1)]
            .into_iter()
            .chain(self.compare.then_some(None));
        let mut runs = vec![];
        for (place, scene) in self.scenes.iter().enumerate() {
            for by in by_all.clone() {
                let (how, cost) = match by.map(|k| &self.discretisations[k]) {
                    Some(how) => (how.label(), how.cost(scene.t_end)),
                    None => (
                        scene.method.name().to_owned(),
                        scene.mesh.elements() as f64 * scene.steps() as f64,
                    ),
                };
                let run = SceneRun { scene: place, by };
                runs.push(Case::new(format!("{}, {how}", scene.name), cost, run));
            }
        }
        runs
    }

    fn run(&self, &SceneRun { scene, by }: &SceneRun) -> Result<ShownStates, CaseFailure> {
        let scene = &self.scenes[scene];
        let t_end = self.times.last().copied().unwrap_or(scene.t_end);
        let scene = match by {
            Some(k) => self.discretisations[k].of(scene, t_end)?,
            None => Scene {
                t_end,
                ..scene.clone()
            },
        };
        let mut states = vec![];
        let simulator = Simulator::new(&scene)?;
        let run = simulator.read_at(Recording::Curve(TIP_TIMES), &self.times, |motion| {
            states.push(motion.sample());
        })?;
        Ok(ShownStates {
            states,
            tip: run.tip(),
            steps: run.steps,
            balance: [
                run.energy.largest_balance_residual / run.energy.initial,
                run.energy.largest_increase,
            ],
            events: run.contact.map_or(vec![], |contact| contact.events),
        })
    }

    fn numbers(&self, _: &SceneRun, shown: &ShownStates) -> Vec<Reading> {
        let tip = largest_of(shown.tip.iter().map(|(_, u)| u.abs()));
        let tip = Reading::new("u(1, t)", tip.unwrap_or(f64::NAN));
        let states = shown.states.iter().flat_map(|state| {
            let named = judge::NAMES.into_iter().zip(state.numbers());
            named.map(|(name, number)| Reading::new(name, number))
        });
        states.chain([tip]).collect()
    }

    fn judge(&self, results: &Results<'_, Self>) -> Findings {
        let scenes: Vec<OfScene<'_>> = (0..self.scenes.len())
            .map(|scene| OfScene::of(self, results, scene))
            .collect();
        let worst = scenes.iter().map(OfScene::difference).fold(0.0, max_or_nan);
        let agreement = format!("two discretisations agree within {worst:.1e}");
        let mut headline = agreement.clone();
        let title = "The free end and the energy, to the digits on which two discretisations agree";
        let mut listings = vec![
            Listing::of(
                title,
                &["scene", "t"],
                scenes.iter().flat_map(OfScene::values),
            ),
            Listing::from(events(&scenes)),
        ];
        let mut coverage = vec![];
        if self.compare {
            let own = scenes.iter().map(OfScene::own_error).fold(0.0, max_or_nan);
            headline += &format!(
                "; the scenes' own schemes at their resolution are off by up to {own:.1e} in u(1, t)"
            );
            let errors = scenes.iter().flat_map(OfScene::errors);
            let title = "Errors of the scenes' own scheme at their own resolution";
            listings.push(Listing::of(title, &["scene", "t"], errors));
            // No statement is made about them.
            let reasons = scenes.iter().map(|_| Some("measured, without a claim"));
            coverage.push(Coverage::of("own schemes", reasons));
        }
        listings.push(Listing::from(self.how(&scenes)));
        Findings {
            summary: format!("{} experiments, {agreement}", scenes.len()),
            headline,
            checks: scenes
                .iter()
                .flat_map(|scene| scene.checks(self.agreement))
                .collect(),
            listings,
            figures: self.figures(&scenes, worst),
            coverage,
            ..Findings::default()
        }
    }
}

/// Refuses scenes whose time levels do not include the times of comparison: a difference in time
/// would pass for an error.
fn comparable(section: &Section<'_>, scenes: &[Scene], times: &[f64]) -> Result<(), InputError> {
    for scene in scenes {
        let steps: Vec<f64> = times.iter().map(|t| t / scene.dt()).collect();
        let are_levels = steps
            .iter()
            .all(|steps| (steps - steps.round()).abs() <= 1e-9 * steps);
        let last = steps.last().map_or(0, |steps| steps.round() as usize);
        if !(are_levels && last.is_multiple_of(TIP_TIMES)) {
            let found = format!("{}, whose dt is {:?}", scene.name, scene.dt());
            let last =
                format!("the last after a multiple of {TIP_TIMES} steps, where compare = true");
            let expected = format!("scenes whose time levels include all `times`, {last}");
            return Err(section.refuse("scenes", found, expected));
        }
    }
    Ok(())
}

impl ExactExperiments {
    /// The two discretisations, and the steps that they have taken.
    fn how(&self, scenes: &[OfScene<'_>]) -> Table {
        let mut rows = vec![];
        for (k, how) in self.discretisations.iter().enumerate() {
            let stepping = &how.stepping;
            let steps = scenes
                .iter()
                .map(|runs| runs.any_order[k].steps.to_string());
            let mut row: Vec<String> = [how.elements, how.degree, stepping.degree]
                .map(|count| count.to_string())
                .to_vec();
            let numbers = [stepping.dt, stepping.restart_dt, stepping.growth];
            row.extend(numbers.map(|number| format!("{number:?}")));
            row.push(steps.collect::<Vec<_>>().join(", "));
            rows.push(row);
        }
        let head = [
            "elements",
            "degree p",
            "degree q",
            "largest step",
            "first step",
            "growth",
            "steps of each scene",
        ];
        Table::new("The two discretisations", head, rows)
    }

    /// * `agreement`: the largest difference of the two discretisations.
    fn figures(&self, scenes: &[OfScene<'_>], agreement: f64) -> Vec<Figure> {
        let obstacles = self.scenes.first().and_then(|scene| scene.obstacles);
        let tip = over_time(
            scenes,
            "the free end bounces, faster for larger β",
            chart::Axis::linear("u(1, t) (dimensionless)"),
            &figures::obstacle_lines(obstacles),
            |runs| runs.tip(),
        );
        let caption = format!(
            "The free end of every experiment by dG; two discretisations agree within {agreement:.1e}."
        );
        let mut figures = vec![Figure::new("tip", &caption, chart::panels(&caption, &tip))];
        if self.compare {
            let error = over_time(
                scenes,
                "the error jumps where contact begins",
                chart::Axis::log("error of u(1, t)"),
                &[],
                |runs| runs.error_over_time(),
            );
            let caption = "Error of the scenes' own schemes at their own resolution over time, in the displacement of \
                           the free end.";
            figures.push(Figure::new(
                "error",
                caption,
                chart::panels(caption, &error),
            ));
        }
        figures
    }
}

/// A panel for the experiments without heating and one for those with, if there are any; a curve
/// for each β.
fn over_time(
    scenes: &[OfScene<'_>],
    title: &str,
    y: chart::Axis,
    guides: &[Guide],
    points: fn(&OfScene<'_>) -> Vec<(f64, f64)>,
) -> Vec<Chart> {
    let mut sorted: Vec<&OfScene<'_>> = scenes.iter().collect();
    sorted.sort_by(|one, other| one.scene.beam.beta.total_cmp(&other.scene.beam.beta));
    sorted.sort_by(|one, other| one.heating().total_cmp(&other.heating()));
    let mut panels = vec![];
    for group in sorted.chunk_by(|one, other| one.heating() == other.heating()) {
        let mut panel = Chart {
            guides: guides.to_vec(),
            is_panel: true,
            ..Chart::empty(chart::Axis::linear("time t"), y.clone())
        };
        for runs in group {
            let beam = &runs.scene.beam;
            let curve = panel.curve(figures::beta_label(beam), points(runs));
            curve.look = Some(figures::look_of_beta(beam.beta));
        }
        let heated = match group[0].heating() {
            0.0 => "Without heating (θ_A = 0)".to_owned(),
            theta_a => format!("Heated (θ_A = {theta_a})"),
        };
        panels.push(panel.titled(format!("{heated}: {title}")));
    }
    panels
}
