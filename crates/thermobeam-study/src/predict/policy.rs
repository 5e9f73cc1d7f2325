//! The tuned constants of a search for a discretisation.

/// How a search refines, and when it ends.
///
/// The values are from experience. They change the cost of a search and the discretisation that it
/// finds. Whatever they are, a run is accepted for its differences to two finer ones.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Policy {
    /// Share of the target allowed for each of the two differences.
    pub(super) share: f64,
    /// Rounds of refinement: each at least halves something.
    pub(super) rounds: usize,
    /// A round that lowers the difference by less than this factor has stalled.
    pub(super) stalled: f64,
    /// Below this difference a stalled round has reached round-off: that of the solver's stopping
    /// rule, 1e-14 per step.
    pub(super) round_off: f64,
    /// Least factor by which each degree lowers the error in x, measured in the worst scene: a
    /// front after an impact.
    pub(super) fall_per_degree: f64,
    /// Rate of the error inside steps near a contact event, where u_tt behaves like t^(1/2).
    pub(super) event_rate: f64,
    /// Rate of the error in the first steps, where data that violate a condition at x = 1 make u_tt
    /// behave like t^(-1/2).
    pub(super) start_rate: f64,
    /// Smallest and largest divisor of `restart_dt` in one round.
    pub(super) start_divisors: [f64; 2],
    /// A layer at x = 1 is resolved if its width is at least this multiple of length / p², the
    /// finest detail of an element.
    pub(super) resolved_layer: f64,
    /// Smallest and largest factor of all steps in one round: a large difference gives no reliable
    /// factor.
    pub(super) step_factors: [f64; 2],
    /// A difference that must fall by more than this also raises the degree in time.
    pub(super) large_factor: f64,
    /// Extra degrees of the finer space: two would give only half of the error where a layer is not
    /// resolved.
    pub(super) finer_degrees: usize,
    /// Growth of steps below which it is kept: slower growth would never reach dt.
    pub(super) least_growth: f64,
    /// Elements longer than this part of the longest are halved; shorter ones wait until the
    /// lengths are closer.
    pub(super) long_element: f64,
    /// Degrees added in one round.
    pub(super) most_degrees: usize,
    /// The degree above which elements are halved instead.
    pub(super) highest_degree: usize,
}

impl Default for Policy {
    fn default() -> Self {
        Self {
            share: 0.5,
            rounds: 14,
            stalled: 0.7,
            round_off: 1e-11,
            fall_per_degree: 1.8,
            event_rate: 2.5,
            start_rate: 1.5,
            start_divisors: [2.0, 32.0],
            resolved_layer: 12.0,
            step_factors: [0.25, 0.8],
            large_factor: 4.0,
            finer_degrees: 4,
            least_growth: 1.02,
            long_element: 0.25,
            most_degrees: 8,
            highest_degree: 27,
        }
    }
}
