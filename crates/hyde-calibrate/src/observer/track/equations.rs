//! [`Equations`] of the unknowns that an effect brings, told from those of the axis by the derivatives, along a track:
//!
//! ```text
//! Jx x + Jv v + b(axis) = 0      v: the rates of its states x, and its algebraic variables
//! x' = A x + g(axis)
//! ```
//! They are looked at wherever modes are new and now and then, with the own unknowns at 0 and elsewhere.

use super::counterparts::Counterparts;
use super::vectors::Vectors;
use super::{Passed, Track};
use crate::linear::steps;
use crate::observer::over_record::When;
use crate::plant::{Places, arranged, partials, v_column, x_column};
use hyde_program::{Function, PartialEntry, Point, Program, SomeRows, Workspace, Wrt};
use nalgebra::DMatrix;
use std::collections::BTreeSet;

/// Rows looked at beside one of each combination of modes.
const LOOKS: usize = 8;

/// The equations of what is brought.
pub(super) struct Equations<'p> {
    /// Positions of its unknowns: so many states, and below them algebraic variables.
    pub(super) own: Vec<usize>,
    pub(super) states: usize,
    /// Positions of the states of the axis.
    pub(super) of_axis: Vec<usize>,
    /// Its equations, by number, and their residuals.
    pub(super) rows: Vec<usize>,
    pub(super) residual: Box<dyn SomeRows + 'p>,
    /// What v changes by with a unit of the residuals.
    pub(super) by_residual: DMatrix<f64>,
    pub(super) flow: Flow,
}

/// What time does to the states.
pub(super) enum Flow {
    /// A is constant.
    Constant {
        /// States of the axis whose part of g is linear.
        drivers: Vec<usize>,
        /// What a row's time makes of the states, by: those before it, their rates there, the rates of the drivers there and
        /// at its end, by how much the drivers change, and g at the end.
        over: DMatrix<f64>,
    },
    /// A is diagonal: the states do not act on each other.
    Diagonal {
        /// Whether each acts linearly on itself.
        linear: bool,
    },
}

impl<'p> Equations<'p> {
    /// `None` where Jv is not constant, where states that are not linear act on each other, or where what is brought acts on
    /// the axis.
    pub(super) fn new(
        track: &Track<'_>,
        program: &'p Program,
        counterparts: &Counterparts,
        places: &Places,
        p: &[f64],
    ) -> Option<Self> {
        let mut is_own = vec![true; program.n_unknowns];
        for &position in &counterparts.positions {
            is_own[position] = false;
        }
        let chosen = |list: &[usize], wanted: bool| -> Vec<usize> {
            let list = list.iter().copied();
            list.filter(|&place| is_own[place] == wanted).collect()
        };
        let own_states = chosen(&places.states, true);
        let own = [own_states.as_slice(), &chosen(&places.algebraics, true)].concat();
        let derivatives = Derivatives::new(track, program, counterparts, &own, p)?;
        let (mut constant, mut linear) = (true, true);
        let (mut drivers, mut uneven) = (BTreeSet::new(), BTreeSet::new());
        for (number, entry) in derivatives.entries.iter().enumerate() {
            let (true, Some(place)) = (derivatives.rows.contains(&entry.row), unknown(entry))
            else {
                continue;
            };
            let same = derivatives.is_same(number);
            let of_v = v_column(places, entry.wrt).is_some();
            if !is_own[place] {
                let list = if same { &mut drivers } else { &mut uneven };
                if !of_v {
                    list.insert(place);
                }
            } else if of_v && !(same && derivatives.is_linear(number)) {
                return None;
            } else {
                constant &= same;
                linear &= derivatives.is_linear(number);
            }
        }
        let drivers: Vec<usize> = drivers.difference(&uneven).copied().collect();
        let looks = &derivatives.looks;
        let of_own = |matrix: DMatrix<f64>, columns: &[usize]| {
            matrix
                .select_rows(&derivatives.rows)
                .select_columns(columns)
        };
        let by_x = |look: &[f64]| arranged(program, look, |wrt| x_column(places, wrt));
        let by_v = arranged(program, &looks[0][0], |wrt| v_column(places, wrt));
        let by_residual: DMatrix<f64> = -of_own(by_v, &own).try_inverse()?;
        let states = own_states.len();
        let rates = by_residual.rows(0, states);
        let a = |look: &[f64]| rates * of_own(by_x(look), &own_states);
        let flow = if constant && linear {
            let by_drivers = rates * of_own(by_x(&looks[0][0]), &drivers);
            Flow::Constant {
                over: over(&a(&looks[0][0]), &by_drivers, track.route.step_s),
                drivers,
            }
        } else if looks.iter().flatten().all(|look| is_diagonal(&a(look))) {
            Flow::Diagonal { linear }
        } else {
            return None;
        };
        Some(Self {
            of_axis: chosen(&places.states, false),
            residual: program
                .kernels
                .some_rows(Function::Residual, &derivatives.rows),
            rows: derivatives.rows,
            own,
            states,
            by_residual,
            flow,
        })
    }
}

/// Derivatives of the residual along a track.
struct Derivatives<'p> {
    entries: &'p [PartialEntry],
    /// At each place with the own unknowns at 0, and elsewhere.
    looks: Vec<[Vec<f64>; 2]>,
    /// The equations of what is brought.
    rows: Vec<usize>,
}

impl<'p> Derivatives<'p> {
    fn new(
        track: &Track<'_>,
        program: &'p Program,
        counterparts: &Counterparts,
        own: &[usize],
        p: &[f64],
    ) -> Option<Self> {
        let n = program.n_unknowns;
        let mut workspace = Workspace::new(program.n_work);
        let mut look = |row: usize| {
            [0.0, 1.0].map(|size| {
                let at = track.route.point(row, When::After, p);
                let mut there = Vectors::default();
                there.reach(n);
                counterparts.put(at, &mut there);
                for (number, &place) in own.iter().enumerate() {
                    // Any numbers without relation to each other.
                    let part = |shift: f64| size * (12.9898 * number as f64 + shift).sin();
                    (there.y[place], there.yp[place]) = (part(1.0), part(2.0));
                }
                let (y, yp) = (&there.y, &there.yp);
                partials(program, Point { y, yp, ..at }, &mut workspace)
            })
        };
        let looks: Vec<[Vec<f64>; 2]> = samples(track).into_iter().map(&mut look).collect();
        let entries = program.partials(Function::Residual);
        // Its equations are those in which something of its own acts: as many as it has unknowns, for it acts nowhere else.
        let mut rows = BTreeSet::new();
        for values in looks.iter().flatten() {
            for (entry, &value) in entries.iter().zip(values) {
                if value != 0.0 && unknown(entry).is_some_and(|place| own.contains(&place)) {
                    rows.insert(entry.row);
                }
            }
        }
        (rows.len() == own.len()).then(|| Self {
            entries,
            looks,
            rows: rows.into_iter().collect(),
        })
    }

    /// Whether a derivative is the same wherever the axis has been.
    fn is_same(&self, number: usize) -> bool {
        let first = self.looks[0][0][number].to_bits();
        let mut looks = self.looks.iter();
        looks.all(|[here, _]| here[number].to_bits() == first)
    }

    /// Whether a derivative is the same whatever the own unknowns are.
    fn is_linear(&self, number: usize) -> bool {
        let mut looks = self.looks.iter();
        looks.all(|[here, moved]| here[number].to_bits() == moved[number].to_bits())
    }
}

/// The first row of each combination of modes, and some more.
fn samples(track: &Track<'_>) -> BTreeSet<usize> {
    let rows = &track.route.rows;
    let mut met = vec![false; track.route.configurations.len()];
    let is_new =
        |(_, passed): &(usize, &Passed)| !std::mem::replace(&mut met[passed.modes[1]], true);
    let new = rows.iter().enumerate().filter(is_new);
    let mut found: BTreeSet<usize> = new.map(|(row, _)| row).collect();
    found.extend((0..LOOKS).map(|look| look * rows.len() / LOOKS));
    found
}

/// The unknown that a derivative is by, or by whose rate.
fn unknown(entry: &PartialEntry) -> Option<usize> {
    match entry.wrt {
        Wrt::Unknown(place) | Wrt::Derivative(place) => Some(place),
        Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => None,
    }
}

fn is_diagonal(matrix: &DMatrix<f64>) -> bool {
    let n = matrix.nrows();
    let mut others = (0..n).flat_map(|row| (0..n).map(move |column| (row, column)));
    others.all(|(row, column)| row == column || matrix[(row, column)] == 0.0)
}

/// What a time T makes of x' = A x + g, g = B d + r, with r going evenly from one end to the other and d as cubic as its values
/// and slopes at both ends tell: by x, x', the slopes of d at both ends, the change of d, and g at the end.
fn over(a: &DMatrix<f64>, b: &DMatrix<f64>, time: f64) -> DMatrix<f64> {
    let n = a.nrows();
    // With g cubic, g and its derivatives are states of a linear system.
    let mut all = DMatrix::zeros(5 * n, 5 * n);
    all.view_mut((0, 0), (n, n)).copy_from(a);
    for part in 0..4 {
        let mut next = all.view_mut((part * n, (part + 1) * n), (n, n));
        next.fill_with_identity();
    }
    let exp = steps(&all, time, 1)[0].exp.rows(0, n).into_owned();
    let [by_x, by_g, first, second, third] = [0, 1, 2, 3, 4].map(|part| exp.columns(part * n, n));
    let (first, second, third) = (
        first / time,
        second / (time * time),
        third / (time * time * time),
    );
    let by_rate = by_g - &first;
    let parts = [
        by_x - &by_rate * a,
        by_rate,
        (&first - &second * 4.0 + &third * 6.0) * b * time,
        (&third * 6.0 - &second * 2.0) * b * time,
        (&second * 6.0 - &third * 12.0 - &first) * b,
        first,
    ];
    let width = parts.iter().map(DMatrix::ncols).sum();
    let (mut over, mut at) = (DMatrix::zeros(n, width), 0);
    for part in &parts {
        over.columns_mut(at, part.ncols()).copy_from(part);
        at += part.ncols();
    }
    over
}
