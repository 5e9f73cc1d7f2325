//! `manufacture`: the page of ten minutes as a newcomer follows it, exit status, and what is
//! written.

use std::fs;
#[cfg(unix)]
use std::{
    thread,
    time::{Duration, Instant},
};

use serde_json::Value;
use tempfile::TempDir;

use super::where_lost::ROD;
use super::{read, run, run_words, write};

const PAGE: &str = include_str!("../../../manufacture/TEN-MINUTES.md");

/// The blocks of the page in that language.
fn blocks(language: &str) -> Vec<&'static str> {
    let opening = format!("```{language}\n");
    let blocks = PAGE.split(opening.as_str()).skip(1);
    blocks
        .map(|rest| rest.split("```").next().unwrap())
        .collect()
}

#[test]
fn the_page_of_ten_minutes_leads_to_a_study_that_passes_and_can_fail() {
    let root = TempDir::new().unwrap();
    let write = |name: &str, text: &str| write(&root, name, text);
    let (status, _, err) = run(&root, "new manufacture heat").parts();
    assert_eq!((status, err.as_str()), (Some(0), ""));
    let file = read(&root, "heat.toml");
    // The page is about the program `convergence-study`.
    assert_eq!(
        file.replace("powers", "convergence-study"),
        blocks("toml")[0]
    );
    let (status, out, err) = run(&root, "manufacture heat.toml").parts();
    assert_eq!((status, err.as_str()), (Some(0), ""));
    assert_eq!(out, blocks("text")[1]);
    if !foreign_tools::are_here(&[foreign_tools::NUMPY]) {
        return;
    }
    let (status, out, err) = run(&root, "manufacture heat.toml --language python").parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    let [solver, foreign] = blocks("python")[..] else {
        panic!("two programs on the page")
    };
    write("solver.py", solver);
    run(&root, "study heat.study.toml").says(0, "");
    // Moved to the other studies, it names the folder of its program.
    let study = read(&root, "heat.study.toml");
    assert!(study.contains("directory = \".\"\n"), "{study}");
    let moved = study.replace("directory = \".\"", "directory = \"..\"");
    fs::create_dir_all(root.path().join("studies")).unwrap();
    write("studies/heat.toml", &moved);
    run(&root, "study studies/heat.toml").says(0, "");
    fs::remove_file(root.path().join("studies/heat.toml")).unwrap();
    write(
        "solver.py",
        &solver.replace("+ 2.5 + step / 2", "- 2.5 + step / 2"),
    );
    run(&root, "study heat.study.toml").says(1, "");
    write("foreign.py", foreign);
    let (status, out, _) = run_words(
        &root,
        &[
            "manufacture",
            "heat.toml",
            "--against",
            "python3 foreign.py",
        ],
    )
    .parts();
    assert_eq!((status, out.as_str()), (Some(1), blocks("text")[2]));
}

#[test]
fn exit_status_and_output_are_those_of_every_command() {
    let root = TempDir::new().unwrap();
    run(&root, "new manufacture heat");
    let path = root.path().join("heat.toml");
    let sound = fs::read_to_string(&path).unwrap();
    write(&root, "points.csv", "x,face\n0.5,\n1,x_max\n");
    let at = [
        "manufacture",
        "heat.toml",
        "--at",
        "points.csv",
        "--format",
        "json",
    ];
    let (status, out, _) = run_words(&root, &at).parts();
    let values: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (status, &values["schema"], &values["name"]),
        (Some(0), &1.into(), &"heat".into())
    );
    assert!(values["boundary"]["x_max"]["robin"][0].is_null());
    assert!(values["boundary"]["x_max"]["robin"][1].is_number());
    assert_eq!(values["terms"]["heat"].as_object().unwrap().len(), 2);

    // A check that fails: nothing is emitted.
    fs::write(
        &path,
        sound.replace("positive = [\"k\"]", "positive = [\"k - 1.2\"]"),
    )
    .unwrap();
    let wrong = [
        "manufacture",
        "heat.toml",
        "--language",
        "c",
        "--out",
        "out",
        "--format",
        "json",
    ];
    let (status, out, _) = run_words(&root, &wrong).parts();
    let check: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (status, &check["check"]["verdict"]),
        (Some(1), &"fail".into())
    );
    assert_eq!(check["check"]["findings"][0]["code"], "not-positive");
    assert_eq!(check["check"]["findings"][0]["where"], "require.positive");
    assert!(!root.path().join("out").exists());

    // A file that cannot be used: nothing is written.
    fs::write(&path, sound.replace("loss = \"T\"", "loss = \"TT\"")).unwrap();
    let (status, out, err) = run(&root, "manufacture heat.toml --out unusable").parts();
    assert_eq!((status, out.as_str()), (Some(2), ""));
    assert!(
        err.starts_with(
            "error: heat.toml:26:9: equations.heat.loss: unknown name `TT`; expected one of x h T k q"
        ),
        "{err}"
    );
    assert!(!root.path().join("unusable").exists());
    // So is one whose solution has a pole inside.
    let pole = sound.replace("1 + exp(x)*sin(2*x)", "x/(x - 0.37)");
    fs::write(&path, pole).unwrap();
    let arguments = [
        "manufacture",
        "heat.toml",
        "--language",
        "c",
        "--out",
        "unusable",
    ];
    let (status, out, err) = run_words(&root, &arguments).parts();
    assert_eq!((status, out.as_str()), (Some(2), ""));
    assert!(
        err.starts_with(
            "error: heat.toml:18:9: exact.T: a pole inside the domain: `x - 0.37` is zero at about x = 0.370000"
        ),
        "{err}"
    );
    assert!(!root.path().join("unusable").exists());
    run(&root, "manufacture heat.toml --language cobol")
        .complains(2, "expected one of c, fortran, python, ufl, octave, rust");
}

/// Nothing that a program has started outlives it, and one that does not read its points, which
/// fill the pipe, is stopped as well.
// The program is a script of a shell.
#[cfg(unix)]
#[test]
fn a_program_that_hangs_ends_with_all_that_it_has_started() {
    if !foreign_tools::are_here(&[foreign_tools::SHELL]) {
        return;
    }
    let root = TempDir::new().unwrap();
    run(&root, "new manufacture heat");
    let program = "sh -c '(sleep 3; touch not-stopped) & sleep 30'";
    let against = ["manufacture", "heat.toml", "--against", program];
    let more = ["--time-limit", "0.5", "--points", "20000"];
    let started = Instant::now();
    let (status, out, err) = run_words(&root, &[&against[..], &more].concat()).parts();
    assert_eq!((status, out.as_str()), (Some(2), ""));
    assert!(
        err.contains("sh was stopped at its time limit of 0.5 s"),
        "{err}"
    );
    let left = Duration::from_secs(4).saturating_sub(started.elapsed());
    thread::sleep(left);
    assert!(!root.path().join("not-stopped").exists());
}

/// A rod with one value prescribed at x_min, which a solution that is constant along x cannot have.
fn with_a_fixed_value() -> String {
    let fixed = ROD.replace(
        "[boundary.x_min]\nu = \"u\"",
        "[boundary.x_min]\nu = { of = \"u\", is = \"1\" }",
    );
    assert_ne!(fixed, ROD);
    fixed
}

#[test]
fn the_variants_are_listed_with_what_each_switches_off() {
    let root = TempDir::new().unwrap();
    write(&root, "rod.toml", with_a_fixed_value());
    let (status, out, err) = run(&root, "manufacture rod.toml --variants").parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    for line in [
        "flat_x_min       the data at x_min",
        "left out: constant_x: boundary.x_min.u: condition-violated",
    ] {
        assert!(out.contains(line), "{line}: {out}");
    }
    let words = ["manufacture", "rod.toml", "--variants", "--format", "json"];
    let object: Value = serde_json::from_str(&run_words(&root, &words).stdout).unwrap();
    let name = &object["variants"][0]["name"];
    assert_eq!(
        (name, &object["variants"][0]["switches_off"]["part"]),
        (&"constant_t".into(), &"time".into())
    );
    assert_eq!(object["left_out"][0]["name"], "constant_x");
}

/// With these values at its ends a rod has no other solution.
const HELD: &str = r#"
[manufacture]
name = "held"
coordinates = ["x"]
[domain]
x = [0, 1]
[exact]
u = "1 + 2*x + x*(1 - x)"
[equations.u]
diffusion = "-d(u, x, x)"
[boundary.x_min]
u = { of = "u", is = "1" }
[boundary.x_max]
u = { of = "u", is = "3" }
"#;

#[test]
fn a_module_without_any_variant_is_refused_and_nothing_is_written() {
    let root = TempDir::new().unwrap();
    write(&root, "held.toml", HELD);
    let words = ["manufacture", "held.toml", "--variants", "--language", "c"];
    let (status, out, err) = run_words(&root, &words).parts();
    assert_eq!((status, out.as_str()), (Some(2), ""));
    for part in [
        "held.toml: --variants: no variant can be used",
        "left out: constant_x: boundary.x_min.u: condition-violated",
    ] {
        assert!(err.contains(part), "{err}");
    }
    assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
}
