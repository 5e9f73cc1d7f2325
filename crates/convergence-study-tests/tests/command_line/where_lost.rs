//! `study --where`: in which part of a program the order is lost.

use std::process::Command;

use tempfile::TempDir;

use super::{blocks, run, texts, write};

const PAGE: &str = include_str!("../../../convergence-study/book/src/where.md");

/// A solver in C, whose data come from the module that the page's file makes: its planted mistakes
/// are found, and where there is none nothing is named.
#[test]
fn mistakes_in_a_program_in_c_are_found_at_their_places() {
    foreign_tools::needs!(C, SHELL);
    let root = TempDir::new().unwrap();
    write(&root, "rod.toml", blocks(PAGE, "toml")[0]);
    write(&root, "solver.c", include_str!("rod_solver.c"));
    run(&root, "manufacture rod.toml --variants --language c").well();
    let build = "cc -std=c99 -Wall -Wextra -Werror -O2 -o solver solver.c rod.c -lm";
    let mut compiler = Command::new("sh");
    texts(compiler.args(["-c", build]).current_dir(root.path())).well();
    let located = |mistake: &str| {
        let study = format!(
            "[study]\nid = \"rod\"\nclaim = \"second order\"\ntier = \"quick\"\nkind = \"program\"\n\
             [program]\ncommand = [\"./solver\", \"{{n}}\", \"{mistake}\"]\nmanufacture = \"rod.toml\"\n\
             [refine]\nn = [8, 16, 32, 64]\n[[expect]]\nerror = \"L2\"\norder = 2\n"
        );
        write(&root, "study.toml", study);
        run(&root, "study study.toml --where")
    };
    located("x_min").says(
        1,
        "the order is lost at the face x_min: it comes back where the solution is flat there",
    );
    located("time").says(
        1,
        "look at the time at which source and data are taken, and the time stepping",
    );
    located("-").well();
}

/// The page can be followed: its files, its commands, what they print, and how the mistake is
/// mended.
#[test]
fn the_page_can_be_followed() {
    foreign_tools::needs!(NUMPY);
    let root = TempDir::new().unwrap();
    let write = |name: &str, text: &str| write(&root, name, text);
    let files = blocks(PAGE, "toml");
    write("rod.toml", files[0]);
    write("rod-study.toml", files[1]);
    let [solver, mended, ..] = blocks(PAGE, "python")[..] else {
        panic!("{PAGE}");
    };
    write("rod_solver.py", solver);
    run(&root, "manufacture rod.toml --variants --language python").well();
    let where_lost = || run(&root, "study rod-study.toml --where");
    where_lost().says(1, blocks(PAGE, "text\n...")[0]);
    let [first, second, flux] = mended.lines().collect::<Vec<_>>()[..] else {
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
    where_lost().well();
}
