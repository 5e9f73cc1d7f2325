use super::typed::{changed, passes_but_not_without_each_case, report};
use super::{file, text};
use convergence_study::{FromFile, Kind, Verdict, run_one};
use thermobeam_study::exact::norm::Norm;
use thermobeam_study::kinds::orders::{Orders, vibration};

type Vibration = Orders<vibration::Vibration>;

const FILES: [&str; 4] = [
    "vibration-space.toml",
    "vibration-time.toml",
    "vibration-midpoint.toml",
    "vibration-coupled.toml",
];

fn study(name: &str) -> Vibration {
    Vibration::read(file(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// The study with one wrong coefficient in the solver.
fn defective(name: &str, coefficient: &str) -> Vibration {
    let text = format!("{}\n[control]\n{coefficient}\n", text(name));
    Vibration::parse(&text, name.as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn refused(change: impl Fn(String) -> String, message: &str) {
    let error = Vibration::parse(&change(text("vibration-time.toml")), "v.toml".as_ref())
        .expect_err(message)
        .to_string();
    assert!(error.contains(message), "{error}");
}

#[test]
fn every_file_passes_but_not_without_each_case() {
    for name in FILES {
        let study = study(name);
        let sound = passes_but_not_without_each_case(&study);
        let unmeasured = changed::<Vibration>(&sound, |_, found| found.closed_form = None);
        let isolates_time = matches!(name, "vibration-time.toml" | "vibration-midpoint.toml");
        let verdict = if isolates_time {
            Verdict::Fail
        } else {
            Verdict::Pass
        };
        assert_eq!(
            study.judge(&unmeasured).verdict,
            verdict,
            "{name} without a closed form"
        );
    }
}

#[test]
fn a_solver_whose_zeta_is_off_by_a_thousandth_fails_wherever_one_error_is_isolated() {
    for name in &FILES[..3] {
        let outcome = run_one(&defective(name, "zeta = 0.1001"));
        assert_eq!(
            outcome.verdict,
            Verdict::Fail,
            "{name}: {}",
            report(&outcome)
        );
    }
}

#[test]
fn every_coefficient_that_must_be_zero_is_seen() {
    for coefficient in ["a = 1e-4", "rho = 1e-4", "beta = 1e-4", "theta_a = 1e-4"] {
        assert_eq!(
            run_one(&defective("vibration-time.toml", coefficient)).verdict,
            Verdict::Fail,
            "{coefficient}"
        );
    }
}

#[test]
fn each_norm_can_fail() {
    let study = study("vibration-space.toml");
    let sound = study.run_here();
    for norm in Norm::ALL {
        let verdict = |change: &dyn Fn(usize, f64) -> f64| {
            let planted = changed::<Vibration>(&sound, |case, found| {
                found.errors[norm] = change(case, found.errors[norm]);
            });
            study.judge(&planted).verdict
        };
        let name = norm.name();
        assert_eq!(verdict(&|_, error| error), Verdict::Pass);
        assert_eq!(
            verdict(&|case, error| if case == 2 { f64::NAN } else { error }),
            Verdict::Fail,
            "{name} NaN"
        );
        assert_eq!(
            verdict(&|_, error| error + 1e-3),
            Verdict::Fail,
            "{name} levels off"
        );
        assert_eq!(
            verdict(&|case, error| error * 2f64.powi(case as i32)),
            Verdict::Fail,
            "{name} too slow"
        );
        assert_eq!(
            verdict(&|case, error| error * 0.5f64.powi(case as i32)),
            Verdict::Fail,
            "{name} too fast"
        );
        assert_ne!(
            verdict(&|case, error| if case == 5 { 1.2 * error } else { error }),
            Verdict::Pass,
            "{name} scatter"
        );
    }
}

#[test]
fn the_closed_form_can_fail() {
    let study = study("vibration-midpoint.toml");
    let sound = study.run_here();
    for deviation in [1e-10, f64::NAN] {
        let planted = changed::<Vibration>(&sound, |case, found| {
            if case == 1 {
                found.closed_form = Some(deviation);
            }
        });
        assert_eq!(study.judge(&planted).verdict, Verdict::Fail);
    }
}

#[test]
fn a_file_that_makes_no_sense_is_refused_where_it_does_not() {
    refused(
        |text| text.replace("a = 0.0", "a = 0.1"),
        "beam.a: found 0.1",
    );
    refused(
        |text| text.replace("rho = 0.0\n", ""),
        "beam.rho: found 1.0",
    );
    refused(
        |text| text.replace("index = 2", "index = 17"),
        "found 17; expected a whole number >= 1 and <= 16",
    );
    refused(
        |text| text.replace("amplitude = 0.1", "amplitude = 0.0"),
        "a mode that does not move",
    );
    refused(
        |text| text.replace("[[mode]]", "[[modes]]"),
        "unknown key `modes`, did you mean `mode`?",
    );
    refused(|text| text.replace("isolate", "isolated"), "isolated");
    refused(
        |text| text.replace("zeta = 0.1", "zeta = -0.1"),
        "beam.zeta",
    );
}
