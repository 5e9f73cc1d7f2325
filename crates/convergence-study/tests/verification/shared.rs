//! A figure that the reports on both tiers have in common is stored once, and each report shows
//! those of its own run.

use std::fs;
use std::path::{Path, PathBuf};

use convergence_study::{Scope, Study, Tier, VerifyRequest, verify};

use super::fake::{Does, Fake, PROJECT, fake, ids, request};

/// A study whose figure is drawn from its errors.
fn scaled(id: &str, scale: f64) -> Box<dyn Study> {
    Fake {
        scale,
        ..fake(id, Does::Converge)
    }
    .erased()
}

/// Blessed: only then the report is written where git holds it.
fn quick(root: &Path, scale: f64) {
    let request = VerifyRequest {
        bless: true,
        loosened: true,
        ..request(root, &["a"])
    };
    verify(&PROJECT, &[scaled("a", scale)], &request, &|_| {}).unwrap();
}

fn full(root: &Path, scale: f64) {
    let request = VerifyRequest {
        scope: Scope::Tier(Tier::Full, ids(&["a", "b"])),
        bless: true,
        ..request(root, &["a"])
    };
    let studies = [scaled("a", scale), scaled("b", 1.0)];
    verify(&PROJECT, &studies, &request, &|_| {}).unwrap();
}

/// The pictures that a report shows, with their bytes; each link must lead to a file.
fn shown(folder: &Path) -> Vec<(String, String)> {
    let readme = fs::read_to_string(folder.join("README.md")).unwrap();
    let links = readme.split("](").skip(1);
    let links = links.filter_map(|rest| rest.split_once(')'));
    let links = links
        .map(|(link, _)| link)
        .filter(|link| link.ends_with(".svg"));
    let picture = |link: &str| fs::read_to_string(folder.join(link));
    links
        .map(|link| (link.to_owned(), picture(link).expect(link)))
        .collect()
}

/// The link of a report to the figure of the study `a`, and the picture there.
fn figure(folder: &Path) -> (String, String) {
    let mut shown = shown(folder).into_iter();
    shown
        .find(|(link, _)| link.ends_with("a-errors.svg"))
        .unwrap()
}

/// A folder of reports with both tiers, and the figure of `a` in the full one when it was written.
fn both(scale: f64) -> (tempfile::TempDir, PathBuf, String) {
    let root = tempfile::tempdir().unwrap();
    let reports = root.path().join("reports");
    quick(root.path(), 1.0);
    full(root.path(), scale);
    let picture = figure(&reports.join("full")).1;
    (root, reports, picture)
}

#[test]
fn the_full_report_links_to_the_figures_of_the_quick_one() {
    let (_root, reports, picture) = both(1.0);
    let full = reports.join("full");
    assert_eq!(figure(&full).0, "../figures/a-errors.svg");
    assert!(!full.join("figures/a-errors.svg").exists());
    assert!(full.join("figures/rates.svg").is_file());
    // Its caption is that of the first: only the page shows it.
    assert!(full.join("figures/page/b-errors.svg").is_file());
    // A page holds its figures.
    let page = fs::read_to_string(full.join("index.html")).unwrap();
    assert!(page.contains(picture.trim()) && !page.contains("../figures"));
}

#[test]
fn a_figure_with_other_bytes_stays_the_reports_own() {
    let (_root, reports, picture) = both(2.0);
    assert_eq!(
        figure(&reports.join("full")),
        ("figures/a-errors.svg".to_owned(), picture.clone())
    );
    assert_ne!(figure(&reports).1, picture);
}

#[test]
fn a_quick_run_that_changes_a_figure_leaves_the_full_report_its_own() {
    let (root, reports, picture) = both(1.0);
    let full_folder = reports.join("full");
    let before = fs::read_to_string(full_folder.join("README.md")).unwrap();
    quick(root.path(), 3.0);
    assert_ne!(figure(&reports).1, picture);
    assert_eq!(
        figure(&full_folder),
        ("figures/a-errors.svg".to_owned(), picture.clone())
    );
    // The old figure again: it is stored once again, byte for byte as before.
    quick(root.path(), 1.0);
    assert_eq!(figure(&full_folder).0, "../figures/a-errors.svg");
    assert!(!full_folder.join("figures/a-errors.svg").exists());
    let after = fs::read_to_string(full_folder.join("README.md")).unwrap();
    assert_eq!(after, before);
}

#[test]
fn the_order_of_the_tiers_makes_no_difference() {
    let (_first, one, _) = both(1.0);
    let root = tempfile::tempdir().unwrap();
    full(root.path(), 1.0);
    let other = root.path().join("reports");
    assert_eq!(figure(&other.join("full")).0, "figures/a-errors.svg");
    quick(root.path(), 1.0);
    let [one, again] = [&one, &other].map(|reports| reports.join("full/README.md"));
    let [one, again] = [one, again].map(|path| fs::read_to_string(path).unwrap());
    assert_eq!(one, again);
    assert!(!other.join("full/figures/a-errors.svg").exists());
}

/// A quick run was killed between two of its moves: the full report already has its own copy.
#[test]
fn a_quick_run_that_was_killed_leaves_the_full_report_its_figures() {
    let (root, reports, picture) = both(1.0);
    quick(root.path(), 3.0);
    let newer = figure(&reports).1;
    fs::write(reports.join("figures/a-errors.svg"), "<svg>newest</svg>").unwrap();
    assert_eq!(
        figure(&reports.join("full")),
        ("figures/a-errors.svg".to_owned(), picture.clone())
    );
    // The next run of the full tier compares with what is there, and the quick one mends it.
    full(root.path(), 1.0);
    assert_eq!(
        figure(&reports.join("full")),
        ("figures/a-errors.svg".to_owned(), picture)
    );
    quick(root.path(), 3.0);
    assert_eq!(figure(&reports).1, newer);
}

#[test]
fn a_figure_that_is_gone_from_the_quick_report_stays_in_the_full_one() {
    let (root, reports, picture) = both(1.0);
    let other = VerifyRequest {
        bless: true,
        loosened: true,
        ..request(root.path(), &["c"])
    };
    verify(&PROJECT, &[scaled("c", 1.0)], &other, &|_| {}).unwrap();
    assert!(!reports.join("figures/a-errors.svg").exists());
    assert_eq!(
        figure(&reports.join("full")),
        ("figures/a-errors.svg".to_owned(), picture)
    );
}

/// The copy cannot be written, as on a full disk: nothing has changed then.
#[test]
fn without_its_copy_of_a_figure_no_report_changes() {
    let (root, reports, picture) = both(1.0);
    let full = reports.join("full");
    let before = fs::read_to_string(full.join("README.md")).unwrap();
    fs::remove_dir_all(full.join("figures")).unwrap();
    fs::write(full.join("figures"), "no folder").unwrap();
    let studies = [scaled("a", 3.0)];
    let bless = VerifyRequest {
        bless: true,
        loosened: true,
        ..request(root.path(), &["a"])
    };
    let failed = verify(&PROJECT, &studies, &bless, &|_| {});
    let message = failed.unwrap_err().to_string();
    assert!(message.contains("reports cannot be written"), "{message}");
    assert_eq!(fs::read_to_string(full.join("README.md")).unwrap(), before);
    assert_eq!(figure(&reports).1, picture);
}

/// A figure that the quick report does not show belongs to somebody else, who may change it.
#[test]
fn a_figure_that_no_report_has_written_is_not_linked() {
    let root = tempfile::tempdir().unwrap();
    let reports = root.path().join("reports");
    full(root.path(), 1.0);
    let (_, picture) = figure(&reports.join("full"));
    fs::create_dir_all(reports.join("figures")).unwrap();
    fs::write(reports.join("figures/a-errors.svg"), picture).unwrap();
    full(root.path(), 1.0);
    assert_eq!(
        figure(&reports.join("full")).0,
        "figures/a-errors.svg".to_owned()
    );
}
