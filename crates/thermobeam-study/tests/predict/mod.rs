//! Laws of error estimates and chosen runs, tested against exact answers, and with contact against
//! much finer runs that share neither mesh nor steps with the tested ones.

mod choice;
mod data;
mod estimate;

use thermobeam::dg::DgStepping;
use thermobeam::mesh::Mesh;
use thermobeam_exact::vibration::Mode;
use thermobeam_study::predict::choice::{Choice, ErrorQuantity};
use thermobeam_study::predict::estimate::{Budget, Estimate};
use thermobeam_study::predict::{self, Cost, MOST_WORK, Unreachable, Work};
use thermobeam_study::run::Sample;
use thermobeam_study::run::simulate::{Recording, Run, Simulator};
use thermobeam_study::scene::{Method, Scene};

/// Runs a search with the usual work limit.
fn limited<T>(find: impl FnOnce(&mut Work<'_>) -> T) -> (T, Cost) {
    let mut progress = |part: f64| assert!((0.0..=1.0).contains(&part));
    let mut work = Work::new(MOST_WORK, &mut progress);
    let found = find(&mut work);
    (found, work.spent())
}

fn choose(scene: &Scene, target: f64) -> Result<Choice, Unreachable> {
    limited(|work| predict::choice::choose(scene, ErrorQuantity::Tip, target, work)).0
}

fn keep(scene: &Scene, quantity: ErrorQuantity, target: f64) -> Choice {
    let (found, _) = limited(|work| predict::choice::keep_scheme(scene, quantity, target, work));
    found.unwrap_or_else(|error| panic!("{target:e}: {error}"))
}

fn estimate(scene: &Scene) -> Result<Budget, Unreachable> {
    limited(|work| predict::estimate::estimate(scene, work)).0
}

/// Times of comparison: most of them lie inside steps.
const TIMES: usize = 3000;

fn scene(beam: &str, time: &str) -> Scene {
    let text = format!(
        "[beam]\n{beam}\n[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n\
         [time]\nscheme = \"dg\"\n{time}\n"
    );
    parsed(&text)
}

fn run(scene: &Scene, times: usize) -> Run {
    Simulator::new(scene)
        .expect("a motion")
        .run(Recording::Curve(times), &mut |_, _| ())
}

fn samples(run: &Run) -> Vec<Sample> {
    run.history
        .iter()
        .flat_map(|history| &history.rows)
        .map(|row| row.sample)
        .collect()
}

/// A reference with ten digits or more, from a discretisation that the search never tries.
fn reference(scene: &Scene) -> Run {
    let mesh = Mesh::from_nodes(vec![0.0, 0.7, 0.9, 0.97, 1.0]).expect("nodes");
    let stepping = DgStepping {
        degree: 5,
        dt: 0.003,
        restart_dt: 1e-4,
        growth: 1.12,
        ..DgStepping::default()
    };
    let fine = Scene {
        mesh,
        degree: 20,
        method: Method::Dg(stepping),
        ..scene.clone()
    };
    run(&fine, TIMES)
}

fn largest_difference(one: &Run, other: &Run) -> f64 {
    let [one, other] = [one, other].map(samples);
    assert_eq!(one.len(), TIMES + 1);
    let pairs = one.iter().zip(&other);
    pairs
        .map(|(a, b)| (a.u_tip - b.u_tip).abs())
        .fold(0.0, |most, difference| {
            assert!(difference.is_finite());
            most.max(difference)
        })
}

fn chosen(scene: &Scene, target: f64) -> Choice {
    choose(scene, target).unwrap_or_else(|error| panic!("{target:e}: {error}"))
}

fn parsed(text: &str) -> Scene {
    Scene::parse(text, "s.toml").unwrap_or_else(|error| panic!("{error}"))
}

/// A reference for the first steps and for contact, on elements that resolve their layers.
fn layered_reference(scene: &Scene) -> Run {
    let mesh = Mesh::from_nodes(vec![0.0, 0.5, 0.8, 0.95, 0.99, 0.998, 1.0]).expect("nodes");
    let stepping = DgStepping {
        degree: 4,
        dt: 0.0035,
        restart_dt: 1e-6,
        growth: 1.18,
        ..DgStepping::default()
    };
    let fine = Scene {
        mesh,
        degree: 16,
        method: Method::Dg(stepping),
        ..scene.clone()
    };
    run(&fine, TIMES)
}

/// The errors of all numbers of a budget, by name.
fn errors(own: &Run, exact: &Run) -> [(&'static str, f64); 8] {
    let [end, true_end] = [own, exact].map(|run| run.last);
    let over_time = |read: fn(&Sample) -> f64| {
        samples(own)
            .iter()
            .zip(&samples(exact))
            .map(|(a, b)| (read(a) - read(b)).abs())
            .fold(0.0, f64::max)
    };
    [
        ("u(1) at the end", (end.u_tip - true_end.u_tip).abs()),
        (
            "largest u(1)",
            (own.extremes.u_tip_max - exact.extremes.u_tip_max).abs(),
        ),
        (
            "smallest u(1)",
            (own.extremes.u_tip_min - exact.extremes.u_tip_min).abs(),
        ),
        ("u(1) over time", over_time(|state| state.u_tip)),
        ("phi(1) at the end", (end.phi_tip - true_end.phi_tip).abs()),
        ("phi(1) over time", over_time(|state| state.phi_tip)),
        ("energy at the end", (end.energy - true_end.energy).abs()),
        ("energy over time", over_time(|state| state.energy)),
    ]
}

fn estimated(budget: &Budget, name: &str) -> f64 {
    budget
        .quantities
        .iter()
        .find(|of| of.name == name)
        .expect("all numbers")
        .total
}

fn named<'b>(budget: &'b Budget, name: &str) -> &'b Estimate {
    budget
        .quantities
        .iter()
        .find(|of| of.name == name)
        .unwrap_or_else(|| panic!("no {name}"))
}

const ZETA: f64 = 0.1;

/// A damped mode of the linear beam as a scene: U and Φ in full, released with U(1) = 1.
fn vibration(index: usize, stepping: &str) -> (Mode, Scene) {
    let mode = Mode::new(index);
    let omega = mode.omega();
    // At x = 0 the formulas of the mode give U' = -2ωA and Φ' = 2ωB.
    let (a, b) = (
        -mode.u_x(0.0) / (2.0 * omega),
        mode.phi_x(0.0) / (2.0 * omega),
    );
    let [plus, minus] = [
        (omega * omega - omega).sqrt(),
        (omega * omega + omega).sqrt(),
    ];
    let text = format!(
        "[beam]\nzeta = {ZETA}\na = 0.0\nrho = 0.0\n[initial]\n\
         u = \"{a:?}*({:?}*sin({plus:?}*x)/{plus:?} - {:?}*sin({minus:?}*x)/{minus:?}) + {b:?}*(cos({plus:?}*x) - cos({minus:?}*x))\"\n\
         phi = \"{a:?}*(cos({plus:?}*x) - cos({minus:?}*x)) + {b:?}*{omega:?}*(sin({plus:?}*x)/{plus:?} + sin({minus:?}*x)/{minus:?})\"\n\
         {stepping}",
        1.0 - omega,
        1.0 + omega
    );
    (mode, parsed(&text))
}

const CONTACT: &str = "[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n[mesh]\nelements = 32\n";
