//! [`Additions`]: effects put on a model from outside its text, as `with E on site` would put them there.

use crate::candidates::Candidate;
use hyde_diag::{FileId, Span};
use hyde_syntax::ast::Reference;

/// Effects put on a model from outside its text. Their parameters have the values declared; all that are not structural
/// can be set without compiling anew.
#[derive(Clone, Debug, Default)]
pub struct Additions {
    list: Vec<Addition>,
    keep_neutral: bool,
    shift_quantisers: bool,
}

/// One of them.
#[derive(Clone, Debug)]
pub(crate) struct Addition {
    pub(crate) effect: Reference,
    pub(crate) site: Reference,
    pub(crate) name: String,
}

impl Additions {
    /// None yet; those put in are left out of the equations while their sizes are exactly 0.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// None yet; those put in stay in the equations whatever their sizes, so that a size can leave 0 and come back
    /// to it without compiling anew.
    #[must_use]
    pub fn kept() -> Self {
        Self {
            keep_neutral: true,
            ..Self::default()
        }
    }

    /// The same with the steps of every `floor_to` and `round_to` half a step from where they are: an encoder whose
    /// origin lies half a count elsewhere. Two such runs differ by what nobody can know of a quantised axis.
    #[must_use]
    pub fn with_shifted_quantisers(self) -> Self {
        Self {
            shift_quantisers: true,
            ..self
        }
    }

    /// Puts a candidate on its site once more, and gives the path of its instance there: its parameter `dF` is
    /// `PATH.dF`. The second of an effect at one site is called `Cogging2`.
    pub fn put(&mut self, file: FileId, candidate: &Candidate) -> String {
        let path = |name: &str| format!("{}.{name}", candidate.site);
        let class = candidate.name();
        let first = candidate.instance.strip_prefix(class).unwrap_or_default();
        let from: usize = first.parse().unwrap_or(1);
        let taken = |name: &str| {
            self.list.iter().any(|other| {
                path(&other.name) == path(name)
                    && hyde_syntax::format_reference(&other.site) == candidate.site
            })
        };
        let mut names = (from..).map(|number| match number {
            1 => class.to_owned(),
            _ => format!("{class}{number}"),
        });
        let name = names.find(|name| !taken(name)).unwrap_or_default();
        let found = path(&name);
        let nowhere = Span::new(file, 0, 0);
        self.list.push(Addition {
            effect: Reference::of_path(&candidate.effect, nowhere),
            site: Reference::of_path(&candidate.site, nowhere),
            name,
        });
        found
    }

    pub(crate) fn list(&self) -> &[Addition] {
        &self.list
    }

    pub(crate) fn shifts_quantisers(&self) -> bool {
        self.shift_quantisers
    }

    pub(crate) fn keeps_neutral(&self) -> bool {
        self.keep_neutral
    }
}
