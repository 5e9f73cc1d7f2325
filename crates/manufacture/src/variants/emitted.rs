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
