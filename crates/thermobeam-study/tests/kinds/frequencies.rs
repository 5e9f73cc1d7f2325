use super::typed::{changed, passes_but_not_without_each_case};
use super::{file, text};
use convergence_study::{FromFile, Kind, Verdict, run_one};
use thermobeam_study::kinds::orders::{Orders, frequencies};

type Frequencies = Orders<frequencies::Frequencies>;

fn study() -> Frequencies {
    Frequencies::read(file("frequencies.toml")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_file_passes_but_not_without_each_case() {
    passes_but_not_without_each_case(&study());
    let graded = text("frequencies.toml")
        .replace("order = 2.0", "map = \"s + 0.1*sin(2*pi*s)\"\norder = 2.0");
    passes_but_not_without_each_case(
        &Frequencies::parse(&graded, "graded.toml".as_ref()).expect("a study"),
    );
}

#[test]
fn elements_of_higher_degree_have_twice_their_degree_as_order_and_no_other() {
    for degree in 2..=4 {
        let text = text(&format!("frequencies-{degree}.toml"));
        let parse = |text: &str| Frequencies::parse(text, "f.toml".as_ref()).expect("a study");
        passes_but_not_without_each_case(&parse(&text));
        // The same meshes with elements of a lower degree.
        let lower = text.replace(
            &format!("degree = {degree}\n"),
            &format!("degree = {}\n", degree - 1),
        );
        let outcome = run_one(&parse(&lower));
        assert!(
            lower != text
                && outcome
                    .rates
                    .iter()
                    .all(|named| named.rate.verdict != Verdict::Pass),
            "{degree}"
        );
    }
}

#[test]
fn a_frequency_below_the_first_that_is_judged_can_fail() {
    let study =
        Frequencies::read(file("frequencies-4.toml")).unwrap_or_else(|error| panic!("{error}"));
    let sound = study.run_here();
    for by in [1e-6, -1e-6, f64::NAN] {
        let planted = changed::<Frequencies>(&sound, |_, found| found[0] *= 1.0 + by);
        assert_eq!(study.judge(&planted).verdict, Verdict::Fail, "{by}");
    }
}

#[test]
fn each_frequency_can_fail() {
    let study = study();
    let sound = study.run_here();
    for mode in 0..8 {
        let verdict = |change: &dyn Fn(usize, f64) -> f64| {
            let planted = changed::<Frequencies>(&sound, |case, found| {
                found[mode] = change(case, found[mode]);
            });
            study.judge(&planted).verdict
        };
        assert_eq!(verdict(&|_, omega| omega), Verdict::Pass);
        assert_eq!(
            verdict(&|case, omega| if case == 0 { f64::NAN } else { omega }),
            Verdict::Fail
        );
        assert_eq!(
            verdict(&|case, omega| if case == 4 { omega - 1e-2 } else { omega }),
            Verdict::Fail,
            "from below"
        );
        // Convergence to a wrong frequency.
        assert_ne!(
            verdict(&|_, omega| omega + 1e-3),
            Verdict::Pass,
            "mode {}",
            mode + 1
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

#[test]
fn a_file_that_makes_no_sense_is_refused() {
    for (from, to, message) in [
        ("[16, 32", "[32, 16", "frequencies.elements"),
        ("count = 8", "count = 17", "<= 16"),
        ("order = 2.0", "order = -2.0", "frequencies.order"),
        ("count = 8", "count = 8\nfirst = 9", "frequencies.first"),
        ("count = 8", "count = 8\ndegree = 0", "frequencies.degree"),
        ("count = 8", "count = 8\ndegree = 41", "frequencies.degree"),
        (
            "count = 8",
            "count = 8\nmap = \"s^2 - 1\"",
            "frequencies.map",
        ),
    ] {
        let error = Frequencies::parse(
            &text("frequencies.toml").replace(from, to),
            "f.toml".as_ref(),
        )
        .expect_err(to)
        .to_string();
        assert!(error.contains(message), "{error}");
    }
}
