//! What `--help` says beside the descriptions of arguments: examples, the options that mean nothing
//! for a command and are left out, and `--color`.

use clap::builder::EnumValueParser;
use clap::{Arg, ColorChoice, Command};

use super::screen::{Format, formats};
use crate::project::Project;

/// What the help of a command says in addition to its arguments.
#[derive(Debug, Clone, Copy)]
pub struct HelpPage {
    /// The command.
    pub command: &'static str,
    /// Options that all commands accept and that mean nothing for this one: they are left out.
    pub without: &'static [&'static str],
    /// Examples: what each does, and the line. `PROGRAM` stands for the project's command,
    /// `TEMPLATE` for what its `new` begins with.
    pub examples: &'static [(&'static str, &'static str)],
}

impl HelpPage {
    /// Those of the harness's commands. Each example works as it is in the folder that a test of
    /// the program `convergence-study` fills.
    pub fn all<'p>() -> impl Iterator<Item = &'p Self> {
        let pages = PAGES.iter();
        #[cfg(feature = "completions")]
        let pages = pages.chain([&COMPLETIONS]);
        #[cfg(feature = "manufacture")]
        let pages = pages.chain([&MANUFACTURE]);
        pages
    }
}

/// That of a command that only an installed program has.
#[cfg(feature = "completions")]
const COMPLETIONS: HelpPage = HelpPage {
    command: "completions",
    without: &[],
    examples: &[
        ("For bash", "PROGRAM completions bash > completions.bash"),
        ("For fish", "PROGRAM completions fish > completions.fish"),
    ],
};

/// That of the command `manufacture`.
#[cfg(feature = "manufacture")]
const MANUFACTURE: HelpPage = HelpPage {
    command: "manufacture",
    without: &["jobs"],
    examples: &[
        ("Check a file", "PROGRAM manufacture heat.toml"),
        (
            "Write what a solver imports",
            "PROGRAM manufacture heat.toml --language python --out sources",
        ),
    ],
};

const PAGES: [HelpPage; 7] = [
    HelpPage {
        command: "new",
        without: &["jobs"],
        examples: &[
            ("Files to start from", "PROGRAM new TEMPLATE mine"),
            ("In another folder", "PROGRAM new TEMPLATE mine --out cases"),
        ],
    },
    HelpPage {
        command: "schema",
        without: &[],
        examples: &[
            ("For an editor", "PROGRAM schema > studies.schema.json"),
            #[cfg(feature = "manufacture")]
            (
                "Of the files of `manufacture`",
                "PROGRAM schema manufacture > manufacture.schema.json",
            ),
        ],
    },
    HelpPage {
        command: "verify",
        without: &[],
        examples: &[
            ("What would run, and how long", "PROGRAM verify --dry-run"),
            ("Accept the first numbers", "PROGRAM verify --bless"),
            ("Some studies", "PROGRAM verify 'po*' --verbose"),
        ],
    },
    HelpPage {
        command: "study",
        without: &[],
        examples: &[
            ("Run a file", "PROGRAM study studies/poisson.toml"),
            (
                "Keep a report",
                "PROGRAM study studies/poisson.toml -j 2 -o page",
            ),
        ],
    },
    HelpPage {
        command: "list",
        without: &["jobs", "out"],
        examples: &[
            ("All studies", "PROGRAM list"),
            ("Some of them", "PROGRAM list 'po*' --tier quick"),
        ],
    },
    HelpPage {
        command: "rates",
        without: &["jobs"],
        examples: &[
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
    },
    HelpPage {
        command: "report",
        without: &["jobs"],
        examples: &[
            ("In its own folder", "PROGRAM report reports/results.json"),
            (
                "In another folder",
                "PROGRAM report reports/results.json -o page",
            ),
        ],
    },
];

/// The command line with examples, `--color` and `--version` for every command, and without options
/// that mean nothing.
///
/// * `others`: the pages of the project's own commands.
pub(super) fn completed(mut command: Command, project: &Project, others: &[HelpPage]) -> Command {
    for page in HelpPage::all().chain(others) {
        command = command.mut_subcommand(page.command, |mut command| {
            for option in page.without {
                command = command.mut_arg(option, |option| option.hide(true));
            }
            command.after_help(examples(page.examples, project))
        });
    }
    if project.seconds_per_cost.is_none() {
        // Nothing is known to take minutes: there is nothing to agree to.
        for name in ["verify", "study"] {
            command = command.mut_subcommand(name, |command| {
                command.mut_arg("yes", |option| option.hide(true))
            });
        }
    }
    let colour = Arg::new(COLOUR)
        .long("color")
        .value_name("WHEN")
        .value_parser(EnumValueParser::<ColorChoice>::new())
        .hide_possible_values(true)
        .default_value("auto")
        .hide_default_value(true)
        .global(true)
        .display_order(BEHIND_ALL)
        .help("Colours: always, never or auto, which is on a terminal, or as FORCE_COLOR and NO_COLOR say");
    command
        .mut_subcommand("rates", |rates| {
            rates.mut_arg("format", |format| {
                format.value_parser(formats(&[
                    Format::Text,
                    Format::Json,
                    Format::Csv,
                    Format::Md,
                    Format::Latex,
                ]))
            })
        })
        .arg(colour)
        .propagate_version(true)
}

/// A place in the list of options behind those of any command, and before `--help`.
const BEHIND_ALL: usize = 900;

/// The id of `--color`.
const COLOUR: &str = "color";

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
