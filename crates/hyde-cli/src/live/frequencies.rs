//! Natural frequencies, frequency responses and margins of the model with what the sliders say, about the points that its
//! experiment names. An experiment that asks for no response shows those of the first one of the same model that does.

use hyde_compiler::Compiled;
use hyde_diag::{Diagnostics, Sources};
use hyde_experiment::{About, Linear, Pole, Poles, linearize_about, mode_shape, parameters, poles};
use hyde_present::assumed;
use hyde_present::bode::{errors_table, margins_text, open_loop_figures, response_figure};
use hyde_program::{Bode, Constant, Program};
use hyde_report::{Block, Figure, Outcome, Page, Section, Table, Verdict};
use hyde_signal::Table as Record;
use hyde_sim::Reached;
use hyde_study::modes::asked_point;
use hyde_study::render::render;
use hyde_study::responses::{OfLoop, Response, margins, measured, response};
use hyde_study::settings::Setting;
use hyde_study::{Aim, Asked, Project, Records, operating_point};
use hyde_syntax::ast::{Experiment, ExperimentItem};
use hyde_units::significant;
use std::collections::BTreeMap;

/// Points of a curve.
const POINTS: usize = 400;

/// An experiment compiled for its linearised system.
pub(super) struct Frequencies {
    /// The experiment, and whether it is another one than that of the run.
    experiment: String,
    another: bool,
    sources: Sources,
    compiled: Compiled,
    tables: BTreeMap<String, Record>,
}

impl Frequencies {
    /// Loads and compiles the experiment that asks for responses, else that of the run.
    ///
    /// # Errors
    /// Why it has no linear system, as the console tells it.
    pub(super) fn of(asked: &Asked, shown: &Project) -> Result<Self, String> {
        let own = shown.experiment.as_deref().unwrap_or_default();
        let experiment = asking(shown, own).unwrap_or(own);
        let asked = Asked {
            experiment: Some(experiment.to_owned()),
            ..asked.clone()
        };
        let mut project = hyde_study::load(&asked, Records::Needed)?;
        let compiled = match project.diagnostics.has_errors() {
            true => None,
            false => project.compile(Aim::Linearize).ok(),
        };
        let why = || render(&project.diagnostics, &project.sources, false);
        Ok(Self {
            experiment: experiment.to_owned(),
            another: experiment != own,
            compiled: compiled.ok_or_else(why)?,
            tables: hyde_study::tables(&project.records),
            sources: project.sources,
        })
    }

    /// What there is to show with these values, as a page.
    ///
    /// # Errors
    /// Why the model is not linearised.
    pub(super) fn page(&self, set: &[Setting]) -> Result<Page, String> {
        let program = &self.compiled.program;
        let set: Vec<(String, f64)> = set
            .iter()
            .map(|own| (own.path.clone(), own.value))
            .collect();
        let p = parameters(program, &self.tables, &set);
        let p = p.map_err(|_| "the values are not allowed".to_owned())?;
        let mut sections: Vec<Section> = self.responses(&p).into_iter().collect();
        sections.extend(self.margins(&p));
        match self.modes(&p) {
            Ok(section) => sections.push(section),
            Err(reason) if sections.is_empty() => return Err(reason),
            Err(reason) => sections.push(self.section("Natural frequencies", vec![failed(reason)])),
        }
        Ok(Page {
            sections,
            ..Page::default()
        })
    }

    /// A section; of another experiment than the run it says of which.
    fn section(&self, heading: &str, blocks: Vec<Block>) -> Section {
        Section {
            heading: match self.another {
                true => format!("{heading}, experiment {}", self.experiment),
                false => heading.to_owned(),
            },
            blocks,
        }
    }

    /// A Bode plot for each output that a `bode` asks for, with what was measured.
    fn responses(&self, p: &[f64]) -> Option<Section> {
        let program = &self.compiled.program;
        let measured = measured::curves(program, &self.tables, p);
        let mut blocks = Vec::new();
        let measured = measured.unwrap_or_else(|diagnostic| {
            blocks.push(failed(diagnostic.message));
            Vec::new()
        });
        for number in 0..program.experiment.bodes.len() {
            match self.of_bode(number, p, &measured) {
                Ok(own) => blocks.extend(own),
                Err(reason) => blocks.push(failed(reason)),
            }
        }
        (!blocks.is_empty()).then(|| self.section("Frequency responses", blocks))
    }

    fn of_bode(
        &self,
        number: usize,
        p: &[f64],
        curves: &[hyde_experiment::MeasuredCurve],
    ) -> Result<Vec<Block>, String> {
        let program = &self.compiled.program;
        let bode = &program.experiment.bodes[number];
        if program.experiment.differentiated.contains(&bode.input) {
            return Err(response::no_rate(bode).message);
        }
        let band = response::band(program, number, p);
        let band = band.or_else(|| measured::band(program, number, curves));
        let band = band.ok_or_else(|| "the band of frequencies is empty".to_owned())?;
        let (linear, poles) = self.linear(number, bode, p)?;
        let frequency = response::frequencies(band, POINTS);
        let asked = (bode, frequency.as_slice());
        let name = &self.experiment;
        let reached = Reached::default();
        let found = response::linearised(name, program, asked, (&linear, &poles), &reached);
        let mut responses: Vec<Response> = found?;
        let compared = measured::compared(program, number, curves, &linear, &self.tables, None);
        let wrong = errors_table(&compared.iter().collect::<Vec<_>>());
        for one in compared {
            let output = one.place.1;
            responses[output].measured.push(one);
        }
        let figure = |own: &Response| {
            let caption = format!("{} to {}", own.input, own.output);
            plain(response_figure("", &[own]), &caption)
        };
        let mut blocks: Vec<Block> = responses.iter().map(figure).collect();
        if !wrong.is_empty() {
            blocks.push(Block::Code(wrong));
        }
        Ok(blocks)
    }

    /// The linear system of a `bode`, about the point and in the modes that it names.
    fn linear(&self, number: usize, bode: &Bode, p: &[f64]) -> Result<(Linear, Poles), String> {
        let program = &self.compiled.program;
        let time = program.kernels.constant(Constant::RespondsAt(number), p);
        let about = About {
            time: operating_point::moment(None, bode.at, time)?,
            modes: &bode.modes,
            ..About::default()
        };
        let input = std::slice::from_ref(&bode.input);
        let linear = linearize_about(program, &self.tables, p, input, about);
        let linear = linear.map_err(|error| not_linearised(&error))?;
        let poles = poles(&linear);
        Ok((linear, poles))
    }

    /// The margins of each loop that is cut, with its open loop.
    fn margins(&self, p: &[f64]) -> Vec<Section> {
        let program = &self.compiled.program;
        if program.experiment.cuts.is_empty() {
            return Vec::new();
        }
        let mut wrong = Diagnostics::new();
        let name = &self.experiment;
        let all = margins::all(name, program, &self.tables, p, (None, &[]), &mut wrong);
        let Some(all) = all else {
            let why = render(&wrong, &self.sources, false);
            return vec![self.section("Margins", vec![Block::Code(why)])];
        };
        let section = |own: &OfLoop| {
            let mut blocks = vec![Block::Code(margins_text(own))];
            let figures = open_loop_figures("", own).into_iter();
            let figures = figures.zip(["Open loop", "Nyquist plot"]);
            blocks.extend(figures.map(|((_, figure), caption)| plain(figure, caption)));
            self.section(&format!("Margins at {}", own.signal), blocks)
        };
        all.iter().map(section).collect()
    }

    /// Frequencies, damping ratios and shares of the energy.
    fn modes(&self, p: &[f64]) -> Result<Section, String> {
        let program = &self.compiled.program;
        let (modes, moment, time) = asked_point(program, p);
        let about = About {
            time: operating_point::moment(None, moment, time)?,
            modes: &modes,
            ..About::default()
        };
        let linear = linearize_about(program, &self.tables, p, &[], about);
        let linear = linear.map_err(|error| not_linearised(&error))?;
        let poles = poles(&linear);
        let mut blocks = Vec::new();
        if let Some(text) = assumed::unstable(program, &linear, &poles) {
            blocks.push(failed(text.trim_end().to_owned()));
        }
        blocks.push(Block::Table(table(program, &linear, &poles)));
        blocks.extend(assumed::blocks(program, &linear, about.time));
        Ok(self.section("Natural frequencies", blocks))
    }
}

/// The experiment of the model shown that asks for frequency responses or margins: `own` before the others.
fn asking<'p>(shown: &'p Project, own: &str) -> Option<&'p str> {
    let asks = |experiment: &&Experiment| {
        let mut items = experiment.items.iter();
        let asks =
            items.any(|item| matches!(item, ExperimentItem::Bode(_) | ExperimentItem::Margins(_)));
        asks && experiment.model.as_word() == Some(shown.model.as_str())
    };
    let mut all: Vec<&Experiment> = shown.file.experiments().filter(asks).collect();
    all.sort_by_key(|experiment| experiment.name.text != own);
    all.first().map(|experiment| experiment.name.text.as_str())
}

fn table(program: &Program, linear: &Linear, poles: &Poles) -> Table {
    let row = |pole: &Pole| {
        let mode = pole.mode();
        let shape = mode_shape(program, linear, (poles, pole));
        let energy = shape.map_or("clocked parts alone".to_owned(), |own| {
            assumed::shares(&own)
        });
        let damping = significant(mode.damping, 3);
        vec![significant(mode.frequency_hz, 5), damping, energy]
    };
    Table {
        rows: poles.oscillating().iter().map(row).collect(),
        ..Table::with_columns(&[">f [Hz]", ">damping", "energy"])
    }
}

/// A figure with a caption for its title.
fn plain(figure: Figure, caption: &str) -> Block {
    let figure = Figure {
        title: None,
        ..figure
    };
    Block::Figure(figure.with_caption(caption))
}

fn failed(text: String) -> Block {
    let outcome = Outcome::Failed;
    Block::Verdicts(vec![Verdict { outcome, text }])
}

fn not_linearised(error: &hyde_experiment::LinearizeError) -> String {
    format!(
        "the model is not linearised: {}",
        operating_point::why_not(error)
    )
}
