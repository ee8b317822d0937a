//! A table in LaTeX.

use std::fmt::Write;

use super::{Align, Table, generated_by};

/// A table of this many columns is wider than a page.
const WIDE: usize = 9;

impl Table {
    /// A LaTeX tabular with booktabs rules, with `command` as what generated it.
    pub fn to_latex(&self, command: &str) -> String {
        let align: String = self
            .columns
            .iter()
            .map(|column| match column.align {
                Align::Left => "l",
                Align::Right => "r",
                Align::Paragraph => "p{0.6\\linewidth}",
            })
            .collect();
        let line = |texts: Vec<String>| format!("{} \\\\\n", texts.join(" & "));
        let mut out = format!(
            "% {}; needs \\usepackage{{booktabs}}\n",
            generated_by(command)
        );
        if self.columns.len() >= WIDE {
            out.push_str(
                "% Wide: set it on a landscape page, or in \\resizebox{\\linewidth}{!}{...}.\n",
            );
        }
        let _ = writeln!(out, "% {}", formulas(&self.caption));
        let _ = write!(out, "\\begin{{tabular}}{{{align}}}\n\\toprule\n");
        let titles = self.columns.iter().map(|column| formulas(&column.title));
        out.push_str(&line(titles.collect()));
        out.push_str("\\midrule\n");
        for row in &self.rows {
            out.push_str(&line(row.iter().map(|cell| latex(&cell.show())).collect()));
        }
        out.push_str("\\bottomrule\n\\end{tabular}\n");
        out
    }
}

/// Text made safe for LaTeX, in any font encoding: what is not plain text there becomes a formula.
fn latex(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text.chars().peekable();
    while let Some(character) = rest.next() {
        if let Some(first) = lowered(character) {
            // A whole exponent is one formula.
            let mut exponent = String::from(first);
            while let Some(next) = rest.peek().copied().and_then(lowered) {
                exponent.push(next);
                rest.next();
            }
            let _ = write!(out, "$^{{{exponent}}}$");
            continue;
        }
        match character {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => out.extend(['\\', character]),
            '\\' => out.push_str("\\textbackslash{}"),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '<' | '>' | '|' => out.extend(['$', character, '$']),
            '−' => out.push_str("$-$"),
            '±' => out.push_str("$\\pm$"),
            '×' => out.push_str("$\\times$"),
            '÷' => out.push_str("$\\div$"),
            'τ' => out.push_str("$\\tau$"),
            '→' => out.push_str("$\\rightarrow$"),
            '·' => out.push_str("$\\cdot$"),
            '≤' => out.push_str("$\\leq$"),
            '≥' => out.push_str("$\\geq$"),
            '≠' => out.push_str("$\\neq$"),
            '≈' => out.push_str("$\\approx$"),
            'π' => out.push_str("$\\pi$"),
            'σ' => out.push_str("$\\sigma$"),
            '–' => out.push_str("--"),
            '—' => out.push_str("---"),
            '…' => out.push_str("\\ldots{}"),
            '\u{a0}' => out.push('~'),
            '\n' => out.push(' '),
            other => out.push(other),
        }
    }
    out
}

/// The plain character of a superscript one.
fn lowered(character: char) -> Option<char> {
    const RAISED: [(char, char); 12] = [
        ('⁻', '-'),
        ('⁺', '+'),
        ('⁰', '0'),
        ('¹', '1'),
        ('²', '2'),
        ('³', '3'),
        ('⁴', '4'),
        ('⁵', '5'),
        ('⁶', '6'),
        ('⁷', '7'),
        ('⁸', '8'),
        ('⁹', '9'),
    ];
    RAISED
        .iter()
        .find(|(raised, _)| *raised == character)
        .map(|&(_, plain)| plain)
}

/// A heading or caption: the counts and their costs as the formulas they are.
fn formulas(text: &str) -> String {
    let mut out = latex(text);
    for letter in ["n", "c"] {
        for of in ["K", "B", "t"] {
            out = out.replace(&format!("{letter}\\_{of}"), &format!("${letter}_{of}$"));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::formulas;

    #[test]
    fn signs_of_headings_are_formulas() {
        assert_eq!(formulas("τ, mean"), "$\\tau$, mean");
        assert_eq!(formulas("error ×/÷"), "error $\\times$/$\\div$");
        assert_eq!(formulas("n_K, n_t"), "$n_K$, $n_t$");
    }
}
