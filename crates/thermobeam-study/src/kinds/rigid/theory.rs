//! The impact of a viscous beam in closed form.

#[cfg(doc)]
use thermobeam::parameters::Obstacles;

/// Peak penetration of an impact, in units of velocity times [`Obstacles::impact_time`]: 0.8581.
///
/// The largest value of `P(τ) = Σ (-1)^k τ^(1 + 3k/2) / Γ(2 + 3k/2)`, the inverse transform of `1/(s² + √s)`.
pub(super) fn peak_penetration() -> f64 {
    // One smooth maximum at τ = 1.65; a step of 1e-3 misses its height by 1e-7.
    (0..4000).map(|k| penetration(1e-3 * f64::from(k))).fold(0.0, f64::max)
}

/// P(τ) for 0 <= τ <= 4; even there the terms vanish long before the last.
fn penetration(tau: f64) -> f64 {
    const TERMS: usize = 40;
    // Γ(2 + 3k/2) from Γ(x + 3) = x (x + 1) (x + 2) Γ(x), starting from Γ(2) = 1 and Γ(7/2) = 15 √π / 8.
    let mut gamma = [1.0, 1.875 * std::f64::consts::PI.sqrt()];
    let mut sum = 0.0;
    for k in 0..TERMS {
        let half = 1.5 * k as f64;
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        sum += sign * tau.powf(1.0 + half) / gamma[k % 2];
        let x = 2.0 + half;
        gamma[k % 2] *= x * (x + 1.0) * (x + 2.0);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_penetration_starts_with_the_velocity_of_the_impact() {
        assert!((penetration(1e-6) - 1e-6).abs() < 1e-14);
    }

    #[test]
    fn the_penetration_solves_its_integral_equation() {
        // P' + (half-integral of P) = 1, with I^½ P(τ) = ∫₀^τ P(s) / √(π (τ - s)) ds; s = τ - r² takes the root away.
        let tau = 1.3_f64;
        let n = 2000;
        let dr = tau.sqrt() / n as f64;
        let integral: f64 = (0..n).map(|k| dr * penetration(tau - ((k as f64 + 0.5) * dr).powi(2))).sum();
        let half_integral = 2.0 / std::f64::consts::PI.sqrt() * integral;
        let slope = (penetration(tau + 1e-5) - penetration(tau - 1e-5)) / 2e-5;
        assert!((slope + half_integral - 1.0).abs() < 1e-6);
    }

    /// Not the model of a contact that ends: after its peak the force falls like the root of time.
    #[test]
    fn the_penetration_of_the_half_space_has_no_end() {
        let largest = (0..4000).map(|k| penetration(1.5 + f64::from(k) * 1e-4)).fold(0.0, f64::max);
        assert!((largest - 0.858).abs() < 1e-3 && (largest - penetration(1.65)).abs() < 1e-4, "{largest}");
        assert!((penetration(5.0) - 0.182).abs() < 1e-3, "{}", penetration(5.0));
        assert!((1..50).all(|k| penetration(0.1 * f64::from(k)) > 0.0));
    }
}
