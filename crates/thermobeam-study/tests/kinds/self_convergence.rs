use crate::{changed, file, passes_but_not_without_each_case, report, results, text};
use convergence_study::judge::verdict::Verdict;
use thermobeam_study::kinds::self_convergence::SelfConvergence;
use thermobeam_study::kinds::{FromFile, Study};

const FILES: [&str; 2] = ["reference-space.toml", "reference-time.toml"];

fn parse(name: &str, change: impl Fn(String) -> String) -> SelfConvergence {
    let name = file(name);
    let text = std::fs::read_to_string(&name).expect("a file");
    SelfConvergence::parse(&change(text), &name).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn quick_files_pass_but_not_without_each_case() {
    FILES.iter().for_each(|name| passes_but_not_without_each_case(&parse(name, |text| text)));
}

#[test]
fn every_file_can_be_read() {
    for name in ["reference-midpoint", "reference-1-space", "reference-1-time", "reference-2-space", "reference-3-time"]
    {
        assert_eq!(parse(&format!("{name}.toml"), |text| text).header().id, name);
    }
}

#[test]
fn each_quantity_can_fail() {
    let study = parse("reference-space.toml", |text| text);
    let sound = results(&study);
    let h = |case: usize| if case == 5 { 0.0 } else { 0.1 * 0.5f64.powi(case as i32) };
    for name in ["tip 3", "rotation 10", "energy 1"] {
        let verdict = |change: &dyn Fn(usize, f64) -> f64| study.conclude(&changed(&sound, name, change)).verdict;
        assert_eq!(verdict(&|_, value| value), Verdict::Pass);
        assert_eq!(verdict(&|case, value| if case == 1 { f64::NAN } else { value }), Verdict::Fail, "{name}");
        assert_eq!(verdict(&|case, value| value + 100.0 * h(case)), Verdict::Fail, "{name}: first order");
        assert_ne!(verdict(&|case, value| value + if case == 4 { 0.1 } else { 0.0 }), Verdict::Pass, "{name}");
    }
}

#[test]
fn the_functions_themselves_can_fail() {
    let study = parse("reference-space.toml", |text| text);
    let sound = results(&study);
    for field in ["u 2", "v 5", "phi 7", "w 10", "theta 1"] {
        for defect in [f64::NAN, 0.5] {
            let mut planted = sound.clone();
            let measured = planted[4].as_mut().expect("a result");
            let curve = measured.series.iter_mut().find(|(name, _)| name == field).expect("a field");
            curve.1[7].1 += defect;
            assert_ne!(study.conclude(&planted).verdict, Verdict::Pass, "{field} {defect}");
        }
    }
}

#[test]
fn a_tip_that_stays_free_is_no_study_of_contact() {
    let study = parse("reference-time.toml", |text| text);
    let sound = results(&study);
    let free = changed(&changed(&sound, "tip min", |_, _| -0.009), "tip max", |_, _| 0.09);
    let outcome = study.conclude(&free);
    assert_eq!(outcome.verdict, Verdict::Fail, "{}", report(&outcome));
}

#[test]
fn an_order_that_the_scheme_has_not_fails() {
    let study = parse("reference-time.toml", |text| text.replace("order = 1.0", "order = 2.0"));
    let outcome = study.conclude(&results(&study));
    assert_eq!(outcome.verdict, Verdict::Fail);
    assert!(outcome.rates.iter().all(|(_, rate)| rate.verdict == Verdict::Fail), "{}", report(&outcome));
}

#[test]
fn what_is_shown_but_not_claimed_decides_nothing() {
    let study = parse("reference-space.toml", |text| text);
    let planted = changed(&results(&study), "tip max", |case, value| value + 0.1 * case as f64);
    assert_eq!(study.conclude(&planted).verdict, Verdict::Pass);
}

#[test]
fn a_file_that_makes_no_sense_is_refused() {
    for (from, to, message) in [
        ("[10, 20,", "[10, 25,", "a multiple of 10, the level before"),
        ("reference = 1280", "reference = 200", "a multiple of 160"),
        ("samples = 10", "samples = 7", "a multiple of samples = 7"),
        ("paper-1-beta-0", "paper-1-beta-00", "scene.file: found the text"),
        ("quantity = \"tip\"", "quantity = \"tips\"", "did you mean \"tip\"?"),
        ("axis = \"space\"", "axis = \"both\"", "refine.axis"),
    ] {
        let name = file("reference-space.toml");
        let changed = text("reference-space.toml").replace(from, to);
        let error = SelfConvergence::parse(&changed, &name).expect_err(to).to_string();
        assert!(error.contains(message), "{error}");
    }
}
