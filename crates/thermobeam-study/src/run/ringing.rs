//! A note on runs in which the free end rings between obstacles: THEORY.md, "A free end that starts
//! beyond an obstacle".

use thermobeam::parameters::Obstacles;
use thermobeam::scheme::MIDPOINT;

use super::tally::Run;
use crate::exact::assembly::{mass, stiffness};
use crate::scene::Scene;

/// Share of the first penetration that the other obstacle must see: a step mirrors all of it, but
/// for what viscosity takes.
const MIRRORED: f64 = 0.5;

/// What to tell a user about the digits of a run that has ended: it is small against its tolerance,
/// or its free end rings.
pub fn note(scene: &Scene, run: &Run) -> Option<String> {
    let small = run.note(scene.method.stopping());
    small.or_else(|| ringing(scene, run))
}

/// By the midpoint rule, a step that does not resolve the contact in which the run starts mirrors
/// the free end at the obstacle.
fn ringing(scene: &Scene, run: &Run) -> Option<String> {
    let obstacles = scene.obstacles?;
    let stepping = scene.one_step().ok()?;
    let Obstacles { g1, g2, .. } = obstacles;
    let start = run.first.u_tip;
    let [low, high] = [run.extremes.u_tip_min, run.extremes.u_tip_max];
    let [depth, mirrored] = if start < g1 {
        [g1 - start, high - g2]
    } else {
        [start - g2, g1 - low]
    };
    let rings = depth > 0.0 && mirrored > MIRRORED * depth;
    if stepping.scheme != MIDPOINT || !rings || resolution(scene, obstacles, stepping.dt) <= 1.0 {
        return None;
    }
    let mut dt = stepping.dt;
    while resolution(scene, obstacles, dt) > 1.0 && dt > f64::MIN_POSITIVE {
        dt *= 0.5;
    }
    Some(format!(
        "the free end starts {depth:.1e} beyond an obstacle that throws it back in less than a step, and the midpoint rule mirrors it \
         from step to step without an end: u(1) is not that of the beam; expected dt = {dt:.0e}, scheme = \"euler-crank-nicolson\" \
         or scheme = \"dg\""
    ))
}

/// σ = dt/(2 ε R): the step resolves the contact for σ <= 1.
///
/// R is the resistance of the free end to a velocity during a step: the force for velocity 1, by
/// the matrix (2/dt) M + (ζ + dt/2) K of the first equation of (3.7) without the other fields.
fn resolution(scene: &Scene, obstacles: Obstacles, dt: f64) -> f64 {
    let mut matrix = mass(&scene.mesh);
    let stiff = stiffness(&scene.mesh);
    let (inertia, stress) = (2.0 / dt, scene.beam.zeta + 0.5 * dt);
    for (entries, other) in [
        (&mut matrix.lower, &stiff.lower),
        (&mut matrix.diagonal, &stiff.diagonal),
        (&mut matrix.upper, &stiff.upper),
    ] {
        for (entry, other) in entries.iter_mut().zip(other) {
            *entry = inertia * *entry + stress * other;
        }
    }
    let n = scene.mesh.elements();
    let mut force = vec![0.0; n + 1];
    force[n] = 1.0;
    let velocity = matrix.solve_between(1, n, &force)[n];
    dt * velocity / (2.0 * obstacles.epsilon)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::simulate::{Recording, Simulator, ran};

    /// The note, and u(1) at the end.
    fn noted(start: f64, epsilon: &str, scheme: &str, dt: &str) -> (Option<String>, f64) {
        let text = format!(
            "[obstacles]\nepsilon = {epsilon}\ng1 = -0.05\ng2 = 0.1\n[initial]\nu = \"{start}*x\"\n[mesh]\nelements = 50\n\
             [time]\ndt = {dt}\nt_end = 0.1\n{scheme}"
        );
        let (scene, run) = ran(&text);
        assert_eq!(run.failure, None);
        (note(&scene, &run), run.last.u_tip)
    }

    const MIDPOINT_RULE: &str = "scheme = \"midpoint\"\n";

    #[test]
    fn a_free_end_that_rings_is_noted_and_its_remedies_are_not() {
        for start in [-0.58, -0.3, 0.4] {
            let (words, wrong) = noted(start, "1e-8", MIDPOINT_RULE, "1e-3");
            let words = words.expect("a note");
            assert!(
                words.contains("mirrors it") && words.contains("dg"),
                "{words}"
            );
            let (none, right) = noted(start, "1e-8", "", "1e-3");
            assert_eq!(none, None, "{start}");
            assert!((wrong - right).abs() > 0.05, "{start}: {wrong} {right}");
        }
    }

    #[test]
    fn a_contact_that_is_resolved_or_soft_or_reached_from_the_gap_is_not_noted() {
        assert_eq!(noted(-0.2, "1e-2", MIDPOINT_RULE, "1e-4").0, None);
        for start in [-0.05, 0.0, 0.09] {
            let (note, _) = noted(start, "1e-8", MIDPOINT_RULE, "1e-3");
            assert_eq!(note, None, "{start}");
        }
    }

    /// With the mass of the last node alone, σ = dt²/(4 m ε).
    #[test]
    fn the_resistance_of_a_short_step_is_that_of_the_end_of_the_mass_matrix() {
        let text = "[obstacles]\nepsilon = 0.5\n[mesh]\nelements = 40\n[time]\ndt = 1e-6\nt_end = 1e-6\n[beam]\nzeta = 0.0\n";
        let scene = Scene::parse(text, "s.toml").expect("a scene");
        let obstacles = scene.obstacles.expect("obstacles");
        // The Schur complement of (h/6) tridiag(1, 4, 1) at its last row, 2.
        let end = 3.0_f64.sqrt() / 6.0 / 40.0;
        let expected = 1e-12 / (4.0 * end * 0.5);
        let ratio = resolution(&scene, obstacles, 1e-6) / expected;
        assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
    }

    #[test]
    fn no_committed_scene_is_noted() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../studies/scenes");
        let mut count = 0;
        for file in std::fs::read_dir(folder).expect("scenes") {
            let path = file.expect("a scene").path();
            let text = std::fs::read_to_string(&path).expect("a scene");
            let Ok(scene) = Scene::parse(&text, "s.toml") else {
                continue;
            };
            let short = Scene {
                t_end: 20.0 * scene.dt(),
                ..scene
            };
            let run = Simulator::new(&short).expect("a simulator");
            let run = run.run(Recording::Summary, &mut |_, _| ());
            assert_eq!(ringing(&short, &run), None, "{}", path.display());
            count += 1;
        }
        assert!(count > 8, "{count}");
    }
}
