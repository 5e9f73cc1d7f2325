//! Tables and figures of a study.

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

/// A picture.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Figure {
    /// File name without folder: `<what>.svg`, and `<id>-<what>.svg` once the study's outcome is
    /// settled.
    pub file: String,
    /// What the figure shows, in a sentence: caption and alternative text.
    pub caption: String,
    /// The picture; in a record it is a separate file.
    #[serde(skip)]
    pub svg: String,
}

impl Figure {
    /// A picture of a study, in the file `<what>.svg`.
    pub fn new(what: &str, caption: impl Into<String>, svg: String) -> Self {
        Self {
            file: format!("{what}.svg"),
            caption: caption.into(),
            svg,
        }
    }
}
