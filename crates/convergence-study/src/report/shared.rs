//! Where the Markdown of a report finds its figures, and figures that two reports have in common.
//!
//! The full tier contains the quick one, and the report on it lies one folder below. A figure with
//! the same bytes in both is stored once, in the folder of the quick tier: the report on the full
//! tier links to `../figures/NAME`, and to `figures/NAME` where the bytes differ.
//!
//! | what is written | step | if it is killed there |
//! | --- | --- | --- |
//! | the full tier | [`share`] on its set, before the set is published | files of two runs, and the old links, until the next run |
//! | the quick tier, before | [`keep`]: the full report gets its own copy of each figure that the new set changes or lacks | each link has its figure |
//! | the quick tier, after | [`merge`]: copies that the new set equals are removed | likewise; a copy may be left, which the next report on the full tier removes |
//!
//! A link of the full report thus leads to the bytes of its own run, whatever ran since. In which
//! order the tiers were written makes no difference. Only Markdown has links: a page has its
//! figures in it.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;

use crate::store::{FIGURES, ONLY_ON_PAGE, README, ReportFolder, ReportSet};

/// The folder of the link to a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FigureFolder {
    /// That of the report itself.
    Own,
    /// That of the report one folder above.
    Above,
}

impl FigureFolder {
    /// How a link begins.
    fn link(self) -> String {
        match self {
            Self::Own => format!("]({FIGURES}/"),
            Self::Above => format!("](../{FIGURES}/"),
        }
    }

    /// The figures to which a report links there.
    fn figures(self, readme: &str) -> BTreeSet<String> {
        let link = self.link();
        readme
            .split(&link)
            .skip(1)
            .filter_map(|rest| rest.split_once(')'))
            .map(|(name, _)| name.to_owned())
            .filter(|name| is_file_name(name))
            .collect()
    }

    /// The report with the link to a figure there and no longer at the other place.
    fn of(self, name: &str, readme: &str) -> String {
        let other = match self {
            Self::Own => Self::Above,
            Self::Above => Self::Own,
        };
        let [old, new] = [other, self].map(|place| format!("{}{name})", place.link()));
        readme.replace(&old, &new)
    }
}

fn is_file_name(name: &str) -> bool {
    Path::new(name).file_name().is_some_and(|own| own == name)
}

/// The path of a figure in a set of files, by the links of the Markdown report in it.
pub(super) fn path(readme: &str, name: &str) -> String {
    if readme.contains(&format!("{}{name})", FigureFolder::Own.link())) {
        format!("{FIGURES}/{name}")
    } else {
        format!("{FIGURES}/{ONLY_ON_PAGE}/{name}")
    }
}

/// Where the picture of a figure is.
///
/// * `folder`: that of the report.
///
/// # Errors
/// The report in Markdown exists but cannot be read.
#[cfg(feature = "command-line")]
pub(crate) fn picture(folder: &Path, name: &str) -> io::Result<std::path::PathBuf> {
    use crate::store::{if_there, read_to_string};

    let own = folder.join(FIGURES).join(name);
    let only_on_page = folder.join(FIGURES).join(ONLY_ON_PAGE).join(name);
    let readme = if_there(read_to_string(&folder.join(README)))?.unwrap_or_default();
    Ok(if only_on_page.exists() {
        only_on_page
    } else if FigureFolder::Above.figures(&readme).contains(name) {
        folder.join("..").join(FIGURES).join(name)
    } else {
        own
    })
}

/// Replaces the files of a report. The caller must hold the lock.
///
/// * `tiers`: the folders of the reports on the quick tier and on the full one; others share
///   nothing.
///
/// # Errors
/// A file that cannot be read or written.
pub(crate) fn publish(
    target: &ReportFolder,
    mut files: ReportSet,
    [quick, full]: &[ReportFolder; 2],
) -> io::Result<()> {
    if target == full {
        share(&mut files, quick)?;
        return full.publish(&files);
    }
    if target != quick {
        return target.publish(&files);
    }
    keep(full, quick, &files)?;
    quick.publish(&files)?;
    merge(full, quick)
}

/// Leaves the figures out of a set that the report above has with the same bytes, and links to
/// those.
///
/// # Errors
/// A file of the report above that cannot be read.
fn share(set: &mut ReportSet, above: &ReportFolder) -> io::Result<()> {
    let Some(readme) = set.text(README) else {
        return Ok(());
    };
    let common = Common::find(&readme, above, |path| Ok(set.get(path).cloned()))?;
    for path in &common.paths {
        set.remove(path);
    }
    set.replace(README, common.readme);
    Ok(())
}

/// Figures of a report that the report above has with the same bytes.
struct Common {
    /// Their paths.
    paths: BTreeSet<String>,
    /// The report in Markdown with links to those above.
    readme: String,
}

impl Common {
    /// * `readme`: the report in Markdown.
    /// * `own`: the bytes of its file at a path; `None` if it has none.
    ///
    /// # Errors
    /// A file of either report that cannot be read.
    fn find(
        readme: &str,
        above: &ReportFolder,
        own: impl Fn(&str) -> io::Result<Option<Vec<u8>>>,
    ) -> io::Result<Self> {
        // Other files in its folder are those of somebody else, who may change them.
        let shown = above.text(README)?.unwrap_or_default();
        let shown = FigureFolder::Own.figures(&shown);
        let mut common = Self {
            paths: BTreeSet::new(),
            readme: readme.to_owned(),
        };
        for name in FigureFolder::Own.figures(readme) {
            let path = format!("{FIGURES}/{name}");
            let bytes = own(&path)?;
            if bytes.is_some() && shown.contains(&name) && bytes == above.read(&path)? {
                common.readme = FigureFolder::Above.of(&name, &common.readme);
                common.paths.insert(path);
            }
        }
        Ok(common)
    }
}

/// Copies the figures that a new set of files of the report above changes or lacks into the report
/// that links to them. Comes before the new set is published.
///
/// # Errors
/// A file that cannot be read or written.
fn keep(below: &ReportFolder, above: &ReportFolder, new: &ReportSet) -> io::Result<()> {
    let Some(readme) = below.text(README)? else {
        return Ok(());
    };
    let mut linked = readme.clone();
    let mut copies = ReportSet::default();
    for name in FigureFolder::Above.figures(&readme) {
        let path = format!("{FIGURES}/{name}");
        let now = above.read(&path)?;
        if let Some(bytes) = now.filter(|bytes| new.get(&path) != Some(bytes)) {
            copies.add(path, bytes)?;
            linked = FigureFolder::Own.of(&name, &linked);
        }
    }
    if linked == readme {
        return Ok(());
    }
    copies.add(README, linked)?;
    below.renew(&copies)
}

/// Removes the figures of a report that the report above has with the same bytes, and links to
/// those. Comes after the set of the report above is published.
///
/// # Errors
/// A file that cannot be read or written.
fn merge(below: &ReportFolder, above: &ReportFolder) -> io::Result<()> {
    let Some(readme) = below.text(README)? else {
        return Ok(());
    };
    let common = Common::find(&readme, above, |path| below.read(path))?;
    if common.paths.is_empty() {
        return Ok(());
    }
    let mut changed = ReportSet::default();
    changed.add(README, common.readme)?;
    below.renew(&changed)?;
    common.paths.iter().try_for_each(|path| below.remove(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_moves_and_its_like_stay() {
        let text = "![a](figures/a.svg) [b](figures/aa.svg) ![c](../figures/c.svg) figures/a.svg";
        let moved = FigureFolder::Above.of("a.svg", text);
        assert_eq!(
            moved,
            "![a](../figures/a.svg) [b](figures/aa.svg) ![c](../figures/c.svg) figures/a.svg"
        );
        assert_eq!(FigureFolder::Own.of("a.svg", &moved), text);
        let names = |place: FigureFolder| place.figures(text).into_iter().collect::<Vec<_>>();
        assert_eq!(names(FigureFolder::Own), ["a.svg", "aa.svg"]);
        assert_eq!(names(FigureFolder::Above), ["c.svg"]);
    }

    #[test]
    fn a_link_that_leaves_the_folder_of_figures_is_no_figure() {
        let text = "![a](../figures/../../b.svg) ![c](../figures/d/e.svg) ![f](../figures/..)";
        assert!(FigureFolder::Above.figures(text).is_empty());
    }
}
