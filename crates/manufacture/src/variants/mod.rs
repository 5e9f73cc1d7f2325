//! Variants of a solution: each switches off what one part of a program can get wrong. If the order
//! of a program comes back, that part is where it was lost.
//!
//! | variant | switches off |
//! | --- | --- |
//! | constant in a coordinate, in time | what acts along it |
//! | flat at faces, at the first time | the data there: the solution vanishes there with its derivatives up to one more than the largest order claimed |
//! | a parameter zero | its term |
//! | a field constant | what acts on it |

mod described;
mod design;
mod switch;

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use crate::check::Check;
use crate::derive::{Part, Role};
use crate::emit::{self, Alternative, EmittedFile, Language};
use crate::model::{Model, Rows};
use crate::problem::{InputError, Problem, Variation};
use crate::sample::Sampler;
use crate::{Finding, Sampling, check};

pub use described::{DescribedVariant, Description};
use design::{Design, MIDDLE, Side, designs, sides};
pub use switch::Switch;

/// A variant that is right by the check of the file.
#[derive(Debug)]
pub struct Variant {
    /// What it switches off.
    pub switch: Switch,
    /// The size of its solution.
    pub size: f64,
    model: Model,
}

/// A variant that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// What it would switch off.
    #[serde(flatten)]
    pub switch: Switch,
    /// Why not.
    pub why: String,
}

/// The variants of a file.
#[derive(Debug)]
pub struct Variants<'m> {
    base: &'m Model,
    /// The size of the solution of the file: the root mean square of its fields over the domain.
    pub size: f64,
    /// Those that can be used.
    pub usable: Vec<Variant>,
    /// The others.
    pub left_out: Vec<LeftOut>,
}

impl Variants<'_> {
    /// All parts of the file: those of variants that can be used, and of those that cannot.
    pub fn switches(&self) -> impl Iterator<Item = &Switch> {
        let usable = self.usable.iter().map(|variant| &variant.switch);
        usable.chain(self.left_out.iter().map(|entry| &entry.switch))
    }

    /// The data of a side, by their names in the file: `flux`.
    pub fn data_at(&self, side: &str) -> Vec<&str> {
        design::data_at(&self.base.problem, side)
    }

    /// The files of a language, whose functions are those of the variant that the environment
    /// variable `MANUFACTURE_VARIANT` names; it is read once, and without it they are those of the
    /// file. In Fortran a program calls `choose_variant` first. In Python the module says what each
    /// variant switches off, too.
    pub fn emit(&self, language: Language) -> Vec<EmittedFile> {
        let mut files = emit::emit(self.base, &self.alternatives(), language);
        if language == Language::Python {
            files[0].text += &self.description().literal();
        }
        files
    }

    /// Builds and runs the files of a language in a folder, which is for temporary files, and
    /// compares the values of the file's solution and of each variant.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn check_emitted(
        &self,
        language: Language,
        folder: &Path,
        sampling: &Sampling,
    ) -> Result<Vec<Finding>, InputError> {
        let alternatives = self.alternatives();
        check::emitted::emitted(self.base, &alternatives, language, folder, sampling)
    }

    /// Builds and runs the files of a language that are in a folder already, and compares their
    /// values.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn check_built(
        &self,
        language: Language,
        folder: &Path,
        sampling: &Sampling,
    ) -> Result<Vec<Finding>, InputError> {
        let alternatives = self.alternatives();
        check::emitted::run(self.base, &alternatives, language, folder, sampling)
    }

    fn alternatives(&self) -> Vec<Alternative<'_>> {
        let usable = self.usable.iter();
        usable
            .map(|variant| Alternative {
                name: variant.switch.variant(),
                model: &variant.model,
            })
            .collect()
    }
}

/// All variants of a model, checked.
pub(crate) fn variants<'m>(
    base: &'m Model,
    sampling: &Sampling,
) -> Result<Variants<'m>, InputError> {
    let mut variants = Variants {
        base,
        size: size(base, sampling)?,
        usable: vec![],
        left_out: vec![],
    };
    // What is wrong with the file is no reason against a variant.
    for part in Part::all(&base.problem) {
        Sampler::new(base, sampling.seed).points(part, 1)?;
    }
    let problem = &base.problem;
    if let Some(level) = design::on_a_level(problem) {
        // Nothing is flat there, so no variant is flat at all faces.
        variants.left_out.push(LeftOut {
            switch: Switch::AllFaces,
            why: format!("the face {level} lies on a level"),
        });
    }
    let is_left_out = |switch: &Switch| variants.left_out.iter().any(|one| one.switch == *switch);
    let designs = designs(problem).into_iter();
    let designs: Vec<Design> = designs
        .filter(|design| !is_left_out(&design.switch))
        .collect();
    for design in designs {
        match usable(base, &design, sampling) {
            Ok(variant) => variants.usable.push(variant),
            Err(why) => variants.left_out.push(LeftOut {
                switch: design.switch,
                why,
            }),
        }
    }
    Ok(variants)
}

/// The root mean square of all fields over points of the domain.
fn size(model: &Model, sampling: &Sampling) -> Result<f64, InputError> {
    let points = Sampler::new(model, sampling.seed).points(Part::Interior, sampling.points)?;
    let fields: Vec<_> = model.of_role(Role::Exact).collect();
    let rows = Rows::new(&model.graph, fields.iter().map(|field| &field.tensor));
    let square = |point: &Vec<f64>| -> f64 {
        let values = rows.at(point).tensors.into_iter().flatten();
        values.map(|part| part.value.powi(2)).sum()
    };
    let mean = points.iter().map(square).sum::<f64>() / points.len() as f64;
    Ok(mean.sqrt())
}

/// The values of a field at a point.
struct Values {
    field: String,
    values: Vec<f64>,
}

/// Near the middle of the domain, but with this value of a variable.
fn values(base: &Model, held: Option<(usize, f64)>) -> Vec<Values> {
    let intervals = base.problem.intervals.iter();
    let mut point: Vec<f64> = intervals
        .map(|[low, high]| low + MIDDLE * (high - low))
        .collect();
    if let Some((variable, at)) = held {
        point[variable] = at;
    }
    base.of_role(Role::Exact)
        .map(|quantity| {
            let rows = Rows::new(&base.graph, std::iter::once(&quantity.tensor)).at(&point);
            Values {
                field: quantity.name.clone(),
                values: rows.tensors[0].iter().map(|part| part.value).collect(),
            }
        })
        .collect()
}

/// What may be added to flat fields, which are near zero somewhere: nothing; where this is not
/// allowed the value at a side, which the file may prescribe; a multiple of the value in the
/// middle.
fn lifts(base: &Model, design: &Design) -> Vec<BTreeMap<String, Vec<f64>>> {
    let scaled = |values: Vec<Values>, scale: f64| {
        let values = values.into_iter().map(|Values { field, values }| {
            (field, values.iter().map(|value| scale * value).collect())
        });
        values.collect::<BTreeMap<String, Vec<f64>>>()
    };
    let mut lifts = vec![BTreeMap::new()];
    if design.is_flat() {
        for Side { coordinate, at, .. } in sides(&base.problem) {
            lifts.push(scaled(values(base, Some((coordinate, at))), 1.0));
        }
        for scale in [1.0, 3.0] {
            lifts.push(scaled(values(base, None), scale));
        }
    }
    lifts
}

/// The variant, or in words why it cannot be used.
fn usable(base: &Model, design: &Design, sampling: &Sampling) -> Result<Variant, String> {
    let Sampling { seed, points, .. } = *sampling;
    let mut why = String::new();
    for lift in lifts(base, design) {
        let model = match Model::new(problem(&base.problem, design, lift)) {
            Ok(model) => model,
            Err(error) => return Err(error.to_string()),
        };
        // A pole is refused as bad input; here it is a reason.
        let findings = match check::check(&model, seed, points, false) {
            Ok(Check { findings, .. }) => findings,
            Err(error) => {
                if why.is_empty() {
                    why = error.problem;
                }
                continue;
            }
        };
        let failures: Vec<&Finding> = findings.iter().filter(|finding| finding.fails).collect();
        let Some(first) = failures.first() else {
            return Ok(Variant {
                switch: design.switch.clone(),
                size: size(&model, sampling).map_err(|error| error.to_string())?,
                model,
            });
        };
        if why.is_empty() {
            why = format!("{}: {}: {}", first.key, first.code, first.text);
        }
        let mends = ["not-positive", "singular", "condition-violated"];
        if !failures.iter().any(|failure| mends.contains(&failure.code)) {
            break;
        }
    }
    Err(why)
}

/// The problem of a variant.
fn problem(base: &Problem, design: &Design, lifts: BTreeMap<String, Vec<f64>>) -> Problem {
    let mut problem = base.clone();
    if let Switch::Parameter(name) = &design.switch {
        design::set_to_zero(&mut problem, name);
        return problem;
    }
    problem.variation = Some(Variation {
        lifts,
        ..design.variation.clone()
    });
    problem
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) const HEAT: &str = r#"
[manufacture]
name = "heat"
coordinates = ["x"]
time = "t"
[domain]
x = [0, 1]
t = [0, 2]
[exact]
u = "sin(x)*exp(-t)"
[equations.u]
storage = "dt(u)"
diffusion = "-d(u, x, x)"
[boundary.x_min]
u = "u"
[boundary.x_max]
flux = "d(u, x)"
[initial]
u = "u"
"#;

    fn few() -> Sampling {
        Sampling {
            points: 40,
            ..Sampling::default()
        }
    }

    fn model(text: &str) -> Model {
        Model::new(Problem::parse(text, "heat.toml").unwrap()).unwrap()
    }

    fn named<'v>(variants: &'v Variants<'_>, name: &str) -> &'v Variant {
        let mut usable = variants.usable.iter();
        usable
            .find(|variant| variant.switch.variant() == name)
            .unwrap_or_else(|| panic!("no {name}: {:?}", variants.left_out))
    }

    /// The exact value and the source of u.
    fn at(variant: &Variant, point: [f64; 2]) -> [f64; 2] {
        [Role::Exact, Role::Source].map(|role| {
            let quantity = variant.model.of_role(role).next().unwrap();
            let tensors = std::iter::once(&quantity.tensor);
            let rows = Rows::new(&variant.model.graph, tensors).at(&point);
            rows.tensors[0][0].value
        })
    }

    fn assert_close(found: [f64; 2], expected: [f64; 2]) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    }

    #[test]
    fn the_variants_of_a_problem_are_those_of_its_coordinates_faces_and_time() {
        let model = model(HEAT);
        let variants = variants(&model, &few()).unwrap();
        let names: Vec<String> = variants.usable.iter().map(|v| v.switch.variant()).collect();
        let expected = [
            "constant_x",
            "constant_t",
            "flat_x_min",
            "flat_x_max",
            "flat_x",
            "flat_initial",
            "flat_everywhere",
        ];
        assert_eq!(names, expected, "{:?}", variants.left_out);
    }

    #[test]
    fn variants_have_the_values_of_their_closed_forms() {
        let model = model(HEAT);
        let variants = variants(&model, &few()).unwrap();
        let [x, t] = [0.7_f64, 0.9_f64];
        // sin(x) without its Taylor polynomial of degree 3 at 0.
        let expected = [
            (x.sin() - x + x.powi(3) / 6.0) * (-t).exp(),
            (-(x.sin() - x + x.powi(3) / 6.0) + x.sin() - x) * (-t).exp(),
        ];
        assert_close(at(named(&variants, "flat_x_min"), [x, t]), expected);
        let held = 0.4_f64.sin();
        let expected = [held * (-t).exp(), -held * (-t).exp()];
        assert_close(at(named(&variants, "constant_x"), [x, t]), expected);
        let held = (-0.8_f64).exp() * x.sin();
        assert_close(at(named(&variants, "constant_t"), [x, t]), [held, held]);
        let taylor = 1.0 - t + t * t / 2.0 - t.powi(3) / 6.0;
        let slope = -1.0 + t - t * t / 2.0;
        let expected = [
            x.sin() * ((-t).exp() - taylor),
            x.sin() * (-(-t).exp() - slope + (-t).exp() - taylor),
        ];
        assert_close(at(named(&variants, "flat_initial"), [x, t]), expected);
    }

    #[test]
    fn a_flat_variant_vanishes_like_a_fourth_power_at_each_of_its_faces() {
        let model = model(HEAT);
        let variants = variants(&model, &few()).unwrap();
        for (name, ends) in [
            ("flat_x_min", vec![0.0]),
            ("flat_x_max", vec![1.0]),
            ("flat_x", vec![0.0, 1.0]),
        ] {
            let variant = named(&variants, name);
            assert!(at(variant, [0.45, 0.3])[0].abs() > 1e-4, "{name}");
            for end in ends {
                let near = |distance: f64| {
                    let x = if end == 0.0 { distance } else { 1.0 - distance };
                    at(variant, [x, 0.3])[0]
                };
                let order = (near(0.04) / near(0.02)).log2();
                assert!((3.7..5.2).contains(&order), "{name} at {end}: {order}");
            }
        }
    }

    #[test]
    fn what_is_flat_at_both_faces_of_a_coordinate_has_the_size_of_the_solution() {
        let model = model(HEAT);
        let variants = variants(&model, &few()).unwrap();
        let x = 0.7_f64;
        let t = 0.9_f64;
        let weight = (4.0 * x * (1.0 - x)).powi(4);
        let slope = 4.0 * (4.0 * x * (1.0 - x)).powi(3) * (4.0 - 8.0 * x);
        let curvature = 12.0 * (4.0 * x * (1.0 - x)).powi(2) * (4.0 - 8.0 * x).powi(2)
            - 32.0 * (4.0 * x * (1.0 - x)).powi(3);
        let second = curvature * x.sin() + 2.0 * slope * x.cos() - weight * x.sin();
        let expected = [
            weight * x.sin() * (-t).exp(),
            (-weight * x.sin() - second) * (-t).exp(),
        ];
        let [value, source] = at(named(&variants, "flat_x"), [x, t]);
        assert!((value - expected[0]).abs() < 1e-13 && (source - expected[1]).abs() < 1e-11);
        // Both together vanish at the first time, too.
        let everywhere = named(&variants, "flat_everywhere");
        let order = (at(everywhere, [x, 0.04])[0] / at(everywhere, [x, 0.02])[0]).log2();
        assert!((3.9..4.1).contains(&order), "{order}");
        let order = (at(everywhere, [0.04, t])[0] / at(everywhere, [0.02, t])[0]).log2();
        assert!((3.7..5.2).contains(&order), "{order}");
    }

    #[test]
    fn the_size_of_a_variant_is_that_of_its_solution() {
        let model = model(HEAT);
        let variants = variants(&model, &few()).unwrap();
        // The mean of sin(x)^2 is 0.27, that of exp(-2t) 0.25.
        assert!((variants.size - 0.26).abs() < 0.06, "{}", variants.size);
        let size = named(&variants, "flat_x_min").size;
        // sin(x) - x + x^3/6 is x^5/120, and less than 0.0081.
        assert!((1e-4..3e-3).contains(&size), "{size}");
    }

    #[test]
    fn a_variant_that_breaks_a_condition_is_left_out_and_says_why() {
        let held = HEAT.replace(
            "u = \"u\"\n[boundary.x_max]",
            "u = { of = \"u\", is = \"0\" }\n[boundary.x_max]",
        );
        assert_ne!(held, HEAT);
        let model = model(&held);
        let variants = variants(&model, &few()).unwrap();
        let left_out: Vec<String> = variants
            .left_out
            .iter()
            .map(|entry| entry.switch.variant())
            .collect();
        // Flat at x_max alone u has another value at x_min.
        assert_eq!(left_out, ["constant_x", "flat_x_max"]);
        assert!(variants.left_out[0].why.contains("condition-violated"));
    }

    #[test]
    fn a_flat_field_keeps_the_value_that_a_face_prescribes() {
        let held = HEAT
            .replace("sin(x)*exp(-t)", "1 + sin(x)*exp(-t)")
            .replacen("u = \"u\"", "u = { of = \"u\", is = \"1\" }", 1);
        let model = model(&held);
        let variants = variants(&model, &few()).unwrap();
        for name in ["flat_x_min", "flat_x", "flat_initial"] {
            let variant = named(&variants, name);
            assert!((at(variant, [0.0, 0.7])[0] - 1.0).abs() < 1e-13, "{name}");
        }
    }

    #[test]
    fn a_field_that_must_be_positive_is_lifted_or_the_variant_is_left_out() {
        let positive = format!(
            "{}\n[require]\npositive = [\"u\"]\n",
            HEAT.replace("sin(x)", "(2 + sin(x))")
        );
        let model = model(&positive);
        let variants = variants(&model, &few()).unwrap();
        let variant = named(&variants, "flat_x_max");
        let lowest = (0..=20)
            .map(|k| at(variant, [f64::from(k) / 20.0, 1.0])[0])
            .fold(f64::INFINITY, f64::min);
        assert!(lowest > 0.0, "{lowest}");
    }

    #[test]
    fn only_the_named_parameters_are_set_to_zero() {
        let text = HEAT
            .replace(
                "[exact]",
                "[parameters]\nb = 2\nc = 3\n[variants]\nparameters = [\"b\"]\n[exact]",
            )
            .replace(
                "storage =",
                "advection = \"b*d(u, x)\"\nreaction = \"c*u\"\nstorage =",
            );
        let model = model(&text);
        let variants = variants(&model, &few()).unwrap();
        let [x, t] = [0.7_f64, 0.9_f64];
        // -u + 3 u + u, without the advection.
        let u = x.sin() * (-t).exp();
        assert_close(at(named(&variants, "zero_b"), [x, t]), [u, 3.0 * u]);
        let zero = variants
            .usable
            .iter()
            .filter(|variant| matches!(variant.switch, Switch::Parameter(_)));
        assert_eq!(zero.count(), 1);
        assert_eq!(model.part(Part::Initial).len(), 1);
        let wrong = text.replace("[\"b\"]", "[\"d\"]");
        let error = Problem::parse(&wrong, "heat.toml").unwrap_err().to_string();
        assert!(error.contains("unknown parameter `d`"), "{error}");
    }
}
