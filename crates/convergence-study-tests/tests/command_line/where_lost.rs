//! `study --where`: in which part of a program the order is lost.

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use serde_json::{Value, json};
use tempfile::TempDir;

use super::{read, run, run_words, write};

/// Equations with a solution that has data at both faces.
pub(super) const ROD: &str = r#"
[manufacture]
name = "rod"
coordinates = ["x"]
time = "t"
[domain]
x = [0, 1]
t = [0, 1]
[exact]
u = "1 + sin(x)*exp(-t)"
[equations]
u = "dt(u) - d(u, x, x)"
[boundary.x_min]
u = "u"
[boundary.x_max]
flux = "d(u, x)"
[initial]
u = "u"
"#;

/// Errors h^2, and 0.3 h where the variant does not hide it: `run.sh N VARIANT...`, those that do.
const PROGRAM: &str = r#"
n=$1
shift
part=0.3
for variant in "$@"; do
    if [ "$variant" = "$MANUFACTURE_VARIANT" ]; then part=0; fi
done
# Each variant has its own solution.
scale=1.${#MANUFACTURE_VARIANT}
awk "BEGIN { h = 1 / $n; printf \"L2 = %.12g\n\", $scale * (h * h + $part * h) }"
"#;

/// A folder with the program, its solution, and a study that finds its order lost.
fn project(program: &str, hidden_in: &[&str]) -> TempDir {
    let root = TempDir::new().unwrap();
    let words = hidden_in.iter().map(|variant| format!(", \"{variant}\""));
    let study = format!(
        "[study]\nid = \"rod\"\nclaim = \"second order\"\ntier = \"quick\"\nkind = \"program\"\n\
         [program]\ncommand = [\"sh\", \"run.sh\", \"{{n}}\"{}]\nmanufacture = \"rod.toml\"\n\
         [refine]\nn = [8, 16, 32, 64]\n[[expect]]\nerror = \"L2\"\norder = 2\n",
        words.collect::<String>()
    );
    for (name, text) in [
        ("rod.toml", ROD),
        ("run.sh", program),
        ("study.toml", &study),
    ] {
        write(&root, name, text);
    }
    root
}

/// What `study --where` prints.
fn located(program: &str, hidden_in: &[&str]) -> convergence_study_tests::Ended {
    run_words(
        &project(program, hidden_in),
        &["study", "study.toml", "--where"],
    )
}

#[test]
fn the_face_whose_flat_variant_has_its_order_back_is_named() {
    if !crate::awk_is_here() {
        return;
    }
    let hidden_in = ["flat_x_max", "flat_x", "flat_everywhere", "constant_x"];
    let (status, out, err) = located(PROGRAM, &hidden_in).parts();
    assert_eq!((status, err.as_str()), (Some(1), ""), "{out}");
    let conclusion = "the order is lost at the face x_max: it comes back where the solution is flat there \
                      (2.00 ± 0.00), and not where it is flat at any other face; look at the condition flux at x_max";
    assert!(out.contains(conclusion), "{out}");
    let rest = &out[out.find("\nvariant ").unwrap() + 1..];
    let block = &rest[..rest.find("\n\n").unwrap_or(rest.len())];
    assert!(block.lines().count() <= 15, "{block}");
    let root = project(PROGRAM, &hidden_in);
    let words = ["study", "study.toml", "--where", "--format", "json"];
    let record: Value = serde_json::from_str(&run_words(&root, &words).stdout).unwrap();
    let place = &record["studies"][0]["where"];
    assert_eq!(place["named"], json!([{"part": "face", "name": "x_max"}]));
    let variants = place["variants"].as_array().unwrap();
    assert_eq!(variants.len(), 7);
    assert_eq!(variants[3]["name"], "flat_x_max");
    let part = json!({"part": "face", "name": "x_max"});
    assert_eq!(variants[3]["switches_off"], part);
    assert_eq!(variants[3]["rates"][0]["verdict"], "pass");
    assert_eq!(variants[2]["rates"][0]["verdict"], "fail");
}

#[test]
fn the_report_has_the_conclusion_and_a_figure_of_the_rates_by_variant() {
    if !crate::awk_is_here() {
        return;
    }
    let root = project(PROGRAM, &["flat_x_max", "flat_x", "flat_everywhere"]);
    let words = ["study", "study.toml", "--where", "--out", "report"];
    let (status, _, err) = run_words(&root, &words).parts();
    assert_eq!((status, err.as_str()), (Some(1), ""));
    let report = root.path().join("report");
    let figure = fs::read_to_string(report.join("figures/rod-where.svg")).unwrap();
    for text in [
        "rod: rate of the error L2 by variant",
        "rate; the line is the order claimed, 2, the band its tolerance",
        "the solution itself",
        "flat_x_max: back",
        "flat_x_min: lost",
    ] {
        assert!(figure.contains(text), "{text}: {figure}");
    }
    let page = fs::read_to_string(report.join("README.md")).unwrap();
    assert!(page.contains("(figures/rod-where.svg)"), "{page}");
    assert!(
        page.contains("the order is lost at the face x_max"),
        "{page}"
    );
    // Without --where there is neither.
    run(&root, "study study.toml --out other");
    let page = read(&root, "other/README.md");
    assert!(!page.contains("where.svg"), "{page}");
}

#[test]
fn a_variant_that_is_left_out_has_its_reason_in_json() {
    if !crate::awk_is_here() {
        return;
    }
    let root = project(PROGRAM, &["-"]);
    let fixed = ROD.replace(
        "[boundary.x_min]\nu = \"u\"",
        "[boundary.x_min]\nu = { of = \"u\", is = \"1\" }",
    );
    assert_ne!(fixed, ROD);
    write(&root, "rod.toml", fixed);
    let words = ["study", "study.toml", "--where", "--format", "json"];
    let record: Value = serde_json::from_str(&run_words(&root, &words).stdout).unwrap();
    let variants = record["studies"][0]["where"]["variants"]
        .as_array()
        .unwrap();
    let row = |name: &str| variants.iter().find(|row| row["name"] == name).unwrap();
    let reason = row("constant_x")["left_out"].as_str().unwrap();
    assert!(
        reason.starts_with("boundary.x_min.u: condition-violated: "),
        "{reason}"
    );
    assert_eq!(row("constant_t").get("left_out"), None);
}

#[test]
fn other_parts_are_named_by_their_variants_and_none_without_one() {
    if !crate::awk_is_here() {
        return;
    }
    for (hidden_in, words) in [
        (
            ["constant_x", "-"],
            "the order is lost in what acts along x: it comes back where the solution is constant in x",
        ),
        (
            ["constant_t", "-"],
            "look at the time at which source and data are taken, and the time stepping",
        ),
        (
            ["flat_initial", "flat_everywhere"],
            "the order is lost at the first time",
        ),
        (
            ["flat_x", "flat_everywhere"],
            "the order is lost at the faces x_min and x_max",
        ),
        (
            ["constant_x", "constant_t"],
            "no single one explains that the order comes back in constant_x and constant_t",
        ),
        (["-", "-"], "the order is lost in every variant: everywhere"),
    ] {
        located(PROGRAM, &hidden_in).says(1, words);
    }
}

#[test]
fn a_program_that_ignores_the_variant_is_refused_and_nothing_is_written() {
    if !crate::awk_is_here() {
        return;
    }
    let ignoring = PROGRAM.replace("scale=1.${#MANUFACTURE_VARIANT}", "scale=1");
    assert_ne!(ignoring, PROGRAM);
    let root = project(&ignoring, &[]);
    let log = root.path().join("log");
    let logged = format!(
        "echo \"$MANUFACTURE_VARIANT\" >> '{}'\n{ignoring}",
        log.display()
    );
    write(&root, "run.sh", logged);
    let words = ["study", "study.toml", "--where", "--out", "report"];
    let (status, out, err) = run_words(&root, &words).parts();
    assert_eq!((status, out.as_str()), (Some(2), ""), "{err}");
    for part in [
        "does not notice",
        "--variants",
        "mpirun -x MANUFACTURE_VARIANT",
    ] {
        assert!(err.contains(part), "{err}");
    }
    // One variant was run, not all.
    let log = fs::read_to_string(log).unwrap();
    let variants: BTreeSet<&str> = log.lines().collect();
    assert_eq!(variants, BTreeSet::from(["", "flat_everywhere"]));
    let written = fs::read_dir(root.path().join("report")).map_or(0, Iterator::count);
    assert_eq!(written, 0);
}

#[test]
fn a_variant_that_does_not_run_is_refused_with_its_last_words() {
    if !crate::awk_is_here() {
        return;
    }
    let failing = format!(
        "if [ \"$MANUFACTURE_VARIANT\" = flat_everywhere ]; then echo 'unknown variant' >&2; exit 3; fi\n{PROGRAM}"
    );
    let (status, out, err) = located(&failing, &[]).parts();
    assert_eq!((status, out.as_str()), (Some(2), ""), "{err}");
    for part in [
        "the variant flat_everywhere does not run",
        "unknown variant",
    ] {
        assert!(err.contains(part), "{err}");
    }
}

#[test]
fn a_study_without_a_manufactured_solution_is_refused_before_it_runs() {
    let root = project("exit 1", &[]);
    let study = read(&root, "study.toml");
    let without = study.replace("manufacture = \"rod.toml\"\n", "");
    write(&root, "study.toml", without);
    for command in ["study", "verify"] {
        let (status, out, err) = run_words(&root, &[command, "study.toml", "--where"]).parts();
        assert_eq!((status, out.as_str()), (Some(2), ""));
        assert!(
            err.contains("rod: --where: found no `manufacture` in [program]"),
            "{err}"
        );
    }
    write(&root, "study.toml", study.replace("rod.toml", "rood.toml"));
    let ran = run(&root, "study study.toml");
    ran.complains(2, "program.manufacture");
    ran.complains(2, "is no file");
}

#[test]
fn a_study_that_passes_has_no_place() {
    if !crate::awk_is_here() {
        return;
    }
    let right = PROGRAM.replace("part=0.3", "part=0");
    let (status, out, err) = located(&right, &[]).parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    assert!(!out.contains("flat_x"), "{out}");
}

/// A solver in C, whose data come from the module that the page's file makes: its planted mistakes
/// are found, and where there is none nothing is named.
#[test]
fn mistakes_in_a_program_in_c_are_found_at_their_places() {
    const PAGE: &str = include_str!("../../../convergence-study/book/src/where.md");
    if !foreign_tools::are_here(&[foreign_tools::C]) {
        return;
    }
    let root = TempDir::new().unwrap();
    let file = PAGE.split("```toml\n").nth(1).unwrap();
    write(&root, "rod.toml", file.split("```").next().unwrap());
    write(&root, "solver.c", include_str!("rod_solver.c"));
    let words = ["manufacture", "rod.toml", "--variants", "--language", "c"];
    let (status, out, err) = run_words(&root, &words).parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    let build = "cc -std=c99 -Wall -Wextra -Werror -O2 -o solver solver.c rod.c -lm";
    let mut words = build.split(' ');
    let compiler = Command::new(words.next().unwrap())
        .args(words)
        .current_dir(root.path())
        .output();
    let output = compiler.unwrap();
    assert!(output.status.success(), "{output:?}");
    let study = |mistake: &str| {
        format!(
            "[study]\nid = \"rod\"\nclaim = \"second order\"\ntier = \"quick\"\nkind = \"program\"\n\
             [program]\ncommand = [\"./solver\", \"{{n}}\", \"{mistake}\"]\nmanufacture = \"rod.toml\"\n\
             [refine]\nn = [8, 16, 32, 64]\n[[expect]]\nerror = \"L2\"\norder = 2\n"
        )
    };
    for (mistake, words) in [
        (
            "x_min",
            "the order is lost at the face x_min: it comes back where the solution is flat there",
        ),
        (
            "time",
            "look at the time at which source and data are taken, and the time stepping",
        ),
    ] {
        write(&root, "study.toml", study(mistake));
        let (status, out, err) = run(&root, "study study.toml --where").parts();
        assert_eq!((status, err.as_str()), (Some(1), ""), "{out}");
        assert!(out.contains(words), "{mistake}: {out}");
    }
    write(&root, "study.toml", study("-"));
    let (status, out, err) = run(&root, "study study.toml --where").parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
}

/// The page can be followed: its files, its commands, what they print, and how the mistake is mended.
#[test]
fn the_page_can_be_followed() {
    const PAGE: &str = include_str!("../../../convergence-study/book/src/where.md");
    if !foreign_tools::are_here(&[foreign_tools::NUMPY]) {
        return;
    }
    let block = |opening: &str, number: usize| {
        let block = PAGE.split(opening).nth(number + 1).unwrap();
        block.split("```").next().unwrap()
    };
    let root = TempDir::new().unwrap();
    let write = |name: &str, text: &str| write(&root, name, text);
    write("rod.toml", block("```toml\n", 0));
    write("rod-study.toml", block("```toml\n", 1));
    let solver = block("```python\n", 0);
    write("rod_solver.py", solver);
    let words = [
        "manufacture",
        "rod.toml",
        "--variants",
        "--language",
        "python",
    ];
    let (status, out, err) = run_words(&root, &words).parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    let (status, out, err) = run(&root, "study rod-study.toml --where").parts();
    assert_eq!((status, err.as_str()), (Some(1), ""), "{out}");
    assert!(out.contains(block("```text\n", 0)), "{out}");
    let [first, second, flux] = block("```python\n", 1).lines().collect::<Vec<_>>()[..] else {
        panic!("{PAGE}");
    };
    let mended = solver
        .replace("A[0, 0] -= k[0]\n", &format!("{first}\n{second}\n"))
        .replace(
            "    out[0] += k[0]*rod.boundary_x_min_value([0.0], t)",
            flux,
        );
    assert!(mended.contains(flux) && mended.contains(second), "{mended}");
    write("rod_solver.py", &mended);
    let (status, out, err) = run(&root, "study rod-study.toml --where").parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
}
