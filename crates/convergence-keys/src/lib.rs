#![doc = include_str!("../README.md")]

/// A key of a table.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// Its values.
    pub form: Form,
    /// What holds without it, as in a file or in words; `None` for a key that must be there.
    pub default: Option<&'static str>,
    /// What it means, in a few words.
    pub meaning: &'static str,
}

/// The keys of one table, in groups that tables may share.
pub type Keys = &'static [&'static [Key]];

/// The values of a key. A reader may refuse more: a limit that depends on another key, or an
/// expression that it cannot parse.
#[derive(Debug, Clone, Copy)]
pub enum Form {
    /// A text in quotes.
    Text,
    /// A whole number, at least this.
    Count(usize),
    /// A finite number.
    Number,
    /// A finite number > 0.
    Positive,
    /// `true` or `false`.
    Boolean,
    /// One of these texts.
    Choice(fn() -> Vec<&'static str>),
    /// A list.
    List(&'static Form),
    /// A value of one of these forms.
    OneOf(&'static [Form]),
    /// A table with one of these sets of keys.
    Table(&'static [Keys]),
    /// A table with these keys, and with values of this form under names that the user chooses.
    Named(Keys, &'static Form),
}

impl Key {
    /// A key that must be there.
    pub const fn new(name: &'static str, form: Form, meaning: &'static str) -> Self {
        Self {
            name,
            form,
            default: None,
            meaning,
        }
    }

    /// The same key, which may be left out.
    ///
    /// * `default`: what holds then, as in a file or in words.
    #[must_use]
    pub const fn or(self, default: &'static str) -> Self {
        Self {
            default: Some(default),
            ..self
        }
    }
}

/// The names of keys.
pub fn names(keys: &[&[Key]]) -> Vec<&'static str> {
    keys.iter().copied().flatten().map(|key| key.name).collect()
}
