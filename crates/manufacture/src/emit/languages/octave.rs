//! Octave and MATLAB.

use super::super::texts::*;

/// `iskeyword()` of Octave and MATLAB; functions that the emitted file calls.
const TAKEN: [Taken; 2] = [
    Taken {
        by: "a keyword of Octave",
        names: "break case catch classdef continue do else elseif end end_try_catch \
                end_unwind_protect endclassdef endenumeration endevents endfor endfunction endif \
                endmethods endparfor endproperties endspmd endswitch endwhile enumeration events \
                for function global if methods otherwise parfor persistent properties return spmd \
                switch try until unwind_protect unwind_protect_cleanup while",
    },
    Taken {
        by: "a function of Octave that the emitted one would hide",
        names: "abs acos any argv asin atan cos cosh error exp fgetl find floor fscanf gauss getenv \
                get_parameter \
                isempty isfield isscalar log log10 max min mod num2cell numel ones parameters pick \
                printf puts rule set_parameter sin sinh size sprintf sqrt stdin store strcmp \
                strsplit strtrim sum tan tanh true variant zeros",
    },
];

const SHAPED: Shaped = Shaped {
    function: "function out = @F@(x@T@)\n  out = zeros(@N@, size(x, 2));\n@BODY@end\n\n",
    values: "",
    kind: "",
    out: "",
    result: "",
    answer: "p.@F@(x@TIME@)",
};

pub(super) const OCTAVE: Texts = Texts {
    ending: ".m",
    prefix: "",
    comment: "%",
    build: "octave --quiet @NAME@_answer.m",
    tools: Some(Tools {
        probe: "octave --version",
        missing: "Octave",
        builds: &[],
        answering: Answering::Alone("octave --quiet --no-history --path @IN@ @IN@@NAME@_answer.m"),
    }),
    names: NamingRules {
        ignores_case: false,
        has_one_space: false,
        taken: &TAKEN,
    },
    arithmetic: Arithmetic {
        coordinate: "@ARRAY@(@I1@, :)",
        suffix: "",
        times: ".*",
        over: "./",
        functions: functions!(""),
        power: "(@LEFT@).^(@RIGHT@)",
        choose: "pick(@LEFT@ @SYMBOL@ @RIGHT@, @THEN@, @ELSE@)",
    },
    statements: Statements {
        indent: "  ",
        assign: "@NAME@ = @VALUE@;",
        scalar: "out(@I1@, :) = @VALUE@;",
        component: "out(@I1@, :) = @VALUE@;",
        declare: "",
        unused: "",
        block: None,
        integrand: "y",
        integrand_indent: "    ",
    },
    time: Time {
        argument: ", t",
        declaration: "",
    },
    library: Library {
        // An unknown variant is refused at once.
        opening: "\nfunction p = @NAME@()\n@HEADERS@@ENTRIES@end\n\n",
        for_parameters: "",
        for_variants: "  variant();\n",
        entry: "  p.@F@ = @@F@;\n",
        table: "function [points, weights] = @RULE@()\n  points = [ ...\n    @X@];\n  \
                weights = [ ...\n    @W@];\nend\n\n",
        separator: ", ...\n    ",
        helpers: include_str!("../templates/pick.m"),
        closing: "",
    },
    header: None,
    scalar: SHAPED,
    tensor: SHAPED,
    integral: include_str!("../templates/integral.m"),
    norms: Some(Norms {
        average: include_str!("../templates/average.m"),
        point: "",
        points: "",
        error: include_str!("../templates/error.m"),
        l1: Norm {
            add: "",
            root: "sum(sum(weights(:).'.*difference))",
        },
        l2: Norm {
            add: "",
            root: "sqrt(sum(sum(weights(:).'.*difference.^2)))",
        },
        linf: Norm {
            add: "",
            root: "max(difference(:)) + 0*sum(difference(:))",
        },
        without_weights: "",
    }),
    parameters: Parameters {
        definition: "    known.@NAME@ = @VALUE@;\n",
        definitions: include_str!("../templates/parameters.m"),
        read: "parameters().@NAME@",
        read_of_variant: "parameters().@NAME@",
        assign: "store('@NAME@', @VALUE@);",
        setter: include_str!("../templates/setter.m"),
        body: "  switch name\n@CASES@    otherwise\n      \
               error('unknown parameter %s', name);\n  end\n",
        case: "    case '@NAME@'\n",
        indent: "      ",
        close: "",
        global: "",
        getter: include_str!("../templates/getter.m"),
        getter_case: "    case '@NAME@'\n      value = @VALUE@;\n",
        settings: "for k = 2:numel(words)\n  parts = strsplit(words{k}, '=');\n  \
                   p.set_parameter(parts{1}, str2double(parts{2}));\nend\n",
    },
    choice: Choice {
        before: "  switch variant()\n",
        case: "    case {@ALL@}\n",
        otherwise: "    otherwise\n",
        close: "",
        after: "  end\n",
        indent: "    ",
        number: "@K@",
        between: ", ",
        functions: include_str!("../templates/variant.m"),
        name: "'@NAME@'",
        between_names: ", ...\n      ",
        variable: "",
        ready: "",
        changes: "    if variant() == @K@\n@CHANGES@    end\n",
        change: "      known.@NAME@ = @VALUE@;\n",
        advice: "",
        current: "",
    },
    answer: Some(Answer {
        ending: ".m",
        template: include_str!("../templates/answer.m"),
        choose: "",
        time: "t = points(@V@, :);\n",
        time_argument: ", t",
        names: "",
        separator: "\", ...\n      \"",
        matrix: "@CALL@",
        between: "; ...\n      ",
        branch: "  case '@FACE@'\n    puts([\"@NAMES@\\n\"]);\n    rows = [@CALLS@];\n",
    }),
};
