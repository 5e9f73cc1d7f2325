//! The project whose command line is tested: its studies claim powers of h, or run programs.

use std::path::Path;
use std::process::ExitCode;

use convergence_study::{
    Claim, Document, Header, InputError, KindRow, Project, Study, boxed_study, described,
    file::Positive,
    internal::{input::schema, program},
    levels, run_command_line,
};

/// The order claimed instead of 1.
const ORDER: &str = "CONVERGENCE_STUDY_TESTS_ORDER";

const PROJECT: Project = Project {
    kinds: &[
        KindRow {
            name: "power",
            schema: schema::of::<PowerFile>,
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

/// A study of this kind.
#[derive(serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct PowerFile {
    /// errors are h^exponent
    exponent: Positive,
}

/// Errors h^exponent, claimed to be of first order, or of the order in `ORDER`, which is in no
/// baseline.
fn read(header: Header, root: &Document<'_>, _: &Path) -> Result<Box<dyn Study>, InputError> {
    let exponent = described(root, |file: PowerFile| Ok(file.exponent.get()))?;
    let order = std::env::var(ORDER).map_or(1.0, |text| text.parse().unwrap());
    let study = levels([4, 8, 16, 32, 64], move |n| (n as f64).powf(-exponent));
    Ok(boxed_study(
        header,
        study.claiming("error", Claim::new(order, 0.05)),
    ))
}

fn main() -> ExitCode {
    run_command_line(&PROJECT)
}
