//! Listed and proved states of beams drawn by a seed, against the roots that a scan and bisection
//! find. The scan shares no code with the solutions or with the proof.

use super::{loaded, obstacles, states};
use crate::prelude::*;
use thermobeam_exact::equilibrium::{ProvedState, prove};

/// Beams drawn.
const BEAMS: usize = 20;

/// A root and an enclosure may differ by this, relative to one plus its size: the scan has the
/// round-off of `f64`.
const ROUND_OFF: f64 = 1e-9;

/// `1 + N` above the last buckling value of the list: k < (17 - 1/2)π.
const LAST_K: f64 = 16.5 * std::f64::consts::PI;

/// A loaded beam; every third stands free. The last six are pushed below N = -1, and every second
/// of the others beyond buckling.
fn drawn(random: &mut SplitMix, place: usize) -> (Beam, Option<Obstacles>) {
    let mut between = |low: f64, high: f64| random.within([low, high]);
    let beta = match place {
        _ if place >= BEAMS - 6 => between(-5.0, -1.05),
        _ if place.is_multiple_of(2) => between(-0.99, -0.75),
        _ => between(-0.75, 1.0),
    };
    let sign = between(-1.0, 1.0).signum();
    let [rho, moment] = [[-1.0, 1.3], [-2.0, 0.0]].map(|[a, b]| 10.0_f64.powf(between(a, b)));
    let walls = obstacles(
        10.0_f64.powf(between(-3.0, 0.5)),
        between(-0.5, -0.01),
        between(0.01, 0.5),
    );
    let beam = loaded(beta, rho, sign * moment);
    (beam, walls.filter(|_| !place.is_multiple_of(3)))
}

/// The beam at `s = 1 + N` with the stress c: `φ = (aθ_A + cq) ψ` and `u' = q (φ + c)`, with
/// `ψ'' = (1 - q) ψ - 1`, ψ = 0 at the clamped end and ψ' = 0 at the tip.
pub(super) struct Bent {
    pub(super) slope_squared: f64,
    pub(super) u_tip: f64,
    pub(super) stress: f64,
}

/// ∫ψ and ∫ψ², by `ψ = (cos ky/cos k - 1)/k²` with `k² = q - 1`, or `cosh` below.
fn integrals(s: f64) -> [f64; 2] {
    let x = 1.0 / s - 1.0;
    let k = x.abs().sqrt();
    let (tangent, secant) = if x > 0.0 {
        (k.tan() / k, 1.0 / k.cos())
    } else {
        (k.tanh() / k, 1.0 / k.cosh())
    };
    let squares = 0.5 * secant * secant + 0.5 * tangent;
    [
        (tangent - 1.0) / x,
        (squares - 2.0 * tangent + 1.0) / (x * x),
    ]
}

/// * `support`: ε and the position of the obstacle that holds the tip.
pub(super) fn bent(beam: &Beam, support: Option<[f64; 2]>, s: f64) -> Bent {
    let ([mean, square], q, moment) = (integrals(s), 1.0 / s, beam.a * beam.theta_a);
    let stress = support.map_or(0.0, |[epsilon, position]| {
        (position - q * moment * mean) / (epsilon + q + q * q * mean)
    });
    let load = moment + stress * q;
    Bent {
        slope_squared: q
            * q
            * (load * load * square + 2.0 * load * stress * mean + stress * stress),
        u_tip: q * (load * mean + stress),
        stress,
    }
}

/// The values of s at which the sign is looked at, increasing, without s = 0.
fn samples(beta: f64) -> [Vec<f64>; 2] {
    let waves = (1..8000).rev().map(|i| LAST_K * f64::from(i) / 8000.0);
    let powers = (0..3000).map(|i| 10.0_f64.powf(f64::from(i) / 300.0 - 5.0));
    let above = waves
        .map(|k| 1.0 / (1.0 + k * k))
        .chain(powers.map(|power| 1.0 + power));
    let below = (0..4000).map(|i| (1.0 + beta) * 1.5 * 10.0_f64.powf(f64::from(i) / -600.0));
    let below = if beta < -1.0 { below.collect() } else { vec![] };
    [above.collect(), below]
}

/// The largest f between two places, or any above 0, by golden sections.
fn largest(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const SECTION: f64 = 0.381_966_011_250_105_1;
    let mut best = 0.5 * (low + high);
    for _ in 0..200 {
        let [a, b] = [low + SECTION * (high - low), high - SECTION * (high - low)];
        best = if f(a) > f(b) { a } else { b };
        if f(best) > 0.0 {
            break;
        }
        if f(a) > f(b) { high = b } else { low = a }
    }
    best
}

/// All roots of f between samples. Where three samples turn without a change of sign, the extreme
/// value between them is looked for: a pole at which f falls to -∞, or a pair of roots.
fn roots(f: &impl Fn(f64) -> f64, samples: &[f64]) -> Vec<f64> {
    let mut places = samples.to_vec();
    for three in samples.windows(3) {
        let [a, b, c] = [0, 1, 2].map(|i| f(three[i]));
        if b < 0.0 && a < b && c < b {
            places.push(largest(f, three[0], three[2]));
        } else if b > 0.0 && a > b && c > b {
            places.push(largest(|s| -f(s), three[0], three[2]));
        }
    }
    places.sort_by(f64::total_cmp);
    let mut found = vec![];
    for pair in places.windows(2) {
        let [mut a, mut b] = [pair[0], pair[1]];
        if (f(a) > 0.0) == (f(b) > 0.0) {
            continue;
        }
        for _ in 0..200 {
            let middle = 0.5 * (a + b);
            if (f(middle) > 0.0) == (f(a) > 0.0) {
                a = middle;
            } else {
                b = middle;
            }
        }
        found.push(0.5 * (a + b));
    }
    found
}

/// Contact, N and u(1) of every state that the scan finds.
fn scanned(beam: &Beam, obstacles: Option<&Obstacles>) -> Vec<(Phase, f64, f64)> {
    let mut found = vec![];
    let held = obstacles.map(|o| {
        [
            (Phase::Upper, [o.epsilon, o.g2]),
            (Phase::Lower, [o.epsilon, o.g1]),
        ]
    });
    let held = held
        .into_iter()
        .flatten()
        .map(|(contact, support)| (contact, Some(support)));
    for (contact, support) in std::iter::once((Phase::Free, None)).chain(held) {
        let f = |s: f64| s - 1.0 - beam.beta - beam.rho * bent(beam, support, s).slope_squared;
        for s in samples(beam.beta)
            .iter()
            .flat_map(|samples| roots(&f, samples))
        {
            let Bent { u_tip, stress, .. } = bent(beam, support, s);
            let is_state = match contact {
                Phase::Free => obstacles.is_none_or(|o| (o.g1..=o.g2).contains(&u_tip)),
                Phase::Upper => stress < 0.0,
                Phase::Lower => stress > 0.0,
            };
            if is_state {
                found.push((contact, s - 1.0, u_tip));
            }
        }
    }
    found
}

#[test]
fn the_closed_integrals_are_those_of_quadrature() {
    for s in [-3.0, -0.2, 0.013, 0.21, 0.7, 1.4, 30.0] {
        let x: f64 = 1.0 / s - 1.0;
        let k = x.abs().sqrt();
        let cosine = |z: f64| if x > 0.0 { z.cos() } else { z.cosh() };
        let psi = |y: f64| (cosine(k * y) / cosine(k) - 1.0) / x;
        let places = (0..20_000).map(|i| (f64::from(i) + 0.5) / 20_000.0);
        let sums = places.fold([0.0, 0.0], |[one, two], y| {
            [one + psi(y) / 2e4, two + psi(y) * psi(y) / 2e4]
        });
        for (found, sum) in integrals(s).into_iter().zip(sums) {
            assert!((found / sum - 1.0).abs() < 1e-4, "{s}: {found} {sum}");
        }
    }
}

#[test]
fn every_scanned_root_of_drawn_beams_is_listed_and_proved_and_no_other() {
    let mut random = SplitMix::new(20);
    let mut beams: Vec<_> = (0..BEAMS).map(|place| drawn(&mut random, place)).collect();
    beams.extend([
        (loaded(-0.95, 1.0, 0.05), obstacles(1e-3, -0.6, 0.1)),
        (loaded(-0.97, 0.5, -0.02), obstacles(0.1, -2.0, 2.0)),
        (loaded(-1.4, 0.7, 0.4), obstacles(0.05, -0.2, 0.0)),
        (loaded(-5.0, 1.0, 0.34), obstacles(1e-3, -0.01, 0.1)),
    ]);
    let (mut total, mut most) = (0, 0);
    for (place, (beam, obstacles)) in beams.into_iter().enumerate() {
        let list = states(&beam, obstacles.as_ref());
        let proof = prove(&beam, obstacles.as_ref()).unwrap();
        let scanned = scanned(&beam, obstacles.as_ref());
        let what = format!("beam {place}: {beam:?} {obstacles:?}\n{scanned:#?}\n{proof:#?}");
        assert!(proof.undecided.is_empty(), "{what}");
        assert_eq!(proof.states.len(), scanned.len(), "{what}");
        assert_eq!(list.len(), scanned.len(), "{what}\n{list:#?}");
        let mut left: Vec<&ProvedState> = proof.states.iter().collect();
        for (contact, n_value, u_tip) in scanned {
            let is_this = |state: &&ProvedState| {
                let gap = ROUND_OFF * (1.0 + n_value.abs());
                let enclosure = state.n_value;
                assert!(enclosure.width() < gap, "{what}");
                state.contact == contact
                    && enclosure.lo - gap <= n_value
                    && n_value <= enclosure.hi + gap
            };
            let found = left.iter().position(is_this);
            let is_listed = list.iter().any(|state| {
                state.contact == contact
                    && (state.n_value - n_value).abs() < ROUND_OFF * (1.0 + n_value.abs())
            });
            assert!(is_listed, "{contact:?} {n_value}\n{what}\n{list:#?}");
            let state =
                left.swap_remove(found.unwrap_or_else(|| panic!("{contact:?} {n_value}\n{what}")));
            assert!(
                (state.u_tip.midpoint() - u_tip).abs() < 1e-6 * (1.0 + u_tip.abs()),
                "{u_tip}\n{what}"
            );
        }
        total += proof.states.len();
        most = most.max(proof.states.len());
    }
    assert!(
        total > 60 && most > 8,
        "{total} states, at most {most} of a beam"
    );
}
