//! The tables in LaTeX, with the rules of the package booktabs: rates between the rows of their
//! levels, in bold where an order is claimed.

use super::Judgement;
use crate::text::number::interval_text;
use crate::text::visible::visible;
use convergence_judge::shown::MOST_PLACES;

/// Each table as a `tabular`, with its findings in comments.
pub(crate) fn latex(findings: &[Judgement<'_>]) -> String {
    findings.iter().map(table).collect::<Vec<_>>().join("\n")
}

/// Between a level and the rates next to it, so that two levels are one line apart.
const HALF_A_LINE: &str = r"\\[-0.5\normalbaselineskip]";

fn table(judgement: &Judgement<'_>) -> String {
    let rows = judgement.rows();
    let count = rows[0].len();
    let mut text = format!("% {}\n", visible(&judgement.source.name));
    for judged in &judgement.columns {
        let (name, verdict) = (visible(&judged.column.name), judged.rate.verdict);
        text += &format!("% {name}: {verdict}: {}\n", visible(&judged.answer()));
    }
    text += &format!("\\begin{{tabular}}{{{}}}\n\\toprule\n", "r".repeat(count));
    let head = rows[0].iter().map(|name| escaped(name));
    text += &format!("{} \\\\\n\\midrule\n", head.collect::<Vec<_>>().join(" & "));
    let levels = &rows[1..];
    for (k, level) in levels.iter().enumerate() {
        if k > 0 {
            text += &format!("{HALF_A_LINE}\n{} {HALF_A_LINE}\n", rates(judgement, level));
        }
        text += &errors(level);
    }
    text += " \\\\\n\\midrule\n";
    text += &fitted(judgement);
    for line in judgement.legend().lines() {
        let note = note(line);
        text += &format!("\\multicolumn{{{count}}}{{l}}{{\\footnotesize {note}}} \\\\\n");
    }
    text + "\\bottomrule\n\\end{tabular}\n"
}

/// Step and errors of a level; their rates stand above.
fn errors(level: &[String]) -> String {
    let cells = level.iter().enumerate().map(|(k, cell)| match k {
        k if k > 0 && k % 2 == 0 => String::new(),
        _ => number(cell.trim()),
    });
    cells.collect::<Vec<_>>().join(" & ")
}

/// The rates of a level against the one before.
fn rates(judgement: &Judgement<'_>, level: &[String]) -> String {
    let mut cells = vec![String::new()];
    for (judged, pair) in judgement.columns.iter().zip(level[1..].chunks(2)) {
        let rate = pair.last().map_or("-", |rate| rate.trim());
        let rate = match rate {
            "-" => String::new(),
            rate if judged.claim.is_some() => format!("$\\mathbf{{{rate}}}$"),
            rate => format!("${rate}$"),
        };
        cells.extend([String::new(), rate]);
    }
    cells.join(" & ")
}

/// The rate of each column with its interval, as judged.
fn fitted(judgement: &Judgement<'_>) -> String {
    let cells = judgement.columns.iter().map(|judged| {
        let shown = judged.factors.as_ref().unwrap_or(&judged.rate);
        let interval = shown.interval.map(|interval| {
            let text = interval_text(interval, MOST_PLACES);
            escaped(&text).replace(" to ", "--").replace('±', "$\\pm$")
        });
        let interval = interval.unwrap_or_else(|| "--".to_owned());
        let words = if judged.claim.is_some() {
            format!("\\textbf{{{interval}}}")
        } else {
            interval
        };
        format!(" & \\multicolumn{{2}}{{r}}{{{words}}}")
    });
    format!("rate{} \\\\\n", cells.collect::<String>())
}

/// A number in mathematics, with the mark behind it: `4.1e-2~` is set aside.
fn number(cell: &str) -> String {
    let plain = cell.trim_end_matches(['_', '~', '\'']);
    let mark = match &cell[plain.len()..] {
        "" => "",
        mark => symbol(mark),
    };
    let number = match plain.split_once('e') {
        Some((mantissa, exponent)) => format!("{mantissa} \\cdot 10^{{{exponent}}}"),
        None if plain == "-" => return "--".to_owned(),
        None => plain.to_owned(),
    };
    format!("${number}${mark}")
}

/// A mark of a level that is set aside.
fn symbol(mark: &str) -> &'static str {
    match mark {
        "_" => "\\textsuperscript{c}",
        "'" => "\\textsuperscript{b}",
        _ => "\\textsuperscript{a}",
    }
}

/// The meaning of a mark.
fn note(line: &str) -> String {
    let (mark, words) = line.split_once(' ').unwrap_or((line, ""));
    format!("{} {}", symbol(mark), escaped(words))
}

/// Letters and signs of error names that LaTeX knows in mathematics alone.
const SYMBOLS: [(char, &str); 38] = [
    ('α', "alpha"),
    ('β', "beta"),
    ('γ', "gamma"),
    ('δ', "delta"),
    ('ε', "varepsilon"),
    ('ζ', "zeta"),
    ('η', "eta"),
    ('θ', "theta"),
    ('ι', "iota"),
    ('κ', "kappa"),
    ('λ', "lambda"),
    ('μ', "mu"),
    ('ν', "nu"),
    ('ξ', "xi"),
    ('π', "pi"),
    ('ρ', "rho"),
    ('σ', "sigma"),
    ('τ', "tau"),
    ('υ', "upsilon"),
    ('φ', "varphi"),
    ('χ', "chi"),
    ('ψ', "psi"),
    ('ω', "omega"),
    ('Γ', "Gamma"),
    ('Δ', "Delta"),
    ('Θ', "Theta"),
    ('Λ', "Lambda"),
    ('Ξ', "Xi"),
    ('Π', "Pi"),
    ('Σ', "Sigma"),
    ('Φ', "Phi"),
    ('Ψ', "Psi"),
    ('Ω', "Omega"),
    ('‖', "|"),
    ('∞', "infty"),
    ('∇', "nabla"),
    ('∂', "partial"),
    ('∫', "int"),
];

/// A text in LaTeX, without commands of its own.
fn escaped(text: &str) -> String {
    visible(text).chars().map(sign).collect()
}

fn sign(c: char) -> String {
    match c {
        '\\' => "\\textbackslash{}".to_owned(),
        '~' => "\\textasciitilde{}".to_owned(),
        '^' => "\\textasciicircum{}".to_owned(),
        '&' | '%' | '$' | '#' | '_' | '{' | '}' => format!("\\{c}"),
        c => {
            let mut symbols = SYMBOLS.iter();
            let known = symbols.find(|(own, _)| *own == c);
            known.map_or_else(|| c.to_string(), |(_, name)| format!("$\\{name}$"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_has_no_command_and_no_letter_that_latex_does_not_know() {
        for (name, expected) in [
            ("velocity_L2", r"velocity\_L2"),
            ("H^1 & 50%", r"H\textasciicircum{}1 \& 50\%"),
            (r"\input{a}", r"\textbackslash{}input\{a\}"),
            ("‖∇δ‖_∞", r"$\|$$\nabla$$\delta$$\|$\_$\infty$"),
        ] {
            assert_eq!(escaped(name), expected, "{name}");
        }
    }
}
