//! Attacks on the reader of tables: texts that look like tables that pass, and must not.

mod accounted;
mod claims;
mod documents;
mod forms;
mod laws;
mod limits;
mod options;
mod rules;

use convergence_study::rates::{Choice, Claimed, Page, Refusal, Request};
use forms::{Form, Law, Table, cells};

/// The verdict on a text and the line that says it; `None` for a refusal.
fn answer(text: &str, orders: &[&str]) -> Option<Page> {
    chosen(text, orders, Choice::default()).ok()
}

/// The same with a choice.
fn chosen(text: &str, orders: &[&str], choice: Choice) -> Result<Page, Refusal> {
    request(orders, choice).page("rates", text)
}

fn request(orders: &[&str], choice: Choice) -> Request {
    let claims: Vec<Claimed> = orders
        .iter()
        .map(|order| order.parse().expect("an order"))
        .collect();
    Request {
        claims,
        choice,
        ..Request::default()
    }
}

fn passes(text: &str) -> bool {
    answer(text, &["2"]).is_some_and(|answer| answer.verdict.is_pass())
}

/// Texts that must not pass, and those that do.
#[derive(Default)]
struct Attacks {
    count: usize,
    passed: Vec<String>,
}

impl Attacks {
    /// * `name`: of the attack, in the message.
    fn add(&mut self, text: &str, name: impl FnOnce() -> String) {
        self.count += 1;
        if passes(text) {
            self.passed.push(name());
        }
    }

    fn none_pass(&self) {
        let Self { count, passed } = self;
        let first = &passed[..passed.len().min(12)];
        assert!(
            passed.is_empty(),
            "{} of {count}: {}",
            passed.len(),
            first.join("\n")
        );
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

/// Columns that no order 2 fits.
fn lost(levels: usize) -> Vec<(&'static str, Vec<f64>)> {
    let over = |f: fn(f64) -> f64| (0..levels).map(|k| f(k as f64)).collect();
    vec![
        (
            "stalls",
            over(|k| [3e-2, 8e-3, 5e-3, 4.8e-3, 4.75e-3, 4.74e-3][k as usize]),
        ),
        ("grows", over(|k| 1e-3 * 1.7_f64.powf(k))),
        (
            "tends to a constant",
            over(|k| 0.65 + 0.1 * 0.25_f64.powf(k)),
        ),
        ("stands still", over(|_| 0.0699)),
        ("falls like h", over(|k| 0.3 * 0.5_f64.powf(k))),
        (
            "grows in whole numbers",
            over(|k| [3.0, 5.0, 9.0, 14.0, 22.0, 35.0][k as usize]),
        ),
        ("scatters", over(|k| 0.01 * (1.0 + 0.7 * (2.0 * k).sin()))),
        ("is zero", over(|_| 0.0)),
        ("is negative", over(|k| -0.1 * 0.25_f64.powf(k))),
    ]
}

#[test]
fn tables_of_each_form_pass_alone() {
    for form in Form::ALL {
        for levels in [4, 5, 6] {
            let text = form.write(&Table::new(
                "h",
                Law { levels, ..LAW },
                &[("L2", 2.0), ("H1", 2.0)],
            ));
            assert!(passes(&text), "{form:?}:\n{text}");
        }
    }
}

#[test]
fn a_column_that_loses_its_order_does_not_pass_under_a_neutral_name() {
    let mut attacks = Attacks::default();
    for form in Form::ALL {
        for name in NEUTRAL {
            for (what, numbers) in lost(LAW.levels) {
                for errors in [&[("L2", 2.0)][..], &[("L2", 2.0), ("H1", 2.0)]] {
                    let mut table = Table::new("h", LAW, errors);
                    table.add(name, cells(&numbers));
                    attacks.add(&form.write(&table), || format!("{form:?} {name} {what}"));
                }
            }
        }
    }
    attacks.none_pass();
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
    let mut attacks = Attacks::default();
    for form in Form::ALL {
        for name in NEUTRAL {
            for word in WORDS {
                for rows in [LAW.levels - 1..LAW.levels, 2..3, 1..LAW.levels] {
                    let mut table = Table::new("h", LAW, &[("L2", 2.0)]);
                    let mut column = cells(
                        &Law {
                            constant: 0.3,
                            ..LAW
                        }
                        .errors(),
                    );
                    column[rows].fill(word.to_owned());
                    table.add(name, column);
                    attacks.add(&form.write(&table), || format!("{form:?} {name} {word}"));
                }
            }
        }
    }
    attacks.none_pass();
}

#[test]
fn a_level_that_a_mark_says_not_to_be_solved_fails() {
    let mut attacks = Attacks::default();
    for form in Form::ALL {
        for (name, good, bad) in [
            ("converged", "True", "False"),
            ("status", "CONVERGED_RTOL", "DIVERGED_ITS"),
            ("converged", "1", "0"),
        ] {
            let mut table = Table::new("h", LAW, &[("L2", 2.0)]);
            let mut column = vec![good.to_owned(); LAW.levels];
            let all = Table {
                rows: table.rows.clone(),
                ..table.clone()
            };
            column[3] = bad.to_owned();
            table.add(name, column);
            attacks.add(&form.write(&table), || format!("{form:?} {name} {bad}"));
            let mut all = all;
            all.add(name, vec![good.to_owned(); LAW.levels]);
            let text = form.write(&all);
            assert!(passes(&text), "{form:?} {name} {good}:\n{text}");
        }
    }
    attacks.none_pass();
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

#[test]
fn two_tables_in_one_text_do_not_pass_unless_each_does() {
    let fails = Law {
        order: 1.0,
        levels: 4,
        ..LAW
    };
    let mut attacks = Attacks::default();
    for (k, first) in Form::ALL.into_iter().enumerate() {
        // The same form, and two others; all hundred pairs take a minute.
        for second in [0, 1, 3].map(|other| Form::ALL[(k + other) % Form::ALL.len()]) {
            for between in BREAKS {
                for (step, h) in [("h", 0.2), ("h", 0.2 / 16.0), ("dt", 0.2 / 16.0)] {
                    let good = Table::new(
                        step,
                        Law {
                            h,
                            constant: 0.1,
                            levels: 5,
                            ..LAW
                        },
                        &[("L2", 2.0)],
                    );
                    let bad = Table::new("h", fails, &[("L2", 1.0)]);
                    for texts in [
                        [first.write(&bad), second.write(&good)],
                        [second.write(&good), first.write(&bad)],
                    ] {
                        attacks.add(&texts.join(between), || {
                            format!(
                                "{first:?} {second:?} {between:?} {step} {h}:\n{}",
                                texts.join(between)
                            )
                        });
                    }
                }
            }
        }
    }
    attacks.none_pass();
}

#[test]
fn a_group_column_parts_a_table() {
    let mut attacks = Attacks::default();
    for form in Form::ALL {
        for (name, groups) in [
            ("p", ["1", "2"]),
            ("method", ["upwind", "central"]),
            ("degree", ["1", "2"]),
        ] {
            for h in [0.2, 0.2 / 16.0] {
                for sorted in [false, true] {
                    let mut bad = Table::new("h", Law { order: 1.0, ..LAW }, &[("L2", 1.0)]);
                    bad.add(name, vec![groups[0].to_owned(); LAW.levels]);
                    let mut good = Table::new(
                        "h",
                        Law {
                            h,
                            constant: 0.02,
                            ..LAW
                        },
                        &[("L2", 2.0)],
                    );
                    good.add(name, vec![groups[1].to_owned(); LAW.levels]);
                    bad.rows.extend(good.rows);
                    if sorted {
                        bad.rows.sort_by(|a, b| {
                            b[0].parse::<f64>()
                                .unwrap()
                                .total_cmp(&a[0].parse().unwrap())
                        });
                    }
                    attacks.add(&form.write(&bad), || {
                        format!("{form:?} {name} {h} {sorted}")
                    });
                }
            }
        }
    }
    attacks.none_pass();
}

#[test]
fn a_line_of_a_failed_run_is_quoted_and_nothing_passes() {
    for form in Form::ALL {
        for line in [
            "Traceback (most recent call last):",
            "ERROR: run crashed",
            "Segmentation fault (core dumped)",
            "Killed",
        ] {
            let text = form.write(&Table::new("h", LAW, &[("L2", 2.0)]));
            let middle = text
                .match_indices('\n')
                .nth(text.lines().count() / 2)
                .map_or(0, |(end, _)| end + 1);
            let (above, below) = text.split_at(middle);
            for text in [
                format!("{text}{line}\n"),
                format!("{above}{line}\n{below}"),
                format!("{line}\n{text}"),
            ] {
                let answer = answer(&text, &["2"]);
                assert!(
                    answer.is_none_or(
                        |answer| !answer.verdict.is_pass() && answer.sentence.contains(line)
                    ),
                    "{form:?} {line}:\n{text}"
                );
            }
        }
    }
}
