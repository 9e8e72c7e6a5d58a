//! Lookup tables: `table(x, {0, 1, 2} [m], {0, 1, 4} [N])` or `table(x, "grease.csv", "v", "F")` linear between its points,
//! `smooth_table` with a continuous derivative.
//!
//! Beyond its ends a table goes on along a straight line with the slope that it has there. The smooth one is the monotone
//! cubic of Fritsch and Carlson (SIAM J. Numer. Anal. 17 (1980) 238) with the slopes of Fritsch and Butland: it does not overshoot its points.
//! No events: a table is a measured curve, not a switch. Over the time it has one at each of its points: between two steps that
//! are both in a rest lies a whole pulse.

mod file;

use crate::dimension::Dim;
use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::calls as refused;
use hyde_diag::Span;
use hyde_ir::{BinaryOp, Expr as Ir, ExprArena, ExprId};
use hyde_syntax::ast::{Expr, ExprKind};

/// Numbers in SI with their dimension.
type Points = (Vec<f64>, Dim);

/// Points of a table over the time that are events, at most.
const MOST_EVENTS: usize = 1000;

impl<'a> Model<'a, '_> {
    pub(super) fn table(
        &mut self,
        name: &str,
        args: &[&'a Expr],
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let of_file = args
            .get(1)
            .is_some_and(|arg| matches!(arg.kind, ExprKind::String(_)));
        let points = if of_file {
            self.file_points(name, args, span)
        } else {
            self.exactly(name, args, span)
                .and_then(|[_, xs, ys]| self.list_points(xs, ys, scope, span))
        };
        let (Some(((xs, x_dim), (ys, y_dim))), Some(x)) = (points, args.first()) else {
            return self.poison(span);
        };
        let x = self.value(x, scope);
        let place = self.typed(x.id, x_dim, span);
        self.agree(
            &x,
            &place,
            "the argument and the places of the table are",
            scope.instance,
        );
        let pieces = match name {
            "table" => straight(&xs, &ys),
            _ => smooth(&xs, &ys),
        };
        let arena = &mut self.flat.exprs;
        let value = between(arena, x.id, &pieces);
        let id = match xs.len() <= MOST_EVENTS && is_of_time(arena, x.id) {
            true => value,
            false => arena.no_event(value),
        };
        self.typed(id, y_dim, span)
    }

    /// The points of two lists.
    fn list_points(
        &mut self,
        xs: &'a Expr,
        ys: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) -> Option<(Points, Points)> {
        let (xs, ys) = (self.points(xs, scope)?, self.points(ys, scope)?);
        if xs.0.len() != ys.0.len() || xs.0.len() < 2 {
            self.report(refused::points_of_table(xs.0.len(), ys.0.len(), span));
            return None;
        }
        if let Some(at) = xs.0.windows(2).position(|pair| pair[0] >= pair[1]) {
            self.report(refused::places_descend(xs.0[at], xs.0[at + 1], span));
            return None;
        }
        Some((xs, ys))
    }

    /// The numbers of a list, in SI, with their dimension.
    fn points(&mut self, list: &'a Expr, scope: &Scope<'a>) -> Option<Points> {
        let ExprKind::Array(items, unit) = &list.kind else {
            self.report(refused::table_of_no_lists(list.span));
            return None;
        };
        let inner = scope.with(Setting::Parameter);
        let mut numbers = Vec::new();
        let mut whole: Option<Typed> = None;
        for item in items {
            let errors = self.diagnostics.error_count();
            let own = self.value(item, &inner);
            let typed = self.in_unit(own, unit.as_ref());
            if self.diagnostics.error_count() > errors {
                return None;
            }
            numbers.push(self.constant_of(&typed)?);
            let what = "the numbers of a list are";
            whole = Some(self.agreeing(whole, typed, what, scope.instance));
        }
        let dim = whole.map_or(Dim::NUMBER, |typed| typed.dim);
        Some((numbers, dim))
    }
}

/// Whether an expression is made of the time, and of nothing else that changes during a run.
fn is_of_time(arena: &ExprArena, id: ExprId) -> bool {
    let moves = |leaf: Ir| {
        matches!(
            leaf,
            Ir::Var(..) | Ir::Der(..) | Ir::Pre(..) | Ir::Relation(_) | Ir::InMode(..)
        )
    };
    arena.any(id, |leaf| leaf == Ir::Time) && !arena.any(id, moves)
}

/// A polynomial of the distance from a place, in use from another place on: the first one of a curve also below it.
struct Piece {
    from: f64,
    origin: f64,
    value: f64,
    /// Of the distance, its square and its cube.
    factors: [f64; 3],
}

impl Piece {
    /// The straight line through a point.
    fn line(from: f64, (origin, value): (f64, f64), slope: f64) -> Self {
        Self {
            from,
            origin,
            value,
            factors: [slope, 0.0, 0.0],
        }
    }

    /// The cubic between two points with the slopes at them; a straight line where both are that of the chord.
    fn cubic(xs: &[f64], ys: &[f64], slopes: &[f64]) -> Self {
        let width = xs[1] - xs[0];
        let chord = (ys[1] - ys[0]) / width;
        let (first, second) = (slopes[0], slopes[1]);
        Self {
            from: xs[0],
            origin: xs[0],
            value: ys[0],
            factors: [
                first,
                (3.0 * chord - 2.0 * first - second) / width,
                (first + second - 2.0 * chord) / (width * width),
            ],
        }
    }

    /// `y + d*(m + d*(b + d*a))` with d the distance from the place.
    fn at(&self, arena: &mut ExprArena, x: ExprId) -> ExprId {
        let origin = arena.constant(self.origin);
        let distance = arena.minus(x, origin);
        let mut sum = arena.constant(self.value);
        let mut power = distance;
        for factor in self.factors {
            if factor != 0.0 {
                let factor = arena.constant(factor);
                let term = arena.times(factor, power);
                sum = arena.plus(sum, term);
            }
            power = arena.times(power, distance);
        }
        sum
    }
}

/// The curve of pieces: the halves on both sides of the middle place, down to one piece.
fn between(arena: &mut ExprArena, x: ExprId, pieces: &[Piece]) -> ExprId {
    if let [piece] = pieces {
        return piece.at(arena, x);
    }
    let (left, right) = pieces.split_at(pieces.len().div_ceil(2));
    let limit = arena.constant(right[0].from);
    let (left, right) = (between(arena, x, left), between(arena, x, right));
    let below = arena.binary(BinaryOp::Lt, x, limit);
    arena.if_else(below, left, right)
}

/// The straight lines between the points.
fn straight(xs: &[f64], ys: &[f64]) -> Vec<Piece> {
    let points = xs.windows(2).zip(ys.windows(2));
    points
        .map(|(x, y)| Piece::line(x[0], (x[0], y[0]), (y[1] - y[0]) / (x[1] - x[0])))
        .collect()
}

/// The cubics between the points, and beyond the ends the straight lines that touch them there.
fn smooth(xs: &[f64], ys: &[f64]) -> Vec<Piece> {
    let slopes = slopes(xs, ys);
    let end = xs.len() - 1;
    let mut pieces: Vec<Piece> = (0..end)
        .map(|k| Piece::cubic(&xs[k..=k + 1], &ys[k..=k + 1], &slopes[k..=k + 1]))
        .collect();
    // The only cubic through two points is a straight line.
    if end > 1 {
        let first = Piece::line(f64::NEG_INFINITY, (xs[0], ys[0]), slopes[0]);
        pieces.insert(0, first);
        pieces.push(Piece::line(xs[end], (xs[end], ys[end]), slopes[end]));
    }
    pieces
}

/// Slopes at the points: a weighted harmonic mean of the neighbouring chords, zero at an extremum, the chord at the ends.
fn slopes(xs: &[f64], ys: &[f64]) -> Vec<f64> {
    let chords: Vec<f64> = xs
        .windows(2)
        .zip(ys.windows(2))
        .map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0]))
        .collect();
    let mut found = vec![chords[0]];
    for k in 1..chords.len() {
        let (a, b) = (chords[k - 1], chords[k]);
        let (before, after) = (xs[k] - xs[k - 1], xs[k + 1] - xs[k]);
        let (w1, w2) = (2.0 * after + before, after + 2.0 * before);
        found.push(if a * b <= 0.0 {
            0.0
        } else {
            (w1 + w2) / (w1 / a + w2 / b)
        });
    }
    found.push(chords[chords.len() - 1]);
    found
}
