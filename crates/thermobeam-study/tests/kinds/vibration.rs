use super::planted::{Change, defects, each_fails, verdict_of};
use super::typed::{changed, passes_but_not_without_each_case};
use super::{parsed, read, text};
use convergence_study::{Kind, Verdict, run_one};
use thermobeam_study::exact::norm::Norm;
use thermobeam_study::kinds::orders::{Orders, vibration};

type Vibration = Orders<vibration::Vibration>;

const FILES: [&str; 4] = [
    "vibration-space.toml",
    "vibration-time.toml",
    "vibration-midpoint.toml",
    "vibration-coupled.toml",
];

/// The verdict on the study with one wrong coefficient in the solver.
fn defective(name: &str, coefficient: &str) -> Verdict {
    let text = format!("{}\n[control]\n{coefficient}\n", text(name));
    run_one(&parsed::<Vibration>(&text)).verdict
}

#[test]
fn every_file_passes_but_not_without_each_case() {
    for name in FILES {
        let study = read::<Vibration>(name);
        let sound = passes_but_not_without_each_case(&study);
        let unmeasured = changed::<Vibration>(&sound, |_, found| found.closed_form = None);
        let isolates_time = matches!(name, "vibration-time.toml" | "vibration-midpoint.toml");
        let verdict = study.judge(&unmeasured).verdict;
        assert_eq!(
            verdict == Verdict::Fail,
            isolates_time,
            "{name} without a closed form"
        );
    }
}

#[test]
fn a_wrong_coefficient_is_seen_wherever_one_error_is_isolated() {
    for name in &FILES[..3] {
        assert_eq!(defective(name, "zeta = 0.1001"), Verdict::Fail, "{name}");
    }
    // Those that must be zero.
    for coefficient in ["a = 1e-4", "rho = 1e-4", "beta = 1e-4", "theta_a = 1e-4"] {
        let verdict = defective("vibration-time.toml", coefficient);
        assert_eq!(verdict, Verdict::Fail, "{coefficient}");
    }
}

#[test]
fn each_norm_can_fail() {
    let study = read::<Vibration>("vibration-space.toml");
    let sound = study.run_here();
    for norm in Norm::ALL {
        let verdict =
            |change: Change| verdict_of(&study, &sound, |found| &mut found.errors[norm], change);
        let defects: [(&str, Change); 4] = [
            (
                "not finite",
                |case, error| if case == 2 { f64::NAN } else { error },
            ),
            ("levels off", |_, error| error + 1e-3),
            ("too slow", |case, error| error * 2f64.powi(case as i32)),
            ("too fast", |case, error| error * 0.5f64.powi(case as i32)),
        ];
        for (what, defect) in defects {
            assert_eq!(verdict(defect), Verdict::Fail, "{} {what}", norm.name());
        }
        assert_eq!(verdict(|_, error| error), Verdict::Pass);
        let scatter = verdict(|case, error| if case == 5 { 1.2 * error } else { error });
        assert_ne!(scatter, Verdict::Pass, "{}", norm.name());
    }
}

#[test]
fn the_closed_form_can_fail() {
    let study = read::<Vibration>("vibration-midpoint.toml");
    let sound = study.run_here();
    each_fails(
        &study,
        &sound,
        1,
        defects!(|found| [
            found.closed_form = Some(1e-10),
            found.closed_form = Some(f64::NAN),
        ]),
    );
}
