//! `manufacture`: the page of ten minutes as a newcomer follows it, and programs that hang.

use std::fs;
#[cfg(unix)]
use std::{
    thread,
    time::{Duration, Instant},
};

use tempfile::TempDir;

use super::{blocks, read, run, run_words, write};

#[test]
fn the_page_of_ten_minutes_leads_to_a_study_that_passes_and_can_fail() {
    let blocks = |language| {
        blocks(
            include_str!("../../../manufacture/TEN-MINUTES.md"),
            language,
        )
    };
    let root = TempDir::new().unwrap();
    let write = |name: &str, text: &str| write(&root, name, text);
    run(&root, "new manufacture heat").well();
    let file = read(&root, "heat.toml");
    // The page is about the program `convergence-study`.
    let of_page = file.replace("powers", "convergence-study");
    assert_eq!(of_page, blocks("toml")[0]);
    let printed = run(&root, "manufacture heat.toml");
    assert_eq!(printed.well(), blocks("text")[1]);
    foreign_tools::needs!(NUMPY);
    run(&root, "manufacture heat.toml --language python").well();
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
    let against = [
        "manufacture",
        "heat.toml",
        "--against",
        "python3 foreign.py",
    ];
    let ran = run_words(&root, &against);
    assert_eq!((ran.status, &*ran.stdout), (Some(1), blocks("text")[2]));
}

/// Nothing that a program has started outlives it, and one that does not read its points, which
/// fill the pipe, is stopped as well.
// The program is a script of a shell.
#[cfg(unix)]
#[test]
fn a_program_that_hangs_ends_with_all_that_it_has_started() {
    foreign_tools::needs!(SHELL);
    let root = TempDir::new().unwrap();
    run(&root, "new manufacture heat");
    let program = "sh -c '(sleep 3; touch not-stopped) & sleep 30'";
    let against = ["manufacture", "heat.toml", "--against", program];
    let more = ["--time-limit", "0.5", "--points", "20000"];
    let started = Instant::now();
    let ran = run_words(&root, &[&against[..], &more].concat());
    ran.refuses("sh was stopped at its time limit of 0.5 s");
    let left = Duration::from_secs(4).saturating_sub(started.elapsed());
    thread::sleep(left);
    assert!(!root.path().join("not-stopped").exists());
}

/// What a program prints without an end is not kept, and ends it.
// `yes` is a program of every Unix.
#[cfg(unix)]
#[test]
fn a_program_that_prints_without_an_end_is_stopped() {
    let root = TempDir::new().unwrap();
    run(&root, "new manufacture heat");
    let against = ["manufacture", "heat.toml", "--against", "yes nan"];
    run_words(&root, &against).refuses("yes printed more than 64 MB");
}

#[cfg(unix)]
#[test]
fn a_quantity_that_the_other_program_leaves_out_is_not_taken_for_right() {
    foreign_tools::needs!(SHELL);
    let root = TempDir::new().unwrap();
    let file = "[manufacture]\nname = \"two\"\ncoordinates = [\"x\"]\n[domain]\nx = [0, 1]\n\
                [exact]\nu = \"exp(x)\"\n[equations]\nfirst = \"u/u\"\nsecond = \"u\"\n";
    write(&root, "two.toml", file);
    let program = "sh -c 'echo first; read names; while read x; do echo 1; done'";
    let ran = run_words(&root, &["manufacture", "two.toml", "--against", program]);
    ran.says(
        0,
        "\nsecond: not compared: the answer does not name it\npass: ",
    );
    let quiet = ["manufacture", "two.toml", "--against", program, "--quiet"];
    run_words(&root, &quiet).says(0, "0 of 1 quantities differ, 1 not compared");
    let strict = [&quiet[..], &["--strict"]].concat();
    let says = "second: not compared: the answer does not name it\nfail: 0 of 1 quantities differ";
    run_words(&root, &strict).says(1, says);
    let wrong = file.replace("[equations]", "[require]\nzero = [\"u\"]\n[equations]");
    write(&root, "two.toml", &wrong);
    run_words(&root, &quiet)
        .refuses("two.toml: does not pass its own check: run manufacture two.toml");
}
