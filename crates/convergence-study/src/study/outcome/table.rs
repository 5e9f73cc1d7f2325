//! Tables and figures of a study.

use std::sync::{Arc, OnceLock};

use convergence_judge::verdict::Verdict;

#[cfg(feature = "tables")]
use crate::chart::{Chart, titled_by_verdict};

/// A table, printed with aligned columns.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// Column heads.
    pub head: Vec<String>,
    /// Rows of cells, one for each head.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// * `head`: a word for each cell of a row.
    pub fn new<H: Into<String>>(
        title: impl Into<String>,
        head: impl IntoIterator<Item = H>,
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> Self {
        let head = head.into_iter().map(Into::into).collect();
        Self {
            title: title.into(),
            head,
            rows: rows.into_iter().collect(),
        }
    }
}

/// A picture of a study. A chart is drawn when its picture is asked for: a verdict alone costs none.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct Figure {
    /// File name without folder: `<what>.svg`, and `<id>-<what>.svg` once the study's outcome is
    /// settled.
    pub file: String,
    /// What the figure shows, in a sentence: caption and alternative text.
    pub caption: String,
    /// The verdict with which its title begins.
    #[serde(skip)]
    titled: Option<Verdict>,
    /// In a record a picture is a separate file.
    #[serde(skip)]
    picture: Picture,
    /// Copies of a figure are drawn once.
    #[serde(skip)]
    drawn: Arc<OnceLock<String>>,
}

/// What a figure shows.
#[derive(Debug, Clone)]
enum Picture {
    /// A chart, to be drawn.
    #[cfg(feature = "tables")]
    Chart(Arc<Chart>),
    /// A picture that is drawn already, as SVG.
    Svg(String),
}

impl Default for Picture {
    fn default() -> Self {
        Self::Svg(String::new())
    }
}

impl Figure {
    /// A picture of a study, in the file `<what>.svg`.
    pub fn new(what: &str, caption: impl Into<String>, svg: String) -> Self {
        Self::showing(what, caption.into(), Picture::Svg(svg))
    }

    /// The same of a chart, which is drawn when its picture is asked for.
    #[cfg(feature = "tables")]
    pub fn of(what: &str, caption: impl Into<String>, chart: Chart) -> Self {
        Self::showing(what, caption.into(), Picture::Chart(Arc::new(chart)))
    }

    fn showing(what: &str, caption: String, picture: Picture) -> Self {
        Self {
            file: format!("{what}.svg"),
            caption,
            titled: None,
            picture,
            drawn: Arc::default(),
        }
    }

    /// The picture as SVG.
    pub fn svg(&self) -> &str {
        self.drawn.get_or_init(|| {
            let svg = match &self.picture {
                #[cfg(feature = "tables")]
                Picture::Chart(chart) => chart.svg(),
                Picture::Svg(svg) => svg.clone(),
            };
            #[cfg(feature = "tables")]
            if let Some(verdict) = self.titled {
                return titled_by_verdict(&svg, verdict);
            }
            svg
        })
    }

    /// The same figure with the picture that is read from its file.
    pub(crate) fn with_svg(self, svg: String) -> Self {
        Self {
            picture: Picture::Svg(svg),
            titled: None,
            drawn: Arc::default(),
            ..self
        }
    }

    /// The same figure, whose title begins with a verdict.
    pub(crate) fn titled_by(self, verdict: Verdict) -> Self {
        Self {
            titled: Some(verdict),
            drawn: Arc::default(),
            ..self
        }
    }
}

/// Two figures are equal if one sees the same.
impl PartialEq for Figure {
    fn eq(&self, other: &Self) -> bool {
        (&self.file, &self.caption) == (&other.file, &other.caption) && self.svg() == other.svg()
    }
}
