//! The templates of a report. Every value is escaped for the language of its file, so that it reads
//! the same: no character of a text is taken for markup.

use std::borrow::Cow;
use std::io;
use std::sync::LazyLock;

use minijinja::value::Value;
use minijinja::{AutoEscape, Environment, Error, Output, State, UndefinedBehavior};

const FILES: [(&str, &str); 12] = [
    ("README.md", include_str!("templates/README.md.j2")),
    ("digest.md", include_str!("templates/digest.md.j2")),
    ("parts.md", include_str!("templates/parts.md.j2")),
    ("parts.html", include_str!("templates/parts.html.j2")),
    ("page.html", include_str!("templates/page.html.j2")),
    ("junit.xml", include_str!("templates/junit.xml.j2")),
    ("colours.css", include_str!("templates/colours.css")),
    ("page.css", include_str!("templates/page.css")),
    ("picture.css", include_str!("templates/picture.css")),
    ("page.js", include_str!("templates/page.js")),
    ("sort.js", include_str!("templates/sort.js")),
    ("picture.js", include_str!("templates/picture.js")),
];

/// How values are escaped in Markdown.
const MARKDOWN: AutoEscape = AutoEscape::Custom(Cow::Borrowed("Markdown"));

/// All templates, read once.
static ENVIRONMENT: LazyLock<Result<Environment<'static>, Error>> = LazyLock::new(environment);

fn environment() -> Result<Environment<'static>, Error> {
    let mut environment = Environment::new();
    // A line of a template that has only a block leaves no line.
    let mut syntax = environment.syntax().to_builder();
    syntax
        .trim_blocks(true)
        .lstrip_blocks(true)
        .keep_trailing_newline(true);
    environment.set_syntax(syntax.build()?);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_auto_escape_callback(|name| match name.rsplit('.').next() {
        Some("md") => MARKDOWN,
        Some("html" | "xml") => AutoEscape::Html,
        _ => AutoEscape::None,
    });
    environment.set_formatter(escaped);
    environment.add_filter("phrase", phrase);
    environment.add_filter("code", code);
    for (name, source) in FILES {
        environment.add_template(name, source)?;
    }
    Ok(environment)
}

/// A template, filled in.
///
/// # Errors
/// A template that names a value that does not exist.
pub(super) fn render(name: &str, context: impl Into<Value>) -> io::Result<String> {
    let environment = ENVIRONMENT.as_ref().map_err(in_words)?;
    let template = environment.get_template(name);
    let rendered = template.and_then(|template| template.render(context));
    rendered.map_err(|error| in_words(&error))
}

fn in_words(error: &Error) -> io::Error {
    io::Error::other(format!("{error:#}"))
}

/// Writes a value, escaped.
fn escaped(output: &mut Output<'_>, state: &mut State<'_, '_>, value: &Value) -> Result<(), Error> {
    let text = value.to_string();
    let text = match state.auto_escape() {
        _ if value.is_safe() => text,
        AutoEscape::Html => markup(&text),
        AutoEscape::Custom(_) => escaped_markdown(&text),
        _ => text,
    };
    Ok(output.write_str(&text)?)
}

/// Text in an element or an attribute of HTML or XML; lines stay.
fn markup(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\'' => escaped += "&#39;",
            '\n' => escaped.push(c),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

/// Text in a paragraph, a list or a cell of Markdown, on one line; code in backticks stays code.
pub(super) fn escaped_markdown(text: &str) -> String {
    // Unpaired backticks are not code.
    let has_code = text.matches('`').count().is_multiple_of(2);
    let mut in_code = false;
    let mut escaped = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    let mut before = ' ';
    while let Some(c) = rest.next() {
        let c = if c.is_control() { ' ' } else { c };
        // Within a word it is not markup.
        let is_within =
            before.is_alphanumeric() && rest.peek().is_some_and(|next| next.is_alphanumeric());
        let is_markup = matches!(c, '\\' | '*' | '`' | '[' | ']') || (c == '_' && !is_within);
        before = c;
        let opens_a_tag = c == '<'
            && rest
                .peek()
                .is_some_and(|next| next.is_alphabetic() || "/!?".contains(*next));
        if c == '`' && has_code {
            in_code = !in_code;
        } else if c == '|' || (!in_code && (opens_a_tag || is_markup)) {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}

/// HTML with code in backticks.
fn phrase(text: &str) -> Value {
    let parts: Vec<String> = text.split('`').map(markup).collect();
    // Unpaired backticks are not code.
    if parts.len().is_multiple_of(2) {
        return Value::from_safe_string(parts.join("`"));
    }
    let mut phrase = String::new();
    for (k, part) in parts.iter().enumerate() {
        match k % 2 {
            0 => phrase += part,
            _ => phrase += &format!("<code>{part}</code>"),
        }
    }
    Value::from_safe_string(phrase)
}

/// Code in Markdown, which knows no escapes there.
fn code(text: &str) -> Value {
    let text = text.replace('`', "'").replace(char::is_control, " ");
    Value::from_safe_string(format!("`{text}`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_a_text_is_escaped() {
        for (raw, written) in [
            ("a | b", "a \\| b"),
            ("`a|b` < c", "`a\\|b` < c"),
            ("1<2, a<b, </i>", "1<2, a\\<b, \\</i>"),
            ("3*t and 2*t", "3\\*t and 2\\*t"),
            ("`3*t`", "`3*t`"),
            ("one ` only *", "one \\` only \\*"),
            ("back\\slash|", "back\\\\slash\\|"),
            ("two\nlines", "two lines"),
            ("[a](b) ![c]", "\\[a\\](b) !\\[c\\]"),
            ("u_t, _x_ and __y", "u_t, \\_x\\_ and \\_\\_y"),
            ("`a[0]_`", "`a[0]_`"),
        ] {
            assert_eq!(escaped_markdown(raw), written, "{raw}");
        }
        assert_eq!(markup("a\u{1b}<'\"&>\n"), "a &lt;&#39;&quot;&amp;&gt;\n");
    }

    #[test]
    fn a_phrase_holds_code_and_no_markup() {
        let text = |raw| phrase(raw).to_string();
        assert_eq!(text("`a<b` & c"), "<code>a&lt;b</code> &amp; c");
        assert_eq!(text("one ` only"), "one ` only");
        assert_eq!(code("a `*` b").to_string(), "`a '*' b`");
    }

    #[test]
    fn a_value_that_does_not_exist_is_an_error() {
        let error = render("README.md", minijinja::context! {}).unwrap_err();
        assert!(error.to_string().contains("undefined"), "{error}");
    }
}
