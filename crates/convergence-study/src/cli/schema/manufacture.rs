//! The keys of the files of `manufacture`, as keys of this crate. `manufacture` depends on no other
//! crate of the project, so it declares them with types of its own.

use std::sync::LazyLock;

use manufacture::keys;

use crate::input::{Form, Key, Keys};

/// The keys of the topmost table. They are made once and stay until the process ends, as those of
/// other files, which are constants.
pub(super) fn keys() -> Keys {
    static KEYS: LazyLock<Keys> = LazyLock::new(|| set(&keys::FILE));
    *KEYS
}

fn set(keys: &[keys::Key]) -> Keys {
    if keys.is_empty() {
        return &[];
    }
    let keys: Vec<Key> = keys.iter().map(key).collect();
    vec![&*keys.leak()].leak()
}

fn key(key: &keys::Key) -> Key {
    let keys::Key {
        name,
        form: values,
        default,
        meaning,
    } = *key;
    Key {
        name,
        form: form(values),
        default,
        meaning,
    }
}

fn form(values: keys::Form) -> Form {
    match values {
        keys::Form::Text => Form::Text,
        keys::Form::Count(least) => Form::Count(least),
        keys::Form::Number => Form::Number,
        keys::Form::Choice(names) => Form::Choice(names),
        keys::Form::List(items) => Form::List(stays(form(*items))),
        keys::Form::OneOf(forms) => {
            let forms: Vec<Form> = forms.iter().map(|one| form(*one)).collect();
            Form::OneOf(forms.leak())
        }
        keys::Form::Table(keys) => Form::Table(vec![set(keys)].leak()),
        keys::Form::Named(keys, others) => Form::Named(set(keys), stays(form(*others))),
    }
}

fn stays(form: Form) -> &'static Form {
    Box::leak(Box::new(form))
}
