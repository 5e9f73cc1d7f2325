//! The numbers of a scene that a sweep may vary.

/// A numeric key of a scene file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Key {
    /// The table, such as `beam`.
    pub table: &'static str,
    /// The key in it, such as `beta`.
    pub name: &'static str,
    /// Whether its values are whole numbers.
    pub is_whole: bool,
}

const fn number(table: &'static str, name: &'static str) -> Key {
    Key { table, name, is_whole: false }
}

const fn whole(table: &'static str, name: &'static str) -> Key {
    Key { table, name, is_whole: true }
}

/// All of them, in the order in which a case lists them.
pub(super) const KEYS: [Key; 17] = [
    number("beam", "zeta"),
    number("beam", "a"),
    number("beam", "rho"),
    number("beam", "beta"),
    number("beam", "theta_a"),
    number("obstacles", "epsilon"),
    number("obstacles", "g1"),
    number("obstacles", "g2"),
    whole("mesh", "elements"),
    whole("mesh", "degree"),
    number("time", "dt"),
    number("time", "t_end"),
    number("time", "tolerance"),
    whole("time", "max_iterations"),
    whole("time", "degree"),
    number("time", "restart_dt"),
    number("time", "growth"),
];

/// The tables that have numeric keys.
pub(super) const TABLES: [&str; 4] = ["beam", "obstacles", "mesh", "time"];

impl Key {
    /// The dotted name, such as `beam.beta`.
    pub fn path(self) -> String {
        format!("{}.{}", self.table, self.name)
    }

    /// Whether it is the key of that table and name.
    pub(super) fn is(self, table: &str, name: &str) -> bool {
        self.table == table && self.name == name
    }

    /// A value as TOML, JSON and expressions write it; reading it back gives the same bits.
    pub(super) fn written(self, value: f64) -> String {
        if self.is_whole { format!("{value:.0}") } else { format!("{value:?}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::tables;

    #[test]
    fn every_coefficient_can_be_varied() {
        let names = |table| KEYS.iter().filter(|key| key.table == table).map(|key| key.name).collect::<Vec<_>>();
        assert_eq!(names("beam"), tables::BEAM_KEYS);
        assert_eq!(names("obstacles"), tables::OBSTACLE_KEYS);
        assert!(KEYS.iter().all(|key| TABLES.contains(&key.table)));
    }
}
