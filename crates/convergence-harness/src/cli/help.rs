//! What `--help` says beside the descriptions of arguments: examples, the options that mean nothing
//! for a command and are left out, and `--color`.

use clap::builder::EnumValueParser;
use clap::{Arg, Command};

use super::screen::{Colour, Format, formats};
use crate::project::Project;

/// Examples of each command: what it does, and the line. `PROGRAM` stands for the project's
/// command, `TEMPLATE` for what its `new` begins with. Each line works as it is in the folder that a
/// test of the program `convergence-study` fills.
pub const EXAMPLES: [(&str, &[(&str, &str)]); 12] = [
    (
        "new",
        &[
            ("Files to start from", "PROGRAM new TEMPLATE mine"),
            ("In another folder", "PROGRAM new TEMPLATE mine --out cases"),
        ],
    ),
    (
        "schema",
        &[("For an editor", "PROGRAM schema > studies.schema.json")],
    ),
    (
        "manufacture",
        &[
            ("Check a file", "PROGRAM manufacture heat.toml"),
            (
                "Write what a solver imports",
                "PROGRAM manufacture heat.toml --language python --out sources",
            ),
        ],
    ),
    (
        "verify",
        &[
            ("What would run, and how long", "PROGRAM verify --dry-run"),
            ("Accept the first numbers", "PROGRAM verify --bless"),
            ("Some studies", "PROGRAM verify 'po*' --durations"),
        ],
    ),
    (
        "study",
        &[
            ("Run a file", "PROGRAM study studies/poisson.toml"),
            (
                "Keep a report",
                "PROGRAM study studies/poisson.toml -j 2 -o page",
            ),
        ],
    ),
    (
        "list",
        &[
            ("All studies", "PROGRAM list"),
            ("Some of them", "PROGRAM list 'po*' --tier quick"),
        ],
    ),
    (
        "explain",
        &[
            ("A reason for a verdict", "PROGRAM explain too-low"),
            ("A study", "PROGRAM explain poisson"),
        ],
    ),
    (
        "rates",
        &[
            ("A table", "PROGRAM rates errors.csv --order 2"),
            (
                "Several, one column with an order of its own",
                "PROGRAM rates errors.csv finer.csv --order 2 --order H1=1",
            ),
            (
                "What a solver prints, with cells in the plane",
                "cat log.txt | PROGRAM rates --order 2 --dim 2",
            ),
        ],
    ),
    (
        "compare",
        &[
            (
                "Two versions",
                "PROGRAM compare old.json reports/results.json",
            ),
            (
                "Every error",
                "PROGRAM compare old.json reports/results.json --all",
            ),
        ],
    ),
    (
        "report",
        &[
            ("In its own folder", "PROGRAM report reports/results.json"),
            (
                "In another folder",
                "PROGRAM report reports/results.json -o page",
            ),
        ],
    ),
    (
        "completions",
        &[("For bash", "PROGRAM completions bash > completions.bash")],
    ),
    (
        "man",
        &[
            ("The page of the program", "PROGRAM man > program.1"),
            ("The page of a command", "PROGRAM man rates > rates.1"),
        ],
    ),
];

/// Options that all commands accept and that mean nothing for these.
const WITHOUT_MEANING: [(&str, &[&str]); 7] = [
    ("list", &["jobs", "out"]),
    ("explain", &["jobs", "out"]),
    ("rates", &["jobs"]),
    ("compare", &["jobs"]),
    ("report", &["jobs"]),
    ("new", &["jobs"]),
    ("manufacture", &["jobs"]),
];

/// The command line with examples, `--color` and `--version` for every command, and without options
/// that mean nothing.
pub(super) fn completed(mut command: Command, project: &Project) -> Command {
    for (name, lines) in EXAMPLES {
        let examples = examples(lines, project);
        command = command.mut_subcommand(name, |command| command.after_help(examples));
    }
    for (name, options) in WITHOUT_MEANING {
        for option in options {
            command = command.mut_subcommand(name, |command| {
                command.mut_arg(option, |option| option.hide(true))
            });
        }
    }
    let colour = Arg::new(COLOUR)
        .long("color")
        .value_name("WHEN")
        .value_parser(EnumValueParser::<Colour>::new())
        .hide_possible_values(true)
        .default_value("auto")
        .hide_default_value(true)
        .global(true)
        .help("Colours: always, never or auto, which is on a terminal, or as FORCE_COLOR and NO_COLOR say");
    command
        .mut_subcommand("rates", |rates| {
            rates.mut_arg("format", |format| {
                format.value_parser(formats(&[
                    Format::Text,
                    Format::Json,
                    Format::Csv,
                    Format::Md,
                ]))
            })
        })
        .arg(colour)
        .propagate_version(true)
}

/// The id of `--color`.
pub(super) const COLOUR: &str = "color";

fn examples(lines: &[(&str, &str)], project: &Project) -> String {
    let template = project.templates.first().map_or("", |first| first.name);
    let mut text = "Examples:".to_owned();
    for (what, line) in lines {
        let line = line
            .replace("PROGRAM", project.command)
            .replace("TEMPLATE", template);
        text += &format!("\n  {line}\n      {what}");
    }
    text
}
