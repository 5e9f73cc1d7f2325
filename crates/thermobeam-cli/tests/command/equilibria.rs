use super::*;

/// The paper's beam between its obstacles at β, with the `[time]` table that a scene must have.
fn scene(beta: f64) -> String {
    format!("[beam]\nbeta = {beta:?}\n[obstacles]\n[time]\ndt = 0.1\nt_end = 1\n")
}

/// What the command answers about a scene: the text, and the object of JSON.
fn answers(folder: &Folder, name: &str, scene: &str) -> (String, Value) {
    folder.file(&format!("{name}.toml"), scene);
    let line = format!("equilibria {name}.toml");
    (folder.ended(&line).stdout, folder.json(&line).1)
}

const TIME: &str = "[time]\ndt = 0.1\nt_end = 1\n";

/// A heated beam.
fn hot(beta: f64, obstacles: &str) -> String {
    let beam = format!("[beam]\nbeta = {beta:?}\na = 0.5\ntheta_a = 2.0\n{obstacles}");
    format!("{beam}[initial]\ntheta = \"2*(1-x)\"\n{TIME}")
}

fn cold(beta: f64) -> String {
    format!("[beam]\nbeta = {beta:?}\n{TIME}")
}

#[test]
fn a_list_is_called_complete_where_it_is() {
    let folder = Folder::new();
    let infinite = "Not all: infinitely many";
    for (name, scene, states, complete, said) in [
        // One state although beta = -1: no beam with a heated end has a slope so small.
        ("one", hot(-1.0, ""), Some(1), true, ""),
        // The obstacles exclude the free states near u(1) = -1.
        ("held", hot(-4.0, "[obstacles]\n"), None, true, ""),
        // Of 37 states 33 are listed.
        ("few", cold(-0.9997), Some(33), false, "Perhaps not all"),
        ("many", hot(-4.0, ""), None, false, infinite),
        ("straight", cold(-1.0), Some(33), false, infinite),
        ("crushed", scene(-1.5), None, false, "Not all"),
    ] {
        let (text, value) = answers(&folder, name, &scene);
        assert_eq!(text.contains("ot all"), !complete, "{name}: {text}");
        assert!(text.contains(said), "{name}: {text}");
        assert_eq!(value["complete"], complete, "{name}");
        let count = value["equilibria"].as_array().expect("a list").len();
        assert_eq!(count, states.unwrap_or(count), "{name}");
    }
}

/// Each state has an enclosure that is narrow, or is not proved.
#[track_caller]
fn encloses_what_it_proves(value: &Value) {
    let is_proved = value["proved"] == true;
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

#[test]
fn each_state_is_proved_with_an_enclosure_or_inconclusive_with_a_reason() {
    let folder = Folder::new();
    let (text, value) = answers(&folder, "buckled", &scene(-0.8));
    let all = "Proved: 3 steady states, and no other.";
    assert!(text.contains(all) && value["proved"] == true, "{text}");
    encloses_what_it_proves(&value);
    let free =
        format!("[beam]\nbeta = 0.5\ntheta_a = 20.0\n[initial]\ntheta = \"20*(1-x)\"\n{TIME}");
    let (text, value) = answers(&folder, "free", &free);
    assert!(
        value["verdict"] == "pass" && value["complete"] == true,
        "{value}"
    );
    let start = "free: one steady state, 1 of them stable, ";
    assert!(text.starts_with(start), "{text}");
    // An obstacle exactly at the tip.
    let tip = number(&value, "/equilibria/0/u_tip");
    let touching = format!("[obstacles]\ng2 = {tip:?}\n{free}");
    // The double next to the β at which two states meet.
    let fold = format!(
        "[beam]\nbeta = -1.0216245463878471\nrho = 1.0\na = 1.0\ntheta_a = 0.25\n\
         [initial]\ntheta = \"0.25*(1-x)\"\n{TIME}"
    );
    // At the lift-off of the heated beam no enclosure tells contact from none.
    let lift_off = format!("[obstacles]\n{free}").replace("0.5", "0.08325920350093916");
    let reason = "u(1) cannot be told from";
    for (name, scene, reason) in [
        ("fold", fold, "two states cannot be told from one or none"),
        ("touching", touching, reason),
        ("lift-off", lift_off, reason),
    ] {
        let (text, value) = answers(&folder, name, &scene);
        encloses_what_it_proves(&value);
        assert_eq!(value["verdict"], "inconclusive", "{name}: {value}");
        for key in ["complete", "proved"] {
            assert_eq!(value[key], false, "{name}: {value}");
        }
        let headline = format!("{name}: the number of steady states is undecided, for beta = ");
        assert!(
            text.starts_with(&headline) && text.contains(reason),
            "{text}"
        );
        for flags in ["", "-q", "--format json"] {
            let ended = folder.ended(&format!("equilibria {name}.toml {flags}"));
            ended.says(1, "");
            let said = ended.stdout.replace("steady states is undecided,", "");
            let has_count = said.contains("steady states,") || said.contains("one steady state");
            assert!(!has_count, "{name}: {said}");
        }
    }
}
