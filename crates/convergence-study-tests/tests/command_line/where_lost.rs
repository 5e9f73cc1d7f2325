//! `study --where`: in which part of a program the order is lost.

use std::process::Command;

use tempfile::TempDir;

use super::{run, run_words, write};

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
