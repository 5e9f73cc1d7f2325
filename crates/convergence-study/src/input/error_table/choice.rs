//! Which columns a user has chosen, and the command that says so.

/// Which columns of a table are meant; by default their numbers decide.
///
/// A column is named as in the table, with or without its unit, or by its number from 1.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Choice {
    /// The column of the step, or of the count that it is computed from.
    pub step: Option<String>,
    /// The columns of errors.
    pub columns: Option<Vec<String>>,
    /// Columns of values, which tend to a limit that is not zero.
    pub values: Vec<String>,
    /// Names for all columns, in place of those in the table.
    pub names: Option<Vec<String>>,
    /// Columns of which an order is claimed by name: none of them is taken for the step.
    pub claimed: Vec<String>,
    /// Dimension D > 0 of what a count counts: h = count^(-1/D).
    pub dim: Option<f64>,
    /// The command that reads the table, for advice; empty for none.
    pub command: String,
}

impl Choice {
    /// The command with this choice, changed, on a line of its own; empty where no command is known.
    pub(super) fn command(&self, change: impl FnOnce(&mut Choice)) -> String {
        let mut choice = self.clone();
        change(&mut choice);
        if choice.command.is_empty() {
            return String::new();
        }
        let is_plain = |c: char| c.is_alphanumeric() || "_-+.,/^:=@%".contains(c);
        let quoted =
            |text: String| if text.chars().all(is_plain) { text } else { format!("'{}'", text.replace('\'', "'\\''")) };
        let list = |list: Vec<String>| Some(list.join(",")).filter(|list| !list.is_empty());
        let dim = choice.dim.map(|dim| dim.to_string());
        let (names, columns) = (choice.names.and_then(list), choice.columns.and_then(list));
        let values = list(choice.values);
        let options = [("names", names), ("step", choice.step), ("dim", dim), ("columns", columns), ("values", values)];
        let given = options.into_iter().filter_map(|(name, value)| Some((name, quoted(value?))));
        let given: String = given.map(|(name, value)| format!(" --{name} {value}")).collect();
        format!("\n  {}{given}", choice.command)
    }
}
