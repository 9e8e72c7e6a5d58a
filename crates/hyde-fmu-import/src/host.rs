//! An FMU in another process: what is said between the two, one line of JSON each way. If the library crashes, the run ends
//! with a diagnostic.

use crate::{Fmu, InProcess};
use hyde_program::{Foreign as _, ForeignInstance, ForeignTick, Stopped};
use serde::{Deserialize, Serialize};
use std::io::{BufRead, Write};
use std::sync::Arc;

/// What the process is asked first: the FMU, and the name of the component.
#[derive(Serialize, Deserialize)]
struct Begin {
    /// The file as the model names it.
    file: String,
    component: String,
    /// How many bytes of the archive follow.
    size: usize,
}

/// What it is asked at each tick. Numbers are their bits: not every one can be written in JSON.
#[derive(Serialize, Deserialize)]
struct Tick {
    t: u64,
    period: u64,
    stop: u64,
    parameters: Vec<u64>,
    inputs: Vec<u64>,
    outputs: Vec<u64>,
}

/// What it answers.
#[derive(Serialize, Deserialize)]
enum Answer {
    Outputs(Vec<u64>),
    Stopped { what: String, log: Vec<String> },
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn numbers(bits: &[u64]) -> Vec<f64> {
    bits.iter().map(|&bits| f64::from_bits(bits)).collect()
}

/// Serves one instance: reads what is asked from `asked` and writes answers until it ends.
///
/// # Errors
/// The other side is gone, or says what cannot be read.
pub fn serve(mut asked: impl BufRead, mut answers: impl Write) -> Result<(), String> {
    let mut line = String::new();
    if !next(&mut asked, &mut line)? {
        return Ok(());
    }
    let begin: Begin = serde_json::from_str(&line).map_err(|error| error.to_string())?;
    let stopped = |what: String| Stopped {
        what,
        log: Vec::new(),
    };
    let mut content = vec![0; begin.size];
    asked
        .read_exact(&mut content)
        .map_err(|error| error.to_string())?;
    let mut instance = Fmu::read(&begin.file, content, "fmu", "Model")
        .map_err(|unusable| stopped(unusable.what))
        .and_then(|fmu| InProcess::new(Arc::new(fmu)).instance(&begin.component));
    while next(&mut asked, &mut line)? {
        let tick: Tick = serde_json::from_str(&line).map_err(|error| error.to_string())?;
        let mut outputs = numbers(&tick.outputs);
        let done = match &mut instance {
            Ok(instance) => instance.tick(ForeignTick {
                t: f64::from_bits(tick.t),
                period: f64::from_bits(tick.period),
                stop: f64::from_bits(tick.stop),
                parameters: &numbers(&tick.parameters),
                inputs: &numbers(&tick.inputs),
                outputs: &mut outputs,
            }),
            Err(stopped) => Err(stopped.clone()),
        };
        let answer = match done {
            Ok(()) => Answer::Outputs(bits(&outputs)),
            Err(Stopped { what, log }) => Answer::Stopped { what, log },
        };
        let mut text = serde_json::to_string(&answer).map_err(|error| error.to_string())?;
        text.push('\n');
        answers
            .write_all(text.as_bytes())
            .and_then(|()| answers.flush())
            .map_err(|error| error.to_string())?;
    }
    Ok(())
}

fn next(asked: &mut impl BufRead, line: &mut String) -> Result<bool, String> {
    line.clear();
    let length = asked.read_line(line).map_err(|error| error.to_string())?;
    Ok(length > 0)
}

/// The other end: an instance that a process computes.
pub struct Remote<P> {
    process: P,
    /// The FMU and the component, until they are sent.
    begin: Option<(Arc<Fmu>, String)>,
}

/// A process that serves one instance.
pub trait Process: Send {
    /// Sends a line and waits for the line of the answer.
    ///
    /// # Errors
    /// The process has ended, and how.
    fn ask(&mut self, line: &str) -> Result<String, String>;

    /// Sends bytes that have no answer.
    ///
    /// # Errors
    /// The process has ended, and how.
    fn tell(&mut self, bytes: &[u8]) -> Result<(), String>;
}

impl<P: Process> Remote<P> {
    /// An instance of an FMU for a component.
    pub fn new(process: P, fmu: Arc<Fmu>, component: &str) -> Self {
        Self {
            process,
            begin: Some((fmu, component.to_owned())),
        }
    }

    fn ask(&mut self, tick: &ForeignTick<'_>) -> Result<Answer, String> {
        if let Some((fmu, component)) = self.begin.take() {
            let begin = Begin {
                file: fmu.file.clone(),
                component,
                size: fmu.content.len(),
            };
            let mut line = serde_json::to_string(&begin).map_err(|error| error.to_string())?;
            line.push('\n');
            self.process.tell(line.as_bytes())?;
            self.process.tell(&fmu.content)?;
        }
        let asked = Tick {
            t: tick.t.to_bits(),
            period: tick.period.to_bits(),
            stop: tick.stop.to_bits(),
            parameters: bits(tick.parameters),
            inputs: bits(tick.inputs),
            outputs: bits(tick.outputs),
        };
        let line = serde_json::to_string(&asked).map_err(|error| error.to_string())?;
        let answer = self.process.ask(&line)?;
        serde_json::from_str(&answer).map_err(|error| error.to_string())
    }
}

impl<P: Process> ForeignInstance for Remote<P> {
    fn tick(&mut self, tick: ForeignTick<'_>) -> Result<(), Stopped> {
        match self.ask(&tick) {
            Ok(Answer::Outputs(outputs)) => {
                tick.outputs
                    .iter_mut()
                    .zip(numbers(&outputs))
                    .for_each(|(place, value)| *place = value);
                Ok(())
            }
            Ok(Answer::Stopped { what, log }) => Err(Stopped { what, log }),
            Err(what) => Err(Stopped {
                what,
                log: Vec::new(),
            }),
        }
    }
}
