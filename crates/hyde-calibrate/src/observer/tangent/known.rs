//! [`Known`]: what combinations of modes, and steps in them, make of errors and forces.

use super::passage::correct;
use crate::observer::gain::Observer;
use crate::observer::over_record::When;
use crate::observer::track::{Bend, Forcing, Route, Track, acting};
use crate::plant::output_matrix;
use crate::records::{Readings, Recording};
use hyde_program::Workspace;
use nalgebra::DMatrix;
use std::collections::BTreeMap;

/// What a combination of modes makes of errors and forces in a row.
pub(crate) struct Modes {
    pub(crate) exp: DMatrix<f64>,
    /// By the equations that a direction touches.
    pub(crate) first: DMatrix<f64>,
    pub(crate) second: DMatrix<f64>,
    pub(crate) outputs: DMatrix<f64>,
    /// What an observer corrects there, in the kind of row; 0 of a channel without a reading, as its outputs are.
    pub(crate) gain: DMatrix<f64>,
    /// Which channels have a reading.
    pub(crate) readings: Readings,
}

/// What combinations of modes, and steps in them, make of errors and forces: made where they are new. All of it is that of the
/// route, for what is looked at has no size.
pub(crate) struct Known<'t> {
    route: &'t Route<'t>,
    recording: &'t Recording,
    /// The equations that a direction touches, as the route numbers them; `None` of what is carried along, which acts on
    /// nothing.
    touched: Vec<Option<usize>>,
    workspace: Workspace,
    pub(crate) modes: Vec<Modes>,
    /// By the kind of row, and the numbers of the track.
    number_of: Vec<Vec<Option<usize>>>,
    rates: Vec<Option<DMatrix<f64>>>,
    /// Where equations bend, by the first combination of the same modes.
    forcings: BTreeMap<usize, Forcing>,
    legs: BTreeMap<(usize, usize), DMatrix<f64>>,
}

impl<'t> Known<'t> {
    /// That of directions which touch some equations of what is evaluated along a track.
    pub(crate) fn new(track: &'t Track<'t>, recording: &'t Recording, touched: &[usize]) -> Self {
        let route = &*track.route;
        let count = route.configurations.len();
        let touched = touched.iter().map(|&own| track.equation(own));
        Self {
            route,
            recording,
            touched: touched.collect(),
            workspace: Workspace::new(route.program.n_work),
            modes: Vec::new(),
            number_of: vec![vec![None; count]; recording.kinds.len()],
            rates: vec![None; count],
            forcings: BTreeMap::new(),
            legs: BTreeMap::new(),
        }
    }

    /// The observer of the route.
    pub(super) fn observer(&self) -> &'t Observer {
        &self.route.observer
    }

    /// The number of the matrices of a combination of modes and a kind of row, in which a row is.
    pub(crate) fn modes(&mut self, row: usize, when: When, configuration: usize) -> usize {
        let kind = self.recording.kind_of(row);
        if let Some(number) = self.number_of[kind][configuration] {
            return number;
        }
        let route = self.route;
        let readings = self.recording.readings(row);
        let own = &route.configurations[configuration];
        let at = route.point(row, when, &route.p);
        let workspace = &mut self.workspace;
        let mut outputs = output_matrix(route.program, &route.places, own, at, workspace);
        for (channel, _) in readings.iter().enumerate().filter(|(_, there)| !**there) {
            outputs.row_mut(channel).fill(0.0);
        }
        let step = &own.steps[0];
        let rates = self.rates(configuration);
        let made = Modes {
            exp: step.exp.clone(),
            first: &step.first * rates,
            // phi2 is that of a growth over the whole step.
            second: &step.second * rates,
            outputs,
            gain: own.gains.in_row(readings).clone(),
            readings: readings.clone(),
        };
        self.modes.push(made);
        self.number_of[kind][configuration] = Some(self.modes.len() - 1);
        self.modes.len() - 1
    }

    /// Times errors, and forces at the begin and the end of a step below them, this is errors at its end. Without what bends.
    pub(super) fn leg(&mut self, configuration: usize, level: usize) -> &DMatrix<f64> {
        let key = (configuration, level);
        if !self.legs.contains_key(&key) {
            let (step, rates) = match self.route.splitting(configuration) {
                Some(own) => (&own.steps[level], &self.forcing(configuration).rates),
                None => {
                    let plain = &self.route.configurations[configuration].steps[level];
                    (plain, self.rates(configuration))
                }
            };
            let n = step.exp.nrows();
            let forces = rates.ncols();
            let (first, second) = (&step.first * rates, &step.second * rates);
            let mut matrix = DMatrix::zeros(n, n + 2 * forces);
            matrix.columns_mut(0, n).copy_from(&step.exp);
            // The second integral is that of a growth over the step.
            matrix.columns_mut(n, forces).copy_from(&(first - &second));
            matrix.columns_mut(n + forces, forces).copy_from(&second);
            self.legs.insert(key, matrix);
        }
        &self.legs[&key]
    }

    /// How forces act where equations bend in a combination of modes.
    fn forcing(&mut self, configuration: usize) -> &Forcing {
        let first = self.route.same_modes[configuration];
        let (route, touched) = (self.route, &self.touched);
        self.forcings.entry(first).or_insert_with(|| {
            let own = route.splitting(configuration);
            own.map(|own| own.forcing(touched)).unwrap_or_default()
        })
    }

    /// What bends takes errors on by half a step of a length in shortest ones, forces being as they are.
    pub(super) fn kick(
        &mut self,
        configuration: usize,
        bend: Option<&Bend>,
        length: usize,
        forces: &DMatrix<f64>,
        errors: &mut DMatrix<f64>,
    ) {
        if let (Some(own), Some(bend)) = (self.route.splitting(configuration), bend) {
            let forcing = self.forcing(configuration);
            own.kick(bend, length, (forcing, forces), errors);
        }
    }

    /// What bends at the end of a row that is one step, the correction behind it: thin matrices `u v'`, times what is corrected
    /// by [`super::passage::Corrected`], come on top of it. By errors it is the route's.
    pub(super) fn bent_at_end(
        &mut self,
        row: usize,
        (configuration, bend): (usize, Option<&'t Bend>),
        seen: usize,
    ) -> Option<(&'t DMatrix<f64>, DMatrix<f64>)> {
        let (route, bend) = (self.route, bend?);
        let own = route.splitting(configuration)?;
        let [answered, by_error] = route.end(row, || {
            let [errors, by_error] = own.at_end(bend);
            let (channels, states) = self.modes[seen].outputs.shape();
            let mut answered = DMatrix::zeros(states + channels, errors.ncols());
            correct(&errors, &self.modes[seen], &route.observer, &mut answered);
            [answered, by_error]
        });
        self.leg(configuration, 0);
        self.forcing(configuration);
        let first = route.same_modes[configuration];
        let step = (&self.legs[&(configuration, 0)], &self.forcings[&first]);
        let by_force = own.at_end_by_forces(bend, step);
        let (states, rank) = by_error.shape();
        let mut by_all = DMatrix::zeros(states + by_force.nrows(), rank);
        by_all.rows_mut(0, states).copy_from(by_error);
        by_all
            .rows_mut(states, by_force.nrows())
            .copy_from(&by_force);
        Some((answered, by_all))
    }

    /// The rates of the states that forces in the equations that are touched make.
    fn rates(&mut self, configuration: usize) -> &DMatrix<f64> {
        let (route, touched) = (self.route, &self.touched);
        self.rates[configuration].get_or_insert_with(|| {
            let inverse = &route.configurations[configuration].inverse;
            -acting(&inverse.select_rows(&route.places.states), touched)
        })
    }
}
