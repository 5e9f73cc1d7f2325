//! C99, which C++ reads, too.

use super::super::texts::*;

/// C11, 7.1.2: the name of the header is that of the file.
const TAKEN: [Taken; 1] = [Taken {
    by: "a header of the standard library that the emitted one would hide",
    names: "assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp \
            signal stdalign stdarg stdatomic stdbool stddef stdint stdio stdlib stdnoreturn \
            string tgmath threads time uchar wchar wctype",
}];

pub(super) const C: Texts = Texts {
    ending: ".c",
    prefix: "@NAME@_",
    comment: "//",
    build: "cc -O2 -o answer @NAME@.c @NAME@_answer.c -lm",
    tools: Some(Tools {
        probe: "cc --version",
        missing: "C compiler",
        builds: &["cc -std=c99 -O2 -o @IN@@NAME@_answer_c @IN@@NAME@.c @IN@@NAME@_answer.c -lm"],
        answering: Answering::Alone("@IN@@NAME@_answer_c"),
    }),
    names: NamingRules {
        ignores_case: false,
        has_one_space: false,
        taken: &TAKEN,
    },
    arithmetic: Arithmetic {
        coordinate: "@ARRAY@[@I@]",
        suffix: "",
        times: "*",
        over: "/",
        functions: functions!(""),
        power: "pow(@LEFT@, @RIGHT@)",
        choose: "(@LEFT@ @SYMBOL@ @RIGHT@ ? @THEN@ : @ELSE@)",
    },
    statements: Statements {
        indent: "    ",
        assign: "const double @NAME@ = @VALUE@;",
        scalar: "return @VALUE@;",
        component: "out[@I@] = @VALUE@;",
        declare: "",
        unused: "    (void)@X@;\n",
        block: Some(["{", "}"]),
        integrand: "y",
        integrand_indent: "        ",
    },
    time: Time {
        argument: ", double t",
        declaration: "",
    },
    library: Library {
        opening: "\n#include <math.h>\n@HEADERS@#include \"@NAME@.h\"\n\n",
        for_parameters: "#include <string.h>\n",
        for_variants: "#include <stdio.h>\n#include <stdlib.h>\n#include <string.h>\n",
        entry: "",
        table: "static const double @P@@RULE@_x[@K@] = {\n    @X@\n};\n\
                static const double @P@@RULE@_w[@K@] = {\n    @W@\n};\n",
        separator: ",\n    ",
        helpers: "\n",
        closing: "",
    },
    header: Some(Header {
        ending: ".h",
        template: include_str!("../templates/header.h"),
        variant: include_str!("../templates/header_variant.h"),
        parameters: include_str!("../templates/header_parameters.h"),
    }),
    scalar: Shaped {
        function: "double @P@@F@(const double x[]@T@)\n{\n@UNUSED@@BODY@}\n\n",
        values: "value[0] = @P@@F@(@AT@@TIME@);",
        kind: "double",
        out: "",
        result: "return sum[0];",
        answer: "            out[@PLACE@] = @P@@F@(x@TIME@);\n",
    },
    tensor: Shaped {
        function: "void @P@@F@(const double x[]@T@, double out[])\n{\n@UNUSED@@BODY@}\n\n",
        values: "@P@@F@(@AT@@TIME@, value);",
        kind: "void",
        out: ", double out[]",
        result: "for (int j = 0; j < @N@; ++j) out[j] = sum[j];",
        answer: "            @P@@F@(x@TIME@, out + @PLACE@);\n",
    },
    integral: include_str!("../templates/integral.c"),
    norms: Some(Norms {
        average: include_str!("../templates/average.c"),
        point: "x",
        points: "x + @D@*k",
        error: include_str!("../templates/error.c"),
        l1: Norm {
            add: "sum += weights[k]*difference;",
            root: "sum",
        },
        l2: Norm {
            add: "sum += weights[k]*difference*difference;",
            root: "sqrt(sum)",
        },
        linf: Norm {
            add: "if (!(difference <= sum)) sum = difference + 0.0*sum;",
            root: "sum",
        },
        without_weights: "    (void)weights;\n",
    }),
    parameters: Parameters {
        definition: "static double @NAME@ = @VALUE@;\n",
        definitions: "@LINES@",
        read: "@NAME@",
        read_of_variant: "@P@current(&@NAME@)",
        assign: "@NAME@ = @VALUE@;",
        setter: include_str!("../templates/setter.c"),
        body: "@CASES@",
        case: "    if (strcmp(name, \"@NAME@\") == 0) {\n",
        indent: "        ",
        close: "        return 0;\n    }\n",
        global: "",
        getter: include_str!("../templates/getter.c"),
        getter_case: "    if (strcmp(name, \"@NAME@\") == 0) return @VALUE@;\n",
        settings: "    for (int i = 2; i < argc; ++i) {\n        char *value = strchr(argv[i], '=');\n        \
                   if (!value) return 2;\n        *value = '\\0';\n        \
                   if (@P@set_parameter(argv[i], strtod(value + 1, NULL))) return 2;\n    }\n",
    },
    choice: Choice {
        before: "    switch (@P@variant()) {\n",
        case: "    @ALL@ {\n",
        otherwise: "    default: {\n",
        close: "    } break;\n",
        after: "    }\n",
        indent: "    ",
        number: "case @K@:",
        between: " ",
        functions: include_str!("../templates/variant.c"),
        name: "\"@NAME@\"",
        between_names: ",\n        ",
        variable: "",
        ready: "    @P@variant();\n",
        changes: "        if (place == @K@) {\n@CHANGES@        }\n",
        change: "            @NAME@ = @VALUE@;\n",
        advice: "",
        current: "static double @P@current(const double *parameter)\n{\n    \
                  @P@variant();\n    return *parameter;\n}\n\n",
    },
    answer: Some(Answer {
        ending: ".c",
        template: include_str!("../templates/answer.c"),
        choose: "",
        time: "",
        time_argument: ", p[@D@]",
        names: "    if (strcmp(face, \"@FACE@\") == 0) \n        names = \"@NAMES@\";\n",
        separator: "\"\n        \"",
        matrix: "@CALL@",
        between: "",
        branch: "        if (strcmp(face, \"@FACE@\") == 0) {\n@CALLS@            \
                 count = @COUNT@;\n        }\n",
    }),
};
