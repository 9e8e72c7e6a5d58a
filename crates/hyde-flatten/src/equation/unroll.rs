//! How many elements may have an equation each.

use crate::refusals::equations as refused;
use hyde_diag::{Diagnostics, Span};

/// Loops that cannot stay a range are unrolled up to this many turns.
const MAX_UNROLLED: usize = 10_000;

/// Whether so many elements are not too many to have an equation each; reported if they are.
pub(crate) fn can_unroll(diagnostics: &mut Diagnostics, turns: usize, span: Span) -> bool {
    if turns > MAX_UNROLLED {
        diagnostics.push(refused::long_loop(span, turns, MAX_UNROLLED));
    }
    turns <= MAX_UNROLLED
}
