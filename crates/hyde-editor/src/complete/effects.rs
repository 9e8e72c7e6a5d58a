//! Effects behind `with` and `vary effect`: those of the whole library that fit on the model, and the sites where they fit.

use super::Place;
use crate::before::{chain_words, word_start};
use crate::occurrences::Frame;
use crate::scope::Inside;
use hyde_compiler::{Backend, Candidate, Form, FreeInputs, Request};
use hyde_diag::Diagnostics;
use hyde_study::{Asked, Loaded};
use lsp_types::{CompletionItem, CompletionItemKind, Documentation};
use std::collections::BTreeMap;
use std::sync::Arc;

impl Place<'_> {
    /// The effects or the sites that may stand at the end of a text; nothing where none can.
    pub(super) fn effects(&self, before: &str) -> Option<Vec<CompletionItem>> {
        let statement = before.rsplit(';').next().unwrap_or_default();
        let (head, uses) = [" with ", "\nwith ", "vary effect "]
            .iter()
            .find_map(|word| statement.split_once(word))?;
        let model = match head.split_once('=') {
            Some((_, base)) => chain_words(base.split('(').next().unwrap_or(base).trim()).join("."),
            None => self.model_around()?,
        };
        let last = last_use(uses);
        let typed = &last[..word_start(last)];
        let at_site = typed.split_once(" on ");
        let first = typed.trim().is_empty() || typed.trim_end().ends_with('.');
        if at_site.is_none() && !first {
            return None;
        }
        let candidates = self.candidates(&model);
        Some(match at_site {
            Some((effect, _)) => {
                let words = effect.trim_start();
                let end = words.find(['(', ' ']).unwrap_or(words.len());
                let name = words[..end].rsplit('.').next().unwrap_or_default();
                let own = candidates.iter().filter(|own| own.name() == name);
                own.map(site).collect()
            }
            None => by_effect(&candidates, typed.trim()),
        })
    }

    /// The model that the study here is of.
    fn model_around(&self) -> Option<String> {
        self.frames.iter().find_map(|frame| match frame {
            Frame::Inside(Inside::Class(0, class)) => Some(class.name.text.clone()),
            Frame::Inside(_) | Frame::Experiment(..) | Frame::Local(_) => None,
        })
    }

    /// Every effect of the library at every site of a model of the file.
    fn candidates(&self, model: &str) -> Vec<Candidate> {
        let asked = Asked {
            world: Arc::clone(&self.analysis.world),
            whole_library: true,
            ..Asked::of_file(&self.analysis.path)
        };
        let Ok(loaded) = Loaded::of(&asked) else {
            return Vec::new();
        };
        let request = Request {
            sources: &loaded.sources,
            file: &loaded.file,
            model,
            experiment: None,
            settings: &BTreeMap::new(),
            records: &BTreeMap::new(),
            free_inputs: FreeInputs::All,
            ledger: false,
            form: Form::Run,
            backend: Backend::Interpreter,
        };
        hyde_compiler::candidates(&request, &mut Diagnostics::new()).unwrap_or_default()
    }
}

/// What is written of the last effect of a list.
fn last_use(uses: &str) -> &str {
    let mut depth = 0_i32;
    let mut start = 0;
    for (at, sign) in uses.char_indices() {
        match sign {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            ',' if depth == 0 => start = at + 1,
            _ => {}
        }
    }
    &uses[start..]
}

fn site(own: &Candidate) -> CompletionItem {
    CompletionItem {
        label: own.site.clone(),
        kind: Some(CompletionItemKind::FIELD),
        detail: Some(format!("{} on {}", own.effect, own.host)),
        ..CompletionItem::default()
    }
}

/// Each effect once, with all sites where it fits; behind the package if that is written.
fn by_effect(candidates: &[Candidate], package: &str) -> Vec<CompletionItem> {
    let mut sites: BTreeMap<&str, (&Candidate, Vec<&str>)> = BTreeMap::new();
    for own in candidates {
        let known = sites.entry(&own.effect).or_insert((own, Vec::new()));
        known.1.push(&own.site);
    }
    let item = |(effect, (own, sites)): (&str, (&Candidate, Vec<&str>))| {
        let label = effect.strip_prefix(package)?;
        Some(CompletionItem {
            label: label.to_owned(),
            kind: Some(CompletionItemKind::MODULE),
            detail: Some(format!("fits on {}", sites.join(", "))),
            documentation: Some(Documentation::String(own.doc.clone())),
            ..CompletionItem::default()
        })
    };
    sites.into_iter().filter_map(item).collect()
}
