use super::*;

#[test]
fn every_shell_gets_completions_that_know_the_commands() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.ended(&format!("completions {shell}"));
        for name in ["sweep", "report", "rates"] {
            assert!(script.well().contains(name), "{shell}");
        }
    }
}

#[test]
fn the_schemas_are_printed() {
    let (folder, project) = (Folder::new(), project("thermobeam"));
    let schemas = project.schemas();
    let made = |files: &str| {
        let own = schemas.iter().find(|(name, _)| *name == files);
        format!("{:#}\n", own.expect("a schema").1)
    };
    for (files, title) in [
        ("study", "study files of thermobeam"),
        ("scene", "scene files"),
        ("manufacture", "manufacture files"),
    ] {
        let printed = folder.ended(&format!("schema {files}"));
        let schema: serde_json::Value = serde_json::from_str(printed.well()).expect("JSON");
        assert_eq!(schema["title"], title);
        assert_eq!(printed.stdout, made(files));
    }
}
