//! What a study file may get wrong: it is refused with its place, what is found and what is allowed.

use std::fs;
use std::process::Command;

use convergence_study_tests::transcript::place;

use super::{HARNESS, texts};

/// A change of a sound file: what is replaced, by what, and words of the message.
type Row = (&'static str, &'static str, &'static str);

/// Changes of the file `s.toml` that stands at the head of a transcript.
const REFUSED: [(&str, &[Row]); 4] = [
    (include_str!("../transcripts/programs.md"), &PROGRAM),
    (include_str!("../transcripts/samples.md"), &SAMPLES),
    (include_str!("../transcripts/table.md"), &TABLE),
    (include_str!("../transcripts/taylor.md"), &TAYLOR),
];

const PROGRAM: [Row; 30] = [
    (
        "\"{n}\"",
        "\"--dt={dt}\"",
        "program.command[3]: found the placeholder {dt}; expected one that `refine` gives",
    ),
    (
        "command = [",
        "command = [] # [",
        "program.command: found the list []; expected a list of the program",
    ),
    (
        "[refine]",
        "time_limit = 0\n[refine]",
        ":8:14: program.time_limit: found 0; expected a number of seconds > 0",
    ),
    (
        "[refine]",
        "directory = \"x\"\n[refine]",
        "program.directory: found the text \"x\", but ./x is no folder",
    ),
    (
        "[refine]",
        "files = [\"x\"]\n[refine]",
        "program.files: found the list [\"x\"]; expected files beside cache = true",
    ),
    (
        "[refine]",
        "cache = true\n[refine]",
        "program.cache: found true; expected true beside `files`, all files that a result depends on",
    ),
    (
        "[refine]",
        "shell = true\n[refine]",
        "program.shell: unknown key `shell`; expected command, directory, env, manufacture, files, cache, time_limit, floor, scale",
    ),
    (
        "[refine]",
        "env = { SCALE = 3 }\n[refine]",
        ":8:17: program.env.SCALE: found 3; expected a text",
    ),
    (
        "[refine]",
        "env = { \"A=B\" = \"3\" }\n[refine]",
        "expected a name of a variable, without `=`",
    ),
    (
        "[refine]",
        "env = \"SCALE=3\"\n[refine]",
        ":8:7: program.env: found the text \"SCALE=3\"; expected a table",
    ),
    ("[refine]", "floor = -1\n[refine]", "floor"),
    (
        "n = [4, ",
        "n = [8, ",
        "refine.n[1]: found 8; expected a number > 8, the level before",
    ),
    (
        "error = \"L2\"",
        "norm = \"L2\"",
        "expect[0].norm: unknown key `norm`",
    ),
    (
        "0.05",
        "0.5",
        ":13:13: expect[0].tolerance: found 0.5; expected a finite number > 0 and < 0.5",
    ),
    (
        "kind = \"program\"",
        "",
        ":1:1: study.kind: missing; expected \"power\", \"program\", \"table\", \"taylor\"",
    ),
    (
        "[[expect]]",
        "[[expct]]",
        "unknown key `expct`, did you mean `expect`?",
    ),
    ("order = 2.0", "order = \"> 2\"", ">= 2"),
    ("order = 2.0", "order = \">= -2\"", ">= 2"),
    (
        "order = 2.0",
        "order = 2.0\nfactor = 5",
        "one of order, factor and exact",
    ),
    ("order = 2.0", "factor = 0.5", "a factor > 1"),
    (
        "order = 2.0",
        "order = 2.0\nconstant = [2.0, 1.0]",
        "two numbers",
    ),
    (
        "order = 2.0",
        "factor = 2\nconstant = [1.0, 2.0]",
        "beside order",
    ),
    ("order = 2.0", "exact = 1e-3", "exact alone"),
    (
        "order = 2.0\ntolerance = 0.05",
        "exact = 0.07\nconstant = [1.0, 2.0]",
        "constant beside exact",
    ),
    (
        "order = 2.0",
        "factor = 5\ntolerance = 0.1\n[[expect]]\nerror = \"H1\"\norder = 1.0",
        "one of the two in all of a study",
    ),
    (
        "[4, 8, 16, 32, 64]",
        "\"many\"",
        "refine.n: found the text \"many\"; expected a list of increasing whole numbers >= 1, or \"auto\"",
    ),
    (
        "[4, 8, 16, 32, 64]",
        "[8, 16]\nbudget = 3",
        "refine.budget: found a budget beside lists; expected lists alone, or \"auto\"",
    ),
    (
        "[4, 8, 16, 32, 64]",
        "\"auto\"\nbudget = 0",
        "refine.budget: found 0; expected a number of seconds > 0",
    ),
    (
        "[4, 8, 16, 32, 64]",
        "\"auto\"\nsteps = [1, 2, 3, 4]",
        "refine.steps: found the list [1, 2, 3, 4] beside \"auto\"; expected \"auto\"",
    ),
    (
        "[4, 8, 16, 32, 64]",
        "\"auto\"\nsteps = \"auto\"\ngrid = true",
        "refine.n: found the text \"auto\"; expected lists where grid = true",
    ),
];

const SAMPLES: [Row; 8] = [
    (
        ", \"{seed}\"",
        "",
        "expected a command with the placeholder {seed}, which tells",
    ),
    (
        "samples = 40",
        "samples = 9",
        "refine.samples: found 9; expected a whole number >= 10",
    ),
    (
        ", \"{seed}\"]\n[refine]\nn = [4, 8, 16, 32, 64]\nsamples = 40",
        "]\n[refine]\nn = [4, 8, 16, 32, 64]",
        "expect[1].of: found the text \"weak\"; expected of only where refine",
    ),
    (
        "[4, 8, 16, 32, 64]",
        "\"auto\"",
        "refine.samples: found 40; expected samples of levels",
    ),
    (
        "of = \"weak\"",
        "of = \"median\"",
        "expected \"mean\", \"rms\", \"weak\"",
    ),
    (
        "[refine]",
        "floor = 1e-9\n[refine]",
        "program.floor: found 1e-9; expected no floor beside",
    ),
    (
        "order = 0.5",
        "factor = 3",
        "expect[0].factor: found 3; expected error and order beside",
    ),
    (
        "samples = 40",
        "samples = 4000",
        "found 4000 samples of 5 levels; expected at most 10000",
    ),
];

const TABLE: [Row; 10] = [
    (
        "[\"solver.f90\"]",
        "[]",
        "table.inputs: found the list []; expected at least one file",
    ),
    (
        "solver.f90",
        "gone.f90",
        "table.inputs[0]: found the text \"gone.f90\", but ",
    ),
    (
        "errors.csv",
        "gone.csv",
        "table.file: found the text \"gone.csv\", but ",
    ),
    (
        "errors.csv",
        ".",
        "table.file: found the text \".\", which is no file",
    ),
    (
        "[[expect]]\nerror = \"L2\"",
        "samples = \"mean\"\n[[expect]]\nvalue = \"L2\"",
        "table.samples: found the text \"mean\"; expected samples without floor, ratio and values",
    ),
    ("error = \"L2\"", "", "expect[0].error: missing; expected"),
    (
        "value = \"drag\"\norder = 2",
        "value = \"drag\"\norder = \">= 2\"",
        "expected an order alone",
    ),
    (
        "inputs",
        "ratio = 1\ninputs",
        "table.ratio: found 1; expected a finite number > 1",
    ),
    (
        "inputs",
        "lines = [\"x\"]\ninputs",
        "table.lines[0]: found the text \"x\"; expected the first",
    ),
    (
        "inputs",
        "tolerance = 0.5\ninputs",
        "table.tolerance: found 0.5; expected a finite number",
    ),
];

const TAYLOR: [Row; 6] = [
    (
        "\"{eps}\", \"{seed}\"",
        "\"{n}\"",
        "program.command[3]: found the placeholder {n}; expected one that",
    ),
    (
        "\"{eps}\", ",
        "",
        "expected a command with the placeholder {eps}, or without any",
    ),
    (
        ", \"{seed}\"]",
        "]\n[taylor]\ndirections = 2",
        "taylor.directions: found 2; expected 1, or {seed} in the command",
    ),
    (
        "\"{seed}\"]",
        "\"{seed}\"]\n[taylor]\nto = 1",
        "taylor.to: found 1; expected a finite number > 0 and < 1",
    ),
    (
        "\"{seed}\"]",
        "\"{seed}\"]\n[taylor]\neps = 0",
        "taylor.eps: found 0; expected a finite number > 0",
    ),
    (
        "\"{seed}\"]",
        "\"{seed}\"]\nfloor = 1",
        "program.floor: unknown key `floor`",
    ),
];

#[test]
fn a_study_file_that_cannot_be_used_is_refused_with_its_place() {
    for (transcript, rows) in REFUSED {
        let place = place(transcript);
        let file = place.path().join("s.toml");
        let sound = fs::read_to_string(&file).unwrap();
        for (from, to, words) in rows {
            assert!(sound.contains(from), "{from}: {sound}");
            fs::write(&file, sound.replacen(from, to, 1)).unwrap();
            let mut study = Command::new(HARNESS);
            let ended = texts(study.args(["study", "s.toml"]).current_dir(&place));
            ended.refuses(&format!("error: s.toml … {words}"));
        }
    }
}
