//! The keys of a file: the reader refuses all others, and schemas are made from the same constants.

use convergence_keys::{Form, Key, Keys};

use super::{Norm, System};

/// A text, or a number.
const EXPRESSION: Form = Form::OneOf(&[Form::Text, Form::Number]);
const VECTOR: Form = Form::List(&EXPRESSION);
/// A scalar, a vector or a tensor.
const VALUE: Form = Form::OneOf(&[EXPRESSION, VECTOR, Form::List(&VECTOR)]);
/// A value, or one that must hold.
const DATUM: Form = Form::OneOf(&[
    EXPRESSION,
    VECTOR,
    Form::List(&VECTOR),
    Form::Table(&[&[&HELD]]),
]);

/// The tables of a file.
pub const FILE_KEYS: Keys = &[&FILE];

const FILE: [Key; 12] = [
    Key::new(
        "manufacture",
        Form::Table(&[&[&HEAD]]),
        "what the file is about",
    ),
    Key::new(
        "domain",
        Form::Named(&[], &VECTOR),
        "the interval of each coordinate and of time, as two numbers or expressions of parameters",
    ),
    Key::new(
        "parameters",
        Form::Named(&[], &EXPRESSION),
        "numbers, or expressions of other parameters",
    )
    .or("none"),
    Key::new(
        "exact",
        Form::Named(&[], &VALUE),
        "the chosen solution: a text is a scalar, a list a vector, a list of lists a tensor",
    ),
    Key::new(
        "define",
        Form::Named(&[], &VALUE),
        "laws and abbreviations: scalars, vectors or tensors",
    )
    .or("none"),
    Key::new(
        "equations",
        Form::Named(
            &[],
            &Form::OneOf(&[Form::Text, Form::Number, Form::Named(&[], &EXPRESSION)]),
        ),
        "the left side of each equation, whose value is the source: a text is cut into terms at its + and -, a table has terms by name",
    ),
    Key::new(
        "boundary",
        Form::Named(&[], &Form::Named(&[&FACE], &DATUM)),
        "the data on each face: `x_min`, `x_max`, ..., or any name with `face` or `level`",
    )
    .or("none"),
    Key::new(
        "initial",
        Form::Named(&[], &DATUM),
        "the values at the first time",
    )
    .or("none"),
    Key::new(
        "require",
        Form::Table(&[&[&REQUIRE]]),
        "what must hold at all points of the domain",
    )
    .or("nothing"),
    Key::new(
        "norms",
        Form::Named(&[], &Form::List(&NORM)),
        "the norms of the error of each field",
    )
    .or("none"),
    Key::new(
        "variants",
        Form::Table(&[&[&VARIANTS]]),
        "what the variants of `--variants` may change beside the solution",
    )
    .or("the solution alone"),
    Key::new(
        "study",
        Form::Table(&[&[&STUDY]]),
        "a study of the solver, which is written beside the files of a language",
    )
    .or("no study is written"),
];

/// What a key of the file, of `[manufacture]` or of `[study]` means.
///
/// * `table`: its path; empty for the file.
pub(super) fn meaning(table: &str, name: &str) -> Option<&'static str> {
    let keys: &[Key] = match table {
        "" => &FILE,
        "manufacture" => &HEAD,
        "study" => &STUDY,
        _ => &[],
    };
    let key = keys.iter().find(|key| key.name == name)?;
    Some(key.meaning)
}

/// `[manufacture]`.
pub(super) const HEAD: [Key; 4] = [
    Key::new(
        "name",
        Form::Text,
        "an identifier: everything that is written begins with it",
    ),
    Key::new(
        "coordinates",
        Form::List(&Form::Text),
        "the names of one to three coordinates",
    ),
    Key::new("time", Form::Text, "the name of time").or("the problem is stationary"),
    Key::new(
        "system",
        Form::Choice(systems),
        "the coordinate system: polar is (r, theta), axisymmetric (r, z), cylindrical (r, theta, z)",
    )
    .or("\"cartesian\""),
];

/// The keys of `[boundary.FACE]` that name no datum.
pub(super) const FACE: [Key; 2] = [
    Key::new(
        "face",
        Form::Text,
        "the side that the data are on, such as `x_max`",
    )
    .or("the name of the table"),
    Key::new(
        "level",
        EXPRESSION,
        "in place of `face`: a function that is negative inside and zero on the face",
    )
    .or("the face is a side"),
];

/// A value that must hold, as a table.
pub(super) const HELD: [Key; 2] = [
    Key::new("of", VALUE, "what has the value"),
    Key::new("is", VALUE, "the value that it must have"),
];

/// `[require]`.
pub(super) const REQUIRE: [Key; 2] = [
    Key::new(
        "positive",
        Form::List(&EXPRESSION),
        "expressions that must be positive",
    )
    .or("none"),
    Key::new(
        "zero",
        Form::List(&EXPRESSION),
        "expressions that must be zero",
    )
    .or("none"),
];

/// `[study]`.
pub(super) const STUDY: [Key; 3] = [
    Key::new(
        "command",
        Form::List(&Form::Text),
        "the solver and its arguments; `{n}` stands for the resolution",
    ),
    Key::new(
        "n",
        Form::List(&Form::Count(1)),
        "the resolutions of the study",
    ),
    Key::new(
        "order",
        Form::Named(&[], &Form::Number),
        "the order of each error, by names such as \"T L2\"",
    ),
];

/// `[variants]`.
pub(super) const VARIANTS: [Key; 1] = [Key::new(
    "parameters",
    Form::List(&Form::Text),
    "parameters that the program takes from the emitted module, each of which a variant sets to zero",
)];

const NORM: Form = Form::Choice(norms);

fn systems() -> Vec<&'static str> {
    System::ALL.map(|system| system.0).to_vec()
}

fn norms() -> Vec<&'static str> {
    Norm::ALL.map(|norm| norm.0).to_vec()
}
