//! The form language of FEniCSx and Firedrake: the statements of Python, for symbols.

use super::super::texts::*;
use super::python::PYTHON;

const SHAPED: Shaped = Shaped {
    function: "def @F@(x@T@):\n@BODY@    return @RESULT@\n\n\n",
    ..PYTHON.tensor
};

pub(super) const UFL: Texts = Texts {
    ending: "_ufl.py",
    build: "import @NAME@_ufl",
    tools: None,
    // Its module is NAME_ufl.
    names: NamingRules {
        taken: &[],
        ..PYTHON.names
    },
    arithmetic: Arithmetic {
        functions: Functions {
            ln: "ufl.ln(@X@)",
            log10: "(ufl.ln(@X@)/2.302585092994046)",
            ..functions!("ufl.")
        },
        choose: "ufl.conditional(ufl.@WORD@(@LEFT@, @RIGHT@), @THEN@, @ELSE@)",
        ..PYTHON.arithmetic
    },
    statements: Statements {
        scalar: "r@I@ = ufl.as_ufl(@VALUE@)",
        component: "r@I@ = ufl.as_ufl(@VALUE@)",
        ..PYTHON.statements
    },
    library: Library {
        opening: "\nimport ufl\n\n",
        ..PYTHON.library
    },
    scalar: SHAPED,
    tensor: SHAPED,
    norms: None,
    answer: None,
    ..PYTHON
};
