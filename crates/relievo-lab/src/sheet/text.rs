//! Conversion of strings to the characters of the bitmap fonts, and fitting into a width.

use embedded_graphics::mono_font::{MonoFont, iso_8859_1};

/// The mark of text that was cut; drawn by the canvas, since no Latin-1 font has it.
pub(super) const ELLIPSIS: char = '…';

/// A monospaced font with its line height.
#[derive(Clone, Copy)]
pub(super) struct Face {
    pub(super) font: &'static MonoFont<'static>,
    /// True if drawn twice, one pixel apart: the largest font comes in one weight only.
    pub(super) double_strike: bool,
    /// Distance between lines, in pixels.
    pub(super) line_height: u32,
}

pub(super) const HEADLINE: Face = Face { font: &iso_8859_1::FONT_10X20, double_strike: true, line_height: 26 };
pub(super) const TITLE: Face = Face { font: &iso_8859_1::FONT_9X18_BOLD, double_strike: false, line_height: 24 };
pub(super) const BODY: Face = Face { font: &iso_8859_1::FONT_8X13, double_strike: false, line_height: 18 };

impl Face {
    /// The width of a character with its space.
    pub(super) fn advance(self) -> u32 {
        self.font.character_size.width + self.font.character_spacing + u32::from(self.double_strike)
    }

    pub(super) fn height(self) -> u32 {
        self.font.character_size.height
    }

    /// The width of a line of printable text, in pixels; of endless lines, more than any sheet has.
    pub(super) fn width(self, text: &str) -> u32 {
        text.chars().count().min(1 << 20) as u32 * self.advance()
    }

    /// Cuts the text to `width` pixels, with an ellipsis at its end (nothing where not even that fits).
    pub(super) fn fit(self, text: &str, width: u32) -> String {
        let room = (width / self.advance()) as usize;
        if text.chars().nth(room).is_none() {
            return text.to_owned();
        }
        let Some(kept) = room.checked_sub(1) else { return String::new() };
        let beginning: String = text.chars().take(kept).collect();
        format!("{}{ELLIPSIS}", beginning.trim_end())
    }

    /// Wraps the text into lines of at most `width` pixels, broken between words; words that are longer are cut.
    pub(super) fn wrap(self, text: &str, width: u32) -> Vec<String> {
        let room = (width / self.advance()) as usize;
        let mut lines = vec![String::new()];
        let mut used = 0;
        for word in text.split_whitespace() {
            let word = self.fit(word, width);
            let length = word.chars().count();
            if used > 0 && used + 1 + length > room {
                lines.push(String::new());
                used = 0;
            }
            if let Some(line) = lines.last_mut() {
                if used > 0 {
                    line.push(' ');
                    used += 1;
                }
                line.push_str(&word);
                used += length;
            }
        }
        lines
    }
}

/// Converts text to printable Latin-1 (and the ellipsis): common signs are spelt out, others become question marks.
pub(super) fn printable(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            ' '..='~' | '\u{a1}'..='\u{ac}' | '\u{ae}'..='ÿ' | ELLIPSIS => out.push(c),
            // Combining and zero-width marks take no room of their own; a soft hyphen shows only at a break.
            '\u{ad}' | '\u{300}'..='\u{36f}' | '\u{200b}'..='\u{200f}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' => {}
            c if c.is_whitespace() => out.push(' '),
            _ => out.push_str(spelling(c)),
        }
    }
    out
}

fn spelling(c: char) -> &'static str {
    match c {
        '≤' | '⩽' => "<=",
        '≥' | '⩾' => ">=",
        '≠' => "!=",
        '≈' | '∼' | '≃' => "~",
        '≡' => "==",
        '−' | '‐' | '‑' | '‒' | '–' | '—' | '―' => "-",
        '→' | '⟶' => "->",
        '←' => "<-",
        '↔' => "<->",
        '↑' => "^",
        '⇒' => "=>",
        '∞' => "inf",
        '√' => "sqrt ",
        '∆' | 'Δ' => "delta ",
        '∑' | 'Σ' => "sum ",
        'μ' => "µ",
        'α' => "alpha",
        'β' => "beta",
        'γ' => "gamma",
        'ε' => "eps",
        'θ' => "theta",
        'λ' => "lambda",
        'π' => "pi",
        'σ' => "sigma",
        '‘' | '’' | '′' => "'",
        '“' | '”' | '″' => "\"",
        '„' => "\"",
        '•' | '∙' | '⋅' => "·",
        '⁄' | '∕' => "/",
        '∗' => "*",
        '✓' | '✔' => "ok",
        '✗' | '✘' => "x",
        '⁰' => "°",
        '⁴' => "^4",
        'ᴸ' => "L",
        'ꟻ' => "F",
        '‰' => "/1000",
        '€' => "EUR",
        '™' => "(TM)",
        'œ' => "oe",
        'Œ' => "OE",
        _ => "?",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_outside_latin_1_are_spelt_out_and_latin_1_is_kept() {
        assert_eq!(printable("error ≤ 0.5 px — 3×2, Ø 5 µm ± 1°"), "error <= 0.5 px - 3×2, Ø 5 µm ± 1°");
        assert_eq!(printable("a\tb\nc\u{a0}d"), "a b c d");
        assert_eq!(printable("日本 ok"), "?? ok");
        assert_eq!(printable("e\u{301}\u{200b}"), "e");
    }

    #[test]
    fn whatever_comes_in_only_drawable_characters_come_out() {
        for c in '\0'..='\u{2fff}' {
            for p in printable(&c.to_string()).chars() {
                assert!(matches!(p, ' '..='~' | '¡'..='ÿ' | ELLIPSIS), "{c:?} became {p:?}");
            }
        }
    }

    #[test]
    fn text_is_cut_with_an_ellipsis_only_where_it_does_not_fit() {
        let width = 10 * BODY.advance();
        assert_eq!(BODY.fit("ten chars!", width), "ten chars!");
        assert_eq!(BODY.fit("eleven char", width), "eleven ch…");
        assert_eq!(BODY.fit("a space ends here", 9 * BODY.advance()), "a space…");
        assert_eq!(BODY.fit("no room", BODY.advance()), "…");
        assert_eq!(BODY.fit("no room", 3), "");
        assert_eq!(BODY.fit("", 0), "");
    }

    #[test]
    fn notes_break_between_words_and_no_line_is_too_wide() {
        let width = 12 * BODY.advance();
        assert_eq!(BODY.wrap("one two three four", width), ["one two", "three four"]);
        assert_eq!(BODY.wrap("a thirteen-char-word b", width), ["a", "thirteen-ch…", "b"]);
        assert_eq!(BODY.wrap("", width), [""]);
        for line in BODY.wrap("words of any length up to extraordinarily-long ones", width) {
            assert!(BODY.width(&line) <= width, "{line}");
        }
    }
}
