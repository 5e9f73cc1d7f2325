//! Parameters that are set at run time: their values in the file are defaults, and those that
//! depend on one that is set follow.

use std::fmt::Write;

use super::lower::Lowered;
use super::write::{Emitted, Writer, declared};
use super::{Language, choice, fill};
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
pub(super) fn read(writer: &Writer<'_>, name: &str) -> String {
    match writer.language {
        Language::C if writer.changes_parameters() => format!("{}current(&{name})", writer.prefix),
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
             fn current(parameter: &AtomicU64) -> f64 {{\n{}    f64::from_bits(parameter.load(Relaxed))\n}}\n\n",
            if writer.changes_parameters() {
                choice::ready(writer)
            } else {
                String::new()
            }
        ),
        Language::Octave => format!(
            "function values = parameters(new)\n  persistent known\n  if isempty(known)\n{lines}{}  end\n  \
             if nargin > 0, known = new; end\n  values = known;\nend\n\n\
             function store(name, value)\n  values = parameters();\n  values.(name) = value;\n  \
             parameters(values);\nend\n\n",
            choice::changes(writer)
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

fn branch<'w>(writer: &'w Writer<'_>, emitted: &Emitted<'_>, index: usize) -> Branch<'w> {
    let language = writer.language;
    let mut statements = vec![assignment(language, &writer.parameters[index], "value")];
    let mut all = vec![];
    for follower in followers(emitted.model, index) {
        let node = emitted.model.parameters[follower];
        let Lowered { constants, roots } = writer.statements(emitted, &[node], "x", "t");
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

/// How a language sets a parameter by its name, and returns it.
struct Access {
    setter: &'static str,
    /// The statements around all cases.
    body: &'static str,
    first: &'static str,
    later: &'static str,
    indent: usize,
    close: &'static str,
    /// The function that returns one; empty where programs read the variables of the module.
    getter: &'static str,
    getter_case: &'static str,
}

fn texts(language: Language) -> Access {
    match language {
        Language::C => Access {
            setter: include_str!("templates/setter.c"),
            body: "@CASES@",
            first: "    if (strcmp(name, \"@NAME@\") == 0) {\n",
            later: "    if (strcmp(name, \"@NAME@\") == 0) {\n",
            indent: 8,
            close: "        return 0;\n    }\n",
            getter: include_str!("templates/getter.c"),
            getter_case: "    if (strcmp(name, \"@NAME@\") == 0) return @VALUE@;\n",
        },
        Language::Fortran => Access {
            setter: include_str!("templates/setter.f90"),
            body: "    select case (name)\n@CASES@    case default\n        \
                   error stop 'unknown parameter'\n    end select\n",
            first: "    case ('@NAME@')\n",
            later: "    case ('@NAME@')\n",
            indent: 8,
            close: "",
            getter: "",
            getter_case: "",
        },
        Language::Rust => Access {
            setter: include_str!("templates/setter.rs"),
            body: "    match name {\n@CASES@        \
                   _ => return Err(format!(\"unknown parameter `{name}`\")),\n    }\n",
            first: "        \"@NAME@\" => {\n",
            later: "        \"@NAME@\" => {\n",
            indent: 12,
            close: "        }\n",
            getter: include_str!("templates/getter.rs"),
            getter_case: "        \"@NAME@\" => Some(@VALUE@),\n",
        },
        Language::Octave => Access {
            setter: include_str!("templates/setter.m"),
            body: "  switch name\n@CASES@    otherwise\n      \
                   error('unknown parameter %s', name);\n  end\n",
            first: "    case '@NAME@'\n",
            later: "    case '@NAME@'\n",
            indent: 6,
            close: "",
            getter: include_str!("templates/getter.m"),
            getter_case: "    case '@NAME@'\n      value = @VALUE@;\n",
        },
        Language::Python | Language::Ufl => Access {
            setter: include_str!("templates/setter.py"),
            body: "@CASES@    else:\n        raise ValueError(f\"unknown parameter {name}\")\n",
            first: "    if name == \"@NAME@\":\n",
            later: "    elif name == \"@NAME@\":\n",
            indent: 8,
            close: "",
            getter: "",
            getter_case: "",
        },
    }
}

/// The functions that set and return a parameter; empty without parameters.
pub(super) fn functions(writer: &Writer<'_>) -> String {
    if writer.parameters.is_empty() {
        return String::new();
    }
    let texts = texts(writer.language);
    let mut bodies = vec![];
    let mut longest = vec![];
    for emitted in &writer.models {
        let mut cases = String::new();
        for index in 0..writer.parameters.len() {
            let Branch {
                name,
                statements,
                constants,
            } = branch(writer, emitted, index);
            let opening = if index == 0 { texts.first } else { texts.later };
            cases += &fill(opening, &[("NAME", name)]);
            for statement in statements {
                let _ = writeln!(cases, "{}{statement}", " ".repeat(texts.indent));
            }
            cases += texts.close;
            if constants.len() > longest.len() {
                longest = constants;
            }
        }
        bodies.push(fill(texts.body, &[("CASES", &cases)]));
    }
    let globals: String = writer
        .parameters
        .iter()
        .map(|name| format!("    global {name}\n"))
        .collect();
    let setter = fill(
        texts.setter,
        &[
            ("GLOBALS", &globals),
            ("DECLARED", &declared(writer.language, &longest)),
            ("READY", &choice::ready(writer)),
            ("BODY", &choice::body(writer, &bodies)),
            ("P", &writer.prefix),
        ],
    );
    setter + &getter(writer, &texts)
}

fn getter(writer: &Writer<'_>, texts: &Access) -> String {
    let parameters = &writer.model.problem.parameters;
    let cases = writer.parameters.iter().zip(parameters);
    let cases: String = cases
        .map(|(name, parameter)| {
            let value = read(writer, name);
            fill(
                texts.getter_case,
                &[("NAME", &parameter.name), ("VALUE", &value)],
            )
        })
        .collect();
    fill(texts.getter, &[("CASES", &cases), ("P", &writer.prefix)])
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
