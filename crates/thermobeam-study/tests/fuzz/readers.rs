//! The readers of files, each used as in the commands, and the files that they read.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use convergence_study::rates::{Choice, RateTable};
use convergence_study::{Claim, Document, Floor, TestRun};
use tempfile::TempDir;
use thermobeam::dg::Dg;
use thermobeam_study::run::RunError;
use thermobeam_study::run::simulate::Simulator;
use thermobeam_study::scene::{Method, Scene};
use thermobeam_study::sweep::{self, Header, RESULTS, ShareFile, Sweep, SweepShare};

use crate::read_study;

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Reading {
    Scene,
    Study,
    Sweep,
    Rates,
    Baseline,
    /// The lines of a sweep.
    Results,
    /// No reader at all, to check that a panic is noticed.
    Panic,
}

impl Reading {
    pub(crate) const ALL: [Self; 6] = [
        Self::Scene,
        Self::Study,
        Self::Sweep,
        Self::Rates,
        Self::Baseline,
        Self::Results,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Study => "study",
            Self::Sweep => "sweep",
            Self::Rates => "rates",
            Self::Baseline => "baseline",
            Self::Results => "results",
            Self::Panic => "panic",
        }
    }
}

fn studies() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies")
}

/// The TOML files of a folder, in the order of their names.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    paths
}

fn texts(folder: &Path) -> Vec<String> {
    let texts = files(folder).into_iter().map(fs::read_to_string);
    texts.map(|text| text.expect("a file")).collect()
}

const SWEEPS: [&str; 2] = [
    "[sweep]\nscene = \"scenes/paper-1-beta-0.toml\"\n[set]\ntime.t_end = 1.0\ninitial.theta = \"{beam.theta_a}*(1-x)\"\n\
     [grid]\nbeam.beta = [-0.5, 0.0, 5.0]\nbeam.theta_a = { from = 0.0, to = 20.0, count = 5 }\n\
     obstacles.epsilon = { from = 1e-4, to = 1e-2, count = 3, scale = \"log\" }\n",
    "[sweep]\nscene = \"scenes/paper-1-beta-0.toml\"\n[list]\n\
     beam.beta = { from = -0.5, to = 5.0, count = 3 }\nmesh.elements = [20, 50, 200]\n",
];

const TABLES: [&str; 2] = [
    "# of another code\nh,     L2,      H1\n0.1,   1.0e-3,  2.1e-2\n0.05,  2.5e-4,  1.0e-2\n0.025, 6.2e-5,  5.2e-3\n",
    "dt;\"error\"\n1;NaN\n0.5;inf\n0.25;1e-3\n0.125;5e-4\n0.0625;2.5e-4\n",
];

/// A sweep of two cases, whose folder is damaged.
const SMALL: &str = "[sweep]\nscene = \"scenes/paper-1-beta-0.toml\"\n[set]\ntime.dt = 0.1\ntime.t_end = 0.2\n\
    [grid]\nbeam.beta = [0.0, 5.0]\n";

/// Every file with its kind; kinds with few files appear several times.
pub(crate) fn seeds() -> Vec<(Reading, String)> {
    let of =
        |reading: Reading, texts: Vec<String>| texts.into_iter().map(move |text| (reading, text));
    let several = |texts: &[&str]| {
        texts
            .iter()
            .cycle()
            .take(8)
            .map(|text| (*text).to_owned())
            .collect::<Vec<_>>()
    };
    let sweeps = texts(&studies().join("cluster"))
        .into_iter()
        .map(|text| text.replace("../scenes", "scenes"))
        .collect();
    let baseline = fs::read_to_string(studies().join("baseline.json")).expect("the baseline");
    // A part of it, since a single damage in a hundred thousand lines would rarely hit a number.
    let mut small: serde_json::Value = serde_json::from_str(&baseline).expect("JSON");
    let blessed = small["studies"].as_object_mut().expect("studies");
    let first = blessed.keys().next().expect("a study").clone();
    blessed.retain(|id, _| *id == first);
    let small = serde_json::to_string_pretty(&small).expect("JSON");
    of(Reading::Scene, texts(&studies().join("scenes")))
        .chain(of(Reading::Study, texts(&studies())))
        .chain(of(Reading::Sweep, sweeps))
        .chain(of(Reading::Sweep, several(&SWEEPS)))
        .chain(of(Reading::Rates, several(&TABLES)))
        .chain(of(
            Reading::Baseline,
            vec![baseline, small.clone(), small.clone(), small],
        ))
        .chain(of(Reading::Results, several(&[&Bench::new().results()])))
        .collect()
}

/// A folder in which one file at a time is read.
pub(crate) struct Bench {
    folder: TempDir,
}

impl Bench {
    /// Creates it with the scenes that studies and sweeps name.
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("scenes")).expect("a folder");
        // Studies also refer to each other's solutions.
        for path in files(&studies().join("scenes"))
            .iter()
            .chain(&files(&studies()))
        {
            let inside = path.strip_prefix(studies()).expect("a file below");
            fs::copy(path, folder.path().join(inside)).expect("a copy");
        }
        fs::write(folder.path().join("small.toml"), SMALL).expect("a sweep");
        Self { folder }
    }

    /// Path of the damaged file.
    pub(crate) fn path(&self) -> PathBuf {
        self.folder.path().join("damaged")
    }

    fn share(&self) -> PathBuf {
        self.folder.path().join("share")
    }

    fn small(&self) -> Sweep {
        Sweep::read(self.folder.path().join("small.toml")).expect("a sweep")
    }

    /// The first line and those of two cases.
    fn results(&self) -> String {
        let header = Header::new(&self.small(), SweepShare::ALL).line();
        let mut lines = (header + "\n").into_bytes();
        // With a limit, cases run one after the other.
        let limit = Some(std::time::Duration::from_secs(60));
        sweep::run(&self.small(), &[0, 1], 1, limit, &mut lines, |_, _| ()).expect("two lines");
        String::from_utf8(lines).expect("a text")
    }

    /// Reads it as the command does; returns the message of a refusal.
    pub(crate) fn read(&self, reading: Reading, bytes: &[u8]) -> Result<(), String> {
        fs::write(self.path(), bytes).expect("a writable folder");
        let read = self.read_file(reading, bytes);
        read.map_err(|error| error.to_string())
    }

    fn read_file(&self, reading: Reading, bytes: &[u8]) -> Result<(), Box<dyn Error>> {
        let path = self.path();
        let name = path.to_string_lossy();
        match reading {
            Reading::Scene => {
                let scene = Scene::read(&path)?;
                let set_up = match scene.method {
                    Method::OneStep(_) => Simulator::new(&scene).map(drop),
                    Method::Dg(stepping) => Dg::new(scene.dg_problem(), stepping)
                        .map(drop)
                        .map_err(RunError::from),
                };
                set_up.map_err(|error| format!("{name}: {error}"))?;
            }
            Reading::Study => drop(read_study(&path)?.plan().cases()),
            Reading::Sweep => {
                let sweep = Sweep::read(&path)?;
                let _ = sweep.scene(sweep.cases - 1);
            }
            Reading::Rates => {
                let text = Document::text_of_file(&path)?;
                let tables = RateTable::parse_all_with(&text, &name, &Choice::default())?;
                for column in tables.iter().flat_map(|table| &table.columns) {
                    drop(column.judge(&Claim::new(1.0, 0.05), Floor::NONE));
                }
            }
            Reading::Baseline => drop(TestRun::guarded(&path)?),
            Reading::Results => self.resumed(bytes)?,
            Reading::Panic => panic!("as it was asked to"),
        }
        Ok(())
    }

    /// Joins a sweep whose folder holds this file, and goes on with it.
    fn resumed(&self, results: &[u8]) -> Result<(), Box<dyn Error>> {
        let (share, joined) = (self.share(), self.folder.path().join("joined"));
        let _ = [&share, &joined].map(fs::remove_dir_all);
        fs::create_dir(&share).expect("a folder");
        fs::write(share.join(RESULTS), results).expect("a file");
        let merged = sweep::merge(std::slice::from_ref(&share), &joined);
        let opened = ShareFile::open(&share, &self.small(), SweepShare::ALL);
        merged?;
        opened?;
        Ok(())
    }

    /// Does a refusal begin with the name of a file that was read, and describe a problem in it?
    pub(crate) fn is_located(&self, message: &str) -> Result<(), String> {
        let folder = self.folder.path().display().to_string();
        // A file of the folder, or one that the input names by its full path.
        let is_file = |place: &str| {
            place.starts_with(&folder) || (place.starts_with('/') && Path::new(place).exists())
        };
        let said = message
            .split_once(": ")
            .is_some_and(|(place, said)| is_file(place) && !said.is_empty());
        // Control characters could have any effect on a terminal.
        let plain = message.chars().all(|c| c == '\n' || !c.is_control());
        match (said, plain) {
            (true, true) => Ok(()),
            (false, _) => Err(format!("no place: {message:?}")),
            (_, false) => Err(format!("control characters: {message:?}")),
        }
    }
}
