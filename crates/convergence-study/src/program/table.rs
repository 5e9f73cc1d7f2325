//! The kind `table`: a table or a log that exists, read and judged as `rates` does, and guarded
//! with the files that it was made from.

mod file;
mod outcome;

use std::path::Path;

use super::sources::SourceFile;
use crate::input::advice::CommandLine;
use crate::input::{Refusal, schema};
use crate::rates::{self, Request, SourceTable, Tables};
use crate::study::{Case, CaseFailure, FromFile, Header, Kind, KindRow, Outcome, Ran, TableOrigin};
use file::TableFile;

/// The row of the table of kinds.
pub(super) const ROW: KindRow = KindRow {
    name: "table",
    schema: schema::of::<TableFile>,
    read: ExistingTable::read_study,
    why: "The table holds errors of a program whose exact solution is known; theory gives the order.",
    judged: "The table is read and judged as `rates` does: every number is a step, an error, or set aside, and a doubt is inconclusive. \
             The baseline keeps the hashes of the table and of the files that it was made from: if they have changed, it is inconclusive: \
             the table is of another version, or made anew, which a blessing accepts.",
    failure: "The errors of the table do not have the order, or the table cannot be read.",
};

/// A table that exists.
#[derive(Debug, Clone)]
pub(super) struct ExistingTable {
    file: SourceFile,
    inputs: Vec<SourceFile>,
    request: Request,
}

/// What was read.
pub(super) struct Read {
    tables: Vec<SourceTable>,
    sources: TableOrigin,
}

impl FromFile for ExistingTable {
    type File = TableFile;

    fn from_file(file: TableFile, _: &Header, folder: &Path) -> Result<Self, Refusal> {
        file.table(folder)
    }
}

impl ExistingTable {
    /// The hashes of the table and of its inputs.
    fn sources(&self) -> Result<TableOrigin, CaseFailure> {
        let inputs = self.inputs.iter().map(SourceFile::hashed);
        Ok(TableOrigin {
            table: self.file.hashed()?,
            inputs: inputs.collect::<Result<_, _>>()?,
        })
    }
}

impl Kind for ExistingTable {
    type Data = ();
    type Found = Read;

    fn cases(&self) -> Vec<Case<()>> {
        vec![Case::new(&self.file.name, 1.0, ())]
    }

    fn run(&self, (): &()) -> Result<Read, CaseFailure> {
        let path = self.file.path.display().to_string();
        let surface = CommandLine::default();
        let tables = rates::read(Tables::File(&path), &self.request.choice());
        Ok(Read {
            tables: tables.map_err(|refusal| CaseFailure::new(refusal.words(&surface)))?,
            sources: self.sources()?,
        })
    }

    fn judge(&self, ran: &[Ran<(), Read>]) -> Outcome {
        outcome::judge(self, ran)
    }
}
