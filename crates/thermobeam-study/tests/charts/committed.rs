//! The pictures of the reports show the numbers of the baseline.

use std::collections::{BTreeMap, BTreeSet};

use super::back::{DrawnSeries, place, series};
use super::laws::parse;
use super::of_the_reports;

/// The numbers of each study by name.
type Numbers = BTreeMap<String, BTreeMap<String, f64>>;

fn baseline() -> Numbers {
    let text = include_str!("../../../../studies/baseline.json");
    let baseline: serde_json::Value = serde_json::from_str(text).expect("JSON");
    let studies = baseline["studies"].as_object().expect("studies").iter();
    let numbers = studies.map(|(id, study)| {
        let numbers = study["numbers"].as_object().into_iter().flatten();
        let numbers =
            numbers.filter_map(|(name, number)| Some((name.clone(), number[0].as_f64()?)));
        (id.clone(), numbers.collect())
    });
    numbers.collect()
}

/// The errors of a column, `error <column>, <level>`, ascending; none unless there is one for each
/// mark.
fn errors_of(numbers: &BTreeMap<String, f64>, drawn: &DrawnSeries) -> Vec<f64> {
    let start = format!("error {}, ", drawn.columns[1]);
    let own = numbers.iter().filter(|(name, _)| name.starts_with(&start));
    let mut errors: Vec<f64> = own.map(|(_, error)| *error).collect();
    errors.sort_by(f64::total_cmp);
    if errors.len() == marks(drawn).len() {
        errors
    } else {
        vec![]
    }
}

/// The heights of the marks on the page, the lowest first, each once: an open marker has two parts.
fn marks(drawn: &DrawnSeries) -> Vec<f64> {
    let mut heights: Vec<[f64; 2]> = drawn.marks.clone();
    heights.sort_by(|one, next| next[1].total_cmp(&one[1]));
    heights.dedup_by(|next, one| (next[0] - one[0]).hypot(next[1] - one[1]) < 2.0);
    heights.into_iter().map(|at| at[1]).collect()
}

/// The study of a picture `<id>-<what>.svg`.
fn study_of<'n>(numbers: &'n Numbers, path: &str) -> Option<&'n BTreeMap<String, f64>> {
    let name = path.rsplit('/').next()?;
    let ids = numbers
        .keys()
        .filter(|id| name.starts_with(&format!("{id}-")));
    numbers.get(ids.max_by_key(|id| id.len())?)
}

/// A line drawn from another column, and a picture that is older than the baseline, stand
/// elsewhere.
#[test]
fn errors_in_the_pictures_are_those_of_the_baseline() {
    let numbers = baseline();
    let mut compared = 0;
    for (path, svg) in of_the_reports() {
        let Some(numbers) = study_of(&numbers, path) else {
            continue;
        };
        let doc = parse(&svg);
        let picture = doc.root_element();
        let drawn = series(picture);
        for line in &drawn {
            let errors = errors_of(numbers, line);
            for (error, height) in errors.iter().zip(marks(line)) {
                let off = (place(picture, 1, *error) - height).abs() / 10.0;
                assert!(
                    off < 1.0,
                    "{path}: {} is drawn {off:.0} px from {error:e}; is the picture older than the baseline?",
                    line.label
                );
            }
            compared += usize::from(!errors.is_empty());
        }
        // Of errors of one study, no two lines show the same column.
        let columns: BTreeSet<&[String; 2]> = drawn.iter().map(|line| &line.columns).collect();
        let labels: BTreeSet<&String> = drawn.iter().map(|line| &line.label).collect();
        assert!(columns.len() >= labels.len(), "{path}: {columns:?}");
    }
    assert!(compared > 100, "{compared} lines were compared");
}
