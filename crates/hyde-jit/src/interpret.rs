//! The interpreter: slow and obvious, the oracle for the machine code.

use crate::routine::{Leaf, Routine, Slot};
use hyde_ir::{BinaryOp, Dae, Expr, Index, Range, UnaryOp};
use hyde_program::Point;
use rustc_hash::FxHashMap;

/// The memory of a call.
pub(crate) struct Frame<'a> {
    pub(crate) t: f64,
    pub(crate) y: &'a [f64],
    pub(crate) yp: &'a [f64],
    pub(crate) z: &'a [f64],
    pub(crate) u: &'a [f64],
    pub(crate) p: &'a [f64],
    pub(crate) work: &'a mut [f64],
    pub(crate) out: &'a mut [f64],
}

/// A routine as lists of operations on registers, one list a step.
#[derive(Clone, Debug)]
pub(crate) struct Interpreter {
    steps: Vec<Code>,
    registers: usize,
}

#[derive(Clone, Debug)]
struct Code {
    range: Range,
    slot: Slot,
    target: Index,
    operations: Vec<Operation>,
}

/// An operation; its result is the register of its own number.
#[derive(Clone, Copy, Debug)]
enum Operation {
    Leaf(Leaf),
    Unary(UnaryOp, usize),
    Binary(BinaryOp, usize, usize),
    If(usize, usize, usize),
}

impl Interpreter {
    pub(crate) fn new(dae: &Dae, routine: &Routine) -> Self {
        let mut registers = 0;
        let steps = routine
            .steps
            .iter()
            .map(|step| {
                let nodes = dae.exprs.below(&[step.value]);
                let mut number = FxHashMap::default();
                let mut operations: Vec<Operation> = Vec::new();
                for id in nodes {
                    let operation = match dae.exprs[id] {
                        Expr::Unary(op, a) => Operation::Unary(op, number[&a]),
                        Expr::Binary(op, a, b) => Operation::Binary(op, number[&a], number[&b]),
                        Expr::If(c, a, b) => Operation::If(number[&c], number[&a], number[&b]),
                        Expr::NoEvent(a) => {
                            let same = number[&a];
                            number.insert(id, same);
                            continue;
                        }
                        leaf @ (Expr::Const(_)
                        | Expr::Time
                        | Expr::Counter
                        | Expr::Param(..)
                        | Expr::Var(..)
                        | Expr::Der(..)
                        | Expr::Pre(..)
                        | Expr::Relation(_)
                        | Expr::InMode(..)) => Operation::Leaf(
                            routine.leaf(dae, leaf).unwrap_or(Leaf::Number(f64::NAN)),
                        ),
                    };
                    number.insert(id, operations.len());
                    operations.push(operation);
                }
                // The root is the last node unless it is a NoEvent of an earlier one.
                let root = number[&step.value];
                operations.truncate(root + 1);
                registers = registers.max(operations.len());
                Code {
                    range: step.range,
                    slot: step.slot,
                    target: step.target,
                    operations,
                }
            })
            .collect();
        Self { steps, registers }
    }

    pub(crate) fn run(&self, frame: &mut Frame<'_>) {
        let mut registers = vec![0.0; self.registers];
        for step in &self.steps {
            for counter in step.range.iter() {
                for (number, &operation) in step.operations.iter().enumerate() {
                    registers[number] = match operation {
                        Operation::Leaf(leaf) => frame.leaf(leaf, counter),
                        Operation::Unary(op, a) => op.apply(registers[a]),
                        Operation::Binary(op, a, b) => op.apply(registers[a], registers[b]),
                        Operation::If(c, a, b) => {
                            if registers[c] == 0.0 {
                                registers[b]
                            } else {
                                registers[a]
                            }
                        }
                    };
                }
                let value = registers[step.operations.len() - 1];
                let at = usize::try_from(step.target.at(counter)).unwrap_or(usize::MAX);
                if step.slot == Slot::Work {
                    frame.work[at] = value;
                } else {
                    frame.out[at] = value;
                }
            }
        }
    }
}

impl<'a> Frame<'a> {
    /// The memory at a point.
    #[inline]
    pub(crate) fn at(point: Point<'a>, work: &'a mut [f64], out: &'a mut [f64]) -> Self {
        let Point { t, y, yp, z, u, p } = point;
        Self {
            t,
            y,
            yp,
            z,
            u,
            p,
            work,
            out,
        }
    }

    /// The memory of what depends on parameters alone.
    pub(crate) fn of_parameters(p: &'a [f64], out: &'a mut [f64]) -> Self {
        let nowhere = Point {
            t: 0.0,
            y: &[],
            yp: &[],
            z: &[],
            u: &[],
            p,
        };
        Self::at(nowhere, &mut [], out)
    }

    fn leaf(&self, leaf: Leaf, counter: i32) -> f64 {
        match leaf {
            Leaf::Number(value) => value,
            Leaf::Time => self.t,
            Leaf::Counter => f64::from(counter),
            Leaf::IsMode(place, mode) => f64::from(u8::from(
                self.z[place].to_bits() == f64::from(mode).to_bits(),
            )),
            Leaf::Load(slot, index) => {
                let at = usize::try_from(index.at(counter)).unwrap_or(usize::MAX);
                match slot {
                    Slot::Unknown => self.y[at],
                    Slot::Derivative => self.yp[at],
                    Slot::Memory => self.z[at],
                    Slot::Input => self.u[at],
                    Slot::Parameter => self.p[at],
                    Slot::Work => self.work[at],
                    Slot::Out => self.out[at],
                }
            }
        }
    }
}
