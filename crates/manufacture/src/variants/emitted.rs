//! A module that holds all variants and chooses one when it is loaded.

use std::fmt::Write;

use super::Variant;
use crate::emit::{self, EmittedFile, Language};
use crate::model::Model;

/// The files of a language.
///
/// # Errors
/// In words: a language that has no variants yet.
pub(super) fn files(
    base: &Model,
    variants: &[Variant],
    language: Language,
) -> Result<Vec<EmittedFile>, String> {
    if language != Language::Python {
        return Err(format!(
            "variants in {}: not supported yet; expected python",
            language.name()
        ));
    }
    let mut files = emit::emit(base, language);
    // The library comes first. Functions look up each other when they are called, so that those
    // of a variant replace all of the file's, averages and norms included.
    files[0].text += &chosen(variants, language);
    Ok(files)
}

/// Statements behind the functions of the file, which are defined anew for the variant.
fn chosen(variants: &[Variant], language: Language) -> String {
    let names: Vec<String> = variants
        .iter()
        .map(|variant| format!("    \"{}\",\n", variant.switch.variant()))
        .collect();
    let mut text = format!(
        "\n\nimport os\n\n_VARIANTS = [\n{}]\n\
         _VARIANT = os.environ.get(\"MANUFACTURE_VARIANT\", \"\")\n\
         if _VARIANT and _VARIANT not in _VARIANTS:\n    \
         raise ValueError(\n        \
         f\"MANUFACTURE_VARIANT: unknown variant `{{_VARIANT}}`; expected one of {{' '.join(_VARIANTS)}}\"\n    )\n",
        names.concat()
    );
    for variant in variants {
        let name = variant.switch.variant();
        let _ = write!(text, "\nif _VARIANT == \"{name}\":\n");
        for line in emit::emit(&variant.model, language)[0].text.lines() {
            // The comments are those of the file.
            if line.starts_with('#') {
                continue;
            }
            let indent = if line.is_empty() { "" } else { "    " };
            let _ = writeln!(text, "{indent}{line}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Write;
    use std::path::Path;
    use std::process::{Command, Output, Stdio};

    use super::*;
    use crate::derive::Role;
    use crate::model::Rows;
    use crate::{Manufacture, Sampling};

    const POINTS: [[f64; 2]; 3] = [[0.1, 0.2], [0.5, 1.3], [0.9, 1.9]];

    /// The sources that the module answers, with that variable; none without Python and NumPy.
    fn answered(folder: &Path, variant: &str) -> Output {
        let mut program = Command::new("python3")
            .args(["-B", "heat_answer.py"])
            .env("MANUFACTURE_VARIANT", variant)
            .current_dir(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = "x t\n".to_owned();
        for [x, t] in POINTS {
            lines += &format!("{x} {t}\n");
        }
        // A program that refuses its variant does not read.
        let _ = program.stdin.take().unwrap().write_all(lines.as_bytes());
        program.wait_with_output().unwrap()
    }

    fn has_numpy() -> bool {
        let mut command = Command::new("python3");
        let output = command.args(["-c", "import numpy"]).output();
        output.is_ok_and(|output| output.status.success())
    }

    fn assert_source(model: &Model, output: &Output, name: &str) {
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let found: Vec<f64> = text.lines().skip(1).map(|v| v.parse().unwrap()).collect();
        assert_eq!(found.len(), POINTS.len(), "{name}: {output:?}");
        let source = model.of_role(Role::Source).next().unwrap();
        let rows = Rows::new(&model.graph, std::iter::once(&source.tensor));
        for (point, found) in POINTS.iter().zip(found) {
            let expected = rows.at(point).tensors[0][0];
            let difference = (found - expected.value).abs();
            assert!(difference <= 1e-12 * expected.size, "{name} {point:?}");
        }
    }

    #[test]
    fn the_environment_chooses_a_variant_and_an_unknown_one_is_refused() {
        if !has_numpy() {
            eprintln!("skipped: no Python with NumPy");
            return;
        }
        let manufacture = Manufacture::parse(super::super::tests::HEAT, "heat.toml").unwrap();
        let sampling = Sampling {
            points: 40,
            ..Sampling::default()
        };
        let variants = manufacture.variants(&sampling).unwrap();
        let folder = tempfile::tempdir().unwrap();
        for file in variants.emit(Language::Python).unwrap() {
            fs::write(folder.path().join(file.name), file.text).unwrap();
        }
        assert_source(&manufacture.model, &answered(folder.path(), ""), "the file");
        assert_eq!(variants.usable.len(), 7);
        for variant in &variants.usable {
            let name = variant.switch.variant();
            assert_source(&variant.model, &answered(folder.path(), &name), &name);
        }
        let output = answered(folder.path(), "flat_y_max");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success(), "{output:?}");
        let expected = "unknown variant `flat_y_max`; expected one of constant_x constant_t";
        assert!(message.contains(expected), "{message}");
    }

    #[test]
    fn a_language_without_variants_is_refused() {
        let manufacture = Manufacture::parse(super::super::tests::HEAT, "heat.toml").unwrap();
        let sampling = Sampling {
            points: 10,
            ..Sampling::default()
        };
        let variants = manufacture.variants(&sampling).unwrap();
        for (name, language) in Language::ALL {
            let is_refused = variants.emit(language).is_err();
            assert_eq!(is_refused, language != Language::Python, "{name}");
        }
    }
}
