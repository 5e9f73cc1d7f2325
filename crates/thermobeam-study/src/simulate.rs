//! placeholder
use crate::expression::Expression;
use crate::scene::Scene;
use thermobeam::simulation::{self, Problem};
///
/// Boundary values are set exactly. The scene has checked that its functions meet them up to their round-off, which for
/// a function such as sin(1000πx) is more than the solver would accept unseen.
pub fn problem(scene: &Scene) -> Problem {
    let nodes = scene.mesh.nodes();
    let at_nodes = |function: &Option<Expression>, start: f64| -> Vec<f64> {
        let value = |&x: &f64| function.as_ref().map_or(0.0, |function| function.eval(x));
        let mut values: Vec<f64> = nodes.iter().map(value).collect();
        values[0] = start;
        values
    };
    let initial = &scene.initial;
    let mut theta = at_nodes(&initial.theta, scene.beam.theta_a);
    theta[nodes.len() - 1] = 0.0;
    Problem {
        beam: scene.beam,
        obstacles: scene.obstacles,
        mesh: scene.mesh.clone(),
        initial: simulation::Initial {
            u: at_nodes(&initial.u, 0.0),
            u_t: at_nodes(&initial.u_t, 0.0),
            phi: at_nodes(&initial.phi, 0.0),
            phi_t: at_nodes(&initial.phi_t, 0.0),
            theta,
        },
    }
}
