//! Options of several commands: colours, versions.

use super::{command, run, texts, workspace, write};

const TABLE: &str = "h e\n0.4 1.600e-1\n0.2 4.000e-2\n0.1 1.000e-2\n0.05 2.500e-3\n";

const ESCAPE: char = '\u{1b}';

#[test]
fn colours_follow_the_option_then_the_environment() {
    let root = workspace();
    write(&root, "t", TABLE);
    let ended = |words: &[&str], option: &[&str], variables: &[(&str, &str)]| {
        let mut command = command(root.path(), words);
        for name in ["NO_COLOR", "FORCE_COLOR", "CLICOLOR_FORCE"] {
            command.env_remove(name);
        }
        texts(command.args(option).envs(variables.iter().copied()))
    };
    let is_coloured = |option: &[&str], variables: &[(&str, &str)]| {
        let ran = ended(&["rates", "t", "--order", "2"], option, variables);
        let is_coloured = ran.well().contains("\u{1b}[32mpass\u{1b}[0m");
        // Helps, and errors of the command line, follow the same rule.
        let help = ended(&["rates", "--help"], option, variables).stdout;
        let refused = ended(&["rates", "--odrer", "2"], option, variables);
        refused.refuses("");
        for text in [help, refused.stderr] {
            assert_eq!(text.contains(ESCAPE), is_coloured, "{text}");
        }
        is_coloured
    };
    let no_color = [("NO_COLOR", "1")];
    assert!(!is_coloured(&[], &[]));
    assert!(is_coloured(&["--color", "always"], &no_color));
    assert!(is_coloured(&["--color=always"], &[]));
    for forced in ["FORCE_COLOR", "CLICOLOR_FORCE"] {
        assert!(is_coloured(&[], &[(forced, "1"), ("NO_COLOR", "1")]));
        assert!(is_coloured(&["--color", "auto"], &[(forced, "1")]));
        assert!(!is_coloured(&[], &[(forced, "0")]));
        assert!(!is_coloured(&["--color", "never"], &[(forced, "1")]));
    }
    for line in ["rates --version", "verify -V"] {
        run(&root, line).says(0, env!("CARGO_PKG_VERSION"));
    }
    let ran = run(&root, "rates t --color blue");
    ran.complains(2, "'blue'");
    ran.complains(2, "never");
}
