//! The tables of a file: what a struct cannot say of them, and what they mean.

use std::collections::BTreeMap;

use super::entries::{Entry, Located};
use super::file::{HeadTable, Named, ProblemFile, VariantsTable};
use super::reader::Reader;
use super::{
    Datum, Definition, Equation, EquationTerm, Expression, Face, InputError, Location, Parameter,
    Problem, Surface, System, constant,
};
use crate::language::is_of_name;
use crate::language::names::{did_you_mean, reserved, unknown};

fn identifier(
    reader: Reader<'_>,
    key: &str,
    entry: &Located<String>,
) -> Result<String, InputError> {
    let place = reader.location(format!("manufacture.{key}"), &entry.span);
    check_identifier(&entry.value, &place)?;
    Ok(entry.value.clone())
}

impl Problem {
    /// Reads the text of a file.
    pub(crate) fn parse(text: &str, file: &str) -> Result<Self, InputError> {
        let reader = Reader { file, text };
        let tables = reader.read()?;
        let head = &tables.manufacture.value;
        let coordinates = head.coordinates.value.iter();
        let coordinates = coordinates.map(|entry| identifier(reader, "coordinates", entry));
        let mut problem = Self {
            file: file.to_owned(),
            name: identifier(reader, "name", &head.name)?,
            name_place: reader.location("manufacture.name", &head.name.span),
            coordinates: coordinates.collect::<Result<_, _>>()?,
            time: head
                .time
                .as_ref()
                .map(|entry| identifier(reader, "time", entry))
                .transpose()?,
            system: head.system,
            intervals: vec![],
            ends: vec![],
            parameters: parameters(reader, &tables.parameters)?,
            definitions: BTreeMap::new(),
            equations: equations(reader, &tables.equations)?,
            faces: vec![],
            initial: vec![],
            positive: expressions(reader, "require.positive", &tables.require.positive)?,
            zero: expressions(reader, "require.zero", &tables.require.zero)?,
            norms: vec![],
            study: tables.study.clone(),
            switchable: vec![],
            variation: None,
        };
        problem.space(reader, head)?;
        if let Some(variants) = &tables.variants {
            problem.variants(reader, variants)?;
        }
        problem.define(reader, &tables)?;
        problem.check_names(&reader.location("manufacture", &tables.manufacture.span))?;
        problem.domain(reader, &tables.domain)?;
        problem.boundary(reader, &tables.boundary)?;
        if let Some(initial) = &tables.initial {
            problem.initial(reader, initial)?;
        }
        problem.norms(reader, &tables)?;
        Ok(problem)
    }

    /// `[variants]`.
    fn variants(&mut self, reader: Reader<'_>, table: &VariantsTable) -> Result<(), InputError> {
        let known: Vec<&str> = self
            .parameters
            .iter()
            .map(|entry| entry.name.as_str())
            .collect();
        for Located { span, value: name } in &table.parameters {
            if !known.contains(&name.as_str()) {
                let problem = unknown("parameter", name, &known);
                return Err(reader.location("variants.parameters", span).error(problem));
            }
            self.switchable.push(name.clone());
        }
        Ok(())
    }

    fn space(&self, reader: Reader<'_>, head: &HeadTable) -> Result<(), InputError> {
        let place = reader.location("manufacture.coordinates", &head.coordinates.span);
        let found = self.coordinates.len();
        if !(1..=3).contains(&found) {
            return Err(place.error(format!("expected 1 to 3 coordinates, found {found}")));
        }
        let expected = match self.system {
            System::Cartesian => found,
            System::Polar | System::Axisymmetric => 2,
            System::Cylindrical => 3,
        };
        if found != expected {
            let problem = format!("expected {expected} coordinates of this system, found {found}");
            return Err(place.error(problem));
        }
        Ok(())
    }

    fn define(&mut self, reader: Reader<'_>, tables: &ProblemFile) -> Result<(), InputError> {
        let sections = [
            ("exact", &tables.exact, true),
            ("define", &tables.define, false),
        ];
        for (section, entries, is_exact) in sections {
            for (name, entry) in entries {
                let key = format!("{section}.{name}");
                let definition = Definition {
                    value: reader.tensor(&key, entry)?,
                    is_exact,
                };
                if self.definitions.insert(name.clone(), definition).is_some() {
                    return Err(twice(name, &reader.location(key, &entry.span)));
                }
            }
        }
        Ok(())
    }

    /// Each name is an identifier, is not reserved, and has one meaning.
    fn check_names(&self, head: &Location) -> Result<(), InputError> {
        let mut names: Vec<(&str, &Location)> = vec![];
        for variable in self.variables() {
            names.push((variable, head));
        }
        for Parameter { name, expression } in &self.parameters {
            names.push((name, &expression.place));
        }
        for (name, definition) in &self.definitions {
            names.push((name, definition.value.place()));
        }
        for (index, (name, place)) in names.iter().enumerate() {
            check_name(name, place)?;
            if names[..index].iter().any(|earlier| earlier.0 == *name) {
                return Err(twice(name, place));
            }
        }
        Ok(())
    }

    fn domain(
        &mut self,
        reader: Reader<'_>,
        table: &Located<Named<Vec<Located<Entry>>>>,
    ) -> Result<(), InputError> {
        let variables = self.variables();
        known_only(reader, "domain", &table.value, &variables)?;
        let values = self.parameter_values(&[])?;
        let names = self
            .parameters
            .iter()
            .map(|parameter| parameter.name.as_str());
        let known: Vec<(&str, f64)> = names.zip(values).collect();
        let mut intervals = vec![];
        let mut written = vec![];
        for variable in &variables {
            let key = format!("domain.{variable}");
            let Some(Located { span, value: ends }) = table.value.get(*variable) else {
                let problem = format!("expected the key `{variable}`, found none");
                return Err(reader.location("domain", &table.span).error(problem));
            };
            let place = reader.location(&key, span);
            let [low, high] = ends.as_slice() else {
                let problem = format!("expected two numbers, found {}", ends.len());
                return Err(place.error(problem));
            };
            let [low, high] = [low, high].map(|end| reader.expression(&key, end));
            let ends = [low?, high?];
            let [low, high] = ends.each_ref().map(|end| constant(end, &known));
            let (low, high) = (low?, high?);
            written.extend(ends);
            if !(low < high) {
                let problem = format!(
                    "expected an interval, two numbers of which the first is the smaller; found [{low}, {high}]"
                );
                return Err(place.error(problem));
            }
            if self.system != System::Cartesian && intervals.is_empty() && low < 0.0 {
                return Err(place.error("expected a radius of at least 0"));
            }
            intervals.push([low, high]);
        }
        self.intervals = intervals;
        self.ends = written;
        Ok(())
    }

    fn boundary(&mut self, reader: Reader<'_>, tables: &Named<Entry>) -> Result<(), InputError> {
        for (name, entry) in tables {
            let key = format!("boundary.{name}");
            let place = reader.location(&key, &entry.span);
            check_identifier(name, &place)?;
            let table = reader.table(&key, entry)?;
            let mut entries = table
                .iter()
                .filter(|one| !["face", "level"].contains(&one.0.as_str()));
            self.faces.push(Face {
                name: name.clone(),
                surface: self.surface(reader, name, &place, table)?,
                place,
                data: data(reader, &key, &mut entries)?,
            });
        }
        // The sides in the order of the coordinates, so that other names change no order.
        self.faces.sort_by_key(|face| match face.surface {
            Surface::Side {
                coordinate,
                is_upper,
            } => (coordinate, is_upper),
            Surface::Level(_) => (usize::MAX, false),
        });
        Ok(())
    }

    fn surface(
        &self,
        reader: Reader<'_>,
        name: &str,
        place: &Location,
        table: &Named<Entry>,
    ) -> Result<Surface, InputError> {
        let of_face = format!("{}.face", place.key);
        let mut name = name;
        if let Some(face) = table.get("face") {
            let Entry::Text(text) = &face.value else {
                return Err(reader.unexpected(&of_face, face, "a text"));
            };
            name = text;
        }
        match [table.get("level"), table.get("face")] {
            [Some(_), Some(face)] => {
                let place = reader.location(of_face, &face.span);
                return Err(place.error("found `face` and `level`; expected one of them"));
            }
            [Some(level), None] => {
                let level = reader.expression(&format!("{}.level", place.key), level)?;
                return Ok(Surface::Level(level));
            }
            _ => (),
        }
        let sides = ["_min", "_max"];
        let all = self
            .coordinates
            .iter()
            .enumerate()
            .flat_map(|(index, coordinate)| {
                sides.map(|side| (index, side == "_max", format!("{coordinate}{side}")))
            });
        let all: Vec<(usize, bool, String)> = all.collect();
        match all.iter().find(|side| side.2 == name) {
            Some((coordinate, is_upper, _)) => Ok(Surface::Side {
                coordinate: *coordinate,
                is_upper: *is_upper,
            }),
            None => {
                let near = did_you_mean(name, all.iter().map(|side| side.2.as_str()));
                let known: Vec<&str> = all.iter().map(|side| side.2.as_str()).collect();
                let known = known.join(" ");
                Err(place.error(format!(
                    "`{name}` is no face{near}; expected one of {known}, or a key `face` or `level`"
                )))
            }
        }
    }

    fn initial(
        &mut self,
        reader: Reader<'_>,
        table: &Located<Named<Entry>>,
    ) -> Result<(), InputError> {
        if self.time.is_none() {
            let problem = "expected no initial data without `time` in [manufacture]";
            return Err(reader.location("initial", &table.span).error(problem));
        }
        self.initial = data(reader, "initial", &mut table.value.iter())?;
        Ok(())
    }

    fn norms(&mut self, reader: Reader<'_>, tables: &ProblemFile) -> Result<(), InputError> {
        let fields: Vec<&str> = tables.exact.keys().map(String::as_str).collect();
        known_only(reader, "norms", &tables.norms, &fields)?;
        let norms = tables.norms.iter();
        self.norms = norms
            .map(|(field, entry)| (field.clone(), entry.value.clone()))
            .collect();
        Ok(())
    }
}

/// Refuses names other than these.
fn known_only<T>(
    reader: Reader<'_>,
    table: &str,
    entries: &Named<T>,
    known: &[&str],
) -> Result<(), InputError> {
    match entries
        .iter()
        .find(|entry| !known.contains(&entry.0.as_str()))
    {
        None => Ok(()),
        Some((name, entry)) => {
            let problem = unknown("key", name, known);
            Err(reader
                .location(format!("{table}.{name}"), &entry.span)
                .error(problem))
        }
    }
}

fn twice(name: &str, place: &Location) -> InputError {
    place.error(format!(
        "found `{name}` twice; expected one meaning of each name"
    ))
}

fn check_identifier(name: &str, place: &Location) -> Result<(), InputError> {
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(is_of_name) {
        return Ok(());
    }
    let problem = format!("found the name `{name}`; expected a letter, then letters, digits and _");
    Err(place.error(problem))
}

fn check_name(name: &str, place: &Location) -> Result<(), InputError> {
    check_identifier(name, place)?;
    if reserved().any(|word| word == name) {
        let meaning = match name {
            "pi" | "e" => "a constant",
            "n" => "the unit normal",
            "identity" => "the unit tensor",
            _ => "a function",
        };
        let problem = format!("the name `{name}` is {meaning}; expected another name");
        return Err(place.error(problem));
    }
    Ok(())
}

/// Each parameter after those that it depends on, otherwise in alphabetical order.
fn parameters(reader: Reader<'_>, entries: &Named<Entry>) -> Result<Vec<Parameter>, InputError> {
    let mut open = vec![];
    for (name, entry) in entries {
        open.push(Parameter {
            name: name.clone(),
            expression: reader.expression(&format!("parameters.{name}"), entry)?,
        });
    }
    let mut ordered = vec![];
    while !open.is_empty() {
        let is_ready = |one: &Parameter| open.iter().all(|other| !one.depends_on(other));
        let Some(place) = open.iter().position(is_ready) else {
            return Err(circle(&open));
        };
        ordered.push(open.remove(place));
    }
    Ok(ordered)
}

/// The error of parameters each of which depends on another of them.
fn circle(open: &[Parameter]) -> InputError {
    let mut path = vec![&open[0]];
    loop {
        let last = path[path.len() - 1];
        let next = open.iter().find(|other| last.depends_on(other));
        let next = next.unwrap_or(last);
        let first = path.iter().position(|known| known.name == next.name);
        path.push(next);
        if let Some(first) = first {
            let names: Vec<&str> = path[first..].iter().map(|one| one.name.as_str()).collect();
            let place = &path[first].expression.place;
            return place.error(format!("a circle: {}", names.join(" -> ")));
        }
    }
}

fn equations(
    reader: Reader<'_>,
    table: &Located<Named<Entry>>,
) -> Result<Vec<Equation>, InputError> {
    let mut equations = vec![];
    for (name, entry) in &table.value {
        let key = format!("equations.{name}");
        let place = reader.location(&key, &entry.span);
        check_identifier(name, &place)?;
        let terms = match &entry.value {
            Entry::Table(entries) if entries.is_empty() => {
                return Err(place.error("expected at least one term, found none"));
            }
            Entry::Table(entries) => named_terms(reader, &key, entries)?,
            _ => terms(&reader.expression(&key, entry)?),
        };
        equations.push(Equation {
            name: name.clone(),
            place,
            terms,
        });
    }
    if equations.is_empty() {
        let place = reader.location("equations", &table.span);
        return Err(place.error("expected at least one equation, found none"));
    }
    Ok(equations)
}

/// The terms of a table, in alphabetical order, each with its place in the file.
fn named_terms(
    reader: Reader<'_>,
    table: &str,
    entries: &Named<Entry>,
) -> Result<Vec<EquationTerm>, InputError> {
    let mut terms = vec![];
    for (label, entry) in entries {
        let others = entries.values();
        terms.push(EquationTerm {
            label: label.clone(),
            place: others
                .filter(|other| other.span.start < entry.span.start)
                .count(),
            is_negative: false,
            expression: reader.expression(&format!("{table}.{label}"), entry)?,
        });
    }
    Ok(terms)
}

/// A text is cut into terms at its top-level + and -.
fn terms(expression: &Expression) -> Vec<EquationTerm> {
    let mut terms: Vec<EquationTerm> = vec![];
    for summand in expression.tree.summands() {
        let sign = if summand.is_negative { "-" } else { "" };
        let mut label = format!("{sign}{}", summand.tree);
        // Two equal summands have different labels.
        while terms.iter().any(|term| term.label == label) {
            label.push('\'');
        }
        terms.push(EquationTerm {
            label,
            place: terms.len(),
            is_negative: summand.is_negative,
            expression: Expression {
                tree: summand.tree.clone(),
                ..expression.clone()
            },
        });
    }
    terms
}

/// The values of `[boundary]` or `[initial]`, each given or with the value that it must have.
fn data<'e>(
    reader: Reader<'_>,
    table: &str,
    entries: &mut dyn Iterator<Item = (&'e String, &'e Located<Entry>)>,
) -> Result<Vec<Datum>, InputError> {
    let mut data = vec![];
    for (name, entry) in entries {
        let key = format!("{table}.{name}");
        let place = reader.location(&key, &entry.span);
        check_identifier(name, &place)?;
        let (value, condition) = if let Entry::Table(held) = &entry.value {
            known_only(reader, &key, held, &["of", "is"])?;
            let part = |part: &str| match held.get(part) {
                Some(entry) => reader.tensor(&format!("{key}.{part}"), entry),
                None => Err(place.error(format!("expected the key `{part}`, found none"))),
            };
            (part("of")?, Some(part("is")?))
        } else {
            (reader.tensor(&key, entry)?, None)
        };
        data.push(Datum {
            name: name.clone(),
            place,
            value,
            condition,
        });
    }
    Ok(data)
}

fn expressions(
    reader: Reader<'_>,
    key: &str,
    list: &[Located<Entry>],
) -> Result<Vec<Expression>, InputError> {
    list.iter()
        .map(|entry| reader.expression(key, entry))
        .collect()
}
