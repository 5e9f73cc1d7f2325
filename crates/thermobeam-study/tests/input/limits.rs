//! A request beyond the capacity of any machine is refused on reading, with its requirements.

use std::path::Path;

use convergence_study::KindRow;
use thermobeam_study::kinds::KINDS;
use thermobeam_study::scene::Scene;
use thermobeam_study::sweep::Sweep;

use super::says;

/// A study of the project with the lines of these keys replaced, read from a folder that contains its scenes.
#[track_caller]
fn refusal(name: &str, changes: &str) -> String {
    let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    let folder = tempfile::tempdir().expect("a folder");
    for scene in std::fs::read_dir(studies.join("scenes")).expect("scenes") {
        let scene = scene.expect("a scene").path();
        let to = folder.path().join("scenes");
        std::fs::create_dir_all(&to).expect("a folder");
        std::fs::copy(&scene, to.join(scene.file_name().expect("a name"))).expect("a copy");
    }
    let key = |line: &str| line.split(['=', ' ']).next().unwrap_or_default().to_owned();
    let mut text = std::fs::read_to_string(studies.join(name)).expect("a study");
    for line in changes.lines() {
        let before = text.clone();
        let with = |old| if key(old) == key(line) { line } else { old };
        text = before
            .lines()
            .map(|old| with(old).to_owned() + "\n")
            .collect();
        assert_ne!(before, text, "{name} has no such key: {line}");
    }
    let file = folder.path().join(name);
    std::fs::write(&file, text).expect("a file");
    KindRow::read_any(&KINDS, &file)
        .err()
        .unwrap_or_else(|| panic!("{name} with {changes} is not refused"))
        .to_string()
}

#[test]
fn what_a_study_cannot_have_is_refused_with_what_it_would_take() {
    let whole: Vec<_> = (1..=2000).collect();
    let many = format!("elements = {whole:?}\nsteps = {whole:?}");
    for (name, changes, pieces) in [
        (
            "stability-coarse.toml",
            "points = 1000",
            "map.points: found 1000 … <= 400",
        ),
        (
            "stability-h.toml",
            "range = [1e-12, 0.5]",
            "map.range: found the list [1e-12, 0.5] … h >= 1.2e-7",
        ),
        (
            "stability-h.toml",
            "lines = [1e-9]",
            "map.lines[0]: found 1e-9 … h >= 1.2e-7",
        ),
        (
            "energy-decay.toml",
            "random = 1000000000000",
            "energy.random: found 1000000000000, which makes 2.000e12 cases … GiB of memory … at most 1000000 cases",
        ),
        (
            "energy-decay.toml",
            "steps = 1000000000000",
            "energy.steps … <= 10000000000",
        ),
        (
            "theorem-3.4-grid.toml",
            &many,
            "refine.elements … 4.000e6 cases",
        ),
        (
            "vibration-time.toml",
            "elements = 100000",
            "refine.elements: found 100000, whose modes",
        ),
        (
            "vibration-space.toml",
            "steps = 1000000000",
            "refine.steps: found 1000000000, which is 1.000e9 steps … at most 1e7 steps",
        ),
        (
            "vibration-space.toml",
            "index = 1000000000000",
            "index … <= 10000",
        ),
        (
            "fixed-point.toml",
            "steps = 100000000",
            "steps: found 100000000 … <= 10000000",
        ),
        (
            "random-scenes.toml",
            "batches = 1000000000",
            "batches: found 1000000000",
        ),
    ] {
        says(&refusal(name, changes), &format!("{name}: … {pieces}"));
    }
}

#[test]
fn what_a_sweep_cannot_have_is_refused_with_what_it_would_take() {
    let folder = tempfile::tempdir().expect("a folder");
    let write =
        |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    write("base.toml", "[time]\ndt = 0.1\nt_end = 1\n");
    let range = "{ from = 1.0, to = 2.0, count = 10000 }";
    for (design, pieces) in [
        (
            format!("[grid]\nbeam.beta = {range}\nbeam.zeta = {range}\nbeam.rho = {range}\n"),
            "grid: found 1.000e12 cases, which would take about 14901.2 GiB of memory … at most 100000000 cases",
        ),
        (
            "[grid]\nbeam.beta = { from = 1, to = 2, count = 1000000000 }\n".to_owned(),
            "count: found 1000000000",
        ),
        (
            "[grid]\nmesh.elements = [10, 1000000000]\n".to_owned(),
            "grid.mesh.elements[1] … found 1000000000; expected … <= 8589934",
        ),
    ] {
        write(
            "sweep.toml",
            &format!("[sweep]\nscene = \"base.toml\"\n{design}"),
        );
        let error = Sweep::read(folder.path().join("sweep.toml")).expect_err("refused");
        says(&error.to_string(), &format!("sweep.toml: … {pieces}"));
    }
}

/// Whether an expression is too deep must not depend on the stack of the thread that reads it.
#[test]
fn a_function_ten_thousand_brackets_deep_is_refused_at_its_place() {
    let scene = |piece: &str, times: usize| {
        let text = format!(
            "[initial]\nu = \"{}x{}\"\n[time]\ndt = 0.1\nt_end = 1\n",
            piece.repeat(times),
            ")".repeat(piece.matches('(').count() * times),
        );
        let read = move || Scene::parse(&text, "s.toml").map_err(|error| error.to_string());
        let thread = std::thread::Builder::new().stack_size(1 << 20).spawn(read);
        thread.expect("a thread").join().expect("no overflow")
    };
    for (piece, levels) in [("(", 1), ("-", 1), ("sin(", 1), ("2*(0-", 4), ("min(1,", 1)] {
        scene(piece, 90 / levels).expect("a scene");
        let message = scene(piece, 10_000).expect_err("too deep");
        says(&message, "s.toml:2: … initial.u:  … 96");
    }
}

#[test]
fn what_machines_do_have_goes_on_working() {
    let text = "[mesh]\nelements = 1000000\n[time]\ndt = 1e-9\nt_end = 10\n";
    let scene = Scene::parse(text, "s.toml").expect("a scene");
    assert_eq!(
        (scene.mesh.elements(), scene.steps()),
        (1_000_000, 10_000_000_000)
    );
}
