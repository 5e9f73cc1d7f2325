//! The table `[study]`, which every kind of study file has.

use super::kind::Case;
use super::settings::Setting;

/// The kind of a study without a file: orders over levels that the caller computes.
const ORDERS: &str = "orders";

/// The kind of a study whose file has no `kind`.
#[cfg(feature = "files")]
pub(crate) const DEFAULT_KIND: &str = "orders/manufactured";

/// Longest id: it becomes part of file names, which some systems limit to 255 bytes.
const LONGEST_NAME: usize = 100;

/// When a study is run.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Tier {
    /// Always.
    Quick,
    /// Only when everything is verified.
    Full,
}

impl Tier {
    /// All tiers.
    pub const ALL: [Tier; 2] = [Tier::Quick, Tier::Full];

    /// The name in study files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Tier::Quick => "quick",
            Tier::Full => "full",
        }
    }
}

/// What a study file says about itself, whatever its kind.
///
/// ```
/// use convergence_study::{Header, Tier};
///
/// let header = Header::new("heat-space", "the error in L2 is of second order in h");
/// assert_eq!((header.id.as_str(), header.tier), ("heat-space", Tier::Quick));
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Header {
    /// The study's name: small letters, digits, `.` and `-`.
    pub id: String,
    /// The claim, in words.
    pub claim: String,
    /// When it is run.
    pub tier: Tier,
    /// The kind, which selects the reader of the rest of the file. A kind that can take its numbers
    /// from several sources is followed by one: `orders/vibration`.
    pub kind: String,
    /// The group under which reports list the study, by the property claimed; by default the kind.
    #[serde(default)]
    pub group: String,
    /// The relative change that the baseline tolerates of each of its numbers, and by which also
    /// numbers near zero may change, as if they were 1e-10: for programs that scatter, from 1e-6 to
    /// 0.1. `None`: each number has the tolerance that its kind gives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub guard: Option<f64>,
    /// Every value of the file by its dotted path, such as `expect[0].tolerance`, in the form of
    /// `input::Document::settings`, and of the files that it names, such as
    /// `problems/heat.toml: heat.rate`: the baseline keeps a hash of them, so that none changes
    /// unnoticed. Empty for a study without a file.
    #[serde(skip)]
    pub settings: Vec<(String, String)>,
    /// Where it is, of a study in code.
    #[serde(skip)]
    pub home: Option<&'static str>,
    /// Its cases as it lists them before any has run, whose labels are part of the same hash;
    /// filled in by the runner.
    #[serde(skip)]
    pub cases: Vec<Case<()>>,
}

impl Header {
    /// Whether a text can be the id of a study, for file names and command lines.
    pub fn is_id(text: &str) -> bool {
        is_name(text)
    }

    /// The header of a study without a file: of the quick tier, of the kind `orders`.
    ///
    /// * `id`: as in a study file, lowercase letters, digits, `.` and `-`, because it becomes part
    ///   of file names.
    /// * `claim`: one line of text.
    pub fn new(id: impl Into<String>, claim: impl Into<String>) -> Self {
        Self {
            id: id.into(),
            claim: claim.into(),
            tier: Tier::Quick,
            kind: ORDERS.to_owned(),
            group: ORDERS.to_owned(),
            guard: None,
            settings: Vec::new(),
            home: None,
            cases: Vec::new(),
        }
    }

    /// The values of its file, but for those of lists, as settings of every case: a number is zero
    /// or not, and each plain value of a list, such as a word of a command, is one.
    #[cfg(feature = "reports")]
    pub(crate) fn settings_of_file(&self) -> Vec<Setting> {
        let mut settings = vec![];
        for (path, value) in &self.settings {
            if path.starts_with("study.") || path.contains('[') {
                continue;
            }
            for value in value.trim_matches(['[', ']']).split(", ") {
                let words = match value.parse::<f64>() {
                    Ok(0.0) => format!("{path} = 0"),
                    Ok(_) => format!("{path} ≠ 0"),
                    Err(_) => format!("{path} {}", value.trim_matches('"')),
                };
                settings.push((path.clone(), words));
            }
        }
        settings
    }
}

/// What [`is_name`] requires.
pub(crate) const NAME: &str =
    "1 to 100 lowercase letters, digits, `.` or `-`, the first a letter or digit";

/// What [`is_kind`] requires.
#[cfg(feature = "files")]
pub(super) const KIND: &str = "1 to 100 lowercase letters, digits, `.` or `-`, the first a letter or digit; a source like this may follow a `/`";

/// Whether a text can be the name of a kind: parts as in an id, with a `/` between them.
#[cfg(feature = "files")]
pub(super) fn is_kind(text: &str) -> bool {
    text.split('/').all(is_name)
}

/// Whether a text can be a study's id, for file names and command lines.
pub(crate) fn is_name(text: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
    text.len() <= LONGEST_NAME
        && text.starts_with(plain)
        && text.chars().all(|c| plain(c) || c == '.' || c == '-')
}
