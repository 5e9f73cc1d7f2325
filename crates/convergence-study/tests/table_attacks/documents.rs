//! Documents and logs in which a table is not alone.

use super::{answer, passes};

/// A sound table in Markdown.
const SOUND: &str = "| h | L2 |\n|---|---|\n| 0.4 | 0.1600 |\n| 0.2 | 0.0400 |\n| 0.1 | 0.0100 |\n";

/// What stands around rows between bars is prose, but rows and logs in it are none that may be
/// skipped: nothing passes.
#[test]
fn a_failing_run_outside_the_bars_lets_nothing_pass() {
    let settings = "Settings: CFL = 0.4, kappa = 1e-2, T = 1 on [10, 20, 40] cells.\n";
    assert!(passes(&format!(
        "{settings}\n{SOUND}\n- L2 = 3e-7 at N = 200\n"
    )));
    for failing in [
        "h L2\n0.4 0.41\n0.2 0.40\n0.1 0.40\n",
        "h,L2\n0.4,0.41\n0.2,0.40\n0.1,0.40\n",
        "h & L2 \\\\\n0.4 & 0.41 \\\\\n0.2 & 0.40 \\\\\n0.1 & 0.40 \\\\\n",
        "h = 0.4, L2 = 0.41\nh = 0.2, L2 = 0.40\nh = 0.1, L2 = 0.40\n",
        "{\"h\": [0.4, 0.2, 0.1], \"L2\": [0.41, 0.40, 0.40]}\n",
        "L2: 0.41\nL2: 0.40\nL2: 0.40\n",
        "0.4 | 0.41\n0.2 | 0.40\n0.1 | 0.40\n",
    ] {
        for text in [format!("{SOUND}\n{failing}"), format!("{failing}\n{SOUND}")] {
            assert!(!passes(&text), "{text}");
        }
    }
}

/// A last row that has lost a bar, a cell or its form lets nothing pass.
#[test]
fn a_row_that_has_lost_its_frame_is_not_skipped() {
    let sound = "| 0.05 | 0.0025 |";
    assert!(passes(&format!("{SOUND}{sound}\n")));
    for row in [
        "0.05 | 0.0090",
        "| 0.05 | 0.0090",
        "| 0.05 | diverged",
        "| 0.05 | nan",
        "| 0.05 | | 0.0090 |",
        "| 0.05 |",
        "| | 0.0090 |",
        "| 0.05 | 0.0090 | x |",
        "0.05 & 0.0090 \\\\",
        "| not converged | 0.05 |",
        "| 0.05 | not converged |",
        "<tr><td>0.05</td><td>0.0090</td></tr>",
    ] {
        assert!(!passes(&format!("{SOUND}{row}\n")), "{row}");
    }
}

/// A table that no choice reads is a doubt beside others, with its message; alone it is refused.
#[test]
fn a_table_that_cannot_be_read_is_a_doubt_beside_others() {
    let broken = "| h | H1 |\n|---|---|\n| 0.4 | 0.4 |\n| 0.2 | abc |\n| 0.1 | 0.1 |\n";
    assert!(answer(broken, &["2"]).is_none());
    for text in [format!("{SOUND}\n{broken}"), format!("{broken}\n{SOUND}")] {
        let sheet = answer(&text, &["2"]).expect("the other table");
        assert!(!sheet.verdict.is_pass(), "{}", sheet.text);
        for words in [
            "1 of 1 column agrees",
            "a table is not read",
            "expected a number, found `abc`",
        ] {
            assert!(sheet.sentence.contains(words), "{}", sheet.sentence);
        }
        // A claim about its column is one about a column that is not there.
        assert!(answer(&text, &["L2=2", "H1=1"]).is_none());
    }
}

/// The numbers of a command are arguments; its messages are not, and neither are its results.
#[test]
fn a_command_is_no_row_and_hides_none() {
    let rows = "h = 0.4, L2 = 0.1600\nh = 0.2, L2 = 0.0400\nh = 0.1, L2 = 0.0100\n";
    for command in [
        "./solve -n 8 -tol=1e-10 9",
        "$ ./solve -n 8",
        "// mpirun -np 4 ./solve -o 2",
    ] {
        assert!(passes(&format!("{command}\n{rows}")), "{command}");
    }
    for line in [
        "mpirun noticed that process rank 0 exited on signal 9",
        "./run.sh: line 3: 812 Segmentation fault  ./solve",
        "$ h = 0.05, L2 = 0.9",
        "./solve: h = 0.05, L2 = 0.9",
        "mpirun: L2 = 0.9",
    ] {
        assert!(!passes(&format!("{rows}{line}\n")), "{line}");
    }
}

/// `--dim` is for tables with counts; beside them one with a step keeps it, by its name only.
#[test]
fn a_dimension_goes_to_the_tables_with_counts() {
    use convergence_study::{Choice, RateTable};

    let counts = "Space\nn,L2\n4,0.1600\n8,0.0400\n16,0.0100\n";
    let steps = "Time\ndt,L2\n0.4,0.1600\n0.2,0.0400\n0.1,0.0100\n";
    let choice = Choice {
        dim: Some(1.0),
        ..Choice::default()
    };
    let read = |text: &str| RateTable::parse_all_with(text, "t", &choice);
    let tables = read(&format!("{counts}{steps}")).expect("both tables");
    let labels: Vec<&str> = tables
        .iter()
        .map(|(_, table)| table.step.as_str())
        .collect();
    assert_eq!(labels, ["1/n", "dt"]);
    assert!(read(steps).is_err());
    // `eps` could be the step by its numbers alone.
    let levels = "Space\nlevel,L2\n0,0.1600\n1,0.0400\n2,0.0100\n";
    let nameless = steps.replace("dt", "eps");
    let choice = Choice {
        ratio: Some(2.0),
        ..Choice::default()
    };
    let tables = RateTable::parse_all_with(&format!("{levels}{nameless}"), "t", &choice);
    let tables = tables.expect("the table with levels");
    let labels: Vec<&str> = tables
        .iter()
        .map(|(_, table)| table.step.as_str())
        .collect();
    assert_eq!(labels, ["2^(-level)"]);
    assert_eq!(tables[0].1.doubts.len(), 1);
}
