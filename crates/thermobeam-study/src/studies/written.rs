//! What a run writes is what was computed: the files of `run --out` and the lines of `sweep`, held
//! against levels that the library has stepped.
//!
//! * Every column of `history.csv`, at each of its times, and the last time; the contact force by
//!   the formula of the scheme from the tips of two levels.
//! * The balance of the energy (3.9) from the columns alone: the terms of each row add up to zero,
//!   and their changes to the change of the energy.
//! * The phases of contact against the tips; the counts and the end of `run.json`, and of each line
//!   of a sweep whose scenes run together.
//!
//! The scenes have contact and heat. One has more levels than rows, and the stride from row to row
//! does not divide their number. In another one a step crosses both obstacles.

mod stepped;

use super::prelude::*;
use crate::error::reference::largest_difference;
use crate::run::history::RunHistory;
use crate::run::object::Object;
use crate::run::simulate::{Recording, Run, Simulator};
use crate::scene::{Method, Scene};
use crate::sweep::{self, Sweep};
use convergence_study::InputError;
use serde_json::Value;
use std::io::BufRead;
use stepped::stepped;

/// What the study says about itself.
pub const ABOUT: About = About {
    id: "written-files",
    claim: "What a run and a sweep write is what was computed: every column, the last time, the balance, phases, counts",
    tier: Tier::Quick,
    group: "the harness",
    home: file!(),
};

const COLUMN: &str = "largest difference of a column";

/// The beam of (5.1) with a hot end, bent down and thrown upwards, between its obstacles.
const BEAM: &str = "beam = { zeta = 0.1, a = 0.5, rho = 1.0, beta = -0.3, theta_a = 2.0 }
initial = { u = \"0.01*x*(x-2)\", u_t = \"20*x*(x-1)^2\", theta = \"2*(1-x) + sin(pi*x)\" }
";
const OBSTACLES: &str = "obstacles = { epsilon = 1e-3, g1 = -0.01, g2 = 0.1 }\n";
/// A swing through soft obstacles that are close to each other: a step crosses both.
const ACROSS: &str = "beam = { zeta = 1e-3, a = 0.5, rho = 1.0, beta = 0.0, theta_a = 2.0 }
initial = { u_t = \"3*x\", theta = \"2*(1-x)\" }
obstacles = { epsilon = 0.5, g1 = -2e-3, g2 = 1e-3 }
";

/// Meshes and steps of the scenes, by their names.
const METHODS: [(&str, &str, &str); 4] = [
    (
        "more levels than rows",
        OBSTACLES,
        "mesh = { elements = 3 }\ntime = { dt = 1e-4, t_end = 2.0001, tolerance = 1e-13 }",
    ),
    (
        "the midpoint rule",
        OBSTACLES,
        "mesh = { elements = 12 }\ntime = { scheme = \"midpoint\", dt = 1e-3, t_end = 1.5, tolerance = 1e-13 }",
    ),
    (
        "any order",
        OBSTACLES,
        "mesh = { elements = 1, degree = 8 }\ntime = { scheme = \"dg\", degree = 2, dt = 0.01, restart_dt = 1e-3, growth = 1.5, t_end = 1.5 }",
    ),
    (
        "a step across both obstacles",
        "",
        "mesh = { elements = 8 }\ntime = { scheme = \"midpoint\", dt = 0.02, t_end = 6.0, tolerance = 1e-13 }",
    ),
];

/// Scenes that run together: as many steps of other lengths.
const SWEPT: [(&str, [f64; 4]); 3] = [
    ("time.dt", [1e-3, 2e-3, 1.5e-3, 1e-3]),
    ("time.t_end", [0.5, 1.0, 0.75, 0.5]),
    ("beam.beta", [-0.3, 5.0, -0.8, 0.0]),
];
const SWEPT_SCENE: &str =
    "mesh = { elements = 12 }\ntime = { dt = 1e-3, t_end = 0.5, tolerance = 1e-13 }";

/// The most rows after the first of a one-step scheme, a tenth of what `run` writes, and the rows
/// of dG.
const ROWS: usize = 20_000;
const DG_ROWS: usize = 4000;
/// Difference allowed of a number that is computed twice from the same levels, and defect of the
/// balance, relative to the largest number of its sort.
const SAME: f64 = 1e-12;
/// The columns of `history.csv`.
const COLUMNS: [&str; 14] = [
    "t",
    "u_tip",
    "phi_tip",
    "u_t_tip",
    "phi_t_tip",
    "theta_mid",
    "contact_force",
    "energy",
    "energy_change",
    "viscous",
    "thermal",
    "inertial",
    "contact_gap",
    "residual",
];
const ENERGY: usize = 7;
const CHANGE: usize = 8;
const GAP: usize = 12;

/// A row of `history.csv`, in the order of `COLUMNS`.
pub type Row = [f64; COLUMNS.len()];

/// What belongs to a run, as it was written and as it was computed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RunNumbers {
    /// The rows of the history; of a line of a sweep the last one.
    pub rows: Vec<Row>,
    /// Times in contact.
    pub phases: Vec<[f64; 2]>,
    /// Steps, steps in contact, iterations, most iterations of a step.
    pub counts: [f64; 4],
    /// Smallest and largest u(1).
    pub range: [f64; 2],
    /// Steps that cross both obstacles.
    pub across: usize,
}

/// The study.
pub fn study() -> Described<Written> {
    ABOUT.study(Written)
}

/// Runs and a sweep, and what they write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Written;

/// What is written, and what was computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The name of the scene.
    pub name: String,
    /// By the files.
    pub written: RunNumbers,
    /// By levels that are stepped here.
    pub stepped: RunNumbers,
    /// The final time that the scene asks for.
    pub t_end: f64,
}

impl Kind for Written {
    /// The place of a scene; after these, the sweep.
    type Data = usize;
    type Found = Vec<Pair>;

    fn cases(&self) -> Vec<Case<usize>> {
        let scenes = METHODS.iter().map(|(name, obstacles, method)| {
            let scene = scene(name, obstacles, method).ok();
            (*name, scene.map(|scene| Parts::of(&scene)))
        });
        let swept = Scene::parse(SWEPT_SCENE, file!()).ok();
        let swept = swept.map(|scene| Parts::of(&scene));
        let runs = scenes.chain([("a sweep", swept)]).enumerate();
        runs.map(|(place, (name, parts))| Case::new(name, 1e6, place).described(&parts))
            .collect()
    }

    fn run(&self, &place: &usize) -> Result<Vec<Pair>, CaseFailure> {
        match METHODS.get(place) {
            Some((name, obstacles, method)) => Ok(vec![of_run(name, obstacles, method)?]),
            None => of_sweep(),
        }
    }

    fn judge(&self, ran: &[Ran<usize, Vec<Pair>>]) -> Outcome {
        Outcome::of_complete(self, ran, |shown| {
            let pairs: Vec<&Pair> = shown.iter().flat_map(|(_, pairs)| *pairs).collect();
            let histories = pairs.iter().filter(|pair| !pair.is_line());
            let histories = histories.flat_map(|pair| pair.history());
            let summaries = pairs.iter().flat_map(|pair| pair.summary());
            let sheets = [
                Sheet::new("Files of runs", "scene", histories),
                Sheet::new("Runs in numbers", "run", summaries),
            ];
            Outcome::of_sheets(sheets, COLUMN)
        })
    }
}

impl Pair {
    /// A line of a sweep, which has no history.
    fn is_line(&self) -> bool {
        self.written.rows.len() == 1
    }

    /// The numbers of a history.
    fn history(&self) -> Vec<Measured> {
        let Self {
            name,
            written,
            stepped,
            ..
        } = self;
        let count = |what: &str, written: usize, stepped: usize| {
            measured(name, what, written as f64)
                .fixed(0)
                .must_be(Must::Count(stepped))
        };
        let ends = |numbers: &RunNumbers| numbers.phases.concat();
        let mut found = vec![
            count("rows", written.rows.len(), stepped.rows.len()),
            measured(name, COLUMN, largest(&written.rows, &stepped.rows))
                .must_be(Must::AtMost(SAME)),
            measured(name, "defect of the balance", defect(&written.rows))
                .must_be(Must::AtMost(SAME)),
            measured(name, "changes against the energy", lost(&written.rows))
                .must_be(Must::AtMost(10.0 * SAME)),
            count(
                "phases of contact",
                written.phases.len(),
                stepped.phases.len(),
            ),
            measured(
                name,
                "times of contact",
                largest_difference(&ends(written), &ends(stepped)),
            )
            .must_be(Must::AtMost(self.located())),
        ];
        if name == METHODS[3].0 {
            let across = measured(name, "steps across both obstacles", stepped.across as f64);
            found.push(across.fixed(0).must_be(Must::AtLeast(1.0)));
        }
        found
    }

    /// How far an end of contact may be from what the tips say: dG locates it between two rows.
    fn located(&self) -> f64 {
        if self.name == METHODS[2].0 {
            self.t_end / DG_ROWS as f64
        } else {
            SAME
        }
    }

    /// The end, the range and the counts.
    fn summary(&self) -> Vec<Measured> {
        let Self {
            name,
            written,
            stepped,
            t_end,
        } = self;
        let [end, own] = [written, stepped].map(|numbers| {
            let last = numbers.rows.last();
            last.map_or(vec![], |row| row[..=ENERGY].to_vec())
        });
        let time = Must::Near {
            answer: *t_end,
            within: SAME * t_end,
        };
        let mut found = vec![
            measured(name, "last time", end.first().copied())
                .fixed(5)
                .must_be(time),
            measured(
                name,
                "difference of the end",
                largest_difference(&end, &own),
            )
            .must_be(Must::AtMost(SAME)),
            measured(
                name,
                "difference of the range",
                largest_difference(&written.range, &stepped.range),
            )
            .must_be(Must::AtMost(SAME)),
        ];
        let names = ["steps", "steps in contact", "iterations", "most iterations"];
        for (k, what) in names.into_iter().enumerate() {
            let count = measured(name, what, written.counts[k]).fixed(0);
            found.push(count.must_be(Must::Count(stepped.counts[k] as usize)));
        }
        found
    }
}

fn column(rows: &[Row], k: usize) -> Vec<f64> {
    rows.iter().map(|row| row[k]).collect()
}

/// The largest difference of a column, relative to its largest number; of the residual, which is
/// round-off, and of the gap relative to that of the change.
fn largest(written: &[Row], stepped: &[Row]) -> Option<f64> {
    let size = |k: usize| largest_of(column(stepped, k).into_iter().map(f64::abs)).unwrap_or(0.0);
    let differences = (0..COLUMNS.len()).map(|k| {
        let scale = if k > CHANGE {
            size(k).max(size(CHANGE))
        } else {
            size(k)
        };
        largest_difference(&column(written, k), &column(stepped, k)) / scale.max(f64::MIN_POSITIVE)
    });
    largest_of(differences)
}

/// The largest sum of the terms of a row, relative to the largest energy.
fn defect(rows: &[Row]) -> Option<f64> {
    let sums = rows.iter().map(|row| row[CHANGE..=GAP].iter().sum::<f64>());
    let energy = largest_of(column(rows, ENERGY).into_iter().map(f64::abs))?;
    Some(largest_of(sums.map(f64::abs))? / energy)
}

/// How far the changes of all rows are from the change of the energy, relative to that.
fn lost(rows: &[Row]) -> Option<f64> {
    let [first, last] = [rows.first()?, rows.last()?];
    let change = last[ENERGY] - first[ENERGY];
    Some(((column(rows, CHANGE).iter().sum::<f64>() - change) / change).abs())
}

/// A run by its files, and stepped here.
fn scene(name: &str, obstacles: &str, method: &str) -> Result<Scene, InputError> {
    let beam = if obstacles.is_empty() { ACROSS } else { BEAM };
    Scene::parse(&format!("{beam}{obstacles}{method}\n"), name)
}

fn of_run(name: &str, obstacles: &str, method: &str) -> Result<Pair, CaseFailure> {
    let scene = scene(name, obstacles, method)?;
    let rows = match scene.method {
        Method::OneStep(_) => ROWS,
        Method::Dg(_) => DG_ROWS,
    };
    let run = Simulator::new(&scene)?.run(Recording::HistoryOf(rows), &mut |_, _| ());
    Ok(Pair {
        name: name.to_owned(),
        written: written(&scene, &run)?,
        stepped: stepped(&scene)?,
        t_end: scene.t_end,
    })
}

/// What the files of a run say.
fn written(scene: &Scene, run: &Run) -> Result<RunNumbers, CaseFailure> {
    let text = run.history.as_ref().map(RunHistory::csv);
    let text = text.ok_or_else(|| CaseFailure::new("the run has no history"))?;
    let object = serde_json::to_value(Object::reproducible(scene, run))?;
    let phases = run.contact_phases();
    Ok(RunNumbers {
        rows: rows(&text)?,
        phases: phases.into_iter().map(<[f64; 2]>::from).collect(),
        ..summary(&object)
    })
}

/// The rows of a file, by the names of its columns.
fn rows(text: &str) -> Result<Vec<Row>, CaseFailure> {
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    if head != COLUMNS {
        return Err(CaseFailure::new(format!("found the columns {head:?}")));
    }
    let rows = lines.map(|line| {
        let numbers: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        let row = numbers.ok().and_then(|row| row.try_into().ok());
        row.ok_or_else(|| CaseFailure::new(format!("found the row {line}")))
    });
    rows.collect()
}

/// The counts and the range in the object of a run, and its end as the only row; NaN for what it
/// lacks.
fn summary(object: &Value) -> RunNumbers {
    let mut end = [0.0; COLUMNS.len()];
    for (k, name) in COLUMNS.into_iter().enumerate().take(ENERGY + 1) {
        end[k] = number(object, &format!("/final/{name}"));
    }
    // The object has no contact force.
    end[6] = 0.0;
    let counts = [
        "/steps",
        "/contact_steps",
        "/iterations/total",
        "/iterations/max",
    ];
    let range = ["/extremes/u_tip_min", "/extremes/u_tip_max"];
    RunNumbers {
        rows: vec![end],
        counts: counts.map(|path| number(object, path)),
        range: range.map(|path| number(object, path)),
        ..RunNumbers::default()
    }
}

/// NaN, if it is not there.
fn number(object: &Value, path: &str) -> f64 {
    object
        .pointer(path)
        .and_then(Value::as_f64)
        .unwrap_or(f64::NAN)
}

/// The lines of a sweep, and its scenes stepped here.
fn of_sweep() -> Result<Vec<Pair>, CaseFailure> {
    let scene = format!("{BEAM}{OBSTACLES}{SWEPT_SCENE}\n");
    let keys = SWEPT.map(|(path, values)| (path, values.to_vec()));
    let sweep = Sweep::of_list("a sweep", &scene, keys.to_vec());
    let cases: Vec<usize> = (0..sweep.cases).collect();
    let mut lines = vec![];
    sweep::run(&sweep, &cases, 1, None, &mut lines, |_, _| ())?;
    let mut pairs = vec![];
    for (case, line) in lines.lines().enumerate() {
        let line: Value = serde_json::from_str(&line?)?;
        let scene = sweep.scene(case)?;
        let mut stepped = stepped(&scene)?;
        stepped.rows = stepped.rows.pop().into_iter().collect();
        stepped.rows.iter_mut().for_each(|row| row[6] = 0.0);
        pairs.push(Pair {
            name: format!("case {case} of a sweep"),
            written: summary(&line["result"]),
            stepped,
            t_end: SWEPT[1].1[case],
        });
    }
    Ok(pairs)
}
