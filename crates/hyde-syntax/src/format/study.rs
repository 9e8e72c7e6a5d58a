//! Studies: calibrations, diagnoses and sweeps.

use super::class::effect_use;
use super::expression::range;
use super::name::{doc, reference};
use super::{Printer, expression};
use crate::ast::{SettingValue, Study, StudyItem, StudyKind, Varied};

impl Printer {
    pub(super) fn study(&mut self, study: &Study) {
        let of = match study.kind {
            StudyKind::Diagnose => "of calibrate",
            StudyKind::Calibrate | StudyKind::Sweep => "of",
        };
        let word = study.kind.word();
        let name = &study.name.text;
        let models = std::iter::once(&study.of).chain(&study.also);
        let models: Vec<String> = models.map(reference).collect();
        self.line(&format!(
            "{word} {name} {of} {}{}",
            models.join(", "),
            doc(study.doc.as_deref())
        ));
        self.indented(|out| {
            for item in &study.items {
                let line = match item {
                    StudyItem::Vary(list) => {
                        let texts: Vec<String> = list
                            .iter()
                            .map(|variation| {
                                let within = variation
                                    .within
                                    .as_ref()
                                    .map_or_else(String::new, |r| format!(" in {}", range(r)));
                                let values = variation
                                    .values
                                    .as_ref()
                                    .map_or_else(String::new, |e| format!(" = {}", expression(e)));
                                let what = match variation.what {
                                    Varied::Stimulus => "stimulus ",
                                    Varied::Record => "record ",
                                    Varied::Part | Varied::Model => "",
                                };
                                let per = variation
                                    .per
                                    .as_ref()
                                    .map_or_else(String::new, |per| format!(" per {}", per.text));
                                let target = reference(&variation.target);
                                format!("{what}{target}{within}{values}{per}")
                            })
                            .collect();
                        format!("vary {};", texts.join(", "))
                    }
                    StudyItem::VaryEffects(list) => {
                        let texts: Vec<String> = list.iter().map(effect_use).collect();
                        format!("vary effect {};", texts.join(", "))
                    }
                    StudyItem::Setting(name, values, labels) => {
                        let texts: Vec<String> = values
                            .iter()
                            .map(|value| match value {
                                SettingValue::Everything(path) => format!("{}.*", reference(path)),
                                SettingValue::Expr(expr) => expression(expr),
                            })
                            .collect();
                        let own = labels
                            .iter()
                            .map(|own| format!("{} = {}", own.name.text, expression(&own.value)));
                        let own: Vec<String> = own.collect();
                        let at = match own.as_slice() {
                            [] => String::new(),
                            own => format!(" at {}", own.join(", ")),
                        };
                        format!("{} {}{at};", name.text, texts.join(", "))
                    }
                };
                out.line(&line);
            }
        });
        self.line(&format!("end {name};"));
    }
}
