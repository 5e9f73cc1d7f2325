//! Floors that are offered, and samples.

use convergence_judge::random::SplitMix;
use convergence_study::rates::{Choice, NotJudged, Request};
use convergence_study::{Of, Verdict};

use super::{Page, answer, chosen, request, says};

fn halved(levels: i32) -> impl Iterator<Item = f64> {
    (1..=levels).map(|k| 0.5_f64.powi(k))
}

fn plain() -> Request {
    request(&["6"], Choice::default())
}

#[test]
fn a_floor_is_offered_by_a_command_which_passes_and_none_above_a_wrong_limit() {
    let mut random = SplitMix::new(75);
    // Errors of order 6 down to round-off, or to a wrong limit.
    let mut page = |limit: f64, scale| {
        let mut error = |h: f64| (0.3 * h.powi(6) + limit + 4e-16 * random.normal()).abs();
        let rows = halved(10).map(|h| format!("{h},{:.6e}\n", error(h)));
        let text = "h,L2\n".to_owned() + &rows.collect::<String>();
        let claims = Request { scale, ..plain() };
        let page = Page::of(&text, &claims).expect("a table");
        (text, page)
    };
    for _ in 0..40 {
        let (text, found) = page(0.0, None);
        assert_eq!(found.verdict, Verdict::Inconclusive, "{}", found.text);
        let of_size = "round-off, if the solution is of size 1";
        let offer = found.text.split_once("rates FILE --order 6 --floor ");
        let (words, floor) = offer.expect("a command");
        assert!(words.contains(of_size), "{words}");
        let floor = floor.lines().next().and_then(|floor| floor.parse().ok());
        let with_floor = Request {
            floor: floor.expect("a floor"),
            ..plain()
        };
        says(Page::of(&text, &with_floor).ok(), true, "");
        // A small solution is no round-off.
        for (limit, scale) in [(0.0, Some(1e-9)), (1e-10, None), (1e-8, None)] {
            let (_, found) = page(limit, scale);
            let is_offered = found.text.contains("--floor");
            assert!(!found.verdict.is_pass() && !is_offered, "{}", found.text);
        }
    }
}

/// Rows of samples: `numbers` of each of five halved steps.
fn samples(count: usize, mut number: impl FnMut(f64) -> f64) -> String {
    let mut text = "h,seed,error\n".to_owned();
    for h in halved(5) {
        for seed in 0..count {
            text += &format!("{h},{seed},{:.6e}\n", number(h));
        }
    }
    text
}

/// The page of samples whose errors are made this way.
fn sampled(text: &str, of: Of, order: &str) -> Option<Page> {
    chosen(text, &[order], of_samples(of)).ok()
}

fn of_samples(of: Of) -> Choice {
    Choice {
        samples: Some(of),
        ..Choice::default()
    }
}

#[test]
fn rows_with_equal_steps_are_samples_where_the_caller_says_so() {
    let mut random = SplitMix::new(3);
    let text = samples(30, |h| h * (1.0 + 0.2 * random.normal()));
    assert!(answer(&text, &["1"]).is_none());
    for words in [
        "`seed` (numbers of the samples)",
        "the mean of 30 rows at each step",
    ] {
        says(sampled(&text, Of::Mean, "1"), true, words);
    }
    says(sampled(&text, Of::Mean, "1.5"), false, "");
    says(sampled(&text, Of::RootMeanSquare, "1"), true, "");
    // Numbers that do not depend on their seed, too few rows of a step, and one that failed.
    let equal = sampled(&samples(30, |h| h), Of::Mean, "1");
    says(equal, false, "samples of level 1 are equal");
    assert!(sampled(&samples(9, |h| h), Of::Mean, "1").is_none());
    let mut lines: Vec<&str> = text.lines().collect();
    lines.remove(30);
    says(sampled(&lines.join("\n"), Of::Mean, "1"), true, "");
    let (first, _) = lines[40].rsplit_once(',').expect("a row");
    for word in ["nan", "diverged", "-1.0e-3", ""] {
        let broken = lines
            .join("\n")
            .replace(lines[40], &format!("{first},{word}"));
        says(sampled(&broken, Of::Mean, "1"), false, "");
    }
}

/// An old and a new run in one file.
#[test]
fn a_sample_that_stands_twice_at_a_step_is_refused() {
    let mut random = SplitMix::new(5);
    let text = samples(30, |h| h * (1.0 + 0.2 * random.normal()));
    let again = text.clone() + text.split_once('\n').expect("names").1;
    let Err(NotJudged::Table { error, .. }) = chosen(&again, &["1"], of_samples(Of::Mean)) else {
        panic!("the table is read");
    };
    let expected = "expected each `seed` once at each step, found `0` twice";
    assert!(error.to_string().contains(expected), "{error}");
    // A column that numbers paths within a seed tells them apart.
    let rows = text.lines().enumerate().map(|(k, line)| match k {
        0 => format!("{line},path\n{line},path\n"),
        _ => format!("{line},1\n{line},2\n"),
    });
    let paths: String = rows.collect();
    let paths = paths.split_once('\n').expect("names").1;
    says(sampled(paths, Of::Mean, "1"), true, "");
}

#[test]
fn a_weak_error_is_the_size_of_a_mean_and_a_lost_level_says_how_many_samples_would_do() {
    let mut random = SplitMix::new(4);
    let mut signed = |scatter: f64| samples(900, |h| -h * h * (1.0 + scatter * random.normal()));
    let text = signed(0.5);
    says(sampled(&text, Of::Weak, "2"), true, "");
    says(sampled(&text, Of::Mean, "2"), false, "");
    says(
        sampled(&signed(40.0), Of::Weak, "2"),
        false,
        "samples would",
    );
}
