//! The cases of a sweep run together wherever possible, and their lines do not show it.

use std::io::Write;
use std::path::Path;
use std::time::Duration;

use convergence_study::HashedFile;
use thermobeam_study::sweep::{self, Header, RESULTS, ShareFile, Sweep, SweepShare};

const BASE: &str = "[obstacles]\nepsilon = 1e-3\ng1 = -0.05\ng2 = 0.05\n\
    [initial]\nu_t = \"x\"\n[mesh]\nelements = 7\n[time]\ndt = 0.1\nt_end = 50.0\n";

/// Cold and heated beams on two meshes with two steps; at dt = 10 the operator of a beam beyond
/// buckling is not definite.
const GRID: &str = "[grid]\nmesh.elements = [7, 8]\nbeam.a = [0.0, 0.5]\n\
    time.dt = [0.5, 10.0, 13.0]\ntime.t_end = [50.0, 13.0]\nbeam.beta = [-0.8, 0.0, 1.0, 2.0, 3.0]\n";

/// A sweep over this scene, read from a folder.
fn read(folder: &Path, base: &str, design: &str) -> Sweep {
    std::fs::write(folder.join("base.toml"), base).unwrap();
    let text = format!("[sweep]\nscene = \"base.toml\"\n{design}");
    std::fs::write(folder.join("sweep.toml"), text).unwrap();
    Sweep::read(folder.join("sweep.toml")).unwrap()
}

fn sweep(base: &str, design: &str) -> Sweep {
    let folder = tempfile::tempdir().unwrap();
    read(folder.path(), base, design)
}

/// The lines of all cases, and how many failed.
fn all(sweep: &Sweep, jobs: usize, limit: Option<Duration>) -> (String, usize) {
    let (mut output, mut written, mut failed) = (vec![], 0, 0);
    let cases: Vec<usize> = (0..sweep.cases).collect();
    let count = |lines, failures| {
        written += lines;
        failed += failures;
    };
    sweep::run(sweep, &cases, jobs, limit, &mut output, count).unwrap();
    let lines = String::from_utf8(output).unwrap();
    assert_eq!(lines.lines().count(), written);
    assert_eq!(lines.matches("\"status\":\"failed\"").count(), failed);
    for (case, line) in lines.lines().enumerate() {
        assert!(line.starts_with(&format!("{{\"case\":{case},")), "{line}");
    }
    (lines, failed)
}

/// The numbers of the first axes, case by case.
fn values<const N: usize>(sweep: &Sweep) -> Vec<[f64; N]> {
    let of_case = |case| std::array::from_fn(|axis| sweep.axes[axis].value(case));
    (0..sweep.cases).map(of_case).collect()
}

/// With a limit each case runs on its own.
const HOUR: Option<Duration> = Some(Duration::from_secs(3600));

#[test]
fn a_case_has_the_same_line_alone_and_side_by_side_with_others() {
    let sweep = sweep(BASE, GRID);
    let alone = all(&sweep, 1, HOUR);
    let (lines, failed) = &alone;
    let counts = [
        ("\"done\"", 72),
        ("\"kind\":\"indefinite\"", 8),
        ("time.dt: found", 40),
        ("\"heated\":true", 40),
        ("\"heated\":false", 40),
    ];
    for (piece, count) in counts {
        assert_eq!(lines.matches(piece).count(), count, "{piece}");
    }
    assert_eq!((lines.lines().count(), *failed), (120, 48));
    for (jobs, limit) in [(1, None), (3, None), (3, HOUR)] {
        assert_eq!(all(&sweep, jobs, limit), alone, "{jobs} threads, {limit:?}");
    }
}

/// Takes nothing.
struct Full {
    tried: usize,
}

impl Write for Full {
    fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
        self.tried += 1;
        Err(std::io::Error::other("full"))
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn an_error_of_who_takes_the_lines_ends_the_sweep() {
    let sweep = sweep(BASE, GRID);
    let cases: Vec<usize> = (0..sweep.cases).collect();
    let mut full = Full { tried: 0 };
    let ended = sweep::run(&sweep, &cases, 1, HOUR, &mut full, |_, _| ());
    assert_eq!(ended.unwrap_err().to_string(), "full");
    assert_eq!(full.tried, 1);
}

/// The second step does not divide the time: that case fails.
const SMALL: &str = "[grid]\ntime.dt = [0.1, 0.15, 0.2]\ntime.t_end = [0.2]\n";

/// A small sweep, and the lines of its cases.
fn small() -> (Sweep, Vec<String>) {
    let sweep = sweep(BASE, SMALL);
    let (lines, _) = all(&sweep, 1, HOUR);
    let lines = lines.split_inclusive('\n').map(str::to_owned).collect();
    (sweep, lines)
}

/// The file of a share with this text.
fn share_file(folder: &Path, text: &str) {
    let _ = std::fs::remove_dir_all(folder);
    std::fs::create_dir(folder).unwrap();
    std::fs::write(folder.join(RESULTS), text).unwrap();
}

#[test]
fn a_share_goes_on_with_the_cases_that_have_no_line() {
    let folder = tempfile::tempdir().unwrap();
    let (sweep, lines) = small();
    let header = Header::new(&sweep, SweepShare::ALL).line();
    let place = folder.path().join("share");
    let text = format!("{header}\n{}", lines.concat());
    for end in 0..=text.len() {
        share_file(&place, &text[..end]);
        let share = ShareFile::open(&place, &sweep, SweepShare::ALL).unwrap();
        let done = text[..end].matches('\n').count().saturating_sub(1);
        let failed = usize::from(done >= 2);
        assert_eq!((share.done, share.failed), (done, failed), "{end}");
        assert!(share.pending.into_iter().eq(done..3), "{end}");
        let kept = std::fs::read_to_string(place.join(RESULTS)).unwrap();
        let expected = format!("{header}\n{}", lines[..done].concat());
        assert_eq!(kept, expected, "{end}");
    }
}

#[test]
fn what_is_no_part_of_the_share_is_refused_with_its_line_and_left_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let (sweep, lines) = small();
    let header = |share: &str| Header::new(&sweep, share.parse().unwrap()).line() + "\n";
    let all = header("1/1");
    let other_hash = all.replace(&all[9..25], "0123456789abcdef");
    let another_count = all.replace("\"cases\":3", "\"cases\":4");
    let case = |number: &str| lines[0].replace("\"case\":0", &format!("\"case\":{number}"));
    let place = folder.path().join("share");
    for (text, line, expected, found) in [
        (other_hash.clone(), 1, all.trim(), other_hash.trim()),
        (header("1/2"), 1, all.trim(), header("1/2").trim()),
        (another_count, 1, all.trim(), "\"cases\":4"),
        (lines[0].clone(), 1, "the first line", "another line"),
        // Another text without a newline is no torn first line.
        ("notes".to_owned(), 1, "the first line of a sweep", ""),
        (
            all.clone() + &lines[0] + &lines[2],
            3,
            "the line of case 1",
            "that of case 2",
        ),
        (
            all.clone() + &lines[0].repeat(2),
            3,
            "the line of case 1",
            "that of case 0",
        ),
        (
            all.clone() + &case("7"),
            2,
            "the line of case 0",
            "that of case 7",
        ),
        (
            all.clone() + &case("x"),
            2,
            "the line of case 0",
            "another: ",
        ),
        (
            all.clone() + &lines.concat() + &lines[2],
            5,
            "the end of the file",
            "another line",
        ),
    ] {
        share_file(&place, &text);
        let refused = ShareFile::open(&place, &sweep, SweepShare::ALL);
        let refused = refused.unwrap_err().to_string();
        let start = format!(
            "{}:{line}: expected {expected}",
            place.join(RESULTS).display()
        );
        assert!(
            refused.starts_with(&start) && refused.contains(found),
            "{refused}"
        );
        let again = "; remove it with those below it, and run the share again";
        let is_of_a_case = expected.starts_with("the line of");
        assert_eq!(refused.ends_with(again), is_of_a_case, "{refused}");
        let left = std::fs::read_to_string(place.join(RESULTS)).unwrap();
        assert_eq!(left, text, "{refused}");
    }
}

#[test]
fn the_hash_is_that_of_sweep_scene_and_version() {
    let folder = tempfile::tempdir().unwrap();
    let sweep = read(folder.path(), BASE, SMALL);
    let text = std::fs::read_to_string(folder.path().join("sweep.toml")).unwrap();
    let hashed = format!("{}\0{text}\0{BASE}", env!("CARGO_PKG_VERSION"));
    let hash_of = |content: &[u8]| HashedFile::new("", content).hash;
    assert_eq!(sweep.hash, hash_of(hashed.as_bytes()));
    // Computed by an independent program; shares of one sweep depend on it.
    assert_eq!(hash_of(b""), "c3817c016ba4ff30");
    let parameters = hash_of(b"{\"beam.beta\":0.5}");
    assert_eq!(parameters, "c5f6866de049e3bb");
    let other = read(folder.path(), &format!("{BASE}\n"), SMALL);
    assert_ne!(other.hash, sweep.hash);
}

#[test]
fn a_list_takes_the_numbers_of_its_keys_side_by_side() {
    let sweep = sweep(
        BASE,
        "[list]\ntime.t_end = [0.6, 0.9, 0.6]\ntime.dt = [0.2, 0.3, 0.1]\n\
         beam.beta = { from = 0, to = 1, count = 3 }\n",
    );
    // In the order of the file.
    assert_eq!(sweep.axes[0].path, "time.t_end");
    assert_eq!(
        values(&sweep),
        [[0.6, 0.2, 0.0], [0.9, 0.3, 0.5], [0.6, 0.1, 1.0]]
    );
    assert_eq!(all(&sweep, 1, None).1, 0);
}

#[test]
fn every_combination_of_a_grid_comes_once_and_the_last_key_runs_fastest() {
    let sweep = sweep(
        BASE,
        "[grid]\nmesh.elements = [4, 5]\nbeam.beta = [0.0, 1.0, 2.0]\n",
    );
    let expected = [4.0, 5.0].map(|n| [0.0, 1.0, 2.0].map(|beta| [n, beta]));
    assert_eq!(values(&sweep), expected.concat());
}

/// Scenes of any order: a case with a first step above its largest has no scene, one without
/// iterations fails.
const ANY_ORDER: [&str; 2] = [
    "[obstacles]\n[initial]\nu_t = \"20*x*(x-1)^2\"\n[mesh]\ndegree = 8\n\
     [time]\nscheme = \"dg\"\ndt = 0.02\nrestart_dt = 0.01\nt_end = 0.3\n",
    "[grid]\nmesh.degree = [6, 8]\ntime.dt = [0.02, 0.013]\n\
     time.max_iterations = [100, 1]\ntime.degree = [1, 3]\ntime.restart_dt = [0.01, 0.015]\n",
];

#[test]
fn scenes_of_any_order_have_the_same_lines_for_any_threads() {
    // With dt = 0.013, cases with restart_dt = 0.015 have no scene; a sweep refuses only values
    // that no case can have.
    let sweep = sweep(ANY_ORDER[0], ANY_ORDER[1]);
    let alone = all(&sweep, 1, HOUR);
    let (lines, failed) = &alone;
    let count = |piece: &str| lines.matches(piece).count();
    let done = count("\"done\"");
    for (piece, expected) in [
        ("time.restart_dt: found 0.015", 8),
        ("\"scheme\":\"dg\"", 24),
        ("wall_seconds", 0),
        ("\"events\":[{", done),
    ] {
        assert_eq!(count(piece), expected, "{piece}");
    }
    assert!(
        done + failed == 32 && done >= 12 && count("\"failure\"") > 0,
        "{lines}"
    );
    for (jobs, limit) in [(1, None), (3, None), (2, HOUR)] {
        assert_eq!(all(&sweep, jobs, limit), alone, "{jobs} threads, {limit:?}");
    }
}
