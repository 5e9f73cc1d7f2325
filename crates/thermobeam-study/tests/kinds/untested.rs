//! Laws about what a manufactured solution does not test.

use super::*;

#[test]
fn what_a_solution_does_not_test_is_named_with_the_reason() {
    each_is_refused(include_str!("untested.txt"), |case| {
        let whole = match case.kind.split(':').next() {
            Some("own.toml") => include_str!("own.toml").to_owned(),
            _ => text(case.kind),
        };
        let altered = match &*case.old {
            "" => whole,
            old => {
                assert!(whole.contains(old), "{case:?}");
                whole.replace(old, &case.new)
            }
        };
        let untested = parsed::<Orders<Convergence>>(&altered).untested();
        let all = untested
            .iter()
            .map(|one| format!("{}: {}", one.what, one.why));
        let all: Vec<String> = all.collect();
        format!("{} untested: {}.", all.len(), all.join(" | "))
    });
}
