//! Steady states with enclosures.

use super::*;
use convergence_study_tests::transcript::place;

/// Of the scenes at the head of the transcript; a state without an enclosure is not proved.
#[test]
fn a_state_that_is_proved_has_a_narrow_enclosure() {
    let folder = Folder(place(include_str!("../transcripts/equilibria.md")));
    for name in ["beam", "fold", "touching", "lift-off"] {
        let (_, value) = folder.json(&format!("equilibria {name}.toml"));
        let is_proved = name == "beam";
        assert_eq!(value["proved"], is_proved, "{name}");
        let undecided = value["undecided"].as_array().expect("a list");
        assert_eq!(undecided.is_empty(), is_proved, "{value}");
        for state in value["equilibria"].as_array().expect("a list") {
            if state["n_enclosure"].is_null() {
                assert_eq!((is_proved, &state["proved"]), (false, &false.into()));
                continue;
            }
            let [lo, n, hi] =
                ["/n_enclosure/0", "/n_value", "/n_enclosure/1"].map(|path| number(state, path));
            let is_inside = lo - 1e-12 <= n && n <= hi + 1e-12;
            assert!(is_inside && hi - lo < 1e-12, "{state}");
        }
    }
}
