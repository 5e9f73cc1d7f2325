//! Fortran 2008.

use super::super::texts::*;

/// Fortran has no reserved words; modules share one space with procedures.
const TAKEN: [Taken; 2] = [
    Taken {
        by: "an intrinsic module of Fortran",
        names: "iso_c_binding iso_fortran_env ieee_arithmetic ieee_exceptions ieee_features",
    },
    Taken {
        by: "a name that the emitted module itself has",
        names: "choose_variant dp gauss_x gauss_w require_variant rule_x rule_w set_parameter variant",
    },
];

const FUNCTION: &str = "pure function @F@(x@T@) result(out)\n    \
     real(dp), intent(in) :: x(:)@TIME@\n    real(dp) :: out@SHAPE@\n\
     @DECLARED@@UNUSED@@READY@@BODY@end function @F@\n\n";

const SHAPED: Shaped = Shaped {
    function: FUNCTION,
    values: "",
    kind: "",
    out: "",
    result: "",
    answer: "@F@(x@TIME@)",
};

pub(super) const FORTRAN: Texts = Texts {
    ending: ".f90",
    prefix: "",
    comment: "!",
    build: "gfortran -O2 -o answer @NAME@.f90 @NAME@_answer.f90",
    tools: Some(Tools {
        probe: "gfortran --version",
        missing: "gfortran",
        builds: &[
            "gfortran -std=f2008 -O2 -J @IN@ -o @IN@@NAME@_answer_fortran @IN@@NAME@.f90 @IN@@NAME@_answer.f90",
        ],
        answering: Answering::Alone("@IN@@NAME@_answer_fortran"),
    }),
    names: NamingRules {
        ignores_case: true,
        has_one_space: true,
        taken: &TAKEN,
    },
    arithmetic: Arithmetic {
        coordinate: "@ARRAY@(@I1@)",
        suffix: "_dp",
        times: "*",
        over: "/",
        functions: functions!(""),
        power: "(@LEFT@)**(@RIGHT@)",
        choose: "merge(@THEN@, @ELSE@, @LEFT@ @SYMBOL@ @RIGHT@)",
    },
    statements: Statements {
        indent: "    ",
        assign: "@NAME@ = @VALUE@",
        scalar: "out = @VALUE@",
        component: "out(@INDICES@) = @VALUE@",
        declare: "    real(dp) :: @NAMES@\n",
        unused: "    associate (unused => @X@)\n    end associate\n",
        block: None,
        integrand: "y",
        integrand_indent: "            ",
    },
    time: Time {
        argument: ", t",
        declaration: ", t",
    },
    library: Library {
        opening: "module @NAME@\nimplicit none\npublic\n\
                  integer, parameter, private :: dp = kind(1.0d0)\n",
        for_parameters: "",
        for_variants: "",
        entry: "",
        table: "real(dp), parameter, private :: @RULE@_x(@K@) = [ &\n    @X@]\n\
                real(dp), parameter, private :: @RULE@_w(@K@) = [ &\n    @W@]\n",
        separator: ", &\n    ",
        helpers: "contains\n\n",
        closing: "end module @NAME@\n",
    },
    header: None,
    scalar: SHAPED,
    tensor: SHAPED,
    integral: include_str!("../templates/integral.f90"),
    norms: Some(Norms {
        average: include_str!("../templates/average.f90"),
        point: "",
        points: "",
        error: include_str!("../templates/error.f90"),
        l1: Norm {
            add: "out = out + weights(k)*sum(difference)",
            root: "out",
        },
        l2: Norm {
            add: "out = out + weights(k)*sum(difference**2)",
            root: "sqrt(out)",
        },
        linf: Norm {
            add: "if (.not. all(difference <= out)) \
                  out = maxval(difference) + 0.0_dp*(out + sum(difference))",
            root: "out",
        },
        without_weights: "",
    }),
    parameters: Parameters {
        definition: "real(dp), protected :: @NAME@ = @VALUE@\n",
        definitions: "@LINES@",
        read: "@NAME@",
        read_of_variant: "@NAME@",
        assign: "@NAME@ = @VALUE@",
        setter: include_str!("../templates/setter.f90"),
        body: "    select case (name)\n@CASES@    case default\n        \
               error stop 'unknown parameter'\n    end select\n",
        case: "    case ('@NAME@')\n",
        indent: "        ",
        close: "",
        global: "",
        getter: "",
        getter_case: "",
        settings: "    do place = 2, command_argument_count()\n        \
                   call get_command_argument(place, text)\n        \
                   cut = index(text, '=')\n        read(text(cut + 1:), *) value\n        \
                   call set_parameter(text(:cut - 1), value)\n    end do\n",
    },
    choice: Choice {
        before: "    select case (variant)\n",
        case: "    case (@ALL@)\n",
        otherwise: "    case default\n",
        close: "",
        after: "    end select\n",
        indent: "    ",
        number: "@K@",
        between: ", ",
        functions: include_str!("../templates/variant.f90"),
        name: "'@NAME@'",
        between_names: ", &\n        ",
        variable: "integer, private :: variant = -1\n",
        ready: "    call require_variant()\n",
        changes: "    if (place == @K@) then\n@CHANGES@    end if\n",
        change: "        @NAME@ = @VALUE@\n",
        advice: "Programs must call choose_variant() before any other procedure. ",
        current: "",
    },
    answer: Some(Answer {
        ending: ".f90",
        template: include_str!("../templates/answer.f90"),
        choose: "    call choose_variant()\n",
        time: "        t = p(@V@)\n",
        time_argument: ", t",
        names: "    case ('@FACE@')\n        write(*, '(*(a))') '@NAMES@'\n",
        separator: "', &\n            '",
        // An array of Fortran is printed column by column.
        matrix: "transpose(@CALL@)",
        between: ", &\n                ",
        branch: "        case ('@FACE@')\n            write(*, '(*(es25.16e3, 1x))') &\n                @CALLS@\n",
    }),
};
