//! `rates` with several tables, in several formats, and from a pipe.

use std::fs;
use std::io::Write;
use std::process::Stdio;

use convergence_study_tests::{Ended, finished};
use tempfile::TempDir;

use super::{command, run, run_words, write};

/// Tables of second and of first order, and a file with both.
fn place() -> TempDir {
    let root = tempfile::tempdir().unwrap();
    let second = "h,\"L2 [Pa, mean]\"\n0.4,1.600e-1\n0.2,4.000e-2\n0.1,1.000e-2\n0.05,2.500e-3\n";
    let first = "h,H1\n0.4,4.000e-1\n0.2,2.000e-1\n0.1,1.000e-1\n0.05,5.000e-2\n";
    write(&root, "a.csv", second);
    write(&root, "b.csv", first);
    let second = second.replace("\"L2 [Pa, mean]\"", "L2");
    let both = format!("Degree 1\n{second}\nDegree 2\n{first}");
    write(&root, "both.txt", both);
    root
}

#[test]
fn each_table_is_judged_under_its_name() {
    let root = place();
    let claims = ["--order", "L2=2", "--order", "H1=1"];
    let with =
        |files: &[&str], claims: &[&str]| run_words(&root, &[&["rates"], files, claims].concat());
    let (status, out, err) = with(&["a.csv", "b.csv"], &claims).parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    assert!(
        out.starts_with("a.csv\nstep: `h`") && out.contains("\n\nb.csv\nstep: `h`"),
        "{out}"
    );
    assert!(out.ends_with("\n\npass: 2 of 2 tables agree\n"), "{out}");
    // One that fails decides.
    let (status, out, _) = with(&["a.csv", "b.csv"], &["--order", "2"]).parts();
    assert_eq!(status, Some(1));
    assert!(
        out.contains("H1: fail: 1.000") && out.ends_with("fail: 1 of 2 tables agree\n"),
        "{out}"
    );
    let (_, out, _) = with(&["a.csv", "b.csv"], &["--order", "2", "--quiet"]).parts();
    assert!(
        out.starts_with("b.csv\nH1: fail") && !out.contains("a.csv"),
        "{out}"
    );
    // So does one without a claim.
    with(&["a.csv", "b.csv"], &claims[..2]).says(1, "");
    let (_, out, _) = with(&["a.csv", "b.csv"], &["--order", "2", "--format", "json"]).parts();
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    let tables = object["tables"].as_array().unwrap();
    assert_eq!(object["verdict"], "fail");
    assert_eq!(
        (&tables[1]["table"], &tables[1]["verdict"]),
        (&"b.csv".into(), &"fail".into())
    );
    assert_eq!(tables[0]["verdict"], "pass");
    for (files, claims, words) in [
        (
            &["a.csv", "b.csv"][..],
            &["--order", "L3=2"][..],
            "--order L3=2: expected a column of errors: L2 [Pa, mean], H1; found `L3`",
        ),
        (
            &["a.csv", "missing.csv"],
            &["--order", "2"],
            "missing.csv: ",
        ),
    ] {
        with(files, claims).refuses(words);
    }
}

#[test]
fn tables_of_one_file_are_judged_under_their_headings() {
    let root = place();
    let claims = ["--order", "L2=2", "--order", "H1=1"];
    let (status, out, err) = run_words(
        &root,
        &[&["rates", "both.txt", "-o", "out"], &claims[..]].concat(),
    )
    .parts();
    assert_eq!((status, err.as_str()), (Some(0), ""), "{out}");
    assert!(
        out.starts_with("both.txt: Degree 1\n") && out.contains("\nboth.txt: Degree 2\n"),
        "{out}"
    );
    let read = |name: &str| fs::read_to_string(root.path().join("out").join(name)).unwrap();
    let page = read("rates.md");
    assert!(
        page.contains("](rates-1.svg)") && page.contains("](rates-2.svg)"),
        "{page}"
    );
    assert!(page.ends_with("**pass**: 2 of 2 tables agree\n"), "{page}");
    assert!(
        read("rates-1.svg").contains("L2, order 2") && read("rates-2.svg").contains("H1, order 1")
    );
    let junit = read("junit.xml");
    assert_eq!(junit.matches("<testsuite ").count(), 2, "{junit}");
    assert!(junit.contains("both.txt: Degree 2"), "{junit}");
}

#[test]
fn rows_come_as_csv_and_as_markdown() {
    let root = place();
    let with = |format: &str, files: &[&str]| {
        let claims = ["--order", "2", "--format", format];
        run_words(&root, &[&["rates"], files, &claims[..]].concat()).stdout
    };
    assert_eq!(
        with("csv", &["a.csv"]),
        "h,\"L2 [Pa, mean]\",rate\n0.4,1.6000e-1,-\n0.2,4.0000e-2,2.0000\n0.1,1.0000e-2,2.0000\n0.05,2.5000e-3,2.0000\n"
    );
    assert_eq!(
        with("md", &["a.csv"]),
        "| h | L2 \\[Pa, mean\\] | rate |\n| --: | --: | --: |\n| 0.4 | 1.6000e-1 | - |\n\
         | 0.2 | 4.0000e-2 | 2.0000 |\n| 0.1 | 1.0000e-2 | 2.0000 |\n| 0.05 | 2.5000e-3 | 2.0000 |\n"
    );
    let both = with("csv", &["a.csv", "b.csv"]);
    assert!(
        both.starts_with("# a.csv\nh,") && both.contains("\n\n# b.csv\nh,H1,rate\n"),
        "{both}"
    );
    let both = with("md", &["both.txt"]);
    assert!(
        both.starts_with("## both.txt: Degree 1\n\n| h | L2 | rate |\n"),
        "{both}"
    );
    let latex = with("latex", &["both.txt"]);
    assert_eq!(
        latex.matches("\\begin{tabular}{rrr}\n\\toprule\n").count(),
        2,
        "{latex}"
    );
    assert!(
        latex.starts_with("% both.txt: Degree 1\n% L2: pass: 2.0000"),
        "{latex}"
    );
    // The exit status is that of the verdict.
    let arguments = ["rates", "b.csv", "--order", "2", "--format", "csv"];
    run_words(&root, &arguments).says(1, "");
}

#[test]
fn a_table_that_is_piped_needs_no_name() {
    let root = place();
    let mut child = command(root.path(), &["rates", "--order", "2"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let table = fs::read(root.path().join("a.csv")).unwrap();
    child.stdin.take().unwrap().write_all(&table).unwrap();
    let Ended { status, stdout, .. } = finished(child).into();
    assert!(
        status == Some(0) && stdout.contains("L2 [Pa, mean]: pass"),
        "{stdout}"
    );
    // Without input there is no table.
    let ran = run(&root, "rates --order 2");
    ran.complains(2, "standard input");
    ran.complains(2, "an empty table");
}

#[test]
fn an_order_that_is_none_is_refused_with_all_forms() {
    let root = place();
    for order in ["two", "L2=two", ">=", "-1"] {
        run_words(&root, &["rates", "a.csv", "--order", order]).refuses(
            "expected a number > 0, '>=P' with such a number P, or NAME= before one of them",
        );
    }
}

#[test]
fn rows_come_as_latex_with_rates_between_them() {
    let root = tempfile::tempdir().unwrap();
    let table = "h,L2_u,H1\n0.4,1.600e-1,4.000e-1\n0.2,4.000e-2,2.000e-1\n0.1,1.000e-2,1.000e-1\n0.05,2.500e-3,5.000e-2\n";
    write(&root, "t.csv", table);
    let with = |more: &[&str]| {
        let arguments = ["rates", "t.csv", "--order", "L2_u=2", "--format", "latex"];
        run_words(&root, &[&arguments, more].concat()).stdout
    };
    let half = r"\\[-0.5\normalbaselineskip]";
    let expected = format!(
        r"% t.csv
% L2_u: pass: 2.0000 (1.9990 to 2.0010), claimed 2 ± 0.25: 2, not 1.5 or 2.5
% H1: inconclusive: 1.0000 (0.9991 to 1.0009): no order is claimed
\begin{{tabular}}{{rrrrr}}
\toprule
h & L2\_u & rate & H1 & rate \\
\midrule
$0.4$ & $1.6000 \cdot 10^{{-1}}$ &  & $4.0000 \cdot 10^{{-1}}$ & {half}
 &  & $\mathbf{{2.0000}}$ &  & $1.0000$ {half}
$0.2$ & $4.0000 \cdot 10^{{-2}}$ &  & $2.0000 \cdot 10^{{-1}}$ & {half}
 &  & $\mathbf{{2.0000}}$ &  & $1.0000$ {half}
$0.1$ & $1.0000 \cdot 10^{{-2}}$ &  & $1.0000 \cdot 10^{{-1}}$ & {half}
 &  & $\mathbf{{2.0000}}$ &  & $1.0000$ {half}
$0.05$ & $2.5000 \cdot 10^{{-3}}$ &  & $5.0000 \cdot 10^{{-2}}$ &  \\
\midrule
rate & \multicolumn{{2}}{{r}}{{\textbf{{1.9990--2.0010}}}} & \multicolumn{{2}}{{r}}{{0.9991--1.0009}} \\
\bottomrule
\end{{tabular}}
"
    );
    assert_eq!(with(&[]), expected);
    // A level that is set aside has a mark, which is explained.
    let latex = with(&["--floor", "1e-2"]);
    assert!(
        latex.contains(r"$2.5000 \cdot 10^{-3}$\textsuperscript{c}")
            && latex.contains(
                r"{\footnotesize \textsuperscript{c} set aside: not above the floor 1e-2} \\"
            ),
        "{latex}"
    );
}
