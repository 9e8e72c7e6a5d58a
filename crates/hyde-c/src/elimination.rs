//! [`Elimination`]: the order in which the equations of a step are eliminated, so that few numbers become other than zero.
//!
//! The order is that of Markowitz on the structure alone: the pivot whose row and column have the fewest other numbers is next.
//! The step itself exchanges rows where a pivot of this order is too small.

use hyde_program::{Function, Program, Wrt};
use std::collections::BTreeSet;

/// An order of equations and unknowns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Elimination {
    /// The equations in their order.
    pub(crate) equations: Vec<usize>,
    /// The unknown that each of them is solved for.
    pub(crate) unknowns: Vec<usize>,
}

impl Elimination {
    /// The order for the equations of a program.
    pub(crate) fn of(program: &Program) -> Self {
        let n = program.n_unknowns;
        let mut rows = vec![BTreeSet::new(); n];
        for entry in program.partials(Function::Residual) {
            if let Wrt::Unknown(column) | Wrt::Derivative(column) = entry.wrt {
                rows[entry.row].insert(column);
            }
        }
        Self::of_rows(rows)
    }

    /// The order for rows of a square matrix, each with the columns of its numbers.
    fn of_rows(mut rows: Vec<BTreeSet<usize>>) -> Self {
        let n = rows.len();
        let mut columns = vec![BTreeSet::new(); n];
        for (row, own) in rows.iter().enumerate() {
            for &column in own {
                columns[column].insert(row);
            }
        }
        let mut found = Self {
            equations: Vec::with_capacity(n),
            unknowns: Vec::with_capacity(n),
        };
        while found.equations.len() < n {
            let all = rows.iter().enumerate();
            let all = all.flat_map(|(row, own)| own.iter().map(move |&column| (row, column)));
            let cost = |&(row, column): &(usize, usize)| {
                (rows[row].len() - 1) * (columns[column].len() - 1)
            };
            let Some((row, column)) = all.min_by_key(cost) else {
                break;
            };
            found.equations.push(row);
            found.unknowns.push(column);
            let own = std::mem::take(&mut rows[row]);
            for &other in &own {
                columns[other].remove(&row);
            }
            for below in std::mem::take(&mut columns[column]) {
                rows[below].remove(&column);
                for &other in own.iter().filter(|other| **other != column) {
                    rows[below].insert(other);
                    columns[other].insert(below);
                }
            }
        }
        // What no pivot is left for is singular, which the step finds.
        found.equations.extend(rest(&found.equations, n));
        found.unknowns.extend(rest(&found.unknowns, n));
        found
    }
}

/// The numbers below `n` that are not in a list.
fn rest(list: &[usize], n: usize) -> Vec<usize> {
    let known: BTreeSet<usize> = list.iter().copied().collect();
    (0..n).filter(|number| !known.contains(number)).collect()
}

/// The place of each number in a list of all of them.
pub(crate) fn places(list: &[usize]) -> Vec<usize> {
    let mut found = vec![0; list.len()];
    for (place, &number) in list.iter().enumerate() {
        found[number] = place;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arrow_is_eliminated_from_its_thin_end() {
        // The first row and column are full: eliminated first, they would fill the matrix.
        let mut rows = vec![(0..6).collect::<BTreeSet<usize>>()];
        rows.extend((1..6).map(|k| BTreeSet::from([0, k])));
        let order = Elimination::of_rows(rows);
        assert_eq!(order.equations[..4], order.unknowns[..4]);
        assert!(!order.equations[..4].contains(&0), "{order:?}");
        let mut all = order.unknowns.clone();
        all.sort_unstable();
        assert_eq!(all, (0..6).collect::<Vec<usize>>());
        let places = places(&order.equations);
        assert!(
            order
                .equations
                .iter()
                .enumerate()
                .all(|(k, &row)| places[row] == k)
        );
    }

    #[test]
    fn a_singular_structure_still_has_every_number_once() {
        let order = Elimination::of_rows(vec![BTreeSet::from([0]), BTreeSet::new()]);
        assert_eq!(order.equations, [0, 1]);
        assert_eq!(order.unknowns, [0, 1]);
    }
}
