//! Values at points that a table gives.

use serde_json::{Map, Value, json};

use crate::arithmetic::NodeId;
use crate::arithmetic::tape::SizedValue;
use crate::derive::{DerivedQuantity, Part, Role, components};
use crate::language::names::unknown;
use crate::model::Model;
use crate::problem::{InputError, Surface};

/// Share of an interval, or of the summands of a level, that a printed coordinate may be off.
const NEAR: f64 = 1e-6;

/// Points, and of each the face that it is on.
struct PointTable {
    points: Vec<Vec<f64>>,
    faces: Vec<String>,
}

/// The column of each variable; in words what is wrong with the header.
fn places(variables: &[&str], head: &[&str]) -> Result<Vec<usize>, String> {
    let known: Vec<&str> = variables.iter().copied().chain(["face"]).collect();
    if let Some(name) = head.iter().find(|name| !known.contains(name)) {
        return Err(unknown("column", name, &known));
    }
    let mut places = vec![];
    let mut again = (1..head.len()).filter(|place| head[..*place].contains(&head[*place]));
    if let Some(place) = again.next() {
        return Err(format!(
            "expected each column once, found `{}` twice",
            head[place]
        ));
    }
    for variable in variables {
        let place = head.iter().position(|name| name == variable);
        places.push(place.ok_or_else(|| format!("expected the column `{variable}`, found none"))?);
    }
    Ok(places)
}

/// Reads a header with the coordinates, time and optionally `face`, then a point for each line.
fn read(model: &Model, text: &str, file: &str) -> Result<PointTable, InputError> {
    let variables = model.problem.variables();
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|line| !line.1.trim().is_empty());
    let Some((first, header)) = lines.next() else {
        return Err(InputError::whole(
            file,
            "expected a header, found an empty table",
        ));
    };
    let head: Vec<&str> = header.split(',').map(str::trim).collect();
    let places = places(&variables, &head)
        .map_err(|problem| InputError::at_line(file, first + 1, problem))?;
    let face = head.iter().position(|name| *name == "face");
    let mut table = PointTable {
        points: vec![],
        faces: vec![],
    };
    for (line, row) in lines {
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        if cells.len() != head.len() {
            let problem = format!("expected {} columns, found {}", head.len(), cells.len());
            return Err(InputError::at_line(file, line + 1, problem));
        }
        let mut point = vec![];
        for place in &places {
            let value = cells[*place].parse::<f64>().ok();
            let Some(value) = value.filter(|value| value.is_finite()) else {
                let problem = format!("expected a number, found `{}`", cells[*place]);
                return Err(InputError::at_line(file, line + 1, problem));
            };
            point.push(value);
        }
        let name = face.map_or("", |place| cells[place]);
        on_face(model, name, &point)
            .map_err(|problem| InputError::at_line(file, line + 1, problem))?;
        table.points.push(point);
        table.faces.push(name.to_owned());
    }
    Ok(table)
}

/// Refuses an unknown face, and a point that is not on its face; the error is in words.
fn on_face(model: &Model, name: &str, point: &[f64]) -> Result<(), String> {
    let problem = &model.problem;
    if name.is_empty() {
        return Ok(());
    }
    let Some(face) = problem.faces.iter().find(|face| face.name == name) else {
        let known = problem.faces.iter().map(|face| face.name.as_str());
        return Err(unknown("face", name, &known.collect::<Vec<_>>()));
    };
    let [what, is, found] = match &face.surface {
        Surface::Side {
            coordinate,
            is_upper,
        } => {
            let [low, high] = problem.intervals[*coordinate];
            let end = if *is_upper { high } else { low };
            let x = point[*coordinate];
            if (x - end).abs() <= NEAR * (high - low) {
                return Ok(());
            }
            let name = &problem.coordinates[*coordinate];
            [name.clone(), end.to_string(), x.to_string()]
        }
        Surface::Level(expression) => {
            let levels = model.of_role(Role::Level);
            let level = model.rows(levels.filter(|level| level.name == name));
            let tensors = level.at(point).tensors;
            let SizedValue { value, size } = tensors[0][0];
            if value.abs() <= NEAR * size {
                return Ok(());
            }
            [
                format!("`{}`", expression.text),
                "0".to_owned(),
                value.to_string(),
            ]
        }
    };
    Err(format!(
        "expected a point of the face `{name}`, where {what} is {is}; found {found}"
    ))
}

/// A part of the values of quantities, as columns under the names of their components; null where
/// there is no point.
fn columns<'q>(
    model: &Model,
    quantities: impl Iterator<Item = &'q DerivedQuantity<NodeId>>,
    points: &[Option<Vec<f64>>],
    part: fn(&SizedValue) -> f64,
) -> Map<String, Value> {
    let quantities: Vec<_> = quantities.collect();
    let rows = model.rows(quantities.iter().copied());
    let points = points.iter();
    let values: Vec<_> = points
        .map(|point| point.as_ref().map(|point| rows.at(point).tensors))
        .collect();
    let mut columns = Map::new();
    for (index, quantity) in quantities.iter().enumerate() {
        let names = components(&model.problem, &quantity.name, &quantity.tensor.shape);
        for (place, name) in names.into_iter().enumerate() {
            let cells = values.iter().map(|tensors| {
                let cell = tensors.as_ref().map(|tensors| part(&tensors[index][place]));
                json!(cell)
            });
            columns.insert(name, cells.collect());
        }
    }
    columns
}

fn value_of(at: &SizedValue) -> f64 {
    at.value
}

/// The values of all quantities at the points of a table, as one JSON object.
pub(crate) fn values(model: &Model, text: &str, file: &str) -> Result<Value, InputError> {
    let table = read(model, text, file)?;
    let points: Vec<Option<Vec<f64>>> = table.points.iter().cloned().map(Some).collect();
    let mut terms = Map::new();
    for quantity in model.of_role(Role::Source) {
        for (label, tensor) in &quantity.terms {
            let term = DerivedQuantity {
                tensor: tensor.clone(),
                terms: vec![],
                ..quantity.clone()
            };
            for (component, column) in columns(model, std::iter::once(&term), &points, value_of) {
                let entry = terms.entry(component).or_insert_with(|| json!({}));
                entry[label.as_str()] = column;
            }
        }
    }
    let mut boundary = Map::new();
    for (index, face) in model.problem.faces.iter().enumerate() {
        let on_face = table.points.iter().zip(&table.faces);
        let on_face = on_face.map(|(point, name)| (*name == face.name).then(|| point.clone()));
        let on_face: Vec<_> = on_face.collect();
        let data = model.part(Part::Face(index)).iter();
        let data = data.filter(|quantity| quantity.role == Role::Datum);
        let columns = columns(model, data, &on_face, value_of);
        boundary.insert(face.name.clone(), Value::Object(columns));
    }
    let mut first = points.clone();
    for point in first.iter_mut().flatten() {
        if let (Some(first), Some(time)) = (model.problem.first_time(), point.last_mut()) {
            *time = first;
        }
    }
    Ok(json!({
        "schema": 1,
        "name": model.problem.name,
        "exact": columns(model, model.of_role(Role::Exact), &points, value_of),
        "sources": columns(model, model.of_role(Role::Source), &points, value_of),
        "terms": terms,
        "boundary": boundary,
        "initial": columns(model, model.of_role(Role::Initial), &first, value_of),
        "size": {"sources": columns(model, model.of_role(Role::Source), &points, |at| at.size)},
    }))
}
