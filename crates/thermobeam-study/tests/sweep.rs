//! A sweep's cases run side by side wherever they can, and no line shows it.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Duration;

use thermobeam_study::sweep::{self, Line, Sweep};

const BASE: &str = "[obstacles]\nepsilon = 1e-3\ng1 = -0.05\ng2 = 0.05\n\
    [initial]\nu_t = \"x\"\n[mesh]\nelements = 7\n[time]\ndt = 0.1\nt_end = 50.0\n";

/// Cold and heated beams on two meshes with two steps; at dt = 10 the operator of a beam beyond buckling is not definite.
const GRID: &str = "[sweep]\nscene = \"base.toml\"\n[grid]\nmesh.elements = [7, 8]\nbeam.a = [0.0, 0.5]\n\
    time.dt = [0.5, 10.0, 13.0]\ntime.t_end = [50.0, 13.0]\nbeam.beta = [-0.8, 0.0, 1.0, 2.0, 3.0]\n";

fn sweep(folder: &std::path::Path) -> Sweep {
    std::fs::write(folder.join("base.toml"), BASE).unwrap();
    std::fs::write(folder.join("sweep.toml"), GRID).unwrap();
    Sweep::read(folder.join("sweep.toml")).unwrap()
}

fn all(sweep: &Sweep, jobs: usize, limit: Option<Duration>) -> BTreeMap<usize, Line> {
    let lines = Mutex::new(BTreeMap::new());
    let cases: Vec<usize> = (0..sweep.cases()).collect();
    sweep::run(sweep, &cases, jobs, limit, |line| {
        assert!(lines.lock().unwrap().insert(line.case, line).is_none(), "a case came twice");
        Ok(())
    })
    .unwrap();
    lines.into_inner().unwrap()
}

#[test]
fn a_case_has_the_same_line_alone_and_side_by_side_with_others() {
    let folder = tempfile::tempdir().unwrap();
    let sweep = sweep(folder.path());
    let alone: BTreeMap<_, _> = (0..sweep.cases()).map(|case| (case, Line::compute(&sweep, case, None))).collect();
    let with = |piece: &str| alone.values().filter(|line| line.json.contains(piece)).count();
    assert_eq!(
        (sweep.cases(), with("\"done\""), with("\"kind\":\"indefinite\""), with("time.dt: found")),
        (120, 72, 8, 40)
    );
    assert_eq!((with("\"heated\":true"), with("\"heated\":false")), (40, 40));
    for jobs in [1, 3] {
        assert_eq!(all(&sweep, jobs, None), alone, "{jobs} threads");
    }
    assert_eq!(all(&sweep, 1, Some(Duration::from_secs(3600))), alone);
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
    assert_eq!((ended.unwrap_err().to_string(), *count.lock().unwrap()), ("full".to_owned(), 1));
}
