//! What a Taylor test has found, in words.

use std::fmt;

use super::{Finding, Judged};
use crate::fit::FLOOR_MARGIN;
use crate::text::number::{counted, decimals};
use crate::verdict::FEWEST_LEVELS;

impl fmt::Display for Judged {
    /// `dJ·d is right to 3.1e-12; the remainder has the rate 2.000`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.name();
        let size = &self.size;
        match self.finding {
            Finding::Right => write!(
                f,
                "{name} is right to {:.1e}; {}",
                size.right_to(),
                self.rate_in_words()
            ),
            Finding::Wrong => write!(
                f,
                "{name} = {:.10e} is wrong: the differences of J tend to {:.10e} ± {:.0e}, it is off by {:.1e} of its size, allowed {:.0e}; {}",
                size.claimed,
                size.found,
                size.bar,
                size.off() / size.size(),
                self.to,
                self.rate_in_words()
            ),
            Finding::OrderTooLow => write!(
                f,
                "{}, expected at least {}: is J smooth along d?",
                self.rate_in_words(),
                self.derivative + 1
            ),
            Finding::OrderUndecided => match &self.rate {
                Some(rate) => write!(
                    f,
                    "{name} is right to {:.1e}, but {}, expected at least {} ({}): start at a smaller step, or test at another m",
                    size.right_to(),
                    self.rate_in_words(),
                    self.derivative + 1,
                    rate.because
                ),
                None => write!(
                    f,
                    "{name} is right to {:.1e}, but only {} of the remainder stand above what that and the noise of J hide, expected at least {FEWEST_LEVELS}: solve more accurately",
                    size.right_to(),
                    counted(self.levels.len(), "level"),
                ),
            },
            Finding::Noisy => f.write_str(&self.noise_in_words()),
            Finding::Vanishes => write!(
                f,
                "{name} is zero along this direction, so it has no relative error: test at another m"
            ),
            Finding::NothingTested => write!(
                f,
                "nothing is tested: J is {} along d but for its noise, at which a wrong derivative of J does not show; test at another m",
                if self.derivative == 1 {
                    "a line"
                } else {
                    "a parabola"
                }
            ),
            Finding::NotFinite => write!(
                f,
                "J or {name} is NaN or infinite at m, or at the smallest steps from it"
            ),
        }
    }
}

impl Judged {
    /// `dJ·d`, or `d'Hd`.
    pub fn name(&self) -> &'static str {
        if self.derivative == 1 {
            "dJ·d"
        } else {
            "d'Hd"
        }
    }

    fn noise_in_words(&self) -> String {
        let right_to = self.size.right_to();
        let less = least_power_of_ten(right_to)
            .filter(|_| self.can_show_order)
            .map(|to| format!(", or ask for less with to={to}"))
            .unwrap_or_default();
        format!(
            "J has noise of {:.0e}, which leaves {} unknown by {right_to:.1e} of its size, allowed {:.0e}: solve more accurately{less}",
            self.noise,
            self.name(),
            self.to,
        )
    }

    fn rate_in_words(&self) -> String {
        match self.rate.as_ref().and_then(|rate| rate.fitted) {
            Some(rate) => format!("the remainder has the rate {}", decimals(rate, 3)),
            None if self.levels.is_empty() => {
                format!("no remainder is above {FLOOR_MARGIN} times the noise of J")
            }
            None => "the remainder has no rate".to_owned(),
        }
    }
}

/// The least power of ten that is not below a number, if it is below one: `1e-4`.
fn least_power_of_ten(number: f64) -> Option<String> {
    let exponent = number.log10().ceil();
    (exponent < 0.0).then(|| format!("1e{exponent}"))
}
