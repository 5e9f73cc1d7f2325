//! The steady states of one state of contact: straight, buckled and loaded.

use super::law::{ForceLaw, Support, free_buckling};
use super::polish::polish;
use super::scan::{Position, Root};
use super::shape::Shape;
use super::{BUCKLING_VALUES, Equilibrium, EquilibriumError, Phase};

/// Tolerance of `N = β + ρ‖u'‖²` in a returned state, relative to one plus the largest of its
/// terms.
const CONSISTENCY: f64 = 1e-9;

/// For ρ = 0: a determinant smaller than this, relative to the sum of its terms, is zero to
/// round-off.
const RESONANCE: f64 = 1e-13;

/// Whether a state with this N is returned: an interval above N = -1 is omitted, see
/// [`super::equilibria`].
fn is_listed(n_value: f64) -> bool {
    n_value <= -1.0 || 1.0 + n_value > free_buckling(BUCKLING_VALUES + 1)
}

/// One state of contact: its law, and the solutions of that law, whether or not they press the
/// obstacle.
pub(super) struct Branch {
    /// The state of contact.
    pub(super) contact: Phase,
    /// The linear problem for given N.
    pub(super) law: ForceLaw,
    /// The law of the straight beam if both obstacles hold its tip at 0.
    pub(super) held_tip: Option<ForceLaw>,
}

impl Branch {
    /// All solutions of the law.
    pub(super) fn states(&self) -> Result<Vec<Equilibrium>, EquilibriumError> {
        let mut states = if self.law.rho == 0.0 {
            vec![self.linear()?]
        } else if self.law.homogeneous() {
            self.straight_and_buckled()?
        } else {
            self.bent()?
        };
        states.extend(self.at_minus_one());
        Ok(states)
    }

    /// ρ = 0: N = β, and one linear problem.
    fn linear(&self) -> Result<Equilibrium, EquilibriumError> {
        let s = 1.0 + self.law.beta;
        if self.law.homogeneous() && self.law.support.is_none() {
            return self.resonant(s).map_or_else(|| Ok(self.straight()), Err);
        }
        if s == 0.0 {
            return Ok(self.state(-1.0, Shape::line(self.law.moment), None, false));
        }
        if let Some(error) = self.resonant(s) {
            return Err(error);
        }
        let above = (s > 0.0).then(|| self.law.buckling_above(s));
        Ok(self.state(self.law.beta, self.law.solve(s), above, false))
    }

    fn resonant(&self, s: f64) -> Option<EquilibriumError> {
        let q = 1.0 / s;
        let epsilon = self.law.support.map_or(0.0, |support| support.epsilon);
        let singular = if s > 0.0 {
            self.law.determinant(q).abs() <= RESONANCE * (1.0 + q + epsilon)
        } else {
            self.law
                .buckling_below_minus_one()
                .is_some_and(|pole| (s - pole).abs() <= RESONANCE * s.abs())
        };
        singular.then_some(EquilibriumError::Resonance {
            contact: self.contact,
            n_value: self.law.beta,
        })
    }

    /// The straight beam without load: u = φ = 0, N = β.
    fn straight(&self) -> Equilibrium {
        let s = 1.0 + self.law.beta;
        let law = self.held_tip.unwrap_or(self.law);
        let unstable = (s > 0.0).then(|| law.buckling_above(s));
        let at_bifurcation = unstable.is_some_and(|k| law.buckling(k + 1) == s);
        self.state(self.law.beta, Shape::line(0.0), unstable, at_bifurcation)
    }

    /// Without load: the straight state, and a pair of buckled states at each buckling value above
    /// β.
    fn straight_and_buckled(&self) -> Result<Vec<Equilibrium>, EquilibriumError> {
        // With a support at 0 the straight beam touches without pressing: the free law returns it.
        let mut states = if self.law.support.is_none() {
            vec![self.straight()]
        } else {
            Vec::new()
        };
        let above = (1..=BUCKLING_VALUES + 1).map(|k| (self.law.buckling(k), Some(k - 1)));
        let below = self.law.buckling_below_minus_one().map(|s| (s, None));
        let exists = |s: f64| s > 1.0 + self.law.beta && is_listed(s - 1.0);
        for (s, unstable_directions) in above.chain(below).filter(|(s, _)| exists(*s)) {
            for sign in [1.0, -1.0] {
                let position = Position::Buckling(s, sign);
                states.push(self.state_at(&Root {
                    position,
                    unstable_directions,
                    fold: false,
                })?);
            }
        }
        Ok(states)
    }

    /// With a load: the roots of the scalar equation.
    fn bent(&self) -> Result<Vec<Equilibrium>, EquilibriumError> {
        let above = self.law.roots_above_minus_one(BUCKLING_VALUES + 1);
        let roots = above.into_iter().chain(self.law.roots_below_minus_one());
        let states: Result<Vec<_>, _> = roots.map(|root| self.state_at(&root)).collect();
        Ok(states?
            .into_iter()
            .filter(|state| is_listed(state.n_value))
            .collect())
    }

    /// The free state at N = -1, which exists if `ρ(aθ_A)² = -1 - β` to round-off.
    fn at_minus_one(&self) -> Option<Equilibrium> {
        let ForceLaw { beta, rho, .. } = self.law;
        let slope = -self.law.moment;
        let defect = -1.0 - beta - rho * slope * slope;
        let exists = self.law.support.is_none()
            && rho * slope != 0.0
            && defect.abs() <= 4.0 * f64::EPSILON * beta.abs();
        exists.then(|| self.state(-1.0, Shape::line(self.law.moment), None, false))
    }

    /// The state at a root; an error if it violates `N = β + ρ‖u'‖²`.
    fn state_at(&self, root: &Root) -> Result<Equilibrium, EquilibriumError> {
        let ForceLaw { beta, rho, .. } = self.law;
        let shape = match root.position {
            Position::Between(s) => self.law.solve(s),
            Position::Buckling(s, sign) => self.buckled(s, sign)?,
        };
        let shape = if root.fold {
            shape
        } else {
            polish(&self.law, shape)
        };
        let n_value = shape.n_value();
        let tension = rho * shape.slope_squared();
        let defect =
            (n_value - beta - tension) / (1.0 + n_value.abs().max(beta.abs()).max(tension));
        if defect.is_nan() || defect.abs() > CONSISTENCY {
            return Err(EquilibriumError::Inaccurate {
                contact: self.contact,
                n_value,
                defect,
            });
        }
        Ok(self.state(n_value, shape, root.unstable_directions, root.fold))
    }

    /// The buckling mode at s with the given sign and the amplitude for which `N = β + ρ‖u'‖²`.
    fn buckled(&self, s: f64, sign: f64) -> Result<Shape, EquilibriumError> {
        let mode = self.law.mode(s);
        let square = (s - (1.0 + self.law.beta)) / (self.law.rho * mode.slope_squared());
        if square.is_nan() || square <= 0.0 {
            return Err(EquilibriumError::Bifurcation {
                contact: self.contact,
                n_value: s - 1.0,
            });
        }
        let factor = sign * square.sqrt();
        let (alpha, stress) = (factor * mode.alpha, factor * mode.stress);
        Ok(Shape {
            alpha,
            stress,
            moment: self.law.moment,
            ..mode
        })
    }

    fn state(
        &self,
        n_value: f64,
        shape: Shape,
        unstable_directions: Option<usize>,
        singular: bool,
    ) -> Equilibrium {
        // A difference, so that a zero force is 0 and not -0.
        let contact_force = 0.0 - shape.stress;
        let u_tip = match self.law.support {
            // Equal to u(1), without the cancellation that a small compliance would amplify.
            Some(Support { epsilon, position }) => position + epsilon * contact_force,
            None => shape.u(1.0),
        };
        Equilibrium {
            contact: self.contact,
            n_value,
            u_tip,
            phi_tip: shape.phi(1.0),
            contact_force,
            stable: unstable_directions == Some(0) && !singular,
            unstable_directions,
            shape,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::EquilibriumError::{Bifurcation, Inaccurate};
    use super::*;

    fn branch(law: ForceLaw, held_tip: Option<ForceLaw>) -> Branch {
        let contact = if law.support.is_some() {
            Phase::Upper
        } else {
            Phase::Free
        };
        Branch {
            contact,
            law,
            held_tip,
        }
    }

    fn support(epsilon: f64, position: f64) -> Option<Support> {
        Some(Support { epsilon, position })
    }

    #[test]
    fn a_state_that_violates_the_scalar_equation_is_rejected_with_its_defect() {
        for support in [None, support(0.5, 0.1)] {
            let law = ForceLaw {
                moment: 0.4,
                beta: -3.0,
                rho: 5.0,
                support,
            };
            let branch = branch(law, None);
            for s in [0.7, 4.0, -0.5] {
                let root = Root {
                    position: Position::Between(s),
                    unstable_directions: None,
                    fold: true,
                };
                let (n, tension) = (s - 1.0, law.rho * law.solve(s).slope_squared());
                let largest = n.abs().max(3.0).max(tension);
                let Err(Inaccurate {
                    n_value, defect, ..
                }) = branch.state_at(&root)
                else {
                    panic!("{s} is no root")
                };
                assert!((n_value - n).abs() < 1e-12);
                assert!(
                    (defect - (n + 3.0 - tension) / (1.0 + largest)).abs() < 1e-12,
                    "{s}: {defect}"
                );
            }
            let nan = Root {
                position: Position::Between(f64::NAN),
                unstable_directions: None,
                fold: true,
            };
            assert!(matches!(branch.state_at(&nan), Err(Inaccurate { .. })));
        }
    }

    #[test]
    fn a_buckled_state_needs_a_buckling_value_above_beta() {
        let law = ForceLaw {
            moment: 0.25,
            beta: -4.0,
            rho: 2.0,
            support: support(0.5, 0.1),
        };
        let stretched = ForceLaw { beta: 3.0, ..law };
        for s in [law.buckling(1), law.buckling_below_minus_one().unwrap()] {
            let shape = branch(law, None).buckled(s, -1.0).unwrap();
            assert_eq!((shape.moment, shape.is_line()), (0.25, false));
            let Err(Bifurcation { n_value, contact }) = branch(stretched, None).buckled(s, 1.0)
            else {
                panic!("{s} is below beta")
            };
            assert_eq!((n_value, contact), (s - 1.0, Phase::Upper));
        }
    }

    /// A determinant counts as zero below 1e-13 of the sum of the sizes of its terms, and N as a
    /// pole within 1e-13 of it.
    #[test]
    fn resonance_is_detected_to_round_off() {
        let law = |support: Option<Support>| ForceLaw {
            moment: 0.5,
            support,
            ..ForceLaw::default()
        };
        let is_resonant = |beta: f64, support: Option<Support>| {
            let law = ForceLaw {
                beta,
                ..law(support)
            };
            branch(law, None).resonant(1.0 + beta).is_some()
        };
        for support in [None, support(12.0, 0.1)] {
            let law = law(support);
            let size = |q: f64| 1.0 + q + support.map_or(0.0, |support| support.epsilon);
            let excess = |beta: f64| {
                let q = 1.0 / (1.0 + beta);
                law.determinant(q).abs() / (RESONANCE * size(q))
            };
            let mut counts = [0, 0];
            for k in 1..=3 {
                let beta = law.buckling(k) - 1.0;
                for step in -40..=40 {
                    let beta = beta + f64::from(step) * 4e-15;
                    counts[usize::from(is_resonant(beta, support))] += 1;
                    assert_eq!(
                        is_resonant(beta, support),
                        excess(beta) <= 1.0,
                        "{beta} of {law:?}: {}",
                        excess(beta)
                    );
                }
            }
            assert!(counts[0] > 50 && counts[1] > 10, "{counts:?}");
        }
        let support = support(0.05, 0.1);
        let pole = law(support).buckling_below_minus_one().unwrap();
        for (relative, expected) in [
            (-2e-13, false),
            (-7e-14, true),
            (0.0, true),
            (7e-14, true),
            (2e-13, false),
        ] {
            assert_eq!(
                is_resonant(pole * (1.0 + relative) - 1.0, support),
                expected,
                "{relative:e}"
            );
        }
    }

    /// The β for which 1 + β is exactly s, if it exists.
    fn beta_at(s: f64) -> Option<f64> {
        Some(s - 1.0).filter(|beta| 1.0 + beta == s)
    }

    #[test]
    fn a_beam_held_by_both_obstacles_is_not_stable_at_its_buckling_value() {
        let mut tried = 0;
        for k in 0..50 {
            let held_tip = ForceLaw {
                support: support(1e-3 * f64::from(1 + k), 0.0),
                ..ForceLaw::default()
            };
            let Some(beta) = beta_at(held_tip.buckling(1)) else {
                continue;
            };
            let is_stable = |beta: f64| {
                let law = ForceLaw {
                    beta,
                    rho: 1.0,
                    ..ForceLaw::default()
                };
                branch(law, Some(held_tip)).straight().stable
            };
            let found = [beta, beta + 1e-12].map(is_stable);
            assert_eq!(found, [false, true], "{held_tip:?}");
            tried += 1;
        }
        assert!(tried > 5, "{tried}");
    }

    #[test]
    fn at_its_buckling_value_a_buckled_pair_merges_with_the_straight_beam() {
        let mut tried = 0;
        for k in 1..=BUCKLING_VALUES {
            let Some(beta) = beta_at(free_buckling(k)) else {
                continue;
            };
            let law = ForceLaw {
                beta,
                rho: 1.0,
                ..ForceLaw::default()
            };
            let states = branch(law, None).states().unwrap();
            assert_eq!(states.len(), 1 + 2 * (k - 1), "quarter waves {k}");
            assert!(!states[0].stable && states[0].unstable_directions == Some(k - 1));
            tried += 1;
        }
        assert!(tried > 0);
    }
}
