//! A scene run again, on another mesh or with other time steps.

use crate::run::driver::Step;
use crate::run::motion::RunError;
use crate::run::simulate;
use crate::scene::Scene;
use convergence_study::text::number::{max_or_nan, min_or_nan};
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::simulation::Simulation;
use thermobeam::solve::Level;

/// The results of the run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Trace<S> {
    /// Smallest and largest u(1) over all time levels including the start; NaN once a level was NaN.
    pub(crate) tip: [f64; 2],
    /// At `t_end k / samples`, k = 1..samples.
    pub(crate) samples: Vec<S>,
}

/// The scene on another mesh, with `steps` steps to a final time.
pub(crate) fn at(scene: &Scene, mesh: Mesh, steps: usize, t_end: f64) -> Scene {
    Scene { t_end, ..scene.at(mesh, t_end / steps as f64) }
}

/// Runs a scene to its end.
///
/// * `samples`: number of equidistant calls of `sample`; it must divide the number of steps.
///
/// # Errors
/// [`RunError`] if the solver refuses the problem, or a step fails.
pub(crate) fn traced<S>(
    scene: &Scene,
    samples: usize,
    mut sample: impl FnMut(&Simulation, &Level) -> S,
) -> Result<Trace<S>, RunError> {
    let mut driver = simulate::driver(scene)?;
    let last = scene.mesh.elements();
    let mut trace = Trace { tip: [driver.level().u[last]; 2], samples: Vec::with_capacity(samples) };
    let stride = scene.steps() / samples;
    for n in 1..=scene.steps() {
        let Step { new, simulation, .. } = driver.stepped()?;
        let tip = new.u[last];
        trace.tip = [min_or_nan(trace.tip[0], tip), max_or_nan(trace.tip[1], tip)];
        if n % stride == 0 {
            trace.samples.push(sample(simulation, new));
        }
    }
    Ok(trace)
}

/// `elements` elements graded like `mesh`: its nodes x_i as a function of i/n, linear in between, at j/m.
///
/// If m divides n, or n divides m, or both are such multiples of a third, the meshes are nested to the last bit.
pub(crate) fn resampled(mesh: &Mesh, elements: usize) -> Result<Mesh, MeshError> {
    if elements == 0 {
        // The error for every mesh without elements.
        return Mesh::uniform(0);
    }
    let (nodes, n) = (mesh.nodes(), mesh.elements());
    let node = |j: usize| {
        // In integers: a rounded j/m would shift nested nodes by a bit.
        let (index, rest) = (j * n / elements, j * n % elements);
        if rest == 0 {
            return nodes[index];
        }
        nodes[index] + (nodes[index + 1] - nodes[index]) * (rest as f64 / elements as f64)
    };
    Mesh::from_nodes((0..=elements).map(node).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resampled_meshes_are_nested_to_the_last_bit() {
        let mesh = Mesh::mapped(12, |s| 0.3 * s + 0.7 * s * s).expect("a mesh");
        assert_eq!(resampled(&mesh, 12).expect("a mesh"), mesh);
        assert!(resampled(&mesh, 0).is_err());
        for (coarse, fine) in [(3, 6), (4, 12), (12, 36), (24, 48), (5, 35)] {
            let [coarse, fine] = [coarse, fine].map(|n| resampled(&mesh, n).expect("a mesh"));
            let ratio = fine.elements() / coarse.elements();
            for (i, x) in coarse.nodes().iter().enumerate() {
                assert_eq!(*x, fine.nodes()[i * ratio]);
            }
        }
    }

    #[test]
    fn a_run_keeps_extremes_and_samples() {
        let text = "[initial]\nu_t = \"x\"\n[mesh]\nelements = 4\n[time]\ndt = 0.1\nt_end = 2.0\n";
        let scene = Scene::parse(text, "s.toml").expect("a scene");
        let trace = traced(&scene, 4, |simulation, level| (simulation.t(), level.u[4])).expect("a run");
        let times: Vec<f64> = trace.samples.iter().map(|sample| sample.0).collect();
        assert_eq!(times, [0.5, 1.0, 1.5, 2.0]);
        assert_eq!(trace.tip[0].min(0.0), trace.tip[0]);
        assert!(trace.samples.iter().all(|sample| (trace.tip[0]..=trace.tip[1]).contains(&sample.1)));
    }
}
