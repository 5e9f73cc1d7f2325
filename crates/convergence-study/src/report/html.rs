//! Markdown of the report as HTML.
//!
//! Texts of studies are already escaped in Markdown. If one of them slips through as markup, it
//! stops here: tags that the report does not write itself are shown as text, and pictures are those
//! of the study.

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

use super::forest;
use crate::judge::verdict::Verdict;
use crate::study::outcome::Figure;

/// Converts a piece of the report; pictures are inserted in place.
pub(super) fn html(markdown: &str, figures: &[Figure]) -> String {
    let mut events = Parser::new_ext(markdown, Options::ENABLE_TABLES);
    let mut safe_events = Vec::new();
    // Whether each open link leads to a place on the page.
    let mut links = vec![];
    // The text before a table is its title.
    let mut title = String::new();
    while let Some(event) = events.next() {
        match event {
            Event::Start(Tag::Paragraph) => {
                let inner: Vec<_> = events
                    .by_ref()
                    .take_while(|e| *e != Event::End(TagEnd::Paragraph))
                    .collect();
                title = plain(&inner);
                match picture(&inner, figures) {
                    Some(picture) => safe_events.push(Event::Html(picture.into())),
                    None => {
                        safe_events.push(Event::Start(Tag::Paragraph));
                        safe_events.extend(
                            inner
                                .into_iter()
                                .filter_map(|event| make_safe(event, &mut links)),
                        );
                        safe_events.push(Event::End(TagEnd::Paragraph));
                    }
                }
            }
            Event::Start(Tag::Table(alignments)) => {
                let label = escape(&title);
                let open = format!(
                    "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{label}\">\n"
                );
                safe_events.extend([
                    Event::Html(open.into()),
                    Event::Start(Tag::Table(alignments)),
                ]);
            }
            Event::End(TagEnd::Table) => {
                safe_events.extend([Event::End(TagEnd::Table), Event::Html("</div>\n".into())]);
            }
            Event::Html(text) if is_own(&text) => {
                title = without_own_tags(&text).trim().to_owned();
                safe_events.push(Event::Html(text));
            }
            other => safe_events.extend(make_safe(other, &mut links)),
        }
    }
    let mut html = String::new();
    pulldown_cmark::html::push_html(&mut html, safe_events.into_iter());
    html
}

/// An event that can load nothing, run nothing and not leave the page.
fn make_safe<'e>(event: Event<'e>, links: &mut Vec<bool>) -> Option<Event<'e>> {
    match event {
        Event::Html(text) | Event::InlineHtml(text) => Some(Event::Text(text)),
        Event::Start(Tag::Image { .. }) | Event::End(TagEnd::Image) => None,
        Event::Start(Tag::Link { ref dest_url, .. }) => {
            let stays = dest_url.starts_with('#');
            links.push(stays);
            stays.then_some(event)
        }
        Event::End(TagEnd::Link) => links.pop().unwrap_or(false).then_some(event),
        other => Some(other),
    }
}

const OWN_TAGS: [&str; 9] = [
    "<details>",
    "<details open=\"\">",
    "</details>",
    "<summary>",
    "</summary>",
    "<b>",
    "</b>",
    "<code>",
    "</code>",
];

/// Whether this is markup that the report writes, that of folded tables.
fn is_own(text: &str) -> bool {
    !without_own_tags(text).contains('<')
}

fn without_own_tags(text: &str) -> String {
    OWN_TAGS
        .iter()
        .fold(text.to_owned(), |text, tag| text.replace(tag, ""))
}

fn plain(events: &[Event<'_>]) -> String {
    let mut plain = String::new();
    for event in events {
        if let Event::Text(text) | Event::Code(text) = event {
            plain += text;
        }
    }
    plain
}

/// The picture that a paragraph consists of, in its place.
fn picture(paragraph: &[Event<'_>], figures: &[Figure]) -> Option<String> {
    let [
        Event::Start(Tag::Image { dest_url, .. }),
        ..,
        Event::End(TagEnd::Image),
    ] = paragraph
    else {
        return None;
    };
    let figure = figures
        .iter()
        .find(|figure| dest_url.strip_prefix("figures/") == Some(figure.file.as_str()))?;
    // The picture of all rates has too many words to be legible when small.
    let class = if figure.file == forest::FILE {
        "scroll wide"
    } else {
        "scroll"
    };
    Some(format!(
        "<figure class=\"{class}\" tabindex=\"0\" aria-label=\"{}\">\n{}</figure>\n",
        escape(&figure.caption),
        figure.svg
    ))
}

/// A verdict with its colour.
pub(super) fn badge(verdict: Verdict) -> String {
    format!("<span class=\"badge {0}\">{0}</span>", verdict.name())
}

/// Text that reads the same, in an element or an attribute.
pub(super) fn escape(raw: &str) -> String {
    let mut escaped = String::with_capacity(raw.len());
    for c in raw.chars() {
        match c {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\'' => escaped += "&#39;",
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

/// The same, with code in backticks.
pub(super) fn phrase(raw: &str) -> String {
    let parts: Vec<String> = raw.split('`').map(escape).collect();
    // Unpaired backticks are not code.
    if parts.len().is_multiple_of(2) {
        return parts.join("`");
    }
    let mut phrase = String::new();
    for (i, part) in parts.iter().enumerate() {
        if i % 2 == 1 {
            phrase += &format!("<code>{part}</code>");
        } else {
            phrase += part;
        }
    }
    phrase
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_that_is_not_the_reports_own_is_shown() {
        // Backticks of three lengths: Markdown treats none of them as code.
        for text in [
            "``` <script>alert(1)</script> ` ``",
            "a\n\n<script>alert(1)</script>\n\nb",
            "<img src=x onerror=y>",
        ] {
            let html = html(text, &[]);
            assert!(
                !html.contains("<script") && !html.contains("<img"),
                "{html}"
            );
            assert!(html.contains("&lt;"), "{html}");
        }
        let html = html(
            "[a](javascript:b) ![c](http://d/e.svg) <http://f> [g](#h) [i](j#k)",
            &[],
        );
        assert_eq!(html, "<p>a c http://f <a href=\"#h\">g</a> i</p>\n");
    }

    #[test]
    fn folded_tables_keep_their_markup_and_tables_scroll_under_their_title() {
        let text = "<details>\n<summary><b>One &lt; two</b></summary>\n\n| a |\n| - |\n| b |\n\n</details>\n";
        let html = html(text, &[]);
        assert!(
            html.starts_with(
                "<details>\n<summary><b>One &lt; two</b></summary>\n<div class=\"scroll\""
            ),
            "{html}"
        );
        assert!(
            html.contains("<td>b</td>") && html.ends_with("</div>\n</details>\n"),
            "{html}"
        );
    }

    #[test]
    fn a_picture_is_put_in_place_if_it_is_the_studys() {
        let figure = Figure {
            file: "a.svg".into(),
            caption: "a < \"b\"".into(),
            svg: "<svg/>".into(),
        };
        let html = html("![x](figures/a.svg)\n\n![y](figures/b.svg)\n", &[figure]);
        let figure = "<figure class=\"scroll\" tabindex=\"0\" aria-label=\"a &lt; &quot;b&quot;\">\n<svg/></figure>\n";
        assert_eq!(html, format!("{figure}<p>y</p>\n"));
    }

    #[test]
    fn a_phrase_holds_code_and_no_markup() {
        assert_eq!(phrase("`a<b` & c"), "<code>a&lt;b</code> &amp; c");
        assert_eq!(phrase("one ` only"), "one ` only");
    }
}
