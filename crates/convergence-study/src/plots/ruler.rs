//! From values to positions: range, scale, ticks and their labels.

use super::Scale;

/// Values beyond this overflow the arithmetic of ranges, and count as not finite.
const LARGEST: f64 = 1e300;
/// A range narrower than this fraction of its values is widened: its ticks would be the same in
/// print.
const NARROWEST: f64 = 1e-6;

/// Whether a value has a position on its scale.
pub(crate) fn has_place(scale: Scale, value: f64) -> bool {
    // NaN fails the comparison.
    value.abs() <= LARGEST && (scale == Scale::Linear || value > 0.0)
}

/// Position of a value on its scale: itself, or its decimal logarithm. `None` if it has none.
pub fn on_scale(scale: Scale, value: f64) -> Option<f64> {
    has_place(scale, value).then(|| {
        if scale == Scale::Log {
            value.log10()
        } else {
            value
        }
    })
}

/// An axis with a range and a place on the page.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ruler {
    /// Linear or logarithmic.
    pub scale: Scale,
    /// Low end of the range, on the scale: a value, or its decimal logarithm.
    pub lo: f64,
    /// High end, on the scale.
    pub hi: f64,
    /// The px that belong to `lo` and `hi`.
    start: f64,
    end: f64,
}

/// A labelled tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Its position on the scale.
    pub position: f64,
    /// Its text.
    pub label: String,
}

/// The ticks of an axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ticks {
    /// Those with labels.
    pub major: Vec<Tick>,
    /// Positions of those without, on the scale.
    pub minor: Vec<f64>,
    /// The labels must be multiplied by ten to this power.
    pub exponent: i32,
}

impl Ruler {
    /// The range of the drawable values, widened by `margin` of its length on both sides.
    ///
    /// Without drawable values it is [0, 1], or one decade.
    pub fn around(scale: Scale, values: impl IntoIterator<Item = f64>, margin: f64) -> Self {
        let mut lo = f64::INFINITY;
        let mut hi = f64::NEG_INFINITY;
        for v in values.into_iter().filter_map(|v| on_scale(scale, v)) {
            lo = lo.min(v);
            hi = hi.max(v);
        }
        if lo > hi {
            (lo, hi) = if scale == Scale::Log {
                (-1.0, 0.0)
            } else {
                (0.0, 1.0)
            };
        }
        let smallest = match scale {
            Scale::Linear => NARROWEST * lo.abs().max(hi.abs()),
            Scale::Log => NARROWEST,
        };
        let half = match (hi - lo, scale) {
            (0.0, Scale::Linear) if lo == 0.0 => 1.0,
            (0.0, Scale::Linear) => 0.1 * lo.abs(),
            (0.0, Scale::Log) => 0.5,
            (span, _) => (0.5 * span).max(smallest),
        };
        let mid = lo + 0.5 * (hi - lo);
        let half = half * (1.0 + 2.0 * margin);
        Self {
            scale,
            lo: mid - half,
            hi: mid + half,
            start: 0.0,
            end: 1.0,
        }
    }

    /// A range given by its ends on the scale.
    pub fn between(scale: Scale, lo: f64, hi: f64) -> Self {
        Self {
            scale,
            lo,
            hi,
            start: 0.0,
            end: 1.0,
        }
    }

    /// The ruler on the page: `start` and `end` are the px of its low and its high end.
    pub fn laid_out(self, start: f64, end: f64) -> Self {
        Self { start, end, ..self }
    }

    /// The px of a value, if it can be drawn.
    pub fn px(&self, value: f64) -> Option<f64> {
        on_scale(self.scale, value).map(|v| self.px_of(v))
    }

    /// The px of a position on the scale.
    pub fn px_of(&self, v: f64) -> f64 {
        self.start + self.fraction(v) * (self.end - self.start)
    }

    /// 0 at the low end, 1 at the high end.
    pub fn fraction(&self, v: f64) -> f64 {
        (v - self.lo) / (self.hi - self.lo)
    }

    /// About `wanted` labelled ticks at round values.
    pub fn ticks(&self, wanted: usize) -> Ticks {
        let decades = self.hi.floor() - self.lo.ceil() + 1.0;
        match self.scale {
            Scale::Linear => linear_ticks(self.lo, self.hi, wanted),
            Scale::Log if decades >= 3.0 => self.decade_ticks(wanted),
            Scale::Log => self.ticks_within_few_decades(wanted),
        }
    }

    fn decade_ticks(&self, wanted: usize) -> Ticks {
        let first = self.lo.ceil() as i32;
        let last = self.hi.floor() as i32;
        let stride = (last - first + 1).div_euclid(wanted as i32 + 1) + 1;
        let major = (first..=last).filter(|d| d.rem_euclid(stride) == 0);
        let major = major
            .map(|d| Tick {
                position: f64::from(d),
                label: power_of_ten(d),
            })
            .collect();
        let minor = if stride > 1 {
            (first..=last)
                .filter(|d| d.rem_euclid(stride) != 0)
                .map(f64::from)
                .collect()
        } else {
            self.multiples((2..10).map(f64::from))
        };
        Ticks {
            major,
            minor,
            exponent: 0,
        }
    }

    /// Positions of these multiples of the powers of ten, within the range.
    fn multiples(&self, multiples: impl Iterator<Item = f64> + Clone) -> Vec<f64> {
        let decades = self.lo.floor() as i32..=self.hi.floor() as i32;
        decades
            .flat_map(|d| multiples.clone().map(move |m| f64::from(d) + m.log10()))
            .filter(|&v| v >= self.lo && v <= self.hi)
            .collect()
    }

    fn ticks_within_few_decades(&self, wanted: usize) -> Ticks {
        let minor = self.multiples((1..10).map(f64::from));
        let round = self.multiples([1.0, 2.0, 5.0].into_iter());
        if round.len() > wanted {
            return self.decade_ticks(wanted);
        }
        if round.len() >= 3 {
            // From 1 to 1000, typical of counts and percentages, powers of ten would be less
            // readable.
            let is_plain = self.lo >= -0.3 && self.hi <= 3.05 && round[0] >= 0.0;
            let major = round
                .iter()
                .map(|&position| Tick {
                    position,
                    label: if is_plain {
                        fixed(10f64.powf(position), 0)
                    } else {
                        scientific(position)
                    },
                })
                .collect();
            return Ticks {
                major,
                minor,
                exponent: 0,
            };
        }
        let linear = linear_ticks(10f64.powf(self.lo), 10f64.powf(self.hi), wanted);
        let major = linear.major.into_iter().filter_map(|tick| {
            Some(Tick {
                position: on_scale(Scale::Log, tick.position)?,
                label: tick.label,
            })
        });
        Ticks {
            major: major.collect(),
            minor,
            exponent: linear.exponent,
        }
    }
}

fn linear_ticks(lo: f64, hi: f64, wanted: usize) -> Ticks {
    let step = round_step((hi - lo) / wanted.max(1) as f64);
    // Half a thousandth keeps an end that is a tick except for round-off.
    let first = (lo / step - 5e-4).ceil() as i64;
    let last = (hi / step + 5e-4).floor() as i64;
    let values: Vec<f64> = (first..=last).take(50).map(|k| k as f64 * step).collect();
    let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let magnitude = if largest > 0.0 {
        (largest * (1.0 + 1e-9)).log10().floor() as i32
    } else {
        0
    };
    let exponent = if (-2..5).contains(&magnitude) {
        0
    } else {
        magnitude
    };
    let unit = 10f64.powi(exponent);
    let decimals = (-(step / unit * (1.0 + 1e-9)).log10().floor()).clamp(0.0, 12.0) as usize;
    let major = values
        .iter()
        .map(|&value| Tick {
            position: value,
            label: fixed(value / unit, decimals),
        })
        .collect();
    Ticks {
        major,
        minor: Vec::new(),
        exponent,
    }
}

/// The next of 1, 2, 5 times a power of ten.
fn round_step(rough: f64) -> f64 {
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|m| m * power >= rough * (1.0 - 1e-9));
    step.unwrap_or(10.0) * power
}

/// A number with a true minus sign, and no negative zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().any(|c| ('1'..='9').contains(&c)) => format!("−{digits}"),
        Some(digits) => digits.to_owned(),
        None => text,
    }
}

/// `10⁻³`.
pub fn power_of_ten(exponent: i32) -> String {
    format!("10{}", superscript(exponent))
}

/// `2×10⁻³` for the value with this logarithm.
fn scientific(log: f64) -> String {
    let exponent = (log + 1e-9).floor();
    let mantissa = 10f64.powf(log - exponent).round();
    let power = power_of_ten(exponent as i32);
    if mantissa == 1.0 {
        power
    } else {
        format!("{mantissa}×{power}")
    }
}

fn superscript(n: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    n.to_string()
        .chars()
        .map(|c| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.major.iter().map(|t| t.label.as_str()).collect()
    }

    #[test]
    fn decades_are_labelled_with_superscripts() {
        let ruler = Ruler::around(Scale::Log, [1e-4, 2.0], 0.0);
        assert_eq!(
            labels(&ruler.ticks(6)),
            ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰"]
        );
        assert_eq!(ruler.ticks(6).minor.len(), 8 * 4 + 1);
    }

    #[test]
    fn many_decades_are_thinned() {
        let ticks = Ruler::around(Scale::Log, [1e-16, 1.0], 0.0).ticks(6);
        assert!(ticks.major.len() <= 7, "{ticks:?}");
        assert_eq!(ticks.major.len() + ticks.minor.len(), 17);
    }

    #[test]
    fn less_than_a_decade_has_labels_too() {
        assert_eq!(
            labels(&Ruler::around(Scale::Log, [9e-3, 6e-2], 0.0).ticks(6)),
            ["10⁻²", "2×10⁻²", "5×10⁻²"]
        );
        assert!(
            Ruler::around(Scale::Log, [3.1, 3.2], 0.0)
                .ticks(6)
                .major
                .len()
                >= 2
        );
    }

    #[test]
    fn linear_ticks_are_round_and_signed_by_a_true_minus() {
        assert_eq!(
            labels(&Ruler::around(Scale::Linear, [-0.1, 0.1], 0.0).ticks(4)),
            ["−0.10", "−0.05", "0.00", "0.05", "0.10"]
        );
    }

    #[test]
    fn small_and_large_values_share_a_power_of_ten() {
        let ticks = Ruler::around(Scale::Linear, [0.0, 4e-5], 0.0).ticks(4);
        assert_eq!(
            (ticks.exponent, labels(&ticks)),
            (-5, vec!["0", "1", "2", "3", "4"])
        );
        assert_eq!(
            Ruler::around(Scale::Linear, [0.0, 3e7], 0.0)
                .ticks(4)
                .exponent,
            7
        );
    }

    #[test]
    fn any_data_gives_a_range() {
        let cases: [&[f64]; 7] = [
            &[],
            &[f64::NAN],
            &[0.0],
            &[5.0, 5.0],
            &[1e300, -1e300],
            &[f64::INFINITY, 1e-320],
            &[1.0, 1.0 + 1e-15],
        ];
        for values in cases {
            for scale in [Scale::Linear, Scale::Log] {
                let ruler = Ruler::around(scale, values.iter().copied(), 0.05);
                assert!(ruler.lo < ruler.hi, "{values:?}: {ruler:?}");
                let ticks = ruler.ticks(6);
                assert!(
                    (1..60).contains(&ticks.major.len()),
                    "{values:?}: {ticks:?}"
                );
            }
        }
    }
}
