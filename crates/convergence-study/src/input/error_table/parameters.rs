//! Numbers that a whole table shares: the degree in its heading, or in a column of groups.

use super::columns::Cells;
use super::names;
use super::number::number;

/// A number that all rows of a table share.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
}

/// Names of the degree of elements.
const DEGREES: [&str; 7] = [
    "p",
    "q",
    "k",
    "deg",
    "degree",
    "polydeg",
    "polynomialdegree",
];

impl Parameter {
    /// Whether a name is meant: the same, or another one of the degree.
    pub fn is_called(&self, name: &str) -> bool {
        self.name.eq_ignore_ascii_case(name) || is_degree(&self.name) && is_degree(name)
    }
}

/// Whether a name is one of the degree of elements: `p`, `Degree`.
pub(crate) fn is_degree(name: &str) -> bool {
    DEGREES.contains(&&*name.to_lowercase())
}

/// The degrees of a heading behind their names, as in `Degree = 2`, `p: 2` and `P2 elements`, and
/// those of columns of groups with the same number in all rows.
pub(super) fn of_table(heading: &str, columns: &[Cells<'_>]) -> Vec<Parameter> {
    let mut parameters = of_heading(heading);
    for Cells {
        name,
        texts,
        values,
        ..
    } in columns
    {
        let is_same = texts.iter().all(|cell| *cell == texts[0]);
        if names::is_group(name) && is_same && !values[0].is_nan() {
            parameters.push(Parameter {
                name: name.clone(),
                value: values[0],
            });
        }
    }
    parameters
}

fn of_heading(heading: &str) -> Vec<Parameter> {
    let words = heading.split(|c: char| c.is_whitespace() || ",;:=()[]".contains(c));
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let mut parameters = vec![];
    for (k, word) in words.iter().enumerate() {
        let behind = words.get(k + 1).and_then(|word| number(word, false));
        let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
        let (name, value) = match behind {
            Some(number) if is_degree(word) => (*word, number.value),
            // `P2`.
            _ if letters.len() == 1 && letters.starts_with(['P', 'p', 'Q', 'q']) => {
                let Ok(value) = word[1..].parse() else {
                    continue;
                };
                (letters, value)
            }
            _ => continue,
        };
        parameters.push(Parameter {
            name: name.to_owned(),
            value,
        });
    }
    parameters
}
