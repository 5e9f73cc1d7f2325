//! What a table may hold: readers refuse every key that is not declared for it.

use convergence_keys::{Form, Key, Keys, names};

use super::{Field, InputError, Section};

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
                .map_or(Ok(()), |field| allow_only_keys_of(key.form, &field))?;
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

/// Refuses unknown keys in a value that is a table, or a list of tables.
fn allow_only_keys_of(form: Form, field: &Field<'_>) -> Result<(), InputError> {
    match form {
        Form::Table(sets) if field.is_table() => field.section()?.allow_only(&[], sets),
        Form::Named(keys, form) if field.is_table() => {
            let section = field.section()?;
            section.keys().try_for_each(|name| {
                let mut known = keys.iter().copied().flatten();
                let known = known.find(|key| key.name == name);
                let form = known.map_or(*form, |key| key.form);
                let value = section.get(name);
                value.map_or(Ok(()), |value| allow_only_keys_of(form, &value))
            })
        }
        Form::List(form) if field.is_list() => field
            .items("a list")?
            .iter()
            .try_for_each(|item| allow_only_keys_of(*form, item)),
        Form::OneOf(forms) => forms
            .iter()
            .try_for_each(|form| allow_only_keys_of(*form, field)),
        _ => Ok(()),
    }
}
