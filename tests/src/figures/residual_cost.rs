//! `residual_cell_cost_vs_c`: machine code against C written by hand, compiled here by `cc -O3`.

use super::clock::now;
use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;
use hyde_compiler::Backend;
use hyde_program::{Function, Point, Program, Workspace};
use std::io::{BufRead, BufReader, Lines, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

pub(super) const FIGURE: Figure = Figure {
    name: "residual_cell_cost_vs_c",
    unit: "ratio",
    promise: Promise::AtMost(1.5),
    measure,
};

const CELLS: u32 = 5000;

/// Evaluations in a batch, some milliseconds of work.
const TURNS: u32 = 300;

/// Batches of each, one of Hyde after one of C, so that both see the same machine.
const BATCHES: usize = 40;

/// The quickest batch of machine code over the quickest one of C; what is slower was disturbed from outside.
fn measure(_: &Session) -> Result<Measured, String> {
    let screw = Example::load("tests/models/screw.hyde", None)?.set("n", f64::from(CELLS));
    let program = screw.compile(Backend::Native)?.program;
    let mut state = State::new(&program)?;
    let mut c = HandWritten::start(&program, &state)?;
    let (mut quickest, mut quickest_c) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..BATCHES {
        quickest_c = quickest_c.min(c.batch()?);
        quickest = quickest.min(state.batch(&program));
    }
    agree(&state, &c.finish()?)?;
    Ok(Measured::Value(quickest / quickest_c))
}

/// A point and room for the residual there.
struct State {
    p: Vec<f64>,
    y: Vec<f64>,
    yp: Vec<f64>,
    workspace: Workspace,
    out: Vec<f64>,
}

impl State {
    /// A smooth point away from zero.
    fn new(program: &Program) -> Result<Self, String> {
        let place = |name: &str| {
            let blocks = program.unknowns.iter().filter(|block| block.name == name);
            blocks.map(|block| block.offset).min()
        };
        let nodes = program.n_unknowns / 2 - 1;
        let layout = ["table.s", "table.v", "screw.th", "screw.w"].map(place);
        if layout != [Some(0), Some(1), Some(2), Some(2 + nodes)] {
            return Err(format!("the C code does not know the layout {layout:?}"));
        }
        let mut p = vec![0.0; program.n_parameters];
        program.kernels.parameters(&[], &mut p);
        let wave = |scale: f64, step: f64| {
            let n = u32::try_from(program.n_unknowns).unwrap_or(0);
            (0..n)
                .map(|i| scale * (step * f64::from(i)).sin())
                .collect()
        };
        Ok(Self {
            p,
            y: wave(1.0, 0.37),
            yp: wave(10.0, 0.73),
            workspace: Workspace::new(program.n_work),
            out: vec![0.0; program.n_unknowns],
        })
    }

    /// Nanoseconds of a batch.
    fn batch(&mut self, program: &Program) -> f64 {
        let at = Point {
            t: 0.0,
            y: &self.y,
            yp: &self.yp,
            z: &[],
            u: &[],
            p: &self.p,
        };
        let start = now();
        for _ in 0..TURNS {
            let (workspace, out) = (&mut self.workspace, &mut self.out);
            program
                .kernels
                .evaluate(Function::Residual, at, workspace, out);
        }
        start.elapsed().as_secs_f64() * 1e9
    }
}

/// The C program, waiting for lines.
struct HandWritten {
    child: Child,
    input: Option<ChildStdin>,
    output: Lines<BufReader<ChildStdout>>,
    _folder: tempfile::TempDir,
}

impl HandWritten {
    fn start(program: &Program, state: &State) -> Result<Self, String> {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let command = compile(folder.path())?;
        let mut child = Command::new(command)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| format!("the C program does not start: {error}"))?;
        let (mut input, output) = match (child.stdin.take(), child.stdout.take()) {
            (Some(input), Some(output)) => (input, output),
            (None, _) | (_, None) => return Err("the C program has no pipes".to_owned()),
        };
        let text = problem(program, state)?;
        input
            .write_all(text.as_bytes())
            .map_err(|error| error.to_string())?;
        Ok(Self {
            child,
            input: Some(input),
            output: BufReader::new(output).lines(),
            _folder: folder,
        })
    }

    /// Nanoseconds of a batch.
    fn batch(&mut self) -> Result<f64, String> {
        if let Some(input) = &mut self.input {
            input.write_all(b"\n").map_err(|error| error.to_string())?;
        }
        self.number()?
            .ok_or_else(|| "the C program ended".to_owned())
    }

    /// The residual that it computed.
    fn finish(mut self) -> Result<Vec<f64>, String> {
        self.input = None;
        let mut values = Vec::new();
        while let Some(value) = self.number()? {
            values.push(value);
        }
        self.child.wait().map_err(|error| error.to_string())?;
        Ok(values)
    }

    fn number(&mut self) -> Result<Option<f64>, String> {
        let Some(line) = self.output.next() else {
            return Ok(None);
        };
        let line = line.map_err(|error| error.to_string())?;
        let number = line.parse();
        number
            .map(Some)
            .map_err(|_| format!("`{line}` is no number"))
    }
}

/// Compiles the C program into a folder.
fn compile(folder: &Path) -> Result<std::path::PathBuf, String> {
    let program = folder.join("residual");
    let mut compiler = Command::new("cc")
        .args(["-O3", "-x", "c", "-", "-o"])
        .arg(&program)
        .stdin(Stdio::piped())
        .spawn()
        .map_err(|error| format!("no C compiler: {error}"))?;
    if let Some(mut input) = compiler.stdin.take() {
        input
            .write_all(include_bytes!("residual.c"))
            .map_err(|error| error.to_string())?;
    }
    let status = compiler.wait().map_err(|error| error.to_string())?;
    if status.success() {
        Ok(program)
    } else {
        Err("cc does not compile residual.c".to_owned())
    }
}

/// The numbers that the C program reads first.
fn problem(program: &Program, state: &State) -> Result<String, String> {
    let value = |name: &str| {
        let found = program.parameter(name);
        found
            .map(|(parameter, _)| state.p[parameter.place])
            .ok_or_else(|| format!("the screw has no parameter `{name}`"))
    };
    let ip = value("screw.Ip")?;
    let numbers = [
        value("screw.rho")? * ip,
        value("screw.G")? * ip,
        value("screw.tv")?,
        f64::from(CELLS) / value("screw.len")?,
        value("screw.lead")?,
        value("screw.contact.k")?,
        value("screw.contact.c")?,
        value("table.M")?,
        value("near.J")?,
        value("far.J")?,
        value("T")?,
    ];
    let mut text = format!("{CELLS} {TURNS}");
    let pairs = state.y.iter().zip(&state.yp).flat_map(|(&y, &yp)| [y, yp]);
    for number in numbers.into_iter().chain(pairs) {
        text.push_str(&format!(" {number:e}"));
    }
    text.push('\n');
    Ok(text)
}

/// Both compute the same to rounding: differences of neighbours of size 1 are scaled up to forces of the row's largest
/// term, so that is what rounding is relative to.
fn agree(state: &State, c: &[f64]) -> Result<(), String> {
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let apart: Vec<f64> = state.out.iter().zip(c).map(|(a, b)| a - b).collect();
    if c.len() != state.out.len() || largest(&apart) > 1e-13 * largest(c) {
        return Err(format!(
            "the C code computes something else: {:e} apart, largest {:e}",
            largest(&apart),
            largest(c)
        ));
    }
    Ok(())
}
