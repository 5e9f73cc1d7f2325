//! A request beyond the capacity of any machine is refused on reading, with its requirements.

use std::path::Path;

use convergence_study::KindRow;
use thermobeam_study::kinds::KINDS;
use thermobeam_study::scene::Scene;
use thermobeam_study::sweep::Sweep;

use super::says;

#[test]
fn a_grid_of_millions_of_cases_is_refused_with_their_number() {
    let whole: Vec<_> = (1..=2000).collect();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/theorem-3.4-grid.toml");
    let text = std::fs::read_to_string(&file).expect("a study");
    let many = |line: &str| match line.split_once(" = ") {
        Some((key @ ("elements" | "steps"), _)) => format!("{key} = {whole:?}\n"),
        _ => format!("{line}\n"),
    };
    let text: String = text.lines().map(many).collect();
    let refused = KindRow::parse_any(&KINDS, &text, &file).err();
    let refused = refused.expect("a refusal").to_string();
    says(
        &refused,
        "theorem-3.4-grid.toml: … refine.elements … 4.000e6 cases",
    );
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
