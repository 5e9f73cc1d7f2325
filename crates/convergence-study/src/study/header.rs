//! The table `[study]`, which every kind of study file has.

/// The kind of a study whose file has no `kind`.
pub(super) const DEFAULT_KIND: &str = "convergence";

/// Longest id: it becomes part of file names, which some systems limit to 255 bytes.
const LONGEST_NAME: usize = 100;

/// When a study is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Header {
    /// The study's name: small letters, digits, `.` and `-`.
    pub id: String,
    /// The claim, in words.
    pub claim: String,
    /// When it is run.
    pub tier: Tier,
    /// The kind, which selects the reader of the rest of the file.
    pub kind: String,
    /// The group under which reports list the study, by the property claimed; by default the kind.
    #[serde(default)]
    pub group: String,
    /// Every value of the file by its dotted path, such as `expect[0].tolerance`, in the form of `input::Section::settings`: the
    /// baseline keeps them, so that no claim changes unnoticed. Empty for a study without a file.
    #[serde(skip)]
    pub settings: Vec<(String, String)>,
}

impl Header {
    /// The header of a study without a file: of the quick tier, of the kind `convergence`.
    ///
    /// * `id`: as in a study file, lowercase letters, digits, `.` and `-`, because it becomes part of file names.
    /// * `claim`: one line of text.
    pub fn new(id: impl Into<String>, claim: impl Into<String>) -> Self {
        Self {
            id: id.into(),
            claim: claim.into(),
            tier: Tier::Quick,
            kind: DEFAULT_KIND.to_owned(),
            group: DEFAULT_KIND.to_owned(),
            settings: Vec::new(),
        }
    }
}

/// What [`is_name`] requires.
pub const NAME: &str = "1 to 100 lowercase letters, digits, `.` or `-`, the first a letter or digit";

/// Whether a text can be a study's id, for file names and command lines.
pub fn is_name(text: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
    text.len() <= LONGEST_NAME && text.starts_with(plain) && text.chars().all(|c| plain(c) || c == '.' || c == '-')
}
