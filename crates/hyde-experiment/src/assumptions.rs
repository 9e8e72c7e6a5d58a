//! What a linearised model takes otherwise than it is at the operating point, and what is open there: a switch at its zero.

use crate::linearize::Dense;
use hyde_program::{Function, Point, Program, RelationUse, Workspace, Wrt};
use hyde_sim::{OperatingPoint, TakenMode};

/// Derivatives that differ by more, over the largest of their row, are those of two sides of a switch.
const OTHER: f64 = 1e-3;
/// How often numbers are moved about to find a kink among them.
const TRIALS: usize = 6;

/// Something that a linearised model assumes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Assumption {
    /// An automaton is taken in another mode than the run has it in.
    Mode(TakenMode),
    /// A condition of the equations is within rounding of its switch: it is taken as true or false.
    Switch {
        /// As written.
        condition: String,
        /// The truth it is taken with.
        taken: bool,
    },
    /// The exit of a mode, or the condition of a `when`, is within rounding of its switch: it is taken as not yet reached.
    Event {
        /// As written.
        condition: String,
        /// The automaton whose exit it is.
        automaton: Option<usize>,
    },
    /// The run slides on a surface: one side of it is taken.
    Slide(String),
    /// An expression without events is within rounding of a kink, in a clocked part or in the equation of an unknown, which
    /// is named: one side is taken.
    Kink(String),
}

/// What is assumed at a point with these free inputs, whose places in the parameter vector are given; what the run knows of
/// its values is exact to a relative and an absolute tolerance.
pub(crate) fn assumptions(
    program: &Program,
    inputs: &[usize],
    point: &OperatingPoint,
    tolerances: (f64, f64),
) -> Vec<Assumption> {
    let mut found: Vec<Assumption> = point.modes.iter().copied().map(Assumption::Mode).collect();
    found.extend(point.slides.iter().cloned().map(Assumption::Slide));
    let mut look = Look {
        program,
        inputs,
        directions: program.kernels.parameter_directions(inputs, &point.p),
        tolerances,
        at: point.at(),
        work: Workspace::new(program.n_work),
    };
    for relation in look.at_zero() {
        let known = &program.relations[relation];
        let condition = known.text.clone();
        let told = match known.used {
            RelationUse::Equation if look.matters(relation) => Some(Assumption::Switch {
                condition,
                taken: point.z[relation] != 0.0,
            }),
            RelationUse::Exit(automaton, mode) => {
                let taken = |known: &TakenMode| known.automaton == automaton;
                let here = program.mode(&point.z, automaton) == mode;
                let new = here && !point.modes.iter().any(taken);
                new.then_some(Assumption::Event {
                    condition,
                    automaton: Some(automaton),
                })
            }
            RelationUse::When => Some(Assumption::Event {
                condition,
                automaton: None,
            }),
            RelationUse::Equation | RelationUse::Assert => None,
        };
        if let Some(told) = told.filter(|told| !found.contains(told)) {
            found.push(told);
        }
    }
    found.extend(look.kinks().into_iter().map(Assumption::Kink));
    found
}

/// A look at a point.
struct Look<'a> {
    program: &'a Program,
    inputs: &'a [usize],
    directions: Vec<Vec<f64>>,
    tolerances: (f64, f64),
    at: Point<'a>,
    work: Workspace,
}

impl Look<'_> {
    /// The relations whose root functions are zero as far as their arguments are known. Those that the time alone decides
    /// are not in doubt: it goes one way.
    fn at_zero(&mut self) -> Vec<usize> {
        let (program, at) = (self.program, self.at);
        let count = program.relations.len();
        let mut roots = vec![0.0; count];
        let kernels = &program.kernels;
        kernels.evaluate(Function::Roots, at, &mut self.work, &mut roots);
        let entries = program.partials(Function::Roots);
        let mut values = vec![0.0; entries.len()];
        kernels.partials(Function::Roots, at, &mut self.work, &mut values);
        let (mut bands, mut decided) = (vec![0.0; count], vec![false; count]);
        for (entry, value) in entries.iter().zip(values) {
            let argument = match entry.wrt {
                Wrt::Unknown(column) => at.y[column],
                Wrt::Derivative(column) => at.yp[column],
                Wrt::Delayed(number) => at.u[2 * program.columns.len() + number],
                Wrt::Time | Wrt::Parameter(_) | Wrt::Memory(_) => continue,
            };
            decided[entry.row] = true;
            bands[entry.row] += value.abs() * self.known_to(argument);
        }
        let held = |place: usize| {
            let mut holds = program.holds.iter();
            holds.any(|hold| (hold.target..hold.target + hold.len).contains(&place))
        };
        let still = kernels.still_entries(Function::Roots);
        let mut values = vec![0.0; still.len()];
        kernels.still_partials(Function::Roots, at, &mut self.work, &mut values);
        for (entry, value) in still.iter().zip(values) {
            match entry.wrt {
                Wrt::Memory(place) if held(place) => {
                    decided[entry.row] = true;
                    bands[entry.row] += value.abs() * self.known_to(at.z[place]);
                }
                Wrt::Parameter(place) if self.directions.iter().any(|d| d[place] != 0.0) => {
                    decided[entry.row] = true;
                    bands[entry.row] += value.abs() * self.known_to(at.p[place]);
                }
                Wrt::Unknown(_)
                | Wrt::Derivative(_)
                | Wrt::Parameter(_)
                | Wrt::Memory(_)
                | Wrt::Delayed(_)
                | Wrt::Time => {}
            }
        }
        let near = |&number: &usize| {
            let scheduled = program.relations[number].scheduled;
            decided[number] && !scheduled && roots[number].abs() <= bands[number]
        };
        (0..count).filter(near).collect()
    }

    /// How exactly a number is known.
    fn known_to(&self, value: f64) -> f64 {
        let (relative, absolute) = self.tolerances;
        relative * value.abs() + absolute
    }

    /// Whether the other truth of a relation changes a value or a derivative of anything.
    fn matters(&mut self, relation: usize) -> bool {
        let mut turned = self.at.z.to_vec();
        turned[relation] = 1.0 - turned[relation];
        let other = Point {
            z: &turned,
            ..self.at
        };
        let functions = [Function::Residual, Function::Outputs, Function::Delayed];
        let slopes = functions.into_iter().any(|function| {
            let here = self.slopes(function, self.at);
            let there = self.slopes(function, other);
            let mut rows = here.iter().zip(&there);
            rows.any(|(here, there)| differ(here, there))
        });
        slopes || {
            let values = |look: &mut Self, at| {
                let mut all = Vec::new();
                for function in functions {
                    let mut values = vec![0.0; look.program.rows(function)];
                    let kernels = &look.program.kernels;
                    kernels.evaluate(function, at, &mut look.work, &mut values);
                    all.extend(values);
                }
                all
            };
            let (here, there) = (values(self, self.at), values(self, other));
            let pairs = here.iter().zip(&there);
            pairs
                .into_iter()
                .any(|(a, b)| (a - b).abs() > 1e-9 * a.abs().max(b.abs()) + 1e-12)
        }
    }

    /// The derivatives of a function, a row a list.
    fn slopes(&mut self, function: Function, at: Point<'_>) -> Vec<Vec<f64>> {
        let held: Vec<usize> = self
            .program
            .holds
            .iter()
            .flat_map(|hold| hold.target..hold.target + hold.len)
            .collect();
        let dense = Dense::of(
            self.program,
            function,
            at,
            &mut self.work,
            self.inputs,
            &held,
        );
        let parts = [
            &dense.by_unknown,
            &dense.by_derivative,
            &dense.by_input,
            &dense.by_held,
            &dense.by_delayed,
        ];
        let row = |row: usize| {
            let parts = parts.iter();
            parts
                .flat_map(|part| part.row(row).iter().copied().collect::<Vec<f64>>())
                .collect()
        };
        (0..self.program.rows(function)).map(row).collect()
    }

    /// The clocked parts and unknowns whose equations have other derivatives if what they read is moved by as much as it is
    /// not known.
    fn kinks(&mut self) -> Vec<String> {
        let here = self.all_slopes(self.at);
        let mut found: Vec<String> = Vec::new();
        for trial in 0..TRIALS {
            let moved = |values: &[f64], salt: usize| -> Vec<f64> {
                let each = values.iter().enumerate();
                let by = |number, value| self.known_to(value) * sign(number + salt, trial);
                each.map(|(number, value)| value + by(number, *value))
                    .collect()
            };
            let (y, yp) = (moved(self.at.y, 0), moved(self.at.yp, 3));
            let mut z = moved(self.at.z, 7);
            // Truths, modes and factors of chosen states are no numbers that are known to rounding.
            for place in self.exact_places() {
                z[place] = self.at.z[place];
            }
            let mut p = self.at.p.to_vec();
            for (number, direction) in self.directions.iter().enumerate() {
                let by = self.tolerances.1 * sign(number, trial);
                p.iter_mut().zip(direction).for_each(|(p, d)| *p += by * d);
            }
            let there = self.all_slopes(Point {
                y: &y,
                yp: &yp,
                z: &z,
                p: &p,
                ..self.at
            });
            for ((name, here), (_, there)) in here.iter().zip(&there) {
                if differ(here, there) && !found.contains(name) {
                    found.push(name.clone());
                }
            }
        }
        found
    }

    /// Places of the memory that hold truths, modes and factors.
    fn exact_places(&self) -> Vec<usize> {
        let program = self.program;
        let automata = program.automata.iter().map(|automaton| automaton.place);
        let factors = program.selections.iter().flat_map(|selection| {
            let m = selection.candidates.len();
            selection.factors..selection.factors + m * (m - selection.constraints.len())
        });
        let truths = 0..program.relations.len();
        truths.chain(automata).chain(factors).collect()
    }

    /// The derivatives of every equation and clocked part, by what they are called.
    fn all_slopes(&mut self, at: Point<'_>) -> Vec<(String, Vec<f64>)> {
        let program = self.program;
        let rows = self.slopes(Function::Residual, at);
        let rows = rows.into_iter().enumerate();
        let mut all: Vec<(String, Vec<f64>)> = rows
            .map(|(row, slopes)| (program.unknown_name(row), slopes))
            .collect();
        for (clock, known) in program.clocks.iter().enumerate() {
            let kernels = &program.kernels;
            let mut partials = kernels.tick_partials(clock, at, &mut self.work);
            partials.sort_by_key(|(row, ..)| *row);
            for row in partials.chunk_by(|a, b| a.0 == b.0) {
                let slopes = row.iter().map(|(.., value)| *value).collect();
                all.push((known.name.clone(), slopes));
            }
        }
        all
    }
}

/// Whether a row has another slope.
fn differ(here: &[f64], there: &[f64]) -> bool {
    let both = || here.iter().zip(there);
    let largest = both().map(|(a, b)| a.abs().max(b.abs()));
    let largest = largest.fold(0.0, f64::max);
    both().any(|(a, b)| (a - b).abs() > OTHER * largest)
}

/// 1 or -1, without a pattern.
fn sign(number: usize, trial: usize) -> f64 {
    let mixed = (number as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> (20 + 3 * trial);
    // The first two trials move all one way.
    match trial {
        0 => 1.0,
        1 => -1.0,
        _ if mixed & 1 == 0 => 1.0,
        _ => -1.0,
    }
}
