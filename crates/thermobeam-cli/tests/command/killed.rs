//! `verify` killed at any moment, and several runs at the same time.

use super::workspace::with_studies;
use super::*;

/// Number of kills; `THERMOBEAM_KILLS` overrides it.
const KILLS: u32 = 12;

type Set = BTreeMap<String, Vec<u8>>;

type Studies = [(&'static str, String); 3];

/// Two projects.
fn both() -> [Studies; 2] {
    [["a-1", "a-2", "a-3"], ["b-1", "b-2", "b-3"]].map(|ids| ids.map(|id| (id, quick(id))))
}

/// The set that an undisturbed run writes, and its duration.
fn undisturbed(studies: &Studies) -> (Set, Duration) {
    let folder = Folder::new();
    let root = workspace(&folder, "w", studies);
    let start = Instant::now();
    (verified(&root, ""), start.elapsed())
}

/// The set after a further run.
fn verified(root: &Path, arguments: &str) -> Set {
    // Without a baseline every number is new: a fail, with reports.
    ended(&mut verify(root, arguments)).complains(1, "");
    set(&failing(root))
}

/// Where the report on a run that does not pass is.
fn failing(root: &Path) -> PathBuf {
    root.join("reports/local/quick")
}

#[test]
fn killed_at_any_moment_each_file_is_that_of_a_run_and_the_markdown_the_last() {
    let kills =
        std::env::var("THERMOBEAM_KILLS").map_or(KILLS, |kills| kills.parse().expect("a number"));
    let folder = Folder::new();
    let both = both();
    let [(first, of_first), (second, of_second)] = [undisturbed(&both[0]), undisturbed(&both[1])];
    assert!(first.keys().ne(second.keys()));
    let (sets, times) = ([first, second], [of_first, of_second]);
    let root = workspace(&folder, "killed", &both[0]);
    let reports = failing(&root);
    let mut before = Set::new();
    let (mut old, mut new, mut mixed) = (0, 0, 0);
    for kill in 0..kills {
        let turn = (kill % 2) as usize;
        with_studies(&root, &both[turn]);
        let mut child = started(&mut verify(&root, "--quiet"));
        // Spread over the run and slightly beyond, in an order that does not repeat.
        std::thread::sleep(times[turn] * (1 + kill * 37 % 101) / 80);
        child.kill().expect("it can be killed");
        finished(child);
        let mut found = set(&reports);
        // What is not finished has no name of a report, and the next run removes it.
        found.retain(|name, _| !name.contains(".unfinished-"));
        for (name, bytes) in &found {
            let is_whole = [&before, &sets[turn]]
                .iter()
                .any(|set| set.get(name) == Some(bytes));
            assert!(is_whole, "kill {kill}: {name}");
        }
        let is_in_place = |(name, bytes): (&String, &Vec<u8>)| found.get(name) == Some(bytes);
        let is_new = sets[turn].iter().all(is_in_place);
        let readme = "README.md";
        if found.get(readme) == sets[turn].get(readme) && before.get(readme) != found.get(readme) {
            assert!(is_new, "kill {kill}: the Markdown came before another file");
        }
        let is_old = found == before;
        old += u32::from(is_old && !is_new);
        new += u32::from(is_new);
        mixed += u32::from(!is_old && !is_new);
        before = found;
    }
    println!("{kills} kills: {old} left the old files, {new} the new ones, {mixed} some of both");
    with_studies(&root, &both[0]);
    assert_eq!(verified(&root, ""), sets[0]);
    let mut left: Vec<String> = all(&root).into_keys().collect();
    left.retain(|name| !name.ends_with('/') && name.contains("/."));
    assert_eq!(left, ["reports/.gitignore"]);
}

#[test]
fn what_a_killed_run_has_left_is_cleared_away_even_by_a_run_of_another_scope() {
    let folder = Folder::new();
    let root = workspace(&folder, "left", &both()[0]);
    let before = verified(&root, "");
    for name in [
        "reports/local/quick/.README.md.unfinished-77-3",
        "reports/full/figures/.x.svg.unfinished-77-3",
        "reports/local/.provenance.json.unfinished-77-3",
        "reports/.probe.unfinished-77-3",
        "studies/.baseline.json.unfinished-77-3",
    ] {
        let path = root.join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, "half").expect("a file");
    }
    assert_eq!(verified(&root, "a-1"), before);
    let mut half = all(&root);
    half.retain(|_, bytes| bytes == b"half");
    assert!(half.is_empty(), "{half:?}");
}

#[test]
fn several_at_once_leave_one_whole_set() {
    let folder = Folder::new();
    let both = both();
    let root = workspace(&folder, "shared", &both[0]);
    let children = ["", "", "a-2", "", "", "a-2"].map(|ids| started(&mut verify(&root, ids)));
    for child in children {
        Ended::from(finished(child)).complains(1, "");
    }
    assert_eq!(set(&failing(&root)), undisturbed(&both[0]).0);
    with_studies(&root, &both[1]);
    assert_eq!(verified(&root, ""), undisturbed(&both[1]).0);
}
