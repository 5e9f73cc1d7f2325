//! What judges calls nothing of what is judged: the sources of `thermobeam-exact`, and of the
//! studies that evaluate exact solutions by a scheme, are read and refused if they use the solver's
//! formulas. THEORY.md, "What both sides of a comparison share".

use std::fs;
use std::path::Path;

use super::{code, crate_folder, files, is_of_name, paths};

/// What `thermobeam-exact` may use of the solver: data types, what a discrete function is, and
/// bisection.
const ALLOWED: [&str; 11] = [
    "bracket::bisect",
    "contact::Phase",
    "dg::DgLevel",
    "dg::Field",
    "dg::InitialFunctions",
    "dg::Load",
    "dg::Space",
    "mesh::Mesh",
    "one_step::InitialValues",
    "parameters::",
    "solve::TimeLevel",
];

/// The frequencies of a mesh judge the matrices of its elements, which they use.
const OF_A_MESH: (&str, [&str; 2]) = ("vibration/discrete.rs", ["dg::MAX_DEGREE", "dg::element"]);

/// The files of the studies that evaluate exact solutions by a scheme, or errors against a
/// reference.
const STUDIES: [&str; 5] = [
    "kinds/orders/manufactured/design.rs",
    "kinds/orders/one_step.rs",
    "run/family.rs",
    "kinds/orders/vibration/modes.rs",
    "error/reference.rs",
];

/// Files of the solver whose methods of `Beam` and `Obstacles` are the formulas that are judged.
const FORMULAS: [&str; 2] = ["kirchhoff.rs", "contact.rs"];

/// The code of a source without comments and tests.
fn code_of(path: &Path) -> String {
    code(&fs::read_to_string(path).unwrap())
}

/// The names of the methods in which the solver has its formulas.
fn methods() -> Vec<String> {
    let source = crate_folder("thermobeam").join("src");
    let code = FORMULAS.map(|file| code_of(&source.join(file))).concat();
    let methods = code.split("pub fn ").skip(1);
    methods
        .filter_map(|method| method.split_once("(&self"))
        .map(|(name, _)| name.to_owned())
        .collect()
}

/// The methods of the solver with its formulas that a code calls.
fn calls(code: &str) -> Vec<String> {
    let mut called = methods();
    called.retain(|name| code.contains(&format!(".{name}(")));
    called
}

/// The formulas of the solver that a code uses: its methods, rows of schemes, norms of P1
/// functions.
fn uses_of_formulas(code: &str) -> Vec<String> {
    let is_field = |name: &str| {
        let mut after = code
            .match_indices(name)
            .map(|(at, _)| &code[at + name.len()..]);
        after.any(|rest| !rest.starts_with(is_of_name) && !rest.starts_with('('))
    };
    let fields = [".inertia", ".contact"].into_iter();
    let names = ["ContactRule", "thermobeam::norms"].into_iter();
    let fields = fields.filter(|name| is_field(name));
    let others = fields.chain(names.filter(|name| code.contains(name)));
    let mut found = calls(code);
    found.extend(others.map(str::to_owned));
    found
}

/// Whether a path is the allowed one, or an item of the allowed module.
fn allows(allowed: &str, path: &str) -> bool {
    path == allowed || allowed.ends_with("::") && path.starts_with(allowed) && !path.ends_with('*')
}

#[test]
fn exact_solutions_use_only_data_types_the_basis_and_bisection_of_the_solver() {
    let (mut used, mut refused) = (vec![], vec![]);
    for path in files(&crate_folder("thermobeam-exact").join("src"), &["rs"]) {
        let code = code_of(&path);
        for of_solver in paths(&code, "thermobeam") {
            let (file, of_a_mesh) = OF_A_MESH;
            if path.ends_with(file) && of_a_mesh.contains(&of_solver.as_str()) {
                continue;
            }
            match ALLOWED.iter().find(|allowed| allows(allowed, &of_solver)) {
                Some(allowed) => used.push(*allowed),
                None => refused.push(format!("{}: thermobeam::{of_solver}", path.display())),
            }
        }
        let calls = calls(&code).into_iter();
        refused.extend(calls.map(|name| format!("{}: .{name}()", path.display())));
    }
    assert!(refused.is_empty(), "{}", refused.join("\n"));
    used.sort_unstable();
    used.dedup();
    assert_eq!(
        used, ALLOWED,
        "each is used; otherwise it need not be allowed"
    );
}

#[test]
fn studies_use_no_formula_of_the_solver_where_they_evaluate_exact_solutions() {
    for file in STUDIES {
        let code = code_of(&crate_folder("thermobeam-study").join("src").join(file));
        assert_eq!(uses_of_formulas(&code), Vec::<String>::new(), "{file}");
    }
}

#[test]
fn a_use_of_the_solver_is_seen() {
    for (code, expected) in [
        (
            "use thermobeam::norms::{TheoremSquares, l2_squared};",
            "norms::TheoremSquares norms::l2_squared",
        ),
        (
            "use thermobeam::dg::{Field,\n    Space};\nuse thermobeam_exact::norm::Norm;",
            "dg::Field dg::Space",
        ),
        (
            "fn f() { thermobeam::kirchhoff::BUCKLING }",
            "kirchhoff::BUCKLING",
        ),
        ("use thermobeam::scheme::*;", "scheme::*"),
        ("use thermobeam as solver;", ""),
    ] {
        assert_eq!(paths(code, "thermobeam").join(" "), expected, "{code}");
    }
    let all = methods();
    for name in [
        "axial_force",
        "kirchhoff_energy",
        "force",
        "potential",
        "discrete_gradient",
        "solve_tip",
    ] {
        assert!(all.iter().any(|known| known == name), "{name} in {all:?}");
    }
    for (code, expected) in [
        ("obstacles.force(tip)", "force"),
        (
            "self.obstacles\n    .discrete_gradient(u, u0)",
            "discrete_gradient",
        ),
        ("scheme.inertia / dt", ".inertia"),
        ("match refine.scheme.contact {", ".contact"),
        ("ContactRule::Implicit => 0.0", "ContactRule"),
        (
            "scheme.inertia() / dt + contact(study, key) + sources.forces(u)",
            "",
        ),
    ] {
        assert_eq!(uses_of_formulas(code).join(" "), expected, "{code}");
    }
}
