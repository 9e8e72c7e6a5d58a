//! What the columns that drive a model are not known to, and what that makes of its states.
//!
//! ```text
//! declared                        stimulus i = file.i ~ 15 [mA];
//! quantised                       q/sqrt(12), q the least step of the column
//! linear between rows             a twelfth of its usual second difference: the mean of a parabola over its chord
//! ticking several times a row     what it is off by between rows, as the innovations show it
//! ```
//! A value that is off by e throughout a row moves the states by `first B e`. Errors of neighbouring rows are taken for
//! independent. Those of a command that its record does not have all of are not: they go with the motion. So they are given
//! a variance by which all of them together, in whatever pattern, are worth less than the least effect that counts.

use super::gain::Observer;
use super::over_record;
use crate::plant::{Configuration, Places, Unsupported};
use crate::records::Recording;
use hyde_program::{Column, Function, Point, Program, Workspace};
use hyde_signal::statistics::median;
use nalgebra::{DMatrix, DVector};

/// An effect counts if it improves the sum of squares of innovations that were not fitted by this part of their number.
pub(crate) const MATERIAL: f64 = 0.002;

/// The median of the size of a normal number, in standard deviations.
const MEDIAN: f64 = 0.6745;

/// Standard deviation of each driving column, SI, of all records together, but for what ticks between rows; 0 of those that
/// nothing continuous reads.
pub(crate) fn deviations(program: &Program, recordings: &[Recording]) -> Vec<f64> {
    let each = program.columns.iter().enumerate();
    each.map(|(number, column)| {
        let lists = recordings.iter().map(|own| own.columns[number].as_slice());
        deviation(column, &lists.collect::<Vec<_>>())
    })
    .collect()
}

fn deviation(column: &Column, lists: &[&[f64]]) -> f64 {
    if !column.continuous {
        return 0.0;
    }
    let (between, step) = match column.stepped {
        true => (0.0, 0.0),
        false => (usual_difference(lists, 2) / 12.0, least_step(lists)),
    };
    (column.noise.powi(2) + between * between + step * step / 12.0).sqrt()
}

/// Standard deviation of each driving column that changes between rows, as innovations show it; 0 of all others. `moves` is
/// what a unit of each does to the channels in a row.
pub(crate) fn between_rows(
    program: &Program,
    recordings: &[Recording],
    set: &[(usize, f64)],
    observer: &Observer,
    moves: &DMatrix<f64>,
) -> Result<Vec<f64>, Unsupported> {
    let mut found = vec![0.0; program.columns.len()];
    for (number, column) in program.columns.iter().enumerate() {
        let own = moves.column(number);
        let weights = own.iter().zip(&observer.noise);
        let weights = DVector::from_iterator(own.len(), weights.map(|(m, sd)| m / (sd * sd)));
        let known = weights.dot(&own);
        if column.ticks_s.is_none() || known <= 0.0 {
            continue;
        }
        let (mut squares, mut rows) = (0.0, 0.0);
        for recording in recordings {
            let (mut plant, observer) = observer.on(program, recording, set)?;
            over_record::run(&mut plant, &observer, |_, row, error| {
                let off = weights.iter().zip(error).map(|(w, e)| w * e).sum::<f64>() / known;
                if row >= recording.first_row && off.is_finite() {
                    squares += off * off;
                    rows += 1.0;
                }
            });
        }
        let own = (squares / f64::max(rows, 1.0) - 1.0 / known).max(0.0);
        found[number] = (own / (MATERIAL * moves.nrows() as f64)).sqrt();
    }
    Ok(found)
}

/// The size of the differences of an order, as a standard deviation; what happens rarely does not count.
fn usual_difference(lists: &[&[f64]], order: usize) -> f64 {
    let mut sizes = Vec::new();
    for list in lists {
        let mut differences = list.to_vec();
        for _ in 0..order {
            differences = differences
                .windows(2)
                .map(|pair| pair[1] - pair[0])
                .collect();
        }
        sizes.extend(
            differences
                .into_iter()
                .map(f64::abs)
                .filter(|d| d.is_finite()),
        );
    }
    median(&sizes).unwrap_or(0.0) / MEDIAN
}

/// The least difference of two values; 0 if there is one value only.
fn least_step(lists: &[&[f64]]) -> f64 {
    let mut values: Vec<f64> = lists.iter().flat_map(|list| list.iter().copied()).collect();
    values.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return 0.0;
    };
    let rounding = 1e-9 * (last - first);
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let least = steps
        .filter(|step| *step > rounding)
        .fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// What a unit of each driving column, read linearly and held, makes of the rates of the states at a point.
pub(crate) fn rates(
    program: &Program,
    places: &Places,
    configuration: &Configuration<'_>,
    at: Point<'_>,
    workspace: &mut Workspace,
) -> [DMatrix<f64>; 2] {
    let mut residual = |u: &[f64]| {
        let mut out = vec![0.0; program.n_unknowns];
        let at = Point { u, ..at };
        program
            .kernels
            .evaluate(Function::Residual, at, workspace, &mut out);
        out
    };
    let plain = residual(at.u);
    let mut of = |first: usize| {
        let mut all = DMatrix::zeros(program.n_unknowns, program.columns.len());
        for number in 0..program.columns.len() {
            let mut u = at.u.to_vec();
            u[2 * number + first] += 1.0;
            let moved = residual(&u);
            let differences = moved.iter().zip(&plain).map(|(a, b)| b - a);
            all.column_mut(number)
                .iter_mut()
                .zip(differences)
                .for_each(|(into, d)| *into = d);
        }
        (&configuration.inverse * all).select_rows(&places.states)
    };
    [of(0), of(1)]
}

/// What a unit of each driving column, off throughout a row, makes of the states.
pub(crate) fn moved(
    program: &Program,
    places: &Places,
    configuration: &Configuration<'_>,
    at: Point<'_>,
    workspace: &mut Workspace,
) -> DMatrix<f64> {
    let [linear, held] = rates(program, places, configuration, at, workspace);
    &configuration.steps[0].first * (linear + held)
}

/// The covariance that errors of the driving columns add to the states in a row.
pub(crate) fn covariance(moved: &DMatrix<f64>, deviations: &[f64]) -> DMatrix<f64> {
    let deviations = DVector::from_column_slice(deviations);
    let spread = moved * DMatrix::from_diagonal(&deviations);
    &spread * spread.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(stepped: bool, noise: f64) -> Column {
        Column {
            record: "file".to_owned(),
            column: "i".to_owned(),
            next: false,
            continuous: true,
            stepped,
            noise,
            ticks_s: None,
            drives: None,
        }
    }

    #[test]
    fn a_straight_line_has_the_error_of_its_steps_alone() {
        let list: Vec<f64> = (0..500).map(|k| 0.01 * f64::from(k)).collect();
        let found = deviation(&column(false, 0.0), &[&list]);
        assert!((found - 0.01 / 12.0_f64.sqrt()).abs() < 1e-9, "{found}");
        // What is held is known, but for what is said of it.
        assert!(deviation(&column(true, 0.0), &[&list]) < 1e-12);
        assert!((deviation(&column(true, 0.3), &[&list]) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn a_parabola_is_a_twelfth_of_its_second_difference_off_its_chords() {
        // The mean of x(1 - x)*h/2 over 0 .. 1, h the second difference.
        let list: Vec<f64> = (0..500).map(|k| 1e-3 * f64::from(k * k)).collect();
        let found = usual_difference(&[&list], 2) * MEDIAN / 12.0;
        assert!((found - 2e-3 / 12.0).abs() < 1e-9, "{found}");
    }
}
