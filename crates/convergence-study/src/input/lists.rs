//! Lists of a document: of values, of levels that follow each other, of tables.

use std::fmt::Display;

use super::{Field, InputError, Section};

impl<'a> Section<'a> {
    /// The values of a list without a default, each by `read`.
    ///
    /// * `fits`: whether the list as a whole matches `allowed`.
    pub fn list<T>(
        &self,
        key: &str,
        allowed: &str,
        read: impl FnMut(&Field<'a>) -> Result<T, InputError>,
        fits: impl Fn(&[T]) -> bool,
    ) -> Result<Vec<T>, InputError> {
        let field = self.require(key, allowed)?;
        let list = field
            .items(allowed)?
            .iter()
            .map(read)
            .collect::<Result<Vec<T>, InputError>>()?;
        if fits(&list) {
            Ok(list)
        } else {
            Err(field.refuse_as_written(allowed))
        }
    }

    /// A list of at least `least` levels, each of which `follows` the previous one; `relation`
    /// describes this, such as `a number >`.
    pub fn sequence<T: Copy + Display>(
        &self,
        (key, allowed, least): (&str, &str, usize),
        read: impl Fn(&Field<'a>) -> Result<T, InputError>,
        (relation, follows): (&str, fn(T, T) -> bool),
    ) -> Result<Vec<T>, InputError> {
        let mut last = None;
        let level = |item: &Field<'a>| {
            let level = read(item)?;
            match last.replace(level) {
                Some(before) if !follows(before, level) => {
                    Err(item.refuse_as_written(format!("{relation} {before}, the level before")))
                }
                _ => Ok(level),
            }
        };
        self.list(key, allowed, level, |list| list.len() >= least)
    }

    /// A list of at least `least` levels without a default, each greater than the one before.
    pub fn increasing<T: Copy + Display + PartialOrd>(
        &self,
        key: &str,
        least: usize,
        read: impl Fn(&Field<'a>) -> Result<T, InputError>,
    ) -> Result<Vec<T>, InputError> {
        let allowed = list_of(least, "increasing numbers");
        let increases = |before, level| level > before;
        self.sequence((key, &allowed, least), read, ("a number >", increases))
    }

    /// The same, each less than the one before.
    pub fn decreasing<T: Copy + Display + PartialOrd>(
        &self,
        key: &str,
        least: usize,
        read: impl Fn(&Field<'a>) -> Result<T, InputError>,
    ) -> Result<Vec<T>, InputError> {
        let allowed = list_of(least, "decreasing numbers");
        let decreases = |before, level| level < before;
        self.sequence((key, &allowed, least), read, ("a number <", decreases))
    }

    /// A list of at least two whole numbers without a default, each a greater multiple of the one
    /// before.
    ///
    /// * `allowed`: what is allowed, in words.
    pub fn multiples(
        &self,
        key: &str,
        allowed: &str,
        read: impl Fn(&Field<'a>) -> Result<usize, InputError>,
    ) -> Result<Vec<usize>, InputError> {
        let follows = |before: usize, level: usize| level > before && level.is_multiple_of(before);
        self.sequence((key, allowed, 2), read, ("a multiple of", follows))
    }

    /// The tables `[[key]]`, at least one, each by `read`.
    ///
    /// * `keys`: the end of a message, such as ` with order and tolerance`.
    pub fn tables<T>(
        &self,
        key: &str,
        keys: &str,
        mut read: impl FnMut(&Section<'a>) -> Result<T, InputError>,
    ) -> Result<Vec<T>, InputError> {
        let allowed = format!("at least one table [[{key}]]{keys}");
        self.list(
            key,
            &allowed,
            |item| read(&item.section()?),
            |list| !list.is_empty(),
        )
    }
}

/// What is allowed for a list of `what` with at least `least` values.
fn list_of(least: usize, what: &str) -> String {
    if least > 1 {
        format!("a list of at least {least} {what}")
    } else {
        format!("a list of {what}")
    }
}

#[cfg(test)]
mod tests {
    use crate::input::{Field, InputError, parse};

    fn count(field: &Field<'_>) -> Result<usize, InputError> {
        field.count(1..=1000)
    }

    #[test]
    fn a_level_that_does_not_follow_the_one_before_is_refused_at_its_place() {
        let message = |text: &str| {
            let read = parse(text, "f.toml", |root| {
                root.get("up")
                    .map(|_| root.increasing("up", 3, count))
                    .transpose()?;
                root.get("down")
                    .map(|_| root.decreasing("down", 1, count))
                    .transpose()?;
                let allowed =
                    "a list of at least 2 whole numbers, each a multiple of the one before";
                root.get("by")
                    .map(|_| root.multiples("by", allowed, count))
                    .transpose()
            });
            read.map_or_else(|error| error.to_string(), |_| "read".to_owned())
        };
        for good in ["up = [1, 2, 4]", "down = [4]", "by = [2, 4, 12]"] {
            assert_eq!(message(good), "read", "{good}");
        }
        for (bad, words) in [
            (
                "up = [1, 4, 4]",
                "f.toml:1:13: up[2]: found 4; expected a number > 4, the level before",
            ),
            (
                "up = [1, 2]",
                "expected a list of at least 3 increasing numbers",
            ),
            (
                "down = [4, 8]",
                "down[1]: found 8; expected a number < 4, the level before",
            ),
            (
                "by = [2, 5]",
                "by[1]: found 5; expected a multiple of 2, the level before",
            ),
            (
                "by = [2, 2]",
                "by[1]: found 2; expected a multiple of 2, the level before",
            ),
            (
                "by = [2]",
                "expected a list of at least 2 whole numbers, each a multiple of",
            ),
        ] {
            let message = message(bad);
            assert!(message.contains(words), "{message}");
        }
    }
}
