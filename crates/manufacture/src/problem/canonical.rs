//! A file as text that does not depend on the order of its keys, its blanks and its comments.

use std::fmt::Write;

use super::{Datum, Problem, Surface, System, TensorValue};

impl TensorValue {
    fn text(&self) -> String {
        match self {
            TensorValue::One(expression) => expression.tree.to_string(),
            TensorValue::List(_, parts) => {
                let parts: Vec<String> = parts.iter().map(TensorValue::text).collect();
                format!("[{}]", parts.join(", "))
            }
        }
    }
}

fn data(text: &mut String, path: &str, data: &[Datum]) {
    for datum in data {
        let _ = write!(text, "{path}.{} = {}", datum.name, datum.value.text());
        if let Some(condition) = &datum.condition {
            let _ = write!(text, " = {}", condition.text());
        }
        text.push('\n');
    }
}

impl Problem {
    /// One line for each name, equation and datum.
    pub(crate) fn canonical(&self) -> String {
        let mut text = String::new();
        if self.system != System::Cartesian {
            let _ = writeln!(text, "{} coordinates", self.system.name());
        }
        for (variable, interval) in self.variables().iter().zip(&self.intervals) {
            let _ = writeln!(text, "{variable} in {interval:?}");
        }
        for parameter in &self.parameters {
            let _ = writeln!(text, "{} = {}", parameter.name, parameter.expression.tree);
        }
        for (name, definition) in &self.definitions {
            let _ = writeln!(text, "{name} = {}", definition.value.text());
        }
        for equation in &self.equations {
            let mut sum = String::new();
            for term in &equation.terms {
                let sign = if term.is_negative { " - " } else { " + " };
                let sign = if sum.is_empty() { "" } else { sign };
                let _ = write!(sum, "{sign}{}", term.expression.tree);
            }
            let _ = writeln!(text, "{}: {sum} = source_{}", equation.name, equation.name);
        }
        for face in &self.faces {
            if let Surface::Level(level) = &face.surface {
                let _ = writeln!(text, "{}: {} = 0", face.name, level.tree);
            }
            data(&mut text, &face.name, &face.data);
        }
        data(&mut text, "initial", &self.initial);
        let required = [("positive", &self.positive), ("zero", &self.zero)];
        for (word, expressions) in required {
            for expression in expressions {
                let _ = writeln!(text, "{word}: {}", expression.tree);
            }
        }
        for (field, norms) in &self.norms {
            let norms: Vec<&str> = norms.iter().map(|norm| norm.name()).collect();
            let _ = writeln!(text, "error of {field}: {}", norms.join(", "));
        }
        text
    }
}
