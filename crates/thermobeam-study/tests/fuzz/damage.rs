//! Ways to damage a file.

pub(crate) use convergence_judge::random::SplitMix as Dice;

fn one<'a, T>(of: &'a [T], dice: &mut Dice) -> &'a T {
    &of[dice.below(of.len())]
}

/// Replacements for a number.
const NUMBERS: &str = include_str!("numbers.txt");

/// Replacements for a piece of text.
const PIECES: [&str; 24] = [
    "\u{0}", "\u{feff}", "é", "π", "😀", "\u{202e}", "\r", "\r\n", "\t", "\"", "'''", "\"\"\"",
    "\\", "\\u0000", "=", "[", "]", "[[", "#", "{", "}", ",", ".", "x",
];

/// The file after one to four kinds of damage.
pub(crate) fn damaged(file: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = file.to_vec();
    for _ in 0..=dice.below(4) {
        bytes = match dice.below(12) {
            0 => flipped(bytes, dice),
            1 => truncated(bytes, dice),
            2 | 3 => lines(&bytes, dice),
            4 => inserted(bytes, dice),
            5 => nested(&bytes, dice),
            6 => words(&bytes, dice),
            _ => numbers(&bytes, dice),
        };
    }
    bytes
}

fn flipped(mut bytes: Vec<u8>, dice: &mut Dice) -> Vec<u8> {
    for _ in 0..=dice.below(3) {
        let at = dice.below(bytes.len());
        if let Some(byte) = bytes.get_mut(at) {
            *byte ^= 1 << dice.below(8);
        }
    }
    bytes
}

fn truncated(mut bytes: Vec<u8>, dice: &mut Dice) -> Vec<u8> {
    bytes.truncate(dice.below(bytes.len() + 1));
    bytes
}

/// A line is dropped, doubled, swapped with another, or moved to the end.
fn lines(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut lines: Vec<&[u8]> = bytes.split_inclusive(|&byte| byte == b'\n').collect();
    if lines.is_empty() {
        return vec![];
    }
    let (a, b) = (dice.below(lines.len()), dice.below(lines.len()));
    match dice.below(4) {
        0 => drop(lines.remove(a)),
        1 => lines.insert(b, lines[a]),
        2 => lines.swap(a, b),
        _ => {
            let line = lines.remove(a);
            lines.push(line);
        }
    }
    lines.concat()
}

fn inserted(mut bytes: Vec<u8>, dice: &mut Dice) -> Vec<u8> {
    let at = dice.below(bytes.len() + 1);
    let piece = if dice.below(3) == 0 {
        vec![dice.below(256) as u8]
    } else {
        one(&PIECES, dice).as_bytes().to_vec()
    };
    bytes.splice(at..at, piece);
    bytes
}

/// Thousands of brackets, or a part of the file inserted into itself.
fn nested(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let at = dice.below(bytes.len() + 1);
    let piece = match dice.below(4) {
        0 => one(&["(", "[", "{a=", "-", "sin(", "a.", "2^"], dice)
            .repeat(10_000)
            .into_bytes(),
        1 => one(&["x", "1", " ", "\n", "é", "9"], dice)
            .repeat(2_000)
            .into_bytes(),
        _ => {
            let start = dice.below(bytes.len());
            bytes[start..]
                .iter()
                .copied()
                .take(dice.below(400))
                .collect()
        }
    };
    [&bytes[..at], &piece, &bytes[at..]].concat()
}

/// Two words exchanged.
fn words(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let found = spans(bytes, |byte| byte.is_ascii_alphabetic() || byte == b'_');
    if found.len() < 2 {
        return bytes.to_vec();
    }
    let (a, b) = (one(&found, dice).clone(), one(&found, dice).clone());
    let mut damaged = bytes.to_vec();
    damaged.splice(a, bytes[b].iter().copied());
    damaged
}

/// Replaces one number, or three.
fn numbers(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut damaged = bytes.to_vec();
    for _ in 0..=dice.below(3) {
        let found = spans(&damaged, |byte| {
            byte.is_ascii_digit() || matches!(byte, b'.' | b'-')
        });
        if !found.is_empty() {
            let span = one(&found, dice).clone();
            let numbers: Vec<&str> = NUMBERS.lines().collect();
            damaged.splice(span, one(&numbers, dice).bytes());
        }
    }
    damaged
}

/// Runs of bytes of a kind.
fn spans(bytes: &[u8], is: impl Fn(u8) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut spans: Vec<std::ops::Range<usize>> = vec![];
    for (at, _) in bytes.iter().enumerate().filter(|(_, byte)| is(**byte)) {
        match spans.last_mut() {
            Some(span) if span.end == at => span.end = at + 1,
            _ => spans.push(at..at + 1),
        }
    }
    spans
}
