//! Which equations bend: all others are linear as long as modes and relations stay, so they hold all along a linear flow.
//! And what the coefficients of the linear ones are made of, for those who keep a matrix of them.

use crate::routine::{Leaf, Routine, Slot};
use hyde_ir::dae::{Dae, Function, Wrt};
use hyde_ir::{BinaryOp, Expr, ExprId, Index, Range, UnaryOp, VarId};
use hyde_program::Coefficients;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// Rows of the residual that bend, rising: a derivative by an unknown or its rate is another elsewhere, or with another value
/// that events assign; or what is outside is read, which is time, record columns and delayed values.
pub(crate) fn bending_rows(dae: &Dae) -> Vec<usize> {
    let mut found = BTreeSet::new();
    let values = Values::new(dae);
    for partial in dae.partials(Function::Residual) {
        let by_outside = matches!(partial.wrt, Wrt::Time | Wrt::Delayed(_));
        if by_outside || values.reads(partial.value).anything() {
            add(&mut found, partial.range, partial.row);
        }
    }
    for (range, row, value) in hyde_analysis::rows(dae, Function::Residual) {
        if values.reads(value).outside {
            add(&mut found, range, row);
        }
    }
    found.into_iter().collect()
}

/// The coefficients of the unknowns and their rates in the residual.
pub(crate) fn coefficients(dae: &Dae) -> Coefficients {
    let mut curved = BTreeSet::new();
    let (mut modes, mut parameters) = (BTreeSet::new(), BTreeSet::new());
    let values = Values::new(dae);
    for partial in dae.partials(Function::Residual) {
        if !matches!(partial.wrt, Wrt::Unknown(_) | Wrt::Derivative(_)) {
            continue;
        }
        let reads = values.reads(partial.value);
        if reads.anything() {
            add(&mut curved, partial.range, partial.row);
        }
        modes.extend(reads.modes);
        let places = reads.parameters.into_iter();
        parameters.extend(places.flat_map(|index| at_all(partial.range, index)));
    }
    for (range, row, value) in hyde_analysis::rows(dae, Function::Residual) {
        if values.reads(value).jumps {
            add(&mut curved, range, row);
        }
    }
    Coefficients {
        curved: curved.into_iter().collect(),
        modes: modes.into_iter().collect(),
        parameters: parameters.into_iter().collect(),
    }
}

fn add(found: &mut BTreeSet<usize>, range: Range, index: Index) {
    found.extend(at_all(range, index));
}

/// The places of an index over a range.
fn at_all(range: Range, index: Index) -> Vec<usize> {
    let places = range
        .iter()
        .map(|counter| usize::try_from(index.at(counter)));
    places.filter_map(Result::ok).collect()
}

/// What a value reads, itself and through definitions. Modes and truths of relations are no values of the memory.
#[derive(Clone, Default)]
struct Reads {
    /// Time, record columns or delayed values.
    outside: bool,
    /// Unknowns or their rates.
    unknowns: bool,
    /// Values of the memory.
    memory: bool,
    /// A quantiser or a comparison of unknowns, which jumps where its derivative says nothing.
    jumps: bool,
    /// Positions in the memory of modes and truths.
    modes: BTreeSet<usize>,
    /// Parameters, by their positions over the range of the value; those of definitions are places.
    parameters: BTreeSet<Index>,
}

impl Reads {
    fn anything(&self) -> bool {
        self.outside || self.unknowns || self.memory
    }

    fn add(&mut self, other: &Self) {
        self.outside |= other.outside;
        self.unknowns |= other.unknowns;
        self.memory |= other.memory;
        self.jumps |= other.jumps;
        self.modes.extend(&other.modes);
        self.parameters.extend(&other.parameters);
    }
}

/// Definitions with what they read, each from those before it.
struct Values<'a> {
    dae: &'a Dae,
    routine: Routine,
    definitions: FxHashMap<VarId, Reads>,
}

impl<'a> Values<'a> {
    fn new(dae: &'a Dae) -> Self {
        let mut values = Self {
            dae,
            routine: Routine::plain("bending", Vec::new()),
            definitions: FxHashMap::default(),
        };
        for definition in &dae.definitions {
            let mut reads = values.reads(definition.value);
            let places = reads.parameters.iter();
            let places = places.flat_map(|&index| at_all(definition.range, index));
            let fixed = places.filter_map(|place| Some(Index::fixed(i32::try_from(place).ok()?)));
            reads.parameters = fixed.collect();
            let all = values.definitions.entry(definition.var).or_default();
            all.add(&reads);
        }
        values
    }

    fn reads(&self, value: ExprId) -> Reads {
        let mut found = Reads::default();
        for id in self.dae.exprs.below(&[value]) {
            let expr = self.dae.exprs[id];
            if let Expr::Var(var, _) = expr
                && let Some(reads) = self.definitions.get(&var)
            {
                found.add(reads);
            }
            match self.routine.leaf(self.dae, expr) {
                Some(Leaf::Time) => found.outside = true,
                Some(Leaf::IsMode(place, _)) => {
                    found.modes.insert(place);
                }
                Some(Leaf::Load(_, index)) if matches!(expr, Expr::Relation(_)) => {
                    found.modes.extend(usize::try_from(index.offset));
                }
                Some(Leaf::Load(slot, index)) => match slot {
                    Slot::Unknown | Slot::Derivative => found.unknowns = true,
                    Slot::Memory => found.memory = true,
                    Slot::Input => found.outside = true,
                    Slot::Parameter => {
                        found.parameters.insert(index);
                    }
                    Slot::Work | Slot::Out => {}
                },
                Some(Leaf::Number(_) | Leaf::Counter) => {}
                None => {
                    found.jumps |= jumps(expr) && self.reads_unknowns(expr);
                }
            }
        }
        found
    }

    fn reads_unknowns(&self, expr: Expr) -> bool {
        let mut found = false;
        expr.for_each_child(|child| found |= self.reads(child).unknowns);
        found
    }
}

/// Whether an operation jumps.
fn jumps(expr: Expr) -> bool {
    let binary =
        |op: BinaryOp| op.is_comparison() || matches!(op, BinaryOp::FloorTo | BinaryOp::RoundTo);
    matches!(expr, Expr::Unary(UnaryOp::Floor | UnaryOp::Ceil, _))
        || matches!(expr, Expr::Binary(op, ..) if binary(op))
}
