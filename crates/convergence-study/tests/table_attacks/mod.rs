//! Attacks on the reader of tables: texts that look like tables that pass, and must not.

mod accounted;
mod claims;
mod documents;
mod forms;
mod laws;
mod limits;
mod options;
mod rules;

use convergence_study::Verdict;
use convergence_study::rates::{Choice, Claimed, NotJudged, Request, Tables};
use forms::{Form, Law, Table, cells};

/// What a page shows of a text.
#[derive(Debug, serde::Deserialize)]
struct Page {
    verdict: Verdict,
    sentence: String,
    text: String,
}

impl Page {
    fn of(text: &str, request: &Request) -> Result<Self, NotJudged> {
        let page = request.page("rates", text)?;
        Ok(serde_json::from_value(page).expect("a page"))
    }
}

/// The verdict on a text and the line that says it; `None` for a refusal.
fn answer(text: &str, orders: &[&str]) -> Option<Page> {
    chosen(text, orders, Choice::default()).ok()
}

/// The same with a choice.
fn chosen(text: &str, orders: &[&str], choice: Choice) -> Result<Page, NotJudged> {
    Page::of(text, &request(orders, choice))
}

fn request(orders: &[&str], choice: Choice) -> Request {
    let claims = orders.iter().map(|order| order.parse::<Claimed>());
    Request {
        claims: claims.collect::<Result<_, _>>().expect("orders"),
        choice,
        ..Request::default()
    }
}

/// Without the words and pictures of a page: it is asked of thousands of texts.
fn passes(text: &str) -> bool {
    let judged = request(&["2"], Choice::default()).object("rates", Tables::Text(text));
    judged.is_ok_and(|judged| judged["verdict"] == "pass")
}

/// A page of this verdict has these words.
#[track_caller]
fn says(page: Option<Page>, passes: bool, words: &str) {
    let Page { verdict, text, .. } = page.expect("a table");
    let is_said = verdict.is_pass() == passes && text.contains(words);
    assert!(is_said, "{passes}, {words}:\n{text}");
}

/// What holds of a table in each form.
#[track_caller]
fn in_each_form(table: &Table, holds: impl Fn(&str) -> bool) {
    for form in Form::ALL {
        let text = form.write(table);
        assert!(holds(&text), "{form:?}:\n{text}");
    }
}

#[track_caller]
fn never_passes(table: &Table) {
    in_each_form(table, |text| !passes(text));
}

/// None of many tables passes, each in one form, in turn. What is left out depends on a name and on
/// numbers: each of these comes in nearly all forms.
#[track_caller]
fn none_passes(tables: impl Iterator<Item = Table>) {
    for (table, form) in tables.zip(Form::ALL.into_iter().cycle()) {
        let text = form.write(&table);
        assert!(!passes(&text), "{form:?}:\n{text}");
    }
}

/// A table with each of the columns under each of the names.
fn with_each<'t>(
    table: &'t Table,
    names: impl Iterator<Item = &'t str>,
    columns: &'t [Vec<String>],
) -> impl Iterator<Item = Table> {
    names.flat_map(move |name| {
        columns
            .iter()
            .map(move |column| table.clone().with(name, column))
    })
}

/// Whatever the order, two texts do not pass as one.
#[track_caller]
fn never_pass_together(one: &str, other: &str, between: &str) {
    for texts in [[one, other], [other, one]] {
        let text = texts.join(between);
        assert!(!passes(&text), "{text}");
    }
}

const LAW: Law = Law {
    h: 0.2,
    levels: 5,
    order: 2.0,
    constant: 0.7,
};

/// Names that say nothing.
const NEUTRAL: [&str; 6] = ["T", "ph", "B1", "Ux", "CN", "kappa"];

#[test]
fn tables_of_each_form_pass_alone() {
    for levels in [4, 5, 6] {
        let law = Law { levels, ..LAW };
        in_each_form(&Table::new("h", law, &[("L2", 2.0), ("H1", 2.0)]), passes);
    }
}

#[test]
fn a_level_without_a_result_fails_in_every_form() {
    const WORDS: [&str; 14] = [
        "nan",
        "NaN",
        "-nan",
        "-nan(ind)",
        "1.#QNAN",
        "NaNQ",
        "inf",
        "********",
        "diverged",
        "failed",
        "null",
        "None",
        "-",
        "DIVERGED",
    ];
    let law = Law {
        constant: 0.3,
        ..LAW
    };
    let mut columns = vec![];
    for word in WORDS {
        for rows in [LAW.levels - 1..LAW.levels, 2..3, 1..LAW.levels] {
            let mut column = cells(&law.errors());
            column[rows].fill(word.to_owned());
            columns.push(column);
        }
    }
    none_passes(with_each(&Table::of(LAW), NEUTRAL.into_iter(), &columns));
}

#[test]
fn a_level_that_a_mark_says_not_to_be_solved_fails() {
    for (name, good, bad) in [
        ("converged", "True", "False"),
        ("status", "CONVERGED_RTOL", "DIVERGED_ITS"),
        ("converged", "1", "0"),
    ] {
        let mut column = [good; LAW.levels];
        in_each_form(&Table::of(LAW).with(name, column), passes);
        column[3] = bad;
        never_passes(&Table::of(LAW).with(name, column));
    }
}

/// What may stand between two tables.
const BREAKS: [&str; 9] = [
    "",
    "\n",
    "Scheme: central\n",
    "# central scheme\n",
    "## Central\n\n",
    "\nP2 elements\n",
    "----------------\n",
    "\n\n\n",
    "p = 2\n",
];

/// A table of order 1.
const FAILS: Law = Law { order: 1.0, ..LAW };

#[test]
fn two_tables_in_one_text_do_not_pass_unless_each_does() {
    let bad = Table::of(Law { levels: 4, ..FAILS });
    for (k, first) in Form::ALL.into_iter().enumerate() {
        // The same form, and two others; all hundred pairs take a minute.
        for second in [0, 1, 3].map(|other| Form::ALL[(k + other) % Form::ALL.len()]) {
            for (step, h) in [("h", 0.2), ("h", 0.2 / 16.0), ("dt", 0.2 / 16.0)] {
                let law = Law {
                    h,
                    constant: 0.1,
                    ..LAW
                };
                let good = second.write(&Table::new(step, law, &[("L2", 2.0)]));
                for between in BREAKS {
                    never_pass_together(&first.write(&bad), &good, between);
                }
            }
        }
    }
}

#[test]
fn a_group_column_parts_a_table() {
    for (name, [one, other]) in [
        ("p", ["1", "2"]),
        ("method", ["upwind", "central"]),
        ("degree", ["1", "2"]),
    ] {
        for h in [0.2, 0.2 / 16.0] {
            let law = Law {
                h,
                constant: 0.02,
                ..LAW
            };
            let mut both = Table::of(FAILS).with(name, [one; LAW.levels]);
            both.rows
                .extend(Table::of(law).with(name, [other; LAW.levels]).rows);
            never_passes(&both);
            let step = |row: &Vec<String>| row[0].parse::<f64>().unwrap();
            both.rows.sort_by(|a, b| step(b).total_cmp(&step(a)));
            never_passes(&both);
        }
    }
}

#[test]
fn a_line_of_a_failed_run_is_quoted_and_nothing_passes() {
    for line in [
        "Traceback (most recent call last):",
        "ERROR: run crashed",
        "Segmentation fault (core dumped)",
        "Killed",
    ] {
        in_each_form(&Table::of(LAW), |text| {
            let lines: Vec<&str> = text.split_inclusive('\n').collect();
            [0, lines.len() / 2, lines.len()].into_iter().all(|place| {
                let (above, below) = lines.split_at(place);
                let text = [&above.concat(), line, "\n", &below.concat()].concat();
                let is_quoted =
                    |page: Page| !page.verdict.is_pass() && page.sentence.contains(line);
                answer(&text, &["2"]).is_none_or(is_quoted)
            })
        });
    }
}
