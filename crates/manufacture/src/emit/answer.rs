//! The program that answers questions about points in each language.

use super::functions::{Function, others};
use super::write::prefix;
use super::{EmittedFile, Language, fill, parameters};
use crate::derive::{Part, Role};
use crate::model::Model;

/// The argument that asks for all functions but sources and data; no face has this name.
pub(crate) const OTHERS: &str = ":others";

/// The functions that answer for the sources, or for a face.
struct Group<'f> {
    face: &'f str,
    functions: Vec<&'f Function>,
}

impl Group<'_> {
    /// The number of components.
    fn count(&self) -> usize {
        self.functions.iter().map(|f| f.roots.len()).sum()
    }

    /// The names of all components, with this between the parts of long lines.
    fn names(&self, separator: &str) -> String {
        const LONGEST: usize = 48;
        let components = self.functions.iter().flat_map(|f| f.components.clone());
        let mut text = String::new();
        let mut length = 0;
        for name in components {
            if !text.is_empty() {
                text.push(' ');
            }
            if length > LONGEST {
                text += separator;
                length = 0;
            }
            length += name.len() + 1;
            text += &name;
        }
        text
    }
}

fn functions_of(functions: &[Function], role: Role, part: Part) -> Vec<&Function> {
    let functions = functions.iter();
    functions
        .filter(|f| f.role == role && f.part == part)
        .collect()
}

fn groups<'f>(model: &'f Model, functions: &'f [Function]) -> Vec<Group<'f>> {
    let mut groups = vec![Group {
        face: "",
        functions: functions_of(functions, Role::Source, Part::Interior),
    }];
    for (index, face) in model.problem.faces.iter().enumerate() {
        let functions = functions_of(functions, Role::Datum, Part::Face(index));
        if !functions.is_empty() {
            groups.push(Group {
                face: &face.name,
                functions,
            });
        }
    }
    groups.push(Group {
        face: OTHERS,
        functions: others(functions),
    });
    groups
}

pub(super) fn program(
    model: &Model,
    has_alternatives: bool,
    language: Language,
    functions: &[Function],
) -> Option<EmittedFile> {
    let (template, ending) = match language {
        Language::C => (include_str!("templates/answer.c"), "c"),
        Language::Fortran => (include_str!("templates/answer.f90"), "f90"),
        Language::Python => (include_str!("templates/answer.py"), "py"),
        Language::Octave => (include_str!("templates/answer.m"), "m"),
        Language::Rust => (include_str!("templates/answer.rs"), "rs"),
        Language::Ufl => return None,
    };
    let problem = &model.problem;
    let groups = groups(model, functions);
    let dimension = problem.coordinates.len();
    let prefix = prefix(model, language);
    let names = groups
        .iter()
        .map(|group| names(language, group))
        .collect::<String>();
    let calls = groups
        .iter()
        .map(|group| calls(language, group, dimension, &prefix));
    let calls = calls.collect::<String>();
    let most = groups.iter().map(Group::count).max().unwrap_or(1);
    let has_parameters = !problem.parameters.is_empty();
    let real = [
        if problem.time.is_some() { ", t" } else { "" },
        if has_parameters { ", value" } else { "" },
    ];
    let time = match (language, problem.time.is_some()) {
        (Language::Fortran, true) => format!("        t = p({})\n", dimension + 1),
        (Language::Python, true) => format!("t = points[{dimension}]\n"),
        (Language::Octave, true) => format!("t = points({}, :);\n", dimension + 1),
        _ => String::new(),
    };
    let text = fill(
        template,
        &[
            ("NAME", &problem.name),
            ("NAMES", &names),
            ("CALLS", &calls),
            ("REAL", &real.concat()),
            ("WHOLE", if has_parameters { ", place, cut" } else { "" }),
            ("TIME", &time),
            (
                "CHOOSE",
                if has_alternatives {
                    "    call choose_variant()\n"
                } else {
                    ""
                },
            ),
            ("SETTINGS", &parameters::settings(model, language, &prefix)),
            ("T", if problem.time.is_some() { ", t" } else { "" }),
            ("D", &dimension.to_string()),
            ("V", &problem.intervals.len().to_string()),
            ("MOST", &most.to_string()),
        ],
    );
    Some(EmittedFile {
        name: format!("{}_answer.{ending}", problem.name),
        text,
    })
}

/// The branch that prints the names.
fn names(language: Language, group: &Group<'_>) -> String {
    let Group { face, .. } = group;
    let names = group.names(match language {
        Language::Rust => "\\\n            ",
        Language::Fortran => "', &\n            '",
        _ => "\"\n        \"",
    });
    match language {
        Language::C => {
            format!("    if (strcmp(face, \"{face}\") == 0) \n        names = \"{names}\";\n")
        }
        Language::Fortran => {
            format!("    case ('{face}')\n        write(*, '(*(a))') '{names}'\n")
        }
        Language::Rust => format!("        \"{face}\" => println!(\"{names}\"),\n"),
        _ => String::new(),
    }
}

/// The branch that evaluates the functions of a group.
fn calls(language: Language, group: &Group<'_>, dimension: usize, prefix: &str) -> String {
    let Group { face, functions } = group;
    let has_time = functions.iter().any(|f| f.has_time);
    let time = match (has_time, language) {
        (false, _) => String::new(),
        (true, Language::C | Language::Rust) => format!(", p[{dimension}]"),
        (true, _) => ", t".to_owned(),
    };
    let mut place = 0;
    let mut lines = vec![];
    for function in functions {
        let Function { name, shape, .. } = function;
        let name = format!("{prefix}{name}");
        lines.push(match (language, shape.len()) {
            (Language::C, 0) => format!("            out[{place}] = {name}(x{time});\n"),
            (Language::C, _) => format!("            {name}(x{time}, out + {place});\n"),
            // An array of Fortran is printed column by column.
            (Language::Fortran, 2) => format!("transpose({name}(x{time}))"),
            (Language::Fortran, _) => format!("{name}(x{time})"),
            (Language::Rust, 0) => {
                format!("                out.push(library::{name}(&x{time}));\n")
            }
            (Language::Rust, _) => {
                format!("                out.extend(library::{name}(&x{time}));\n")
            }
            (Language::Octave, _) => format!("p.{name}(x{time})"),
            _ => format!("library.{name}"),
        });
        place += function.roots.len();
    }
    match language {
        Language::C => format!(
            "        if (strcmp(face, \"{face}\") == 0) {{\n{}            count = {place};\n        }}\n",
            lines.concat()
        ),
        Language::Fortran => format!(
            "        case ('{face}')\n            write(*, '(*(es25.16e3, 1x))') &\n                {}\n",
            lines.join(", &\n                ")
        ),
        Language::Python => {
            let lines = lines.join(",\n        ");
            format!(
                "    \"{face}\": (\"{}\", [\n        {lines},\n    ]),\n",
                group.names("\"\n        \"")
            )
        }
        Language::Octave => format!(
            "  case '{face}'\n    puts([\"{}\\n\"]);\n    rows = [{}];\n",
            group.names("\", ...\n      \""),
            lines.join("; ...\n      ")
        ),
        _ => format!(
            "            \"{face}\" => {{\n{}            }}\n",
            lines.concat()
        ),
    }
}
