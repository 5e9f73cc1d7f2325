//! The keys of tables, each declared once: readers refuse all others, and the schema and the
//! reference page of study files are made from the same constants.

use super::{Field, InputError, Section};

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

/// The values of a key. A reader may refuse more: a limit that depends on another key.
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

/// The same keys, all of which may be left out.
///
/// * `default`: what holds then, as for [`Key::or`].
pub const fn all_or<const N: usize>(mut keys: [Key; N], default: &'static str) -> [Key; N] {
    let mut place = 0;
    while place < N {
        keys[place] = keys[place].or(default);
        place += 1;
    }
    keys
}

/// The names of keys.
pub fn names(keys: &[&[Key]]) -> Vec<&'static str> {
    keys.iter().copied().flatten().map(|key| key.name).collect()
}

impl<'a> Section<'a> {
    /// The table of that name, which has these keys.
    pub fn table(&self, key: &str, keys: Keys) -> Result<Section<'a>, InputError> {
        let names = names(keys).join(", ");
        self.require(key, &format!("a table with {names}"))?
            .section()
    }

    /// Refuses every key, here and in the tables below, that none of these sets has. If the names
    /// that the table chooses, such as that of a method, fit some of the sets, only those count.
    ///
    /// * `shared`: keys that each of the sets has in addition.
    pub fn allow_only(&self, shared: &'static [Key], sets: &[Keys]) -> Result<(), InputError> {
        let mut fitting: Vec<Keys> = sets
            .iter()
            .copied()
            .filter(|set| self.chooses(set))
            .collect();
        if fitting.is_empty() {
            fitting = sets.to_vec();
        }
        let groups = fitting.into_iter().flatten().copied();
        let mut known: Vec<&Key> = vec![];
        for key in std::iter::once(shared).chain(groups).flatten() {
            if !known.iter().any(|other| other.name == key.name) {
                known.push(key);
            }
        }
        let names: Vec<&str> = known.iter().map(|key| key.name).collect();
        self.allow(&names)?;
        for key in known {
            self.get(key.name)
                .map_or(Ok(()), |field| key.form.allow_only(&field))?;
        }
        Ok(())
    }

    /// Whether the names in the table are among the choices of these keys.
    fn chooses(&self, set: Keys) -> bool {
        let fits = |key: &Key| match (key.form, self.get(key.name)) {
            (Form::Choice(names), Some(field)) => {
                field.text().is_ok_and(|name| names().contains(&name))
            }
            (Form::Choice(_), None) => key.default.is_some(),
            _ => true,
        };
        set.iter().copied().flatten().all(fits)
    }
}

impl Form {
    /// Refuses unknown keys in a value that is a table, or a list of tables.
    fn allow_only(self, field: &Field<'_>) -> Result<(), InputError> {
        match self {
            Self::Table(sets) if field.is_table() => field.section()?.allow_only(&[], sets),
            Self::Named(keys, form) if field.is_table() => {
                let section = field.section()?;
                section.keys().try_for_each(|name| {
                    let mut known = keys.iter().copied().flatten();
                    let known = known.find(|key| key.name == name);
                    let form = known.map_or(*form, |key| key.form);
                    let value = section.get(name);
                    value.map_or(Ok(()), |value| form.allow_only(&value))
                })
            }
            Self::List(form) if field.is_list() => field
                .items("a list")?
                .iter()
                .try_for_each(|item| form.allow_only(item)),
            Self::OneOf(forms) => forms.iter().try_for_each(|form| form.allow_only(field)),
            _ => Ok(()),
        }
    }
}
