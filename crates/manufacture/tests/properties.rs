//! Expressions drawn at random: values against a direct evaluation, derivatives against dual
//! numbers and jets.

use num_dual::{Dual64, DualNum};
use proptest::prelude::*;

use crate::files::{at, check, found, plane};

/// An expression that is finite everywhere.
#[derive(Debug, Clone)]
enum Sample {
    Number(f64),
    X,
    Y,
    Sum(Box<[Sample; 2]>),
    Difference(Box<[Sample; 2]>),
    Product(Box<[Sample; 2]>),
    /// Divided by 2 plus a square.
    Quotient(Box<[Sample; 2]>),
    Negated(Box<Sample>),
    Sine(Box<Sample>),
    Bounded(Box<Sample>),
    Cube(Box<Sample>),
    /// The root of 1 plus a square.
    Root(Box<Sample>),
    Angle(Box<Sample>),
    Growth(Box<Sample>),
}

impl Sample {
    fn text(&self) -> String {
        match self {
            Sample::Number(value) => format!("{value}"),
            Sample::X => "x".to_owned(),
            Sample::Y => "y".to_owned(),
            Sample::Sum(parts) => format!("({} + {})", parts[0].text(), parts[1].text()),
            Sample::Difference(parts) => format!("({} - {})", parts[0].text(), parts[1].text()),
            Sample::Product(parts) => format!("{}*{}", parts[0].text(), parts[1].text()),
            Sample::Quotient(parts) => {
                format!("{}/(2 + ({})^2)", parts[0].text(), parts[1].text())
            }
            Sample::Negated(part) => format!("(-{})", part.text()),
            Sample::Sine(part) => format!("sin({})", part.text()),
            Sample::Bounded(part) => format!("tanh({})", part.text()),
            Sample::Cube(part) => format!("({})^3", part.text()),
            Sample::Root(part) => format!("sqrt(1 + ({})^2)", part.text()),
            Sample::Angle(part) => format!("atan({})", part.text()),
            Sample::Growth(part) => format!("exp(sin({}))", part.text()),
        }
    }

    fn eval<D: DualNum<Primitive = f64> + Copy>(&self, x: D, y: D) -> D {
        let of = |part: &Sample| part.eval(x, y);
        match self {
            Sample::Number(value) => D::from(*value),
            Sample::X => x,
            Sample::Y => y,
            Sample::Sum(parts) => of(&parts[0]) + of(&parts[1]),
            Sample::Difference(parts) => of(&parts[0]) - of(&parts[1]),
            Sample::Product(parts) => of(&parts[0]) * of(&parts[1]),
            Sample::Quotient(parts) => {
                let below = of(&parts[1]);
                of(&parts[0]) / (below * below + D::from(2.0))
            }
            Sample::Negated(part) => -of(part),
            Sample::Sine(part) => of(part).sin(),
            Sample::Bounded(part) => of(part).tanh(),
            Sample::Cube(part) => of(part).powi(3),
            Sample::Root(part) => (of(part).powi(2) + D::from(1.0)).sqrt(),
            Sample::Angle(part) => of(part).atan(),
            Sample::Growth(part) => of(part).sin().exp(),
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
        let two = || (inner.clone(), inner.clone()).prop_map(|(a, b)| Box::new([a, b]));
        let one = || inner.clone().prop_map(Box::new);
        prop_oneof![
            two().prop_map(Sample::Sum),
            two().prop_map(Sample::Difference),
            two().prop_map(Sample::Product),
            two().prop_map(Sample::Quotient),
            one().prop_map(Sample::Negated),
            one().prop_map(Sample::Sine),
            one().prop_map(Sample::Bounded),
            one().prop_map(Sample::Cube),
            one().prop_map(Sample::Root),
            one().prop_map(Sample::Angle),
            one().prop_map(Sample::Growth),
        ]
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
    fn a_file_with_a_changed_part_is_read_or_refused(start in 0..1200usize, length in 0..30usize, piece in "[-+*/^()\\[\\],<>=\"\n a-z0-9.]{0,12}") {
        let file = crate::files::HEAT;
        let start = start.min(file.len());
        let end = (start + length).min(file.len());
        let changed = format!("{}{piece}{}", &file[..start], &file[end..]);
        if let Err(error) = manufacture::Manufacture::parse(&changed, "changed.toml") {
            prop_assert!(error.to_string().starts_with("changed.toml:"), "{error}");
        }
    }

    #[test]
    fn a_printed_tree_is_the_same_tree(sample in samples()) {
        let tree = manufacture::language::parse(&sample.text()).unwrap();
        let again = manufacture::language::parse(&tree.to_string()).unwrap();
        prop_assert_eq!(tree.to_string(), again.to_string());
    }
}
