//! The program that answers questions about points in each language.

use super::functions::{EmittedFunction, others};
use super::texts::{Answer, Texts};
use super::writer::prefix;
use super::{EmittedFile, Language, fill};
use crate::derive::{Part, Role};
use crate::model::Model;

/// The argument that asks for all functions but sources and data; no face has this name.
pub(crate) const OTHERS: &str = ":others";

/// The functions that answer for the sources, or for a face.
struct AnswerGroup<'f> {
    face: &'f str,
    functions: Vec<&'f EmittedFunction>,
}

impl AnswerGroup<'_> {
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

fn functions_of(functions: &[EmittedFunction], role: Role, part: Part) -> Vec<&EmittedFunction> {
    let functions = functions.iter();
    functions
        .filter(|f| f.role == role && f.part == part)
        .collect()
}

fn groups<'f>(model: &'f Model, functions: &'f [EmittedFunction]) -> Vec<AnswerGroup<'f>> {
    let mut groups = vec![AnswerGroup {
        face: "",
        functions: functions_of(functions, Role::Source, Part::Interior),
    }];
    for (index, face) in model.problem.faces.iter().enumerate() {
        let functions = functions_of(functions, Role::Datum, Part::Face(index));
        if !functions.is_empty() {
            groups.push(AnswerGroup {
                face: &face.name,
                functions,
            });
        }
    }
    groups.push(AnswerGroup {
        face: OTHERS,
        functions: others(functions),
    });
    groups
}

pub(super) fn program(
    model: &Model,
    has_alternatives: bool,
    language: Language,
    functions: &[EmittedFunction],
) -> Option<EmittedFile> {
    let texts = language.texts().answer.as_ref()?;
    let problem = &model.problem;
    let groups = groups(model, functions);
    let dimension = problem.coordinates.len().to_string();
    let variables = problem.intervals.len().to_string();
    let prefix = prefix(model, language);
    let mut names = String::new();
    let mut calls = String::new();
    for group in &groups {
        let all = group.names(texts.separator);
        names += &fill(texts.names, &[("FACE", group.face), ("NAMES", &all)]);
        calls += &self::calls(language.texts(), texts, group, &prefix);
    }
    let most = groups.iter().map(AnswerGroup::count).max().unwrap_or(1);
    let has_parameters = !problem.parameters.is_empty();
    let has_time = problem.time.is_some();
    let real = [
        if has_time { ", t" } else { "" },
        if has_parameters { ", value" } else { "" },
    ];
    let settings = language.texts().parameters.settings;
    let text = fill(
        texts.template,
        &[
            ("NAME", &problem.name),
            ("NAMES", &names),
            ("CALLS", &calls),
            ("REAL", &real.concat()),
            ("WHOLE", if has_parameters { ", place, cut" } else { "" }),
            ("TIME", if has_time { texts.time } else { "" }),
            ("CHOOSE", if has_alternatives { texts.choose } else { "" }),
            ("SETTINGS", if has_parameters { settings } else { "" }),
            ("P", &prefix),
            ("T", if has_time { ", t" } else { "" }),
            ("D", &dimension),
            ("V", &variables),
            ("MOST", &most.to_string()),
        ],
    );
    Some(EmittedFile {
        name: format!("{}_answer{}", problem.name, texts.ending),
        text,
    })
}

/// The branch that evaluates the functions of a group.
fn calls(language: &Texts, texts: &Answer, group: &AnswerGroup<'_>, prefix: &str) -> String {
    let AnswerGroup { face, functions } = group;
    let mut place = 0;
    let mut calls = vec![];
    for function in functions {
        let shaped = match function.shape.len() {
            0 => &language.scalar,
            _ => &language.tensor,
        };
        let time = if function.has_time {
            texts.time_argument
        } else {
            ""
        };
        let call = fill(
            shaped.answer,
            &[
                ("F", &function.name),
                ("TIME", time),
                ("PLACE", &place.to_string()),
                ("P", prefix),
            ],
        );
        calls.push(match function.shape.len() {
            2 => fill(texts.matrix, &[("CALL", &call)]),
            _ => call,
        });
        place += function.roots.len();
    }
    fill(
        texts.branch,
        &[
            ("FACE", *face),
            ("NAMES", &group.names(texts.separator)),
            ("CALLS", &calls.join(texts.between)),
            ("COUNT", &place.to_string()),
        ],
    )
}
