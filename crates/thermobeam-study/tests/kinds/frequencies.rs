use thermobeam_study::kinds::orders::frequencies;

use super::*;

type Frequencies = Orders<frequencies::Frequencies>;

#[test]
fn a_graded_mesh_passes_but_not_without_each_case() {
    let map = "map = \"s + 0.1*sin(2*pi*s)\"\norder = 2.0";
    let graded = text("frequencies.toml").replace("order = 2.0", map);
    Sound::checked(parsed::<Frequencies>(&graded));
}

#[test]
fn a_frequency_below_the_first_that_is_judged_can_fail() {
    let sound = Sound::run(read::<Frequencies>("frequencies-4.toml"));
    for by in [1e-6, -1e-6, f64::NAN] {
        let verdict = sound.verdict_of(|found| &mut found[0], |_, omega| omega * (1.0 + by));
        assert_eq!(verdict, Verdict::Fail, "{by}");
    }
}

#[test]
fn each_frequency_can_fail() {
    let sound = Sound::checked(read::<Frequencies>("frequencies.toml"));
    for mode in 0..8 {
        let [nan, below] = [(0, f64::NAN), (4, -1e-2)].map(|(case, by)| {
            let moved = sound.at(case, |found| found[mode] += by);
            moved.verdict
        });
        assert_eq!([nan, below], [Verdict::Fail; 2], "mode {mode}");
        // Convergence to a wrong frequency.
        let wrong = sound.verdict_of(|found| &mut found[mode], |_, omega| omega + 1e-3);
        assert_ne!(wrong, Verdict::Pass, "mode {mode}");
    }
    let short = sound.at(2, |found| found.truncate(7));
    assert_eq!(short.verdict, Verdict::Fail, "a frequency is missing");
}
