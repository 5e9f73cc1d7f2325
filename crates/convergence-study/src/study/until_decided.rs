//! Levels until there is a decision: a study begins with four and adds the next finer one while its
//! rates decide nothing, another level can help, and its cost fits the budget.
//!
//! A pass decides at the first look that shows it. A failure decides when two looks in a row show
//! it: at each look a true claim fails by chance, and a study that ended at the first failure would
//! collect these chances. Where no level can follow, the last look decides. The verdict is always
//! that of the rule on the levels with which the study ends.
//!
//! Looking again causes few wrong passes: the rule stands by its interval at every look, and a
//! wrong claim fails at two of them. `rule-calibration` has rows that measure this. A limit on the
//! number of levels keeps it so.

#[cfg(feature = "files")]
use crate::input::{Positive, Refusal};
use crate::study::outcome::{NamedRate, Outcome};
use crate::study::over_levels::Levels;
use convergence_judge::verdict::{Reason, Verdict};

/// What the levels of a study may cost that adds levels until its rates are decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Budget {
    /// The cost of the next level.
    pub next: f64,
    /// The cost of all levels so far.
    pub spent: f64,
    /// The most that all may cost.
    pub limit: f64,
    /// The unit of these costs, in words, such as `s`.
    pub unit: &'static str,
}

impl Budget {
    /// The counts with which such a study begins, each level twice as fine as the one before.
    pub const FIRST_LEVELS: [usize; 4] = [8, 16, 32, 64];

    /// That of a study whose levels take these seconds: the next one takes longer by the same
    /// factor as the last one did, and by at least two. One level alone says nothing of the next.
    pub fn of_seconds(seconds: &[f64], limit: f64) -> Self {
        let next = match seconds {
            [.., before, last] => last * (last / before).max(2.0),
            _ => 0.0,
        };
        Self {
            next,
            spent: seconds.iter().sum(),
            limit,
            unit: "s",
        }
    }

    /// [`FIRST_LEVELS`](Self::FIRST_LEVELS), or coarser ones for errors that fall fast.
    ///
    /// * `error`: at a count, for the fastest of the errors claimed, in units of its constant.
    pub fn first_levels(error: impl Fn(f64) -> f64) -> [usize; 4] {
        let first = Self::FIRST_LEVELS;
        let begins_with = |coarsest: usize| first.map(|count| count * coarsest / first[0]);
        let mut usable = [8, 4].map(begins_with).into_iter();
        let usable = usable.find(|levels| error(levels[3] as f64) >= SMALLEST_FIRST);
        // Few schemes have a single cell.
        usable.unwrap_or(begins_with(2))
    }

    /// Whether the next level is computed: the rates are not decided, it can help, and it fits.
    ///
    /// * `rates`: of the levels so far.
    pub fn allows(&self, levels: &Levels, rates: &[NamedRate]) -> bool {
        self.after(&Looks::of(levels, rates), levels.refinements.len()) == Next::Another
    }

    /// Whether the next level fits.
    pub(crate) fn has_room(&self) -> bool {
        // Not `>`, which would let NaN pass.
        self.spent + self.next <= self.limit
    }

    /// The outcome of a study that has ended so. It says how the study ended, and guards only the
    /// first levels, because another machine may afford others.
    pub fn conclude(&self, outcome: Outcome, levels: &Levels, rates: &[NamedRate]) -> Outcome {
        self.conclude_after(outcome, &Looks::of(levels, rates), levels)
    }

    /// The same of rates that need not be those of the levels alone.
    pub(crate) fn conclude_after(
        &self,
        mut outcome: Outcome,
        looks: &Looks<'_>,
        levels: &Levels,
    ) -> Outcome {
        let next = self.after(looks, levels.refinements.len());
        let words = self.in_words(next, levels, &outcome.rates);
        outcome.add_to_summary(&words);
        let first = levels.refinements.iter().take(Self::FIRST_LEVELS.len());
        let first: Vec<&String> = first.map(|level| &level.label).collect();
        outcome.quantities.retain(|quantity| {
            let case = quantity.subject.case.as_ref();
            case.is_some_and(|case| first.contains(&case))
        });
        outcome
    }

    /// What a study does next.
    ///
    /// * `levels`: how many there are so far.
    pub(crate) fn after(&self, looks: &Looks<'_>, levels: usize) -> Next {
        let open = looks.open();
        let Some(&(_, first)) = open.first() else {
            return Next::Decided;
        };
        let mut may_change = open
            .iter()
            .filter(|(_, reason)| can_change(*reason))
            .peekable();
        if may_change.peek().is_none() {
            Next::Beyond(first)
        } else if may_change.all(|(name, _)| looks.below_floor.iter().any(|below| below == name)) {
            Next::BelowFloor
        } else if levels >= MOST_LEVELS {
            Next::Most
        } else if self.has_room() {
            Next::Another
        } else {
            Next::TooDear
        }
    }

    /// How a study ended, in words: `decided after 5 levels; 4 were enough for L2`.
    fn in_words(&self, next: Next, levels: &Levels, rates: &[NamedRate]) -> String {
        let count = levels.refinements.len();
        let is_open = |named: &NamedRate| named.rate.verdict == Verdict::Inconclusive;
        let undecided = if rates.iter().any(is_open) {
            format!("undecided after {count} levels")
        } else {
            format!("a failure at the last look only, after {count} levels")
        };
        match next {
            Next::Another | Next::Decided => {
                let mut words = format!("decided after {count} levels");
                for (name, enough) in levels_that_were_enough(levels, rates) {
                    words += &format!("; {enough} were enough for {name}");
                }
                words
            }
            Next::Beyond(reason) => {
                format!("{undecided}: {}, which no finer level mends", reason.text())
            }
            Next::BelowFloor => {
                format!("{undecided}: the next error would be below the floor")
            }
            Next::Most => format!("{undecided}, the most that are tried"),
            Next::TooDear => {
                let Self {
                    next, limit, unit, ..
                } = self;
                format!(
                    "{undecided}: the next would take about {next:.2e} {unit}, more than what is left of the budget of {limit} {unit}"
                )
            }
        }
    }

    /// Whether a verdict stands without a finer level: a pass does, a failure if the look before
    /// has failed as well.
    ///
    /// * `before`: the verdict with one level fewer; `None` at the first look.
    pub fn is_settled(now: Verdict, before: Option<Verdict>) -> bool {
        match now {
            Verdict::Pass => true,
            Verdict::Fail => before == Some(Verdict::Fail),
            Verdict::Inconclusive => false,
        }
    }

    /// The budget of a study; `None` if no list is left to the study.
    ///
    /// * `lists`: the keys that are refined, each with whether it is `"auto"`: all are, or none.
    /// * `usual`: the default budget.
    ///
    /// # Errors
    /// Only some lists are `"auto"`, `"auto"` beside `grid = true`, or a budget without it.
    #[cfg(feature = "files")]
    pub fn read(
        lists: &[(&str, bool)],
        grid: bool,
        budget: Option<Positive>,
        usual: f64,
    ) -> Result<Option<f64>, Refusal> {
        let Some((auto, _)) = lists.iter().find(|(_, is_auto)| *is_auto) else {
            return match budget {
                None => Ok(None),
                Some(_) => Err(Refusal::new(
                    "budget",
                    "a budget beside lists",
                    "lists alone, or \"auto\" in their place",
                )),
            };
        };
        if let Some((listed, _)) = lists.iter().find(|(_, is_auto)| !is_auto) {
            let more = " beside \"auto\"";
            return Err(Refusal::written_and(*listed, more, "\"auto\" for both"));
        }
        if grid {
            return Err(Refusal::written(*auto, "lists where grid = true"));
        }
        Ok(Some(budget.map_or(usual, Positive::get)))
    }
}

/// The error at the fourth level, of a solution of size one, below which a study begins with
/// coarser levels: that of the next one would be near round-off.
const SMALLEST_FIRST: f64 = 1e-11;

/// Most levels.
pub(crate) const MOST_LEVELS: usize = 8;

/// What a study that adds levels does next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Next {
    /// It computes another level.
    Another,
    /// It ends: every rate has passed, or has failed at two looks.
    Decided,
    /// It ends: no finer level can resolve this reason.
    Beyond(Reason),
    /// It ends with `MOST_LEVELS`.
    Most,
    /// It ends: the next errors would be below the floor, and tell nothing.
    BelowFloor,
    /// It ends: the next level would cost more than what is left.
    TooDear,
}

/// The rates of the levels so far, and what they were with one level fewer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Looks<'r> {
    /// The rates of all levels so far.
    pub now: &'r [NamedRate],
    /// The same names without the finest level; empty at the first look.
    pub before: Vec<NamedRate>,
    /// The names of errors that would be below the floor at the next level.
    below_floor: Vec<String>,
}

impl<'r> Looks<'r> {
    /// * `now`: the rates of all levels so far, `levels` in number.
    /// * `judge`: the rates of that many of them, the coarsest first.
    pub(crate) fn new(
        now: &'r [NamedRate],
        levels: usize,
        judge: impl FnOnce(usize) -> Vec<NamedRate>,
    ) -> Self {
        let before = if levels > Budget::FIRST_LEVELS.len() {
            judge(levels - 1)
        } else {
            vec![]
        };
        Self {
            now,
            before,
            below_floor: vec![],
        }
    }

    /// The same of rates of these errors, which may be below the floor at the next level.
    #[must_use]
    pub(crate) fn of_errors(self, levels: &Levels) -> Self {
        let below_floor = levels.below_floor_next();
        Self {
            below_floor,
            ..self
        }
    }

    /// The two looks at errors over levels.
    ///
    /// * `now`: the rates of these levels.
    pub(crate) fn of(levels: &Levels, now: &'r [NamedRate]) -> Self {
        Self::new(now, levels.refinements.len(), |count| {
            levels.coarsest(count).judge()
        })
        .of_errors(levels)
    }

    /// The rates that are not decided yet, with their reasons.
    fn open(&self) -> Vec<(&str, Reason)> {
        let earlier = |name: &str| {
            let named = self.before.iter().find(|named| named.name == name);
            named.map(|named| named.rate.verdict)
        };
        self.now
            .iter()
            .filter(|now| {
                let kind = now.rate.code;
                !kind.is_final() && !Budget::is_settled(kind.verdict(), earlier(&now.name))
            })
            .map(|now| (now.name.as_str(), now.rate.code))
            .collect()
    }
}

/// Whether a finer level may settle a rate that is open for this reason.
fn can_change(reason: Reason) -> bool {
    reason.verdict() == Verdict::Fail || reason.wants_a_level()
}

/// Errors that were decided with fewer levels, each with that number of levels.
fn levels_that_were_enough<'r>(levels: &Levels, rates: &'r [NamedRate]) -> Vec<(&'r str, usize)> {
    let all = levels.refinements.len();
    let mut enough = vec![all; rates.len()];
    for count in (Budget::FIRST_LEVELS.len()..all).rev() {
        let earlier = levels.coarsest(count).judge();
        for ((enough, last), earlier) in enough.iter_mut().zip(rates).zip(&earlier) {
            if *enough == count + 1 && earlier.rate.verdict == last.rate.verdict {
                *enough = count;
            }
        }
    }
    for (enough, last) in enough.iter_mut().zip(rates) {
        let kind = last.rate.code;
        if kind.verdict() == Verdict::Fail && !kind.is_final() {
            *enough += 1;
        }
    }
    let names = rates.iter().map(|rate| rate.name.as_str());
    names
        .zip(enough)
        .filter(|(_, enough)| *enough < all)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::over_levels::{Claim, ErrorColumn, RefinedIn, Refinement};
    use convergence_judge::verdict::{Floor, judge_pairs};

    /// The rates of errors on so many levels, each claimed to be of second order.
    fn rates(levels: usize, errors: &[fn(f64) -> f64]) -> Vec<NamedRate> {
        let steps: Vec<f64> = (3..levels as i32 + 3).map(|k| 0.5_f64.powi(k)).collect();
        let judged = |error: &fn(f64) -> f64| {
            let pairs: Vec<(f64, f64)> = steps.iter().map(|&h| (h, error(h))).collect();
            judge_pairs(pairs, 2.0, 0.25)
        };
        errors
            .iter()
            .enumerate()
            .map(|(index, error)| NamedRate::new(format!("e{index}"), judged(error)))
            .collect()
    }

    fn verdict(levels: usize, error: fn(f64) -> f64) -> Verdict {
        rates(levels, &[error])[0].rate.verdict
    }

    /// What comes after so many levels, the next of which costs so much.
    fn after(levels: usize, errors: &[fn(f64) -> f64], cost: f64) -> Next {
        let now = rates(levels, errors);
        let looks = Looks::new(&now, levels, |count| rates(count, errors));
        costing(cost, 5.0).after(&looks, levels)
    }

    /// What is left after a cost of 1.
    fn costing(next: f64, limit: f64) -> Budget {
        Budget {
            next,
            spent: 1.0,
            limit,
            unit: "s",
        }
    }

    fn second(h: f64) -> f64 {
        h * h
    }

    fn first(h: f64) -> f64 {
        h
    }

    fn not_a_number(_: f64) -> f64 {
        f64::NAN
    }

    /// Of first order on the four coarsest levels, of second order below them.
    fn late(h: f64) -> f64 {
        if h > 0.01 { 1e-4 * h } else { 0.01 * h * h }
    }

    #[test]
    fn a_pass_decides_at_once_and_a_failure_at_the_second_look() {
        assert_eq!(after(4, &[second], 1.0), Next::Decided);
        assert_eq!(verdict(4, first), Verdict::Fail);
        assert_eq!(after(4, &[first], 1.0), Next::Another);
        assert_eq!(after(5, &[first], 1.0), Next::Decided);
        assert_eq!(after(4, &[second, first], 1.0), Next::Another);
    }

    #[test]
    fn what_no_level_mends_fails_at_once() {
        assert_eq!(after(4, &[not_a_number], 1.0), Next::Decided);
    }

    #[test]
    fn a_failure_that_a_finer_level_takes_back_does_not_decide() {
        assert_eq!(verdict(4, late), Verdict::Fail);
        assert_ne!(verdict(5, late), Verdict::Fail);
        assert_eq!(after(5, &[late], 1.0), Next::Another);
    }

    #[test]
    fn high_orders_begin_with_coarser_levels() {
        let of_order = |order: i32| Budget::first_levels(|n| n.powi(-order));
        for (order, first) in [(2, 8), (6, 8), (7, 4), (8, 2), (40, 2)] {
            assert_eq!(of_order(order)[0], first, "{order}");
        }
        assert_eq!(of_order(8), [2, 4, 8, 16]);
        assert_eq!(Budget::first_levels(|n| 3f64.powf(-n)), [2, 4, 8, 16]);
    }

    #[test]
    fn no_level_is_added_whose_error_would_be_below_the_floor() {
        let levels = |floor: f64| {
            let refinements = (0..4).map(|k| {
                let n = 8 << k;
                Refinement::new(format!("n = {n}"), &[("n", n)], 1.0 / n as f64)
            });
            let refinements: Vec<Refinement> = refinements.collect();
            let errors = refinements.iter().map(|level| Some(level.step));
            let column = ErrorColumn::new("e", Claim::new(2.0, 0.25), errors);
            let levels = Levels::new(RefinedIn::Space, refinements.clone(), [column]);
            levels.with_floor(Floor::new(floor).unwrap())
        };
        let after = |floor: f64| {
            let levels = levels(floor);
            let now = levels.judge();
            costing(1.0, 9.0).after(&Looks::of(&levels, &now), 4)
        };
        // The last error is 1/64.
        assert_eq!(after(0.0), Next::Another);
        assert_eq!(after(0.007), Next::Another);
        assert_eq!(after(0.008), Next::BelowFloor);
    }

    #[test]
    fn the_last_look_decides_where_no_level_can_follow() {
        assert_eq!(after(4, &[first], 9.0), Next::TooDear);
        assert!(!Budget::is_settled(
            Verdict::Fail,
            Some(Verdict::Inconclusive)
        ));
        assert!(Budget::is_settled(Verdict::Fail, Some(Verdict::Fail)));
    }
}
