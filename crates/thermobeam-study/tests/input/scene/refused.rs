//! Scene files that are refused, with place, value found and values allowed.

use convergence_study_tests::refusals::each_is_refused;

use super::{TIME, refusal, scene};

#[test]
fn a_wrong_key_or_value_is_named_with_its_place_and_what_is_allowed() {
    each_is_refused(include_str!("refused.txt"), |case| match case.kind {
        "before [time]" => refusal(&format!("{}\n{TIME}", case.new)),
        "in [time]" => refusal(&format!("{TIME}{}", case.new)),
        _ => refusal(&case.new),
    });
}

#[test]
fn the_dt_that_a_refusal_names_is_accepted() {
    for (dt, t_end) in [
        (0.3, 1.0),
        (0.7, 1.0),
        (1e-3, 0.98765),
        (3.0, 1.0),
        (0.012, 7.3),
        (2e-5, 0.31415926),
    ] {
        let text = |dt: f64| format!("[time]\ndt = {dt:?}\nt_end = {t_end:?}");
        let message = refusal(&text(dt));
        let nearest = message
            .split("nearest being ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next());
        let nearest: f64 = nearest
            .and_then(|dt| dt.parse().ok())
            .unwrap_or_else(|| panic!("{message}"));
        let steps = scene(&text(nearest)).steps() as f64;
        assert!((steps * nearest - t_end).abs() <= 1e-15 * t_end);
        // Neither neighbour is closer to the written value.
        for neighbour in [steps - 1.0, steps + 1.0]
            .into_iter()
            .filter(|steps| *steps > 0.0)
        {
            assert!(
                (t_end / neighbour - dt).abs() >= (nearest - dt).abs(),
                "{message}"
            );
        }
    }
}
