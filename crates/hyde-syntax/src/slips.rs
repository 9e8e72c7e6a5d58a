//! Slips that are met most where a statement is broken, each with its repair: a forgotten `;`, a product without its `*`.

use crate::habits::{CHOICE, IMPORT};
use crate::recover::{self, Scanner};

/// What a broken statement looks like it needs.
pub(crate) struct Slip {
    /// The sign that was expected, where that is certain.
    pub(crate) missing: Option<&'static str>,
    /// Where it is missing, if that is not where the statement is not understood.
    pub(crate) behind: Option<usize>,
    pub(crate) help: &'static str,
}

const NUMBER: &str =
    "a number has a point as its decimal sign, `1.5`, and no sign between thousands, `1000000`";
const LIST: &str = "a list is written in braces: `{1, 2, 3} [mm]`";
/// What other tools set beside an experiment, or in its parentheses.
const SETTINGS: [&str; 9] = [
    "start",
    "stop",
    "every",
    "skip",
    "rtol",
    "atol",
    "tolerance",
    "max_step",
    "method",
];
const SOLVE: &str = "times, tolerances and the method of a run stand in its `solve`: `solve auto(rtol = 1e-6, max_step = 1 [ms]) start 0 [s] stop 2 [s] every 1 [ms];`";
const PRODUCT: &str = "a product is written `a*b`";

/// The slip in the statement that begins at `start` and is not understood at `at`, where the parser expected `expected`.
pub(crate) fn find(text: &str, start: usize, at: usize, expected: &str) -> Option<Slip> {
    let before = text[start..at].trim_end();
    let here = &text[at..];
    let other_line = text[start + before.len()..at].contains('\n');
    let open = before.matches('(').count() > before.matches(')').count();
    if open && here.starts_with(';') {
        return Some(Slip {
            missing: Some("`)`"),
            behind: Some(start + recover::end_of_last_word(before)),
            help: "a parenthesis is open: close it before the `;`",
        });
    }
    if let Some(slip) = of_connection(text, start, here) {
        return Some(slip);
    }
    if let Some(slip) = last_end(text, at) {
        return Some(slip);
    }
    if other_line && let Some(slip) = opening(text, start, at) {
        return Some(slip);
    }
    let end = Some(start + before.len())
        .filter(|_| other_line && !before.is_empty() && !before.ends_with([';', '{', '}']))
        .map(|_| start + recover::end_of_last_word(&text[start..at]))
        .or_else(|| end_of_call(text, start, at));
    if let Some(end) = end {
        return Some(Slip {
            missing: Some("`;`"),
            behind: Some(end),
            help: "end the line before with `;`",
        });
    }
    let help = choice(before, here, expected)
        .or_else(|| list(before, here, expected))
        .or_else(|| number(before, here, expected))
        .or_else(|| product(before, here, expected))
        .or_else(|| experiment(before, here, expected))
        .or_else(|| other(before, here, expected))?;
    Some(Slip {
        missing: None,
        behind: None,
        help,
    })
}

/// Connectors without a comma between them, or a single one.
fn of_connection(text: &str, start: usize, here: &str) -> Option<Slip> {
    let rest = text[start..].strip_prefix("connect")?;
    let inside = rest.trim_start().strip_prefix('(')?;
    let inside = inside.split([')', ';']).next()?;
    let separated = inside.contains(',') && !here.starts_with(is_word);
    (!separated && (here.starts_with(')') || here.starts_with(is_word))).then_some(Slip {
        missing: Some("`,`"),
        behind: None,
        help: "two connectors or more are connected, with commas between them: `connect(motor.b, screw.a);`",
    })
}

/// The end of a call that is a statement, is not understood at `at` and ends without a `;`: what it lacks is found at its last
/// parenthesis, or where it might have been an expression.
fn end_of_call(text: &str, start: usize, at: usize) -> Option<usize> {
    let mut tokens = Scanner::new(text, start);
    let (_, callee) = tokens.next()?;
    let (_, opening) = tokens.next()?;
    if !callee.starts_with(is_word) || opening != "(" {
        return None;
    }
    let mut depth = 1_usize;
    let (close, _) = tokens.find(|(_, token)| {
        match *token {
            "(" => depth += 1,
            ")" => depth -= 1,
            _ => {}
        }
        depth == 0
    })?;
    let end = close + 1;
    let (next, token) = Scanner::new(text, end).next()?;
    let other_line = text.get(end..next)?.contains('\n');
    (at <= close && other_line && token.starts_with(is_word)).then_some(end)
}

/// A word that is missing behind the condition or the range with which a statement begins, on whose line nothing follows.
fn opening(text: &str, start: usize, at: usize) -> Option<Slip> {
    let (missing, help) = match word(&text[start..]) {
        "if" => (
            "`then`",
            "write `then` behind the condition: `if a > b then`",
        ),
        "when" => (
            "`then`",
            "write `then` behind the condition: `when x > 1 [m] then`",
        ),
        "for" => (
            "`loop`",
            "write `loop` behind the range: `for i in 1:n loop`",
        ),
        _ => return None,
    };
    let before = Scanner::new(text, start).take_while(|(place, _)| *place < at);
    let mut before = before.map(|(_, token)| token);
    let open = before.all(|token| !matches!(token, "then" | "loop" | ";"));
    open.then(|| Slip {
        missing: Some(missing),
        behind: Some(start + recover::end_of_last_word(&text[start..at])),
        help,
    })
}

/// An `end NAME` that ends without a `;`, and the text with it.
fn last_end(text: &str, at: usize) -> Option<Slip> {
    let mut tokens = Scanner::new(text, at);
    let (_, end) = tokens.next()?;
    let (place, name) = tokens.next()?;
    let is_end = end == "end" && name.starts_with(is_word) && tokens.next().is_none();
    is_end.then(|| Slip {
        missing: Some("`;`"),
        behind: Some(place + name.len()),
        help: "end the last line with `;`",
    })
}

/// A choice as it is written in Python, C or Matlab.
fn choice(before: &str, here: &str, expected: &str) -> Option<&'static str> {
    if matches!(word(before), "if" | "when") {
        return None;
    }
    let behind_value = word(here) == "if" && before.ends_with(ends_value);
    let without_then = expected.contains("`then`");
    let without_else = expected.contains("`else`") && here.starts_with(';');
    (behind_value || without_then || without_else).then_some(CHOICE)
}

/// A number in the way of another language, or without the brackets of its unit.
fn number(before: &str, here: &str, expected: &str) -> Option<&'static str> {
    let digit = |sign: char| sign.is_ascii_digit();
    if let Some(behind) = here.strip_prefix('.') {
        let next = behind.chars().next();
        let value = expected.contains("an expression");
        return match next {
            Some('.') => Some("a range of elements is written `2:n`"),
            Some(next) if digit(next) && value => Some("a digit stands before the point: `0.5`"),
            _ if is_number(before) => Some("a digit stands behind the point: `1.0`"),
            _ => None,
        };
    }
    let behind_comma = before.strip_suffix(',').is_some_and(is_number);
    if (behind_comma || is_number(before)) && here.starts_with(digit) {
        return Some(NUMBER);
    }
    if !is_number(before) {
        return None;
    }
    if here.starts_with('%') {
        return Some(
            "a part of something is a number: `0.05*M`; only an uncertainty is in percent, `~ ±5%`",
        );
    }
    here.starts_with(char::is_alphabetic).then_some(
        "a unit stands in brackets behind its number, `20 [mm]`; a product is written `2*x`",
    )
}

/// A list in brackets or parentheses, or a unit that is not closed.
fn list(before: &str, here: &str, expected: &str) -> Option<&'static str> {
    if here.starts_with('[') {
        let closed = here
            .split([';', '\n'])
            .next()
            .is_some_and(|line| line.contains(']'));
        return match before.chars().last() {
            Some('=' | '(' | ',') => Some(LIST),
            _ if !closed => Some("a unit stands between brackets: `20 [mm]`"),
            Some(')') => {
                Some("a unit stands behind a number, not behind a parenthesis: `2*(3 [mm])`")
            }
            _ => None,
        };
    }
    let value = |opening: char, closing: char| {
        before
            .rsplit_once(opening)
            .is_some_and(|(outside, inside)| {
                outside.trim_end().ends_with(['=', '*', '+']) && !inside.contains(closing)
            })
    };
    if value('{', '}') && !before.ends_with('{') && here.starts_with(is_word) {
        return Some(LIST);
    }
    let is_group = value('(', ')');
    (here.starts_with(',') && is_group && expected.contains("an operator")).then_some(LIST)
}

/// Two values side by side.
fn product(before: &str, here: &str, expected: &str) -> Option<&'static str> {
    let value = here.starts_with(is_word) || here.starts_with('(');
    let sides = before.ends_with(ends_value) && value;
    let goes_on = expected.contains("an operator") || expected.contains("an expression");
    // `vary k over {1, 2}`: how the statement is written tells more.
    let begun = crate::forms::of(before).is_some() && !before.contains(['=', '(']);
    (sides && goes_on && !is_keyword(here) && !begun).then_some(PRODUCT)
}

/// A statement of an experiment that has not its first word, a setting of its run, or a file that has not its quotes.
fn experiment(before: &str, here: &str, expected: &str) -> Option<&'static str> {
    if word(before) == "experiment" && before.ends_with('=') && here.starts_with(is_word) {
        return Some("the name of a file stands in quotes: `record log = \"scope.csv\"`");
    }
    let in_parentheses = word(before) == "experiment" && before.ends_with(['(', ',']);
    let at_statement = before.is_empty() && expected.contains("`stimulus`");
    let names_setting = (in_parentheses || at_statement) && SETTINGS.contains(&word(here));
    if names_setting || (SETTINGS.contains(&before) && here.starts_with('=')) {
        return Some(SOLVE);
    }
    if !at_statement {
        return None;
    }
    let equates = Scanner::new(here, 0).skip(1).any(|(_, token)| token == "=");
    equates.then_some("an input is driven by `stimulus F = 2 [N];`, a parameter is set behind the name of the model: `experiment step of Axis(m = 2 [kg])`")
}

fn other(before: &str, here: &str, expected: &str) -> Option<&'static str> {
    if before.ends_with('~') {
        Some("an uncertainty is written `~ ±8%` or `~ ±0.1 [mm]`")
    } else if here.starts_with("==") {
        Some("an equation is written with one `=`; `==` compares")
    } else if expected == "a modification" {
        Some("a modification has a name and a value: `Length x(start = 1 [mm]);`")
    } else if before.is_empty() && word(here) == "from" {
        Some(IMPORT)
    } else {
        None
    }
}

/// The first word of a text.
fn word(text: &str) -> &str {
    text.split(|sign| !is_word(sign)).next().unwrap_or_default()
}

fn is_word(sign: char) -> bool {
    sign.is_alphanumeric() || sign == '_'
}

/// Whether a value may end with this sign.
fn ends_value(sign: char) -> bool {
    is_word(sign) || matches!(sign, ')' | ']' | '}')
}

/// Whether a text ends with a number.
fn is_number(text: &str) -> bool {
    let part = |sign: char| is_word(sign) || sign == '.';
    let last = text.rsplit(|sign| !part(sign)).next();
    last.is_some_and(|last| last.starts_with(|sign: char| sign.is_ascii_digit()))
}

fn is_keyword(text: &str) -> bool {
    crate::words::is_reserved(word(text))
}
