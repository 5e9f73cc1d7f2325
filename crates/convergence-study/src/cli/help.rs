//! `--help` with the commands in groups.

use std::fmt::Write;

use super::exit;

/// The command line with its subcommands listed under headings, and the exit status explained.
///
/// * `groups`: heading, and names of subcommands. A subcommand of no group is not listed.
pub(super) fn grouped(command: clap::Command, groups: &[(&str, &[&str])]) -> clap::Command {
    let mut text = String::new();
    let width = groups.iter().flat_map(|(_, names)| names.iter()).map(|name| name.len()).max().unwrap_or(0);
    for (heading, names) in groups {
        let _ = writeln!(text, "{heading}:");
        for name in *names {
            let found = command.get_subcommands().find(|known| known.get_name() == *name);
            let about = found.and_then(clap::Command::get_about).map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(text, "  {name:width$}  {about}");
        }
        text.push('\n');
    }
    let template =
        format!("{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{text}Options:\n{{options}}\n\n{}", exit::HELP);
    command.help_template(template)
}
