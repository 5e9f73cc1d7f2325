//! The experiments of Section 5 by the scheme of any order: values to ten decimals, and the error
//! of the paper's own scheme.
//!
//! Two different discretisations (degree, elements, degree in time, steps) of one scene must agree.
//! What they agree on is then the reference for the scene's own scheme at its own resolution, over
//! the whole time.
//!
//! ```toml
//! [experiments]
//! scenes = ["scenes/paper-1-beta-0.toml"]   # one-step scenes; their own scheme is what is compared
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

use thermobeam::dg::ContactEvent;

use super::prelude::*;
use super::settings;
use super::tables::{Discretisation, discretisations};
use crate::run::object::phase_name;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "runs/exact-experiments",
    read: reader::<ExactExperiments>,
    why: "Elements of high degree and dG(q), with contact located to round-off, converge so fast that some hundred steps give ten \
          digits. Two discretisations that share neither mesh nor degrees nor steps make different errors.",
    judged: "Both must agree at each time listed within the tolerance, in the state of the free end and the energy, and on every \
             contact event. The energy must fall, its balance close to round-off.",
    failure: "One of the two is not resolved: raise the degrees or lower the steps of both and see which one moves.",
    settings: settings::of_exact_experiments,
};

/// Times at which the free end is compared over the whole time.
const TIP_TIMES: usize = 1000;

/// Residual of the balance that is round-off, over the initial energy.
const CLOSED: f64 = 1e-12;

/// Relative change of a published number that the baseline tolerates.
const TOLERANCE: f64 = 1e-8;

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

impl FromFile for ExactExperiments {
    fn from_document(_: &Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "experiments", "discretisations"])?;
        let section = root.table("experiments", &["scenes", "times", "agreement", "compare"])?;
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
}

/// Refuses scenes whose time levels do not include the times of comparison: a difference in time
/// would pass for an error.
fn comparable(section: &Section<'_>, scenes: &[Scene], times: &[f64]) -> Result<(), InputError> {
    for scene in scenes {
        let steps = |t: &f64| t / scene.dt();
        let is_level = |t: &f64| (steps(t) - steps(t).round()).abs() <= 1e-9 * steps(t);
        let last = times.last().map_or(0, |t| steps(t).round() as usize);
        if !(times.iter().all(is_level) && last.is_multiple_of(TIP_TIMES)) {
            let found = format!("{}, whose dt is {:?}", scene.name, scene.dt());
            let last =
                format!("the last after a multiple of {TIP_TIMES} steps, where compare = true");
            let expected = format!("scenes whose time levels include all `times`, {last}");
            return Err(section.refuse("scenes", found, expected));
        }
    }
    Ok(())
}

impl Kind for ExactExperiments {
    /// A scene, by its place in the list, and the number of the discretisation that it is run by;
    /// `None`: its own scheme, mesh and steps.
    type Data = (usize, Option<usize>);
    type Found = ShownStates;

    fn cases(&self) -> Vec<Case<Self::Data>> {
        let case = |scene: usize, by: Option<usize>| {
            let of = &self.scenes[scene];
            let (how, cost) = match by.map(|k| &self.discretisations[k]) {
                Some(how) => (how.label(), how.cost(of.t_end)),
                None => (
                    of.method.name().to_owned(),
                    of.mesh.elements() as f64 * of.steps() as f64,
                ),
            };
            Case::new(format!("{}, {how}", of.name), cost, (scene, by))
        };
        let runs = [Some(0), Some(1), None]
            .into_iter()
            .filter(|by| self.compare || by.is_some());
        (0..self.scenes.len())
            .flat_map(|scene| runs.clone().map(move |by| case(scene, by)))
            .collect()
    }

    fn run(&self, &(scene, by): &Self::Data) -> Result<ShownStates, CaseFailure> {
        let scene = &self.scenes[scene];
        let t_end = self.times.last().copied().unwrap_or(scene.t_end);
        match by {
            Some(k) => self.shown(&self.discretisations[k].of(scene, t_end)?),
            None => self.shown(&Scene {
                t_end,
                ..scene.clone()
            }),
        }
    }

    fn judge(&self, ran: &[Ran<(usize, Option<usize>), ShownStates>]) -> Outcome {
        let scenes: Vec<OfScene<'_>> = (0..self.scenes.len())
            .map(|scene| OfScene::of(self, ran, scene))
            .collect();
        let mut checks = vec![completion(ran, |shown: &ShownStates| {
            let tip = shown
                .tip
                .iter()
                .map(|(_, u)| *u)
                .reduce(|a, b| if a.is_finite() { b } else { a });
            let tip = Reading::new("u(1, t)", tip.unwrap_or(f64::NAN));
            readings::not_finite(
                &shown
                    .states
                    .iter()
                    .flat_map(numbers)
                    .chain([tip])
                    .collect::<Vec<_>>(),
            )
        })];
        checks.extend(scenes.iter().flat_map(|scene| scene.checks(self.agreement)));
        let [worst, own] = [OfScene::difference, OfScene::own_error]
            .map(|of| scenes.iter().map(of).fold(0.0, max_or_nan));
        let agreement = format!("two discretisations agree within {worst:.1e}");
        let own = format!(
            "; the scenes' own schemes at their resolution are off by up to {own:.1e} in u(1, t)"
        );
        let values: Vec<_> = scenes.iter().flat_map(OfScene::values).collect();
        let title = "The free end and the energy, to the digits on which two discretisations agree";
        let mut tables = vec![
            readings::table(title, &["scene", "t"], &values),
            events(&scenes),
        ];
        if self.compare {
            let errors: Vec<_> = scenes.iter().flat_map(OfScene::errors).collect();
            let title = "Errors of the scenes' own scheme at their own resolution";
            tables.push(readings::table(title, &["scene", "t"], &errors));
        }
        tables.push(self.how(&scenes));
        Outcome {
            headline: format!("{agreement}{}", if self.compare { &own } else { "" }),
            coverage: self.own_schemes().into_iter().collect(),
            tables,
            figures: self.figures(&scenes),
            quantities: readings::guarded(values.iter().flat_map(|(_, readings)| readings)),
            ..Outcome::new(
                format!("{} experiments, {agreement}", scenes.len()),
                vec![],
                checks,
            )
        }
    }
}

impl ExactExperiments {
    /// No statement is made about the scenes' own schemes: their errors are measured. `None` if the
    /// study does not run them.
    fn own_schemes(&self) -> Option<Coverage> {
        let reason = Some("measured, without a claim");
        self.compare
            .then(|| Coverage::of("own schemes", self.scenes.iter().map(|_| reason)))
    }

    fn shown(&self, scene: &Scene) -> Result<ShownStates, CaseFailure> {
        let mut states = vec![];
        let read = |motion: &mut dyn Motion| states.push(motion.sample());
        let run = Simulator::new(scene)?.read_at(Recording::Curve(TIP_TIMES), &self.times, read)?;
        let balance = [
            run.energy.largest_balance_residual / run.energy.initial,
            run.energy.largest_increase,
        ];
        let (tip, steps) = (run.tip(), run.steps);
        Ok(ShownStates {
            states,
            tip,
            steps,
            balance,
            events: run.contact.map_or(vec![], |contact| contact.events),
        })
    }

    /// The two discretisations, and the steps that they have taken.
    fn how(&self, scenes: &[OfScene<'_>]) -> Table {
        let row = |(
            k,
            Discretisation {
                elements,
                degree,
                stepping,
            },
        ): (usize, &Discretisation)| {
            let steps = scenes
                .iter()
                .map(|of| of.any_order[k].map_or("-".to_owned(), |shown| shown.steps.to_string()));
            let counts = [*elements, *degree, stepping.degree].map(|count| count.to_string());
            let numbers = [stepping.dt, stepping.restart_dt, stepping.growth]
                .map(|number| format!("{number:?}"));
            counts
                .into_iter()
                .chain(numbers)
                .chain([steps.collect::<Vec<_>>().join(", ")])
                .collect()
        };
        let head = [
            "elements",
            "degree p",
            "degree q",
            "largest step",
            "first step",
            "growth",
            "steps of each scene",
        ];
        Table::new(
            "The two discretisations",
            head,
            self.discretisations.iter().enumerate().map(row),
        )
    }

    fn figures(&self, scenes: &[OfScene<'_>]) -> Vec<Figure> {
        let agreement = scenes.iter().map(OfScene::difference).fold(0.0, max_or_nan);
        let tip = self.over_time(
            scenes,
            "the free end bounces, faster for larger β",
            plots::Axis::linear("displacement u(1, t) (dimensionless)"),
            |scene| scene.tip(),
        );
        let tip: Vec<Xy> = tip
            .into_iter()
            .map(|panel| Xy {
                guides: figures::obstacle_lines(
                    self.scenes.first().and_then(|scene| scene.obstacles),
                ),
                ..panel
            })
            .collect();
        let caption = format!(
            "The free end of every experiment by dG; two discretisations agree within {agreement:.1e}."
        );
        let mut figures = vec![Figure::new("tip", &caption, plots::panels(&caption, &tip))];
        if self.compare {
            let error = self.over_time(
                scenes,
                "the error jumps where contact begins",
                plots::Axis::log("error of u(1, t) (dimensionless)"),
                |scene| scene.error_over_time(),
            );
            let caption = "Error of the scenes' own schemes at their own resolution over time, in the displacement of \
                           the free end.";
            figures.push(Figure::new(
                "error",
                caption,
                plots::panels(caption, &error),
            ));
        }
        figures
    }

    /// A panel for the experiments without heating and one for those with, if there are any; a
    /// curve for each β.
    fn over_time(
        &self,
        scenes: &[OfScene<'_>],
        title: &str,
        y: plots::Axis,
        points: fn(&OfScene<'_>) -> Vec<(f64, f64)>,
    ) -> Vec<Xy> {
        let mut heatings: Vec<f64> = self.scenes.iter().map(|scene| scene.beam.theta_a).collect();
        heatings.sort_by(f64::total_cmp);
        heatings.dedup();
        let panel = |&theta_a: &f64| {
            let mut shown: Vec<(&Scene, &OfScene<'_>)> = self
                .scenes
                .iter()
                .zip(scenes)
                .filter(|(scene, _)| scene.beam.theta_a == theta_a)
                .collect();
            shown.sort_by(|(one, _), (other, _)| one.beam.beta.total_cmp(&other.beam.beta));
            let curve = |(scene, runs): &(&Scene, &OfScene<'_>)| {
                plots::Series::new(figures::beta_label(&scene.beam), points(runs))
            };
            let looks: Vec<usize> = shown
                .iter()
                .map(|(scene, _)| figures::look_of_beta(scene.beam.beta))
                .collect();
            let curves: Vec<plots::Series> = shown.iter().map(curve).collect();
            plots::history(y.clone(), &curves)
                .with_looks(&looks)
                .titled(format!("{}: {title}", heating(theta_a)))
        };
        heatings.iter().map(panel).collect()
    }
}

/// The temperature of the clamped end in words.
fn heating(theta_a: f64) -> String {
    if theta_a == 0.0 {
        "Without heating (θ_A = 0)".to_owned()
    } else {
        format!("Heated (θ_A = {theta_a})")
    }
}

/// The runs of one scene.
struct OfScene<'r> {
    name: &'r str,
    any_order: [Option<&'r ShownStates>; 2],
    own: Option<&'r ShownStates>,
}

/// The numbers of a state.
fn numbers(state: &Sample) -> [Reading; 6] {
    let Sample {
        u_tip,
        phi_tip,
        u_t_tip,
        phi_t_tip,
        theta_mid,
        energy,
        ..
    } = *state;
    let values = [u_tip, phi_tip, u_t_tip, phi_t_tip, theta_mid, energy];
    let names = ["u(1)", "φ(1)", "u_t(1)", "φ_t(1)", "θ(1/2)", "E"];
    std::array::from_fn(|k| Reading::new(names[k], values[k]))
}

/// The differences of all numbers of two states.
fn differences(one: &Sample, other: &Sample) -> [Reading; 6] {
    let (ones, others) = (numbers(one), numbers(other));
    std::array::from_fn(|k| {
        let difference = ones[k]
            .value
            .zip(others[k].value)
            .map(|(one, other)| one - other);
        Reading::new(ones[k].name.clone(), difference)
    })
}

impl<'r> OfScene<'r> {
    fn of(
        study: &'r ExactExperiments,
        ran: &'r [Ran<(usize, Option<usize>), ShownStates>],
        scene: usize,
    ) -> Self {
        let by = |by: Option<usize>| found(ran, &(scene, by));
        Self {
            name: &study.scenes[scene].name,
            any_order: [by(Some(0)), by(Some(1))],
            own: by(None),
        }
    }

    /// `(t, u(1, t))` by the first discretisation.
    fn tip(&self) -> Vec<(f64, f64)> {
        self.any_order[0].map_or(vec![], |shown| shown.tip.clone())
    }

    /// The states of the first discretisation.
    fn states(&self) -> &'r [Sample] {
        self.any_order[0].map_or(&[], |shown| &shown.states)
    }

    /// The largest difference of any number at any time; NaN where one of the runs is missing.
    fn difference(&self) -> f64 {
        let [Some(one), Some(other)] = self.any_order else {
            return f64::NAN;
        };
        if one.states.len() != other.states.len() || one.states.is_empty() {
            return f64::NAN;
        }
        let differences = one
            .states
            .iter()
            .zip(&other.states)
            .flat_map(|(one, other)| differences(one, other));
        differences
            .filter_map(|reading| reading.value)
            .map(f64::abs)
            .fold(0.0, max_or_nan)
    }

    fn checks(&self, agreement: f64) -> [Check; 3] {
        let difference = self.difference();
        let claim = format!("two discretisations agree within {agreement:e}");
        let agree = Check::that(
            difference <= agreement,
            claim,
            format!("largest difference {difference:.1e}"),
        )
        .about(self.subject("agreement"));
        [agree, self.events_agree(agreement), self.balance()]
    }

    fn subject(&self, quantity: &str) -> Subject {
        Subject::of(quantity).in_case(self.name)
    }

    fn events_agree(&self, agreement: f64) -> Check {
        let claim = "they agree on every contact event";
        let subject = self.subject("contact events");
        let [Some(one), Some(other)] = self.any_order else {
            return Check::that(false, claim, "a run is missing").about(subject);
        };
        let alike = one.events.len() == other.events.len()
            && one
                .events
                .iter()
                .zip(&other.events)
                .all(|(a, b)| (a.from, a.to) == (b.from, b.to));
        let apart = one
            .events
            .iter()
            .zip(&other.events)
            .map(|(a, b)| (a.t - b.t).abs());
        let apart = largest_of(apart);
        let times = apart.map_or(String::new(), |apart| {
            format!(", times at most {apart:.1e} apart")
        });
        let evidence = format!(
            "{} and {} events{times}",
            one.events.len(),
            other.events.len()
        );
        // Times are of order 10, the other numbers of order 1.
        let close = apart.is_none_or(|apart| apart <= 10.0 * agreement);
        Check::that(alike && close, claim, evidence).about(subject)
    }

    fn balance(&self) -> Check {
        let [residual, increase] = [0, 1].map(|i| {
            let values = self
                .any_order
                .iter()
                .map(|shown| shown.map_or(f64::NAN, |shown| shown.balance[i]));
            values.fold(f64::NEG_INFINITY, max_or_nan)
        });
        Check::that(
            residual <= CLOSED && increase <= 0.0,
            format!(
                "the energy falls in every step and its balance closes within {CLOSED:e} of E0"
            ),
            format!("largest residual {residual:.1e} of E0, largest change {increase:.1e}"),
        )
        .about(self.subject("energy and balance"))
    }

    /// The numbers, to the digits that both discretisations agree on and one more.
    fn values(&self) -> Vec<(Vec<String>, Vec<Reading>)> {
        let apart = self.difference();
        let decimals = if apart > 0.0 {
            (-apart.log10()).floor().clamp(0.0, 14.0) as usize
        } else {
            14
        };
        let row = |state: &Sample| {
            let guard = |reading: Reading| {
                let name = reading.name.replace('φ', "phi").replace('θ', "theta");
                let quantity = format!("{name} at t = {}", state.t);
                reading
                    .fixed(decimals)
                    .guarded_in(self.name, quantity, TOLERANCE)
            };
            let apart = Reading::text("largest difference", format!("{apart:.0e}"));
            let numbers = numbers(state)
                .map(guard)
                .into_iter()
                .chain([apart])
                .collect();
            (vec![self.name.to_owned(), state.t.to_string()], numbers)
        };
        self.states().iter().map(row).collect()
    }

    /// Errors of the scene's own scheme.
    fn errors(&self) -> Vec<(Vec<String>, Vec<Reading>)> {
        let row = |(own, exact): (&Sample, &Sample)| {
            let largest = Reading::new("largest |error| of u(1, t)", self.own_error());
            let errors = differences(own, exact)
                .into_iter()
                .chain([largest])
                .map(|error| error.scientific(2));
            (
                vec![self.name.to_owned(), exact.t.to_string()],
                errors.collect(),
            )
        };
        self.own
            .iter()
            .flat_map(|own| own.states.iter().zip(self.states()))
            .map(row)
            .collect()
    }

    /// `(t, error)` of u(1, t) by the scene's own scheme.
    fn error_over_time(&self) -> Vec<(f64, f64)> {
        let (Some(own), Some(exact)) = (self.own, self.any_order[0]) else {
            return vec![];
        };
        // The history of the exact run begins at t = 0. The reader has made sure that both have the
        // same times.
        own.tip
            .iter()
            .zip(&exact.tip)
            .skip(1)
            .map(|((t, u), (_, exact))| (*t, (u - exact).abs()))
            .collect()
    }

    /// The largest of these; NaN where there is none.
    fn own_error(&self) -> f64 {
        self.error_over_time()
            .into_iter()
            .map(|(_, error)| error)
            .reduce(max_or_nan)
            .unwrap_or(f64::NAN)
    }
}

fn events(scenes: &[OfScene<'_>]) -> Table {
    let of_scene = |scene: &OfScene<'_>| -> Vec<Vec<String>> {
        let row = |event: &ContactEvent| {
            let [from, to] = [event.from, event.to].map(phase_name);
            vec![
                scene.name.to_owned(),
                format!("{:.10}", event.t),
                format!("{from} to {to}"),
            ]
        };
        scene.any_order[0]
            .iter()
            .flat_map(|shown| &shown.events)
            .map(row)
            .collect()
    };
    Table::new(
        "Contact events",
        ["scene", "t", "free end"],
        scenes.iter().flat_map(of_scene),
    )
}
