//! Where long runs end, against exact steady states that nobody manufactured.
//!
//! A beam at rest solves the discrete static problem to round-off, whatever the time step was: what is left is the error
//! of P1 elements, which halves twice with the mesh width, in u and in φ. So three things are judged: the rate at every
//! scene that ends bent, the error on the finest mesh, and that the straight beam, where it is the answer, is met to the
//! last of the motion.

use std::path::Path;

use super::complete::{all_ran, or_nothing};
use super::steady::{
    at_resolution, code_of, contact_of, exact_states, listed_scenes, name_of, nearest, positive, settle,
};
use super::{FromFile, Study};
use crate::kinds::untyped::{Case, Measured};
use crate::scene::Scene;
use crate::scene::limits;
use crate::scene::tables;
use convergence_study::input::{self, Field, InputError, Section};
use convergence_study::judge::fit::Level;
use convergence_study::judge::verdict::{Judge, RateVerdict};
use convergence_study::plots::{Convergence, ErrorSeries, PowerLaw, convergence};
use convergence_study::study::CaseFailure;
use convergence_study::study::Header;
use convergence_study::study::outcome::{Check, Figure, LevelErrors, Outcome, Quantity, Table};
use convergence_study::text::number::{decimals, max_or_nan};

/// Order of the elements in u and φ.
const ORDER: f64 = 2.0;

/// What is left of the tip's error when it is extrapolated from two meshes: the next term of the expansion, and the motion.
const EXTRAPOLATED: f64 = 1e-2;

/// What is compared at the nodes.
const FIELDS: [&str; 2] = ["u", "φ"];

/// The study.
#[derive(Debug, Clone, PartialEq)]
pub struct EndStates {
    header: Header,
    scenes: Vec<Scene>,
    elements: Vec<usize>,
    dt: f64,
    speed: f64,
    t_max: f64,
    judge: Judge,
    error: f64,
}

impl FromFile for EndStates {
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, from_document)
    }
}

impl EndStates {
    fn scene_and_elements(&self, index: usize) -> (&Scene, usize) {
        (&self.scenes[index / self.elements.len()], self.elements[index % self.elements.len()])
    }
}

fn from_document(root: &Section<'_>, folder: &Path) -> Result<EndStates, InputError> {
    let header = Header::from_document(root)?;
    root.allow(&["study", "run", "expect"])?;
    let run = root.require("run", "a table with scenes, elements, dt, speed and t_max")?.section()?;
    run.allow(&["scenes", "elements", "dt", "speed", "t_max"])?;
    let expect = root.require("expect", "a table with tolerance and error")?.section()?;
    expect.allow(&["tolerance", "error"])?;
    let tolerance = expect.require("tolerance", "a number > 0 and < 0.5")?;
    let judge = Judge::new(tolerance.number()?).map_err(|_| tolerance.refuse_as_written("a number > 0 and < 0.5"))?;
    let (dt, t_max) = (positive(&run, "dt")?, positive(&run, "t_max")?);
    limits::steps_until(&run.require("t_max", "a number")?, t_max, dt, limits::STEPS)?;
    Ok(EndStates {
        header,
        scenes: listed_scenes(&run.require("scenes", "a list of scene files")?, folder)?,
        elements: mesh_sizes(&run)?,
        dt,
        speed: positive(&run, "speed")?,
        t_max,
        judge,
        error: positive(&expect, "error")?,
    })
}

fn mesh_sizes(run: &Section<'_>) -> Result<Vec<usize>, InputError> {
    let allowed = "a list of at least three numbers of elements, ascending";
    let field: Field<'_> = run.require("elements", allowed)?;
    let sizes = field.items(allowed)?.iter().map(tables::elements).collect::<Result<Vec<_>, _>>()?;
    let ascending = sizes.windows(2).all(|pair| pair[0] < pair[1]);
    if sizes.len() >= 3 && ascending { Ok(sizes) } else { Err(field.refuse_as_written(allowed)) }
}

impl Study for EndStates {
    fn header(&self) -> &Header {
        &self.header
    }

    fn cases(&self) -> Vec<Case> {
        let case = |index| {
            let (scene, elements) = self.scene_and_elements(index);
            Case { label: format!("{}, n = {elements}", scene.name), cost: 200.0 / self.dt * elements as f64 }
        };
        (0..self.scenes.len() * self.elements.len()).map(case).collect()
    }

    fn run(&self, index: usize) -> Result<Measured, CaseFailure> {
        let (scene, elements) = self.scene_and_elements(index);
        let scene = at_resolution(scene, elements, self.dt)?;
        let end = settle(&scene, self.speed, self.t_max)?;
        let states = exact_states(&scene)?;
        let stable: Vec<_> = states.into_iter().filter(|state| state.stable).collect();
        let none = || CaseFailure { reason: "there is no stable steady state".to_owned() };
        let (state, (in_u, in_phi)) = nearest(&scene.mesh, &end.level, &stable).ok_or_else(none)?;
        let mut measured = Measured::default();
        measured.push("t_rest", end.t);
        measured.push("u_tip", end.level.u[elements]);
        measured.push("phi_tip", end.level.phi[elements]);
        measured.push("exact_u_tip", state.u_tip);
        measured.push("exact_phi_tip", state.phi_tip);
        measured.push("contact", code_of(state.contact));
        measured.push(FIELDS[0], in_u);
        measured.push(FIELDS[1], in_phi);
        Ok(measured)
    }

    fn conclude(&self, results: &[Result<Measured, CaseFailure>]) -> Outcome {
        let cases = self.cases();
        let measured = or_nothing(cases.len(), results);
        let ends: Vec<Ends<'_>> = self
            .scenes
            .iter()
            .zip(measured.chunks(self.elements.len()))
            .map(|(scene, levels)| Ends { scene, levels })
            .collect();
        let mut checks = vec![all_ran(&cases, results)];
        checks.extend(ends.iter().map(|end| self.arrived(end)));
        let rates = self.rates(&ends);
        Outcome {
            levels: self.levels(&ends),
            tables: vec![self.table(&ends)],
            figures: vec![self.figure(&ends, &rates)],
            quantities: quantities(&ends),
            headline: format!("largest error at the finest mesh {:.1e}, of {} ends", worst(&ends), ends.len()),
            ..Outcome::new(summary(&ends), rates, checks)
        }
    }
}

/// The ends of one scene, one for each mesh.
struct Ends<'a> {
    scene: &'a Scene,
    levels: &'a [Measured],
}

impl Ends<'_> {
    fn finest(&self, name: &str) -> f64 {
        self.levels.last().map_or(f64::NAN, |level| level.value(name))
    }

    /// Whether the beam ends straight, where the mesh makes no error.
    fn is_straight(&self) -> bool {
        self.finest("exact_u_tip") == 0.0 && self.finest("exact_phi_tip") == 0.0
    }

    fn errors(&self, field: &str) -> Vec<f64> {
        self.levels.iter().map(|level| level.value(field)).collect()
    }

    /// The number that two meshes suggest for vanishing mesh width.
    fn extrapolated(&self, name: &str, elements: &[usize]) -> f64 {
        let &[.., coarse, fine] = elements else { return f64::NAN };
        let ratio = (fine as f64 / coarse as f64).powf(ORDER);
        let [.., before, last] = self.levels else { return f64::NAN };
        last.value(name) + (last.value(name) - before.value(name)) / (ratio - 1.0)
    }
}

impl EndStates {
    fn arrived(&self, ends: &Ends<'_>) -> Check {
        let error = max_or_nan(ends.finest("u"), ends.finest("φ"));
        let extrapolated = (ends.extrapolated("u_tip", &self.elements) - ends.finest("exact_u_tip")).abs();
        let elements = self.elements.last().copied().unwrap_or(0);
        // The beam may buckle to either side, but to the same one on every mesh, or the errors are no family.
        let same_side = ends.levels.iter().all(|level| level.value("contact") == ends.finest("contact"));
        Check::that(
            error <= self.error && extrapolated <= EXTRAPOLATED * self.error && same_side,
            format!("{} comes to rest in the exact steady state, to {:.0e}", ends.scene.name, self.error),
            format!(
                "largest error at {elements} elements: u {:.2e}, φ {:.2e}; u(1) extrapolated from the last two meshes {} for {}",
                ends.finest("u"),
                ends.finest("φ"),
                decimals(ends.extrapolated("u_tip", &self.elements), 10),
                decimals(ends.finest("exact_u_tip"), 10)
            ),
        )
    }

    fn rates(&self, ends: &[Ends<'_>]) -> Vec<(String, RateVerdict)> {
        let mut rates = Vec::new();
        for ends in ends.iter().filter(|ends| !ends.is_straight()) {
            for field in FIELDS {
                let step = |n: &usize| 1.0 / *n as f64;
                let levels: Vec<Level> = self
                    .elements
                    .iter()
                    .zip(ends.errors(field))
                    .map(|(n, error)| Level { step: step(n), error })
                    .collect();
                // An end is known to the last of the motion only.
                let judge = self.judge.clone().with_floor(10.0 * self.speed).unwrap_or_else(|_| self.judge.clone());
                rates.push((format!("{}: {field}", ends.scene.name), judge.judge(&levels, ORDER)));
            }
        }
        rates
    }

    fn levels(&self, ends: &[Ends<'_>]) -> Vec<LevelErrors> {
        let level = |k: usize| {
            let errors = ends.iter().flat_map(|ends| {
                FIELDS.map(|field| (format!("{}: {field}", ends.scene.name), ends.levels[k].value(field)))
            });
            LevelErrors { parameters: vec![("elements".to_owned(), self.elements[k] as f64)], errors: errors.collect() }
        };
        (0..self.elements.len()).map(level).collect()
    }

    fn table(&self, ends: &[Ends<'_>]) -> Table {
        let row = |ends: &Ends<'_>| {
            vec![
                ends.scene.name.clone(),
                contact_of(ends.finest("contact")).map_or("?", name_of).to_owned(),
                decimals(ends.finest("u_tip"), 10),
                decimals(ends.extrapolated("u_tip", &self.elements), 10),
                decimals(ends.finest("exact_u_tip"), 10),
                decimals(ends.extrapolated("phi_tip", &self.elements), 10),
                decimals(ends.finest("exact_phi_tip"), 10),
                format!("{:.0}", ends.finest("t_rest")),
            ]
        };
        Table {
            title: format!(
                "Ends of long runs ({} elements, and extrapolated) and exact steady states",
                self.elements.last().unwrap_or(&0)
            ),
            head: ["scene", "at rest", "u(1)", "extrapolated", "exact", "φ(1) extrapolated", "exact", "at rest by t"]
                .map(String::from)
                .to_vec(),
            rows: ends.iter().map(row).collect(),
        }
    }

    fn figure(&self, ends: &[Ends<'_>], rates: &[(String, RateVerdict)]) -> Figure {
        let bent = ends.iter().filter(|ends| !ends.is_straight());
        let series = bent.map(|ends| {
            let points: Vec<(f64, f64)> =
                self.elements.iter().zip(ends.errors("φ")).map(|(n, error)| (1.0 / *n as f64, error)).collect();
            let name = format!("{}: φ", ends.scene.name);
            let fitted = rates.iter().find(|(rate, _)| *rate == name).and_then(|(_, rate)| rate.fitted);
            let fit = fitted.map(|rate| through_the_last(&points, rate));
            ErrorSeries { label: ends.scene.name.clone(), points, fit, ..ErrorSeries::default() }
        });
        Figure {
            file: format!("{}-errors.svg", self.header.id),
            caption: "Largest error of φ at the nodes of beams at rest, against exact steady states.".into(),
            svg: convergence(&Convergence {
                y_label: "largest error of φ (dimensionless)".into(),
                series: series.collect(),
                slopes: vec![ORDER],
                ..Convergence::in_space()
            }),
        }
    }
}

fn summary(ends: &[Ends<'_>]) -> String {
    format!("{} long runs end in exact steady states, the farthest {:.1e} away", ends.len(), worst(ends))
}

/// The largest error of all ends at the finest mesh.
fn worst(ends: &[Ends<'_>]) -> f64 {
    ends.iter().map(|ends| max_or_nan(ends.finest("u"), ends.finest("φ"))).fold(0.0, max_or_nan)
}

fn through_the_last(points: &[(f64, f64)], rate: f64) -> PowerLaw {
    let (h, error) = points.last().copied().unwrap_or((f64::NAN, f64::NAN));
    PowerLaw { rate, constant: error / h.powf(rate) }
}

fn quantities(ends: &[Ends<'_>]) -> Vec<Quantity> {
    let bent = ends.iter().filter(|ends| !ends.is_straight());
    bent.flat_map(|ends| {
        let guard = |name: &str, tolerance| Quantity {
            name: format!("{}: {name}", ends.scene.name),
            value: ends.finest(name),
            tolerance,
        };
        [guard("u_tip", 1e-8), guard("phi_tip", 1e-8), guard("exact_u_tip", 1e-9), guard("exact_phi_tip", 1e-9)]
    })
    .collect()
}
