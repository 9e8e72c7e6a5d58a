//! Experiments.

use super::declaration::{measure_text, modification};
use super::expression::{optional_arguments, range};
use super::name::{doc, quoted, reference};
use super::{Printer, expression};
use crate::ast::{Drive, Experiment, ExperimentItem, Expr, LayoutSetting, Name, Reference};

/// `time = "cycle" in 125 [us] wraps 65536`
fn layout_setting(setting: &LayoutSetting) -> String {
    let value = match setting.number {
        Some(_) => setting.value.text.clone(),
        None => quoted(&setting.value.text),
    };
    let unit = setting.unit.as_ref();
    let unit = unit.map_or_else(String::new, |(count, unit)| {
        let count = count.map_or_else(String::new, |count| format!("{count} "));
        format!(" in {count}[{}]", unit.text)
    });
    let wraps = setting.wraps;
    let wraps = wraps.map_or_else(String::new, |period| format!(" wraps {period}"));
    format!("{} = {value}{unit}{wraps}", setting.name.text)
}

impl Printer {
    pub(super) fn experiment(&mut self, experiment: &Experiment) {
        let records: Vec<String> = experiment
            .records
            .iter()
            .map(|record| {
                let every = record
                    .every
                    .as_ref()
                    .map_or_else(String::new, |every| format!(" every {}", expression(every)));
                let default = record
                    .default
                    .as_ref()
                    .map_or_else(String::new, |name| format!(" = {}", quoted(&name.text)));
                let layout: Vec<String> = record.layout.iter().map(layout_setting).collect();
                let layout = layout.join(", ");
                let kind = record
                    .kind
                    .as_ref()
                    .map_or_else(String::new, |kind| format!(" layout {}", kind.text));
                let layout = match layout.as_str() {
                    "" => layout,
                    _ => format!("({layout})"),
                };
                format!("record {}{layout}{every}{default}{kind}", record.name.text)
            })
            .collect();
        let records = if records.is_empty() {
            String::new()
        } else {
            format!("({})", records.join(", "))
        };
        let name = &experiment.name.text;
        self.line(&format!(
            "experiment {name}{records} of {}{}{}",
            reference(&experiment.model),
            modification(&experiment.changes),
            doc(experiment.doc.as_deref())
        ));
        self.indented(|out| {
            experiment
                .items
                .iter()
                .for_each(|item| out.experiment_item(item))
        });
        self.line(&format!("end {name};"));
    }

    fn experiment_item(&mut self, item: &ExperimentItem) {
        let noise = |of: Option<&Expr>| {
            of.map_or_else(String::new, |noise| format!(" ~ {}", expression(noise)))
        };
        let drives = |list: &[Drive]| {
            let texts: Vec<String> = list
                .iter()
                .map(|drive| {
                    format!(
                        "{} = {}{}",
                        reference(&drive.target),
                        expression(&drive.value),
                        noise(drive.noise.as_ref())
                    )
                })
                .collect();
            texts.join(", ")
        };
        let line = match item {
            ExperimentItem::Stimulus(list) => format!("stimulus {};", drives(list)),
            ExperimentItem::Replay(list) => format!("replay {};", drives(list)),
            ExperimentItem::Measured(channels) => {
                let texts: Vec<String> = channels
                    .iter()
                    .map(|channel| {
                        format!(
                            "{} = {}{}{}",
                            expression(&channel.signal),
                            expression(&channel.value),
                            noise(channel.noise.as_ref()),
                            doc(channel.doc.as_deref())
                        )
                    })
                    .collect();
                format!("measured {};", texts.join(", "))
            }
            ExperimentItem::Expect(condition, text) => {
                format!("expect {}{};", expression(condition), doc(text.as_deref()))
            }
            ExperimentItem::Measure(measure) => measure_text("measure", measure),
            ExperimentItem::Solve(method, arguments) => {
                let arguments = optional_arguments(arguments);
                format!("solve {}{arguments};", method.text)
            }
            ExperimentItem::Start(at) => format!("start {};", expression(at)),
            ExperimentItem::Stop(at) => format!("stop {};", expression(at)),
            ExperimentItem::Every(step) => format!("every {};", expression(step)),
            ExperimentItem::Skip(time) => format!("skip {};", expression(time)),
            ExperimentItem::Bode(bode) => {
                let outputs: Vec<String> = bode.outputs.iter().map(expression).collect();
                let (at, modes) = (point(bode.at.as_ref()), in_modes(&bode.modes));
                let (input, band) = (reference(&bode.input), range(&bode.band));
                let steps = bode
                    .steps
                    .as_ref()
                    .map_or_else(String::new, |(name, arguments)| {
                        format!(" by {}{}", name.text, optional_arguments(arguments))
                    });
                format!(
                    "bode from {input} to {} over {band}{steps}{at}{modes};",
                    outputs.join(", ")
                )
            }
            ExperimentItem::Margins(margins) => {
                let signals: Vec<String> = margins.signals.iter().map(reference).collect();
                let band = margins.band.as_ref();
                let band = band.map_or_else(String::new, |band| format!(" over {}", range(band)));
                let (at, modes) = (point(margins.at.as_ref()), in_modes(&margins.modes));
                format!("margins of {}{band}{at}{modes};", signals.join(", "))
            }
            ExperimentItem::Figure(figure) => {
                let panels: Vec<String> = figure.panels.iter().map(expression).collect();
                let over = figure
                    .over
                    .as_ref()
                    .map_or_else(String::new, |over| format!(" over {}", expression(over)));
                let within = figure
                    .within
                    .as_ref()
                    .map_or_else(String::new, |within| format!(" in {}", range(within)));
                format!(
                    "figure {} = {}{over}{within}{};",
                    figure.name.text,
                    panels.join(", "),
                    doc(figure.doc.as_deref())
                )
            }
            ExperimentItem::Budget(ideals) => {
                let ideals: Vec<String> = ideals
                    .iter()
                    .map(|ideal| {
                        let (name, changes) = (&ideal.name.text, modification(&ideal.changes));
                        format!("{name}{changes}{}", doc(ideal.doc.as_deref()))
                    })
                    .collect();
                format!("budget {};", ideals.join(", "))
            }
        };
        self.line(&line);
    }
}

/// ` at 0.3 [s]`, or nothing.
fn point(at: Option<&Expr>) -> String {
    at.map_or_else(String::new, |at| format!(" at {}", expression(at)))
}

/// ` in guide = slip`, or nothing.
fn in_modes(modes: &[(Reference, Name)]) -> String {
    let chosen = modes.iter();
    let texts: Vec<String> = chosen
        .map(|(name, mode)| format!("{} = {}", reference(name), mode.text))
        .collect();
    if texts.is_empty() {
        String::new()
    } else {
        format!(" in {}", texts.join(", "))
    }
}
