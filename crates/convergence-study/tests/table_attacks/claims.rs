//! Orders that are claimed of each table: by its degree, its heading or its number.

use convergence_study::Verdict;

use super::forms::{Form, Law, Table};
use super::{LAW, answer, in_each_form};

/// A study of degrees 1, 2 and 3, each with errors of order p + 1 and p.
fn degrees(form: Form, heading: fn(usize) -> String) -> String {
    let table = |p: usize| {
        let order = p as f64;
        let errors = [("L2", order + 1.0), ("H1", order)];
        heading(p) + &form.write(&Table::new("h", LAW, &errors))
    };
    (1..4).map(table).collect()
}

fn verdict(text: &str, orders: &[&str]) -> Option<Verdict> {
    answer(text, orders).map(|answer| answer.verdict)
}

#[test]
fn an_order_may_be_claimed_by_the_degree_in_the_heading() {
    let headings: [fn(usize) -> String; 4] = [
        |p| format!("Degree = {p}\n"),
        |p| format!("P{p} elements:\n"),
        |p| format!("# p: {p}\n"),
        |p| format!("\npolynomial degree {p}\n\n"),
    ];
    // A heading in a text of JSON makes it none.
    for form in Form::ALL.into_iter().filter(|form| !form.is_json()) {
        for heading in headings {
            let text = degrees(form, heading);
            let verdicts = ["L2=p+1", "L2=p"].map(|order| verdict(&text, &[order, "H1=p"]));
            let expected = [Verdict::Pass, Verdict::Fail].map(Some);
            assert_eq!(verdicts, expected, "{form:?}:\n{text}");
        }
    }
}

#[test]
fn an_order_may_be_claimed_by_a_column_of_degrees() {
    let [mut all, second, third] = [1, 2, 3].map(|p| {
        let order = f64::from(p) + 1.0;
        Table::of(Law { order, ..LAW }).with("p", [p; LAW.levels])
    });
    all.rows.extend([second.rows, third.rows].concat());
    in_each_form(&all, |text| {
        let verdicts = ["L2=p+1", "L2=p"].map(|order| verdict(text, &[order]));
        verdicts == [Verdict::Pass, Verdict::Fail].map(Some)
    });
}

#[test]
fn an_order_by_the_degree_needs_one() {
    let without_degree = Form::Csv.write(&Table::of(LAW));
    assert_eq!(verdict(&without_degree, &["L2=p+1"]), None);
}
