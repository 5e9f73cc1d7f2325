//! The project whose command line is tested: its studies claim powers of h, or run programs.

use std::path::Path;
use std::process::ExitCode;

use convergence_study::{
    Claim, Described, Document, Header, InputError, KindRow, Project, Study, Template,
    file::Positive, file::schema, levels,
};

/// The order claimed instead of 1.
const ORDER: &str = "CONVERGENCE_STUDY_TESTS_ORDER";

const PROJECT: Project = Project {
    kinds: &[
        KindRow {
            name: "power",
            schema: schema::<PowerFile>,
            read,
            why: "",
            judged: "",
            failure: "",
        },
        KindRow::PROGRAM,
        KindRow::TABLE,
        KindRow::TAYLOR,
    ],
    templates: &[Template::PROGRAM, Template::MANUFACTURE],
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
    let exponent = root.described(|file: PowerFile| Ok(file.exponent.get()))?;
    let order = std::env::var(ORDER).map_or(1.0, |text| text.parse().unwrap());
    let study = levels([4, 8, 16, 32, 64], move |n| (n as f64).powf(-exponent));
    Ok(Described::boxed(
        header,
        study.claiming("error", Claim::new(order, 0.05)),
    ))
}

fn main() -> ExitCode {
    PROJECT.run_command_line()
}
