//! [`Factors`]: the factors of a step's matrix in the fixed order of its [`Elimination`], as straight lines of C.
//!
//! One pattern serves all modes. The numbers of the factors lie row by row: those below the diagonal, by which the rows of
//! earlier pivots are multiplied; the inverse of the pivot; those above the diagonal.

use crate::elimination::{Elimination, column_of, differential, places};
use hyde_program::{Function, Program};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// The pattern of the factors.
pub(crate) struct Factors {
    rows: Vec<Row>,
    /// How many numbers there are.
    pub(crate) count: usize,
}

/// A row of the factors; numbers by their columns.
struct Row {
    equation: usize,
    unknown: usize,
    /// The name of the unknown, and whether it is a state, whose rate is solved for.
    name: String,
    state: bool,
    /// What the matrix has there: by rates and algebraic unknowns, and by states, as numbers of partial derivatives.
    terms: BTreeMap<usize, [Vec<usize>; 2]>,
    /// Where the number of a column is.
    place: BTreeMap<usize, usize>,
}

impl Factors {
    pub(crate) fn of(program: &Program, order: &Elimination) -> Self {
        let [row_at, column_at] = [places(&order.equations), places(&order.unknowns)];
        let differential = differential(program);
        let each = order.equations.iter().zip(&order.unknowns);
        let mut rows: Vec<Row> = each
            .map(|(&equation, &unknown)| Row {
                equation,
                unknown,
                name: program.unknown_name(unknown),
                state: differential[unknown],
                terms: BTreeMap::new(),
                place: BTreeMap::new(),
            })
            .collect();
        for (number, entry) in program.partials(Function::Residual).iter().enumerate() {
            let Some((column, by_state)) = column_of(entry, &differential) else {
                continue;
            };
            let terms = rows[row_at[entry.row]].terms.entry(column_at[column]);
            terms.or_default()[usize::from(by_state)].push(number);
        }
        let mut count = 0;
        for k in 0..rows.len() {
            let mut columns: BTreeSet<usize> = rows[k].terms.keys().copied().collect();
            columns.insert(k);
            let mut next = columns.first().copied();
            while let Some(earlier) = next.filter(|&column| column < k) {
                columns.extend(rows[earlier].above(earlier).map(|(column, _)| column));
                next = columns.range(earlier + 1..).next().copied();
            }
            rows[k].place = columns.into_iter().zip(count..).collect();
            count += rows[k].place.len();
        }
        Self { rows, count }
    }

    /// `hy_eliminate` and `hy_substitute_in_order`.
    pub(crate) fn text(&self) -> String {
        let mut text = String::from(ELIMINATE);
        for (k, row) in self.rows.iter().enumerate() {
            self.eliminate(&mut text, k, row);
        }
        text.push_str("    return 1;\n}\n\n");
        text.push_str(SUBSTITUTE);
        for (k, row) in self.rows.iter().enumerate() {
            let _ = write!(text, "    const double c{k} = b[{}]", row.equation);
            for (column, place) in row.below(k) {
                let _ = write!(text, " - f[{place}] * c{column}");
            }
            text.push_str(";\n");
        }
        for (k, row) in self.rows.iter().enumerate().rev() {
            let mut value = format!("c{k}");
            for (column, place) in row.above(k) {
                let _ = write!(value, " - f[{place}] * x{column}");
            }
            if row.above(k).next().is_some() {
                value = format!("({value})");
            }
            let _ = writeln!(
                text,
                "    const double x{k} = {value} * f[{}];",
                row.place[&k]
            );
        }
        for (k, row) in self.rows.iter().enumerate() {
            let _ = writeln!(text, "    b[{}] = x{k};", row.unknown);
        }
        text.push_str("    (void)f;\n    (void)b;\n}\n\n");
        text
    }

    fn eliminate(&self, text: &mut String, k: usize, row: &Row) {
        let _ = writeln!(
            text,
            "    /* Equation {} for `{}`{}. */",
            row.equation,
            row.name,
            if row.state { ", its rate" } else { "" }
        );
        for (column, place) in &row.place {
            let terms = row.terms.get(column).into_iter();
            let terms = terms.flat_map(|[once, by_step]| {
                let once = once.iter().map(|number| format!("v[{number}]"));
                once.chain(by_step.iter().map(|number| format!("h * v[{number}]")))
            });
            let terms: Vec<String> = terms.collect();
            let sum = match terms.is_empty() {
                true => "0.0".to_owned(),
                false => terms.join(" + "),
            };
            let _ = writeln!(text, "    f[{place}] = {sum};");
        }
        let sizes = row.terms.keys();
        let sizes = sizes.map(|column| format!("fabs(f[{}])", row.place[column]));
        let most = sizes.reduce(|most, size| format!("hy_largest({most}, {size})"));
        let most = most.unwrap_or_else(|| "0.0".to_owned());
        let _ = writeln!(text, "    const double most{k} = {most};");
        let mut sizes = Vec::new();
        for (column, factor) in row.below(k) {
            let pivot = &self.rows[column];
            let _ = writeln!(text, "    f[{factor}] *= f[{}];", pivot.place[&column]);
            for (other, place) in pivot.above(column) {
                let target = row.place[&other];
                let _ = writeln!(text, "    f[{target}] -= f[{factor}] * f[{place}];");
            }
            sizes.push(format!("fabs(f[{factor}]) * most{column}"));
        }
        let pivot = row.place[&k];
        let _ = writeln!(text, "    f[{pivot}] = 1.0 / f[{pivot}];");
        let mut well = format!("fabs(f[{pivot}]) * most{k} < HY_SINGULAR");
        if !sizes.is_empty() {
            well = format!("{} <= HY_FACTOR * most{k} && {well}", sizes.join(" + "));
        }
        let _ = writeln!(text, "    if (!({well})) {{\n        return 0;\n    }}");
    }
}

impl Row {
    /// Columns and places below the diagonal, in row `k`.
    fn below(&self, k: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let own = self.place.range(..k);
        own.map(|(column, place)| (*column, *place))
    }

    /// Columns and places above the diagonal, in row `k`.
    fn above(&self, k: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let own = self.place.range(k + 1..);
        own.map(|(column, place)| (*column, *place))
    }
}

const ELIMINATE: &str = "\
/* ---- Linear equations: factors in a fixed order ---------------------------------------------------------------- */

/* The fixed order serves as long as the multiples of rows that are subtracted are at most this, and no pivot is smaller than the
   inverse of the second; both of rows whose largest number is 1. */
#define HY_FACTOR 100.0
#define HY_SINGULAR 1e12

static double hy_largest(double a, double b)
{
    return b > a ? b : a;
}

/* The matrix of Newton's method, by rates of states and by the other unknowns, as triangular factors: from the partial derivatives `v`
   and the step `h`. The order of elimination was chosen when this was written, such that few numbers are other than zero and pivots are
   large in all modes. The numbers `f` are, row by row, the multiples of earlier rows that are subtracted, the inverse of the pivot,
   and what is to the right of it. Gives 0 where the order does not serve. */
static int hy_eliminate(const double *v, double h, double *f)
{
    (void)v;
    (void)h;
    (void)f;
";

const SUBSTITUTE: &str = "\
/* Replaces the right side `b`, by equations, by the solution, by unknowns: first downwards, then upwards. */
static void hy_substitute_in_order(const double *f, double *b)
{
";
