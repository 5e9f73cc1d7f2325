//! Models that replace each other at run time: an environment variable chooses one.

use super::fill;
use super::texts::Choice;
use super::writer::Writer;

/// Bodies of a function, that of the file first and then those of the alternatives: one where all
/// are alike, otherwise each in its branch.
pub(super) fn body(writer: &Writer<'_>, bodies: &[String]) -> String {
    let base = &bodies[0];
    let mut cases: Vec<(&String, Vec<String>)> = vec![];
    let choice = &writer.texts().choice;
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
        let values = [("EL", el(place)), ("ALL", &numbers.join(choice.between))];
        text += &fill(choice.case, &values);
        text += &branch(choice, body);
    }
    text + choice.otherwise + &branch(choice, base) + choice.after
}

/// What stands before `if` in the case at a place.
pub(super) fn el(place: usize) -> &'static str {
    if place == 0 { "" } else { "el" }
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
    let choice = &writer.texts().choice;
    let alternatives = writer.models.iter().skip(1);
    let names: Vec<&str> = alternatives.map(|model| model.name.as_str()).collect();
    let longest = names.iter().map(|name| name.len()).max().unwrap_or(0);
    let list: Vec<String> = names
        .iter()
        .map(|name| fill(choice.name, &[("NAME", name)]))
        .collect();
    let current = if writer.changes_parameters() {
        choice.current
    } else {
        ""
    };
    fill(
        choice.functions,
        &[
            ("LIST", &list.join(choice.between_names)),
            ("LONGEST", &longest.to_string()),
            ("COUNT", &(names.len() + 1).to_string()),
            ("LAST", &names.len().to_string()),
            ("CURRENT", current),
            ("CHANGES", &changes(writer)),
            ("P", &writer.prefix),
        ],
    )
}

/// Statements by which parameters get the values of the model that is chosen.
pub(super) fn changes(writer: &Writer<'_>) -> String {
    let choice = &writer.texts().choice;
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
        writer.texts().choice.variable
    } else {
        ""
    }
}

/// The statement by which a model is chosen, where the language needs one before what depends on
/// the choice.
pub(super) fn ready(writer: &Writer<'_>) -> String {
    if writer.has_alternatives() {
        fill(writer.texts().choice.ready, &[("P", &writer.prefix)])
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
        writer.texts().choice.advice,
        names.join(" ")
    )
}
