//! Expressions drawn at random: values against a direct evaluation, derivatives against dual
//! numbers and jets.

use num_dual::{Dual64, DualNum};
use proptest::prelude::*;

use crate::prelude::*;

/// An expression that is finite everywhere.
#[derive(Debug, Clone)]
enum Sample {
    Number(f64),
    X,
    Y,
    /// An operation on A.
    One(&'static str, Box<Sample>),
    /// An operation on A and B.
    Two(&'static str, Box<[Sample; 2]>),
}

const ONE: [&str; 7] = [
    "(-A)",
    "sin(A)",
    "tanh(A)",
    "(A)^3",
    "sqrt(1 + (A)^2)",
    "atan(A)",
    "exp(sin(A))",
];

const TWO: [&str; 4] = ["(A + B)", "(A - B)", "A*B", "A/(2 + (B)^2)"];

impl Sample {
    fn text(&self) -> String {
        match self {
            Sample::Number(value) => format!("{value}"),
            Sample::X => "x".to_owned(),
            Sample::Y => "y".to_owned(),
            Sample::One(text, part) => text.replace('A', &part.text()),
            Sample::Two(text, parts) => {
                let [a, b] = [parts[0].text(), parts[1].text()];
                text.replace('A', &a).replace('B', &b)
            }
        }
    }

    fn eval<D: DualNum<Primitive = f64> + Copy>(&self, x: D, y: D) -> D {
        match self {
            Sample::Number(value) => D::from(*value),
            Sample::X => x,
            Sample::Y => y,
            Sample::One(text, part) => {
                let a = part.eval(x, y);
                match *text {
                    "(-A)" => -a,
                    "sin(A)" => a.sin(),
                    "tanh(A)" => a.tanh(),
                    "(A)^3" => a.powi(3),
                    "sqrt(1 + (A)^2)" => (a.powi(2) + D::from(1.0)).sqrt(),
                    "atan(A)" => a.atan(),
                    "exp(sin(A))" => a.sin().exp(),
                    _ => unreachable!("{text}"),
                }
            }
            Sample::Two(text, parts) => {
                let [a, b] = [parts[0].eval(x, y), parts[1].eval(x, y)];
                match *text {
                    "(A + B)" => a + b,
                    "(A - B)" => a - b,
                    "A*B" => a * b,
                    "A/(2 + (B)^2)" => a / (b * b + D::from(2.0)),
                    _ => unreachable!("{text}"),
                }
            }
        }
    }
}

fn samples() -> impl Strategy<Value = Sample> {
    let leaf = prop_oneof![
        (1..40i32).prop_map(|number| Sample::Number(f64::from(number) / 8.0)),
        Just(Sample::X),
        Just(Sample::Y),
    ];
    leaf.prop_recursive(4, 24, 2, |inner| {
        let part = inner.clone();
        let one = (0..ONE.len(), part).prop_map(|(k, a)| Sample::One(ONE[k], Box::new(a)));
        let parts = (0..TWO.len(), inner.clone(), inner);
        let two = parts.prop_map(|(k, a, b)| Sample::Two(TWO[k], Box::new([a, b])));
        prop_oneof![7 => one, 4 => two]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn values_and_derivatives_agree_with_dual_numbers(sample in samples(), x in 0.2..1.1, y in 0.3..1.4) {
        let text = plane(&format!("u = \"{}\"", sample.text()), "", "a = \"u\"\nb = \"d(u, x)\"\nc = \"d(u, y)\"");
        let values = at(&text, &format!("x,y\n{x},{y}\n"));
        let by_x = sample.eval(Dual64::new(x, 1.0), Dual64::from(y));
        let by_y = sample.eval(Dual64::from(x), Dual64::new(y, 1.0));
        for (name, expected) in [("a", by_x.re), ("b", by_x.eps), ("c", by_y.eps)] {
            let found = values["sources"][name][0].as_f64().unwrap();
            let size = values["size"]["sources"][name][0].as_f64().unwrap();
            prop_assert!((found - expected).abs() <= 1e-12 * size.max(1e-300), "{} {found} {expected}", sample.text());
        }
    }

    #[test]
    fn derivatives_of_fourth_order_agree_with_jets(sample in samples()) {
        let text = plane(&format!("u = \"{}\"", sample.text()), "", "a = \"laplacian(laplacian(u)) + d(u, x)*d(u, x, y)\"");
        let check = check(&text);
        prop_assert!(found(&check, "second-way").is_empty(), "{:?}", check.findings);
        prop_assert!(found(&check, "singular").is_empty(), "{:?}", check.findings);
    }

    #[test]
    fn any_text_is_an_expression_or_refused(text in "[-+*/^()\\[\\],<>=a-z0-9. ]{0,40}") {
        if let Err(error) = manufacture::language::parse(&text) {
            prop_assert!(error.offset <= text.len());
            prop_assert!(text.is_char_boundary(error.offset));
        }
    }

    #[test]
    fn a_printed_tree_is_the_same_tree(sample in samples()) {
        let tree = manufacture::language::parse(&sample.text()).unwrap();
        let again = manufacture::language::parse(&tree.to_string()).unwrap();
        prop_assert_eq!(tree.to_string(), again.to_string());
    }
}
