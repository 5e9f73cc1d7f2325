use super::planted::{Change, verdict_of};
use super::typed::{changed, passes_but_not_without_each_case};
use super::{parsed, read, text};
use convergence_study::{Kind, Verdict, run_one};
use thermobeam_study::kinds::orders::{Orders, frequencies};

type Frequencies = Orders<frequencies::Frequencies>;

#[test]
fn a_graded_mesh_passes_but_not_without_each_case() {
    let map = "map = \"s + 0.1*sin(2*pi*s)\"\norder = 2.0";
    let graded = text("frequencies.toml").replace("order = 2.0", map);
    passes_but_not_without_each_case(&parsed::<Frequencies>(&graded));
}

#[test]
fn elements_of_higher_degree_have_twice_their_degree_as_order_and_no_other() {
    for degree in 2..=4 {
        let name = format!("frequencies-{degree}.toml");
        passes_but_not_without_each_case(&read::<Frequencies>(&name));
        // The same meshes with elements of a lower degree.
        let lower = format!("degree = {}\n", degree - 1);
        let lower = text(&name).replace(&format!("degree = {degree}\n"), &lower);
        let outcome = run_one(&parsed::<Frequencies>(&lower));
        let mut rates = outcome.rates.iter();
        assert!(
            rates.all(|named| named.rate.verdict != Verdict::Pass),
            "{degree}"
        );
    }
}

#[test]
fn a_frequency_below_the_first_that_is_judged_can_fail() {
    let study: Frequencies = read("frequencies-4.toml");
    let sound = study.run_here();
    for by in [1e-6, -1e-6, f64::NAN] {
        let verdict = verdict_of(
            &study,
            &sound,
            |found| &mut found[0],
            |_, omega| omega * (1.0 + by),
        );
        assert_eq!(verdict, Verdict::Fail, "{by}");
    }
}

#[test]
fn each_frequency_can_fail() {
    let study: Frequencies = read("frequencies.toml");
    let sound = passes_but_not_without_each_case(&study);
    for mode in 0..8 {
        let verdict = |change: Change| verdict_of(&study, &sound, |found| &mut found[mode], change);
        let nan = verdict(|case, omega| if case == 0 { f64::NAN } else { omega });
        let below = verdict(|case, omega| if case == 4 { omega - 1e-2 } else { omega });
        assert_eq!([nan, below], [Verdict::Fail; 2], "mode {mode}");
        // Convergence to a wrong frequency.
        assert_ne!(
            verdict(|_, omega| omega + 1e-3),
            Verdict::Pass,
            "mode {mode}"
        );
    }
    let short = changed::<Frequencies>(&sound, |case, found| {
        found.truncate(if case == 2 { 7 } else { 8 });
    });
    assert_eq!(
        study.judge(&short).verdict,
        Verdict::Fail,
        "a frequency is missing"
    );
}
