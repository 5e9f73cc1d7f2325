//! `run` of scenes with `scheme = "dg"`.

use super::{Folder, keys, number};

/// The paper's first experiment at β = 0 over [0, 0.5], with the given lines in `[mesh]` and
/// `[time]`.
pub(crate) fn thrown(mesh: &str, time: &str) -> String {
    format!(
        "[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n\
         [mesh]\n{mesh}\n[time]\nscheme = \"dg\"\nt_end = 0.5\n{time}\n"
    )
}

/// Keys of the object of any scene of any order.
const CONTRACT: &str = "schema verdict scene elements steps dt t_end iterations total max wall_seconds \
    final t u_tip phi_tip u_t_tip phi_t_tip theta_mid energy extremes u_tip_min u_tip_max \
    energy initial final largest_increase largest_balance_residual \
    scheme solver heated contact_steps degree time_degree restart_dt growth work passes factorizations events t from to";

#[test]
fn the_keys_and_their_order_are_the_contract() {
    let folder = Folder::new();
    folder.file(
        "thrown.toml",
        &thrown("degree = 16", "degree = 4\ndt = 0.01"),
    );
    let (ended, json) = folder.json("run thrown.toml");
    let found = keys(ended.well());
    let found: Vec<&str> = found.iter().map(|key| key.trim_start()).collect();
    assert_eq!(found.join(" "), CONTRACT);
    assert_eq!([&json["scheme"], &json["scene"]], ["dg", "thrown"]);
    assert_eq!(
        [&json["elements"], &json["degree"], &json["time_degree"]],
        [1, 16, 4]
    );
    // The first touch, from experiments-exact.
    let events = json["events"].as_array().expect("a list");
    assert_eq!(events.len(), 1, "{events:?}");
    let t = number(&json, "/events/0/t");
    assert!((t - 0.203_413_276_1).abs() < 1e-8, "{t}");
    assert_eq!([&events[0]["from"], &events[0]["to"]], ["free", "upper"]);
    assert_eq!(json["final"]["t"], 0.5);
    assert!(number(&json, "/energy/largest_increase") < 0.0);
    assert!(number(&json, "/energy/largest_balance_residual") < 1e-12);
    assert!((50.0..200.0).contains(&number(&json, "/steps")));
}

#[test]
fn the_summary_shows_degrees_work_and_events() {
    let folder = Folder::new();
    folder.file("thrown.toml", &thrown("degree = 8", ""));
    let ended = folder.ended("run thrown.toml");
    for piece in [
        "thrown: 1 element of degree 8, dG(2) in time",
        "free -> upper",
        "factorizations",
        "0.2034",
    ] {
        assert!(ended.well().contains(piece), "{piece}: {ended:?}");
    }
}

#[test]
fn a_misspelt_scheme_is_named_before_the_keys_that_depend_on_it() {
    let text = thrown("degree = 8", "degree = 3\ndt = 0.01").replace("\"dg\"", "\"dgx\"");
    let folder = Folder::new();
    folder.file("bad.toml", &text);
    folder
        .ended("run bad.toml")
        .refuses("time.scheme: found the text \"dgx\" (did you mean \"dg\"?)");
}
