//! The cases of a sweep run together wherever possible, and their lines do not show it.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Duration;

use convergence_study::internal::store::content_hash;
use thermobeam_study::sweep::{self, CaseLine, Header, RESULTS, ShareFile, Sweep, SweepShare};

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
    let cases: Vec<usize> = (0..sweep.cases).collect();
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
            sweep.cases,
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
    let cases: Vec<usize> = (0..sweep.cases).collect();
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

/// The file of a share with these lines below its first one.
fn share_file(folder: &std::path::Path, header: &str, lines: &str) {
    let _ = std::fs::remove_dir_all(folder);
    std::fs::create_dir(folder).unwrap();
    std::fs::write(folder.join(RESULTS), format!("{header}\n{lines}")).unwrap();
}

#[test]
fn a_share_goes_on_with_the_cases_that_have_no_line() {
    let folder = tempfile::tempdir().unwrap();
    let (sweep, lines) = small(folder.path());
    let header = Header::new(&sweep, SweepShare::ALL).line();
    let place = folder.path().join("share");
    let text = format!("{header}\n{}", lines.concat());
    for end in 0..=text.len() {
        share_file(&place, "", "");
        std::fs::write(place.join(RESULTS), &text[..end]).unwrap();
        let share = ShareFile::open(&place, &sweep, SweepShare::ALL).unwrap();
        let done = text[..end].matches('\n').count().saturating_sub(1);
        assert_eq!((share.done, share.failed), (done, 0), "{end}");
        assert!(share.pending.into_iter().eq(done..3), "{end}");
        let kept = std::fs::read_to_string(place.join(RESULTS)).unwrap();
        assert_eq!(
            kept,
            format!("{header}\n{}", lines[..done].concat()),
            "{end}"
        );
    }
}

#[test]
fn what_is_no_part_of_the_share_is_refused_with_its_line_and_left_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let (sweep, lines) = small(folder.path());
    let header = |share: &str| Header::new(&sweep, share.parse().unwrap()).line();
    let all = header("1/1");
    let (hash, cases) = (&all[9..25], "\"cases\":3");
    let other_hash = all.replace(hash, "0123456789abcdef");
    let again = "; remove it with those below it, and run the share again";
    let place = folder.path().join("share");
    for (first, below, line, expected, found) in [
        (&other_hash, String::new(), 1, &*all, &*other_hash),
        (&header("1/2"), String::new(), 1, &all, &header("1/2")),
        (
            &all.replace(cases, "\"cases\":4"),
            String::new(),
            1,
            &all,
            "\"cases\":4",
        ),
        (
            &lines[0].trim_end().to_owned(),
            String::new(),
            1,
            "the first line",
            "another line",
        ),
        (
            &all,
            lines[0].clone() + &lines[2],
            3,
            "the line of case 1",
            "that of case 2",
        ),
        (
            &all,
            lines[0].repeat(2),
            3,
            "the line of case 1",
            "that of case 0",
        ),
        (
            &all,
            lines[0].replace("\"case\":0", "\"case\":7"),
            2,
            "the line of case 0",
            "that of case 7",
        ),
        (
            &all,
            lines[0].replace("\"case\":0", "\"case\":x"),
            2,
            "the line of case 0",
            "another: ",
        ),
        (
            &all,
            lines.concat() + &lines[2],
            5,
            "the end of the file",
            "another line",
        ),
    ] {
        share_file(&place, first, &below);
        let before = std::fs::read(place.join(RESULTS)).unwrap();
        let refused = ShareFile::open(&place, &sweep, SweepShare::ALL)
            .unwrap_err()
            .to_string();
        let start = format!(
            "{}:{line}: expected {expected}",
            place.join(RESULTS).display()
        );
        assert!(
            refused.starts_with(&start) && refused.contains(found),
            "{refused}"
        );
        assert_eq!(
            refused.ends_with(again),
            expected.starts_with("the line of"),
            "{refused}"
        );
        assert_eq!(
            std::fs::read(place.join(RESULTS)).unwrap(),
            before,
            "{refused}"
        );
    }
    // Another text without a newline is no torn first line.
    share_file(&place, "", "");
    std::fs::write(place.join(RESULTS), "notes").unwrap();
    let refused = ShareFile::open(&place, &sweep, SweepShare::ALL)
        .unwrap_err()
        .to_string();
    assert!(
        refused.contains("results.jsonl:1: expected the first line of a sweep"),
        "{refused}"
    );
    assert_eq!(
        std::fs::read_to_string(place.join(RESULTS)).unwrap(),
        "notes"
    );
}

#[test]
fn the_hash_is_that_of_sweep_scene_and_version() {
    let folder = tempfile::tempdir().unwrap();
    let (sweep, _) = small(folder.path());
    let text = std::fs::read_to_string(folder.path().join("sweep.toml")).unwrap();
    let hashed = format!("{}\0{text}\0{BASE}", env!("CARGO_PKG_VERSION"));
    let hash = content_hash(hashed.as_bytes());
    // Computed by an independent program; shares of one sweep depend on it.
    assert_eq!(content_hash(b""), 0xC381_7C01_6BA4_FF30);
    let parameters = content_hash(b"{\"beam.beta\":0.5}");
    assert_eq!(parameters, 0xC5F6_866D_E049_E3BB);
    assert_eq!(sweep.hash, hash);
    std::fs::write(folder.path().join("base.toml"), format!("{BASE}\n")).unwrap();
    let other = Sweep::read(folder.path().join("sweep.toml")).unwrap();
    assert_ne!(other.hash, hash);
}

#[test]
fn a_list_takes_the_numbers_of_its_keys_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("base.toml"), BASE).unwrap();
    let read = |list: &str| {
        let text = format!("[sweep]\nscene = \"base.toml\"\n[list]\n{list}");
        std::fs::write(folder.path().join("sweep.toml"), text).unwrap();
        Sweep::read(folder.path().join("sweep.toml"))
    };
    let sweep = read(
        "time.t_end = [0.6, 0.9, 0.6]\ntime.dt = [0.2, 0.3, 0.1]\n\
        beam.beta = { from = 0, to = 1, count = 3 }\n",
    )
    .unwrap();
    let value = |axis: usize, case| sweep.axes[axis].value(case);
    let cases: Vec<_> = (0..sweep.cases)
        .map(|case| [0, 1, 2].map(|axis| value(axis, case)))
        .collect();
    // In the order of the file.
    assert_eq!(sweep.axes[0].path, "time.t_end");
    assert_eq!(cases, [[0.6, 0.2, 0.0], [0.9, 0.3, 0.5], [0.6, 0.1, 1.0]]);
    assert!(all(&sweep, 1, None).values().all(|line| line.passed));
    for (list, words) in [
        (
            "time.dt = [0.1, 0.2]\ntime.t_end = [1.0, 0.5]\n",
            "sweep.toml:4:17: list.time.dt[1]: time.dt: found 0.2",
        ),
        (
            "time.dt = [0.1, 0.2]\nbeam.beta = [0.0]\n",
            "list.beam.beta[0]: found 1 numbers of beam.beta; expected 2, as many as of time.dt",
        ),
    ] {
        let refused = read(list).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
    }
}

#[test]
fn every_combination_of_a_grid_comes_once_and_the_last_key_runs_fastest() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("base.toml"), BASE).unwrap();
    let text = "[sweep]\nscene = \"base.toml\"\n[grid]\nmesh.elements = [4, 5]\nbeam.beta = [0.0, 1.0, 2.0]\n";
    std::fs::write(folder.path().join("sweep.toml"), text).unwrap();
    let sweep = Sweep::read(folder.path().join("sweep.toml")).unwrap();
    let cases: Vec<_> = (0..sweep.cases)
        .map(|case| [0, 1].map(|axis: usize| sweep.axes[axis].value(case)))
        .collect();
    assert_eq!(
        cases,
        [
            [4.0, 0.0],
            [4.0, 1.0],
            [4.0, 2.0],
            [5.0, 0.0],
            [5.0, 1.0],
            [5.0, 2.0]
        ]
    );
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
    assert_eq!((sweep.cases, with("time.restart_dt: found 0.015")), (32, 8));
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
    // A file with half the lines is gone on with.
    let place = folder.path().join("out");
    let half: String = alone
        .values()
        .take(16)
        .map(|line| line.json.clone() + "\n")
        .collect();
    share_file(&place, &Header::new(&sweep, SweepShare::ALL).line(), &half);
    let share = ShareFile::open(&place, &sweep, SweepShare::ALL).unwrap();
    assert!(share.pending.into_iter().eq(16..32));
    let failed = |line: &&CaseLine| !line.passed;
    assert_eq!(share.failed, alone.values().take(16).filter(failed).count());
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
