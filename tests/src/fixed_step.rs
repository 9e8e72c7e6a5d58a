//! The reference of the C export: implicit Euler over the kernels of a program, machine code and full Newton steps; what
//! happens in a step happens at its end, as `hyde export c` says.

use hyde_program::{
    Column, Constant, Function, Point, Program, ReactionKind, RelationUse, Target, Workspace, Wrt,
};
use hyde_signal::{Cursor, Table};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

const ROUNDS: usize = 50;

/// The inputs of a program that records drive, a list for each of some times in s.
///
/// # Errors
/// A record has no such column.
pub fn inputs(
    program: &Program,
    tables: &BTreeMap<String, Table>,
    times: &[f64],
) -> Result<Vec<Vec<f64>>, String> {
    let signal = |column: &Column| {
        let table = tables.get(&column.record);
        let signal = table.and_then(|table| table.signal(&column.column));
        signal.ok_or_else(|| format!("`{}` has no `{}`", column.record, column.column))
    };
    let of = |column: &Column| -> Result<Vec<f64>, String> {
        let signal = signal(column)?;
        let mut cursor = Cursor::default();
        let value = |&t: &f64| match column.next {
            true => signal.next(t, &mut cursor),
            false => signal.linear(t, &mut cursor),
        };
        Ok(times.iter().map(value).collect())
    };
    let columns = program.columns.iter().map(of);
    let columns: Vec<Vec<f64>> = columns.collect::<Result<_, String>>()?;
    let row = |at: usize| columns.iter().map(|column| column[at]).collect();
    match columns.is_empty() {
        true => Ok(Vec::new()),
        false => Ok((0..times.len()).map(row).collect()),
    }
}

/// The same as the programs in `tests/exports` read them: a line for each step.
#[must_use]
pub fn lines(inputs: &[Vec<f64>]) -> String {
    let line = |row: &Vec<f64>| {
        let values: Vec<String> = row.iter().map(|value| format!("{value:?}")).collect();
        values.join(" ") + "\n"
    };
    inputs.iter().map(line).collect()
}

/// A program that is stepped.
pub struct FixedStep<'a> {
    program: &'a Program,
    /// Parameters, free inputs among them.
    pub p: Vec<f64>,
    /// Record columns, two values each.
    pub u: Vec<f64>,
    y: Vec<f64>,
    yp: Vec<f64>,
    z: Vec<f64>,
    largest: Vec<f64>,
    step_s: f64,
    start_s: f64,
    count: i64,
    differential: Vec<bool>,
    conditions: Vec<bool>,
    pinned: Vec<(usize, f64)>,
    pending: Vec<(i64, usize, Vec<f64>, bool)>,
    work: Workspace,
}

impl<'a> FixedStep<'a> {
    /// A program at its consistent start.
    ///
    /// # Errors
    /// It has no solution there.
    pub fn new(
        program: &'a Program,
        p: Vec<f64>,
        (start_s, step_s): (f64, f64),
        start: hyde_sim::KnownStart,
    ) -> Result<Self, String> {
        let mut own = Self {
            differential: program.differential(&start.z),
            u: vec![0.0; 2 * program.columns.len()],
            largest: vec![0.0; start.y.len()],
            y: start.y,
            yp: start.yp,
            z: start.z,
            conditions: vec![false; program.reactions.len()],
            pinned: Vec::new(),
            pending: Vec::new(),
            work: Workspace::new(program.n_work),
            count: 0,
            program,
            p,
            step_s,
            start_s,
        };
        own.pin();
        own.instant(true)?;
        Ok(own)
    }

    /// One step.
    ///
    /// # Errors
    /// It has no solution.
    pub fn step(&mut self) -> Result<(), String> {
        let base = self.y.clone();
        for k in 0..self.y.len() {
            if self.differential[k] {
                self.y[k] += self.step_s * self.yp[k];
            }
        }
        self.count += 1;
        self.solve(self.step_s, base)?;
        self.instant(false)
    }

    /// The reported quantities.
    pub fn outputs(&mut self) -> Vec<f64> {
        self.values(Function::Outputs, self.program.outputs.len(), 0.0)
    }

    fn time(&self) -> f64 {
        self.start_s + self.count as f64 * self.step_s
    }

    fn values(&mut self, function: Function, rows: usize, later: f64) -> Vec<f64> {
        let mut out = vec![0.0; rows];
        let at = Point {
            t: self.time() + later,
            y: &self.y,
            yp: &self.yp,
            z: &self.z,
            u: &self.u,
            p: &self.p,
        };
        let kernels = &self.program.kernels;
        kernels.evaluate(function, at, &mut self.work, &mut out);
        out
    }

    fn truths(&mut self) -> Vec<f64> {
        let mut out = vec![0.0; self.program.reactions.len()];
        let at = Point {
            t: self.time(),
            y: &self.y,
            yp: &self.yp,
            z: &self.z,
            u: &self.u,
            p: &self.p,
        };
        self.program
            .kernels
            .conditions(at, &mut self.work, &mut out);
        out
    }

    /// Rates and algebraic variables; with a step the states are `base + h rate`.
    fn solve(&mut self, h: f64, mut base: Vec<f64>) -> Result<(), String> {
        let n = self.y.len();
        let mut last = f64::INFINITY;
        self.apply_pins();
        for &(state, value) in &self.pinned {
            base[state] = value;
        }
        for _ in 0..60 {
            let residual = DVector::from_vec(self.values(Function::Residual, n, 0.0));
            let mut matrix = DMatrix::zeros(n, n);
            let entries = self.program.partials(Function::Residual);
            let mut partials = vec![0.0; entries.len()];
            let at = Point {
                t: self.time(),
                y: &self.y,
                yp: &self.yp,
                z: &self.z,
                u: &self.u,
                p: &self.p,
            };
            let kernels = &self.program.kernels;
            kernels.partials(Function::Residual, at, &mut self.work, &mut partials);
            for (entry, value) in entries.iter().zip(partials) {
                match entry.wrt {
                    Wrt::Derivative(column) => matrix[(entry.row, column)] += value,
                    Wrt::Unknown(column) if self.differential[column] => {
                        matrix[(entry.row, column)] += h * value;
                    }
                    Wrt::Unknown(column) => matrix[(entry.row, column)] += value,
                    Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => {}
                }
            }
            let change = matrix.lu().solve(&residual).ok_or("singular")?;
            let mut size: f64 = 0.0;
            for k in 0..n {
                let value = match self.differential[k] {
                    true => &mut self.yp[k],
                    false => &mut self.y[k],
                };
                *value -= change[k];
                self.largest[k] = self.largest[k].max(value.abs());
                let mut part = change[k].abs() / (1e-12 * self.largest[k] + 1e-14);
                if self.differential[k] {
                    self.y[k] = base[k] + h * self.yp[k];
                    let of_state = self.step_s * change[k].abs();
                    part = part.min(of_state / (1e-12 * self.y[k].abs() + 1e-14));
                }
                size = size.max(part);
            }
            if size <= 1.0 || size <= 1e6 && size > 0.25 * last {
                self.apply_pins();
                return Ok(());
            }
            last = size;
        }
        Err(format!("not solved at {} s", self.time()))
    }

    fn apply_pins(&mut self) {
        for &(state, value) in &self.pinned {
            self.y[state] = value;
            self.yp[state] = 0.0;
        }
    }

    fn pin(&mut self) {
        let rows = self.program.rows(Function::Assignments);
        let values = self.values(Function::Assignments, rows, 0.0);
        let first = self.program.assignments.len();
        let pins = self.program.pins.iter().zip(&values[first..]);
        let on = pins.filter(|(pin, _)| self.in_mode(pin.automaton, pin.mode));
        self.pinned = on.map(|(pin, value)| (pin.state, *value)).collect();
        self.apply_pins();
    }

    fn in_mode(&self, automaton: usize, mode: usize) -> bool {
        self.z[self.program.automata[automaton].place] as usize == mode
    }

    fn instant(&mut self, at_start: bool) -> Result<(), String> {
        let left = (self.y.clone(), self.yp.clone(), self.z.clone());
        self.settle(at_start)?;
        if self.tick(&left) {
            self.solve(0.0, self.y.clone())?;
            self.settle(false)?;
        }
        Ok(())
    }

    fn settle(&mut self, at_start: bool) -> Result<(), String> {
        let program = self.program;
        for round in 0..ROUNDS {
            let first = at_start && round == 0;
            let roots = self.values(Function::Roots, program.relations.len(), 0.0);
            let later = self.values(Function::Roots, program.relations.len(), 1e-3 * self.step_s);
            let mut flipped = Vec::new();
            for (k, relation) in program.relations.iter().enumerate() {
                let root = if relation.scheduled {
                    later[k]
                } else {
                    roots[k]
                };
                let truth = f64::from(u8::from(
                    root > 0.0 || root.abs() == 0.0 && relation.inclusive,
                ));
                let matters = match relation.used {
                    RelationUse::Exit(automaton, mode) => self.in_mode(automaton, mode),
                    RelationUse::Equation | RelationUse::When | RelationUse::Assert => true,
                };
                if matters && self.z[k].to_bits() != truth.to_bits() {
                    self.z[k] = truth;
                    if relation.used == RelationUse::Equation {
                        flipped.push(k);
                    }
                }
            }
            let fired = self.fired(first)?;
            if fired.is_empty() && flipped.is_empty() {
                for reaction in &program.reactions {
                    if let ReactionKind::Edge(place) = reaction.kind {
                        self.z[place] = 0.0;
                    }
                }
                return Ok(());
            }
            self.apply(&fired, &flipped);
            self.solve(0.0, self.y.clone())?;
        }
        Ok(())
    }

    fn fired(&mut self, first: bool) -> Result<Vec<usize>, String> {
        let program = self.program;
        let mut truths = self.truths();
        for (k, reaction) in program.reactions.iter().enumerate() {
            if let ReactionKind::Edge(place) = reaction.kind {
                let became = !first && truths[k] != 0.0 && !self.conditions[k];
                self.z[place] = f64::from(u8::from(became));
            }
        }
        truths = self.truths();
        let (mut fired, mut left, mut clauses) = (Vec::new(), Vec::new(), Vec::new());
        for (k, reaction) in program.reactions.iter().enumerate() {
            let (now, before) = (truths[k] != 0.0, self.conditions[k]);
            self.conditions[k] = now;
            match &reaction.kind {
                ReactionKind::Transition {
                    automaton, from, ..
                } => {
                    if now && self.in_mode(*automaton, *from) && !left.contains(automaton) {
                        left.push(*automaton);
                        fired.push(k);
                    }
                }
                ReactionKind::When { clause } => {
                    if now && !before && !first && !clauses.contains(clause) {
                        clauses.push(*clause);
                        fired.push(k);
                    }
                }
                ReactionKind::Edge(_) => {}
                ReactionKind::Assert(message) if now => return Err(message.clone()),
                ReactionKind::Assert(_) => {}
            }
        }
        Ok(fired)
    }

    fn apply(&mut self, fired: &[usize], flipped: &[usize]) {
        let program = self.program;
        let turn = |z: &mut [f64]| flipped.iter().for_each(|&k| z[k] = 1.0 - z[k]);
        turn(&mut self.z);
        let values = self.values(
            Function::Assignments,
            program.rows(Function::Assignments),
            0.0,
        );
        turn(&mut self.z);
        for &k in fired {
            for n in program.reactions[k].assignments.clone() {
                match program.assignments[n].target {
                    Target::State(place) => self.y[place] = values[n],
                    Target::Memory(place) => self.z[place] = values[n],
                }
            }
        }
        for &k in fired {
            if let ReactionKind::Transition { automaton, to, .. } = program.reactions[k].kind {
                self.z[program.automata[automaton].place] = to as f64;
            }
        }
        self.pin();
    }

    fn tick(&mut self, (y, yp, z): &(Vec<f64>, Vec<f64>, Vec<f64>)) -> bool {
        let program = self.program;
        let steps = |which| {
            let time = program.kernels.constant(which, &self.p).unwrap_or(0.0);
            (time / self.step_s).round() as i64
        };
        let now = std::mem::replace(&mut self.z, z.clone());
        for &clock in &program.clock_order {
            let since = self.count - steps(Constant::Phase(clock));
            if since < 0 || since % steps(Constant::Period(clock)) != 0 {
                continue;
            }
            let mut after = self.z.clone();
            let at = Point {
                t: self.time(),
                y,
                yp,
                z: &self.z,
                u: &self.u,
                p: &self.p,
            };
            program.kernels.tick(clock, at, &mut self.work, &mut after);
            self.z = after;
            let due = self.count + steps(Constant::Delay(clock));
            for hold in program.holds.iter().filter(|hold| hold.clock == clock) {
                let values = self.z[hold.source..hold.source + hold.len].to_vec();
                self.pending.push((due, hold.target, values, hold.read));
            }
        }
        let mut changed = false;
        for (due, target, values, read) in std::mem::take(&mut self.pending) {
            if due > self.count {
                self.pending.push((due, target, values, read));
                continue;
            }
            let held = &mut self.z[target..target + values.len()];
            changed |= read
                && held
                    .iter()
                    .zip(&values)
                    .any(|(a, b)| a.to_bits() != b.to_bits());
            held.copy_from_slice(&values);
        }
        for (k, before) in z.iter().enumerate() {
            if self.z[k].to_bits() == before.to_bits() {
                self.z[k] = now[k];
            }
        }
        changed
    }
}
