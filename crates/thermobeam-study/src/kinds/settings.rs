//! The settings that an item of a study exercises; by these a diagnosis separates failing from passing items.

use convergence_study::study::Header;
use convergence_study::study::header::{Setting, field, study};
use thermobeam::parameters::Beam;

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

/// The settings of an item, found by a rate's norm, a check's claim, or a guarded number's name.
///
/// In a study with named cases: the settings of the case whose name the item's name begins with.
pub fn settings(header: &Header, item: &str) -> Vec<Setting> {
    let of = Of {
        header,
        item,
        case: case(header, item),
    };
    let field = field(item);
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
    let mut settings = vec![("kind", of.kind())];
    if Norm::ALL.iter().any(|norm| norm.name() == field) {
        settings.push(("field", &field));
    }
    if !axis.is_empty() && (of.kind() == "manufactured solutions" || of.kind() == "free vibrations")
    {
        settings.push(("axis", &refined));
    }
    if of.kind() != "the harness" {
        settings.extend(of.method());
        settings.extend(of.beam());
        settings.push(("mesh", of.mesh()));
    }
    let settings = settings
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value.to_owned()));
    // A study on its own: its kind tells where to look.
    let (key, alone) = study(header);
    std::iter::once((key, format!("{alone} ({})", of.kind())))
        .chain(settings)
        .collect()
}

/// The dotted path of the item's case, such as `case[2].`; empty without a case.
fn case(header: &Header, item: &str) -> String {
    let name = item
        .trim_start_matches("error ")
        .trim_start_matches("rate ")
        .split_once(": ")
        .map_or("", |(name, _)| name);
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
    item: &'s str,
    case: String,
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
        let path = self.case.clone() + table;
        self.header
            .settings
            .iter()
            .any(|(known, _)| known.starts_with(&path) || known.starts_with(table))
    }

    /// Whether the item or the file mentions a word.
    fn speaks_of(&self, word: &str) -> bool {
        let time = [
            "time.scheme",
            "time.solver",
            "refine.scheme",
            "refine.solver",
            "scheme",
            "solver",
        ];
        self.item.contains(word) || time.iter().any(|key| self.text(key) == Some(word))
    }

    fn kind(&self) -> &str {
        match self.header.kind.as_str() {
            "calibration" | "program" => "the harness",
            "convergence" | "any-order" | "controls" if !self.has("vibration.") => {
                "manufactured solutions"
            }
            "vibration" | "frequencies" | "convergence" | "any-order" | "controls" => {
                "free vibrations"
            }
            "energy" => "the energy's laws",
            "equilibrium" | "bifurcation" => "steady states",
            "scenes" => "whole scenes",
            "solvers" => "maps of the solvers",
            "work-precision" => "cost",
            _ => "experiments with contact",
        }
    }

    fn method(&self) -> [(&'static str, &'static str); 3] {
        // A method without this choice is named instead.
        let all = |method: &'static str| ["method", "scheme", "solver"].map(|key| (key, method));
        let kind = self.header.kind.as_str();
        let any_order =
            matches!(kind, "any-order" | "exact-experiments") || self.has("any-order.studies");
        if any_order
            || self.item.contains("any-order")
            || self.speaks_of("dg")
            || self.item.contains("any order")
        {
            return all("any order");
        }
        let is_steady =
            kind == "frequencies" || (kind == "bifurcation" && !self.item.contains("rest"));
        if is_steady || self.item.contains("exact") {
            return all("no time steps");
        }
        let scheme = if self.speaks_of("midpoint") {
            "the midpoint rule"
        } else {
            "the paper's scheme"
        };
        let solver = if self.speaks_of("fixed-point") || self.item.contains("contraction") {
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

    /// The active terms of the equations; scenes in other files are those of the paper, whose beam is the default.
    fn beam(&self) -> [(&'static str, &'static str); 5] {
        let free = self.kind() == "free vibrations";
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
        let meets = [
            "experiments with contact",
            "maps of the solvers",
            "the energy's laws",
            "steady states",
        ];
        let paper = meets.contains(&self.kind())
            || self.item.contains("paper-")
            || self.text("refine.scene").is_some();
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
                on(paper || self.has("obstacles."), "obstacles", "a free end"),
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
    use super::settings;
    use convergence_study::study::Header;

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
        let values = |header: &Header, item: &str| -> Vec<String> {
            settings(header, item)
                .into_iter()
                .map(|(_, value)| value)
                .collect()
        };
        let cold = values(&whole, "cold: u_tip");
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
        let found = values(&header("convergence", &file), "temperature");
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
