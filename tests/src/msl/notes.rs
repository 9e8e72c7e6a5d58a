//! What a model file says in comments of the trajectory it is set beside.

/// The comments of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Notes {
    /// The file of the trajectory, below the folder of all.
    pub(super) reference: String,
    signals: Vec<(String, Source)>,
    /// Signals that are not compared, and why.
    pub(super) without: Vec<(String, String)>,
}

/// Where a signal comes from.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Source {
    /// A column of the results, and the sign it takes.
    Output(String, f64),
    /// A number.
    Constant(f64),
    /// The mode of an automaton, and the numbers of its modes.
    Mode(String, Vec<(String, f64)>),
}

/// The numbers that the Modelica Standard Library gives the modes of friction.
const MODES: [(&str, f64); 5] = [
    ("undecided", 3.0),
    ("free", 2.0),
    ("forward", 1.0),
    ("stuck", 0.0),
    ("backward", -1.0),
];

impl Notes {
    /// Reads them from the text of a model.
    pub(super) fn read(text: &str) -> Result<Self, String> {
        let mut notes = Self::default();
        for line in text.lines().filter_map(|line| line.strip_prefix("// ")) {
            let Some((word, rest)) = line.split_once(' ') else {
                continue;
            };
            let bad = || format!("`{line}` is not understood");
            match word {
                "reference" => notes.reference = rest.trim().to_owned(),
                "signal" => {
                    let (name, source) = rest.split_once('=').ok_or_else(bad)?;
                    let source = source_of(source.trim()).ok_or_else(bad)?;
                    notes.signals.push((name.trim().to_owned(), source));
                }
                "without" => {
                    let (name, reason) = rest.split_once(':').ok_or_else(bad)?;
                    let reason = reason.trim().to_owned();
                    notes.without.push((name.trim().to_owned(), reason));
                }
                _ => {}
            }
        }
        if notes.reference.is_empty() {
            return Err("no line `// reference FILE`".to_owned());
        }
        Ok(notes)
    }

    /// Where a signal of the reference comes from.
    pub(super) fn source(&self, name: &str) -> Source {
        let written = self.signals.iter().find(|(known, _)| known == name);
        if let Some((_, source)) = written {
            return source.clone();
        }
        match name.strip_suffix(".mode") {
            Some(automaton) => {
                let modes = MODES.map(|(name, value)| (name.to_owned(), value));
                Source::Mode(automaton.to_owned(), modes.to_vec())
            }
            None => Source::Output(name.to_owned(), 1.0),
        }
    }
}

fn source_of(text: &str) -> Option<Source> {
    if let Ok(value) = text.parse() {
        return Some(Source::Constant(value));
    }
    if let Some(rest) = text.strip_prefix("mode of ") {
        let (automaton, modes) = rest.split_once(':').unzip();
        let modes = match modes {
            Some(list) => list.split(',').map(mode_of).collect::<Option<Vec<_>>>()?,
            None => MODES.map(|(name, value)| (name.to_owned(), value)).to_vec(),
        };
        return Some(Source::Mode(automaton.unwrap_or(rest).to_owned(), modes));
    }
    let (sign, name) = match text.strip_prefix('-') {
        Some(name) => (-1.0, name),
        None => (1.0, text),
    };
    Some(Source::Output(name.trim().to_owned(), sign))
}

fn mode_of(text: &str) -> Option<(String, f64)> {
    let (name, value) = text.trim().split_once(' ')?;
    Some((name.to_owned(), value.trim().parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_say_where_signals_come_from() {
        let text = "package p;\n// reference A/B.csv\n// signal a.x = -b.y\n// signal c = 0\n// signal d = mode of e: on 1\n\
            // without f: why\n";
        let notes = Notes::read(text).unwrap();
        assert_eq!(notes.reference, "A/B.csv");
        assert_eq!(notes.source("a.x"), Source::Output("b.y".to_owned(), -1.0));
        assert_eq!(notes.source("c"), Source::Constant(0.0));
        let on = vec![("on".to_owned(), 1.0)];
        assert_eq!(notes.source("d"), Source::Mode("e".to_owned(), on));
        assert_eq!(notes.source("g.w"), Source::Output("g.w".to_owned(), 1.0));
        assert!(
            matches!(notes.source("g.mode"), Source::Mode(name, modes) if name == "g" && modes.len() == 5)
        );
        assert_eq!(notes.without, [("f".to_owned(), "why".to_owned())]);
        assert!(Notes::read("// signal a = b").is_err());
    }
}
