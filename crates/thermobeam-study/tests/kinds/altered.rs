//! Studies of the repository with a piece of their file replaced, and what they find.

use super::*;

/// The verdict, how many rates have each, and the claims that fail.
fn in_words(outcome: &Outcome) -> String {
    let rates = |verdict: Verdict| {
        let rates = outcome.rates.iter();
        rates.filter(|named| named.rate.verdict == verdict).count()
    };
    let [pass, fail] = [Verdict::Pass, Verdict::Fail].map(rates);
    let failed = failed(outcome);
    format!(
        "{}; rates: {pass} pass, {fail} fail; claims: {} fail: {}.",
        outcome.verdict,
        failed.len(),
        failed.join(" | ")
    )
}

#[test]
fn a_study_with_another_file_finds_what_is_wrong_with_it() {
    each_is_refused(include_str!("altered.txt"), |case| {
        let sound = text(case.kind);
        let altered = sound.replace(&case.old, &case.new);
        assert_ne!(altered, sound, "{case:?}");
        let study = KindRow::parse_any(&KINDS, &altered, &file("altered.toml"));
        let study = study.unwrap_or_else(|error| panic!("{error}"));
        let plan = study.plan();
        (0..plan.cases().len()).for_each(|run| plan.run(run));
        while let Some(run) = plan.more() {
            plan.run(run);
        }
        in_words(&plan.judge())
    });
}
