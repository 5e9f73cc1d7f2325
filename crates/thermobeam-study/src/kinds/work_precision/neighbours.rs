//! The runs next to a listed one, which show that it is the cheapest of its method.
//!
//! Elements and steps change by an eighth: fewer elements, fewer steps, or fewer of one and more of
//! the other. For dG a degree falls by one, the step grows by an eighth, or one of the three is
//! traded for another. The grading of a mesh, and the nodes of dG, are those of the list.

use convergence_judge::text::number::significant;
use thermobeam::dg::{MAX_DEGREE, MAX_TIME_DEGREE};

use super::method::{Degrees, Resolution, Trial, UniformGrid};

impl Trial {
    /// The neighbours, for grids those of less element-steps alone.
    ///
    /// * `observations`: steps are a multiple of it.
    pub(super) fn neighbours(&self, observations: usize) -> Vec<Trial> {
        let resolutions: Vec<Resolution> = match &self.resolution {
            Resolution::OneStep(scheme, grid) => grids(*grid, observations)
                .into_iter()
                .map(|grid| Resolution::OneStep(*scheme, grid))
                .collect(),
            Resolution::Dg { mesh, degrees } => degrees_near(*degrees)
                .into_iter()
                .map(|degrees| Resolution::Dg {
                    mesh: mesh.clone(),
                    degrees,
                })
                .collect(),
        };
        let method = self.method;
        resolutions
            .into_iter()
            .map(|resolution| Trial { method, resolution })
            .collect()
    }
}

fn grids(grid: UniformGrid, observations: usize) -> Vec<UniformGrid> {
    let intervals = grid.steps / observations;
    let eighth = |count: usize| count.div_ceil(8);
    let [fewer, more] = [
        grid.elements - eighth(grid.elements),
        grid.elements + eighth(grid.elements),
    ];
    let [shorter, longer] = [intervals - eighth(intervals), intervals + eighth(intervals)];
    [
        (fewer, intervals),
        (grid.elements, shorter),
        (fewer, longer),
        (more, shorter),
    ]
    .into_iter()
    .filter(|(elements, intervals)| *elements > 0 && *intervals > 0)
    .map(|(elements, intervals)| UniformGrid {
        elements,
        steps: intervals * observations,
        ..grid
    })
    .filter(|near| near.elements * near.steps < grid.elements * grid.steps)
    .collect()
}

fn degrees(p: usize, q: usize, dt: f64) -> Degrees {
    // As it is written in a list of runs.
    let dt = significant(dt, 3);
    Degrees { p, q, dt }
}

fn degrees_near(Degrees { p, q, dt }: Degrees) -> Vec<Degrees> {
    let mut near = vec![degrees(p, q, 1.125 * dt)];
    if p < MAX_DEGREE {
        near.push(degrees(p + 1, q, 1.25 * dt));
    }
    if q < MAX_TIME_DEGREE {
        near.push(degrees(p, q + 1, 1.5 * dt));
    }
    if p > 1 {
        near.extend([degrees(p - 1, q, dt), degrees(p - 1, q, dt / 1.25)]);
    }
    if q > 0 {
        near.extend([degrees(p, q - 1, dt), degrees(p, q - 1, dt / 1.5)]);
    }
    near
}
