//! A manufactured solution: loads from the strong form (1.1) and the two boundary conditions at
//! x = 1.

use std::f64::consts::PI;
use thermobeam::dg::{Dg, DgProblem, DgStepping, Field, InitialFunctions, Load, Space};
use thermobeam::mesh::Mesh;
use thermobeam::motion::Motion;
use thermobeam::parameters::{Beam, Obstacles};

const BEAM: Beam = Beam {
    zeta: 0.1,
    a: 0.5,
    rho: 2.0,
    beta: 0.5,
    theta_a: 0.0,
};
/// The free end presses on the lower obstacle throughout.
const OBSTACLES: Obstacles = Obstacles {
    epsilon: 0.01,
    g1: -0.01,
    g2: 0.1,
};
const K: f64 = 1.3 * PI;
const END: f64 = 0.3;

/// A factor of x with two derivatives, or one of t.
type Jet = [f64; 3];

/// A field and the two factors of its exact solution at the end.
type Exact = (Field, fn(f64) -> Jet, f64);

fn u_x(x: f64) -> Jet {
    let (s, c) = (K * x).sin_cos();
    [0.3 * s, 0.3 * K * c, -0.3 * K * K * s]
}

fn u_t(t: f64) -> Jet {
    let (s, c) = (3.0 * t).sin_cos();
    [c + 0.2 * t, -3.0 * s + 0.2, -9.0 * c]
}

fn phi_x(x: f64) -> Jet {
    let e = 0.4 * (-x).exp();
    [x * e, (1.0 - x) * e, (x - 2.0) * e]
}

fn phi_t(t: f64) -> Jet {
    let (s, c) = (2.0 * t).sin_cos();
    [s + 0.5, 2.0 * c, -4.0 * s]
}

fn theta_x(x: f64) -> Jet {
    let (s, c) = (PI * x).sin_cos();
    [
        (1.0 + x) * s,
        s + (1.0 + x) * PI * c,
        2.0 * PI * c - (1.0 + x) * PI * PI * s,
    ]
}

fn theta_t(t: f64) -> Jet {
    [(-t).exp(), -(-t).exp(), (-t).exp()]
}

/// `N(u)`, with `∫ cos² Kx = ½ + sin 2K/(4K)`.
fn axial_force(t: f64) -> f64 {
    BEAM.beta + BEAM.rho * 0.09 * K * K * (0.5 + (2.0 * K).sin() / (4.0 * K)) * u_t(t)[0].powi(2)
}

fn sources(space: &Space) -> Box<Load> {
    let (space, points) = (space.clone(), Space::gauss(space.degree() + 8));
    Box::new(move |t, load| {
        let Beam { zeta, a, .. } = BEAM;
        let (n, ut, pt, tt) = (axial_force(t), u_t(t), phi_t(t), theta_t(t));
        // y + ζ y_t, the time factor of all elastic terms.
        let (uz, pz) = (ut[0] + zeta * ut[1], pt[0] + zeta * pt[1]);
        space.add_load(
            Field::U,
            &points,
            |x| u_x(x)[0] * ut[2] - u_x(x)[2] * (uz + n * ut[0]) + phi_x(x)[1] * pz,
            load,
        );
        space.add_load(
            Field::Phi,
            &points,
            |x| {
                phi_x(x)[0] * (pt[2] + pz) - phi_x(x)[2] * pz - u_x(x)[1] * uz
                    + a * theta_x(x)[1] * tt[0]
            },
            load,
        );
        space.add_load(
            Field::Theta,
            &points,
            |x| theta_x(x)[0] * tt[1] - theta_x(x)[2] * tt[0] + a * phi_x(x)[1] * pt[1],
            load,
        );
        let tip = space.mesh().elements();
        let stress = u_x(1.0)[1] * (uz + n * ut[0]) - phi_x(1.0)[0] * pz;
        load[tip][0] += stress + OBSTACLES.force(u_x(1.0)[0] * ut[0]);
        load[tip][1] += phi_x(1.0)[1] * pz;
    })
}

fn run(elements: usize, degree: usize, stepping: DgStepping) -> Dg {
    let initial = InitialFunctions {
        u: Box::new(|x| u_x(x)[0] * u_t(0.0)[0]),
        u_t: Box::new(|x| u_x(x)[0] * u_t(0.0)[1]),
        phi: Box::new(|x| phi_x(x)[0] * phi_t(0.0)[0]),
        phi_t: Box::new(|x| phi_x(x)[0] * phi_t(0.0)[1]),
        theta: Box::new(|x| theta_x(x)[0]),
    };
    let mesh = Mesh::mapped(elements, |s| 0.8 * s + 0.2 * s * s).unwrap();
    let problem = DgProblem {
        beam: BEAM,
        obstacles: Some(OBSTACLES),
        mesh,
        degree,
        initial,
    };
    let mut simulation = Dg::with_load(problem, stepping, sources).unwrap();
    simulation.advance(END).unwrap();
    simulation
}

fn fine_steps() -> DgStepping {
    DgStepping {
        degree: 4,
        dt: 0.02,
        restart_dt: 0.02,
        ..DgStepping::default()
    }
}

/// L² errors of u, φ, θ and of u_x, φ_x, θ_x at the end.
fn errors(simulation: &Dg) -> [f64; 6] {
    let mut squares = [0.0; 6];
    let points = Space::gauss(simulation.space().degree() + 6);
    let exact: [Exact; 3] = [
        (Field::U, u_x, u_t(END)[0]),
        (Field::Phi, phi_x, phi_t(END)[0]),
        (Field::Theta, theta_x, theta_t(END)[0]),
    ];
    for x in simulation.space().mesh().nodes().windows(2) {
        for (xi, weight) in &points {
            let half = 0.5 * (x[1] - x[0]);
            let at = x[0] + half * (1.0 + xi);
            for (i, (field, jet, factor)) in exact.iter().enumerate() {
                let (value, slope) =
                    simulation
                        .level()
                        .value_and_slope(simulation.space(), *field, at);
                squares[i] += half * weight * (value - jet(at)[0] * factor).powi(2);
                squares[3 + i] += half * weight * (slope - jet(at)[1] * factor).powi(2);
            }
        }
    }
    squares.map(f64::sqrt)
}

#[test]
fn the_order_in_space_is_p_for_slopes_and_p_plus_one_for_values() {
    for (p, elements) in [(1, 32), (2, 16), (3, 12), (4, 10)] {
        let [coarse, fine] =
            [elements, 2 * elements].map(|elements| errors(&run(elements, p, fine_steps())));
        for i in 0..6 {
            let (rate, order) = (
                (coarse[i] / fine[i]).log2(),
                if i < 3 { p + 1 } else { p } as f64,
            );
            // φ is smoother than u and θ, whose errors cause slowly vanishing terms of higher order
            // in φ.
            let above = if i % 3 == 1 { 0.8 } else { 0.05 };
            let within = rate >= order - 0.05 && rate <= order + above;
            assert!(
                within,
                "p = {p}, error {i}: {:e} {:e}, rate {rate}",
                coarse[i], fine[i]
            );
        }
    }
}

#[test]
fn the_error_of_a_smooth_solution_falls_exponentially_with_the_degree() {
    let found: Vec<_> = [2, 4, 6, 8, 10, 12, 14]
        .map(|p| errors(&run(1, p, fine_steps()))[0])
        .to_vec();
    assert!(
        found
            .windows(2)
            .take(5)
            .all(|pair| pair[1] < 0.06 * pair[0]),
        "{found:?}"
    );
    assert!(found[6] < 5e-12, "{found:?}");
}

#[test]
fn the_work_of_the_loads_belongs_to_the_balance() {
    let mut simulation = run(2, 6, fine_steps());
    let scale = simulation.energy(simulation.level()).total();
    while simulation.step(1.5 * END).unwrap().is_some() {
        let balance = simulation.balance();
        assert!(balance.load.abs() > 1e-4 * scale);
        assert!(balance.residual.abs() < 1e-13 * scale, "{balance:?}");
    }
}
