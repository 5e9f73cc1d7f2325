//! Parameters that are set at run time: their values in the file are defaults, and those that
//! depend on one that is set follow.

use std::fmt::Write;

use super::Language;
use super::lower::Lowered;
use super::write::{Writer, declared};
use crate::model::Model;
use crate::problem::mentions;

/// The parameters that depend on one, each after those that it depends on.
fn followers(model: &Model, index: usize) -> Vec<usize> {
    let parameters = &model.problem.parameters;
    let depends =
        |on: usize, of: usize| mentions(&parameters[of].expression.tree, &parameters[on].name);
    let count = parameters.len();
    // In each round those whose operands are known: a file has no circles.
    let mut order: Vec<usize> = vec![];
    while order.len() < count {
        let is_ready = |of: &usize| {
            !order.contains(of) && (0..count).all(|on| !depends(on, *of) || order.contains(&on))
        };
        let Some(next) = (0..count).find(is_ready) else {
            break;
        };
        order.push(next);
    }
    let mut changed = vec![index];
    for of in order {
        if of != index && changed.iter().any(|on| depends(*on, of)) {
            changed.push(of);
        }
    }
    changed.split_off(1)
}

/// The definition of a parameter.
fn definition(language: Language, name: &str, value: f64) -> String {
    let number = language.number(value);
    match language {
        Language::C => format!("static double {name} = {number};\n"),
        Language::Fortran => format!("real(dp), protected :: {name} = {number}\n"),
        Language::Rust => format!(
            "#[allow(non_upper_case_globals)]\nstatic {name}: AtomicU64 = AtomicU64::new({:#x}); // {value:?}\n",
            value.to_bits()
        ),
        Language::Octave => format!("    known.{name} = {number};\n"),
        Language::Python | Language::Ufl => format!("{name} = {number}\n"),
    }
}

/// How functions read a parameter.
pub(super) fn read(language: Language, name: &str) -> String {
    match language {
        Language::Rust => format!("current(&{name})"),
        Language::Octave => format!("parameters().{name}"),
        _ => name.to_owned(),
    }
}

fn assignment(language: Language, name: &str, value: &str) -> String {
    match language {
        Language::C => format!("{name} = {value};"),
        Language::Rust => format!("{name}.store(({value}).to_bits(), Relaxed);"),
        Language::Octave => format!("store('{name}', {value});"),
        _ => format!("{name} = {value}"),
    }
}

/// The definitions of all parameters.
pub(super) fn definitions(writer: &Writer<'_>) -> String {
    let values = writer.model.graph.parameters.iter();
    let pairs = writer.parameters.iter().zip(values);
    let lines: String = pairs
        .map(|(name, value)| definition(writer.language, name, *value))
        .collect();
    if lines.is_empty() {
        return lines;
    }
    match writer.language {
        Language::Rust => format!(
            "use std::sync::atomic::{{AtomicU64, Ordering::Relaxed}};\n\n{lines}\n\
             fn current(parameter: &AtomicU64) -> f64 {{\n    f64::from_bits(parameter.load(Relaxed))\n}}\n\n"
        ),
        Language::Octave => format!(
            "function values = parameters(new)\n  persistent known\n  if isempty(known)\n{lines}  end\n  \
             if nargin > 0, known = new; end\n  values = known;\nend\n\n\
             function store(name, value)\n  values = parameters();\n  values.(name) = value;\n  \
             parameters(values);\nend\n\n"
        ),
        _ => lines,
    }
}

/// The statements that set a parameter, and those that follow it.
struct Branch<'w> {
    name: &'w str,
    statements: Vec<String>,
    constants: Vec<[String; 2]>,
}

fn branch<'w>(writer: &'w Writer<'_>, index: usize) -> Branch<'w> {
    let language = writer.language;
    let mut statements = vec![assignment(language, &writer.parameters[index], "value")];
    let mut all = vec![];
    for follower in followers(writer.model, index) {
        let node = writer.model.parameters[follower];
        let Lowered { constants, roots } = writer.statements(&[node], "x", "t");
        // One after the other: constants are numbered anew for each, in C in a block of their own.
        let is_block = language == Language::C && !constants.is_empty();
        statements.extend(is_block.then(|| "{".to_owned()));
        for [name, value] in constants {
            statements.push(language.assign(&name, &value));
            if !all.contains(&[name.clone(), String::new()]) {
                all.push([name, String::new()]);
            }
        }
        let name = &writer.parameters[follower];
        statements.push(assignment(language, name, &roots[0]));
        statements.extend(is_block.then(|| "}".to_owned()));
    }
    Branch {
        name: &writer.model.problem.parameters[index].name,
        statements,
        constants: all,
    }
}

/// The function `set_parameter`; empty without parameters.
pub(super) fn setter(writer: &Writer<'_>) -> String {
    let count = writer.parameters.len();
    let branches: Vec<Branch<'_>> = (0..count).map(|index| branch(writer, index)).collect();
    if branches.is_empty() {
        return String::new();
    }
    let mut cases = String::new();
    for (
        number,
        Branch {
            name, statements, ..
        },
    ) in branches.iter().enumerate()
    {
        let [opening, indent, closing] = match writer.language {
            Language::C => [
                format!("    if (strcmp(name, \"{name}\") == 0) {{\n"),
                " ".repeat(8),
                "        return 0;\n    }\n".to_owned(),
            ],
            Language::Fortran => [
                format!("    case ('{name}')\n"),
                " ".repeat(8),
                String::new(),
            ],
            Language::Rust => [
                format!("        \"{name}\" => {{\n"),
                " ".repeat(12),
                "        }\n".to_owned(),
            ],
            Language::Octave => [format!("    case '{name}'\n"), " ".repeat(6), String::new()],
            Language::Python | Language::Ufl => {
                let word = if number == 0 { "if" } else { "elif" };
                [
                    format!("    {word} name == \"{name}\":\n"),
                    " ".repeat(8),
                    String::new(),
                ]
            }
        };
        cases += &opening;
        for statement in statements {
            let _ = writeln!(cases, "{indent}{statement}");
        }
        cases += &closing;
    }
    framed(writer, &branches, &cases)
}

/// The function around its cases.
fn framed(writer: &Writer<'_>, branches: &[Branch<'_>], cases: &str) -> String {
    let Writer {
        prefix, language, ..
    } = writer;
    match language {
        Language::C => format!(
            "int {prefix}set_parameter(const char *name, double value)\n{{\n{cases}    return 1;\n}}\n\n"
        ),
        Language::Fortran => {
            let longest = branches
                .iter()
                .map(|b| &b.constants)
                .max_by_key(|c| c.len());
            let declared = longest.map_or(String::new(), |c| declared(*language, c));
            format!(
                "subroutine set_parameter(name, value)\n    character(*), intent(in) :: name\n    \
                 real(dp), intent(in) :: value\n{declared}    select case (name)\n{cases}    case default\n        \
                 error stop 'unknown parameter'\n    end select\nend subroutine set_parameter\n\n"
            )
        }
        Language::Rust => format!(
            "pub fn set_parameter(name: &str, value: f64) -> Result<(), String> {{\n    match name {{\n{cases}        \
             _ => return Err(format!(\"unknown parameter `{{name}}`\")),\n    }}\n    Ok(())\n}}\n\n"
        ),
        Language::Octave => format!(
            "function set_parameter(name, value)\n  switch name\n{cases}    otherwise\n      \
             error('unknown parameter %s', name);\n  end\nend\n\n"
        ),
        Language::Python | Language::Ufl => {
            let globals: String = writer
                .parameters
                .iter()
                .map(|name| format!("    global {name}\n"))
                .collect();
            format!(
                "def set_parameter(name, value):\n{globals}{cases}    else:\n        \
                 raise ValueError(f\"unknown parameter {{name}}\")\n\n\n"
            )
        }
    }
}

/// What the answering program does with arguments `NAME=VALUE` behind the face.
pub(super) fn settings(model: &Model, language: Language, prefix: &str) -> String {
    if model.problem.parameters.is_empty() {
        return String::new();
    }
    match language {
        Language::C => format!(
            "    for (int i = 2; i < argc; ++i) {{\n        char *value = strchr(argv[i], '=');\n        \
             if (!value) return 2;\n        *value = '\\0';\n        \
             if ({prefix}set_parameter(argv[i], strtod(value + 1, NULL))) return 2;\n    }}\n"
        ),
        Language::Fortran => "    do place = 2, command_argument_count()\n        \
             call get_command_argument(place, text)\n        \
             cut = index(text, '=')\n        read(text(cut + 1:), *) value\n        \
             call set_parameter(text(:cut - 1), value)\n    end do\n"
            .to_owned(),
        Language::Python => "for word in sys.argv[2:]:\n    name, value = word.split(\"=\")\n    \
             library.set_parameter(name, float(value))\n"
            .to_owned(),
        Language::Octave => "for k = 2:numel(words)\n  parts = strsplit(words{k}, '=');\n  \
             p.set_parameter(parts{1}, str2double(parts{2}));\nend\n"
            .to_owned(),
        Language::Rust => "    for word in std::env::args().skip(2) {\n        \
             let (name, value) = word.split_once('=').expect(\"NAME=VALUE\");\n        \
             library::set_parameter(name, value.parse().expect(\"a number\")).expect(\"a parameter\");\n    }\n"
            .to_owned(),
        Language::Ufl => String::new(),
    }
}
