//! The names of the language, and suggestions for misspelt ones.

use strsim::osa_distance;

/// A smooth function of one number, which every language has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
}

/// A function that is made of choices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Piecewise {
    Abs,
    Min,
    Max,
    Heaviside,
    Where,
}

/// An operator on tensors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Operator {
    Derivative,
    TimeDerivative,
    Gradient,
    Divergence,
    Laplacian,
    Curl,
    Dot,
    Inner,
    Outer,
    Cross,
    Transpose,
    Symmetric,
    Skew,
    Trace,
    Determinant,
    Inverse,
    Integral,
    /// What the search for mistakes alone writes; it has no name in the language.
    Altered(OperandAlteration),
}

/// What the search for mistakes does to an operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OperandAlteration {
    /// Derivatives take it for a constant.
    Held,
    /// It is multiplied by an unknown factor: a parameter behind those of the file.
    Scaled,
    /// Its own derivatives do not know that the basis turns; along theta they keep the factor 1/r.
    Unturned,
    /// Its own derivatives are those of Cartesian coordinates.
    Flat,
}

/// What is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Callee {
    Function(Function),
    Piecewise(Piecewise),
    Operator(Operator),
}

/// Everything that can be called: its name, and its smallest and largest number of arguments.
pub const CALLEES: [(&str, Callee, usize, usize); 35] = [
    ("sin", Callee::Function(Function::Sin), 1, 1),
    ("cos", Callee::Function(Function::Cos), 1, 1),
    ("tan", Callee::Function(Function::Tan), 1, 1),
    ("asin", Callee::Function(Function::Asin), 1, 1),
    ("acos", Callee::Function(Function::Acos), 1, 1),
    ("atan", Callee::Function(Function::Atan), 1, 1),
    ("sinh", Callee::Function(Function::Sinh), 1, 1),
    ("cosh", Callee::Function(Function::Cosh), 1, 1),
    ("tanh", Callee::Function(Function::Tanh), 1, 1),
    ("exp", Callee::Function(Function::Exp), 1, 1),
    ("ln", Callee::Function(Function::Ln), 1, 1),
    ("log10", Callee::Function(Function::Log10), 1, 1),
    ("sqrt", Callee::Function(Function::Sqrt), 1, 1),
    ("abs", Callee::Piecewise(Piecewise::Abs), 1, 1),
    ("min", Callee::Piecewise(Piecewise::Min), 2, 2),
    ("max", Callee::Piecewise(Piecewise::Max), 2, 2),
    ("heaviside", Callee::Piecewise(Piecewise::Heaviside), 1, 1),
    ("where", Callee::Piecewise(Piecewise::Where), 3, 3),
    ("d", Callee::Operator(Operator::Derivative), 2, 9),
    ("dt", Callee::Operator(Operator::TimeDerivative), 1, 1),
    ("grad", Callee::Operator(Operator::Gradient), 1, 1),
    ("div", Callee::Operator(Operator::Divergence), 1, 1),
    ("laplacian", Callee::Operator(Operator::Laplacian), 1, 1),
    ("curl", Callee::Operator(Operator::Curl), 1, 1),
    ("dot", Callee::Operator(Operator::Dot), 2, 2),
    ("inner", Callee::Operator(Operator::Inner), 2, 2),
    ("outer", Callee::Operator(Operator::Outer), 2, 2),
    ("cross", Callee::Operator(Operator::Cross), 2, 2),
    ("transpose", Callee::Operator(Operator::Transpose), 1, 1),
    ("sym", Callee::Operator(Operator::Symmetric), 1, 1),
    ("skew", Callee::Operator(Operator::Skew), 1, 1),
    ("trace", Callee::Operator(Operator::Trace), 1, 1),
    ("det", Callee::Operator(Operator::Determinant), 1, 1),
    ("inv", Callee::Operator(Operator::Inverse), 1, 1),
    ("integral", Callee::Operator(Operator::Integral), 2, 2),
];

/// Functions that the language leaves out, with the reason.
pub(crate) const LEFT_OUT: [(&str, &str); 10] = [
    (
        "log",
        "an unknown function; the natural logarithm is `ln`, that of base 10 `log10`",
    ),
    ("jump", INTERFACES),
    ("mean", INTERFACES),
    ("erf", SPECIAL),
    ("erfc", SPECIAL),
    ("gamma", SPECIAL),
    ("besselj", SPECIAL),
    ("real", COMPLEX),
    ("imag", COMPLEX),
    ("conj", COMPLEX),
];

const INTERFACES: &str =
    "no jumps or means: write a field for each side, and a face with `level` for the interface";

const SPECIAL: &str = "special functions are left out; not every language has them";

const COMPLEX: &str = "complex fields are left out; write real and imaginary part as two fields";

/// The constants by name.
pub const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

/// Names that have a meaning in every file: callees, constants, the normal and the unit tensor.
pub(crate) fn reserved() -> impl Iterator<Item = &'static str> {
    let callees = CALLEES.iter().map(|callee| callee.0);
    callees
        .chain(CONSTANTS.iter().map(|constant| constant.0))
        .chain(["n", "identity"])
}

/// The name of a value in a table of names.
pub(crate) fn name_in<T: PartialEq>(table: &[(&'static str, T)], value: &T) -> &'static str {
    let mut entries = table.iter();
    let entry = entries.find(|entry| entry.1 == *value);
    entry.map_or("", |entry| entry.0)
}

/// What is wrong with a name that is none of those known.
///
/// * `what`: `key`, `face`, `parameter`.
pub fn unknown(what: &str, name: &str, known: &[&str]) -> String {
    let near = did_you_mean(name, known.iter().copied());
    format!(
        "unknown {what} `{name}`{near}; expected one of {}",
        known.join(" ")
    )
}

/// The part of a message about an unknown name that suggests a known one; empty without a
/// suggestion.
pub fn did_you_mean<'c>(name: &str, known: impl IntoIterator<Item = &'c str>) -> String {
    nearest(name, known).map_or(String::new(), |near| format!(", did you mean `{near}`?"))
}

/// The candidate closest to `name`; `None` if none is close enough to be a typing error.
///
/// The distance counts insertions, deletions, replacements and swaps of neighbours, ignoring case.
/// It must be at most a third of the length of `name`, or 1, and less than the length of the
/// candidate.
pub fn nearest<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    // The computation of the distance takes time proportional to the product of both lengths.
    const LONGEST: usize = 40;
    let length = name.chars().take(LONGEST + 1).count();
    if length > LONGEST {
        return None;
    }
    let name = name.to_lowercase();
    let allowed = (length / 3).max(1);
    candidates
        .into_iter()
        .map(|candidate| (osa_distance(&name, &candidate.to_lowercase()), candidate))
        .filter(|&(distance, candidate)| {
            distance <= allowed && distance < candidate.chars().count()
        })
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_misspelt_name_is_suggested_and_an_unrelated_word_is_not() {
        let names = ["sin", "sinh", "sqrt", "log10", "theta_a", "elements"];
        for (written, meant) in [
            ("sine", Some("sin")),
            ("SIN", Some("sin")),
            ("sqr", Some("sqrt")),
            ("sqtr", Some("sqrt")),
            ("log", None),
            ("log01", Some("log10")),
            ("olg01", None),
            ("sinxyz", None),
            ("thetaa", Some("theta_a")),
            ("element", Some("elements")),
            ("zeta", None),
            ("", None),
        ] {
            assert_eq!(nearest(written, names), meant, "{written}");
        }
    }

    #[test]
    fn no_suggestion_for_names_longer_than_forty_characters() {
        assert_eq!(nearest(&"s".repeat(1_000_000), ["sin"]), None);
        let [forty, more] = [40, 41].map(|count| "s".repeat(count));
        assert_eq!(
            [&forty, &more].map(|name| nearest(name, [forty.as_str()])),
            [Some(forty.as_str()), None]
        );
    }

    #[test]
    fn suggestions_allow_one_edit_per_three_letters() {
        let edited = ["abcdefghX", "abcdefgXX", "abcdefXXX", "abcdeXXXX"]
            .map(|name| nearest(name, ["abcdefghi"]));
        assert_eq!(
            edited,
            [
                Some("abcdefghi"),
                Some("abcdefghi"),
                Some("abcdefghi"),
                None
            ]
        );
        assert_eq!((nearest("y", ["x"]), nearest("xx", ["x"])), (None, None));
    }
}
