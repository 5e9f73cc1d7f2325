//! Problems of the literature, each with mistakes in its source: the edit that is named.

use manufacture::Edit;

use crate::prelude::*;

const GAS: &str = include_str!("files/viscous-gas.toml");
const FILTERED: &str = include_str!("files/filtered-gas.toml");
const RUBBER: &str = include_str!("files/rubber.toml");
const TORUS: &str = include_str!("files/torus.toml");
const INTERVAL: &str = include_str!("files/moving-interval.toml");
const COASTAL: &str = include_str!("files/coastal.toml");

/// Flow with swirl, in a basis that turns.
pub(crate) const SWIRL: &str = include_str!("swirl.toml");

/// All of them.
pub(crate) const FILES: [&str; 6] = [GAS, FILTERED, RUBBER, TORUS, INTERVAL, COASTAL];

const SAMPLING: Sampling = Sampling {
    seed: 1,
    points: 60,
    is_strict: false,
};

/// What is said of a program whose sources are those of another file; `None` if they are not
/// finite.
pub(crate) fn compared(text: &str, other: &str, sampling: &Sampling) -> Option<Vec<Comparison>> {
    let right = read(text);
    let question = right.question(None, sampling).unwrap();
    let table = question.text().replace(' ', ",");
    let values = read(other).at(&table, "points.csv").unwrap();
    let sources = values["sources"].as_object().unwrap();
    let names: Vec<&String> = sources.keys().collect();
    let mut answer: String = names.iter().map(|name| format!("{name} ")).collect();
    for line in 0..sampling.points {
        answer.push('\n');
        for name in &names {
            answer += &format!("{:?} ", sources[*name][line].as_f64()?);
        }
    }
    Some(question.compare(&answer, "other").unwrap())
}

#[track_caller]
fn answered(text: &str, other: &str, sampling: &Sampling) -> Vec<Comparison> {
    compared(text, other, sampling).unwrap()
}

/// The components that are wrong, of which there is one at least.
#[track_caller]
fn wrong(found: &[Comparison]) -> Vec<&Comparison> {
    let wrong: Vec<_> = found.iter().filter(|c| c.cause != "equal").collect();
    assert!(!wrong.is_empty());
    wrong
}

/// The file after an edit of its text, which must have the old text at the edit's place.
#[track_caller]
pub(crate) fn applied(text: &str, edit: &Edit) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let line = &lines[edit.line - 1];
    let before: String = line.chars().take(edit.column - 1).collect();
    let rest = line[before.len()..].strip_prefix(&edit.old);
    let rest = rest.unwrap_or_else(|| panic!("{edit:?} in {line}"));
    lines[edit.line - 1] = format!("{before}{}{rest}", edit.new);
    lines.join("\n")
}

/// Whether the new text of an edit stands for its old text in the file.
pub(crate) fn is_text(edit: &Edit) -> bool {
    let whole = [
        "product-rule",
        "basis",
        "coordinates",
        "time",
        "time-factor",
    ];
    !whole.contains(&edit.kind)
}

/// A file with one text replaced is held against the file: the kind of the edit that is named, its
/// line, and its texts. The corrected text has the values of the other program.
#[track_caller]
fn named(text: &str, replaced: [&str; 2], kind: &str, texts: [&str; 2]) {
    let [old, new] = replaced;
    let other = text.replacen(old, new, 1);
    assert_ne!(text, other);
    let found = answered(text, &other, &SAMPLING);
    let line = 1 + text[..text.find(old).unwrap()].matches('\n').count();
    for comparison in wrong(&found) {
        let edits = &comparison.edits;
        assert_eq!(comparison.cause, kind, "{}", comparison.sentence);
        let first = &edits[0];
        assert_eq!([first.old.as_str(), &first.new], texts, "{comparison:?}");
        assert_eq!((first.line, edits[0].kind), (line, kind), "{comparison:?}");
        let place = format!("test.toml:{line}:{}", first.column);
        assert!(comparison.sentence.contains(&place), "{comparison:?}");
        if edits.iter().all(is_text) {
            let corrected = edits
                .iter()
                .fold(text.to_owned(), |text, e| applied(&text, e));
            let again = answered(&corrected, &other, &SAMPLING);
            let again = again.iter().find(|c| c.quantity == comparison.quantity);
            assert_eq!(again.unwrap().cause, "equal", "{comparison:?}");
        }
    }
}

/// A case says the kind of the edit that is named, and its two texts.
#[test]
fn mistakes_in_problems_of_the_literature_are_named() {
    for case in refusals(include_str!("mistakes.txt")) {
        let path = format!("{}/tests/{}", env!("CARGO_MANIFEST_DIR"), case.kind);
        let text = std::fs::read_to_string(path).unwrap();
        let (kind, texts) = case.words.split_once(": ").unwrap();
        let (before, after) = texts[1..texts.len() - 1].split_once("` -> `").unwrap();
        named(&text, [&case.old, &case.new], kind, [before, after]);
    }
}

/// `mu` stands before each divergence that acts on it, in two equations.
#[test]
fn a_viscosity_outside_of_all_derivatives_is_named() {
    let mut other = GAS.to_owned();
    for [old, new] in [
        ["-div(tau)", "-mu*div(tau/mu)"],
        ["-div(mu*cp/Pr*grad(T))", "-mu*div(cp/Pr*grad(T))"],
        ["-div(dot(tau, v))", "-mu*div(dot(tau/mu, v))"],
    ] {
        assert!(other.contains(old));
        other = other.replace(old, new);
    }
    let found = answered(GAS, &other, &SAMPLING);
    all_are(&found, "product-rule");
    let keys = wrong(&found).into_iter().map(|c| c.edits[0].key.as_str());
    assert_eq!(keys.collect::<Vec<_>>(), ["define.mu"; 4]);
}

/// The page shows what a reader would meet.
#[test]
fn the_mistake_of_the_page_is_found_as_it_says() {
    let page = include_str!("../NOTES.md");
    let section = page.split("# A mistake that is found").nth(1).unwrap();
    let block = |language: &str| {
        let block = section.split(&format!("```{language}\n")).nth(1).unwrap();
        block.split("```").next().unwrap()
    };
    let file = block("toml");
    let other = file.replace("div(v)/3", "div(v)/2");
    let lines: String = answered(file, &other, &SAMPLING)
        .iter()
        .map(|c| format!("{}\n", c.sentence.replace("test.toml", "stress.toml")))
        .collect();
    assert_eq!(
        lines + "fail: a cause is what fits, not a proof\n",
        block("text")
    );
}

/// A solution of some 1e5: its cube is far larger than its square.
const LARGE: &str = "[manufacture]\nname = \"large\"\ncoordinates = [\"x\"]\n[domain]\nx = [1, 2]\n\
[exact]\nu = \"1e5*sin(x)*exp(x)\"\n[equations.a]\ndiffusion = \"d(u, x, x)\"\nreaction = \"u^2\"\n";

/// Rounding of the other program is that of what it computes, which may be far larger than the
/// right values.
#[test]
fn an_edit_that_makes_values_large_is_named() {
    let other = LARGE.replace("u^2", "u^3");
    let question = read(LARGE);
    let question = question.question(None, &SAMPLING).unwrap();
    let values = read(&other).at(question.text(), "points.csv").unwrap();
    let values = values["sources"]["a"].as_array().unwrap().iter();
    // Another program rounds in another way.
    let rounded = values.map(|value| value.as_f64().unwrap() * (1.0 + 4.0 * f64::EPSILON));
    let answer: String = rounded.map(|value| format!("{value:?}\n")).collect();
    let found = question.compare(&answer, "other").unwrap();
    let edit = &found[0].edits[0];
    assert_eq!([edit.old.as_str(), &edit.new], ["u^2", "u^3"], "{found:?}");
}

/// Where an edit leaves a sum behind a sign, in a product or below a power.
#[test]
fn a_sum_in_place_of_a_function_has_brackets() {
    for [old, new] in [
        ["d(u, x, x) - exp(x + u)", "d(u, x, x) - (x + u)"],
        ["3*exp(x + u)*u + u^2", "3*(x + u)*u + u^2"],
        ["d(u, x) + sin(x + u)^3", "d(u, x) + (x + u)^3"],
    ] {
        let head = LARGE.split("[equations.a]").next().unwrap();
        let file = format!("{}[equations]\na = \"{old}\"\n", head.replace("1e5*", ""));
        let found = answered(&file, &file.replace(old, new), &SAMPLING);
        all_are(&found, "missing-operator");
        let corrected = applied(&file, &found[0].edits[0]);
        let again = answered(&corrected, &file.replace(old, new), &SAMPLING);
        assert_eq!(again[0].cause, "equal", "{old}: {found:?}");
    }
}

/// In all of a source, and in one of its terms.
#[test]
fn a_factor_of_time_alone_that_was_forgotten_is_named() {
    let file = |terms: [&str; 2]| {
        format!(
            "[manufacture]\nname = \"rod\"\ncoordinates = [\"x\"]\ntime = \"t\"\n[domain]\nx = [0, 1]\nt = [0, 1]\n\
             [exact]\nT = \"sin(2*x)*exp(-t)\"\n[equations.heat]\nstorage = \"{}\"\nconduction = \"{}\"\n",
            terms[0], terms[1]
        )
    };
    let right = file(["dt(T)", "-d(T, x, x)"]);
    let whole = file(["dt(T)/exp(-t)", "-d(T, x, x)/exp(-t)"]);
    let found = answered(&right, &whole, &SAMPLING);
    assert_eq!(found[0].cause, "time-factor", "{}", found[0].sentence);
    assert!(
        found[0]
            .sentence
            .ends_with("in equations.heat: your source lacks `exp(-t)`"),
        "{}",
        found[0].sentence
    );
    named(
        &right,
        ["-d(T, x, x)", "-d(T, x, x)/exp(-t)"],
        "missing-factor",
        ["-d(T, x, x)", "-d(T, x, x)/exp(-t)"],
    );
}

/// By its value, with its line: also where the file has zero, which no factor changes.
#[test]
fn a_parameter_with_another_value_is_named() {
    for [old, new] in [["0", "0.5"], ["0.7", "1.4"], ["0.3", "0.45"]] {
        let file = format!(
            "[manufacture]\nname = \"rod\"\ncoordinates = [\"x\"]\n[domain]\nx = [0, 1]\n[parameters]\nb = {old}\n\
             [exact]\nu = \"sin(2*x)\"\n[equations]\nbalance = \"-d(u, x, x) + sin(b*u)*cos(b*x)\"\n"
        );
        let values = [format!("b = {old}"), format!("b = {new}")];
        let [before, after] = values.each_ref().map(String::as_str);
        named(&file, [before, after], "parameter", [old, new]);
    }
}

/// Whether all components that are wrong have this cause, and an edit with a line.
#[track_caller]
fn all_are(found: &[Comparison], cause: &str) {
    for comparison in wrong(found) {
        assert_eq!(comparison.cause, cause, "{}", comparison.sentence);
        assert!(comparison.edits[0].line > 0, "{}", comparison.sentence);
    }
}
