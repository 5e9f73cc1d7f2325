//! Study files that are refused, with place, value found and values allowed.

use convergence_study::{Document, Header};
use thermobeam_study::kinds::tables::Perturbation;

use super::super::says;
use super::{EXACT, EXPECT, REFINE, STUDY, refine, refuses, spec};

#[test]
fn a_wrong_header_is_named() {
    for (text, pieces) in [
        (
            "",
            "s.toml:1:1: study: missing; expected a table with id, claim and tier",
        ),
        (
            "[study]",
            "1:1: study.id: missing; expected 1 to 100 lowercase letters, digits",
        ),
        (
            "[study]\nid = \"A b\"",
            "2:6: study.id: found the text \"A b\"; expected 1 to 100 lowercase letters",
        ),
        ("[study]\nid = \"\"", "2:6: study.id: found the text \"\""),
        (
            "[study]\nid = 3",
            "2:6: study.id: found 3; expected 1 to 100 lowercase",
        ),
        (
            "[study]\nid = \"a\"",
            "1:1: study.claim: missing; expected one line of text without control characters",
        ),
        (
            "[study]\nid = \"a\"\nclaim = \" \"",
            "3:9: study.claim: found the text \" \"",
        ),
        (
            "[study]\nid = \"a\"\nclaim = \"b\"",
            "study.tier: missing; expected \"quick\", \"full\"",
        ),
        (
            "[study]\nid = \"a\"\nclaim = \"b\"\ntier = \"fast\"",
            "study.tier: found the text \"fast\" … \"quick\", \"full\"",
        ),
        (
            "[study]\nname = \"a\"",
            "2:1: study.name: unknown key `name`; expected id, claim, tier, kind",
        ),
    ] {
        says(
            &Document::parse(text, "s.toml", Header::from_document)
                .expect_err(text)
                .to_string(),
            pieces,
        );
        refuses(&[text], pieces);
    }
}

#[test]
fn a_missing_table_or_an_unknown_one_is_named() {
    refuses(
        &[STUDY, EXACT, EXPECT],
        "s.toml:1:1: refine: missing; expected a table: the meshes and steps",
    );
    refuses(
        &[STUDY, REFINE, EXPECT],
        "1:1: exact: missing; expected a table: the exact solution",
    );
    refuses(
        &[STUDY, EXACT, REFINE],
        "1:1: expect: missing; expected a list of tables: the orders claimed",
    );
    refuses(
        &[STUDY, "[expects]\n"],
        "5:2: expects: unknown key `expects`, did you mean `expect`?",
    );
    refuses(
        &[STUDY, "[beam]\nzeta = -1\n", EXACT, REFINE, EXPECT],
        "6:8: beam.zeta: found -1",
    );
    refuses(
        &[STUDY, "[obstacles]\ng2 = -1\n", EXACT, REFINE, EXPECT],
        "6:6: obstacles.g2: found -1",
    );
}

#[test]
fn an_exact_solution_that_breaks_a_rule_is_named() {
    for (line, pieces) in [
        (
            "",
            "exact: found an empty table; expected a table with at least one of u, phi, theta",
        ),
        (
            "v = []",
            "6:1: exact.v: unknown key `v`; expected u, phi, theta",
        ),
        (
            "u = []",
            "6:5: exact.u: found the list []; expected a list of at least one { x =",
        ),
        (
            "u = \"x\"",
            "exact.u: found the text \"x\"; expected a list",
        ),
        (
            "u = [\"x\"]",
            "exact.u[0]: found the text \"x\"; expected a table",
        ),
        (
            "u = [{ x = \"x\" }]",
            "6:6: exact.u[0].t: missing; expected a function of t in quotes",
        ),
        (
            "u = [{ x = \"x\", t = \"x\" }]",
            "6:22: exact.u[0].t: unknown name `x`; expected one of t pi e",
        ),
        (
            "u = [{ x = \"x\", t = \"1\", s = 1 }]",
            "exact.u[0].s: unknown key `s`; expected x, t",
        ),
        (
            "u = [{ x = \"x\", t = \"1\" }, { x = \"1+x\", t = \"1\" }]",
            "6:34: exact.u[1].x: found 1.0 at x = 0; expected 0",
        ),
        (
            "phi = [{ x = \"cos(x)\", t = \"1\" }]",
            "6:14: exact.phi[0].x: found 1.0 at x = 0",
        ),
        (
            "u = [{ x = \"x^1.5\", t = \"1\" }]",
            "exact.u[0].x: the second derivative is inf at x = 0",
        ),
        (
            "u = [{ x = \"x\", t = \"1/(1-2*t)\" }]",
            "exact.u[0].t: the value is inf at t = 0.5",
        ),
        (
            "theta = [{ x = \"x\", t = \"t\" }]",
            "6:9: exact.theta: found theta =  … at x = 1 … 0 at x = 1 at all times",
        ),
        (
            "theta = [{ x = \"1-x\", t = \"1\" }]",
            "exact.theta: found theta = 1.0 at x = 0, t = 0.0 … theta = 0.0",
        ),
    ] {
        refuses(&[STUDY, "[exact]\n", line, "\n", REFINE, EXPECT], pieces);
    }
    let hot = "[beam]\ntheta_a = 2\n";
    refuses(
        &[STUDY, hot, EXACT, REFINE, EXPECT],
        "exact.theta: found theta = 0.0 at x = 0 … beam.theta_a",
    );
}

#[test]
fn a_refinement_that_breaks_a_rule_is_named() {
    let space = "axis = \"space\"\nelements = [4, 8]\nsteps = 2\n";
    for (lines, pieces) in [
        (
            "",
            "refine.axis: missing; expected \"space\", \"time\", \"both\"",
        ),
        (
            "axis = \"h\"",
            "refine.axis: found the text \"h\"; expected \"space\", \"time\", \"both\"",
        ),
        (
            "axis = \"space\"\nsteps = 2",
            "refine.elements: missing; expected a whole number >= 1",
        ),
        (
            "axis = \"space\"\nelements = 4\nsteps = 2",
            "refine.elements: found 4; expected a list … axis = \"space\"",
        ),
        (
            "axis = \"space\"\nelements = []\nsteps = 2",
            "refine.elements: found the list []; expected a whole number … a list of at least 1",
        ),
        (
            "axis = \"space\"\nelements = [4, 4]\nsteps = 2",
            "refine.elements[1]: found 4; expected a number > 4, the level before",
        ),
        (
            "axis = \"space\"\nelements = [8, 4]\nsteps = 2",
            "refine.elements[1]: found 4; expected a number > 8, the level before",
        ),
        (
            "axis = \"space\"\nelements = [0, 4]\nsteps = 2",
            "refine.elements[0]: found 0; expected a whole number >= 1",
        ),
        (
            "axis = \"space\"\nelements = [4, 1000000000]\nsteps = 2",
            "refine.elements[1]: found 1000000000; expected … <= 8589934",
        ),
        (
            "axis = \"space\"\nelements = [4]\nsteps = [2]",
            "refine.steps: found the list [2]; expected a single whole",
        ),
        (
            "axis = \"space\"\nelements = [4]\nsteps = 0",
            "refine.steps: found 0; expected a whole number >= 1",
        ),
        (
            "axis = \"time\"\nelements = [4]\nsteps = [2]",
            "refine.elements: found the list [4]; expected a single",
        ),
        (
            "axis = \"time\"\nelements = 4\nsteps = [2, 20000000000]",
            "refine.steps[1]: found 20000000000 … <= 10000000000",
        ),
        (
            "axis = \"both\"\nelements = [4]\nsteps = [2, 4]",
            "refine.steps: found 2 numbers of steps for 1 … grid = true",
        ),
        (
            "axis = \"both\"\nisolate = true\nelements = [4]\nsteps = [2]",
            "refine.isolate: found true; expected false",
        ),
    ] {
        refuses(&[STUDY, EXACT, &refine(lines), EXPECT], pieces);
    }
    for (line, pieces) in [
        (
            "grid = true",
            "refine.grid: found true; expected true only where the axis is \"both\"",
        ),
        (
            "isolate = 1",
            "refine.isolate: found 1; expected true or false",
        ),
        (
            "perturb = 1",
            "refine.perturb: found 1; expected a finite number >= 0 and < 1",
        ),
        (
            "seed = 1",
            "refine.seed: found 1 without perturb; expected perturb beside it",
        ),
        (
            "perturb = 0.1\nseed = -1",
            "refine.seed: found -1; expected a whole number >= 0",
        ),
        (
            "map = \"1-s\"",
            "refine.map: its mesh: node 0: expected 0, found 1",
        ),
        (
            "map = \"s+0.9*sin(2*pi*s)\"",
            "refine.map: its mesh: nodes … expected strictly increasing nodes, found ",
        ),
        (
            "scheme = \"leapfrog\"",
            "refine.scheme: found the text \"leapfrog\"; expected \"euler-crank-nicolson\"",
        ),
        (
            "level = 1",
            "refine.level: unknown key `level`; expected axis, isolate, elements, steps, grid, t_end",
        ),
    ] {
        refuses(
            &[STUDY, EXACT, &refine(&format!("{space}{line}")), EXPECT],
            pieces,
        );
    }
    refuses(
        &[STUDY, EXACT, "[refine]\n", space, EXPECT],
        "refine.t_end: missing; expected a finite number > 0",
    );
    let seeded = spec(&[
        STUDY,
        EXACT,
        &refine(&format!("{space}perturb = 0.5")),
        EXPECT,
    ]);
    assert_eq!(
        seeded.refine.layout.perturbation,
        Some(Perturbation {
            amount: 0.5,
            seed: 0
        })
    );
}

#[test]
fn a_control_that_controls_nothing_is_refused() {
    for (control, pieces) in [
        (
            "[control]\n",
            "control: found an empty table; expected a table that changes at least one",
        ),
        (
            "[control]\nzeta = 0.1\n",
            "control.zeta: found 0.1, which is the value of the sources; expected another",
        ),
        (
            "[control]\nepsilon = 0.1\n",
            "control.epsilon: found 0.1 without a table [obstacles]; expected zeta, a,",
        ),
        (
            "[control]\nzeta = -1\n",
            "control.zeta: found -1; expected a finite number >= 0",
        ),
        (
            "[obstacles]\n[control]\nepsilon = -1\n",
            "control.epsilon: found -1; expected a finite number > 0",
        ),
        (
            "[control]\nthetaa = 1\n",
            "control.thetaa: unknown key `thetaa`, did you mean `theta_a`?",
        ),
    ] {
        refuses(&[STUDY, EXACT, REFINE, control, EXPECT], pieces);
    }
}

#[test]
fn an_expectation_that_breaks_a_rule_is_named() {
    for (expect, pieces) in [
        (
            "expect = []\n",
            "1:10: expect: found the list []; expected at least one table [[expect]]",
        ),
        (
            "expect = 1\n",
            "1:10: expect: found 1; expected a list of tables",
        ),
        (
            "expect = [{}]\n",
            "expect[0].norm: missing; expected \"velocity\", \"shear\"",
        ),
        (
            "expect = [{ norm = \"veloctiy\" }]\n",
            "expect[0].norm: found the text \"veloctiy\" (did you mean \"velocity\"?)",
        ),
        (
            "expect = [{ norm = \"shear\" }]\n",
            "expect[0].order: missing; expected a number > 0, or a text such as",
        ),
        (
            "expect = [{ norm = \"shear\", order = 0 }]\n",
            "expect[0].order: found 0; expected a number > 0",
        ),
        (
            "expect = [{ norm = \"shear\", order = 1, tolerance = 0 }]\n",
            "expect[0].tolerance: found 0; expected a finite number > 0",
        ),
        (
            "expect = [{ norm = \"shear\", rate = 1 }]\n",
            "expect[0].rate: unknown key `rate`; expected norm, order",
        ),
    ] {
        refuses(&[expect, STUDY, EXACT, REFINE], pieces);
    }
    refuses(
        &[STUDY, EXACT, REFINE, EXPECT, EXPECT],
        "s.toml:18:8: expect[1].norm: found \"velocity\" a second time; expected each norm once",
    );
}
