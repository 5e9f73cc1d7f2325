//! From values to places on an axis: range, ticks and their labels.

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

use super::Axis;
use super::pen::widest;

/// Larger numbers overflow the arithmetic of ranges.
const LARGEST: f64 = 1e300;
/// A range narrower than this fraction of its values is widened: its ticks would be the same in
/// print.
const NARROWEST: f64 = 1e-6;

/// An axis with its range and ticks: the coordinate that plotters draws with.
#[derive(Debug, Clone, Default)]
pub(super) struct Ruler {
    pub(super) is_log: bool,
    /// Ends of the range: values, or their decimal logarithms.
    pub(super) low: f64,
    pub(super) high: f64,
    /// Values with their labels.
    pub(super) major: Vec<(f64, String)>,
    /// Values with a line and no label.
    pub(super) minor: Vec<f64>,
}

impl Ranged for Ruler {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        let fraction = self.fraction(*value).unwrap_or(0.0);
        start + (fraction * f64::from(end - start)).round() as i32
    }

    fn key_points<H: KeyPointHint>(&self, hint: H) -> Vec<f64> {
        if hint.weight().allow_light_points() {
            self.minor.clone()
        } else {
            self.major.iter().map(|tick| tick.0).collect()
        }
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Ruler {
    fn format_ext(&self, value: &f64) -> String {
        let tick = self.major.iter().find(|tick| tick.0 == *value);
        tick.map(|tick| tick.1.clone()).unwrap_or_default()
    }
}

impl Ruler {
    /// An axis of no range yet.
    pub(super) fn of_scale(axis: &Axis) -> Self {
        Self {
            is_log: axis.is_log,
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
            ..Self::default()
        }
    }

    /// The range of the axis' own values and the given ones, widened by a fraction on both sides.
    pub(super) fn new(axis: &Axis, values: impl Iterator<Item = f64>, margin: f64) -> Self {
        let mut ruler = Self::of_scale(axis);
        let is_fixed = axis.range.is_some();
        let shown = axis.range.iter().flatten().chain(&axis.show).copied();
        for value in shown.chain(values.filter(|_| !is_fixed)) {
            if let Some(place) = ruler.place(value) {
                ruler.low = ruler.low.min(place);
                ruler.high = ruler.high.max(place);
            }
        }
        if ruler.low > ruler.high {
            [ruler.low, ruler.high] = [0.0, 1.0];
        }
        let span = ruler.high - ruler.low;
        let size = match ruler.low.abs().max(ruler.high.abs()) {
            _ if axis.is_log => 5.0,
            0.0 => 10.0,
            largest => largest,
        };
        let least = if span == 0.0 { 0.2 } else { NARROWEST } * size;
        let room = if is_fixed {
            0.0
        } else {
            (0.5 * (least - span)).max(margin * span)
        };
        Self {
            low: ruler.low - room,
            high: ruler.high + room,
            ..ruler
        }
    }

    /// On which side of the range a value is: -1 below, 1 above, 0 within.
    pub(super) fn beyond(&self, value: f64) -> f64 {
        match self.place(value) {
            Some(place) if place < self.low => -1.0,
            Some(place) if place > self.high => 1.0,
            _ => 0.0,
        }
    }

    /// The place of a value on the scale, if it has one.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        // NaN fails the comparison.
        let has_place = value.abs() <= LARGEST && (!self.is_log || value > 0.0);
        has_place.then(|| if self.is_log { value.log10() } else { value })
    }

    /// 0 at the low end, 1 at the high end; values beyond stand on the rim.
    pub(super) fn fraction(&self, value: f64) -> Option<f64> {
        let place = self.place(value)?;
        Some(((place - self.low) / (self.high - self.low)).clamp(0.0, 1.0))
    }

    /// The same with about as many labelled ticks.
    pub(super) fn with_ticks(&self, wanted: usize) -> Self {
        let mut ruler = Self {
            minor: vec![],
            ..self.clone()
        };
        if !self.is_log {
            ruler.major = linear_ticks(self.low, self.high, wanted);
            return ruler;
        }
        let decades = self.multiples(&[1.0]);
        let round = self.multiples(&[1.0, 2.0, 5.0]);
        let stride = (decades.len() / (wanted + 1) + 1) as i32;
        let minor = match stride {
            1 => self.multiples(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]),
            _ => decades.clone(),
        };
        ruler.minor = minor.into_iter().map(|tick| tick.value).collect();
        // From 1 to 1000, typical of counts and percentages, powers of ten would be less readable.
        let is_plain = self.low >= -0.3 && self.high <= 3.05;
        let labelled = if decades.len() >= 3 || round.len() > wanted {
            decades
        } else {
            round
        };
        let labelled = labelled.into_iter().filter(|tick| tick.power % stride == 0);
        let labelled = labelled.map(|tick| {
            let label = match tick.multiple {
                _ if is_plain => fixed(tick.value, 0),
                1.0 => power_of_ten(tick.power),
                multiple => format!("{multiple}×{}", power_of_ten(tick.power)),
            };
            (tick.value, label)
        });
        ruler.major = labelled.collect();
        if ruler.major.len() < 3 {
            let [low, high] = [self.low, self.high].map(|end| 10f64.powf(end));
            ruler.major = linear_ticks(low, high, wanted);
        }
        ruler
    }

    /// Values in the range that are these multiples of powers of ten.
    fn multiples(&self, multiples: &[f64]) -> Vec<Multiple> {
        let powers = self.low.floor() as i32..=self.high.floor() as i32;
        let all = powers.flat_map(|power| {
            multiples.iter().map(move |multiple| Multiple {
                value: multiple * 10f64.powi(power),
                multiple: *multiple,
                power,
            })
        });
        let is_within = |tick: &Multiple| (self.low..=self.high).contains(&tick.value.log10());
        all.filter(is_within).collect()
    }

    /// Width of the widest label in px.
    pub(super) fn widest(&self) -> f64 {
        widest(self.major.iter().map(|tick| &*tick.1))
    }
}

/// A multiple of a power of ten.
#[derive(Clone)]
struct Multiple {
    value: f64,
    multiple: f64,
    power: i32,
}

fn linear_ticks(low: f64, high: f64, wanted: usize) -> Vec<(f64, String)> {
    let rough = (high - low) / wanted.max(1) as f64;
    let unit = 10f64.powf(rough.log10().floor());
    let steps = [1.0, 2.0, 5.0].map(|multiple| multiple * unit);
    let step = steps
        .into_iter()
        .find(|step| *step >= 0.999_999 * rough)
        .unwrap_or(10.0 * unit);
    // Half a thousandth keeps an end that is a tick except for round-off.
    let ticks = (low / step - 5e-4).ceil() as i64..=(high / step + 5e-4).floor() as i64;
    let largest = magnitude(low.abs().max(high.abs()));
    let power = if (-2..5).contains(&largest) {
        0
    } else {
        largest
    };
    let decimals = (power - magnitude(step)).clamp(0, 12) as usize;
    let ticks = ticks.take(50).map(|k| {
        let value = k as f64 * step;
        let label = match power {
            _ if value == 0.0 => "0".to_owned(),
            0 => fixed(value, decimals),
            _ => {
                let multiple = fixed(value / 10f64.powi(power), decimals);
                format!("{multiple}×{}", power_of_ten(power))
            }
        };
        (value, label)
    });
    ticks.collect()
}

/// The power of ten at or below a value; a little less than a power counts as it.
fn magnitude(value: f64) -> i32 {
    (1.000_001 * value.abs().max(f64::MIN_POSITIVE))
        .log10()
        .floor() as i32
}

/// A number with a true minus sign.
fn fixed(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}").replace('-', "−")
}

/// `10⁻³`.
fn power_of_ten(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits = power.to_string();
    let raised = digits
        .chars()
        .map(|c| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]));
    format!("10{}", raised.collect::<String>())
}
