use thermobeam_study::kinds::orders::vibration;

use super::*;

type Vibration = Orders<vibration::Vibration>;

#[test]
fn every_file_passes_but_not_without_each_case() {
    for (name, isolates_time) in [
        ("vibration-space.toml", false),
        ("vibration-time.toml", true),
        ("vibration-midpoint.toml", true),
        ("vibration-coupled.toml", false),
    ] {
        let sound = Sound::checked(read::<Vibration>(name));
        let verdict = sound.with(|_, found| found.closed_form = None).verdict;
        let fails = verdict == Verdict::Fail;
        assert_eq!(fails, isolates_time, "{name} without a closed form");
    }
}

#[test]
fn each_norm_can_fail() {
    let sound = Sound::run(read::<Vibration>("vibration-space.toml"));
    let defects: Named<fn(usize, f64) -> f64, 4> = [
        ("not finite", |case, error| {
            error * if case == 2 { f64::NAN } else { 1.0 }
        }),
        ("levels off", |_, error| error + 1e-3),
        ("too slow", |case, error| error * 2f64.powi(case as i32)),
        ("too fast", |case, error| error * 0.5f64.powi(case as i32)),
    ];
    for norm in Norm::ALL {
        for (what, defect) in defects {
            let verdict = sound.verdict_of(|found| &mut found.errors[norm], defect);
            assert_eq!(verdict, Verdict::Fail, "{} {what}", norm.name());
        }
        let scatter = sound.at(5, |found| found.errors[norm] *= 1.2);
        assert_ne!(scatter.verdict, Verdict::Pass, "{}", norm.name());
    }
}
