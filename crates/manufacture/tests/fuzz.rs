//! Files made of pieces of others: each is refused with its place, or it is derived, checked and
//! emitted without a panic.
//!
//! `MANUFACTURE_FUZZ=10000` makes more files.

use proptest::prelude::*;

use crate::prelude::*;

const FILES: [&str; 6] = [
    HEAT,
    PFHUB,
    BEAM,
    SOLID,
    PIECES,
    include_str!("files/ethier-steinman.toml"),
];

/// Words of the language and of files, numbers and signs.
fn tokens(text: &str) -> Vec<&str> {
    let mut tokens = vec![];
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let length = match rest.find(|c| !is_word(c)) {
            Some(0) => first.len_utf8(),
            Some(length) => length,
            None => rest.len(),
        };
        tokens.push(&rest[..length]);
        rest = &rest[length..];
    }
    tokens
}

/// What is done to a file: at a place so many tokens are replaced by tokens of another file.
#[derive(Debug, Clone)]
struct Splice {
    place: usize,
    length: usize,
    file: usize,
    from: usize,
    count: usize,
}

fn splices() -> impl Strategy<Value = Vec<Splice>> {
    let splice = (
        any::<usize>(),
        0..4usize,
        0..FILES.len(),
        any::<usize>(),
        0..6usize,
    );
    let splice = splice.prop_map(|(place, length, file, from, count)| Splice {
        place,
        length,
        file,
        from,
        count,
    });
    prop::collection::vec(splice, 1..4)
}

fn spliced(file: usize, splices: &[Splice]) -> String {
    let mut all = tokens(FILES[file]);
    for splice in splices {
        let other = tokens(FILES[splice.file]);
        let place = splice.place % all.len();
        let end = (place + splice.length).min(all.len());
        let from = splice.from % other.len();
        let until = (from + splice.count).min(other.len());
        all.splice(place..end, other[from..until].iter().copied());
        if all.is_empty() {
            break;
        }
    }
    all.concat()
}

fn cases() -> u32 {
    let number = std::env::var("MANUFACTURE_FUZZ").ok();
    number.and_then(|text| text.parse().ok()).unwrap_or(200)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]

    #[test]
    fn a_spliced_file_is_refused_with_its_place_or_emitted(file in 0..FILES.len(), splices in splices()) {
        let text = spliced(file, &splices);
        match Manufacture::parse(&text, "fuzz.toml") {
            Err(error) => prop_assert!(error.to_string().starts_with("fuzz.toml:"), "{error}"),
            Ok(manufacture) => {
                let sampling = Sampling { points: 2, ..Sampling::default() };
                if let Err(error) = manufacture.check(&sampling) {
                    prop_assert!(error.to_string().starts_with("fuzz.toml:"), "{error}");
                }
                for (_, language) in Language::ALL {
                    prop_assert!(language == Language::Ufl || manufacture.emit(language).len() >= 2);
                }
            }
        }
    }
}
