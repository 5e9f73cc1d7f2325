//! The cases of a sweep run together wherever possible, and their lines do not show it.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Duration;

use thermobeam_study::sweep::{self, CaseLine, Journal, Manifest, Sweep, SweepShare};

const BASE: &str = "[obstacles]\nepsilon = 1e-3\ng1 = -0.05\ng2 = 0.05\n\
    [initial]\nu_t = \"x\"\n[mesh]\nelements = 7\n[time]\ndt = 0.1\nt_end = 50.0\n";

/// Cold and heated beams on two meshes with two steps; at dt = 10 the operator of a beam beyond
/// buckling is not definite.
const GRID: &str = "[sweep]\nscene = \"base.toml\"\n[grid]\nmesh.elements = [7, 8]\nbeam.a = [0.0, 0.5]\n\
    time.dt = [0.5, 10.0, 13.0]\ntime.t_end = [50.0, 13.0]\nbeam.beta = [-0.8, 0.0, 1.0, 2.0, 3.0]\n";

fn sweep(folder: &std::path::Path) -> Sweep {
    std::fs::write(folder.join("base.toml"), BASE).unwrap();
    std::fs::write(folder.join("sweep.toml"), GRID).unwrap();
    Sweep::read(folder.join("sweep.toml")).unwrap()
}

fn all(sweep: &Sweep, jobs: usize, limit: Option<Duration>) -> BTreeMap<usize, CaseLine> {
    let lines = Mutex::new(BTreeMap::new());
    let cases: Vec<usize> = (0..sweep.cases()).collect();
    sweep::run(sweep, &cases, jobs, limit, |line| {
        assert!(
            lines.lock().unwrap().insert(line.case, line).is_none(),
            "a case came twice"
        );
        Ok(())
    })
    .unwrap();
    lines.into_inner().unwrap()
}

/// With a limit each case runs on its own.
const HOUR: Option<Duration> = Some(Duration::from_secs(3600));

#[test]
fn a_case_has_the_same_line_alone_and_side_by_side_with_others() {
    let folder = tempfile::tempdir().unwrap();
    let sweep = sweep(folder.path());
    let alone = all(&sweep, 1, HOUR);
    let with = |piece: &str| {
        alone
            .values()
            .filter(|line| line.json.contains(piece))
            .count()
    };
    assert_eq!(
        (
            sweep.cases(),
            with("\"done\""),
            with("\"kind\":\"indefinite\""),
            with("time.dt: found")
        ),
        (120, 72, 8, 40)
    );
    assert_eq!(
        (with("\"heated\":true"), with("\"heated\":false")),
        (40, 40)
    );
    for jobs in [1, 3] {
        assert_eq!(all(&sweep, jobs, None), alone, "{jobs} threads");
    }
    assert_eq!(all(&sweep, 3, HOUR), alone);
}

#[test]
fn an_error_of_who_takes_the_lines_ends_the_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let sweep = sweep(folder.path());
    let cases: Vec<usize> = (0..sweep.cases()).collect();
    let count = Mutex::new(0);
    let ended = sweep::run(&sweep, &cases, 1, None, |_| {
        *count.lock().unwrap() += 1;
        Err(std::io::Error::other("full"))
    });
    assert_eq!(
        (ended.unwrap_err().to_string(), *count.lock().unwrap()),
        ("full".to_owned(), 1)
    );
}

/// A small sweep, and the lines of its cases.
fn small(folder: &std::path::Path) -> (Sweep, Vec<String>) {
    std::fs::write(folder.join("base.toml"), BASE).unwrap();
    let grid =
        "[sweep]\nscene = \"base.toml\"\n[grid]\nbeam.beta = [0.0, 1.0, 2.0]\ntime.t_end = [0.1]\n";
    std::fs::write(folder.join("sweep.toml"), grid).unwrap();
    let sweep = Sweep::read(folder.join("sweep.toml")).unwrap();
    let lines = all(&sweep, 1, HOUR)
        .into_values()
        .map(|line| line.json + "\n")
        .collect();
    (sweep, lines)
}

#[test]
fn a_line_that_was_changed_is_refused_on_resume_and_on_merging() {
    let folder = tempfile::tempdir().unwrap();
    let (sweep, lines) = small(folder.path());
    let share = folder.path().join("share");
    let open = |journal: &str| {
        let _ = std::fs::remove_dir_all(&share);
        std::fs::create_dir(&share).unwrap();
        let manifest = serde_json::to_string(&Manifest::new(&sweep, SweepShare::ALL)).unwrap();
        std::fs::write(share.join("sweep.json"), manifest).unwrap();
        std::fs::write(share.join("journal.jsonl"), journal).unwrap();
        Journal::open(&share, &sweep, SweepShare::ALL, true)
            .map(|journal| (0..3).filter(|&case| journal.has(case)).count())
    };
    assert_eq!(open(&lines[..2].concat()).unwrap(), 2);
    let altered = |from: &str, to: &str| {
        let line = lines[1].replacen(from, to, 1);
        assert_ne!(line, lines[1], "{from}");
        lines[0].clone() + &line
    };
    for (from, to) in [
        ("\"case\":1", "\"case\":2"),
        ("\"beam.beta\":1.0", "\"beam.beta\":1.5"),
        ("\"steps\":1", "\"steps\":2"),
        ("\"status\":\"done\"", "\"status\":\"failed\""),
        ("\"hash\":\"", "\"hash\":\"0"),
    ] {
        let refused = open(&altered(from, to)).unwrap_err().to_string();
        let expected = format!(
            "{}:2: expected the hash ",
            share.join("journal.jsonl").display()
        );
        assert!(refused.starts_with(&expected), "{from}: {refused}");
        let out = folder.path().join("merged.jsonl");
        let merged = sweep::merge(std::slice::from_ref(&share), &out)
            .unwrap_err()
            .to_string();
        assert!(merged.starts_with(&expected) && !out.exists(), "{merged}");
    }
}

#[test]
fn a_whole_line_of_another_sweep_or_share_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (sweep, lines) = small(folder.path());
    let other = tempfile::tempdir().unwrap();
    std::fs::write(other.path().join("base.toml"), BASE).unwrap();
    let text = std::fs::read_to_string(folder.path().join("sweep.toml"))
        .unwrap()
        .replace("[0.0, 1.0, 2.0]", "[0.0, 1.5]");
    std::fs::write(other.path().join("sweep.toml"), text).unwrap();
    let foreign = all(
        &Sweep::read(other.path().join("sweep.toml")).unwrap(),
        1,
        HOUR,
    )[&1]
        .json
        .clone()
        + "\n";
    let half: SweepShare = "1/2".parse().unwrap();
    let not_held = (0..3)
        .find(|&case| !half.holds(sweep.case(case).hash()))
        .unwrap();
    for (share, line, words) in [
        (
            SweepShare::ALL,
            &foreign,
            ":1: expected a line that begins with {\"case\":1,\"status\":\"done\",\"parameters\":{",
        ),
        (
            half,
            &lines[not_held],
            ":1: expected a case of the share 1/2, found ",
        ),
    ] {
        let place = folder
            .path()
            .join(format!("share-{}", share.to_string().replace('/', "-of-")));
        std::fs::create_dir(&place).unwrap();
        let manifest = serde_json::to_string(&Manifest::new(&sweep, share)).unwrap();
        std::fs::write(place.join("sweep.json"), manifest).unwrap();
        std::fs::write(place.join("journal.jsonl"), line).unwrap();
        let refused = Journal::open(&place, &sweep, share, true)
            .unwrap_err()
            .to_string();
        assert!(refused.contains(words), "{refused}");
    }
}

/// Scenes of any order: a case with a first step above its largest has no scene, one without
/// iterations fails.
const ANY_ORDER: [&str; 2] = [
    "[obstacles]\n[initial]\nu_t = \"20*x*(x-1)^2\"\n[mesh]\ndegree = 8\n\
     [time]\nscheme = \"dg\"\ndt = 0.02\nrestart_dt = 0.01\nt_end = 0.3\n",
    "[sweep]\nscene = \"base.toml\"\n[grid]\nmesh.degree = [6, 8]\ntime.dt = [0.02, 0.013]\n\
     time.max_iterations = [100, 1]\ntime.degree = [1, 3]\ntime.restart_dt = [0.01, 0.015]\n",
];

#[test]
fn scenes_of_any_order_have_the_same_lines_for_any_threads_shares_and_interruptions() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("base.toml", ANY_ORDER[0]);
    write("sweep.toml", ANY_ORDER[1]);
    // With dt = 0.013, cases with restart_dt = 0.015 have no scene; a sweep refuses only values
    // that no case can have.
    let sweep = Sweep::read(folder.path().join("sweep.toml")).unwrap();
    let alone = all(&sweep, 1, HOUR);
    let with = |piece: &str| {
        alone
            .values()
            .filter(|line| line.json.contains(piece))
            .count()
    };
    assert_eq!(
        (sweep.cases(), with("time.restart_dt: found 0.015")),
        (32, 8)
    );
    assert_eq!(with("\"scheme\":\"dg\""), 24);
    assert!(
        with("\"done\"") >= 12 && with("\"failure\"") > 0,
        "{alone:?}"
    );
    assert_eq!(
        (with("wall_seconds"), with("\"events\":[{")),
        (0, with("\"done\""))
    );
    for jobs in [1, 3] {
        assert_eq!(all(&sweep, jobs, None), alone, "{jobs} threads");
    }
    assert_eq!(all(&sweep, 2, HOUR), alone);
    // Each case belongs to one share; a journal with half the lines is continued, and refused if a
    // line is altered.
    let shares: Vec<SweepShare> = ["1/2", "2/2"].map(|share| share.parse().unwrap()).into();
    let held = |case: usize| {
        shares
            .iter()
            .filter(|share| share.holds(sweep.case(case).hash()))
            .count()
    };
    assert!((0..sweep.cases()).all(|case| held(case) == 1));
    let share = folder.path().join("out");
    let resumed = |lines: String| {
        let _ = std::fs::remove_dir_all(&share);
        std::fs::create_dir(&share).unwrap();
        let manifest = serde_json::to_string(&Manifest::new(&sweep, SweepShare::ALL)).unwrap();
        std::fs::write(share.join("sweep.json"), manifest).unwrap();
        std::fs::write(share.join("journal.jsonl"), lines).unwrap();
        Journal::open(&share, &sweep, SweepShare::ALL, true)
            .map(|journal| (0..32).filter(|&case| journal.has(case)).count())
    };
    let half: String = alone
        .values()
        .take(16)
        .map(|line| line.json.clone() + "\n")
        .collect();
    assert_eq!(resumed(half.clone()).unwrap(), 16);
    assert!(resumed(half.replacen("\"u_tip\":", "\"u_tip\":1", 1)).is_err());
}

#[test]
fn keys_of_the_other_scheme_are_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |base: &str, grid: &str| {
        std::fs::write(folder.path().join("base.toml"), base).unwrap();
        let text = format!("[sweep]\nscene = \"base.toml\"\n[grid]\n{grid}\n");
        std::fs::write(folder.path().join("sweep.toml"), text).unwrap();
        Sweep::read(folder.path().join("sweep.toml"))
            .unwrap_err()
            .to_string()
    };
    for (grid, message) in [
        ("mesh.degree = [1, 2]", "mesh.degree"),
        ("time.growth = [1.0, 1.5]", "time"),
    ] {
        let error = refused(BASE, grid);
        assert!(
            error.contains("sweep.toml:4") && error.contains(message),
            "{error}"
        );
    }
    for grid in [
        "mesh.degree = [0, 2]",
        "mesh.degree = [4, 41]",
        "time.degree = [6]",
        "time.growth = [0.5]",
    ] {
        let error = refused(ANY_ORDER[0], grid);
        assert!(error.contains("sweep.toml:4"), "{error}");
    }
}

#[test]
fn a_drawn_largest_step_of_any_order_need_not_divide_the_time() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("base.toml"), ANY_ORDER[0]).unwrap();
    let latin = "[sweep]\nscene = \"base.toml\"\n[latin]\nsamples = 5\nseed = 1\ntime.dt = { from = 0.01, to = 0.02 }\n\
        mesh.degree = { from = 4, to = 9 }\n";
    std::fs::write(folder.path().join("sweep.toml"), latin).unwrap();
    let sweep = Sweep::read(folder.path().join("sweep.toml")).unwrap();
    let drawn = |case: usize| {
        sweep
            .case(case)
            .parameters()
            .find(|(key, _)| key.name == "dt")
            .expect("dt")
            .1
    };
    assert!((0..5).any(|case| (0.3 / drawn(case)).fract() > 0.01));
    assert!(all(&sweep, 2, None).values().all(|line| line.passed));
}
