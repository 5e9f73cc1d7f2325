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

use convergence_study::{ErrorColumn, Levels};
use thermobeam_exact::vibration::{discrete_frequencies_until, frequencies};

use super::{ErrorSource, Orders, Runs, Series, SourceResult};
use crate::kinds::prelude::*;
use crate::{
    kinds::tables::{Layout, level_of_mesh},
    scene::{
        file::{Degree, Formula, OfS},
        limits::{self, Elements},
    },
};
use convergence_judge::{text::number::min_or_nan, time_limit::Patience};
use convergence_study::{Order, file};

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

/// A study of frequencies as it is written.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrequenciesFile {
    /// frequencies and meshes
    frequencies: FrequenciesTable,
}

/// The table `[frequencies]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct FrequenciesTable {
    /// frequencies that are computed, from the lowest
    count: Count<1, { limits::MODES }>,
    /// numbers of elements, increasing
    elements: file::Ascending<Elements>,
    /// the order, or the least order
    order: Order,
    /// the ends of the C of error = C h^order
    #[schemars(extend("title" = "two numbers > 0, the smaller first"))]
    constant: Option<[Positive; 2]>,
    /// how far a rate may be from the order; without it 0.25, at most half of the order, a quarter
    /// of a least one
    tolerance: Option<Positive>,
    /// the first frequency whose rate is judged
    #[schemars(extend("default" = 1))]
    first: Option<Count<1>>,
    /// degree p of the elements
    #[schemars(extend("default" = 1))]
    degree: Option<Degree>,
    /// a function of s that places the nodes: 0 at 0, 1 at 1; without it s
    map: Option<Formula<OfS>>,
}

impl FrequenciesTable {
    fn frequencies(&self) -> Result<Frequencies, Refusal> {
        let elements: Vec<usize> = self
            .elements
            .iter()
            .map(|elements| elements.get())
            .collect();
        let [count, degree] = [self.count.get(), self.degree.map_or(1, Count::get)];
        // A mesh has twice as many frequencies, but the upper ones are not approximations.
        if count > elements[0] * degree {
            let allowed = format!("a whole number >= 1 and <= {}", elements[0] * degree);
            return Err(Refusal::written("count", allowed));
        }
        let first = self.first.map_or(1, Count::get);
        if first > count {
            let allowed = format!("a whole number >= 1 and <= {count}");
            return Err(Refusal::written("first", allowed));
        }
        Ok(Frequencies {
            first,
            count,
            degree,
            layout: Layout::new(self.map.as_ref(), &elements, None)?,
            elements,
            claim: self.order.claim(self.constant, self.tolerance)?,
        })
    }
}

impl ErrorSource for Frequencies {
    const ROW: KindRow = KindRow {
        name: "orders/frequencies",
        schema: schema::<FrequenciesFile>,
        read: <Orders<Self>>::read_study,
        why: "Elements of degree p overestimate the eigenfrequencies of the clamped-free beam by O(h^2p); the exact ones are roots of \
              a scalar equation.",
        judged: "The rate of each frequency from the first to the last, and that the discrete ones lie above. Frequencies \
                 below the first must be met on the finest mesh.",
        failure: "Mass, stiffness or coupling of the discretisation is wrong.",
    };

    type File = FrequenciesFile;
    /// Number of elements.
    type Data = usize;
    /// The first discrete frequencies, ascending.
    type Found = Vec<f64>;

    fn from_file(file: FrequenciesFile, _: &Path) -> Result<Self, Refusal> {
        file.frequencies
            .frequencies()
            .map_err(Refusal::within("frequencies"))
    }

    fn cases(&self) -> Vec<Case<usize>> {
        // Bisection to the last bit takes some 60 counts per frequency.
        let mut cases = vec![];
        for &n in &self.elements {
            let cost = 60.0 * (n * self.degree.pow(3) * self.count) as f64;
            cases.push(Case::new(format!("n = {n}"), cost, n));
        }
        cases
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

    fn measured(&self, runs: &Runs<Self>) -> SourceResult {
        let levels = self.levels(runs);
        let mut numbers = vec![self.equation_holds(), self.lie_above(&levels)];
        if self.first > 1 {
            numbers.push(self.met_below_first(runs.last().and_then(Ran::ok)));
        }
        let caption = format!(
            "Errors of frequencies {} to {} over the mesh width, on elements of degree {}.",
            self.first, self.count, self.degree
        );
        let table = self.table(&levels);
        let series = Series::new(levels).drawn("errors", Some("Frequencies ωₕ − ω"), &caption);
        SourceResult {
            sheets: vec![Sheet::untabled(numbers)],
            tables: vec![table],
            series: vec![series],
            ..SourceResult::default()
        }
    }
}

impl Frequencies {
    fn levels(&self, runs: &Runs<Self>) -> Levels {
        let exact = frequencies(self.count);
        let cases = runs.iter().map(|run| &run.case);
        let refinements = cases.map(|case| level_of_mesh(&case.label, case.data));
        let mut columns = vec![];
        for mode in self.first - 1..self.count {
            let errors = runs.iter();
            let errors = errors.map(|run| Some(run.ok()?.get(mode)? - exact[mode]));
            columns.push(ErrorColumn {
                symbol: Some(format!("ω{}", subscript(mode + 1))),
                style: mode,
                ..ErrorColumn::new(format!("omega-{}", mode + 1), self.claim, errors)
            });
        }
        Levels::new(RefinedIn::Space, refinements, columns)
    }

    /// Each judged frequency on the finest mesh.
    fn table(&self, levels: &Levels) -> Table {
        let finest = levels.refinements.last();
        let h = finest.map_or(f64::NAN, |level| level.step);
        let mesh = finest.map_or("-", |level| level.label.as_str());
        let title = format!(
            "Frequencies {} to {}, exact and discrete ({mesh})",
            self.first, self.count
        );
        let head = ["mode", "ω exact", "ω_h", "ω_h - ω", "over ω³h²/24"];
        let mut rows = vec![];
        let exact = frequencies(self.count).into_iter().skip(self.first - 1);
        for ((mode, omega), column) in (self.first..).zip(exact).zip(&levels.columns) {
            let error = column.errors.last().copied().flatten().unwrap_or(f64::NAN);
            // Known for linear elements only.
            let leading = match self.degree {
                1 => format!("{:.3}", error / (omega.powi(3) * h * h / 24.0)),
                _ => "-".to_owned(),
            };
            rows.push(vec![
                mode.to_string(),
                format!("{omega:.11}"),
                format!("{:.11}", omega + error),
                format!("{error:.3e}"),
                leading,
            ]);
        }
        Table::new(title, head, rows)
    }

    /// The exact frequencies solve the frequency equation `1 + C+ C- - ω² S+ S- = 0`.
    fn equation_holds(&self) -> Measured {
        let residuals = frequencies(self.count)
            .into_iter()
            .map(|omega| determinant(omega).abs() / (f64::EPSILON * (1.0 + omega)));
        let name = "residual of the frequency equation in rounding errors, largest";
        measured("", name, largest_of(residuals))
            .fixed(1)
            .must_be(Must::AtMost(ROUNDING_ERRORS))
    }

    /// Frequencies too close to round-off for a rate: they must be accurate on the finest mesh.
    fn met_below_first(&self, found: Option<&Vec<f64>>) -> Measured {
        let exact = frequencies(self.first - 1).into_iter().enumerate();
        let errors = exact.map(|(mode, omega)| {
            let discrete = found.and_then(|found| found.get(mode));
            discrete.map_or(f64::NAN, |discrete| (discrete - omega).abs() / omega)
        });
        let name = format!(
            "relative error of the frequencies below number {} on the finest mesh, largest",
            self.first
        );
        measured("", name, largest_of(errors))
            .scientific(1)
            .must_be(Must::AtMost(MET))
    }

    /// Discrete frequencies lie above the exact ones.
    fn lie_above(&self, levels: &Levels) -> Measured {
        // A NaN and a missing mode must stay visible.
        let errors = levels
            .columns
            .iter()
            .flat_map(|column| &column.errors)
            .map(|error| error.unwrap_or(f64::NAN));
        let name = "ω_h - ω of all levels and modes, least";
        measured("", name, errors.reduce(min_or_nan))
            .scientific(3)
            .must_be(Must::Above(0.0))
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
    digits
        .into_iter()
        .filter_map(|digit| char::from_u32('₀' as u32 + u32::from(digit - b'0')))
        .collect()
}
