//! `run` of scenes with `scheme = "dg"`.

use super::{Folder, ended, keys, run_json, thermobeam};

/// The paper's first experiment at β = 0 over [0, 0.5], with the given lines in `[mesh]` and
/// `[time]`.
pub(crate) fn thrown(mesh: &str, time: &str) -> String {
    format!(
        "[obstacles]\n[initial]\nu = \"0.01*x*(x-2)\"\nu_t = \"20*x*(x-1)^2\"\ntheta = \"sin(pi*x)\"\n\
         [mesh]\n{mesh}\n[time]\nscheme = \"dg\"\nt_end = 0.5\n{time}\n"
    )
}

/// Keys of the object of any scene of any order; keys of inner objects begin with an underscore.
const CONTRACT: &str = "schema verdict scene elements steps dt t_end iterations _total _max wall_seconds \
    final _t _u_tip _phi_tip _u_t_tip _phi_t_tip _theta_mid _energy extremes _u_tip_min _u_tip_max \
    energy _initial _final _largest_increase _largest_balance_residual \
    scheme solver heated contact_steps degree time_degree restart_dt growth work _passes _factorizations events __t __from __to";

fn expected(contract: &str) -> Vec<String> {
    contract
        .split_whitespace()
        .map(|key| {
            key.replace('_', "\0")
                .trim_start_matches('\0')
                .replace('\0', "_")
        })
        .collect()
}

fn bare(json: &str) -> Vec<String> {
    keys(json)
        .iter()
        .map(|key| key.trim_start().to_owned())
        .collect()
}

#[test]
fn the_keys_and_their_order_are_the_contract() {
    let folder = Folder::new();
    let (ended, json) = run_json(&folder.file(
        "thrown.toml",
        &thrown("degree = 16", "degree = 4\ndt = 0.01"),
    ));
    assert_eq!((ended.status, ended.stderr.as_str()), (Some(0), ""));
    assert_eq!(bare(&ended.stdout), expected(CONTRACT));
    assert_eq!(
        (json["scheme"].as_str(), json["scene"].as_str()),
        (Some("dg"), Some("thrown"))
    );
    assert_eq!(
        [&json["elements"], &json["degree"], &json["time_degree"]],
        [1, 16, 4]
    );
    // The first touch, from experiments-exact.
    let events = json["events"].as_array().expect("a list");
    assert_eq!(events.len(), 1, "{events:?}");
    let t = events[0]["t"].as_f64().expect("a time");
    assert!((t - 0.203_413_276_1).abs() < 1e-8, "{t}");
    assert_eq!([&events[0]["from"], &events[0]["to"]], ["free", "upper"]);
    assert_eq!(json["final"]["t"], 0.5);
    assert!(
        json["energy"]["largest_increase"]
            .as_f64()
            .is_some_and(|increase| increase < 0.0)
    );
    assert!(
        json["energy"]["largest_balance_residual"]
            .as_f64()
            .is_some_and(|residual| residual < 1e-12)
    );
    assert!(
        json["steps"]
            .as_u64()
            .is_some_and(|steps| (50..200).contains(&steps))
    );
}

#[test]
fn the_summary_shows_degrees_work_and_events() {
    let folder = Folder::new();
    let ended = ended(
        thermobeam()
            .arg("run")
            .arg(folder.file("thrown.toml", &thrown("degree = 8", ""))),
    );
    assert_eq!((ended.status, ended.stderr.as_str()), (Some(0), ""));
    for piece in [
        "thrown: 1 element of degree 8, dG(2) in time",
        "free -> upper",
        "factorizations",
        "0.2034",
    ] {
        assert!(ended.stdout.contains(piece), "{piece}: {}", ended.stdout);
    }
}

#[test]
fn a_misspelt_scheme_is_named_before_the_keys_that_depend_on_it() {
    let text = thrown("degree = 8", "degree = 3\ndt = 0.01").replace("\"dg\"", "\"dgx\"");
    let ended = ended(
        thermobeam()
            .arg("run")
            .arg(Folder::new().file("bad.toml", &text)),
    );
    assert_eq!(ended.status, Some(2));
    let message = "time.scheme: found the text \"dgx\" (did you mean \"dg\"?)";
    assert!(ended.stderr.contains(message), "{}", ended.stderr);
}

#[test]
fn bad_input_is_refused_with_file_and_field() {
    let folder = Folder::new();
    for (mesh, time, message) in [
        ("degree = 0", "", "mesh.degree: found 0"),
        ("degree = 100", "", "mesh.degree: found 100"),
        ("", "degree = 6", "time.degree: found 6"),
        (
            "",
            "dt = 0.01\nrestart_dt = 0.02",
            "time.restart_dt: found 0.02; expected a number > 0 and at most dt = 0.01",
        ),
        ("", "growth = 0.9", "time.growth: found 0.9"),
        (
            "",
            "solver = \"newton\"",
            "time.solver: found scheme = \"dg\"",
        ),
    ] {
        let scene = folder.file("bad.toml", &thrown(mesh, time));
        let out = folder.path("out");
        let ended = ended(thermobeam().arg("run").arg(scene).arg("--out").arg(&out));
        assert_eq!(
            (ended.status, ended.stdout.as_str()),
            (Some(2), ""),
            "{message}"
        );
        assert!(
            ended.stderr.contains("bad.toml") && ended.stderr.contains(message),
            "{message}: {}",
            ended.stderr
        );
        assert!(!out.exists(), "{message}");
    }
}
