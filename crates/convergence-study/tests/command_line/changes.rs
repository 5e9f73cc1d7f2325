//! What has changed since: `compare`, `review` and `history`.

use std::fs;
use std::process::Stdio;

use crate::{ORDER, command, is_harmless, run, study, texts, workspace};

pub(crate) fn records_are_compared_with_0_1_or_2() {
    let root = workspace(true);
    let write = |name: &str, files: &[&str]| {
        let (_, out, _) = run(&root, &[&["study", "--format", "json"], files].concat());
        fs::write(root.path().join(name), out).unwrap();
    };
    write("old.json", &["studies/one.toml", "studies/two.toml"]);
    fs::write(root.path().join("studies/one.toml"), study("one", "c", 0.8)).unwrap();
    write("new.json", &["studies/one.toml", "studies/two.toml"]);
    write("part.json", &["studies/two.toml"]);
    let (status, out, err) = run(&root, &["compare", "old.json", "new.json"]);
    assert_eq!((status, err.as_str()), (Some(1), ""), "{out}");
    let (finding, rest) = out.split_once('\n').unwrap();
    assert!(finding.starts_with("one: error: worse: order 1.000 (1.000 to 1.000) → 0.800"), "{out}");
    assert_eq!(rest, "worse: 1 worse, 0 better, 1 the same, in 2 studies\n");
    let (status, out, _) = run(&root, &["compare", "new.json", "old.json"]);
    assert!(status == Some(0) && out.contains("\nbetter: 0 worse, 1 better, 1 the same"), "{out}");
    let (status, out, _) = run(&root, &["compare", "old.json", "part.json"]);
    let named = "note: the study one is in the old record only\nsame: 0 worse, 0 better, 1 the same, in 1 studies\n";
    assert_eq!((status, out.as_str()), (Some(0), named));
    let (_, out, _) = run(&root, &["compare", "old.json", "new.json", "--format", "json"]);
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&object["change"], &object["studies"][0]["norms"][0]["change"]), (&"worse".into(), &"worse".into()));
    assert!(object["studies"][0]["norms"][0]["lines"][1]["order_interval"].is_array(), "{out}");
    let (_, out, _) = run(&root, &["compare", "old.json", "new.json", "--all"]);
    assert!(out.contains("two: error: same: errors the same at the same step: 1.0000 times"), "{out}");
    fs::write(root.path().join("bad.json"), "{\n}").unwrap();
    write("other.json", &["studies/one.toml"]);
    for (arguments, message) in [
        (
            &["compare", "old.json", "bad.json"][..],
            "bad.json: missing field `schema` at line 2 column 1; expected a record",
        ),
        (&["compare", "old.json", "none.json"], "none.json: No such file"),
        (&["compare", "part.json", "other.json"], "other.json: found no study that part.json has, too"),
        (&["compare", "old.json", "new.json", "--within", "-1"], "expected a number >= 0"),
        (&["compare", "old.json", "new.json", "--floor", "-1"], "floor = -1: expected a finite number >= 0"),
    ] {
        let (status, out, err) = run(&root, arguments);
        assert!(status == Some(2) && out.is_empty() && err.contains(message), "{err}");
    }
}

pub(crate) fn changes_are_accepted_one_some_or_all_with_a_reason() {
    let root = workspace(false);
    assert_eq!(run(&root, &["verify", "--bless"]).0, Some(0));
    let (status, out, _) = run(&root, &["review"]);
    assert_eq!((status, out.as_str()), (Some(0), "nothing differs from the baseline\n"));
    fs::write(root.path().join("studies/one.toml"), study("one", "c", 1.01)).unwrap();
    let file = root.path().join("studies/baseline.json");
    let before = fs::read_to_string(&file).unwrap();
    // Without a terminal nothing is asked, and nothing is accepted that was not named.
    let (status, out, err) = run(&root, &["review"]);
    assert_eq!((status, err.as_str()), (Some(1), ""));
    assert!(out.starts_with("one:claim exponent: was 1, is 1.01\n  claim: c: pass\n"), "{out}");
    let rate = "one:rate error: moved from 1 to 1.01, by +1 %, tolerated 0.01 %\n  interval 1.0100 ± 0.00005, pairwise \
                1.010 1.010 1.010 1.010\n  order 1 ± 0.05: the rate agrees with the order: ";
    assert!(out.contains(rate), "{out}");
    assert!(out.ends_with("0 accepted, 7 differ from the baseline; accept with --accept ID --reason TEXT\n"), "{out}");
    for (arguments, message) in [
        (&["review", "--accept", "one:rate *"][..], "--reason"),
        (
            &["review", "--accept", "two:*", "--reason", "x"],
            "--accept: found `two:*`, which matches no change; expected one of 7",
        ),
        (&["review", "--accept", "*", "--reason", "a\nb"], "expected one line of text"),
    ] {
        let (status, out, err) = run(&root, arguments);
        assert!(status == Some(2) && out.is_empty() && err.contains(message), "{err}");
    }
    assert_eq!(fs::read_to_string(&file).unwrap(), before);
    let (status, out, _) = run(&root, &["review", "--accept", "one:rate error", "--reason", "new mesh"]);
    assert_eq!(status, Some(1));
    assert!(out.starts_with("accepted: one:rate error: new mesh\n") && out.contains("\n1 accepted, 6 differ"), "{out}");
    let baseline = |path: &[&str]| {
        let text = fs::read_to_string(&file).unwrap();
        let object: serde_json::Value = serde_json::from_str(&text).unwrap();
        path.iter().fold(object, |object, key| object[key].clone())
    };
    assert_eq!(baseline(&["studies", "one", "rate error", "reason"]), "new mesh");
    assert_eq!(baseline(&["studies", "one", "error error, n = 8", "value"]), 0.125);
    let (status, out, _) = run(&root, &["review", "one", "--accept", "one:*", "--reason", "and all the rest"]);
    assert!(status == Some(0) && out.ends_with("\n6 accepted, nothing else differs from the baseline\n"), "{out}");
    assert_eq!(baseline(&["claims", "one", "exponent", "reason"]), "and all the rest");
    assert_eq!(run(&root, &["verify"]).0, Some(0));
    // A blessing of what has not moved keeps the reasons.
    assert_eq!(run(&root, &["verify", "--bless"]).0, Some(0));
    assert_eq!(baseline(&["studies", "one", "rate error", "reason"]), "new mesh");
    // A study that fails has no number that a baseline takes.
    fs::write(root.path().join("studies/one.toml"), study("one", "c", 0.5)).unwrap();
    let (status, _, err) = run(&root, &["review", "--accept", "*", "--reason", "x"]);
    assert!(
        status == Some(2) && err.contains("one:claim exponent: not blessed: the verdict on `one` is fail"),
        "{err}"
    );
    assert_eq!(baseline(&["claims", "one", "exponent", "value"]), "1.01");
}

pub(crate) fn a_review_fails_where_a_study_does_and_nothing_differs() {
    let root = workspace(false);
    assert_eq!(run(&root, &["verify", "--bless"]).0, Some(0));
    for (arguments, end) in [
        (&["review"][..], "\n\nnothing differs from the baseline\n"),
        (&["review", "--quiet"], "\n\nfail: nothing differs from the baseline\n"),
    ] {
        let (status, out, _) = texts(command(root.path(), arguments).env(ORDER, "2").output().unwrap());
        assert_eq!(status, Some(1), "{out}");
        assert!(
            out.starts_with("one: fail\n  error: 1.0000 ± 0.00005, claimed 2 ± 0.05: too low\n") && out.ends_with(end),
            "{out}"
        );
    }
}

/// Wherever their reports go, they write one baseline.
pub(crate) fn blessings_at_once_are_all_kept() {
    let root = workspace(false);
    let ids: Vec<String> = (0..8).map(|k| format!("s{k}")).collect();
    for id in &ids {
        fs::write(root.path().join(format!("studies/{id}.toml")), study(id, "c", 1.0)).unwrap();
    }
    let bless = |id: &String| {
        let mut command = command(root.path(), &["verify", "--bless", "--quiet", "--out", id, id]);
        command.stdout(Stdio::null()).spawn().unwrap()
    };
    for mut run in ids.iter().map(bless).collect::<Vec<_>>() {
        assert_eq!(run.wait().unwrap().code(), Some(0));
    }
    let text = fs::read_to_string(root.path().join("studies/baseline.json")).unwrap();
    let baseline: serde_json::Value = serde_json::from_str(&text).unwrap();
    let missing: Vec<&String> = ids.iter().filter(|id| baseline["studies"].get(id.as_str()).is_none()).collect();
    assert!(missing.is_empty(), "{missing:?}");
    // Another name of the folder of the project's own reports: the lock is the same, and taken once.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("reports", root.path().join("link")).unwrap();
        assert_eq!(run(&root, &["verify", "--bless", "--out", "link"]).0, Some(0));
    }
}

pub(crate) fn runs_are_journaled_and_shown_as_page_and_badge() {
    let root = workspace(true);
    let read = |name: &str| fs::read_to_string(root.path().join(name)).unwrap();
    for (exponent, status) in [(0.5, 1), (1.0, 0)] {
        fs::write(root.path().join("studies/two.toml"), study("two", "c", exponent)).unwrap();
        let arguments = ["study", "studies/one.toml", "studies/two.toml", "--journal", "runs.jsonl"];
        assert_eq!(run(&root, &arguments).0, Some(status));
    }
    assert_eq!(run(&root, &["verify", "one", "--bless", "--quiet", "--journal", "runs.jsonl"]).0, Some(0));
    let lines: Vec<serde_json::Value> =
        read("runs.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 3);
    assert_eq!((&lines[0]["verdict"], &lines[0]["studies"][1]["verdict"]), (&"fail".into(), &"fail".into()));
    assert_eq!(lines[0]["studies"][1]["rates"][0]["fitted"].as_f64().map(|rate| (1e6 * rate).round()), Some(5e5));
    assert_eq!(lines[1]["studies"][0]["errors"]["error"], 1.0 / 64.0);
    assert_eq!(lines[2]["command"], "powers verify one");
    let (status, out, err) = run(&root, &["history", "runs.jsonl", "--out", "out"]);
    let written = "out/history.html, out/badge.svg: 3 runs, the last one pass\n";
    assert_eq!((status, out.as_str(), err.as_str()), (Some(0), written, ""));
    let page = read("out/history.html");
    let (before, after) = page.split_once("<script>").unwrap();
    let text = before.strip_prefix("<!DOCTYPE html>\n").unwrap().to_owned() + after.split_once("</script>").unwrap().1;
    let document = roxmltree::Document::parse(&text).unwrap();
    let is_address = |node: &roxmltree::Node<'_, '_>| {
        node.attributes().any(|a| matches!(a.name(), "src" | "href") && !a.value().starts_with("data:"))
    };
    assert!(!document.descendants().any(|node| is_address(&node)), "nothing is loaded");
    let studies: Vec<_> = document.descendants().filter(|node| node.attribute("class") == Some("study")).collect();
    let pictures = |k: usize| studies[k].descendants().filter(|node| node.has_tag_name("figure")).count();
    assert_eq!((studies.len(), pictures(0), pictures(1)), (2, 3, 3));
    assert!(page.contains("pass since run 2, in 2 runs") && page.contains("order 1"), "{page}");
    assert!(roxmltree::Document::parse(&read("out/badge.svg")).is_ok() && read("out/badge.svg").contains(">pass<"));
    // A journal that cannot be made is refused before anything is read or run.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("none/runs.jsonl", root.path().join("link")).unwrap();
        let (status, _, err) = run(&root, &["study", "none.toml", "--journal", "link"]);
        assert!(status == Some(2) && err.starts_with("error: link: No such file"), "{err}");
    }
    // The badge is that of the last run, whatever came before.
    fs::write(root.path().join("studies/one.toml"), study("one", "c", 0.5)).unwrap();
    assert_eq!(run(&root, &["study", "studies/one.toml", "--journal", "runs.jsonl"]).0, Some(1));
    run(&root, &["history", "runs.jsonl", "--last", "1"]);
    assert!(read("badge.svg").contains(">fail<") && !read("history.html").contains("id=\"two\""));
}

pub(crate) fn a_damaged_line_of_a_journal_is_named() {
    let root = workspace(false);
    let journal = root.path().join("runs.jsonl");
    let append = || run(&root, &["study", "studies/one.toml", "--journal", "runs.jsonl"]).0;
    assert_eq!(append(), Some(0));
    let line = fs::read_to_string(&journal).unwrap();
    for (damaged, found) in [
        (format!("{line}{{\"schema\": 1,\n"), "runs.jsonl:2: EOF while parsing"),
        (format!("{line}\n\u{7}\n"), "runs.jsonl:3: expected value at line 1 column 1"),
        (
            format!("{line}{}", line.replace("\"schema\":1", "\"schema\":9")),
            "runs.jsonl:2: schema: found 9; expected 1",
        ),
        (line.replace("pass", "good"), "runs.jsonl:1: unknown variant `good`, expected one of `pass`"),
        (String::new(), "runs.jsonl: found no run"),
    ] {
        fs::write(&journal, &damaged).unwrap();
        let (status, out, err) = run(&root, &["history", "runs.jsonl"]);
        assert!(status == Some(2) && out.is_empty() && err.starts_with(&format!("error: {found}")), "{err}");
        assert!(!root.path().join("history.html").exists());
        is_harmless(&err);
    }
    // A run that was killed while it wrote spoils its own line only.
    fs::write(&journal, format!("{line}{}", &line[..40])).unwrap();
    assert_eq!(append(), Some(0));
    let text = fs::read_to_string(&journal).unwrap();
    assert_eq!(text.lines().count(), 3);
    let whole: Vec<&str> = text.lines().enumerate().filter(|(k, _)| *k != 1).map(|(_, line)| line).collect();
    fs::write(&journal, whole.join("\n")).unwrap();
    assert_eq!(run(&root, &["history", "runs.jsonl"]).0, Some(0));
    // What cannot be appended to is found before anything is run.
    for place in ["studies", "nowhere/runs.jsonl", "/dev/null"] {
        let (status, out, _) = run(&root, &["study", "studies/one.toml", "--journal", place]);
        assert!(status == Some(2) && out.is_empty(), "{place}: {out}");
    }
}

pub(crate) fn a_study_with_a_near_extension_is_named() {
    let root = workspace(false);
    let write = |name: &str, text: &str| fs::write(root.path().join("studies").join(name), text).unwrap();
    write("two.TOML", &study("two", "c", 0.5));
    write("notes.tml", "# [study]\n");
    write("three.txt", &study("three", "c", 0.5));
    let told = "warning: studies/two.TOML: a study that is not run; expected a name that ends in .toml\n";
    for (arguments, status) in [(&["verify", "--bless"][..], 0), (&["verify", "--quiet"], 0), (&["list"], 0)] {
        let (ended, _, err) = run(&root, arguments);
        assert_eq!((ended, err.as_str()), (Some(status), told), "{arguments:?}");
    }
}
