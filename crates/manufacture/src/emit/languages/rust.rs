//! Rust.

use super::super::texts::*;

/// The Rust Reference, 2.1; crates that are always there.
const TAKEN: [Taken; 2] = [
    Taken {
        by: "a keyword of Rust",
        names: "Self abstract as async await become box break const continue crate do dyn else \
                enum extern false final fn for gen if impl in let loop macro match mod move mut \
                override priv pub ref return self static struct super trait true try type \
                typeof unsafe unsized use virtual where while yield",
    },
    Taken {
        by: "a crate that every program has",
        names: "alloc core std",
    },
];

pub(super) const RUST: Texts = Texts {
    ending: ".rs",
    prefix: "",
    comment: "//",
    build: "rustc --edition 2021 -O -o answer @NAME@_answer.rs",
    tools: Some(Tools {
        probe: "rustc --version",
        missing: "rustc",
        builds: &["rustc --edition 2021 -O -o @IN@@NAME@_answer_rust @IN@@NAME@_answer.rs"],
        answering: Answering::Alone("@IN@@NAME@_answer_rust"),
    }),
    names: NamingRules {
        ignores_case: false,
        has_one_space: false,
        taken: &TAKEN,
    },
    arithmetic: Arithmetic {
        coordinate: "@ARRAY@[@I@]",
        suffix: "_f64",
        times: "*",
        over: "/",
        functions: Functions {
            ln: "f64::ln(@X@)",
            ..functions!("f64::")
        },
        power: "f64::powf(@LEFT@, @RIGHT@)",
        choose: "(if @LEFT@ @SYMBOL@ @RIGHT@ { @THEN@ } else { @ELSE@ })",
    },
    statements: Statements {
        indent: "    ",
        assign: "let @NAME@ = @VALUE@;",
        scalar: "@VALUE@",
        component: "out[@I@] = @VALUE@;",
        declare: "",
        unused: "",
        block: None,
        integrand: "&y",
        integrand_indent: "        ",
    },
    time: Time {
        argument: ", t: f64",
        declaration: "",
    },
    library: Library {
        opening: "#![allow(dead_code, unused_variables, unused_parens, non_snake_case)]\n\n",
        for_parameters: "",
        for_variants: "",
        entry: "",
        table: "const @RULE1@_X: [f64; @K@] = [\n    @X@,\n];\n\
                const @RULE1@_W: [f64; @K@] = [\n    @W@,\n];\n",
        separator: ",\n    ",
        helpers: "\n",
        closing: "",
    },
    header: None,
    scalar: Shaped {
        function: "pub fn @F@(x: &[f64; @D@]@T@) -> f64 {\n@BODY@}\n\n",
        values: "[@F@(@AT@@TIME@)]",
        kind: "f64",
        out: "",
        result: "sum[0]",
        answer: "                out.push(library::@F@(&x@TIME@));\n",
    },
    tensor: Shaped {
        function: "pub fn @F@(x: &[f64; @D@]@T@) -> [f64; @N@] {\n    \
                   let mut out = [0.0; @N@];\n@BODY@    out\n}\n\n",
        values: "@F@(@AT@@TIME@)",
        kind: "[f64; @N@]",
        out: "",
        result: "sum",
        answer: "                out.extend(library::@F@(&x@TIME@));\n",
    },
    integral: include_str!("../templates/integral.rs"),
    norms: Some(Norms {
        average: include_str!("../templates/average.rs"),
        point: "&x",
        points: "&x[k]",
        error: include_str!("../templates/error.rs"),
        l1: Norm {
            add: "sum += weights[k]*difference;",
            root: "sum",
        },
        l2: Norm {
            add: "sum += weights[k] * difference * difference;",
            root: "f64::sqrt(sum)",
        },
        linf: Norm {
            add: "if !(difference <= sum) { sum = difference + 0.0 * sum; }",
            root: "sum",
        },
        without_weights: "",
    }),
    parameters: Parameters {
        definition: "#[allow(non_upper_case_globals)]\n\
                     static @NAME@: AtomicU64 = AtomicU64::new(@BITS@); // @DIGITS@\n",
        definitions: include_str!("../templates/parameters.rs"),
        read: "current(&@NAME@)",
        read_of_variant: "current(&@NAME@)",
        assign: "@NAME@.store((@VALUE@).to_bits(), Relaxed);",
        setter: include_str!("../templates/setter.rs"),
        body: "    match name {\n@CASES@        \
               _ => return Err(format!(\"unknown parameter `{name}`\")),\n    }\n",
        case: "        \"@NAME@\" => {\n",
        indent: "            ",
        close: "        }\n",
        global: "",
        getter: include_str!("../templates/getter.rs"),
        getter_case: "        \"@NAME@\" => Some(@VALUE@),\n",
        settings: "    for word in std::env::args().skip(2) {\n        \
                   let (name, value) = word.split_once('=').expect(\"NAME=VALUE\");\n        \
                   library::set_parameter(name, value.parse().expect(\"a number\")).expect(\"a parameter\");\n    }\n",
    },
    choice: Choice {
        before: "    match variant() {\n",
        case: "        @ALL@ => {\n",
        otherwise: "        _ => {\n",
        close: "        }\n",
        after: "    }\n",
        indent: "        ",
        number: "@K@",
        between: " | ",
        functions: include_str!("../templates/variant.rs"),
        name: "\"@NAME@\"",
        between_names: ",\n            ",
        variable: "",
        ready: "    variant();\n",
        changes: "        if place == @K@ {\n@CHANGES@        }\n",
        change: "            @NAME@.store(f64::to_bits(@VALUE@), Relaxed);\n",
        advice: "",
        current: "",
    },
    answer: Some(Answer {
        ending: ".rs",
        template: include_str!("../templates/answer.rs"),
        choose: "",
        time: "",
        time_argument: ", p[@D@]",
        names: "        \"@FACE@\" => println!(\"@NAMES@\"),\n",
        separator: "\\\n            ",
        matrix: "@CALL@",
        between: "",
        branch: "            \"@FACE@\" => {\n@CALLS@            }\n",
    }),
};
