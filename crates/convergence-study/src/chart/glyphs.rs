//! Widths of texts: nothing else, so that tests of figures in other crates read it, too.

/// Width of a text in px, estimated generously: exact widths would need font files.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    size * text.chars().map(glyph_width).sum::<f64>()
}

/// Advance of one glyph in em, after DejaVu Sans, rounded up.
pub(crate) fn glyph_width(c: char) -> f64 {
    match c {
        // A combining circumflex stands on the letter before it.
        '\u{302}' => 0.0,
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | 'I' | ' ' => 0.33,
        '‖' => 0.5,
        'f' | 't' | 'r' | '(' | ')' | '-' | '/' | '[' | ']' => 0.42,
        '⁰' | '¹' | '²' | '³' | '⁴'..='⁹' | '₀'..='₉' | '⁻' | 'ₕ' | 'ₓ' | 'ₜ' | 'ₙ' => {
            0.43
        }
        'm' | 'w' | 'M' | 'W' | '%' => 0.98,
        'A'..='Z' | '=' | '+' | '−' | '×' | '<' | '>' | '≥' | '≤' => 0.8,
        _ => 0.64,
    }
}
