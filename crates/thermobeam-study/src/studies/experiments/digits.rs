//! The experiments to ten decimals, contact events included, and the errors of one-step schemes.
//!
//! Two discretisations that share neither mesh nor degrees nor steps make different errors. What
//! they agree on is then the reference for the scheme of the scene at its own resolution, over the
//! whole time.

use super::trace::{Recorder, SAME_TIME, Trace};
use crate::error::reference::largest_difference;
use crate::figures;
use crate::kinds::tables::Discretisation;
use crate::run::{Sample, object::phase_name, run, simulate};
use crate::scene::Scene;
use crate::studies::paper::{ELEMENTS, Experiment, OBSTACLES, STEPS, T_END, experiments};
use crate::studies::prelude::*;
use convergence_study::{
    Figure, InputError,
    chart::{self, Chart, Guide},
};

/// What the study says about itself.
pub const ABOUT: About = About {
    id: "experiments-exact",
    claim: "The paper's experiments to ten decimals, contact events included",
    tier: Tier::Quick,
    group: "contact",
    home: file!(),
};

/// The same with the error of the paper's scheme at the paper's resolution.
pub const ERROR: About = About {
    id: "experiments-error",
    claim: "The errors of the paper's figures at the paper's resolution",
    tier: Tier::Full,
    ..ABOUT
};

/// Small viscosity, where high orders gain least: an impact sends fronts into the beam.
pub const SMALL_VISCOSITY: About = About {
    id: "small-viscosity",
    claim: "At ζ = 0.001, on graded elements, two discretisations agree to 1e-8; the error of midpoint on the same scene is measured",
    tier: Tier::Full,
    ..ABOUT
};

/// The paper's first experiment with a hundredth of its viscosity: fronts, and layers of width
/// √(ζt) at x = 1 after each touch, towards which the elements shrink.
pub const FRONTS: &str = "beam = { zeta = 0.001 }
obstacles = {}
initial = { u = \"0.01*x*(x-2)\", u_t = \"20*x*(x-1)^2\", theta = \"sin(pi*x)\" }
mesh = { elements = 400, map = \"1 - (1-s)^3\" }
time = { scheme = \"midpoint\", dt = 2.5e-4, t_end = 1.0 }
";

/// Residual of the balance that is round-off, over the initial energy.
const CLOSED: f64 = 1e-12;
/// Relative change of a published number that the baseline tolerates.
const GUARDED: f64 = 1e-8;
/// The same of the largest error of a scheme, of order 1e-4: it is known to 1e-10.
const GUARDED_ERROR: f64 = 1e-5;

/// The numbers of a state, in the order of [`Sample::numbers`], and their names in the baseline.
const NAMES: [[&str; 2]; 6] = [
    ["u(1)", "u(1)"],
    ["φ(1)", "phi(1)"],
    ["u_t(1)", "u_t(1)"],
    ["φ_t(1)", "phi_t(1)"],
    ["θ(1/2)", "theta(1/2)"],
    ["E", "E"],
];

/// Beams until the end of their scenes.
#[derive(Debug, Clone, PartialEq)]
pub struct TenDigits {
    /// The last of the times of comparison is the end of the scenes.
    pub times: [f64; 2],
    /// Distance allowed between both discretisations, in every number.
    agreement: f64,
    discretisations: [Discretisation; 2],
    /// Whether the digits themselves are shown and guarded.
    shows_digits: bool,
    /// Whether the scenes' own schemes are run and compared.
    pub compare: bool,
    /// The beams.
    pub beams: Vec<Beam>,
}

/// The study.
pub fn study() -> Described<TenDigits> {
    ABOUT.study(TenDigits {
        times: [1.0, T_END],
        agreement: 1e-10,
        discretisations: [
            Discretisation::new([1, 28, 4], [0.003, 1e-4, 1.3]),
            Discretisation::new([2, 20, 5], [0.0035, 1.2e-4, 1.35]),
        ],
        shows_digits: true,
        compare: false,
        beams: experiments().map(Beam::Paper).collect(),
    })
}

/// The study of the error of the paper's scheme; the digits are those of [`study`].
pub fn error() -> Described<TenDigits> {
    ERROR.study(TenDigits {
        shows_digits: false,
        compare: true,
        ..study().kind
    })
}

/// The study of small viscosity.
pub fn small_viscosity() -> Described<TenDigits> {
    SMALL_VISCOSITY.study(TenDigits {
        times: [0.5, 1.0],
        agreement: 1e-8,
        discretisations: [
            Discretisation::new([10, 20, 4], [0.003, 2e-5, 1.3]),
            Discretisation::new([14, 17, 5], [0.0035, 2.4e-5, 1.35]),
        ],
        shows_digits: true,
        compare: true,
        beams: vec![Beam::Fronts],
    })
}

/// A beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beam {
    /// One of the experiments.
    Paper(Experiment),
    /// That of small viscosity.
    Fronts,
}

impl Beam {
    fn name(self) -> &'static str {
        match self {
            Self::Paper(experiment) => experiment.name,
            Self::Fronts => SMALL_VISCOSITY.id,
        }
    }

    fn scene(self) -> Result<Scene, InputError> {
        match self {
            Self::Paper(experiment) => experiment.scene(),
            Self::Fronts => Scene::parse(FRONTS, file!()),
        }
    }

    /// θ_A and β.
    fn heat_and_force(self) -> [f64; 2] {
        match self {
            Self::Paper(Experiment { theta_a, beta, .. }) => [theta_a, beta],
            Self::Fronts => [0.0; 2],
        }
    }

    /// The cost of a run by its own scheme.
    fn cost(self) -> f64 {
        match self {
            Self::Paper(_) => (ELEMENTS * STEPS) as f64,
            Self::Fronts => 400.0 * 4000.0,
        }
    }
}

impl Kind for TenDigits {
    /// A beam, and the place of the discretisation; `None`: by its own scheme.
    type Data = (Beam, Option<usize>);
    type Found = Trace;

    fn cases(&self) -> Vec<Case<Self::Data>> {
        let by_all = [Some(0), Some(1)]
            .into_iter()
            .chain(self.compare.then_some(None));
        let case = |beam: Beam, by: Option<usize>| {
            let (how, cost) = match by.map(|k| self.discretisations[k]) {
                Some(how) => (how.label(), how.cost(self.times[1])),
                None => ("its own scheme".to_owned(), beam.cost()),
            };
            let parts = beam.scene().ok().map(|scene| Parts::of(&scene));
            let parts = parts.map(|own| by.map_or(own.clone(), |_| own.by_dg()));
            Case::new(format!("{}, {how}", beam.name()), cost, (beam, by)).described(&parts)
        };
        let beams = self.beams.iter();
        beams
            .flat_map(|&beam| by_all.clone().map(move |by| case(beam, by)))
            .collect()
    }

    fn run(&self, &(beam, by): &Self::Data) -> Result<Trace, CaseFailure> {
        let [_, t_end] = self.times;
        let mut scene = beam.scene()?;
        scene.t_end = t_end;
        if let Some(k) = by {
            scene = self.discretisations[k].of(&scene, t_end)?;
        }
        let mut motion = simulate::motion(&scene)?;
        let mut recorder = Recorder::new(&mut *motion, &scene, t_end);
        // At the end of a step dG is more exact than inside.
        run(&mut *motion, t_end, &self.times, &mut [&mut recorder])?;
        Ok(recorder.finish(&*motion))
    }

    fn judge(&self, ran: &[Ran<Self::Data, Trace>]) -> Outcome {
        Outcome::of_complete(self, ran, |shown| {
            let all = self.beams.iter().map(|&beam| OfBeam {
                study: self,
                beam,
                any_order: [0, 1].map(|k| of(shown, &(beam, Some(k)))),
                own: self.compare.then(|| of(shown, &(beam, None))),
            });
            let all: Vec<OfBeam<'_>> = all.collect();
            let apart = all.iter().map(OfBeam::difference);
            let apart = apart.fold(0.0, max_or_nan);
            let mut headline = format!("two discretisations agree within {apart:.1e}");
            let [one, other] = self.discretisations.map(|how| how.label());
            let title = format!("Two discretisations agree: {one}, and {other}");
            let agree = all.iter().flat_map(OfBeam::agree);
            let mut sheets = vec![Sheet::new(title, "beam", agree)];
            let mut figures = vec![];
            if self.shows_digits {
                let title =
                    "The free end and the energy, to the digits on which two discretisations agree";
                let digits = all.iter().flat_map(OfBeam::digits);
                sheets.push(Sheet::new(title, "state", digits));
                let events = all.iter().flat_map(OfBeam::events);
                sheets.push(Sheet::new("Contact events", "event", events));
                let caption = format!(
                    "The free end of every beam by dG; two discretisations agree within {apart:.1e}."
                );
                figures.push(free_end(&all, caption));
            }
            if self.compare {
                let errors = all.iter().filter_map(OfBeam::largest_error);
                let largest = errors.fold(0.0, max_or_nan);
                headline += &format!(
                    "; the scenes' own schemes at their resolution are off by up to {largest:.1e} in u(1, t)"
                );
                let title = "Errors of the scene's own scheme at its own resolution";
                let errors = all.iter().flat_map(OfBeam::errors);
                sheets.push(Sheet::new(title, "state", errors));
                figures.push(error_over_time(&all));
            }
            Outcome {
                figures,
                ..Outcome::of_sheets(sheets, "").headed(headline)
            }
        })
    }
}

/// The runs of one beam.
struct OfBeam<'r> {
    study: &'r TenDigits,
    beam: Beam,
    any_order: [&'r Trace; 2],
    /// By its own scheme, where that is compared.
    own: Option<&'r Trace>,
}

/// The numbers of a run at a time; NaN if it ended before.
fn numbers(trace: &Trace, t: f64) -> [f64; 6] {
    trace.at(t).map_or([f64::NAN; 6], Sample::numbers)
}

impl OfBeam<'_> {
    fn one(&self, name: &str, value: f64) -> Measured {
        measured(self.beam.name(), name, value)
    }

    /// A state, which is a row of a table.
    fn at(&self, t: f64) -> String {
        format!("{}, t = {t}", self.beam.name())
    }

    /// The largest difference of any number at any time.
    fn difference(&self) -> f64 {
        let [one, other] = self
            .any_order
            .map(|trace| self.study.times.map(|t| numbers(trace, t)).concat());
        largest_difference(&one, &other)
    }

    /// What the two discretisations agree on, and that the energy falls and its balance closes.
    fn agree(&self) -> Vec<Measured> {
        let [one, other] = self.any_order;
        let pairs = one.events.iter().zip(&other.events);
        let unlike = pairs
            .clone()
            .filter(|(a, b)| (a.from, a.to) != (b.from, b.to));
        let unlike = unlike.count() + one.events.len().abs_diff(other.events.len());
        let apart = largest_of(pairs.map(|(a, b)| (a.t - b.t).abs()));
        let larger = |number: fn(&Trace) -> f64| max_or_nan(number(one), number(other));
        let residual = larger(|trace| trace.largest_residual / trace.points[0].energy);
        let name = self.beam.name();
        vec![
            self.one("largest difference", self.difference())
                .scientific(1)
                .must_be(Must::AtMost(self.study.agreement)),
            self.one("unlike contact events", unlike as f64)
                .fixed(0)
                .must_be(Must::Count(0)),
            // Times are of order 10, the other numbers of order 1.
            measured(name, "distance of the times of events", apart)
                .scientific(1)
                .must_be(Must::AtMost(10.0 * self.study.agreement)),
            self.one("largest residual of the balance, of E0", residual)
                .scientific(1)
                .must_be(Must::AtMost(CLOSED)),
            self.one(
                "largest change of the energy in a step",
                larger(|trace| trace.largest_increase),
            )
            .scientific(1)
            .must_be(Must::AtMost(0.0)),
            self.one("steps of the first", one.steps as f64).fixed(0),
            self.one("of the second", other.steps as f64).fixed(0),
        ]
    }

    /// The numbers, to the digits that both discretisations agree on and one more.
    fn digits(&self) -> Vec<Measured> {
        let apart = self.difference();
        let decimals = if apart > 0.0 {
            (-apart.log10()).floor().clamp(0.0, 14.0) as usize
        } else {
            14
        };
        let name = self.beam.name();
        let states = self.study.times.into_iter().flat_map(|t| {
            let pairs = NAMES.into_iter().zip(numbers(self.any_order[0], t));
            pairs.map(move |([what, known], number)| {
                measured(self.at(t), what, number)
                    .fixed(decimals)
                    .recorded_as(format!("{name}: {known} at t = {t}"), GUARDED)
            })
        });
        states.collect()
    }

    fn events(&self) -> Vec<Measured> {
        let events = self.any_order[0].events.iter().enumerate();
        let events = events.flat_map(|(k, event)| {
            let case = format!("{}, {}", self.beam.name(), k + 1);
            let [from, to] = [event.from, event.to].map(phase_name);
            [
                measured(&case, "time", event.t).fixed(10),
                measured(case, "free end", None).words(format!("{from} to {to}")),
            ]
        });
        events.collect()
    }

    /// Errors of its own scheme.
    fn errors(&self) -> Vec<Measured> {
        let Some(own) = self.own else {
            return vec![];
        };
        let states = self.study.times.into_iter().flat_map(|t| {
            let [own, exact] = [own, self.any_order[0]].map(|trace| numbers(trace, t));
            let errors = own.into_iter().zip(exact).map(|(own, exact)| own - exact);
            let named = NAMES.into_iter().zip(errors);
            named.map(move |([what, _], error)| {
                measured(self.at(t), format!("error of {what}"), error)
            })
        });
        let what = "largest |error| of u(1, t)";
        let largest = measured(self.at(self.study.times[1]), what, self.largest_error())
            .recorded_as(format!("{}: {what}", self.beam.name()), GUARDED_ERROR);
        states.chain([largest]).collect()
    }

    /// `(t, error)` of u(1, t) by its own scheme, after the start; NaN for points of two times.
    fn error_over_time(&self) -> Vec<(f64, f64)> {
        let own = self.own.map_or(&[][..], |own| &own.points);
        let pairs = own.iter().zip(&self.any_order[0].points).skip(1);
        let errors = pairs.map(|(own, exact)| {
            let is_pair = (own.t - exact.t).abs() <= SAME_TIME * exact.t;
            let error = (own.u_tip - exact.u_tip).abs();
            (own.t, if is_pair { error } else { f64::NAN })
        });
        errors.collect()
    }

    fn largest_error(&self) -> Option<f64> {
        largest_of(self.error_over_time().into_iter().map(|(_, error)| error))
    }
}

fn free_end(all: &[OfBeam<'_>], caption: String) -> Figure {
    let panels = over_time(
        all,
        "the free end bounces, faster for larger β",
        chart::Axis::linear("u(1, t) (dimensionless)"),
        &figures::obstacle_lines(Some(OBSTACLES)),
        |runs| {
            // More points than the figure has columns.
            let points = runs.any_order[0].points.iter().step_by(4);
            points.map(|point| (point.t, point.u_tip)).collect()
        },
    );
    let svg = Chart::panels(&caption, &panels);
    Figure::new("tip", caption, svg)
}

fn error_over_time(all: &[OfBeam<'_>]) -> Figure {
    let title = "the error jumps where contact begins";
    let axis = chart::Axis::log("error of u(1, t) (dimensionless)");
    let panels = over_time(all, title, axis, &[], |runs| runs.error_over_time());
    let caption = "Error of the scenes' own schemes at their own resolution over time, in the displacement of the free end.";
    Figure::new("error", caption, Chart::panels(caption, &panels))
}

/// A panel for the beams without heating and one for those with, if there are any; a curve for each
/// β.
fn over_time(
    all: &[OfBeam<'_>],
    title: &str,
    y: chart::Axis,
    guides: &[Guide],
    points: fn(&OfBeam<'_>) -> Vec<(f64, f64)>,
) -> Vec<Chart> {
    let mut sorted: Vec<&OfBeam<'_>> = all.iter().collect();
    sorted.sort_by(|one, other| {
        let [one, other] = [one, other].map(|of| of.beam.heat_and_force());
        one[0]
            .total_cmp(&other[0])
            .then(one[1].total_cmp(&other[1]))
    });
    let heat = |runs: &OfBeam<'_>| runs.beam.heat_and_force()[0];
    let groups = sorted.chunk_by(|one, other| heat(one) == heat(other));
    let panels = groups.map(|group| {
        let mut panel = Chart {
            guides: guides.to_vec(),
            ..Chart::empty(chart::Axis::linear("time t"), y.clone())
        };
        for runs in group {
            let [_, beta] = runs.beam.heat_and_force();
            let curve = panel.curve(figures::beta_label(beta), points(runs));
            curve.style = Some(figures::style_of_beta(beta));
        }
        let words = match heat(group[0]) {
            0.0 => "Without heating (θ_A = 0)".to_owned(),
            theta_a => format!("Heated (θ_A = {theta_a})"),
        };
        panel.titled(format!("{words}: {title}"))
    });
    panels.collect()
}
