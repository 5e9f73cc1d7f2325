//! The loads against sources that `manufacture` derives from the equations of
//! `studies/manufactured/beam.toml`: a second derivation that shares no code with the first.
//! Solutions, coefficients, meshes and times are drawn at random; the tip is in contact in many.

use crate::prelude::*;
use std::cell::{Cell, RefCell};

use manufacture::Manufacture;
use serde_json::Value;

use crate::loads::{beam, compared, filled, nodes, space};

const FILE: &str = include_str!("../../../studies/manufactured/beam.toml");

const CASES: u64 = 100;

/// A function of time.
fn of_time(random: &mut SplitMix) -> String {
    let [a, b, c] = [(); 3].map(|()| random.within([-2.0, 2.0]));
    format!("(cos({a}*t + {b}) + ({c})*t^2*exp(-t))")
}

/// A function of x that is zero at x = 0.
fn of_place(random: &mut SplitMix) -> String {
    let [a, b, c] = [(); 3].map(|()| random.within([-2.0, 2.0]));
    format!("(({a})*sin({b}*x) + x^2*exp({c}*x))")
}

/// A problem, its solution for the solver, and its file.
struct Case {
    beam: Beam,
    obstacles: Obstacles,
    exact: Manufactured,
    mesh: Mesh,
    t: f64,
    manufacture: Manufacture,
}

/// A sum of products X(x) T(t), for the solver and as a text.
fn sum(products: &[[String; 2]]) -> (Vec<Product>, String) {
    let terms = products.iter().map(|[x, t]| product(x, t));
    let texts: Vec<String> = products.iter().map(|[x, t]| format!("{x}*{t}")).collect();
    (terms.collect(), texts.join(" + "))
}

/// The file with the value of a key replaced.
fn with(file: &str, key: &str, value: &str) -> String {
    let start = format!("\n{key} = ");
    let from = file.find(&start).unwrap_or_else(|| panic!("no key {key}")) + start.len();
    let length = file[from..].find('\n').unwrap();
    format!("{}{value}{}", &file[..from], &file[from + length..])
}

impl Case {
    fn random(seed: u64) -> Self {
        let random = &mut SplitMix::new(seed);
        let (beam, obstacles) = beam(random, -2.0);
        let beam = Beam {
            theta_a: random.within([-2.0, 2.0]),
            ..beam
        };
        let [u, phi] = [2, 1].map(|count| {
            let product = |_| [of_place(random), of_time(random)];
            sum(&(0..count).map(product).collect::<Vec<_>>())
        });
        let bump = format!("({}*(1 - x))", of_place(random));
        let ends = ["(1 - x)".to_owned(), format!("({})", beam.theta_a)];
        let theta = sum(&[ends, [bump, of_time(random)]]);
        let mut file = FILE.to_owned();
        for (key, value) in [
            ("zeta", beam.zeta),
            ("a", beam.a),
            ("rho", beam.rho),
            ("beta", beam.beta),
            ("theta_A", beam.theta_a),
            ("eps", obstacles.epsilon),
            ("g1", obstacles.g1),
            ("g2", obstacles.g2),
        ] {
            file = with(&file, key, &format!("{value:?}"));
        }
        for (key, (_, text)) in [("u", &u), ("phi", &phi), ("theta", &theta)] {
            file = with(&file, key, &format!("\"{text}\""));
        }
        let elements = 4 + random.below(4);
        let nodes = nodes(random, elements);
        let manufacture = Manufacture::parse(&file, "beam.toml");
        Self {
            exact: Manufactured {
                u: u.0,
                phi: phi.0,
                theta: theta.0,
            },
            mesh: Mesh::from_nodes(nodes).unwrap(),
            t: random.within([0.0, 2.0]),
            manufacture: manufacture.unwrap_or_else(|error| panic!("{error}\n{file}")),
            beam,
            obstacles,
        }
    }

    /// The values at points of the beam, the last of which is the tip.
    fn values(&self, points: &[f64]) -> Value {
        let mut table = "x,t,face\n".to_owned();
        for x in points {
            table += &format!("{x:?},{:?},\n", self.t);
        }
        table += &format!("1,{:?},x_max\n", self.t);
        self.manufacture.at(&table, "points").unwrap()
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

const SOURCES: [&str; 3] = ["u", "phi", "theta"];

#[test]
fn loads_of_any_order_are_those_of_the_derived_sources() {
    let mut touching = 0;
    for seed in 0..CASES {
        let case = Case::random(seed);
        let degree = 1 + (seed % 4) as usize;
        let space = space(case.mesh.clone(), degree);
        let sources = Sources::any_order(&case.exact, &case.beam, &space);
        let solution = (&case.exact, case.t);
        let (found, forces) = filled(&sources, solution, &case.obstacles, space.blocks());
        touching += u32::from(forces.contact != 0.0);
        let rule = Space::gauss(degree + 14);
        // The points at which the space integrates, in its order.
        let visited = RefCell::new(vec![]);
        let visit = |x: f64| {
            visited.borrow_mut().push(x);
            0.0
        };
        space.add_load(Field::U, &rule, visit, &mut vec![[0.0; 3]; space.blocks()]);
        let points = visited.into_inner();
        let values = case.values(&points);
        let mut expected = vec![[0.0; 3]; space.blocks()];
        for (field, name) in [Field::U, Field::Phi, Field::Theta]
            .into_iter()
            .zip(SOURCES)
        {
            let next = Cell::new(0);
            let at = |x: f64| {
                let place = next.replace(next.get() + 1);
                assert_eq!(points[place], x);
                number(&values["sources"][name][place])
            };
            space.add_load(field, &rule, at, &mut expected);
        }
        let tip = &values["boundary"]["x_max"];
        let row = case.mesh.elements();
        expected[row][0] += number(&tip["load_u"][points.len()]);
        expected[row][1] += number(&tip["load_phi"][points.len()]);
        let count = compared(&found, &expected, &format!("case {seed}"));
        assert_eq!(count, 3 * space.blocks());
    }
    assert!(
        touching > 20,
        "the tip is in contact in {touching} cases only"
    );
}
