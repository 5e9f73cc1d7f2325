//! Levels without a result or without their step; few levels.

use super::Place;

#[test]
fn a_level_without_a_result_fails_and_the_others_have_a_rate() {
    let place = Place::new("abort", "");
    let text = place.text();
    for levels in [
        "[4, 8, 16, 32, 64]",
        "[1, 2, 4, 8, 16]",
        "[16, 32, 64, 128, 256]",
    ] {
        place.write_text(&text.replace("[4, 8, 16, 32, 64]", levels));
        let (status, out, err) = place.study("").parts();
        assert_eq!(status, Some(1), "{out}{err}");
        let found = out
            .lines()
            .find(|line| line.starts_with("L2: 2.0000 ± 0.00005"))
            .unwrap();
        let missing = "1 of 5 levels has no result: n = 16";
        let judged = "4 of 5 cases judged; 1 not: without a result";
        assert!(
            found.ends_with(&format!(", claimed 2 ± 0.05: {missing}; {judged}")),
            "{out}"
        );
        assert!(
            !out.contains("NaN") && out.contains("a level has no result"),
            "{out}"
        );
        let row = out
            .lines()
            .find(|line| line.trim_start().starts_with("16 "))
            .unwrap();
        assert_eq!(
            row.split_whitespace().collect::<Vec<_>>(),
            ["16", "-", "-", "-"],
            "{out}"
        );
    }
    // Two of three levels have a result: no interval, but the rate between them.
    place.write_text(&text.replace("[4, 8, 16, 32, 64]", "[4, 8, 16]"));
    let (status, out, _) = place.study("--quiet").parts();
    let message = "L2: 2.000 between the finest levels that have one, claimed 2 ± 0.05: 1 of 3 levels has no result: n = 16";
    assert!(status == Some(1) && out.contains(message), "{out}");
    // A value, judged by differences.
    place.write_text(&text.replace("error = \"L2\"", "value = \"flux\""));
    let (status, out, _) = place.study("--out report").parts();
    assert!(
        status == Some(1)
            && out.contains(", claimed 2 ± 0.05: 1 of 5 levels has no result: n = 16"),
        "{out}"
    );
    place.write_text(&text);
    place.study("--out report").says(1, "");
    let drawn = place.read("report/figures/s-errors.svg");
    assert!(
        drawn.contains("n = 16: no result") && !drawn.contains("non-finite"),
        "{drawn}"
    );
    // On a grid.
    let grid = text
        .replace("64]", "64]\ndt = [0.1, 0.05, 0.025]\ngrid = true")
        .replace("\"{n}\"]", "\"{n}\", \"{dt}\"]");
    place.study_of(&grid.replace("order = 2.0", "order = 2.0\norder_dt = 1.0")).says(
        1,
        "L2 in h: no rate, claimed 2 ± 0.05: 3 of 15 levels have no result: h = 0.0625, dt = 0.1",
    );
}

#[test]
fn the_step_that_a_program_answers_is_the_one_that_its_errors_are_judged_over() {
    let place = Place::new("cells", "");
    place.study("").says(0, "2.0000 ± 0.00005");
    let text = place.text();
    place
        .study_of(&text.replace("order = 2.0", "order = 1.0"))
        .says(1, "too high");
}

#[test]
fn other_claims_than_an_order_are_judged() {
    let place = Place::new("plain", "");
    let text = place.text();
    let study = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        place.study_of(&text.replace(from, to))
    };
    for (claim, status, says) in [
        ("order = \">= 1\"", 0, "pass"),
        ("order = \">= 2\"", 0, "pass"),
        ("order = \">= 2.5\"", 1, "too low"),
        ("order = 2.0\nconstant = [0.9, 1.1]", 0, "pass"),
        (
            "order = 2.0\nconstant = [1.1, 2.0]",
            1,
            "the constant is outside its interval (1.0000 to 1.0000, claimed 1.1 to 2)",
        ),
    ] {
        study("order = 2.0", claim).says(status, says);
    }
    // The finest error is 2.4e-4, the coarsest 6.25e-2.
    for (bound, status) in [("0.07", 0), ("0.06", 1)] {
        study("order = 2.0\ntolerance = 0.05", &format!("exact = {bound}"))
            .says(status, "largest 6.250e-2");
    }
    for (claim, says) in [
        ("order = \"> 2\"", ">= 2"),
        ("order = \">= -2\"", ">= 2"),
        ("order = 2.0\nfactor = 5", "one of order, factor and exact"),
        ("factor = 0.5", "a factor > 1"),
        ("order = 2.0\nconstant = [2.0, 1.0]", "two numbers"),
        ("factor = 2\nconstant = [1.0, 2.0]", "beside order"),
        ("exact = 1e-3", "exact alone"),
    ] {
        let ran = study("order = 2.0", claim);
        ran.complains(2, says);
        ran.complains(2, "s.toml:");
    }
    let ran = study(
        "order = 2.0\ntolerance = 0.05",
        "exact = 0.07\nconstant = [1.0, 2.0]",
    );
    ran.complains(2, "constant beside exact");
    ran.complains(2, "s.toml:");
    study(
        "order = 2.0",
        "factor = 5\ntolerance = 0.1\n[[expect]]\nerror = \"H1\"\norder = 1.0",
    )
    .complains(2, "one of the two in all of a study");
}

#[test]
fn an_error_that_falls_by_a_factor_a_degree_has_that_factor() {
    let place = Place::new("degrees", "");
    let text = place.text();
    let text = text.replace("[4, 8, 16, 32, 64]", "[1, 2, 3, 4, 5]");
    for (claim, status, says) in [
        ("factor = 5", 0, "pass"),
        ("factor = 8", 1, "too low"),
        ("factor = 3", 1, "too high"),
        ("factor = \">= 3\"", 0, "pass"),
    ] {
        place
            .study_of(&text.replace("order = 2.0", claim))
            .says(status, says);
    }
}

#[test]
fn a_name_that_an_answer_has_twice_is_refused() {
    let place = Place::new("twice", "");
    let (status, out, err) = place.study("").parts();
    assert!(
        status == Some(1) && (out.clone() + &err).contains("`L2` occurs twice"),
        "{out}{err}"
    );
}

#[test]
fn what_is_finite_beside_a_nan_is_kept() {
    let place = Place::new("half", "");
    let text = place.text();
    place.write_text(&(text + "[[expect]]\nerror = \"H1\"\norder = 1.0\ntolerance = 0.05\n"));
    let (status, out, err) = place.study("").parts();
    assert_eq!(status, Some(1), "{out}{err}");
    assert!(
        out.contains("4 of 5 cases completed; n = 16: ")
            && out.contains("`L2` of its errors is NaN"),
        "{out}"
    );
    // The pair 32, 64 is finer than the NaN.
    let message = "L2: 2.000 between the finest levels that have one, claimed 2 ± 0.05: an error is NaN or infinite";
    assert!(out.contains(message), "{out}");
    let rates = out.lines().find(|line| line.starts_with("H1 ")).unwrap();
    assert!(
        rates.contains("pass") && rates.contains("1-5 of 5"),
        "{out}"
    );
}

#[test]
fn a_study_of_two_levels_has_the_rate_between_them() {
    let place = Place::new("ok", "");
    let text = place.text();
    place.write_text(&text.replace("[4, 8, 16, 32, 64]", "[4, 8]"));
    let message =
        "L2: 2.000 between the finest levels that have one, claimed 2 ± 0.05: too few levels";
    place.study("--quiet").says(1, message);
    let (status, out, _) = place.study("").parts();
    let rates = out
        .lines()
        .find(|line| line.starts_with("L2 ") && line.contains("2 ± 0.05"))
        .unwrap();
    assert!(
        status == Some(1) && rates.contains(" 2.000 ") && rates.contains("finest pair"),
        "{out}"
    );
}

#[test]
fn steps_that_only_some_levels_answer_are_refused() {
    let (status, out, err) = Place::new("own-step", "").study("").parts();
    assert_eq!(status, Some(1), "{out}{err}");
    let message = "expected h in the answers of all levels or of none; found it in those of n = 16, not in those of n = 4; n = 8; n = 32; n = 64";
    assert!(out.contains(message) && !out.contains("Rates"), "{out}");
}

#[test]
fn levels_are_added_until_it_is_decided_within_the_budget() {
    let place = Place::new("late", "");
    let text = place.text();
    let second = "[[expect]]\nerror = \"L1\"\norder = 2.0\ntolerance = 0.05\n";
    let auto = text.replace("[4, 8, 16, 32, 64]", "\"auto\"") + second;
    place.write_text(&auto);
    let (status, out, err) = place.study("--out report").parts();
    assert_eq!(status, Some(0), "{out}{err}");
    let summary = out
        .lines()
        .find(|line| line.contains("decided after"))
        .unwrap_or_else(|| panic!("{out}"));
    let levels: usize = summary
        .split("decided after ")
        .nth(1)
        .unwrap()
        .split(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!(
        (5..=8).contains(&levels) && summary.contains("; 4 were enough for L1"),
        "{out}"
    );
    // The same levels are listed; a listed study of them has the same rate, and is undecided with
    // one level fewer.
    let listed = |levels: usize| {
        let counts: Vec<String> = (0..levels).map(|level| (8 << level).to_string()).collect();
        place.write_text(&auto.replace("\"auto\"", &format!("[{}]", counts.join(", "))));
        place.study("--format json")
    };
    listed(levels).says(0, "");
    listed(levels - 1).says(1, "");
    // A budget too small for another level, a claim that fails at two looks.
    place.write_text(&auto.replace("\"auto\"", "\"auto\"\nbudget = 1e-3"));
    place.study("--quiet").says(1, "");
    let (_, out, _) = place.study("").parts();
    assert!(
        out.contains("undecided after 4 levels: the next would take about ")
            && out.contains("0.001 s"),
        "{out}"
    );
    let wrong = auto.replace("order = 2.0", "order = 1.0");
    place.study_of(&wrong).says(1, "decided after 5 levels");
    place
        .study_of(&wrong.replace("\"auto\"", "\"auto\"\nbudget = 1e-3"))
        .says(1, "a failure at the last look only, after 4 levels: the");
    for (written, message) in [
        (
            "\"auto\"\nbudget = 0",
            "refine.budget: found 0; expected a number of seconds > 0",
        ),
        (
            "[8, 16]\nbudget = 3",
            "refine.budget: found a budget beside lists; expected lists alone, or \"auto\"",
        ),
        (
            "\"auto\"\nsteps = [1, 2, 3, 4]",
            "refine.steps: found the list [1, 2, 3, 4] beside \"auto\"; expected \"auto\"",
        ),
        (
            "\"auto\"\nsteps = \"auto\"\ngrid = true",
            "refine.n: found the text \"auto\"; expected lists where grid = true",
        ),
        (
            "\"many\"",
            "refine.n: found the text \"many\"; expected a list of increasing whole numbers >= 1, or \"auto\"",
        ),
    ] {
        place
            .study_of(&auto.replace("\"auto\"", written))
            .refuses(message);
    }
}
