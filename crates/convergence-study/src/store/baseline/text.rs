//! The text of the file: a line for each number, so that a difference between two versions is one
//! of lines.

use std::fmt::Write;
use std::io;

use super::{Baseline, Blessed, Guarded, Line};

/// The whole file.
pub(super) fn of(Baseline { schema, studies }: &Baseline) -> io::Result<String> {
    let mut text = format!("{{\n  \"schema\": {schema},\n  \"studies\": {{");
    let mut separator = "\n";
    for (id, blessed) in studies {
        let _ = writeln!(text, "{separator}    {}: {{", quoted(id)?);
        text += &of_study(blessed)?;
        text += "    }";
        separator = ",\n";
    }
    let end = if studies.is_empty() { "" } else { "\n  " };
    Ok(text + end + "}\n}\n")
}

fn of_study(blessed: &Blessed) -> io::Result<String> {
    let Blessed {
        settings,
        guard,
        test,
        numbers,
        claims,
        sources,
    } = blessed;
    let mut text = String::new();
    for (key, value) in [("settings", settings), ("test", test)] {
        if let Some(value) = value {
            let _ = writeln!(text, "      \"{key}\": {},", quoted(value)?);
        }
    }
    if let Some(guard) = guard {
        let _ = writeln!(text, "      \"guard\": {},", serde_json::to_string(guard)?);
    }
    if let Some(sources) = sources {
        let _ = writeln!(
            text,
            "      \"sources\": {},",
            serde_json::to_string(sources)?
        );
    }
    text += "      \"numbers\": {";
    let mut separator = "\n";
    for (name, number) in numbers {
        let Guarded {
            value,
            tolerance,
            claim,
        } = *number;
        let line = serde_json::to_string(&Line(value, tolerance, claim))?.replace(',', ", ");
        let _ = write!(text, "{separator}        {}: {line}", quoted(name)?);
        separator = ",\n";
    }
    let end = if numbers.is_empty() { "" } else { "\n      " };
    text = text + end + "}";
    let mut separator = ",\n      \"claims\": {\n";
    for (name, claim) in claims {
        let line = serde_json::to_string(claim)?;
        let _ = write!(text, "{separator}        {}: {line}", quoted(name)?);
        separator = ",\n";
    }
    let end = if claims.is_empty() {
        "\n"
    } else {
        "\n      }\n"
    };
    Ok(text + end)
}

fn quoted(text: &str) -> io::Result<String> {
    Ok(serde_json::to_string(text)?)
}
