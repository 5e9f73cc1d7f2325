//! Variants by their closed forms, and those that are left out.

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

fn model(text: &str) -> Model {
    Model::new(Problem::parse(text, "heat.toml").unwrap()).unwrap()
}

/// The variants of a file.
fn of(text: &str) -> Variants {
    let few = Sampling {
        points: 40,
        ..Sampling::default()
    };
    variants(&model(text), &few).unwrap()
}

fn named<'v>(variants: &'v Variants, name: &str) -> &'v Variant {
    let mut usable = variants.usable.iter();
    usable
        .find(|variant| variant.name == name)
        .unwrap_or_else(|| panic!("no {name}: {:?}", variants.left_out))
}

/// The exact value and the source of u.
fn at(variant: &Variant, point: [f64; 2]) -> [f64; 2] {
    [Role::Exact, Role::Source].map(|role| {
        let quantity = variant.model.of_role(role).next().unwrap();
        let rows = variant.model.rows([quantity]).at(&point);
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
    let variants = of(HEAT);
    let names: Vec<String> = variants.usable.iter().map(|v| v.name.clone()).collect();
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

/// X and X'' at x, and T and T' at t, of variants X(x) T(t): the source is X T' - X'' T.
#[test]
fn variants_have_the_values_of_their_closed_forms() {
    let variants = of(HEAT);
    let [x, t] = [0.7_f64, 0.9_f64];
    let of_x = [x.sin(), -x.sin()];
    let of_t = [(-t).exp(), -(-t).exp()];
    // sin(x) without its Taylor polynomial of degree 3 at 0.
    let flat = [x.sin() - x + x.powi(3) / 6.0, x - x.sin()];
    let taylor = 1.0 - t + t * t / 2.0 - t.powi(3) / 6.0;
    let slope = -1.0 + t - t * t / 2.0;
    // At both faces, with the size of the solution.
    let bubble = 4.0 * x * (1.0 - x);
    let weight = bubble.powi(4);
    let rate = 4.0 * bubble.powi(3) * (4.0 - 8.0 * x);
    let curvature = 12.0 * bubble.powi(2) * (4.0 - 8.0 * x).powi(2) - 32.0 * bubble.powi(3);
    let weighed = [
        weight * x.sin(),
        curvature * x.sin() + 2.0 * rate * x.cos() - weight * x.sin(),
    ];
    for (name, [value, second], [factor, rate], tolerance) in [
        ("flat_x_min", flat, of_t, 1e-13),
        ("constant_x", [0.4_f64.sin(), 0.0], of_t, 1e-13),
        ("constant_t", of_x, [(-0.8_f64).exp(), 0.0], 1e-13),
        (
            "flat_initial",
            of_x,
            [of_t[0] - taylor, of_t[1] - slope],
            1e-13,
        ),
        ("flat_x", weighed, of_t, 1e-11),
    ] {
        let [exact, source] = at(named(&variants, name), [x, t]);
        assert!((exact - value * factor).abs() < 1e-13, "{name}: {exact}");
        let expected = value * rate - second * factor;
        assert!((source - expected).abs() < tolerance, "{name}: {source}");
    }
}

#[test]
fn a_flat_variant_vanishes_like_a_fourth_power_where_it_is_flat() {
    let variants = of(HEAT);
    for (name, far, near, orders) in [
        ("flat_x_min", [0.04, 0.3], [0.02, 0.3], 3.7..5.2),
        ("flat_x_max", [0.96, 0.3], [0.98, 0.3], 3.7..5.2),
        ("flat_x", [0.04, 0.3], [0.02, 0.3], 3.7..5.2),
        ("flat_x", [0.96, 0.3], [0.98, 0.3], 3.7..5.2),
        ("flat_everywhere", [0.04, 0.9], [0.02, 0.9], 3.7..5.2),
        ("flat_everywhere", [0.7, 0.04], [0.7, 0.02], 3.9..4.1),
    ] {
        let value = |point| at(named(&variants, name), point)[0];
        assert!(value([0.45, 0.9]).abs() > 1e-5, "{name}");
        let order = (value(far) / value(near)).log2();
        assert!(orders.contains(&order), "{name} at {near:?}: {order}");
    }
}

#[test]
fn the_size_of_a_variant_is_that_of_its_solution() {
    let variants = of(HEAT);
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
    let variants = of(&held);
    let left_out: Vec<String> = variants
        .left_out
        .iter()
        .map(|entry| entry.name.clone())
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
    let variants = of(&held);
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
    let variants = of(&positive);
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
    let variants = of(&text);
    let [x, t] = [0.7_f64, 0.9_f64];
    // -u + 3 u + u, without the advection.
    let u = x.sin() * (-t).exp();
    assert_close(at(named(&variants, "zero_b"), [x, t]), [u, 3.0 * u]);
    let zero = variants
        .usable
        .iter()
        .filter(|variant| matches!(variant.switches_off, Switch::Parameter(_)));
    assert_eq!(zero.count(), 1);
    assert_eq!(model(&text).part(Part::Initial).len(), 1);
    let wrong = text.replace("[\"b\"]", "[\"d\"]");
    let error = Problem::parse(&wrong, "heat.toml").unwrap_err().to_string();
    assert!(error.contains("unknown parameter `d`"), "{error}");
}

/// A field that is linear in time vanishes with its Taylor polynomial: then all that is done to it,
/// and not its initial data alone, would be switched off.
#[test]
fn a_field_that_is_its_own_taylor_polynomial_is_weighed() {
    let linear = HEAT.replace("[equations.u]", "v = \"cos(x)*(2 + t)\"\n[equations.u]");
    let variants = of(&linear);
    let flat = named(&variants, "flat_initial");
    let fields: Vec<_> = flat.model.of_role(Role::Exact).collect();
    assert_eq!(fields.len(), 2);
    let rows = flat.model.rows(fields);
    for t in [0.0, 0.3, 1.9] {
        // The other end of the bubble, 4, lies behind that of the interval.
        let weight = (t * (4.0 - t) / 4.0_f64).powi(4);
        let values = rows.at(&[0.7, t]).tensors;
        let expected = [0.7_f64.sin() * f64::exp(-t), 0.7_f64.cos() * (2.0 + t)];
        assert_close(
            [values[0][0].value, values[1][0].value],
            expected.map(|value| weight * value),
        );
    }
}
