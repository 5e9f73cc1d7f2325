//! Models that replace each other at run time: an environment variable chooses one.

use super::write::Writer;
use super::{Language, fill};
use crate::model::Model;

/// A model whose functions take the place of those of another where its name is chosen.
#[derive(Debug, Clone)]
pub(crate) struct Alternative<'m> {
    pub(crate) name: String,
    pub(crate) model: &'m Model,
}

/// How a language chooses among bodies. In the texts `P` is the prefix of C, `ALL` the numbers of
/// the models that have the body.
struct Choice {
    /// What precedes all branches.
    before: &'static str,
    first: &'static str,
    later: &'static str,
    otherwise: &'static str,
    /// Behind the statements of each branch.
    close: &'static str,
    /// Behind all branches.
    after: &'static str,
    /// Before each line of a branch, besides its own indent.
    indent: &'static str,
    number: &'static str,
    between: &'static str,
    /// The functions that choose.
    functions: &'static str,
    /// The name of a model in their list, and what separates it from the next.
    name: &'static str,
    between_names: &'static str,
    /// A variable of the module.
    variable: &'static str,
    /// The statement without which nothing is chosen yet, where a function needs it.
    ready: &'static str,
    /// Parameters of a model that differ from those of the file; `CHANGES` are assignments.
    changes: &'static str,
    change: &'static str,
    /// What a program has to do.
    advice: &'static str,
}

const C: Choice = Choice {
    before: "    switch (@P@variant()) {\n",
    first: "    @ALL@ {\n",
    later: "    @ALL@ {\n",
    otherwise: "    default: {\n",
    close: "    } break;\n",
    after: "    }\n",
    indent: "    ",
    number: "case @K@:",
    between: " ",
    functions: include_str!("templates/variant.c"),
    name: "\"@NAME@\"",
    between_names: ",\n        ",
    variable: "",
    ready: "    @P@variant();\n",
    changes: "        if (place == @K@) {\n@CHANGES@        }\n",
    change: "            @NAME@ = @VALUE@;\n",
    advice: "",
};

const FORTRAN: Choice = Choice {
    before: "    select case (variant)\n",
    first: "    case (@ALL@)\n",
    later: "    case (@ALL@)\n",
    otherwise: "    case default\n",
    close: "",
    after: "    end select\n",
    indent: "    ",
    number: "@K@",
    between: ", ",
    functions: include_str!("templates/variant.f90"),
    name: "'@NAME@'",
    between_names: ", &\n        ",
    variable: "integer, private :: variant = -1\n",
    ready: "    call require_variant()\n",
    changes: "    if (place == @K@) then\n@CHANGES@    end if\n",
    change: "        @NAME@ = @VALUE@\n",
    advice: "Programs must call choose_variant() before any other procedure. ",
};

const PYTHON: Choice = Choice {
    before: "",
    first: "    if _VARIANT in [@ALL@]:\n",
    later: "    elif _VARIANT in [@ALL@]:\n",
    otherwise: "    else:\n",
    close: "",
    after: "",
    indent: "    ",
    number: "@K@",
    between: ", ",
    functions: include_str!("templates/variant.py"),
    name: "\"@NAME@\"",
    between_names: ",\n    ",
    variable: "",
    ready: "",
    changes: "if _VARIANT == @K@:\n@CHANGES@",
    change: "    @NAME@ = @VALUE@\n",
    advice: "",
};

const OCTAVE: Choice = Choice {
    before: "  switch variant()\n",
    first: "    case {@ALL@}\n",
    later: "    case {@ALL@}\n",
    otherwise: "    otherwise\n",
    close: "",
    after: "  end\n",
    indent: "    ",
    number: "@K@",
    between: ", ",
    functions: include_str!("templates/variant.m"),
    name: "'@NAME@'",
    between_names: ", ...\n      ",
    variable: "",
    ready: "",
    changes: "    if variant() == @K@\n@CHANGES@    end\n",
    change: "      known.@NAME@ = @VALUE@;\n",
    advice: "",
};

const RUST: Choice = Choice {
    before: "    match variant() {\n",
    first: "        @ALL@ => {\n",
    later: "        @ALL@ => {\n",
    otherwise: "        _ => {\n",
    close: "        }\n",
    after: "    }\n",
    indent: "        ",
    number: "@K@",
    between: " | ",
    functions: include_str!("templates/variant.rs"),
    name: "\"@NAME@\"",
    between_names: ",\n            ",
    variable: "",
    ready: "    variant();\n",
    changes: "        if place == @K@ {\n@CHANGES@        }\n",
    change: "            @NAME@.store(f64::to_bits(@VALUE@), Relaxed);\n",
    advice: "",
};

fn choice(language: Language) -> &'static Choice {
    match language {
        Language::C => &C,
        Language::Fortran => &FORTRAN,
        Language::Python | Language::Ufl => &PYTHON,
        Language::Octave => &OCTAVE,
        Language::Rust => &RUST,
    }
}

/// Bodies of a function, that of the file first and then those of the alternatives: one where all
/// are alike, otherwise each in its branch.
pub(super) fn body(writer: &Writer<'_>, bodies: &[String]) -> String {
    let base = &bodies[0];
    let mut cases: Vec<(&String, Vec<String>)> = vec![];
    let choice = choice(writer.language);
    for (number, body) in bodies.iter().enumerate().filter(|entry| entry.1 != base) {
        let number = fill(choice.number, &[("K", &number.to_string())]);
        match cases.iter_mut().find(|case| case.0 == body) {
            Some(case) => case.1.push(number),
            None => cases.push((body, vec![number])),
        }
    }
    if cases.is_empty() {
        return base.clone();
    }
    let mut text = fill(choice.before, &[("P", &writer.prefix)]);
    for (place, (body, numbers)) in cases.iter().enumerate() {
        let opening = if place == 0 {
            choice.first
        } else {
            choice.later
        };
        text += &fill(opening, &[("ALL", &numbers.join(choice.between))]);
        text += &branch(choice, body);
    }
    text + choice.otherwise + &branch(choice, base) + choice.after
}

fn branch(choice: &Choice, body: &str) -> String {
    let lines = body
        .lines()
        .map(|line| format!("{}{line}\n", choice.indent));
    lines.collect::<String>() + choice.close
}

/// The functions that choose a model; none without alternatives.
pub(super) fn functions(writer: &Writer<'_>) -> String {
    if !writer.has_alternatives() {
        return String::new();
    }
    let choice = choice(writer.language);
    let alternatives = writer.models.iter().skip(1);
    let names: Vec<&str> = alternatives.map(|model| model.name.as_str()).collect();
    let longest = names.iter().map(|name| name.len()).max().unwrap_or(0);
    let list: Vec<String> = names
        .iter()
        .map(|name| fill(choice.name, &[("NAME", name)]))
        .collect();
    fill(
        choice.functions,
        &[
            ("LIST", &list.join(choice.between_names)),
            ("LONGEST", &longest.to_string()),
            ("COUNT", &(names.len() + 1).to_string()),
            ("LAST", &names.len().to_string()),
            ("CURRENT", current(writer)),
            ("CHANGES", &changes(writer)),
            ("P", &writer.prefix),
        ],
    )
}

/// How C reads a parameter whose value depends on the model.
fn current(writer: &Writer<'_>) -> &'static str {
    if writer.changes_parameters() {
        "static double @P@current(const double *parameter)\n{\n    @P@variant();\n    return *parameter;\n}\n\n"
    } else {
        ""
    }
}

/// Statements by which parameters get the values of the model that is chosen.
pub(super) fn changes(writer: &Writer<'_>) -> String {
    let choice = choice(writer.language);
    let base = &writer.models[0].model.graph.parameters;
    let mut text = String::new();
    for (number, model) in writer.models.iter().enumerate().skip(1) {
        let values = base.iter().zip(&model.model.graph.parameters);
        let values = writer.parameters.iter().zip(values);
        let changed = values.filter(|(_, (base, value))| base != value);
        let mut changes = String::new();
        for (name, (_, value)) in changed {
            let value = writer.language.number(*value);
            changes += &fill(choice.change, &[("NAME", name), ("VALUE", &value)]);
        }
        if !changes.is_empty() {
            let number = number.to_string();
            text += &fill(choice.changes, &[("K", &number), ("CHANGES", &changes)]);
        }
    }
    text
}

/// The variable of the module that holds the choice.
pub(super) fn variable(writer: &Writer<'_>) -> &'static str {
    if writer.has_alternatives() {
        choice(writer.language).variable
    } else {
        ""
    }
}

/// The statement by which a model is chosen, where the language needs one before what depends on
/// the choice.
pub(super) fn ready(writer: &Writer<'_>) -> String {
    if writer.has_alternatives() {
        fill(choice(writer.language).ready, &[("P", &writer.prefix)])
    } else {
        String::new()
    }
}

/// The line of the first comment.
pub(super) fn head(writer: &Writer<'_>) -> String {
    if !writer.has_alternatives() {
        return String::new();
    }
    let alternatives = writer.models.iter().skip(1);
    let names: Vec<&str> = alternatives.map(|model| model.name.as_str()).collect();
    format!(
        "{}Variants, chosen by the environment variable MANUFACTURE_VARIANT: {}\n",
        choice(writer.language).advice,
        names.join(" ")
    )
}
