//! Into which tables a text is cut.

use convergence_study::{Choice, RateTable};

fn headings(text: &str, dim: Option<f64>) -> Vec<String> {
    let choice = Choice {
        dim,
        ..Choice::default()
    };
    let tables = RateTable::parse_all_with(text, "t", &choice).expect("tables");
    let name = |(heading, table): (String, RateTable)| {
        format!("{heading}: {}", table.columns[0].levels.len())
    };
    tables.into_iter().map(name).collect()
}

#[test]
fn a_text_is_cut_into_its_tables() {
    for (text, tables) in [
        // Between every two rows: nothing is cut.
        (
            "h L2\n0.2 4e-2\n---\n0.1 1e-2\n---\n0.05 2.5e-3\n---\n",
            &[": 3"][..],
        ),
        ("h,L2\n0.1,1e-2\n0.2,4e-2\n0.05,2.5e-3\n", &[": 3"]),
        (
            "Cycle 0:\nh = 0.2\nL2 = 4e-2\n\nCycle 1:\nh = 0.1\nL2 = 1e-2\n\nCycle 2:\nh = 0.05\nL2 = 2.5e-3\n",
            &[": 3"],
        ),
        // Rates and a state that the first level lacks.
        (
            "h = 0.2, L2 = 4e-2\nh = 0.1, L2 = 1e-2\nrate = 2.0\nh = 0.05, L2 = 2.5e-3\nrate = 2.0\n",
            &[": 3"],
        ),
        // Between some rows.
        (
            "h L2\n0.2 4e-2\n0.1 1e-2\n\n0.05 2.5e-3\n0.025 6e-4\n",
            &["table 1: 2", "table 2: 2"],
        ),
        (
            "upwind\nh L2\n0.2 4e-2\n0.1 1e-2\ncentral\nh L2\n0.05 2.5e-3\n0.025 6e-4\n",
            &["upwind: 2", "central: 2"],
        ),
        (
            "h L2\n0.2 4e-2\n0.1 1e-2\nh L2\n0.05 2.5e-3\n0.025 6e-4\n",
            &["table 1: 2", "table 2: 2"],
        ),
        (
            "scheme: upwind\nh = 0.2, L2 = 4e-2\nh = 0.1, L2 = 1e-2\nscheme: central\nh = 0.05, L2 = 3e-3\nh = 0.025, L2 = 6e-4\n",
            &["scheme: upwind: 2", "scheme: central: 2"],
        ),
        // Columns of groups, sorted by them or not.
        (
            "method,h,L2\nupwind,0.2,4e-2\nupwind,0.1,1e-2\ncentral,0.05,3e-3\ncentral,0.025,6e-4\n",
            &["method = upwind: 2", "method = central: 2"],
        ),
        (
            "h p L2\n0.2 1 4e-2\n0.2 2 1e-2\n0.1 1 1e-2\n0.1 2 1e-3\n",
            &["p = 1: 2", "p = 2: 2"],
        ),
        (
            "h eps L2\n0.2 0.5 4e-2\n0.1 0.5 1e-2\n0.2 0.7 1e-2\n0.1 0.7 1e-3\n",
            &["table 1: 2", "table 2: 2"],
        ),
        // A step that returns.
        (
            "h L2\n0.2 4e-2\n0.1 1e-2\n0.2 3e-2\n0.1 1e-3\n",
            &["table 1: 2", "table 2: 2"],
        ),
        (
            "h L2\n0.2 4e-2\n0.1 1e-2\n0.05 2e-3\n0.15 3e-2\n0.07 1e-3\n0.03 2e-4\n",
            &["table 1: 3", "table 2: 3"],
        ),
        // Names of groups above those of columns, with a step each.
        (
            "u         v\nh   error h   error\n0.2 4e-2  0.1 1e-2\n0.1 1e-2  0.05 2e-3\n",
            &["u: 2", "v: 2"],
        ),
    ] {
        assert_eq!(headings(text, None), tables, "{text}");
    }
    let ladders = "Nx Ny L2\n8 4 4e-2\n16 4 1e-2\n4 8 4e-2\n4 16 1e-2\n";
    assert_eq!(headings(ladders, Some(1.0)), ["table 1: 2", "table 2: 2"]);
}

/// Names that end before others begin are two tables: with nothing between, they are not read as one.
#[test]
fn successive_names_are_refused() {
    let text =
        "h = 0.2, L2 = 4e-2\nh = 0.1, L2 = 1e-2\ndt = 0.05, L2 = 3e-3\ndt = 0.025, L2 = 6e-4\n";
    assert!(RateTable::parse_all_with(text, "t", &Choice::default()).is_err());
}

#[test]
fn rows_in_any_order_are_sorted_and_that_is_said() {
    let reading = |rows: [&str; 4]| {
        let text = format!("h,L2\n{}\n", rows.join("\n"));
        RateTable::parse_with(&text, "t", &Choice::default())
            .expect("a table")
            .reading
    };
    assert!(
        reading(["0.1,1e-2", "0.2,4e-2", "0.025,6e-4", "0.05,2.5e-3"])
            .ends_with("; rows sorted by `h`")
    );
    assert!(!reading(["0.025,6e-4", "0.05,2.5e-3", "0.1,1e-2", "0.2,4e-2"]).contains("sorted"));
}
