use super::{Level, ROUND_OFF, fade, floor, tail};

/// A relative uncertainty m of e is one of s m e^s of e^s.
#[test]
fn differences_of_powers_must_exceed_the_uncertainty_of_powers() {
    let levels = [4.0, 2.0].map(|error| Level { step: 0.1, error });
    for power in [1.0, 2.0] {
        let uncertain = floor(&levels, 0.0, power).powf(power);
        let expected = power * ROUND_OFF * 2.0_f64.powf(power);
        assert!((uncertain / expected - 1.0).abs() < 1e-12, "{uncertain}");
    }
}

#[test]
fn distances_of_a_geometric_series_fade_by_its_ratio() {
    for (distances, expected) in [
        (&[1.0, 0.4, 0.28][..], 0.7),
        (&[0.4, -0.28], 0.25),
        (&[0.4, 0.4], 0.75),
        (&[0.0, 0.28], 0.5),
        (&[0.28], 0.5),
    ] {
        assert!((fade(distances) - expected).abs() < 1e-15, "{distances:?}");
    }
}

/// Rates that stay at 2.5 make a geometric series; at the order, the closed form.
#[test]
fn differences_beyond_the_finest_level_have_the_sum_of_their_rates() {
    for (distance, fade) in [(0.5, 1.0), (-0.5, 1.0), (0.0, 0.5)] {
        let quotient = 2.0_f64.powf(-(2.0 + distance));
        let expected = quotient / (1.0 - quotient);
        let found = tail(2.0, 1.0, 2.0, distance, fade);
        assert!(
            (found / expected - 1.0).abs() < 1e-12,
            "{distance}: {found}"
        );
    }
}
