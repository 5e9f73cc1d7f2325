//! The sections of a file.

use std::collections::BTreeMap;

use convergence_keys::names;

use super::keys::{FACE, FILE_KEYS, HEAD, HELD, REQUIRE, STUDY, VARIANTS};
use super::reader::{FileField, FileSection, Reader};
use super::{
    Datum, Definition, EmittedStudy, Equation, EquationTerm, Expression, Face, InputError, Norm,
    Parameter, Problem, Surface, System, constant,
};
use crate::language::is_of_name;
use crate::language::names::{did_you_mean, reserved};

impl Problem {
    /// Reads the text of a file.
    pub(crate) fn parse(text: &str, file: &str) -> Result<Self, InputError> {
        let reader = Reader { file, text };
        let document = reader.parse()?;
        let whole = reader.whole(document.get_ref());
        whole.allow(&names(FILE_KEYS))?;
        let head = whole.require("manufacture")?.section()?;
        head.allow(&names(&[&HEAD]))?;
        let time = head.field("time");
        let mut problem = Self {
            file: file.to_owned(),
            text: text.to_owned(),
            name: name(&head.require("name")?)?,
            name_place: head.require("name")?.place,
            coordinates: vec![],
            time: time.as_ref().map(name).transpose()?,
            system: System::Cartesian,
            intervals: vec![],
            parameters: parameters(&whole)?,
            definitions: BTreeMap::new(),
            equations: equations(&whole)?,
            faces: vec![],
            initial: vec![],
            positive: vec![],
            zero: vec![],
            norms: vec![],
            study: study(&whole)?,
            switchable: vec![],
            variation: None,
        };
        problem.variants(&whole)?;
        problem.space(&head)?;
        problem.define(&whole)?;
        problem.check_names(&head)?;
        problem.domain(&whole)?;
        problem.boundary(&whole)?;
        problem.rest(&whole)?;
        Ok(problem)
    }

    /// `[variants]`.
    fn variants(&mut self, whole: &FileSection<'_>) -> Result<(), InputError> {
        let Some(section) = whole.section("variants")? else {
            return Ok(());
        };
        section.allow(&names(&[&VARIANTS]))?;
        for field in section.require("parameters")?.list()? {
            let name = field.string()?;
            let known = self.parameters.iter().map(|entry| entry.name.as_str());
            let known: Vec<&str> = known.collect();
            if !known.contains(&name.as_str()) {
                let near = did_you_mean(&name, known.iter().copied());
                let known = known.join(" ");
                let problem = format!("unknown parameter `{name}`{near}; expected one of {known}");
                return Err(field.place.error(problem));
            }
            self.switchable.push(name);
        }
        Ok(())
    }

    fn space(&mut self, head: &FileSection<'_>) -> Result<(), InputError> {
        let field = head.require("coordinates")?;
        self.coordinates = field.list()?.iter().map(name).collect::<Result<_, _>>()?;
        let found = self.coordinates.len();
        if !(1..=3).contains(&found) {
            let problem = format!("expected 1 to 3 coordinates, found {found}");
            return Err(field.place.error(problem));
        }
        if let Some(field) = head.field("system") {
            if field.string()? == "spherical" {
                let problem = "spherical coordinates are left out; write the problem in others";
                return Err(field.place.error(problem));
            }
            let known = System::ALL.map(|system| system.0);
            self.system = one_of(&field, &System::ALL, &known)?;
        }
        let expected = match self.system {
            System::Cartesian => found,
            System::Polar | System::Axisymmetric => 2,
            System::Cylindrical => 3,
        };
        if found != expected {
            let problem = format!("expected {expected} coordinates of this system, found {found}");
            return Err(field.place.error(problem));
        }
        Ok(())
    }

    fn define(&mut self, whole: &FileSection<'_>) -> Result<(), InputError> {
        for (section, is_exact) in [("exact", true), ("define", false)] {
            let Some(section) = whole.section(section)? else {
                if is_exact {
                    whole.require("exact")?;
                }
                continue;
            };
            for field in section.fields() {
                let definition = Definition {
                    value: field.value()?,
                    is_exact,
                };
                if self
                    .definitions
                    .insert(field.name.clone(), definition)
                    .is_some()
                {
                    return Err(twice(&field));
                }
            }
        }
        Ok(())
    }

    /// Each name is an identifier, is not reserved, and has one meaning.
    fn check_names(&self, head: &FileSection<'_>) -> Result<(), InputError> {
        let mut names: Vec<(&str, super::Location)> = vec![];
        for variable in self.variables() {
            names.push((variable, head.place()));
        }
        for Parameter { name, expression } in &self.parameters {
            names.push((name, expression.place.clone()));
        }
        for (name, definition) in &self.definitions {
            names.push((name, definition.value.place().clone()));
        }
        for (index, (name, place)) in names.iter().enumerate() {
            check_name(name, place)?;
            if names[..index].iter().any(|earlier| earlier.0 == *name) {
                let problem = format!("found `{name}` twice; expected one meaning of each name");
                return Err(place.error(problem));
            }
        }
        Ok(())
    }

    fn domain(&mut self, whole: &FileSection<'_>) -> Result<(), InputError> {
        let section = whole.require("domain")?.section()?;
        let variables: Vec<String> = self.variables().iter().map(|v| (*v).to_owned()).collect();
        let known: Vec<&str> = variables.iter().map(String::as_str).collect();
        section.allow(&known)?;
        let values = self.parameter_values(&[])?;
        let names = self
            .parameters
            .iter()
            .map(|parameter| parameter.name.as_str());
        let known: Vec<(&str, f64)> = names.zip(values).collect();
        for variable in &variables {
            let field = section.require(variable)?;
            let ends = field.list()?;
            let [low, high] = ends.as_slice() else {
                let problem = format!("expected two numbers, found {}", ends.len());
                return Err(field.place.error(problem));
            };
            let low = constant(&low.expression()?, &known)?;
            let high = constant(&high.expression()?, &known)?;
            if !(low < high) {
                let problem = format!(
                    "expected an interval, two numbers of which the first is the smaller; found [{low}, {high}]"
                );
                return Err(field.place.error(problem));
            }
            self.intervals.push([low, high]);
        }
        if self.system != System::Cartesian && self.intervals[0][0] < 0.0 {
            let problem = "expected a radius of at least 0";
            return Err(section.require(&variables[0])?.place.error(problem));
        }
        Ok(())
    }

    fn boundary(&mut self, whole: &FileSection<'_>) -> Result<(), InputError> {
        let Some(boundary) = whole.section("boundary")? else {
            return Ok(());
        };
        for field in boundary.fields() {
            check_identifier(&field.name, &field.place)?;
            let section = field.section()?;
            let surface = self.surface(&field, &section)?;
            let mut data = vec![];
            for entry in section.fields() {
                if !names(&[&FACE]).contains(&entry.name.as_str()) {
                    data.push(datum(&entry)?);
                }
            }
            self.faces.push(Face {
                name: field.name.clone(),
                place: field.place.clone(),
                surface,
                data,
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
        field: &FileField<'_>,
        section: &FileSection<'_>,
    ) -> Result<Surface, InputError> {
        if let Some(level) = section.field("level") {
            if let Some(face) = section.field("face") {
                let problem = "found `face` and `level`; expected one of them";
                return Err(face.place.error(problem));
            }
            return Ok(Surface::Level(level.expression()?));
        }
        let name = match section.field("face") {
            Some(face) => face.string()?,
            None => field.name.clone(),
        };
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
                let near = did_you_mean(&name, all.iter().map(|side| side.2.as_str()));
                let known: Vec<&str> = all.iter().map(|side| side.2.as_str()).collect();
                let known = known.join(" ");
                Err(field.place.error(format!(
                    "`{name}` is no face{near}; expected one of {known}, or a key `face` or `level`"
                )))
            }
        }
    }

    fn rest(&mut self, whole: &FileSection<'_>) -> Result<(), InputError> {
        if let Some(initial) = whole.section("initial")? {
            if self.time.is_none() {
                let problem = "expected no initial data without `time` in [manufacture]";
                return Err(initial.place().error(problem));
            }
            for entry in initial.fields() {
                self.initial.push(datum(&entry)?);
            }
        }
        if let Some(require) = whole.section("require")? {
            require.allow(&names(&[&REQUIRE]))?;
            self.positive = expressions(&require, "positive")?;
            self.zero = expressions(&require, "zero")?;
        }
        if let Some(norms) = whole.section("norms")? {
            let exact = self.definitions.iter().filter(|entry| entry.1.is_exact);
            let fields: Vec<&str> = exact.map(|entry| entry.0.as_str()).collect();
            let known = Norm::ALL.map(|norm| norm.0);
            let mut entries = norms.fields().into_iter();
            if let Some(turned) = entries.find(|entry| known.contains(&entry.name.as_str())) {
                let field = fields.first().copied().unwrap_or("u");
                let problem = format!(
                    "expected a field and its norms, `{field} = [\"{0}\"]`; found a norm as a key",
                    turned.name
                );
                return Err(turned.place.error(problem));
            }
            norms.allow(&fields)?;
            for entry in norms.fields() {
                let items = entry.list()?;
                let chosen = items.iter().map(|item| one_of(item, &Norm::ALL, &known));
                let chosen = chosen.collect::<Result<_, _>>()?;
                self.norms.push((entry.name.clone(), chosen));
            }
        }
        Ok(())
    }
}

fn twice(field: &FileField<'_>) -> InputError {
    let name = &field.name;
    let problem = format!("found `{name}` twice; expected one meaning of each name");
    field.place.error(problem)
}

/// One of the known words.
fn one_of<T: Copy>(
    field: &FileField<'_>,
    all: &[(&str, T)],
    known: &[&str],
) -> Result<T, InputError> {
    let text = field.string()?;
    match all.iter().find(|entry| entry.0 == text) {
        Some(entry) => Ok(entry.1),
        None => {
            let near = did_you_mean(&text, known.iter().copied());
            let known = known.join(" ");
            let problem = format!("found `{text}`{near}; expected one of {known}");
            Err(field.place.error(problem))
        }
    }
}

fn name(field: &FileField<'_>) -> Result<String, InputError> {
    let name = field.string()?;
    check_identifier(&name, &field.place)?;
    Ok(name)
}

fn check_identifier(name: &str, place: &super::Location) -> Result<(), InputError> {
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(is_of_name) {
        return Ok(());
    }
    let problem = format!("found the name `{name}`; expected a letter, then letters, digits and _");
    Err(place.error(problem))
}

fn check_name(name: &str, place: &super::Location) -> Result<(), InputError> {
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

fn parameters(whole: &FileSection<'_>) -> Result<Vec<Parameter>, InputError> {
    let Some(section) = whole.section("parameters")? else {
        return Ok(vec![]);
    };
    let mut parameters = vec![];
    for field in section.fields() {
        parameters.push(Parameter {
            expression: field.expression()?,
            name: field.name,
        });
    }
    Ok(parameters)
}

fn equations(whole: &FileSection<'_>) -> Result<Vec<Equation>, InputError> {
    let section = whole.require("equations")?.section()?;
    let mut equations = vec![];
    for field in section.fields() {
        check_identifier(&field.name, &field.place)?;
        let terms = if field.is_table() {
            named_terms(&field.section()?)?
        } else {
            terms(&field.expression()?)
        };
        if terms.is_empty() {
            return Err(field.place.error("expected at least one term, found none"));
        }
        equations.push(Equation {
            name: field.name.clone(),
            place: field.place.clone(),
            terms,
        });
    }
    if equations.is_empty() {
        return Err(section
            .place()
            .error("expected at least one equation, found none"));
    }
    Ok(equations)
}

/// The terms of a table, in alphabetical order, each with its place in the file.
fn named_terms(section: &FileSection<'_>) -> Result<Vec<EquationTerm>, InputError> {
    let fields = section.fields();
    let mut terms = vec![];
    for field in &fields {
        let others = fields.iter();
        terms.push(EquationTerm {
            label: field.name.clone(),
            place: others.filter(|other| other.start < field.start).count(),
            is_negative: false,
            expression: field.expression()?,
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

fn datum(field: &FileField<'_>) -> Result<Datum, InputError> {
    check_identifier(&field.name, &field.place)?;
    let name = field.name.clone();
    if !field.is_table() {
        return Ok(Datum {
            name,
            value: field.value()?,
            condition: None,
        });
    }
    let section = field.section()?;
    section.allow(&names(&[&HELD]))?;
    Ok(Datum {
        name,
        value: section.require("of")?.value()?,
        condition: Some(section.require("is")?.value()?),
    })
}

fn expressions(section: &FileSection<'_>, name: &str) -> Result<Vec<Expression>, InputError> {
    let Some(field) = section.field(name) else {
        return Ok(vec![]);
    };
    field.list()?.iter().map(FileField::expression).collect()
}

fn study(whole: &FileSection<'_>) -> Result<Option<EmittedStudy>, InputError> {
    let Some(section) = whole.section("study")? else {
        return Ok(None);
    };
    section.allow(&names(&[&STUDY]))?;
    let command = section.require("command")?.list()?;
    let n = section.require("n")?.list()?;
    let orders = section.require("order")?.section()?.fields();
    Ok(Some(EmittedStudy {
        command: command
            .iter()
            .map(FileField::string)
            .collect::<Result<_, _>>()?,
        n: n.iter().map(FileField::count).collect::<Result<_, _>>()?,
        orders: orders
            .iter()
            .map(|field| Ok((field.name.clone(), field.number()?)))
            .collect::<Result<Vec<_>, InputError>>()?,
    }))
}

impl super::TensorValue {
    pub(crate) fn place(&self) -> &super::Location {
        match self {
            super::TensorValue::One(expression) => &expression.place,
            super::TensorValue::List(place, _) => place,
        }
    }
}
