//! What a language writes in its own way: one row for each language, in `languages/`.
//!
//! A word between two `@` stands for a value. `P` is the prefix of names, `NAME` the name of the
//! file, `F` that of a function, `T` time as an argument, `TIME` its declaration, `D` the number of
//! coordinates, `N` that of components, `BODY` statements.

use crate::language::names::Function;

type Text = &'static str;

/// A row whose fields are all texts.
macro_rules! row {
    ($(#[$about:meta])* $name:ident { $($(#[$field_about:meta])* $field:ident,)* }) => {
        $(#[$about])*
        pub(super) struct $name {
            $($(#[$field_about])* pub(super) $field: Text,)*
        }
    };
}

/// All that differs between languages.
pub(crate) struct Texts {
    /// Of the library's file.
    pub(super) ending: Text,
    /// Before the names of functions and parameters.
    pub(super) prefix: Text,
    pub(super) comment: Text,
    /// How a user builds the answering program.
    pub(super) build: Text,
    /// What builds and runs it here; none where values are not compared.
    pub(crate) tools: Option<Tools>,
    pub(super) names: NamingRules,
    pub(super) arithmetic: Arithmetic,
    pub(super) statements: Statements,
    pub(super) time: Time,
    pub(super) library: Library,
    /// A file of declarations.
    pub(super) header: Option<Header>,
    pub(super) scalar: Shaped,
    pub(super) tensor: Shaped,
    pub(super) integral: Text,
    /// None where there are no points to sum over.
    pub(super) norms: Option<Norms>,
    pub(super) parameters: Parameters,
    pub(super) choice: Choice,
    pub(super) answer: Option<Answer>,
}

/// Programs that build and run the emitted files, with blanks between words. `IN` is the folder.
pub(crate) struct Tools {
    /// It succeeds if they are there.
    pub(crate) probe: Text,
    pub(crate) missing: Text,
    pub(crate) builds: &'static [Text],
    pub(crate) answering: Answering,
}

/// What runs the answering program here.
#[derive(Clone, Copy)]
pub(crate) enum Answering {
    /// A command that is started for each question.
    Alone(Text),
    /// Where starting costs more than answering: an interpreter with a text, which answers question
    /// after question by the answering program.
    Session { interpreter: Text, text: Text },
}

/// Which names the language can tell apart, and which it has itself.
pub(super) struct NamingRules {
    pub(super) ignores_case: bool,
    /// Whether the module's name must differ from those of its functions.
    pub(super) has_one_space: bool,
    pub(super) taken: &'static [Taken],
}

/// Names that are taken, and what takes them.
pub(super) struct Taken {
    pub(super) by: Text,
    pub(super) names: Text,
}

/// Numbers and operations.
pub(super) struct Arithmetic {
    /// Coordinate `I` of an array; `I1` counts from one.
    pub(super) coordinate: Text,
    /// Behind the digits of a number.
    pub(super) suffix: Text,
    pub(super) times: Text,
    pub(super) over: Text,
    pub(super) functions: Functions,
    pub(super) power: Text,
    /// `THEN` where `LEFT SYMBOL RIGHT`, otherwise `ELSE`; `WORD` is the symbol as a name.
    pub(super) choose: Text,
}

row! {
    /// The call of each function at `X`: a language has all of them.
    Functions { sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, ln, log10, sqrt, }
}

impl Functions {
    pub(super) fn call(&self, function: Function) -> Text {
        match function {
            Function::Sin => self.sin,
            Function::Cos => self.cos,
            Function::Tan => self.tan,
            Function::Asin => self.asin,
            Function::Acos => self.acos,
            Function::Atan => self.atan,
            Function::Sinh => self.sinh,
            Function::Cosh => self.cosh,
            Function::Tanh => self.tanh,
            Function::Exp => self.exp,
            Function::Ln => self.ln,
            Function::Log10 => self.log10,
            Function::Sqrt => self.sqrt,
        }
    }
}

/// The functions behind this, by their names in C.
macro_rules! functions {
    ($prefix:literal) => {
        Functions {
            sin: concat!($prefix, "sin(@X@)"),
            cos: concat!($prefix, "cos(@X@)"),
            tan: concat!($prefix, "tan(@X@)"),
            asin: concat!($prefix, "asin(@X@)"),
            acos: concat!($prefix, "acos(@X@)"),
            atan: concat!($prefix, "atan(@X@)"),
            sinh: concat!($prefix, "sinh(@X@)"),
            cosh: concat!($prefix, "cosh(@X@)"),
            tanh: concat!($prefix, "tanh(@X@)"),
            exp: concat!($prefix, "exp(@X@)"),
            ln: concat!($prefix, "log(@X@)"),
            log10: concat!($prefix, "log10(@X@)"),
            sqrt: concat!($prefix, "sqrt(@X@)"),
        }
    };
}
pub(super) use functions;

/// Lines of a function.
pub(super) struct Statements {
    pub(super) indent: Text,
    pub(super) assign: Text,
    /// The result of a scalar function; component `I` of a tensor, `I1` from one; `INDICES` are row
    /// and column of a matrix, from one.
    pub(super) scalar: Text,
    pub(super) component: Text,
    /// Declares `NAMES`.
    pub(super) declare: Text,
    /// A use of an argument `X` that no statement uses.
    pub(super) unused: Text,
    /// Around the statements of a parameter that have constants of their own.
    pub(super) block: Option<[Text; 2]>,
    /// The array of the coordinates of an integrand, as an argument; the indent of its statements.
    pub(super) integrand: Text,
    pub(super) integrand_indent: Text,
}

row! {
    /// Time as an argument, and what declares it.
    Time {
        argument,
        declaration,
    }
}

row! {
    /// What stands around the functions.
    Library {
        opening,
        /// In the opening: what parameters need, what variants need, and a line for each function.
        for_parameters,
        for_variants,
        entry,
        /// `K` points `X` and weights `W` of the rule `RULE`, and what separates numbers.
        table,
        separator,
        /// Behind the tables.
        helpers,
        closing,
    }
}

row! {
    /// A file that declares what the library defines.
    Header {
        ending,
        template,
        variant,
        parameters,
    }
}

row! {
    /// What depends on whether a function is a scalar.
    Shaped {
        function,
        /// Its values at `AT` as an array.
        values,
        /// Its average: type, last argument, and the statement that returns the sum.
        kind,
        out,
        result,
        /// In the answering program.
        answer,
    }
}

/// Averages, and the norms of errors.
pub(super) struct Norms {
    pub(super) average: Text,
    /// The point of an average, and that of an error.
    pub(super) point: Text,
    pub(super) points: Text,
    pub(super) error: Text,
    pub(super) l1: Norm,
    pub(super) l2: Norm,
    /// NaN stays: no comparison holds with it; `max` of Fortran and Octave may lose it.
    pub(super) linf: Norm,
    /// In the largest error, where weights are not used.
    pub(super) without_weights: Text,
}

row! {
    /// What is summed, and what is done with the sum.
    Norm {
        add,
        root,
    }
}

row! {
    /// Parameters that are set at run time.
    Parameters {
        /// The definition of one; `BITS` are those of its value, `DIGITS` its digits.
        definition,
        /// Around `LINES`, the definitions of all.
        definitions,
        /// How functions read one, and how they do where its value depends on the variant.
        read,
        read_of_variant,
        assign,
        setter,
        /// The statements around all cases.
        body,
        /// `EL` is empty in the first case, and `el` in the others.
        case,
        indent,
        close,
        /// A line for each parameter at the head of the setter.
        global,
        /// The function that returns one; empty where programs read the variables of the module.
        getter,
        getter_case,
        /// What the answering program does with arguments `NAME=VALUE` behind the face.
        settings,
    }
}

row! {
    /// How a language chooses among bodies. In the texts `P` is the prefix of C, `ALL` the numbers
    /// of the models that have the body.
    Choice {
        /// What precedes all branches.
        before,
        /// `EL` is empty in the first case, and `el` in the others.
        case,
        otherwise,
        /// Behind the statements of each branch.
        close,
        /// Behind all branches.
        after,
        /// Before each line of a branch, besides its own indent.
        indent,
        number,
        between,
        /// The functions that choose.
        functions,
        /// The name of a model in their list, and what separates it from the next.
        name,
        between_names,
        /// A variable of the module.
        variable,
        /// The statement without which nothing is chosen yet, where a function needs it.
        ready,
        /// Parameters of a model that differ from those of the file; `CHANGES` are assignments.
        changes,
        change,
        /// What a program has to do.
        advice,
        /// What reads a parameter whose value depends on the variant.
        current,
    }
}

row! {
    /// The program that answers questions about points.
    Answer {
        ending,
        template,
        /// The line that chooses a variant.
        choose,
        /// The line by which time is taken from a point.
        time,
        /// Time as an argument of a call.
        time_argument,
        /// The branch that prints the names of a face, and what stands between the parts of a long
        /// line.
        names,
        separator,
        /// The result of a call for a matrix row by row.
        matrix,
        /// Between calls.
        between,
        /// The branch that evaluates the functions of a face; `COUNT` is the number of components.
        branch,
    }
}
