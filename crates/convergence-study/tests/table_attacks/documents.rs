//! Documents and logs in which a table is not alone.

use convergence_study::rates::{Choice, LineRange};

use super::{answer, chosen, never_pass_together, passes, says};

/// A sound table in Markdown.
const SOUND: &str = "| h | L2 |\n|---|---|\n| 0.4 | 0.1600 |\n| 0.2 | 0.0400 |\n| 0.1 | 0.0100 |\n";

/// Prose is nothing; what looks like a row, or has a number for a column, lets nothing pass until
/// the caller says where the table is.
#[test]
fn a_failing_run_outside_the_table_lets_nothing_pass() {
    let prose = "Settings: CFL = 0.4, kappa = 1e-2 on coarse cells, see https://a.b/2 for more.\n";
    assert!(passes(&format!(
        "{prose}\n{SOUND}\nThe scheme is of second order.\n"
    )));
    let first = |below: &str| {
        let choice = Choice {
            lines: vec!["1-5".parse().expect("lines")],
            ..Choice::default()
        };
        chosen(&format!("{SOUND}\n{below}"), &["2"], choice).ok()
    };
    for failing in [
        "h L2\n0.4 0.41\n0.2 0.40\n0.1 0.40\n",
        "h,L2\n0.4,0.41\n0.2,0.40\n0.1,0.40\n",
        "h & L2 \\\\\n0.4 & 0.41 \\\\\n0.2 & 0.40 \\\\\n0.1 & 0.40 \\\\\n",
        "h = 0.4, L2 = 0.41\nh = 0.2, L2 = 0.40\nh = 0.1, L2 = 0.40\n",
        "{\"h\": [0.4, 0.2, 0.1], \"L2\": [0.41, 0.40, 0.40]}\n",
        "L2: 0.41\nL2: 0.40\nL2: 0.40\n",
        "0.4 | 0.41\n0.2 | 0.40\n0.1 | 0.40\n",
        "[0.41, 0.40, 0.40]\n",
        "0.0125\n",
        "level 4: NaN\n",
        "L2: nan\n",
        "L2 = 3e-7 at N = 200\n",
        "residual: 0.5\nresidual: 0.4\n",
    ] {
        never_pass_together(SOUND, failing, "\n");
        says(first(failing), true, "");
    }
    // A failed run is not excused.
    says(first("Traceback (most recent call last):\n"), false, "");
    for lines in ["0-3", "3-2", "a-b", "3-"] {
        assert!(lines.parse::<LineRange>().is_err(), "{lines}");
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
        "| 0.05 | 0.0025* |",
        "| 0.05 | <0.0025 |",
        "| 0.05 | 2.5e-3/9e-3 |",
    ] {
        assert!(!passes(&format!("{SOUND}{row}\n")), "{row}");
    }
}

/// Tags around a cell, capital letters and ends that lack mean nothing; each row that does not fit,
/// and each span, lets nothing pass.
#[test]
fn a_table_of_html_is_read_whole_or_does_not_pass() {
    const TABLE: &str = "<TABLE border=1>\n<tr><th>h</th>\n<th><b>L2</b></th></tr>\n\
                         <tr><td>0.4\n<td>0.1600\n<tr><td>0.2<td>0.0400\n<tr><td>0.1<td>0.0100\n</TABLE>\n";
    assert!(passes(TABLE));
    assert!(passes(&format!("<table><tr><td>{TABLE}</td></tr></table>")));
    for (cell, changed) in [
        ("<td>0.0100", "<td>diverged"),
        ("<td>0.0100", ""),
        ("<td>0.0100", "<td>0.0100<td>x"),
        ("<td>0.0100", "<td>&lt;0.0100"),
        ("<td>0.0100", "<td>0.0100\n0.2"),
        ("<td>0.0100", "<td>0.0100|0.2"),
        ("</TABLE>", "</TABLE><p>0.05 0.0090</p>"),
        (
            "</TABLE>",
            "</TABLE><pre>h L2\n0.4 0.41\n0.2 0.40\n0.1 0.40\n</pre>",
        ),
    ] {
        let text = TABLE.replace(cell, changed);
        assert!(!passes(&text), "{text}");
    }
    for (cell, span) in [("<td>", "<td COLSPAN=1>"), ("<th>h", "<th rowspan=1>h")] {
        let spanned = TABLE.replace(cell, span);
        assert!(answer(&spanned, &["2"]).is_none(), "{spanned}");
        for text in [format!("{TABLE}{spanned}"), format!("{spanned}{TABLE}")] {
            says(answer(&text, &["2"]), false, "an HTML table with spans");
        }
    }
}

/// The tables of a text, each below a line that says what it is.
fn titled(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.split("====\n")
        .filter_map(|part| part.split_once('\n'))
}

#[test]
fn tables_as_programs_print_them_pass() {
    for (title, table) in titled(include_str!("printed.txt")) {
        assert!(passes(table), "{title}");
    }
}

#[test]
fn what_hides_an_error_does_not_pass() {
    for (title, table) in titled(include_str!("hidden.txt")) {
        assert!(!passes(table), "{title}");
    }
}

#[test]
fn each_form_of_the_page_is_read() {
    let page = include_str!("../../book/src/tables.md");
    let parts = page.split("```text\n").skip(1);
    let tables = parts.filter_map(|part| Some(part.split_once("```")?.0));
    let judged = tables.map(|table| says(answer(table, &["L2=2", "H1=1"]), true, ""));
    assert_eq!(judged.count(), 4);
}
