//! Where to go on after an error: past the statement or block that holds it.

/// Words, strings and single characters, nothing of comments or white space, each with its place.
pub(crate) struct Scanner<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Scanner<'a> {
    pub(crate) fn new(text: &'a str, at: usize) -> Self {
        Self { text, at }
    }
}

impl<'a> Iterator for Scanner<'a> {
    type Item = (usize, &'a str);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let rest = &self.text[self.at..];
            let first = rest.chars().next()?;
            let start = self.at;
            if rest.starts_with("//") {
                self.at += rest.find('\n').unwrap_or(rest.len());
            } else if rest.starts_with("/*") {
                self.at += comment_len(rest);
            } else if first == '"' {
                let len = string_len(rest);
                self.at += len;
                return Some((start, &rest[..len]));
            } else if first.is_whitespace() {
                self.at += first.len_utf8();
            } else if first.is_alphabetic() || first == '_' {
                let len = rest
                    .find(|c: char| !c.is_alphanumeric() && c != '_')
                    .unwrap_or(rest.len());
                self.at += len;
                return Some((start, &rest[..len]));
            } else {
                self.at += first.len_utf8();
                return Some((start, &rest[..first.len_utf8()]));
            }
        }
    }
}

/// Where a comment or a text begins that has no end, and the sign that opens it.
pub(crate) fn without_end(text: &str) -> Option<(usize, &'static str)> {
    let mut at = 0;
    while let Some(next) = text[at..].find(['/', '"']) {
        at += next;
        let rest = &text[at..];
        let (opened, len) = if rest.starts_with("//") {
            at += rest.find('\n')?;
            continue;
        } else if rest.starts_with("/*") {
            ("/*", comment_end(rest))
        } else if rest.starts_with('"') {
            ("\"", string_end(rest))
        } else {
            at += 1;
            continue;
        };
        match len {
            Some(len) => at += len,
            None => return Some((at, opened)),
        }
    }
    None
}

/// The end of the last word of a text, comments and white space left out; 0 if it has none.
pub(crate) fn end_of_last_word(text: &str) -> usize {
    Scanner::new(text, 0)
        .last()
        .map_or(0, |(at, token)| at + token.len())
}

/// The first byte that is neither white space nor comment, from `at` on.
pub(crate) fn skip_blank(text: &str, at: usize) -> usize {
    let mut at = at;
    loop {
        let rest = &text[at..];
        let trimmed = rest.trim_start();
        at += rest.len() - trimmed.len();
        if trimmed.starts_with("//") {
            at += trimmed.find('\n').unwrap_or(trimmed.len());
        } else if trimmed.starts_with("/*") {
            at += comment_len(trimmed);
        } else {
            return at;
        }
    }
}

/// The end of the broken statement or block that starts at `start`: past its `;` outside braces, or past the `end
/// for;` of a loop. Stops before `end NAME;` and before the keyword of a new item at the start of a line.
pub(crate) fn skip_statement(text: &str, start: usize) -> usize {
    let mut depth = 0_usize;
    let mut blocks = 0_usize;
    let mut previous = "";
    for (at, token) in Scanner::new(text, start) {
        let line_start = text[..at].ends_with('\n') || at == 0;
        if at > start && line_start && ITEMS.contains(&token) {
            return at;
        }
        match token {
            "{" => depth += 1,
            "}" if depth <= 1 && blocks == 0 && !(depth == 1 && is_list(text, at)) => {
                return at + 1;
            }
            "}" => depth = depth.saturating_sub(1),
            "for" | "when" if previous != "end" && (at == start || blocks > 0) => blocks += 1,
            "if" if at == start => blocks += 1,
            "for" | "when" | "if" if previous == "end" => blocks = blocks.saturating_sub(1),
            ";" if depth == 0 && blocks == 0 => return at + 1,
            "end" if at > start && depth == 0 && previous != "." => {
                let next = Scanner::new(text, at + token.len()).next();
                let next = next.map_or("", |(_, next)| next);
                // `end = …` is somebody's name for something.
                let ends = matches!(next, "" | ";")
                    || next.starts_with(|c: char| c.is_alphabetic() || c == '_');
                if ends && (blocks == 0 || !BLOCKS.contains(&next)) {
                    return at;
                }
            }
            _ => {}
        }
        previous = token;
    }
    text.len()
}

/// Behind an `end;` at `at` that names nothing.
pub(crate) fn behind_bare_end(text: &str, at: usize) -> Option<usize> {
    let mut tokens = Scanner::new(text, at);
    match (tokens.next()?, tokens.next()?) {
        ((_, "end"), (semicolon, ";")) => Some(semicolon + 1),
        _ => None,
    }
}

/// Whether the brace that closes at `at` is that of a list, so that its statement goes on behind it.
fn is_list(text: &str, at: usize) -> bool {
    let next = Scanner::new(text, at + 1).next();
    next.is_some_and(|(_, next)| [";", "[", ")", ",", "+", "-", "*", "/", "^"].contains(&next))
}

/// Where the section of a class ends that begins at `start`: at the next one, or at the end of the class.
pub(crate) fn skip_section(text: &str, start: usize) -> usize {
    let mut at = start;
    loop {
        at = skip_statement(text, at).max(at + 1);
        let next = Scanner::new(text, at.min(text.len())).next();
        let Some((begin, token)) = next else {
            return text.len();
        };
        let ends = [
            "equation",
            "initial",
            "algorithm",
            "protected",
            "public",
            "end",
        ];
        if ends.contains(&token) || ITEMS.contains(&token) {
            return begin;
        }
        at = begin;
    }
}

/// Behind `end NAME;` of the class that starts at `start`, or its statement where it has none.
pub(crate) fn skip_class(text: &str, start: usize, name: &str) -> usize {
    let mut previous = "";
    for (at, token) in Scanner::new(text, start) {
        if previous == "end" && token == name {
            return skip_statement(text, at);
        }
        previous = token;
    }
    skip_statement(text, start).max(start + 1)
}

/// The start of the next item after the broken one that starts at `start`.
pub(crate) fn skip_item(text: &str, start: usize) -> usize {
    Scanner::new(text, start)
        .find(|&(at, token)| at > start && ITEMS.contains(&token) && text[..at].ends_with('\n'))
        .map_or(text.len(), |(at, _)| at)
}

/// The words of statements that have an `end` of their own.
pub(crate) const BLOCKS: [&str; 3] = ["if", "for", "when"];

/// The words that items begin with.
pub(crate) const ITEMS: [&str; 8] = [
    "model",
    "connector",
    "effect",
    "type",
    "experiment",
    "calibrate",
    "diagnose",
    "sweep",
];

fn comment_len(rest: &str) -> usize {
    comment_end(rest).unwrap_or(rest.len())
}

/// Behind the `*/` that ends the comment at the start of a text, if it ends; `/*/` begins one only.
pub fn comment_end(rest: &str) -> Option<usize> {
    rest.get(2..)?.find("*/").map(|end| end + 4)
}

fn string_len(rest: &str) -> usize {
    string_end(rest).unwrap_or(rest.len())
}

/// Behind the quote that ends the string at the start of a text, if it ends.
pub fn string_end(rest: &str) -> Option<usize> {
    let mut escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return Some(at + 1),
            _ => {}
        }
    }
    None
}
