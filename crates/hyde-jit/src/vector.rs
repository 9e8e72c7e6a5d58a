//! Loops over two elements at a time.
//!
//! ```text
//! before:  what does not change with the counter, once
//! pairs:   two elements at a time in a 128-bit register
//! tail:    the last one of an odd number
//! ```
//! The code is the same for any number of elements. Steps that call functions, or read with a stride other than one,
//! run one element at a time instead.

use crate::host;
use crate::known::Known;
use crate::load;
use crate::lower::{At, Lowering};
use crate::routine::{Leaf, Slot, Step};
use crate::wanted::{Wanted, children, is_truth};
use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{self, InstBuilder, MemFlagsData, types};
use hyde_ir::{BinaryOp, Expr, ExprId, Range, UnaryOp};

/// Writes the loop of one or more steps over the same range.
pub(crate) fn lower_loop(lowering: &mut Lowering<'_, '_, '_>, steps: &[Step], range: Range) {
    let in_pairs = steps
        .iter()
        .all(|step| step.target.stride == 1 && may_pair(lowering, step.value));
    let invariants = invariants(lowering, steps);
    for &(id, wanted) in &invariants {
        lowering.emit(id, wanted, At::Fixed(range.first), &mut Known::default());
    }
    let len = i64::try_from(range.len()).unwrap_or(i64::MAX);
    let start = lowering.builder.ins().iconst(types::I64, 0);
    if !in_pairs {
        looped(lowering, start, 8, 8 * len, |lowering, bytes| {
            turn(lowering, steps, bytes, range.first)
        });
        return;
    }
    let splats = splats(lowering, &invariants);
    let exit = looped(lowering, start, 16, 8 * (len & !1), |lowering, bytes| {
        let mut pairs = splats.clone();
        for step in steps {
            let value = emit_pair(lowering, step.value, bytes, range.first, &mut pairs);
            let base = lowering.base(step.slot);
            let address = lowering.builder.ins().iadd(base, bytes);
            let offset = 8 * step.target.at(range.first);
            lowering.builder.ins().store(
                MemFlagsData::trusted().with_aligned(),
                value,
                address,
                offset,
            );
        }
    });
    // The tail, if the number is odd.
    let (tail, done) = (
        lowering.builder.create_block(),
        lowering.builder.create_block(),
    );
    let more = lowering
        .builder
        .ins()
        .icmp_imm_u(IntCC::UnsignedLessThan, exit, 8 * len);
    lowering.builder.ins().brif(more, tail, &[], done, &[]);
    lowering.builder.switch_to_block(tail);
    lowering.builder.seal_block(tail);
    turn(lowering, steps, exit, range.first);
    lowering.builder.ins().jump(done, &[]);
    lowering.builder.switch_to_block(done);
    lowering.builder.seal_block(done);
}

/// A loop from `start` while the bytes are below `limit`; it runs at least once. Returns the bytes at its end.
fn looped(
    lowering: &mut Lowering<'_, '_, '_>,
    start: ir::Value,
    by: i64,
    limit: i64,
    mut body: impl FnMut(&mut Lowering<'_, '_, '_>, ir::Value),
) -> ir::Value {
    let (head, exit) = (
        lowering.builder.create_block(),
        lowering.builder.create_block(),
    );
    let bytes = lowering.builder.append_block_param(head, types::I64);
    let end = lowering.builder.append_block_param(exit, types::I64);
    lowering.builder.ins().jump(head, &[start.into()]);
    lowering.builder.switch_to_block(head);
    body(lowering, bytes);
    let next = lowering.builder.ins().iadd_imm_s(bytes, by);
    let more = lowering
        .builder
        .ins()
        .icmp_imm_u(IntCC::UnsignedLessThan, next, limit);
    lowering
        .builder
        .ins()
        .brif(more, head, &[next.into()], exit, &[next.into()]);
    lowering.builder.seal_block(head);
    lowering.builder.switch_to_block(exit);
    lowering.builder.seal_block(exit);
    end
}

/// One element of each step.
fn turn(lowering: &mut Lowering<'_, '_, '_>, steps: &[Step], bytes: ir::Value, first: i32) {
    let mut local = Known::default();
    for step in steps {
        let value = lowering.emit(
            step.value,
            Wanted::Number,
            At::Loop { bytes, first },
            &mut local,
        );
        let base = lowering.base(step.slot);
        let along = match step.target.stride {
            1 => bytes,
            stride => lowering.builder.ins().imul_imm_s(bytes, i64::from(stride)),
        };
        let address = lowering.builder.ins().iadd(base, along);
        lowering.builder.ins().store(
            MemFlagsData::trusted(),
            value,
            address,
            8 * step.target.at(first),
        );
    }
}

/// Whether every operation that changes with the counter works on pairs.
fn may_pair(lowering: &Lowering<'_, '_, '_>, root: ExprId) -> bool {
    lowering
        .dae
        .exprs
        .below(&[root])
        .into_iter()
        .filter(|id| lowering.moving[id])
        .all(|id| {
            let expr = lowering.dae.exprs[id];
            match expr {
                Expr::Unary(op, _) => !matches!(host::unary(op), host::Unary::Call(_)),
                Expr::Binary(op, ..) => !matches!(host::binary(op), host::Binary::Call(_)),
                Expr::If(..) | Expr::NoEvent(_) => true,
                Expr::Const(_)
                | Expr::Time
                | Expr::Counter
                | Expr::Param(..)
                | Expr::Var(..)
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..) => match lowering.routine.leaf(lowering.dae, expr) {
                    Some(Leaf::Load(_, index)) => index.stride == 1,
                    _ => true,
                },
            }
        })
}

/// The largest parts that do not change with the counter, in the form they are wanted.
fn invariants(lowering: &Lowering<'_, '_, '_>, steps: &[Step]) -> Vec<(ExprId, Wanted)> {
    let mut found: Vec<(ExprId, Wanted)> = Vec::new();
    let mut seen: Vec<(ExprId, Wanted)> = Vec::new();
    let mut stack: Vec<(ExprId, Wanted)> = steps
        .iter()
        .map(|step| (step.value, Wanted::Number))
        .collect();
    while let Some(node) = stack.pop() {
        if seen.contains(&node) {
            continue;
        }
        seen.push(node);
        if lowering.moving[&node.0] {
            children(lowering.dae, node.0, node.1, |child, wanted| {
                stack.push((child, wanted))
            });
        } else {
            found.push(node);
        }
    }
    found
}

/// Invariants in both lanes.
fn splats(lowering: &mut Lowering<'_, '_, '_>, invariants: &[(ExprId, Wanted)]) -> Known {
    let mut known = Known::default();
    for &(id, wanted) in invariants {
        let value = lowering.emit(id, wanted, At::Fixed(0), &mut Known::default());
        let splat = match wanted {
            Wanted::Number => lowering.builder.ins().splat(types::F64X2, value),
            Wanted::Truth => {
                let mask = lowering.builder.ins().bmask(types::I64, value);
                lowering.builder.ins().splat(types::I64X2, mask)
            }
        };
        known.insert(id, wanted, splat);
    }
    known
}

/// The code of a node for two elements.
fn emit_pair(
    lowering: &mut Lowering<'_, '_, '_>,
    root: ExprId,
    bytes: ir::Value,
    first: i32,
    known: &mut Known,
) -> ir::Value {
    let mut stack = vec![(root, Wanted::Number, false)];
    while let Some((id, wanted, ready)) = stack.pop() {
        if known.get(id, wanted).is_some() {
            continue;
        }
        if !ready {
            stack.push((id, wanted, true));
            children(lowering.dae, id, wanted, |child, wanted| {
                stack.push((child, wanted, false))
            });
            continue;
        }
        let value = pair_node(lowering, id, wanted, bytes, first, known);
        known.insert(id, wanted, value);
    }
    known.get(root, Wanted::Number).unwrap_or(bytes)
}

fn pair_node(
    lowering: &mut Lowering<'_, '_, '_>,
    id: ExprId,
    wanted: Wanted,
    bytes: ir::Value,
    first: i32,
    known: &Known,
) -> ir::Value {
    let expr = lowering.dae.exprs[id];
    let get = |id: ExprId, wanted: Wanted| known.get(id, wanted).unwrap_or(bytes);
    match (expr, wanted) {
        (Expr::NoEvent(a), _) => get(a, wanted),
        (Expr::If(c, a, b), _) => choose(
            lowering,
            get(c, Wanted::Truth),
            get(a, wanted),
            get(b, wanted),
            wanted,
        ),
        _ if is_truth(expr) && wanted == Wanted::Number => {
            let (one, zero) = (constant(lowering, 1.0), constant(lowering, 0.0));
            choose(lowering, get(id, Wanted::Truth), one, zero, Wanted::Number)
        }
        _ if !is_truth(expr) && wanted == Wanted::Truth => {
            let zero = constant(lowering, 0.0);
            lowering
                .builder
                .ins()
                .fcmp(FloatCC::NotEqual, get(id, Wanted::Number), zero)
        }
        (Expr::Unary(op, a), _) => {
            let a = get(
                a,
                if op == UnaryOp::Not {
                    Wanted::Truth
                } else {
                    Wanted::Number
                },
            );
            match host::unary(op) {
                host::Unary::Neg => lowering.builder.ins().fneg(a),
                host::Unary::Abs => lowering.builder.ins().fabs(a),
                host::Unary::Sqrt => lowering.builder.ins().sqrt(a),
                host::Unary::Not => lowering.builder.ins().bnot(a),
                host::Unary::Call((name, _)) => unreachable!("`may_pair` let {name} through"),
            }
        }
        (Expr::Binary(op, a, b), _) => {
            let form = if matches!(op, BinaryOp::And | BinaryOp::Or) {
                Wanted::Truth
            } else {
                Wanted::Number
            };
            let (a, b) = (get(a, form), get(b, form));
            match host::binary(op) {
                host::Binary::Add => lowering.builder.ins().fadd(a, b),
                host::Binary::Sub => lowering.builder.ins().fsub(a, b),
                host::Binary::Mul => lowering.builder.ins().fmul(a, b),
                host::Binary::Div => lowering.builder.ins().fdiv(a, b),
                host::Binary::And => lowering.builder.ins().band(a, b),
                host::Binary::Or => lowering.builder.ins().bor(a, b),
                host::Binary::Pick(condition) => {
                    let second = lowering.builder.ins().fcmp(condition, b, a);
                    choose(lowering, second, b, a, Wanted::Number)
                }
                host::Binary::Compare(condition) => lowering.builder.ins().fcmp(condition, a, b),
                host::Binary::Call((name, _)) => unreachable!("`may_pair` let {name} through"),
            }
        }
        _ => pair_leaf(lowering, expr, bytes, first),
    }
}

fn pair_leaf(
    lowering: &mut Lowering<'_, '_, '_>,
    expr: Expr,
    bytes: ir::Value,
    first: i32,
) -> ir::Value {
    match lowering.routine.leaf(lowering.dae, expr) {
        Some(Leaf::Load(slot, index)) => {
            let base = lowering.base(slot);
            let address = lowering.builder.ins().iadd(base, bytes);
            // Two neighbours need not lie on a 16-byte boundary.
            let flags = unaligned(slot);
            lowering
                .builder
                .ins()
                .load(types::F64X2, flags, address, 8 * index.at(first))
        }
        Some(Leaf::Counter) => {
            let counter = lowering.counter(At::Loop { bytes, first });
            let one = lowering.builder.ins().f64const(1.0);
            let next = lowering.builder.ins().fadd(counter, one);
            let both = lowering.builder.ins().splat(types::F64X2, counter);
            lowering.builder.ins().insertlane(both, next, 1)
        }
        // Everything else does not change with the counter.
        Some(Leaf::Number(_) | Leaf::Time | Leaf::IsMode(..)) | None => {
            constant(lowering, f64::NAN)
        }
    }
}

fn constant(lowering: &mut Lowering<'_, '_, '_>, value: f64) -> ir::Value {
    let value = lowering.builder.ins().f64const(value);
    lowering.builder.ins().splat(types::F64X2, value)
}

/// `a` where the mask is set, else `b`.
fn choose(
    lowering: &mut Lowering<'_, '_, '_>,
    mask: ir::Value,
    a: ir::Value,
    b: ir::Value,
    wanted: Wanted,
) -> ir::Value {
    match wanted {
        Wanted::Truth => lowering.builder.ins().bitselect(mask, a, b),
        Wanted::Number => {
            let flags = MemFlagsData::new().with_endianness(ir::Endianness::Little);
            let mask = lowering.builder.ins().bitcast(types::F64X2, flags, mask);
            lowering.builder.ins().bitselect(mask, a, b)
        }
    }
}

fn unaligned(slot: Slot) -> MemFlagsData {
    let flags = MemFlagsData::new().with_notrap();
    if load::flags(slot).readonly() {
        flags.with_readonly().with_can_move()
    } else {
        flags
    }
}
