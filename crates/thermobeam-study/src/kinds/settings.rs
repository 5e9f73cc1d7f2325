//! The settings that an item of a study exercises; by these a diagnosis separates failing from
//! passing items.
//!
//! Each kind of study says in its row what its items exercise: the group of statements, and the
//! method that computes them. What an item is about is data of its [`Subject`].

use convergence_study::study::header::{Setting, study};
use convergence_study::study::{Header, Subject};
use thermobeam::parameters::Beam;
use thermobeam::scheme::{MIDPOINT, Scheme};

use crate::exact::norm::Norm;

/// A viscosity below this is small.
const SMALL_ZETA: f64 = 0.02;

/// Where to look for the cause, by the name of a setting or by the field that changed first.
pub const PLACES: [(&str, &str); 18] = [
    ("one-step schemes", "crates/thermobeam/src/solve"),
    (
        "any order",
        "crates/thermobeam/src/dg; THEORY.md, \"Any order\"",
    ),
    (
        "no time steps",
        "crates/thermobeam-exact/src/equilibrium, vibration",
    ),
    (
        "the fixed point",
        "crates/thermobeam/src/solve/fixed_point.rs; THEORY.md, \"Contraction of the fixed point\"",
    ),
    (
        "Newton's method",
        "crates/thermobeam/src/solve: newton.rs, sweeps.rs",
    ),
    (
        "the midpoint rule",
        "crates/thermobeam/src/scheme, solve/newton.rs",
    ),
    (
        "coupling a > 0",
        "the terms with a; THEORY.md, \"The energy and its exact balance\"",
    ),
    (
        "Kirchhoff's term, rho > 0",
        "crates/thermobeam/src: kirchhoff.rs, solve/bound.rs",
    ),
    (
        "a hot end, theta_A > 0",
        "the lifting: crates/thermobeam/src/simulation.rs, energy/sums.rs",
    ),
    ("obstacles", "crates/thermobeam/src/contact.rs"),
    (
        "a graded mesh",
        "the lengths of elements: crates/thermobeam/src/mesh.rs, norms.rs",
    ),
    (
        "listed nodes",
        "the lengths of elements: crates/thermobeam/src/mesh.rs",
    ),
    (
        "whole scenes",
        "crates/thermobeam-study/src/scene, crates/thermobeam-study/src/run",
    ),
    (
        "manufactured solutions",
        "crates/thermobeam-study/src/error, crates/thermobeam-exact/src",
    ),
    ("the harness", "crates/convergence-judge/src/judge"),
    ("temperature", "the third equation of (3.7)"),
    ("velocity", "the first equation of (3.7)"),
    ("rotation-rate", "the second equation of (3.7)"),
];

/// What a kind of study puts to the test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Group {
    Harness,
    Manufactured,
    Vibrations,
    Energy,
    Steady,
    Scenes,
    Maps,
    Cost,
    Experiments,
}

impl Group {
    /// In words that can stand alone.
    fn name(self) -> &'static str {
        match self {
            Group::Harness => "the harness",
            Group::Manufactured => "manufactured solutions",
            Group::Vibrations => "free vibrations",
            Group::Energy => "the energy's laws",
            Group::Steady => "steady states",
            Group::Scenes => "whole scenes",
            Group::Maps => "maps of the solvers",
            Group::Cost => "cost",
            Group::Experiments => "experiments with contact",
        }
    }

    /// Whether its studies take the beam and the obstacles of the paper, from scenes in other
    /// files.
    fn has_the_papers_beam(self) -> bool {
        matches!(
            self,
            Group::Experiments | Group::Maps | Group::Energy | Group::Steady
        )
    }
}

/// How an item is computed, where that is not the method of its study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ItemMethod {
    /// By a one-step scheme: the study's, or the paper's.
    OneStep,
    /// By the midpoint rule.
    Midpoint,
    /// By the paper's iteration.
    FixedPoint,
    /// By elements of any degree and dG(q).
    AnyOrder,
    /// By a formula, without time steps.
    Exact,
}

impl ItemMethod {
    const ALL: [(&str, ItemMethod); 5] = [
        ("one-step", ItemMethod::OneStep),
        ("midpoint", ItemMethod::Midpoint),
        ("fixed-point", ItemMethod::FixedPoint),
        ("dg", ItemMethod::AnyOrder),
        ("exact", ItemMethod::Exact),
    ];

    /// That of a scheme.
    pub(crate) fn of_scheme(scheme: &Scheme) -> Self {
        if *scheme == MIDPOINT {
            ItemMethod::Midpoint
        } else {
            ItemMethod::OneStep
        }
    }

    fn named(name: &str) -> Option<Self> {
        let row = Self::ALL.iter().find(|(known, _)| *known == name);
        row.map(|(_, method)| *method)
    }
}

impl From<ItemMethod> for String {
    /// Its word in a [`Subject`].
    fn from(method: ItemMethod) -> Self {
        let row = ItemMethod::ALL.iter().find(|(_, known)| *known == method);
        row.map_or("", |(name, _)| name).to_owned()
    }
}

/// Of the harness itself.
pub fn of_harness(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Harness, ItemMethod::OneStep)
}

/// Of errors against a manufactured solution, or a vibration where the file has one, by one-step
/// schemes.
pub(super) fn of_solution(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, solution(header), ItemMethod::OneStep)
}

/// The same by the scheme of any order.
pub(super) fn of_any_order(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, solution(header), ItemMethod::AnyOrder)
}

/// Of planted faults: in studies by one-step schemes, or by the scheme of any order.
pub(super) fn of_controls(header: &Header, subject: &Subject) -> Vec<Setting> {
    if has_table(header, "any-order.") {
        of_any_order(header, subject)
    } else {
        of_solution(header, subject)
    }
}

/// Of vibrations.
pub(super) fn of_vibrations(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Vibrations, ItemMethod::OneStep)
}

/// Of frequencies.
pub(super) fn of_frequencies(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Vibrations, ItemMethod::Exact)
}

/// Of the energy and its balance.
pub(super) fn of_energy(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Energy, ItemMethod::OneStep)
}

/// Of the ends of runs.
pub(super) fn of_ends(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Steady, ItemMethod::OneStep)
}

/// Of steady states themselves.
pub(super) fn of_branches(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Steady, ItemMethod::Exact)
}

/// Of whole scenes.
pub(super) fn of_scenes(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Scenes, ItemMethod::OneStep)
}

/// Of the two solvers.
pub(super) fn of_solvers(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Maps, ItemMethod::OneStep)
}

/// Of work against errors.
pub(super) fn of_cost(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Cost, ItemMethod::OneStep)
}

/// Of experiments with contact by one-step schemes.
pub(super) fn of_experiments(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Experiments, ItemMethod::OneStep)
}

/// The same by the scheme of any order.
pub(super) fn of_exact_experiments(header: &Header, subject: &Subject) -> Vec<Setting> {
    exercised(header, subject, Group::Experiments, ItemMethod::AnyOrder)
}

fn solution(header: &Header) -> Group {
    if has_table(header, "vibration.") {
        Group::Vibrations
    } else {
        Group::Manufactured
    }
}

/// Whether a study file has values in a table.
fn has_table(header: &Header, table: &str) -> bool {
    let mut paths = header.settings.iter().map(|(path, _)| path);
    paths.any(|path| path.starts_with(table))
}

/// The settings of an item.
///
/// * `subject`: what it is about; in a study with named cases, its case has settings of its own.
/// * `method`: that of the study, unless the file or the subject names another.
fn exercised(header: &Header, subject: &Subject, group: Group, method: ItemMethod) -> Vec<Setting> {
    let of = Of {
        header,
        case: case(header, subject),
        group,
    };
    let axis = of
        .text("refine.axis")
        .or(of.text("run.over"))
        .unwrap_or_default();
    let refined = format!(
        "refined in {}",
        if axis == "both" {
            "space and time"
        } else {
            axis
        }
    );
    let mut settings = vec![("kind", group.name())];
    let quantity = subject.quantity.as_str();
    if Norm::ALL.iter().any(|norm| norm.name() == quantity) {
        settings.push(("field", quantity));
    }
    if !axis.is_empty() && matches!(group, Group::Manufactured | Group::Vibrations) {
        settings.push(("axis", &refined));
    }
    if group != Group::Harness {
        let own = subject.method.as_deref().and_then(ItemMethod::named);
        settings.extend(of.method(own, method));
        settings.extend(of.beam());
        settings.push(("mesh", of.mesh()));
    }
    let settings = settings
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value.to_owned()));
    // A study on its own: its kind tells where to look.
    let (key, alone) = study(header);
    std::iter::once((key, format!("{alone} ({})", group.name())))
        .chain(settings)
        .collect()
}

/// The dotted path of the item's case, such as `case[2].`; empty without a case.
fn case(header: &Header, subject: &Subject) -> String {
    let Some(name) = &subject.case else {
        return String::new();
    };
    let is_named =
        |(path, value): &&Setting| path.ends_with("].name") && value.trim_matches('"') == name;
    header
        .settings
        .iter()
        .find(is_named)
        .map_or(String::new(), |(path, _)| {
            path.trim_end_matches("name").to_owned()
        })
}

/// An item of a study.
struct Of<'s> {
    header: &'s Header,
    case: String,
    group: Group,
}

impl Of<'_> {
    fn text(&self, path: &str) -> Option<&str> {
        let value = |path: &str| {
            self.header
                .settings
                .iter()
                .find(|(known, _)| known == path)
                .map(|(_, value)| value)
        };
        value(&(self.case.clone() + path))
            .or_else(|| value(path))
            .map(|value| value.trim_matches('"'))
    }

    fn has(&self, table: &str) -> bool {
        has_table(self.header, &(self.case.clone() + table)) || has_table(self.header, table)
    }

    /// Whether the file names this scheme or solver.
    fn names(&self, word: &str) -> bool {
        let time = [
            "time.scheme",
            "time.solver",
            "refine.scheme",
            "refine.solver",
            "scheme",
            "solver",
        ];
        time.iter().any(|key| self.text(key) == Some(word))
    }

    /// * `own`: the method of the item, if it has one of its own; `of_study`: that of its study.
    fn method(
        &self,
        own: Option<ItemMethod>,
        of_study: ItemMethod,
    ) -> [(&'static str, &'static str); 3] {
        // A method without this choice is named instead.
        let all = |method: &'static str| ["method", "scheme", "solver"].map(|key| (key, method));
        match own.unwrap_or(of_study) {
            ItemMethod::AnyOrder => return all("any order"),
            ItemMethod::Exact => return all("no time steps"),
            _ if self.names("dg") => return all("any order"),
            _ => {}
        }
        let is_midpoint = own == Some(ItemMethod::Midpoint) || self.names("midpoint");
        let is_fixed_point = own == Some(ItemMethod::FixedPoint) || self.names("fixed-point");
        let scheme = if is_midpoint {
            "the midpoint rule"
        } else {
            "the paper's scheme"
        };
        let solver = if is_fixed_point {
            "the fixed point"
        } else {
            "Newton's method"
        };
        [
            ("method", "one-step schemes"),
            ("scheme", scheme),
            ("solver", solver),
        ]
    }

    /// The active terms of the equations; scenes in other files are those of the paper, whose beam
    /// is the default.
    fn beam(&self) -> [(&'static str, &'static str); 5] {
        let free = self.group == Group::Vibrations;
        let default = if free {
            Beam {
                a: 0.0,
                rho: 0.0,
                ..Beam::default()
            }
        } else {
            Beam::default()
        };
        let number = |name: &str, default: f64| {
            self.text(&format!("beam.{name}"))
                .map_or(default, |text| text.parse().unwrap_or(default))
        };
        let on = |is_on: bool, on: &'static str, off: &'static str| if is_on { on } else { off };
        let is_of_the_paper =
            self.group.has_the_papers_beam() || self.text("refine.scene").is_some();
        [
            (
                "coupling",
                on(
                    number("a", default.a) != 0.0,
                    "coupling a > 0",
                    "no coupling",
                ),
            ),
            (
                "rho",
                on(
                    number("rho", default.rho) != 0.0,
                    "Kirchhoff's term, rho > 0",
                    "a linear beam",
                ),
            ),
            (
                "theta_a",
                on(
                    number("theta_a", 0.0) != 0.0,
                    "a hot end, theta_A > 0",
                    "a cold end",
                ),
            ),
            (
                "zeta",
                on(
                    number("zeta", default.zeta) < SMALL_ZETA,
                    "small zeta",
                    "zeta of order 0.1",
                ),
            ),
            (
                "obstacles",
                on(
                    is_of_the_paper || self.has("obstacles."),
                    "obstacles",
                    "a free end",
                ),
            ),
        ]
    }

    fn mesh(&self) -> &'static str {
        let has = |key: &str| {
            ["mesh", "refine", "run", "energy"]
                .iter()
                .any(|table| self.text(&format!("{table}.{key}")).is_some())
        };
        match (has("map"), has("nodes"), has("perturb")) {
            (true, ..) => "a graded mesh",
            (_, true, _) => "listed nodes",
            (.., true) => "a perturbed mesh",
            _ => "a uniform mesh",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ItemMethod, of_branches, of_scenes, of_solution};
    use convergence_study::study::header::Setting;
    use convergence_study::study::{Header, Subject};

    fn header(kind: &str, values: &[(&str, &str)]) -> Header {
        let settings = values
            .iter()
            .map(|(path, value)| ((*path).to_owned(), (*value).to_owned()))
            .collect();
        Header {
            kind: kind.to_owned(),
            settings,
            ..Header::new("a", "b")
        }
    }

    fn values(settings: Vec<Setting>) -> Vec<String> {
        settings.into_iter().map(|(_, value)| value).collect()
    }

    #[test]
    fn the_method_of_an_item_replaces_that_of_its_study() {
        let of = |subject: Subject| values(of_branches(&header("bifurcation", &[]), &subject));
        let state = Subject::of("steady state");
        assert!(of(state.clone()).contains(&"no time steps".to_owned()));
        let run = of(state.by(ItemMethod::OneStep));
        assert!(run.contains(&"one-step schemes".to_owned()), "{run:?}");
        for (_, method) in ItemMethod::ALL {
            assert_eq!(ItemMethod::named(&String::from(method)), Some(method));
        }
    }

    #[test]
    fn a_case_has_its_own_settings_and_a_study_of_orders_those_of_its_file() {
        let whole = header(
            "scenes",
            &[
                ("case[1].name", "\"cold\""),
                ("case[1].beam.a", "0"),
                ("case[1].time.scheme", "\"dg\""),
            ],
        );
        let cold = values(of_scenes(&whole, &Subject::of("u_tip").in_case("cold")));
        assert!(
            ["whole scenes", "any order", "no coupling"]
                .iter()
                .all(|value| cold.iter().any(|own| own == value)),
            "{cold:?}"
        );
        let file = [
            ("beam.a", "0.5"),
            ("refine.axis", "\"time\""),
            ("refine.scheme", "\"midpoint\""),
            ("refine.map", "\"s\""),
        ];
        let found = values(of_solution(
            &header("orders/manufactured", &file),
            &Subject::of("temperature"),
        ));
        for expected in [
            "temperature",
            "refined in time",
            "one-step schemes",
            "the midpoint rule",
            "coupling a > 0",
            "a graded mesh",
            "a free end",
        ] {
            assert!(
                found.iter().any(|value| value == expected),
                "{expected}: {found:?}"
            );
        }
    }
}
