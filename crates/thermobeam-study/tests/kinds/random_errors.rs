use convergence_study::{FromFile, Kind, Verdict, internal::study::kind::run_cases_here};
use thermobeam_study::kinds::random_errors::{AbandonedSearch, PredictedErrors, ROW, RandomErrors};

use super::refused::refusal;
use super::text;
use super::typed::{changed, leaves_one_out, passes_but_not_without_each_case};

/// Two scenes of the file and a rough one; for one of them linear elements are compared too.
fn study() -> RandomErrors {
    let small = text("random-errors.toml")
        .replace("scenes = 10", "scenes = 2")
        .replace("rough = 3", "rough = 1");
    RandomErrors::parse(&small, "small.toml".as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

fn abandoned(is_of_features: bool) -> AbandonedSearch {
    AbandonedSearch {
        words: "given up".to_owned(),
        is_of_features,
    }
}

#[test]
fn a_part_of_the_file_passes_and_each_check_can_fail() {
    let study = study();
    passes_but_not_without_each_case(&study);
    let sound = run_cases_here(&study);
    let verdict = |change: &dyn Fn(&mut PredictedErrors)| {
        let planted = changed::<RandomErrors>(&sound, |case, found| {
            if case == 0 {
                change(found);
            }
        });
        study.judge(&planted).verdict
    };
    assert_eq!(verdict(&|_| ()), Verdict::Pass);
    for wrong in [1.31, f64::NAN] {
        assert_eq!(
            verdict(&|found| found.over_estimate = wrong),
            Verdict::Fail,
            "{wrong}"
        );
        assert_eq!(
            verdict(&|found| found.over_target = wrong),
            Verdict::Fail,
            "{wrong}"
        );
        assert_eq!(
            verdict(&|found| found.over_norm_target = wrong),
            Verdict::Fail,
            "{wrong}"
        );
        assert_eq!(
            verdict(&|found| found.linear = Some([1e-3 * wrong, 1e-3])),
            Verdict::Fail,
            "{wrong}"
        );
    }
    for may_be_refused in [false, true] {
        let refuse = |is_of_features: bool| {
            let refused = vec![abandoned(is_of_features)];
            verdict(&|found| {
                (found.refused, found.may_be_refused) = (refused.clone(), may_be_refused);
            })
        };
        assert_eq!(refuse(false), Verdict::Fail);
        let expected = if may_be_refused {
            Verdict::Pass
        } else {
            Verdict::Fail
        };
        assert_eq!(refuse(true), expected);
    }
    let items = ["searches", "refused with a reason"];
    leaves_one_out(&study, &sound, 0, items, |found| {
        found.refused = vec![abandoned(false)];
    });
    assert_eq!(
        verdict(&|found| found.linear = None),
        Verdict::Fail,
        "no linear elements at all"
    );
}

#[test]
fn unusable_files_are_refused() {
    for (from, to, field) in [
        ("scenes = 10", "scenes = 0", "random-errors.scenes"),
        (
            "\ntargets = [1e-4, 1e-6]",
            "\ntargets = [0.0]",
            "random-errors.targets",
        ),
        (
            "\ntargets = [1e-4, 1e-6]",
            "\ntargets = []",
            "random-errors.targets",
        ),
        (
            "norm_targets = [1e-2, 1e-3]\n",
            "",
            "random-errors.norm_targets",
        ),
        ("rough = 3", "rough = -3", "random-errors.rough"),
        (
            "seed = 1",
            "seed = 1\n[[case]]\nname = \"one\"\nends = 3\n",
            "ends",
        ),
        ("seed = 1", "seed = -1", "random-errors.seed"),
        ("refined = 5\n", "", "random-errors.refined"),
        ("seed = 1", "seed = 1\nsize = 2", "size"),
    ] {
        let error = refusal(&ROW, "random-errors.toml", from, to);
        assert!(error.contains(field), "{to}: {error}");
    }
}
