//! A routine as a Cranelift function.
//!
//! The function takes one pointer: to the frame, which holds the time and the addresses of the slots. Scalar steps become
//! straight-line code; what two of them share is computed once. A step over a range becomes a loop ([`crate::vector`]),
//! whose code does not depend on the number of elements; consecutive results over the same range share one loop, and
//! what does not change with the counter is computed before it.

use crate::host;
use crate::known::Known;
use crate::load;
use crate::parts::Parts;
use crate::routine::{Leaf, Routine, Slot, Step};
use crate::wanted::{Wanted, children, is_truth, moving, sines_with_cosines};
use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{self, InstBuilder, MemFlagsData, types};
use cranelift_codegen::isa::TargetFrontendConfig;
use cranelift_frontend::FunctionBuilder;
use hyde_ir::{BinaryOp, Dae, Expr, ExprId, Index, Range, UnaryOp};
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::{self, RangeInclusive};

/// Ranges shorter than this are written out.
const LOOP_FROM: usize = 8;

/// Makes a function of some parameters, which returns a number, known to the code that calls it.
pub(crate) type Import<'i> =
    &'i mut dyn FnMut(&mut ir::Function, &'static str, &[types::Type]) -> ir::FuncRef;

/// The code of a function while it is written.
pub(crate) struct Lowering<'a, 'f, 'i> {
    pub(crate) dae: &'a Dae,
    pub(crate) routine: &'a Routine,
    pub(crate) builder: FunctionBuilder<'f>,
    import: Import<'i>,
    frame: ir::Value,
    bases: [Option<ir::Value>; Slot::ALL.len()],
    /// Values and truths known in the whole rest of the function.
    known: Known,
    /// In a tick: the slots that each node reads as bits, and the nodes that read each slot.
    slots_read: FxHashMap<ExprId, u8>,
    reading: [Vec<ExprId>; Slot::ALL.len()],
    /// Scalar explicit variables by their place in the workspace.
    explicit: FxHashMap<i32, ir::Value>,
    /// The places of the workspace that loops read, which find them in memory.
    read_in_loops: Vec<RangeInclusive<i32>>,
    /// Whether each node changes with the counter.
    pub(crate) moving: FxHashMap<ExprId, bool>,
    /// Sines and cosines that one call computes, and where it writes the cosine.
    pairs: FxHashMap<ExprId, (ExprId, ExprId)>,
    of_cosine: Option<ir::StackSlot>,
    /// Which numbers are kept for the parts that follow, and those that are by now.
    parts: &'a Parts,
    kept: &'a mut FxHashSet<ExprId>,
    kept_base: Option<ir::Value>,
}

/// The counter where an expression is evaluated.
#[derive(Clone, Copy)]
pub(crate) enum At {
    /// A number.
    Fixed(i32),
    /// In a loop: eight times the turns so far, and the counter's first value.
    Loop { bytes: ir::Value, first: i32 },
}

/// Writes the code of a part of a routine into a function whose only argument is the frame. `kept` has the numbers that the
/// parts before have kept, and then those of this one.
pub(crate) fn lower<'a>(
    dae: &'a Dae,
    routine: &'a Routine,
    (parts, steps): (&'a Parts, ops::Range<usize>),
    kept: &'a mut FxHashSet<ExprId>,
    mut builder: FunctionBuilder<'_>,
    import: Import<'_>,
    config: TargetFrontendConfig,
) {
    let entry = builder.create_block();
    builder.append_block_params_for_function_params(entry);
    builder.switch_to_block(entry);
    builder.seal_block(entry);
    let frame = builder.block_params(entry)[0];
    let moving = moving(dae, routine, steps.clone());
    let mut lowering = Lowering {
        dae,
        routine,
        builder,
        import,
        frame,
        bases: [None; Slot::ALL.len()],
        known: Known::default(),
        slots_read: FxHashMap::default(),
        reading: Default::default(),
        explicit: FxHashMap::default(),
        read_in_loops: Vec::new(),
        pairs: sines_with_cosines(dae, moving.keys().copied()),
        of_cosine: None,
        moving,
        parts,
        kept,
        kept_base: None,
    };
    lowering.prepare(&routine.steps[steps.clone()]);
    let mut at = steps.start;
    while at < steps.end {
        let step = routine.steps[at];
        if step.range.len() < LOOP_FROM {
            step.range
                .iter()
                .for_each(|counter| lowering.scalar(&step, counter));
            at += 1;
            continue;
        }
        let mut end = at + 1;
        // Results over the same range do not depend on each other, except in a tick.
        while step.slot == Slot::Out && routine.tick.is_none() && end < steps.end {
            let next = routine.steps[end];
            if next.slot != Slot::Out || next.range != step.range {
                break;
            }
            end += 1;
        }
        crate::vector::lower_loop(&mut lowering, &routine.steps[at..end], step.range);
        at = end;
    }
    lowering.builder.ins().return_(&[]);
    lowering.builder.finalize(config);
}

impl Lowering<'_, '_, '_> {
    /// Loads the addresses of the slots that are used.
    fn prepare(&mut self, steps: &[Step]) {
        let in_parts = self.parts.steps.len() > 1;
        let mut used = [false; Slot::ALL.len()];
        for step in steps {
            used[step.slot as usize] |= step.slot == Slot::Out || step.range.len() > 1 || in_parts;
        }
        for step in steps.iter().filter(|step| step.range.len() > 1) {
            for id in self.dae.exprs.below(&[step.value]) {
                let leaf = self.routine.leaf(self.dae, self.dae.exprs[id]);
                if let Some(Leaf::Load(Slot::Work, index)) = leaf
                    && index.stride != 0
                {
                    let ends = [step.range.first, step.range.last].map(|counter| index.at(counter));
                    let places = ends[0].min(ends[1])..=ends[0].max(ends[1]);
                    self.read_in_loops.push(places);
                }
            }
        }
        let roots: Vec<ExprId> = steps.iter().map(|step| step.value).collect();
        for id in self.dae.exprs.below(&roots) {
            match self.routine.leaf(self.dae, self.dae.exprs[id]) {
                Some(Leaf::Load(slot, _)) => used[slot as usize] = true,
                Some(Leaf::IsMode(..)) => used[Slot::Memory as usize] = true,
                Some(Leaf::Counter | Leaf::Number(_) | Leaf::Time) | None => {}
            }
        }
        if in_parts {
            let flags = load::unwritten();
            let (frame, offset) = (self.frame, Parts::OFFSET);
            let base = self.builder.ins().load(types::I64, flags, frame, offset);
            self.kept_base = Some(base);
        }
        for slot in Slot::ALL {
            if used[slot as usize] {
                let offset = 8 * (1 + slot as i32);
                let flags = load::unwritten();
                let base = self
                    .builder
                    .ins()
                    .load(types::I64, flags, self.frame, offset);
                self.bases[slot as usize] = Some(base);
            }
        }
    }

    pub(crate) fn base(&self, slot: Slot) -> ir::Value {
        // Every slot a leaf or target names was loaded by `prepare`.
        self.bases[slot as usize].unwrap_or(self.frame)
    }

    /// A step at one value of its counter.
    fn scalar(&mut self, step: &Step, counter: i32) {
        let mut local = Known::default();
        let value = self.emit(step.value, Wanted::Number, At::Fixed(counter), &mut local);
        let element = step.target.at(counter);
        if step.slot == Slot::Work && step.range == Range::SCALAR {
            self.explicit.insert(element, value);
            // A part that follows reads it from memory, and so does a loop.
            let in_loop = self
                .read_in_loops
                .iter()
                .any(|places| places.contains(&element));
            if self.parts.steps.len() == 1 && !in_loop {
                return;
            }
        }
        self.store(step.slot, element, value);
        if self.routine.tick.is_some() {
            // Later assignments of the tick read what was just written.
            self.forget_loads(step.slot);
        }
    }

    fn forget_loads(&mut self, slot: Slot) {
        for id in std::mem::take(&mut self.reading[slot as usize]) {
            self.known.remove(id);
        }
    }

    /// Notes of which slots a node reads, itself or below, so that they can be forgotten.
    fn note_reads(&mut self, id: ExprId) {
        let mut slots = self.slots_of(id);
        self.dae.exprs[id].for_each_child(|child| {
            slots |= match self.slots_read.get(&child) {
                Some(known) => *known,
                None => {
                    let all = self.dae.exprs.below(&[child]).into_iter();
                    all.fold(0, |slots, inner| slots | self.slots_of(inner))
                }
            };
        });
        self.slots_read.insert(id, slots);
        for slot in Slot::ALL {
            if slots & (1 << slot as u8) != 0 {
                self.reading[slot as usize].push(id);
            }
        }
    }

    /// The slot that a node itself reads, as a bit.
    fn slots_of(&self, id: ExprId) -> u8 {
        match self.routine.leaf(self.dae, self.dae.exprs[id]) {
            Some(Leaf::Load(slot, _)) => 1 << slot as u8,
            Some(Leaf::Counter | Leaf::Number(_) | Leaf::Time | Leaf::IsMode(..)) | None => 0,
        }
    }

    /// Stores a number at a fixed element of a slot.
    fn store(&mut self, slot: Slot, element: i32, value: ir::Value) {
        let base = self.base(slot);
        self.builder
            .ins()
            .store(MemFlagsData::trusted(), value, base, 8 * element);
    }

    /// The code of a node and of all below it that is not known yet.
    pub(crate) fn emit(
        &mut self,
        root: ExprId,
        wanted: Wanted,
        at: At,
        local: &mut Known,
    ) -> ir::Value {
        let mut stack = vec![(root, wanted, false)];
        while let Some((id, wanted, ready)) = stack.pop() {
            if self.lookup(id, wanted, local).is_some() {
                continue;
            }
            if let Some(value) = self.kept(id, wanted) {
                self.known.insert(id, wanted, value);
                continue;
            }
            if !ready {
                stack.push((id, wanted, true));
                children(self.dae, id, wanted, |child, wanted| {
                    stack.push((child, wanted, false))
                });
                continue;
            }
            match self.pairs.get(&id) {
                Some(&(sine, cosine)) if wanted == Wanted::Number => {
                    let values = self.sine_and_cosine(sine, local);
                    self.learn(sine, wanted, values.0, local);
                    self.learn(cosine, wanted, values.1, local);
                }
                _ => {
                    let value = self.node(id, wanted, at, local);
                    self.learn(id, wanted, value, local);
                }
            }
        }
        match self.lookup(root, wanted, local) {
            Some(value) => value,
            None => self.builder.ins().f64const(f64::NAN),
        }
    }

    /// Takes note of the code of a node.
    fn learn(&mut self, id: ExprId, wanted: Wanted, value: ir::Value, local: &mut Known) {
        self.keep(id, wanted, value);
        if self.routine.tick.is_some() {
            self.note_reads(id);
        }
        let known = match self.moving[&id] {
            true => local,
            false => &mut self.known,
        };
        known.insert(id, wanted, value);
    }

    fn lookup(&self, id: ExprId, wanted: Wanted, local: &Known) -> Option<ir::Value> {
        local.get(id, wanted).or_else(|| self.known.get(id, wanted))
    }

    /// A number that an earlier part has kept.
    fn kept(&mut self, id: ExprId, wanted: Wanted) -> Option<ir::Value> {
        let (place, base) = (self.parts.kept.get(&id)?, self.kept_base?);
        if wanted == Wanted::Truth || !self.kept.contains(&id) {
            return None;
        }
        let flags = MemFlagsData::trusted();
        Some(self.builder.ins().load(types::F64, flags, base, 8 * place))
    }

    fn keep(&mut self, id: ExprId, wanted: Wanted, value: ir::Value) {
        if let (Wanted::Number, Some(place), Some(base)) =
            (wanted, self.parts.kept.get(&id), self.kept_base)
            && self.kept.insert(id)
        {
            let flags = MemFlagsData::trusted();
            self.builder.ins().store(flags, value, base, 8 * place);
        }
    }

    fn node(&mut self, id: ExprId, wanted: Wanted, at: At, local: &Known) -> ir::Value {
        let expr = self.dae.exprs[id];
        let get = |this: &Self, id: ExprId, wanted: Wanted| {
            this.lookup(id, wanted, local).unwrap_or(this.frame)
        };
        match (expr, wanted) {
            (Expr::NoEvent(a), _) => get(self, a, wanted),
            (Expr::If(c, a, b), _) => {
                let (c, a, b) = (
                    get(self, c, Wanted::Truth),
                    get(self, a, wanted),
                    get(self, b, wanted),
                );
                self.builder.ins().select(c, a, b)
            }
            _ if is_truth(expr) && wanted == Wanted::Number => {
                let truth = get(self, id, Wanted::Truth);
                let (one, zero) = (
                    self.builder.ins().f64const(1.0),
                    self.builder.ins().f64const(0.0),
                );
                self.builder.ins().select(truth, one, zero)
            }
            _ if !is_truth(expr) && wanted == Wanted::Truth => {
                let number = get(self, id, Wanted::Number);
                let zero = self.builder.ins().f64const(0.0);
                self.builder.ins().fcmp(FloatCC::NotEqual, number, zero)
            }
            (Expr::Unary(op, a), _) => {
                let form = if op == UnaryOp::Not {
                    Wanted::Truth
                } else {
                    Wanted::Number
                };
                let a = get(self, a, form);
                self.unary(op, a)
            }
            (Expr::Binary(op, a, b), _) => {
                let form = if matches!(op, BinaryOp::And | BinaryOp::Or) {
                    Wanted::Truth
                } else {
                    Wanted::Number
                };
                let (a, b) = (get(self, a, form), get(self, b, form));
                self.binary(op, a, b)
            }
            _ => self.leaf(expr, at),
        }
    }

    fn unary(&mut self, op: UnaryOp, a: ir::Value) -> ir::Value {
        match host::unary(op) {
            host::Unary::Neg => self.builder.ins().fneg(a),
            host::Unary::Abs => self.builder.ins().fabs(a),
            host::Unary::Sqrt => self.builder.ins().sqrt(a),
            host::Unary::Not => self.builder.ins().icmp_imm_u(IntCC::Equal, a, 0),
            host::Unary::Call((name, _)) => self.call(name, &[a]),
        }
    }

    fn binary(&mut self, op: BinaryOp, a: ir::Value, b: ir::Value) -> ir::Value {
        match host::binary(op) {
            host::Binary::Add => self.builder.ins().fadd(a, b),
            host::Binary::Sub => self.builder.ins().fsub(a, b),
            host::Binary::Mul => self.builder.ins().fmul(a, b),
            host::Binary::Div => self.builder.ins().fdiv(a, b),
            host::Binary::And => self.builder.ins().band(a, b),
            host::Binary::Or => self.builder.ins().bor(a, b),
            host::Binary::Pick(condition) => {
                let second = self.builder.ins().fcmp(condition, b, a);
                self.builder.ins().select(second, b, a)
            }
            host::Binary::Compare(condition) => self.builder.ins().fcmp(condition, a, b),
            host::Binary::Call((name, _)) => self.call(name, &[a, b]),
        }
    }

    /// The sine and the cosine of one argument, by one call.
    fn sine_and_cosine(&mut self, sine: ExprId, local: &Known) -> (ir::Value, ir::Value) {
        let mut argument = self.frame;
        self.dae.exprs[sine].for_each_child(|child| {
            argument = self
                .lookup(child, Wanted::Number, local)
                .unwrap_or(argument);
        });
        let slot = *self.of_cosine.get_or_insert_with(|| {
            let number = ir::StackSlotData::new(ir::StackSlotKind::ExplicitSlot, 8, 3);
            self.builder.create_sized_stack_slot(number)
        });
        let place = self.builder.ins().stack_addr(types::I64, slot, 0);
        let sine = self.call(host::SINE_AND_COSINE, &[argument, place]);
        (
            sine,
            self.builder
                .ins()
                .stack_load(types::I64, types::F64, slot, 0),
        )
    }

    fn call(&mut self, name: &'static str, args: &[ir::Value]) -> ir::Value {
        let types = args
            .iter()
            .map(|&arg| self.builder.func.dfg.value_type(arg));
        let types: Vec<types::Type> = types.collect();
        let function = (self.import)(self.builder.func, name, &types);
        let call = self.builder.ins().call(function, args);
        self.builder.inst_results(call)[0]
    }

    fn leaf(&mut self, expr: Expr, at: At) -> ir::Value {
        match self.routine.leaf(self.dae, expr) {
            Some(Leaf::Number(value)) => self.builder.ins().f64const(value),
            Some(Leaf::Time) => {
                let flags = load::unwritten();
                self.builder.ins().load(types::F64, flags, self.frame, 0)
            }
            Some(Leaf::Counter) => self.counter(at),
            Some(Leaf::IsMode(place, mode)) => {
                let value = self.load(
                    Slot::Memory,
                    Index::fixed(i32::try_from(place).unwrap_or(0)),
                    at,
                );
                let number = self.builder.ins().f64const(f64::from(mode));
                self.builder.ins().fcmp(FloatCC::Equal, value, number)
            }
            Some(Leaf::Load(slot, index)) => self.load(slot, index, at),
            None => self.builder.ins().f64const(f64::NAN),
        }
    }

    pub(crate) fn counter(&mut self, at: At) -> ir::Value {
        match at {
            At::Fixed(counter) => self.builder.ins().f64const(f64::from(counter)),
            At::Loop { bytes, first } => {
                let turns = self.builder.ins().ushr_imm_u(bytes, 3);
                let counter = self.builder.ins().iadd_imm_s(turns, i64::from(first));
                self.builder.ins().fcvt_from_sint(types::F64, counter)
            }
        }
    }

    fn load(&mut self, slot: Slot, index: Index, at: At) -> ir::Value {
        let (base, offset) = match (at, index.stride) {
            (At::Fixed(counter), _) => {
                let element = index.at(counter);
                if slot == Slot::Work
                    && let Some(&value) = self.explicit.get(&element)
                {
                    return value;
                }
                (self.base(slot), 8 * element)
            }
            (At::Loop { .. }, 0) => {
                if slot == Slot::Work
                    && let Some(&value) = self.explicit.get(&index.offset)
                {
                    return value;
                }
                (self.base(slot), 8 * index.offset)
            }
            (At::Loop { bytes, first }, stride) => {
                let along = match stride {
                    1 => bytes,
                    stride => self.builder.ins().imul_imm_s(bytes, i64::from(stride)),
                };
                let base = self.base(slot);
                (self.builder.ins().iadd(base, along), 8 * index.at(first))
            }
        };
        self.builder
            .ins()
            .load(types::F64, load::flags(slot), base, offset)
    }
}
