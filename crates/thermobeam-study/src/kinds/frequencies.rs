//! Frequencies of the beam on elements of degree p against the exact ones: order 2p, from above.
//!
//! Rayleigh-Ritz: the frequencies of a subspace lie above those of the beam, and their error is the
//! square of the modes' error in the energy norm, h^2p. On linear elements `ω_h - ω` is `ω³h²/24`
//! to leading order for high modes.
//!
//! ```toml
//! [frequencies]
//! degree = 3            # of the elements; 1 by default
//! first = 3             # the lowest mode judged; below it high degrees leave only round-off; 1 by default
//! count = 6             # the highest
//! elements = [6, 8, 12]
//! order = 6.0
//! tolerance = 0.1
//! ```

use thermobeam_exact::vibration::{discrete_frequencies_until, frequencies};

use super::prelude::*;
use super::settings;
use super::tables::Layout;

/// The row of the table of kinds.
pub const ROW: KindRow = KindRow {
    name: "orders/frequencies",
    read: reader::<Frequencies>,
    why: "Elements of degree p overestimate the eigenfrequencies of the clamped-free beam by O(h^2p); the exact ones are roots of \
          a scalar equation.",
    judged: "The rate of each frequency from the first to the last, and that the discrete ones lie above. Frequencies \
             below the first must be met on the finest mesh.",
    failure: "Mass, stiffness or coupling of the discretisation is wrong.",
    settings: settings::of_frequencies,
};

/// Bound on the frequency equation at the exact frequencies, in rounding errors of its terms.
///
/// Between frequencies the determinant is of order 1, as is its slope near one: 16 rounding errors
/// mean 14 digits.
const ROUNDING_ERRORS: f64 = 16.0;

/// Allowed relative error of frequencies without a judged rate.
const MET: f64 = 1e-8;

/// A study of frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct Frequencies {
    /// The lowest judged mode, from 1.
    first: usize,
    /// The highest.
    count: usize,
    degree: usize,
    elements: Vec<usize>,
    layout: Layout,
    claim: Claim,
}

impl FromFile for Frequencies {
    fn from_document(_: &Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "frequencies"])?;
        let keys = [
            "count",
            "elements",
            "order",
            "tolerance",
            "first",
            "degree",
            "map",
        ];
        let section = root.table("frequencies", &keys)?;
        let allowed = "a list of increasing whole numbers >= 1";
        let increasing = (
            "a whole number >",
            (|before, level| level > before) as fn(usize, usize) -> bool,
        );
        let elements = section.sequence(("elements", allowed, 1), tables::elements, increasing)?;
        let degree = section
            .get("degree")
            .map_or(Ok(1), |field| field.count(1..=MAX_DEGREE))?;
        // A mesh has twice as many frequencies, but the upper ones are not approximations.
        let count = section.count("count", 1..=(elements[0] * degree).min(limits::MODES))?;
        let claim = read_claim(&section, "order")?;
        Ok(Self {
            first: section
                .get("first")
                .map_or(Ok(1), |field| field.count(1..=count))?,
            count,
            degree,
            layout: Layout::read(&section, &elements, None)?,
            elements,
            claim: Claim {
                tolerance: section.positive("tolerance")?,
                ..claim
            },
        })
    }
}

impl Kind for Frequencies {
    /// Number of elements.
    type Data = usize;
    /// The first discrete frequencies, ascending.
    type Found = Vec<f64>;

    fn cases(&self) -> Vec<Case<usize>> {
        // Bisection to the last bit takes some 60 counts per frequency.
        let cost = |n: usize| 60.0 * (n * self.degree.pow(3) * self.count) as f64;
        self.elements
            .iter()
            .map(|&n| Case::new(format!("n = {n}"), cost(n), n))
            .collect()
    }

    fn run(&self, &elements: &usize) -> Result<Vec<f64>, CaseFailure> {
        // Each count of the bisection traverses all elements, like a step.
        let mut patience = Patience::new(elements * self.degree.pow(3));
        let mesh = self.layout.mesh(elements)?;
        Ok(discrete_frequencies_until(
            &mesh,
            self.degree,
            self.count,
            |known| patience.check(known, || 0.0),
        )??)
    }

    fn judge(&self, ran: &[Ran<usize, Vec<f64>>]) -> Outcome {
        let levels = self.levels(ran);
        let not_finite = |found: &Vec<f64>| {
            let complete = found.len() == self.count && found.iter().all(|omega| omega.is_finite());
            if complete {
                vec![]
            } else {
                vec!["a frequency".to_owned()]
            }
        };
        let mut checks = vec![
            completion(ran, not_finite),
            self.equation_holds(),
            self.lie_above(&levels),
        ];
        if self.first > 1 {
            checks.push(self.met_below_first(ran.last().and_then(Ran::ok)));
        }
        let Self {
            first,
            count,
            degree,
            ..
        } = self;
        let caption = format!(
            "Errors of frequencies {first} to {count} over the mesh width, on elements of degree {degree}."
        );
        let subject = Some("Frequencies ωₕ − ω");
        let outcome = levels.outcome("errors", subject, &caption, checks);
        Outcome {
            tables: vec![self.table(&levels, &outcome.rates)],
            ..outcome
        }
    }
}

impl Frequencies {
    fn levels(&self, ran: &[Ran<usize, Vec<f64>>]) -> Levels {
        let exact = frequencies(self.count);
        let refinement = |level: &Ran<usize, Vec<f64>>| {
            let (n, label) = (level.case.data, level.case.label.clone());
            Refinement::new(
                label,
                &[("elements", n)],
                self.layout.mesh(n).map_or(f64::NAN, |mesh| mesh.size()),
            )
        };
        let column = |mode: usize| ErrorColumn {
            name: format!("omega-{}", mode + 1),
            symbol: Some(format!("ω{}", subscript(mode + 1))),
            errors: ran
                .iter()
                .map(|level| Some(level.ok()?.get(mode)? - exact[mode]))
                .collect(),
            claim: Some(self.claim),
            look: mode,
        };
        Levels::new(
            Axis::Space,
            ran.iter().map(refinement),
            (self.first - 1..self.count).map(column),
        )
    }

    fn table(&self, levels: &Levels, rates: &[(String, RateVerdict)]) -> Table {
        let finest = levels.refinements.last();
        let h = finest.map_or(f64::NAN, |level| level.step);
        let row = |(mode, omega): (usize, f64)| {
            let (column, rate) = (&levels.columns[mode], &rates[mode].1);
            let error = column.errors.last().copied().flatten().unwrap_or(f64::NAN);
            // Known for linear elements only.
            let leading = (self.degree == 1)
                .then(|| format!("{:.3}", error / (omega.powi(3) * h * h / 24.0)));
            vec![
                (mode + self.first).to_string(),
                format!("{omega:.11}"),
                format!("{:.11}", omega + error),
                format!("{error:.3e}"),
                leading.unwrap_or_else(|| "-".into()),
                rate.fitted
                    .map_or_else(|| "-".into(), |rate| format!("{rate:.4}")),
                rate.interval.map_or_else(
                    || "-".into(),
                    |[low, high]| format!("{low:.4} to {high:.4}"),
                ),
                rate.verdict.to_string(),
            ]
        };
        let head = [
            "mode",
            "ω exact",
            "ω_h",
            "ω_h - ω",
            "over ω³h²/24",
            "rate",
            "95 % interval",
            "verdict",
        ];
        let mesh = finest.map_or("-", |level| level.label.as_str());
        let title = format!(
            "Frequencies {} to {}, exact and discrete ({mesh})",
            self.first, self.count
        );
        Table::new(
            title,
            head,
            frequencies(self.count)
                .into_iter()
                .skip(self.first - 1)
                .enumerate()
                .map(row),
        )
    }

    fn equation_holds(&self) -> Check {
        let rounding = |omega: f64| determinant(omega).abs() / (f64::EPSILON * (1.0 + omega));
        let worst = frequencies(self.count)
            .into_iter()
            .map(rounding)
            .fold(0.0, max_or_nan);
        Check::that(
            worst <= ROUNDING_ERRORS,
            "the exact frequencies solve the frequency equation 1 + C+ C- - ω² S+ S- = 0",
            format!("largest residual {worst:.1} rounding errors, allowed {ROUNDING_ERRORS}"),
        )
        .about(Subject::of("frequency equation"))
    }

    /// Frequencies too close to round-off for a rate: they must be accurate on the finest mesh.
    fn met_below_first(&self, found: Option<&Vec<f64>>) -> Check {
        let error = |(mode, omega): (usize, f64)| {
            let found = found
                .and_then(|found| found.get(mode))
                .copied()
                .unwrap_or(f64::NAN);
            (found - omega).abs() / omega
        };
        let worst = frequencies(self.first - 1)
            .into_iter()
            .enumerate()
            .map(error)
            .fold(0.0, max_or_nan);
        Check::that(
            worst <= MET,
            format!(
                "the frequencies below number {} are met to {MET:e} of their value on the finest mesh",
                self.first
            ),
            format!("largest relative error {worst:.1e}"),
        )
        .about(Subject::of("low frequencies"))
    }

    fn lie_above(&self, levels: &Levels) -> Check {
        // A NaN and a missing mode must stay visible.
        let errors = levels
            .columns
            .iter()
            .flat_map(|column| &column.errors)
            .map(|error| error.unwrap_or(f64::NAN));
        let least = errors.fold(f64::INFINITY, min_or_nan);
        Check::that(
            least > 0.0,
            format!(
                "discrete frequencies {} to {} lie above the exact ones",
                self.first, self.count
            ),
            format!("the smallest ω_h - ω of all levels and modes is {least:.3e}"),
        )
        .about(Subject::of("sign of the errors"))
    }
}

/// `1 + C+ C- - ω² S+ S-` at x = 1 for ω > 1, half the determinant of the boundary conditions, by
/// plain sines.
fn determinant(omega: f64) -> f64 {
    let [plus, minus] = [omega * omega - omega, omega * omega + omega].map(f64::sqrt);
    1.0 + plus.cos() * minus.cos() - omega * omega * (plus.sin() / plus) * (minus.sin() / minus)
}

/// A number in small digits below the line.
fn subscript(number: usize) -> String {
    let digits = number.to_string().into_bytes();
    let small = |digit: u8| char::from_u32('₀' as u32 + u32::from(digit - b'0'));
    digits.into_iter().filter_map(small).collect()
}
