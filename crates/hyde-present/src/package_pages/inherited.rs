//! [`Inherited`]: what a member of a class is there, if another class declares it: `extends` changes its value and its model.

use super::html::escaped;
use hyde_diag::Sources;
use hyde_syntax::ast::{Change, Class, Expr, Prior, Reference};

/// How the members of a class came to the class of a page.
#[derive(Clone, Default)]
pub(super) struct Inherited<'l> {
    /// Where they are declared, for people.
    from: Option<String>,
    /// The classes on the way.
    below: Vec<&'l Class>,
    /// The changes of all `extends` on the way, those of the page's own class first: these count.
    changes: Vec<&'l Change>,
}

/// What the changes make of one member.
#[derive(Default)]
pub(super) struct Changed<'l> {
    /// Its new value.
    pub(super) value: Option<&'l Expr>,
    /// The spread and the source of that.
    pub(super) prior: Option<&'l Prior>,
    pub(super) source: Option<&'l str>,
    /// Its new model.
    pub(super) model: Option<&'l Reference>,
    /// What is changed inside it: the target and the text.
    inside: Vec<(String, String)>,
}

impl<'l> Inherited<'l> {
    /// The same of what `extends` brings; nothing of a class that extends itself.
    pub(super) fn through(&self, class: &'l Class, changes: &'l [Change]) -> Option<Self> {
        let known = |known: &&Class| std::ptr::eq(*known, class);
        (!self.below.iter().any(known)).then(|| Self {
            from: Some(format!("from `{}`", class.name.text)),
            below: [self.below.as_slice(), &[class]].concat(),
            changes: self.changes.iter().copied().chain(changes).collect(),
        })
    }

    /// The same of the members of a clocked part.
    pub(super) fn in_part(&self, name: &str) -> Self {
        let own = self.changes.iter();
        let own = own.filter(|change| change.target.as_word() == Some(name));
        Self {
            from: Some(format!("in `{name}`")),
            below: self.below.clone(),
            changes: own.flat_map(|change| &change.changes).collect(),
        }
    }

    /// Where a member is declared, for people; nothing of the class itself.
    pub(super) fn from(&self, changed: &Changed<'_>) -> Option<String> {
        let from = self.from.clone()?;
        let is_changed =
            changed.value.is_some() || changed.model.is_some() || !changed.inside.is_empty();
        Some(match is_changed {
            true => format!("{from}, modified"),
            false => from,
        })
    }

    /// What the changes make of a member.
    pub(super) fn changed(&self, sources: &Sources, name: &str) -> Changed<'l> {
        let mut found = Changed::default();
        for change in &self.changes {
            let mut parts = change.target.parts.iter();
            if parts.next().is_none_or(|first| first.name.text != name) {
                continue;
            }
            if change.target.as_word() != Some(name) {
                let target = inner(&change.target);
                let text = text_of(sources, change, &target);
                found.add(target, text);
                continue;
            }
            if found.value.is_none() && change.value.is_some() {
                found.value = change.value.as_ref();
                found.prior = change.prior.as_ref();
                found.source = change.source.as_deref();
            }
            found.model = found.model.or(change.redeclare.as_ref());
            for own in &change.changes {
                let target = hyde_syntax::format_reference(&own.target);
                let text = text_of(sources, own, &target);
                found.add(target, text);
            }
        }
        found
    }
}

impl Changed<'_> {
    /// Adds a change inside the member, unless one further out has changed the same.
    fn add(&mut self, target: String, text: String) {
        if self.inside.iter().all(|known| known.0 != target) {
            self.inside.push((target, text));
        }
    }

    /// The changes inside the member, with those of its declaration that still hold.
    pub(super) fn with(mut self, sources: &Sources, declared: &[Change]) -> Vec<String> {
        for own in declared {
            let target = hyde_syntax::format_reference(&own.target);
            let text = text_of(sources, own, &target);
            self.add(target, text);
        }
        let texts = self.inside.into_iter();
        texts
            .map(|(_, text)| format!("<code>{}</code>", escaped(&text)))
            .collect()
    }
}

/// A target without its first part, `k` of `part.k`; of an element of an array as it is written.
fn inner(target: &Reference) -> String {
    match target.parts.split_first() {
        Some((first, rest)) if first.subscripts.is_empty() && !rest.is_empty() => {
            hyde_syntax::format_reference(&Reference {
                parts: rest.to_vec(),
                span: target.span,
            })
        }
        Some(_) | None => hyde_syntax::format_reference(target),
    }
}

/// Changes as they are written: `F = 7 [N], redeclare Coarse scale(n = 3)`.
pub(super) fn texts(sources: &Sources, changes: &[Change]) -> String {
    let each = changes.iter();
    let each = each.map(|own| {
        let target = hyde_syntax::format_reference(&own.target);
        text_of(sources, own, &target)
    });
    each.collect::<Vec<_>>().join(", ")
}

fn text_of(sources: &Sources, change: &Change, target: &str) -> String {
    let mut text = match &change.redeclare {
        Some(model) => format!("redeclare {} {target}", model.dotted()),
        None => target.to_owned(),
    };
    if !change.changes.is_empty() {
        text += &format!("({})", texts(sources, &change.changes));
    }
    if let Some(value) = &change.value {
        text += &format!(" = {}", sources.text(value.span));
    }
    text
}
