//! The project whose command line is tested: its studies claim powers of h, or run programs.

use std::path::Path;
use std::process::ExitCode;

use convergence_study::{
    Claim, Form, Header, InputError, Key, KindRow, Project, Section, Study, boxed_study,
    internal::{cli, program},
    levels,
};

/// The order claimed instead of 1.
const ORDER: &str = "CONVERGENCE_STUDY_TESTS_ORDER";

const PROJECT: Project = Project {
    kinds: &[
        KindRow {
            name: "power",
            keys: &[&[&[Key::new(
                "exponent",
                Form::Positive,
                "errors are h^exponent",
            )]]],
            schema: None,
            read,
            why: "",
            judged: "",
            failure: "",
        },
        program::ROW,
        program::TABLE,
        program::TAYLOR,
    ],
    templates: &[program::TEMPLATE, program::MANUFACTURE],
    ..Project::new("powers", "powers")
};

/// Errors h^exponent, claimed to be of first order, or of the order in `ORDER`, which is in no
/// baseline.
fn read(header: Header, root: &Section<'_>, _: &Path) -> Result<Box<dyn Study>, InputError> {
    let exponent = root
        .require("exponent", "a number > 0")?
        .number_where("a number > 0", |value| value > 0.0)?;
    let order = std::env::var(ORDER).map_or(1.0, |text| text.parse().unwrap());
    let study = levels([4, 8, 16, 32, 64], move |n| (n as f64).powf(-exponent));
    Ok(boxed_study(
        header,
        study.claiming("error", Claim::new(order, 0.05)),
    ))
}

fn main() -> ExitCode {
    cli::run_command_line(&PROJECT)
}
