//! Parser of formulas, by precedence climbing.

use super::expr::{Builtin, Expr, Function};

/// Brackets and signs may be nested this deep.
const MAX_DEPTH: usize = 48;
/// A formula's tree may be this deep, so that its evaluation fits any thread's stack.
const MAX_TREE: usize = 96;
/// Longest formula in bytes.
const MAX_LENGTH: usize = 4000;

/// Parses the formula in `text`. `input` returns a name's index among the inputs, or the fault of the name.
///
/// # Errors
/// One sentence that names the column.
pub(crate) fn parse(text: &str, input: &mut dyn FnMut(&str) -> Result<usize, String>) -> Result<Expr, String> {
    if text.len() > MAX_LENGTH {
        return Err(format!("the formula is too long: at most {MAX_LENGTH} bytes; cut it into steps"));
    }
    let mut parser = Parser { text, at: 0, depth: 0, input };
    let expr = parser.sum()?;
    match parser.peek() {
        None if expr.depth() > MAX_TREE => {
            Err(format!("the formula has more than {MAX_TREE} operations in a row; cut it into steps"))
        }
        None => Ok(expr),
        Some(c) => Err(parser.wrong(&format!("expected an operator or the end, found \"{c}\""))),
    }
}

struct Parser<'a> {
    text: &'a str,
    /// In bytes.
    at: usize,
    depth: usize,
    input: &'a mut dyn FnMut(&str) -> Result<usize, String>,
}

impl Parser<'_> {
    fn wrong(&self, what: &str) -> String {
        let column = self.text[..self.at].chars().count() + 1;
        format!("in the formula, column {column}: {what}")
    }

    /// Skips blanks and returns the next character.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        if found {
            self.at += c.len_utf8();
        }
        found
    }

    /// Takes the longest run of characters that are `ok`.
    fn word(&mut self, ok: impl Fn(char) -> bool) -> &str {
        let rest = &self.text[self.at..];
        let end = rest.find(|c| !ok(c)).unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    fn enter(&mut self) -> Result<(), String> {
        self.depth += 1;
        if self.depth > MAX_DEPTH { Err(self.wrong("nested too deep; cut it into steps")) } else { Ok(()) }
    }

    /// Parses a comparison, which binds least; then sums, then products.
    fn sum(&mut self) -> Result<Expr, String> {
        self.enter()?;
        let mut left = self.added()?;
        loop {
            let function = match self.peek() {
                Some('<') => Function::Less,
                Some('>') => Function::Greater,
                _ => break,
            };
            self.at += 1;
            left = Expr::Call(function, vec![left, self.added()?]);
        }
        self.depth -= 1;
        Ok(left)
    }

    fn added(&mut self) -> Result<Expr, String> {
        let mut left = self.product()?;
        loop {
            let function = match self.peek() {
                Some('+') => Function::Add,
                Some('-') => Function::Subtract,
                _ => return Ok(left),
            };
            self.at += 1;
            left = Expr::Call(function, vec![left, self.product()?]);
        }
    }

    fn product(&mut self) -> Result<Expr, String> {
        let mut left = self.signed()?;
        loop {
            let function = match self.peek() {
                Some('*') => Function::Multiply,
                Some('/') => Function::Divide,
                _ => return Ok(left),
            };
            self.at += 1;
            left = Expr::Call(function, vec![left, self.signed()?]);
        }
    }

    fn signed(&mut self) -> Result<Expr, String> {
        if !self.take('-') {
            return self.atom();
        }
        self.enter()?;
        let negated = Expr::Call(Function::Negate, vec![self.signed()?]);
        self.depth -= 1;
        Ok(negated)
    }

    fn atom(&mut self) -> Result<Expr, String> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                let inner = self.sum()?;
                if self.take(')') { Ok(inner) } else { Err(self.wrong("expected \")\"")) }
            }
            Some('#') => {
                self.at += 1;
                let digits = self.word(|c| c.is_ascii_hexdigit()).to_owned();
                color(&digits).map(Expr::Color).ok_or_else(|| self.wrong("a colour has six digits, as in #a0785a"))
            }
            Some(c) if c.is_ascii_digit() || c == '.' => {
                let digits = self.word(|c| c.is_ascii_digit() || c == '.').to_owned();
                let number = digits.parse::<f32>().ok().filter(|n| n.is_finite());
                number.map(Expr::Number).ok_or_else(|| self.wrong(&format!("\"{digits}\" is not a number")))
            }
            Some(c) if c.is_ascii_alphabetic() => self.named(),
            Some(c) => Err(self.wrong(&format!("expected a number, a name or \"(\", found \"{c}\""))),
            None => Err(self.wrong("expected a number, a name or \"(\", found the end")),
        }
    }

    fn named(&mut self) -> Result<Expr, String> {
        let start = self.at;
        let name = self.word(|c| c.is_ascii_alphanumeric() || c == '_' || c == '.').to_owned();
        if self.peek() == Some('(') {
            return self.call(&name, start);
        }
        match name.as_str() {
            "u" => Ok(Expr::Builtin(Builtin::U)),
            "v" => Ok(Expr::Builtin(Builtin::V)),
            "texel" => Ok(Expr::Builtin(Builtin::Texel)),
            "phase" => Ok(Expr::Builtin(Builtin::Phase)),
            "pi" => Ok(Expr::Number(std::f32::consts::PI)),
            _ => match (self.input)(&name) {
                Ok(k) => Ok(Expr::Input(k)),
                Err(what) => {
                    self.at = start;
                    Err(self.wrong(&what))
                }
            },
        }
    }

    fn call(&mut self, name: &str, start: usize) -> Result<Expr, String> {
        let Some(&(_, function, count)) = Function::NAMED.iter().find(|(known, ..)| *known == name) else {
            self.at = start;
            let near = relievo_toml::did_you_mean(name, Function::NAMED.map(|(name, ..)| name));
            return Err(self.wrong(&format!("there is no function \"{name}\"{near}")));
        };
        self.at += 1;
        let mut arguments = Vec::new();
        loop {
            arguments.push(self.sum()?);
            if !self.take(',') {
                break;
            }
            if arguments.len() == count {
                break;
            }
        }
        if !self.take(')') || arguments.len() != count {
            let s = if count == 1 { "" } else { "s" };
            return Err(self.wrong(&format!("{name} takes {count} argument{s} in brackets")));
        }
        Ok(Expr::Call(function, arguments))
    }
}

/// Parses six hexadecimal digits as display RGB.
pub(crate) fn color(digits: &str) -> Option<[f32; 3]> {
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() == 6)?;
    Some([number >> 16, number >> 8 & 255, number & 255].map(|c| c as f32 / 255.0))
}
