//! Scene files: one beam, its initial state, mesh and time steps, for any method.
//!
//! ```toml
//! [beam]                      # all have defaults: (5.1), beta = 0, theta_a = 0
//! beta = 5.0
//!
//! [obstacles]                 # leave the table out: no obstacles; its keys default to (5.1)
//! epsilon = 1e-3
//!
//! [initial]                   # functions of x; left out: 0
//! u = "0.01*x*(x-2)"
//! theta = "sin(pi*x)"         # the physical temperature, theta_a included
//!
//! [mesh]
//! elements = 100              # uniform; or map = "s + 0.1*sin(2*pi*s)" beside it; or nodes = [0.0, ..., 1.0] instead
//!
//! [time]
//! dt = 1e-4
//! t_end = 10.0
//! ```
//!
//! With `scheme = "dg"` elements have degree p, steps are dG(q), and they end where contact begins
//! or ends:
//!
//! ```toml
//! [mesh]
//! elements = 1
//! degree = 12           # p
//!
//! [time]
//! scheme = "dg"
//! degree = 2            # q
//! dt = 0.02             # the largest step; it need not divide t_end
//! restart_dt = 1e-3     # the first step, at the start and after each contact event
//! growth = 1.5          # of the steps in between
//! t_end = 10.0
//! ```

pub(crate) mod file;
pub(crate) mod limits;
mod method;
pub(crate) mod parts;
pub(crate) mod sections;
pub(crate) mod tables;

use std::path::Path;

use thermobeam::dg::{DgProblem, DgStepping, InitialFunctions};
use thermobeam::error::SetupError;
use thermobeam::mesh::{Mesh, MeshError};
use thermobeam::one_step::Stepping;
use thermobeam::parameters::{Beam, Obstacles};

pub use file::SceneFile;
pub use method::{DG, Method};
pub use tables::Coefficients;

use crate::expression::Expression;

use convergence_judge::text::number::{counted, plain_text};
use convergence_study::{Document, InputError, file::Refusal};

/// Initial data (1.2), functions of x; `None` is 0.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Initial {
    /// Displacement.
    pub u: Option<Expression>,
    /// Velocity.
    pub u_t: Option<Expression>,
    /// Rotation.
    pub phi: Option<Expression>,
    /// Rate of rotation.
    pub phi_t: Option<Expression>,
    /// Physical temperature, θ_A at x = 0 and 0 at x = 1.
    pub theta: Option<Expression>,
}

impl Initial {
    /// The functions, in the order of [`thermobeam::dg::Field::ALL`].
    pub(crate) fn fields(&self) -> [&Option<Expression>; 5] {
        [&self.u, &self.phi, &self.u_t, &self.phi_t, &self.theta]
    }
}

/// Everything that a run needs, validated.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The file's name without folder and extension.
    pub name: String,
    /// Coefficients of the equations.
    pub beam: Beam,
    /// The obstacles, if any.
    pub obstacles: Option<Obstacles>,
    /// Initial data, which satisfy the boundary conditions up to round-off and are finite at every
    /// node.
    pub initial: Initial,
    /// The mesh.
    pub mesh: Mesh,
    /// The nodes that the file lists, if it does: the meshes of a search have them too.
    pub listed: Vec<f64>,
    /// Whether a function of the file places them.
    pub is_mapped: bool,
    /// Degree p of the elements: 1 for one-step schemes.
    pub degree: usize,
    /// How it is stepped.
    pub method: Method,
    /// Final time; for a one-step scheme a multiple of dt up to round-off.
    pub t_end: f64,
}

impl Scene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// [`InputError`] with file, line, field, the value found and the values allowed.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        Self::parse(&Document::text_of_file(path)?, &path.display().to_string())
    }

    /// Reads a scene from `text`; messages and the scene's name refer to `file_name`.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn parse(text: &str, file_name: &str) -> Result<Self, InputError> {
        Document::parse(text, file_name, |root| {
            Self::from_document(root, stem(file_name))
        })
    }

    /// Reads a scene from `text`; values of `overlay`, also TOML, replace its own.
    pub(crate) fn parse_overlaid(
        text: &str,
        overlay: &str,
        file_name: &str,
    ) -> Result<Self, InputError> {
        Document::parse_overlaid(text, overlay, file_name, |root| {
            Self::from_document(root, stem(file_name))
        })
    }

    fn from_document(root: &Document<'_>, name: String) -> Result<Self, InputError> {
        Self::new(root.read()?, name).map_err(|refusal| root.locate(refusal))
    }

    /// The scene that a file describes.
    ///
    /// # Errors
    /// Values that do not go together.
    pub(crate) fn new(file: SceneFile, name: String) -> Result<Self, Refusal> {
        let Coefficients { beam, obstacles } =
            Coefficients::new(&file.beam, file.obstacles.as_ref())?;
        let (method, t_end) = file
            .time
            .method(&beam, obstacles.as_ref())
            .map_err(Refusal::within("time"))?;
        let mesh = file
            .mesh
            .mesh(method.default_elements())
            .map_err(Refusal::within("mesh"))?;
        let degree = method
            .degree(&file.mesh, &mesh)
            .map_err(Refusal::within("mesh"))?;
        let initial =
            Initial::new(&file.initial, &beam, &mesh).map_err(Refusal::within("initial"))?;
        let listed = match file.mesh.nodes {
            Some(_) => mesh.nodes().to_vec(),
            None => vec![],
        };
        Ok(Self {
            name,
            beam,
            obstacles,
            initial,
            mesh,
            is_mapped: file.mesh.map.is_some(),
            listed,
            degree,
            method,
            t_end,
        })
    }

    /// Its time step; for dG the largest.
    pub fn dt(&self) -> f64 {
        self.method.dt()
    }

    /// Steps of length dt to the end: all steps of a one-step scheme, the minimum for dG.
    pub fn steps(&self) -> usize {
        let quotient = self.t_end / self.dt();
        let steps = match self.method {
            Method::OneStep(_) => quotient.round(),
            Method::Dg(_) => quotient.ceil(),
        };
        steps.max(1.0) as usize
    }

    /// The scene with the same method on another mesh and with another step.
    pub(crate) fn at(&self, mesh: Mesh, dt: f64) -> Self {
        Self {
            mesh,
            method: self.method.with_dt(dt),
            ..self.clone()
        }
    }

    /// The scene on another mesh, with `steps` steps to a final time.
    pub(crate) fn with_steps(&self, mesh: Mesh, steps: usize, t_end: f64) -> Self {
        Self {
            t_end,
            ..self.at(mesh, t_end / steps as f64)
        }
    }

    /// The one-step scheme, its solver and its step.
    ///
    /// # Errors
    /// [`SetupError::Method`] for a scene by dG.
    pub fn one_step(&self) -> Result<Stepping, SetupError> {
        match self.method {
            Method::OneStep(stepping) => Ok(stepping),
            Method::Dg(_) => Err(SetupError::Method {
                found: DG,
                allowed: "a one-step scheme",
            }),
        }
    }

    /// The steps of dG; for a scene by a one-step scheme the default steps of dG.
    pub fn dg_stepping(&self) -> DgStepping {
        self.method.dg().unwrap_or_else(|| {
            method::default_stepping(&self.beam, self.obstacles.as_ref(), self.t_end)
        })
    }

    /// Mesh, steps, scheme and solver in two lines.
    pub fn discretised(&self) -> String {
        let (elements, t_end) = (counted(self.mesh.elements(), "element"), self.t_end);
        match &self.method {
            Method::OneStep(by) => {
                let (steps, solver) = (counted(self.steps(), "step"), by.settings.solver.name());
                format!(
                    "{elements}, {steps} of dt = {:?} to t = {t_end:?}\n{}, {solver}",
                    by.dt, by.scheme.name
                )
            }
            Method::Dg(by) => {
                let (p, q) = (self.degree, by.degree);
                let steps = format!(
                    "steps from {:.3e} to {}, to t = {t_end:?}",
                    by.restart_dt,
                    plain_text(by.dt)
                );
                format!(
                    "{elements} of degree {p}, dG({q}) in time, {steps}\n{}",
                    self.method.solver()
                )
            }
        }
    }

    /// The scene as a problem for dG.
    pub fn dg_problem(&self) -> DgProblem {
        let Initial {
            u,
            u_t,
            phi,
            phi_t,
            theta,
        } = &self.initial;
        let initial = InitialFunctions {
            u: boxed(u),
            u_t: boxed(u_t),
            phi: boxed(phi),
            phi_t: boxed(phi_t),
            theta: boxed(theta),
        };
        let Self {
            beam,
            obstacles,
            degree,
            ..
        } = *self;
        DgProblem {
            beam,
            obstacles,
            mesh: self.mesh.clone(),
            degree,
            initial,
        }
    }
}

/// A file's name without folder and extension.
pub(crate) fn stem(file_name: &str) -> String {
    Path::new(file_name)
        .file_stem()
        .map_or(file_name.into(), |stem| stem.to_string_lossy())
        .into_owned()
}

/// `elements` elements graded like `mesh`: its nodes x_i as a function of i/n, linear in between,
/// at j/m.
///
/// If m divides n, or n divides m, or both are such multiples of a third, the meshes are nested to
/// the last bit.
pub(crate) fn resampled(mesh: &Mesh, elements: usize) -> Result<Mesh, MeshError> {
    if elements == 0 {
        // The error for every mesh without elements.
        return Mesh::uniform(0);
    }
    let nodes = mesh.nodes();
    let n = mesh.elements();
    let mut resampled = vec![];
    for j in 0..=elements {
        // In integers: a rounded j/m would shift nested nodes by a bit.
        let index = j * n / elements;
        let rest = j * n % elements;
        resampled.push(if rest == 0 {
            nodes[index]
        } else {
            nodes[index] + (nodes[index + 1] - nodes[index]) * (rest as f64 / elements as f64)
        });
    }
    Mesh::from_nodes(resampled)
}

/// A function of the initial data for dG; one that is not given is zero.
fn boxed(function: &Option<Expression>) -> Box<dyn Fn(f64) -> f64> {
    match function.clone() {
        Some(function) => Box::new(move |x| function.eval(x)),
        None => Box::new(|_| 0.0),
    }
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
}
