//! The settings that an item of a study exercises; by these a diagnosis separates failing from
//! passing items.
//!
//! Each kind of study says in its row what its items exercise, as a `Topic`. What an item is
//! about is data of its [`Subject`].

use convergence_study::{
    Header, Subject,
    internal::study::header::{Setting, study},
};
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
        "the lifting: crates/thermobeam/src/one_step.rs, energy.rs",
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

/// What a kind of study puts to the test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Topic {
    /// In words that can stand alone.
    name: &'static str,
    method: ItemMethod,
    beam: BeamOf,
}

/// The beam of a study, where its file has no coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum BeamOf {
    /// The default one; the file says what is refined, and whether there are obstacles.
    File,
    /// The default one without coupling and Kirchhoff's term; otherwise the same.
    Vibration,
    /// That of the paper, between obstacles, from scenes in other files.
    Paper,
}

impl Topic {
    /// A topic whose studies take the paper's beam and obstacles.
    ///
    /// * `method`: that of items which name no other.
    pub(crate) const fn new(name: &'static str, method: ItemMethod) -> Self {
        Self {
            name,
            method,
            beam: BeamOf::Paper,
        }
    }

    /// The same with the beam of the study's file.
    pub(crate) const fn of_file(self) -> Self {
        Self {
            beam: BeamOf::File,
            ..self
        }
    }

    /// Vibrations of a linear beam.
    pub(crate) const fn vibrations(method: ItemMethod) -> Self {
        Self {
            name: "free vibrations",
            method,
            beam: BeamOf::Vibration,
        }
    }

    /// Errors against a manufactured solution, or a vibration where the file has one.
    pub(crate) fn of_solution(header: &Header, method: ItemMethod) -> Self {
        if has_table(header, "vibration.") {
            Self::vibrations(method)
        } else {
            Self::new("manufactured solutions", method).of_file()
        }
    }

    /// The settings of an item of the study with this header.
    ///
    /// * `subject`: what it is about; in a study with named cases, its case has settings of its
    ///   own, and its method is that of the study unless the file or the subject names another.
    pub(crate) fn settings(self, header: &Header, subject: &Subject) -> Vec<Setting> {
        let item = Item {
            header,
            case: case(header, subject),
        };
        let mut settings = general(header, subject, self.name);
        if self.beam != BeamOf::Paper {
            settings.extend(item.axis());
        }
        let own = subject.method.as_deref().and_then(ItemMethod::named);
        settings.extend(item.method(own, self.method));
        settings.extend(item.beam(self.beam));
        settings.push(setting("mesh", item.mesh()));
        settings
    }
}

/// Of the harness itself.
pub fn of_harness(header: &Header, subject: &Subject) -> Vec<Setting> {
    general(header, subject, "the harness")
}

/// Study, topic and field.
fn general(header: &Header, subject: &Subject, topic: &str) -> Vec<Setting> {
    let mut settings = vec![study(header), setting("kind", topic)];
    let quantity = subject.quantity.as_str();
    if Norm::ALL.iter().any(|norm| norm.name() == quantity) {
        settings.push(setting("field", quantity));
    }
    settings
}

fn setting(key: &str, value: &str) -> Setting {
    (key.to_owned(), value.to_owned())
}

fn either(key: &str, holds: bool, value: &str, otherwise: &str) -> Setting {
    setting(key, if holds { value } else { otherwise })
}

/// Whether a study file has values in a table.
pub(crate) fn has_table(header: &Header, table: &str) -> bool {
    let mut paths = header.settings.iter().map(|(path, _)| path);
    paths.any(|path| path.starts_with(table))
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
struct Item<'s> {
    header: &'s Header,
    case: String,
}

impl Item<'_> {
    /// The value of a key: of the item's case, or of the study.
    fn text(&self, path: &str) -> Option<&str> {
        let value = |path: &str| {
            let setting = self.header.settings.iter().find(|(known, _)| known == path);
            setting.map(|(_, value)| value.trim_matches('"'))
        };
        value(&(self.case.clone() + path)).or_else(|| value(path))
    }

    fn axis(&self) -> Option<Setting> {
        let axis = self.text("refine.axis").or(self.text("run.over"))?;
        let axis = if axis == "both" {
            "space and time"
        } else {
            axis
        };
        Some(setting("axis", &format!("refined in {axis}")))
    }

    fn has(&self, table: &str) -> bool {
        has_table(self.header, &(self.case.clone() + table)) || has_table(self.header, table)
    }

    /// Whether the file names this scheme or solver.
    fn names(&self, word: &str) -> bool {
        let keys = [
            "time.scheme",
            "time.solver",
            "refine.scheme",
            "refine.solver",
            "scheme",
            "solver",
        ];
        keys.iter().any(|key| self.text(key) == Some(word))
    }

    /// Method, scheme and solver; a method without a choice of these is named instead.
    ///
    /// * `own`: the method of the item, if it has one of its own; `of_study`: that of its study.
    fn method(&self, own: Option<ItemMethod>, of_study: ItemMethod) -> [Setting; 3] {
        let whole = match own.unwrap_or(of_study) {
            ItemMethod::Exact => Some("no time steps"),
            ItemMethod::AnyOrder => Some("any order"),
            _ => self.names("dg").then_some("any order"),
        };
        if let Some(method) = whole {
            return ["method", "scheme", "solver"].map(|key| setting(key, method));
        }
        let is_midpoint = own == Some(ItemMethod::Midpoint) || self.names("midpoint");
        let is_fixed_point = own == Some(ItemMethod::FixedPoint) || self.names("fixed-point");
        [
            setting("method", "one-step schemes"),
            either(
                "scheme",
                is_midpoint,
                "the midpoint rule",
                "the paper's scheme",
            ),
            either(
                "solver",
                is_fixed_point,
                "the fixed point",
                "Newton's method",
            ),
        ]
    }

    /// The active terms of the equations.
    fn beam(&self, of: BeamOf) -> [Setting; 5] {
        let Beam { a, rho, zeta, .. } = Beam::default();
        let terms = if of == BeamOf::Vibration { 0.0 } else { 1.0 };
        let number = |name: &str, default: f64| {
            let text = self.text(&format!("beam.{name}"));
            text.and_then(|text| text.parse().ok()).unwrap_or(default)
        };
        let is_coupled = number("a", terms * a) != 0.0;
        let is_nonlinear = number("rho", terms * rho) != 0.0;
        let is_hot = number("theta_a", 0.0) != 0.0;
        let is_small = number("zeta", zeta) < SMALL_ZETA;
        // A scene in another file is one of the paper.
        let has_obstacles =
            of == BeamOf::Paper || self.text("refine.scene").is_some() || self.has("obstacles.");
        [
            either("coupling", is_coupled, "coupling a > 0", "no coupling"),
            either(
                "rho",
                is_nonlinear,
                "Kirchhoff's term, rho > 0",
                "a linear beam",
            ),
            either("theta_a", is_hot, "a hot end, theta_A > 0", "a cold end"),
            either("zeta", is_small, "small zeta", "zeta of order 0.1"),
            either("obstacles", has_obstacles, "obstacles", "a free end"),
        ]
    }

    fn mesh(&self) -> &'static str {
        let tables = ["mesh", "refine", "run", "energy"];
        let has = |key: &str| {
            tables
                .iter()
                .any(|table| self.text(&format!("{table}.{key}")).is_some())
        };
        if has("map") {
            "a graded mesh"
        } else if has("nodes") {
            "listed nodes"
        } else if has("perturb") {
            "a perturbed mesh"
        } else {
            "a uniform mesh"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{ItemMethod, Topic};
    use convergence_study::internal::study::header::Setting;
    use convergence_study::{Header, Subject};

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
        let topic = Topic::new("steady states", ItemMethod::Exact);
        let of = |subject: Subject| values(topic.settings(&header("bifurcation", &[]), &subject));
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
        let subject = Subject::of("u_tip").in_case("cold");
        let scenes = Topic::new("whole scenes", ItemMethod::OneStep).of_file();
        let cold = values(scenes.settings(&whole, &subject));
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
        let header = header("orders/manufactured", &file);
        let topic = Topic::of_solution(&header, ItemMethod::OneStep);
        let found = values(topic.settings(&header, &Subject::of("temperature")));
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
