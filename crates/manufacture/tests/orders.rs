//! What must not depend on the order of keys, or on the names of coordinates.

use std::sync::LazyLock;

use proptest::prelude::*;

use crate::prelude::*;

const FILES: [&str; 5] = [
    HEAT,
    BEAM,
    SOLID,
    PIECES,
    include_str!("files/ethier-steinman.toml"),
];

/// All files that are emitted, one after the other.
fn emitted(text: &str) -> Vec<String> {
    let manufacture = read(text);
    let files = Language::ALL.map(|known| manufacture.emit(known.1));
    let texts = files.into_iter().flatten().map(|file| file.text);
    texts
        .chain(manufacture.study().map(|file| file.text))
        .collect()
}

/// The tables of a file: a header, and the keys below it, each in one line.
fn tables(text: &str) -> Vec<Vec<&str>> {
    let mut tables: Vec<Vec<&str>> = vec![];
    for line in text.lines() {
        match tables.last_mut() {
            Some(table) if !line.starts_with('[') => table.push(line),
            _ => tables.push(vec![line]),
        }
    }
    tables
}

/// A file with its tables, and the keys of each table, in another order.
fn reordered(text: &str, seed: u64) -> String {
    let mut state = seed;
    let mut draw = |_: &&str| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        state >> 33
    };
    let mut tables = tables(text);
    tables.sort_by_cached_key(|table| draw(&table[0]));
    for table in &mut tables {
        table[1..].sort_by_cached_key(&mut draw);
    }
    tables.concat().join("\n") + "\n"
}

/// The text without the hash of the input.
fn without_hash(text: &str) -> String {
    let Some((before, rest)) = text.split_once(", input ") else {
        return text.to_owned();
    };
    format!("{before}{}", &rest[16..])
}

/// A file with faces on both sides of both coordinates, whose names are these.
fn flow(names: [&str; 2]) -> String {
    let [x, y] = names;
    format!(
        "[manufacture]\nname = \"flow\"\ncoordinates = [\"{x}\", \"{y}\"]\ntime = \"t\"\n\
         [domain]\n{x} = [0, 1]\n{y} = [1, 3]\nt = [0, 1]\n[parameters]\nnu = 0.3\n\
         [exact]\nv = [\"sin({x} + 2*{y})*exp(-t)\", \"{x}*cos({y})\"]\np = \"{x}^2*{y}\"\n\
         [define]\nsigma = \"-p*identity + 2*nu*sym(grad(v))\"\n\
         [equations]\nmomentum = \"dt(v) + dot(grad(v), v) - div(sigma)\"\nmass = \"d(v[{x}], {x}) + d(v[2], {y})\"\n\
         [boundary.{x}_max]\ntraction = \"dot(sigma, n)\"\n[boundary.{y}_min]\nv = \"v\"\n\
         [boundary.{y}_max]\nflux = \"dot(grad(p), n)\"\n[norms]\nv = [\"L2\"]\n"
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn the_same_bytes_are_emitted_for_any_order_of_keys(seed in any::<u64>(), place in 0..5usize) {
        static EMITTED: LazyLock<[Vec<String>; 5]> = LazyLock::new(|| FILES.map(emitted));
        prop_assert_eq!(&emitted(&reordered(FILES[place], seed)), &EMITTED[place]);
    }

    /// Names of one length, so that lines are cut at the same places; either may come first in the
    /// alphabet.
    #[test]
    fn other_names_of_coordinates_rename_what_is_emitted_and_nothing_else(
        x in "[a-z]{2}0", y in "[a-z]{2}1"
    ) {
        static ORIGINAL: LazyLock<Vec<String>> = LazyLock::new(|| emitted(&flow(["xx0", "yy1"])));
        let texts: Vec<String> = ORIGINAL
            .iter()
            .map(|text| without_hash(text).replace("xx0", &x).replace("yy1", &y))
            .collect();
        let renamed: Vec<String> = emitted(&flow([&x, &y])).iter().map(|text| without_hash(text)).collect();
        prop_assert_eq!(renamed, texts);
    }
}

/// Two files whose functions differ do not have one hash.
#[test]
fn the_hash_depends_on_the_system_and_on_the_norms() {
    let plane = flow(["x", "y"]);
    let polar = plane.replace("time = \"t\"", "time = \"t\"\nsystem = \"polar\"");
    let norms = plane.replace("v = [\"L2\"]", "v = [\"L1\"]");
    let hash = |text: &str| emitted(text)[0].split_once(", input ").unwrap().1[..16].to_owned();
    let hashes = [&plane, &polar, &norms].map(|text| hash(text));
    assert!(
        hashes[0] != hashes[1] && hashes[0] != hashes[2],
        "{hashes:?}"
    );
}
