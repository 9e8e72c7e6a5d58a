//! Reads the text of a unit: `N.m/rad`, `kg.m2`, `J/(kg.K)`, `1/min`.

use crate::suggest::explain;
use crate::symbol::{is_symbol_character, look_up};
use crate::{Exponent, Unit, UnitError, UnitErrorKind};
use std::ops::Range;

/// Reads the text of a unit.
///
/// ```text
/// unit     = factor { ("." | "*" | "·") factor | "/" factor }
/// factor   = ("1" | symbol | "(" unit ")") [ exponent ]
/// exponent = integer | "^" integer | "^(" integer ["/" integer] ")" | superscript integer
/// ```
///
/// Divisions go from left to right, `a/b/c` is `a/(b.c)`. A product after a division, `a/b.c`, is refused, because
/// half of the readers take it for `a/(b.c)`. Blanks may stand round operators. The unit 1 is the bare number.
///
/// # Errors
/// Names the symbol or the place that is wrong, with the near miss where there is one.
pub fn parse_unit(text: &str) -> Result<Unit, UnitError> {
    let mut parser = Parser { text, at: 0 };
    parser.skip_blanks();
    if parser.rest().is_empty() {
        return Err(parser.error(0..text.len(), UnitErrorKind::Empty));
    }
    let unit = parser.quotient(0)?.unit;
    if !parser.rest().is_empty() {
        return Err(parser.unexpected("`.` or `/`"));
    }
    if !unit.scale.is_usable() {
        return Err(parser.error(0..text.len(), UnitErrorKind::OutOfRange));
    }
    Ok(Unit {
        dimension: unit.dimension.of_unit(),
        ..unit
    })
}

const MAX_DEPTH: usize = 16;

struct Parser<'a> {
    text: &'a str,
    at: usize,
}

/// A part of the text with its meaning; the dimension without the rule of the angle-neutral kinds.
struct Part {
    unit: Unit,
    at: Range<usize>,
}

impl Parser<'_> {
    fn quotient(&mut self, depth: usize) -> Result<Part, UnitError> {
        let mut result = self.factor(depth)?;
        let mut divisor_start = None;
        loop {
            self.skip_blanks();
            let divides = match self.peek() {
                Some('/') => true,
                Some('.' | '*' | '·' | '⋅') => false,
                Some(_) | None => return Ok(result),
            };
            let operator = self.at;
            self.bump();
            self.skip_blanks();
            let start = self.at;
            let factor = self.factor(depth)?;
            if divides {
                divisor_start = Some(start);
            } else if let Some(start) = divisor_start {
                let divisor = self.text[start..self.at].to_owned();
                return Err(self.error(operator..self.at, UnitErrorKind::TwoReadings { divisor }));
            }
            result = self.combine(&result, &factor, divides)?;
        }
    }

    fn combine(&self, left: &Part, right: &Part, divides: bool) -> Result<Part, UnitError> {
        let (a, b) = (self.without_offset(left)?, self.without_offset(right)?);
        let (dimension, scale) = if divides {
            (
                a.dimension.divide(b.dimension),
                a.scale.multiply(b.scale.inverse()),
            )
        } else {
            (a.dimension.multiply(b.dimension), a.scale.multiply(b.scale))
        };
        let unit = Unit {
            dimension,
            scale,
            offset: 0.0,
        };
        Ok(Part {
            unit,
            at: left.at.start..right.at.end,
        })
    }

    fn factor(&mut self, depth: usize) -> Result<Part, UnitError> {
        let base = self.base(depth)?;
        let start = self.at;
        let Some(exponent) = self.exponent()? else {
            return Ok(base);
        };
        let unit = self.without_offset(&base)?;
        let Some(dimension) = unit.dimension.power(exponent) else {
            return Err(self.bad_exponent(start));
        };
        let scale = unit.scale.power(exponent);
        if !scale.is_usable() {
            return Err(self.error(base.at.start..self.at, UnitErrorKind::OutOfRange));
        }
        Ok(Part {
            unit: Unit {
                dimension,
                scale,
                offset: 0.0,
            },
            at: base.at.start..self.at,
        })
    }

    fn base(&mut self, depth: usize) -> Result<Part, UnitError> {
        let start = self.at;
        match self.peek() {
            Some('(') if depth == MAX_DEPTH => {
                Err(self.error(start..start + 1, UnitErrorKind::TooDeep))
            }
            Some('(') => {
                self.bump();
                self.skip_blanks();
                let inner = self.quotient(depth + 1)?;
                self.expect(')', "`)`")?;
                Ok(Part {
                    unit: inner.unit,
                    at: start..self.at,
                })
            }
            Some(c) if c.is_ascii_digit() => self.one(),
            Some(c) if is_symbol_character(c) => self.symbol(),
            Some(_) | None => Err(self.unexpected("a unit")),
        }
    }

    fn one(&mut self) -> Result<Part, UnitError> {
        let start = self.at;
        self.bump_while(|c| c.is_ascii_digit());
        if self.rest().starts_with('.')
            && self.rest()[1..].starts_with(|c: char| c.is_ascii_digit())
        {
            self.bump();
            self.bump_while(|c| c.is_ascii_digit());
        }
        let number = &self.text[start..self.at];
        if number == "1" {
            return Ok(Part {
                unit: Unit::ONE,
                at: start..self.at,
            });
        }
        Err(self.error(
            start..self.at,
            UnitErrorKind::Factor {
                number: number.to_owned(),
            },
        ))
    }

    fn symbol(&mut self) -> Result<Part, UnitError> {
        let start = self.at;
        self.bump_while(is_symbol_character);
        let text = &self.text[start..self.at];
        let (scale, symbol) =
            look_up(text).ok_or_else(|| self.error(start..self.at, explain(text)))?;
        let unit = Unit {
            dimension: symbol.dimension(),
            scale,
            offset: symbol.offset,
        };
        Ok(Part {
            unit,
            at: start..self.at,
        })
    }

    /// The exponent that follows a factor, if one does.
    fn exponent(&mut self) -> Result<Option<Exponent>, UnitError> {
        let start = self.at;
        let ratio = match self.peek() {
            Some('^') => {
                self.bump();
                if self.peek() == Some('(') {
                    self.ratio()?
                } else {
                    (self.integer()?, 1)
                }
            }
            Some(c) if c == '-' || c.is_ascii_digit() => (self.integer()?, 1),
            Some(c) if superscript(c).is_some() => (self.superscript_integer(), 1),
            Some(_) | None => return Ok(None),
        };
        match Exponent::ratio(ratio.0, ratio.1) {
            Some(exponent) => Ok(Some(exponent)),
            None => Err(self.bad_exponent(start)),
        }
    }

    fn ratio(&mut self) -> Result<(i32, i32), UnitError> {
        self.bump();
        let numerator = self.integer()?;
        let denominator = if self.peek() == Some('/') {
            self.bump();
            self.integer()?
        } else {
            1
        };
        self.expect(')', "`)`")?;
        Ok((numerator, denominator))
    }

    fn integer(&mut self) -> Result<i32, UnitError> {
        let start = self.at;
        if matches!(self.peek(), Some('-' | '+')) {
            self.bump();
        }
        let digits = self.at;
        self.bump_while(|c| c.is_ascii_digit());
        if self.at == digits {
            return Err(self.unexpected("a whole number"));
        }
        self.text[start..self.at]
            .parse()
            .map_err(|_| self.bad_exponent(start))
    }

    fn superscript_integer(&mut self) -> i32 {
        let mut digits = String::new();
        while let Some(c) = self.peek().and_then(superscript) {
            digits.push(c);
            self.bump();
        }
        // What is no number is too large, and refused as such.
        digits.parse().unwrap_or(i32::MAX)
    }

    fn without_offset(&self, part: &Part) -> Result<Unit, UnitError> {
        if part.unit.offset == 0.0 {
            return Ok(part.unit);
        }
        let symbol = self.text[part.at.clone()].to_owned();
        Err(self.error(part.at.clone(), UnitErrorKind::Offset { symbol }))
    }

    fn expect(&mut self, wanted: char, name: &'static str) -> Result<(), UnitError> {
        if self.peek() != Some(wanted) {
            return Err(self.unexpected(name));
        }
        self.bump();
        Ok(())
    }

    fn unexpected(&self, expected: &'static str) -> UnitError {
        let rest = self.rest();
        let same = |c: char| is_symbol_character(c);
        let length = rest.find(|c| !same(c)).unwrap_or(rest.len());
        let length = if length == 0 {
            rest.chars().next().map_or(0, char::len_utf8)
        } else {
            length
        };
        let found = rest[..length].to_owned();
        self.error(
            self.at..self.at + length,
            UnitErrorKind::Unexpected { expected, found },
        )
    }

    fn bad_exponent(&self, start: usize) -> UnitError {
        let exponent = self.text[start..self.at].trim_start_matches('^').to_owned();
        self.error(start..self.at, UnitErrorKind::Exponent { exponent })
    }

    fn error(&self, at: Range<usize>, kind: UnitErrorKind) -> UnitError {
        UnitError { at, kind }
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn bump(&mut self) {
        self.at += self.peek().map_or(0, char::len_utf8);
    }

    fn bump_while(&mut self, accept: impl Fn(char) -> bool) {
        while self.peek().is_some_and(&accept) {
            self.bump();
        }
    }

    fn skip_blanks(&mut self) {
        self.bump_while(char::is_whitespace);
    }
}

/// The plain character of a superscript digit or minus.
fn superscript(c: char) -> Option<char> {
    const SIGNS: [char; 11] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹', '⁻'];
    let position = SIGNS.iter().position(|sign| *sign == c)?;
    "0123456789-".chars().nth(position)
}

#[cfg(test)]
mod tests;
