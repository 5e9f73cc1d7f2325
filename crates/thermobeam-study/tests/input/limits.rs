//! A request beyond the capacity of any machine is refused on reading, with its requirements.

use std::path::Path;

use convergence_study::KindRow;
use thermobeam_study::kinds::KINDS;
use thermobeam_study::scene::Scene;

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
