//! Columns of a record, with their units.

use super::Place;
use crate::occurrences::Frame;
use hyde_diag::Diagnostics;
use hyde_study::{Asked, Records, headers, read_records};
use hyde_syntax::ast::{Experiment, RecordItem};
use lsp_types::{CompletionItem, CompletionItemKind};
use std::sync::Arc;

impl Place<'_> {
    /// The columns that the file of a record of the experiment here has.
    pub(super) fn columns(&self, record: &RecordItem) -> Vec<CompletionItem> {
        let experiment = self.frames.iter().find_map(|frame| match frame {
            Frame::Experiment(_, experiment) => Some(*experiment),
            Frame::Inside(_) | Frame::Local(_) => None,
        });
        let Some(experiment) = experiment else {
            return Vec::new();
        };
        let asked = Asked {
            world: Arc::clone(&self.analysis.world),
            ..Asked::of_file(&self.analysis.path)
        };
        let alone = Experiment {
            records: vec![record.clone()],
            ..experiment.clone()
        };
        let ignored = &mut Diagnostics::new();
        let records = read_records(&alone, &asked, Records::IfThere, ignored);
        let headers = records.map(|records| headers(&records)).unwrap_or_default();
        let columns = headers.into_values().flat_map(|header| header.columns);
        columns
            .map(|(name, unit)| CompletionItem {
                label: name,
                kind: Some(CompletionItemKind::FIELD),
                detail: unit.map(|unit| format!("[{}]", unit.text())),
                ..CompletionItem::default()
            })
            .collect()
    }
}
