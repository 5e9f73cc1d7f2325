//! Cost and error predicted from the pilot runs of a scheme: its cheapest run for an error, and whether another pilot is worth its cost.

use super::Trust;
use super::pilot::Forecast;

/// The part of the error asked for that is aimed at, where the rates are those of theory, and where they are not. What
/// is left is for the error of the forecast itself; a smaller part would cost more than it makes sure of.
const AIM: [f64; 2] = [0.75, 0.5];
/// The pilots may cost this part of the predicted run before the prediction is accepted.
pub(super) const PILOT_SHARE: f64 = 0.15;
/// The same where the rates are not those of theory.
const LOOSE_SHARE: f64 = 0.75;
/// A scheme that costs so many times more than another, by rates that are those of theory, is out.
const BEATEN: f64 = 4.0;
/// A part of space or time alone may be so many times the error aimed at: more would stake all on their cancelling.
pub(super) const CANCELLATION: f64 = 1.5;

/// Cost and error predicted from the pilot runs of one scheme.
pub(super) struct Outlook<'a> {
    pub(super) forecast: Forecast<'a>,
    pub(super) best: Best,
    /// Error of the last pilot.
    pub(super) own: f64,
    at: [usize; 2],
    /// The pilot that would come next.
    pub(super) next: [usize; 2],
}

impl<'a> Outlook<'a> {
    pub(super) fn new(forecast: Forecast<'a>, target: f64) -> Self {
        let best = cheapest(&forecast, target);
        let at = forecast.at();
        let (own, _) = forecast.error(at.map(|count| count as f64));
        let next = next_pilot(&forecast, &best, at);
        Self { forecast, best, own, at, next }
    }

    fn cost(&self) -> f64 {
        self.best.at[0] * self.best.at[1]
    }

    /// Whether it is worth another pilot though another scheme leads: its own forecast is not settled yet.
    pub(super) fn may_win(&self, leader: &Outlook<'_>) -> bool {
        let settled = self.forecast.trust == Trust::Firm && self.cost() > BEATEN * leader.cost();
        !settled && 2.0 * self.next[0] as f64 * self.next[1] as f64 <= PILOT_SHARE * leader.cost()
    }

    /// The run to be done, once there is no point in another pilot; `total` is what the pilots would then have cost.
    pub(super) fn verdict(&self, target: f64, total: f64) -> Option<[f64; 2]> {
        let share = match self.forecast.trust {
            Trust::Firm => PILOT_SHARE,
            // The impacts of a finer run cannot be predicted: the pilot itself must have reached the accuracy.
            Trust::Loose if self.forecast.touched() => {
                return (self.own <= AIM[1] * target).then_some(self.best.at);
            }
            Trust::Loose => LOOSE_SHARE,
            // Not even a rate: only the accuracy itself will do, its difference to coarser runs being all there is.
            Trust::None => {
                return (CANCELLATION * self.own <= target).then(|| self.at.map(|count| count as f64));
            }
        };
        (total > share * self.cost()).then_some(self.best.at)
    }
}

/// The scheme with the cheapest run among those whose forecast is worth most.
pub(super) fn leader(outlooks: &[Outlook<'_>]) -> usize {
    let rank = |outlook: &Outlook<'_>| usize::from(outlook.forecast.trust == Trust::None);
    let order = |a: &Outlook<'_>, b: &Outlook<'_>| rank(a).cmp(&rank(b)).then(a.cost().total_cmp(&b.cost()));
    (0..outlooks.len()).min_by(|&a, &b| order(&outlooks[a], &outlooks[b])).unwrap_or(0)
}

/// A run that a forecast holds for the cheapest, elements and steps not yet whole.
pub(super) struct Best {
    pub(super) at: [f64; 2],
    parts: [f64; 2],
}

fn aim(trust: Trust) -> f64 {
    AIM[usize::from(trust != Trust::Firm)]
}

/// The cheapest run with the error aimed at.
pub(super) fn cheapest(forecast: &Forecast<'_>, target: f64) -> Best {
    /// Elements are tried in steps of this factor; the cost is flat about its minimum.
    const FACTOR: f64 = 1.05;
    let wanted = aim(forecast.trust) * target;
    let fits = |at: [f64; 2]| {
        let (error, [space, time]) = forecast.error(at);
        error <= wanted && space <= CANCELLATION * wanted && time <= CANCELLATION * wanted
    };
    let mut best = Best { at: [f64::INFINITY; 2], parts: [f64::NAN; 2] };
    let mut elements = 4.0;
    // More elements than the cheapest run's steps would leave no room for: the cost only rises from there.
    while elements < best.at[0] * best.at[1] && elements < 1e9 {
        let steps = fewest_steps(|steps| fits([elements, steps])).unwrap_or(f64::INFINITY);
        if elements * steps < best.at[0] * best.at[1] {
            best = Best { at: [elements, steps], parts: forecast.error([elements, steps]).1 };
        }
        elements *= FACTOR;
        if best.at[0].is_finite() && elements > 30.0 * best.at[0] {
            break;
        }
    }
    best
}

/// The fewest steps that fit, to 1 %; none where 1e12 do not.
fn fewest_steps(fits: impl Fn(f64) -> bool) -> Option<f64> {
    let (mut low, mut high) = (1.0_f64, 1e12_f64);
    if !fits(high) {
        return None;
    }
    while high / low > 1.01 {
        let middle = (low * high).sqrt();
        if fits(middle) { high = middle } else { low = middle }
    }
    Some(high)
}

/// The next pilot halves the step whose part is too large for the best path, or both.
fn next_pilot(forecast: &Forecast<'_>, best: &Best, at: [usize; 2]) -> [usize; 2] {
    let [n, s] = at.map(|count| count as f64);
    let (_, [space, time]) = forecast.error([n, s]);
    let lopsided = (space / time) / (best.parts[0] / best.parts[1]);
    // Halving one step changes the balance by 2 to 4: no more than that is out of balance for good.
    match lopsided {
        ratio if ratio > 4.0 => [2 * at[0], at[1]],
        ratio if ratio < 0.25 => [at[0], 2 * at[1]],
        _ => [2 * at[0], 2 * at[1]],
    }
}
