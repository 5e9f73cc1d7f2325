//! The study file beside the emitted files.

use std::fmt::Write;

use super::EmittedFile;
use crate::model::Model;

/// The study file, if the file has `[study]`.
pub(crate) fn study(model: &Model) -> Option<EmittedFile> {
    let problem = &model.problem;
    let study = problem.study.as_ref()?;
    let id = problem.name.to_lowercase().replace('_', "-");
    let orders = study.order.iter();
    let orders = orders.map(|(error, order)| format!("{error}: {}", order.get()));
    let claim = orders.collect::<Vec<_>>().join(", ");
    let mut text = format!(
        "[study]\nid = \"{id}\"\nclaim = \"orders of the errors against the manufactured solution: {claim}\"\n\
         kind = \"program\"\ntier = \"quick\"\n\n[program]\ncommand = {:?}\n# The folder of the program, as seen from this file: change it with the place of the file.\ndirectory = \".\"\n\n[refine]\nn = {:?}\n",
        study.command,
        study.n.counts()
    );
    for (error, order) in &study.order {
        let order = order.get();
        let _ = write!(
            text,
            "\n[[expect]]\nerror = {error:?}\norder = {order}\ntolerance = {}\n",
            (0.5 * order).min(0.25)
        );
    }
    Some(EmittedFile {
        name: format!("{}.study.toml", problem.name),
        text,
    })
}
