//! `list`: the studies that there are.

use std::error::Error;
use std::process::ExitCode;

use crate::{screen, workspace};

/// List the studies: id, tier, kind, claim
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {}

/// Prints id, tier, kind and claim of every study.
pub(crate) fn list(_: &Arguments) -> Result<ExitCode, Box<dyn Error>> {
    let studies = workspace::studies(&workspace::root()?)?;
    let row = |listed: &workspace::Listed| {
        let header = &listed.header;
        vec![header.id.clone(), header.tier.name().to_owned(), header.kind.clone(), header.claim.clone()]
    };
    let rows: Vec<Vec<String>> = studies.iter().map(row).collect();
    screen::print(&screen::table(&["study", "tier", "kind", "claim"], &rows))?;
    Ok(ExitCode::SUCCESS)
}
