//! Lengths of steps: a fixed geometric ladder, climbed from the bottom after every contact event.

/// `min(restart_dt growth^k, dt)` for k = 0, 1, ..., and below it `restart_dt/2^k`.
///
/// An event leaves an acceleration like t^(1/2), so the steps must be small at first. There are few
/// different lengths, always the same, so that factorisations can be reused. The lower part is for
/// a free end that grazes an obstacle.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lengths {
    rungs: Vec<f64>,
    /// The rung of `restart_dt`.
    first: usize,
    /// The rung of the next step.
    pub(super) next: usize,
}

/// Maximum number of halvings of `restart_dt`: down to a factor 6e-8.
const HALVINGS: i32 = 24;

/// Maximum number of rungs of a ladder: larger growth factors change nothing.
pub(super) const MAX_RUNGS: usize = 1000;

impl Lengths {
    /// The ladder from `restart_dt` to `dt`.
    pub(super) fn new(restart_dt: f64, growth: f64, dt: f64) -> Self {
        let mut rungs: Vec<f64> = (0..=HALVINGS)
            .rev()
            .map(|k| restart_dt * 0.5_f64.powi(k))
            .collect();
        let first = rungs.len() - 1;
        while let Some(&last) = rungs
            .last()
            .filter(|last| **last < dt && rungs.len() <= first + MAX_RUNGS)
        {
            // The last rung is dt itself; another one just below it would only cost a
            // factorisation.
            let next = last * growth;
            rungs.push(if next * growth.sqrt() < dt && growth > 1.0 {
                next
            } else {
                dt
            });
        }
        Self {
            rungs,
            first,
            next: first,
        }
    }

    /// The length of the next step.
    pub(super) fn get(&self) -> f64 {
        self.rungs[self.next]
    }

    /// The number of lengths from `restart_dt` upwards.
    pub(super) fn count(&self) -> usize {
        self.rungs.len() - self.first
    }

    /// Descends to a quarter of the length or of `restart_dt`, whichever is smaller, if the ladder
    /// reaches that far.
    pub(super) fn descend(&mut self) -> bool {
        let possible = self.next >= 2;
        self.next = self.next.min(self.first).saturating_sub(2);
        possible
    }

    /// Descends to at most half of the length, if that is at least a thousandth of `restart_dt`.
    pub(super) fn shorten(&mut self) -> bool {
        let now = self.get();
        let shorter = self.rungs[..self.next]
            .iter()
            .rposition(|rung| *rung <= 0.5 * now);
        let possible = shorter.is_some() && now >= 1e-3 * self.rungs[self.first];
        self.next = shorter.filter(|_| possible).unwrap_or(self.next);
        possible
    }

    /// After a whole step.
    pub(super) fn climb(&mut self) {
        self.next = (self.next + 1).min(self.rungs.len() - 1);
    }

    /// After an event.
    pub(super) fn restart(&mut self) {
        self.next = self.first;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ladder_leads_from_the_first_length_to_the_largest() {
        let mut lengths = Lengths::new(1e-3, 1.5, 0.02);
        let mut found = vec![];
        for _ in 0..lengths.count() + 2 {
            found.push(lengths.get());
            lengths.climb();
        }
        assert_eq!(
            (found[0], found[found.len() - 1], found[found.len() - 3]),
            (1e-3, 0.02, 0.02)
        );
        assert!(
            found
                .windows(2)
                .all(|pair| pair[1] >= pair[0] && pair[1] <= 1.84 * pair[0]),
            "{found:?}"
        );
        lengths.restart();
        assert_eq!(lengths.get(), 1e-3);
        assert!(lengths.descend());
        assert_eq!(lengths.get(), 0.25e-3);
        lengths.climb();
        assert_eq!(lengths.get(), 0.5e-3);
        assert_eq!((0..20).filter(|_| lengths.descend()).count(), 11);
        let mut lengths = Lengths::new(0.02, 1.5, 0.02);
        assert_eq!((0..20).filter(|_| lengths.shorten()).count(), 10);
        assert_eq!(Lengths::new(0.02, 1.5, 0.02).count(), 1);
        // Growth 1 leads directly to dt.
        assert_eq!(Lengths::new(0.01, 1.0, 0.02).count(), 2);
    }
}
