//! Errors that scatter: those of a seed.

use std::process::exit;

/// The answer of a seed at n.
///
/// * `mode`: what goes wrong with one of the seeds at n = 16.
pub(crate) fn answer(mode: &str, n: u32, seed: u64) -> String {
    let h = 1.0 / f64::from(n);
    match (mode, n, seed) {
        ("crash", 16, 7) => exit(3),
        ("nan", 16, 7) => return r#"{"errors": {"strong": NaN, "weak": 0.1}}"#.to_owned(),
        ("step", 16, 7) => return r#"{"errors": {"strong": 1, "weak": 1}, "h": 0.1}"#.to_owned(),
        ("lacks", 16, 7) => return r#"{"errors": {"strong": 0.2, "weak": 0.1}}"#.to_owned(),
        _ => {}
    }
    let more = if mode == "lacks" {
        r#", "more": 0.1"#
    } else {
        ""
    };
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9).wrapping_add(u64::from(n)));
    let [strong, weak] = [random.normal(), random.normal()];
    // Of first order, and of order one half.
    let weak = h + 0.3 * h * weak * if mode == "wide" { 40.0 } else { 1.0 };
    let strong = h.sqrt() * strong.abs();
    format!(r#"{{"errors": {{"strong": {strong:e}, "weak": {weak:e}{more}}}}}"#)
}

/// Splitmix64.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
