//! [`Known`]: what combinations of modes, and steps in them, make of errors and forces.

use super::splitting::{Bend, Splitting};
use crate::observer::over_record::When;
use crate::observer::track::{Track, Vectors};
use crate::plant::{Unsupported, output_matrix, partials, shortest_steps};
use crate::records::{Readings, Recording};
use hyde_program::{Point, Program, Workspace};
use nalgebra::DMatrix;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Rows in which derivatives are looked at for those that are usual.
const LOOKS: usize = 15;

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

/// What combinations of modes, and steps in them, make of errors and forces: made where they are new.
pub(crate) struct Known<'t> {
    track: &'t Track<'t>,
    program: &'t Program,
    p: &'t [f64],
    touched: Vec<usize>,
    workspace: Workspace,
    pub(crate) modes: Vec<Modes>,
    recording: &'t Recording,
    /// By the kind of row, and the numbers of the track.
    number_of: Vec<Vec<Option<usize>>>,
    rates: Vec<Option<DMatrix<f64>>>,
    /// Those of the ones met so far, where equations bend: one for all linear parts of the same modes.
    splittings: BTreeMap<usize, Option<Rc<Splitting>>>,
    legs: BTreeMap<(usize, usize), DMatrix<f64>>,
}

impl<'t> Known<'t> {
    pub(crate) fn new(
        track: &'t Track<'t>,
        program: &'t Program,
        recording: &'t Recording,
        p: &'t [f64],
        touched: &[usize],
    ) -> Self {
        let count = track.route.configurations.len();
        Self {
            track,
            program,
            p,
            touched: touched.to_vec(),
            workspace: Workspace::new(program.n_work),
            modes: Vec::new(),
            recording,
            number_of: vec![vec![None; count]; recording.kinds.len()],
            rates: vec![None; count],
            splittings: BTreeMap::new(),
            legs: BTreeMap::new(),
        }
    }

    /// The number of the matrices of a combination of modes and a kind of row, in which a row is.
    pub(crate) fn modes(
        &mut self,
        row: usize,
        when: When,
        configuration: usize,
    ) -> Result<usize, Unsupported> {
        let kind = self.recording.kind_of(row);
        if let Some(number) = self.number_of[kind][configuration] {
            return Ok(number);
        }
        let track = self.track;
        let readings = self.recording.readings(row);
        let own = &track.route.configurations[configuration];
        let mut room = Vectors::default();
        let at = track.point(row, when, self.p, &mut room);
        let mut outputs = output_matrix(self.program, &track.places, own, at, &mut self.workspace);
        for (channel, _) in readings.iter().enumerate().filter(|(_, there)| !**there) {
            outputs.row_mut(channel).fill(0.0);
        }
        let step = &own.steps[0];
        let rates = self.rates(configuration)?;
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
        Ok(self.modes.len() - 1)
    }

    /// Times errors, and forces at the begin and the end of a step below them, this is errors at its end. Without what bends.
    pub(super) fn leg(
        &mut self,
        configuration: usize,
        level: usize,
    ) -> Result<&DMatrix<f64>, Unsupported> {
        let key = (configuration, level);
        if !self.legs.contains_key(&key) {
            let plain = &self.track.route.configurations[configuration].steps[level];
            let splitting = self.splitting(configuration);
            let (step, rates) = match &splitting {
                Some(own) => (&own.steps[level], &own.rates),
                None => (plain, self.rates(configuration)?),
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
        Ok(&self.legs[&key])
    }

    /// How errors go where equations bend in a combination of modes; `None` where none does.
    pub(super) fn splitting(&mut self, configuration: usize) -> Option<Rc<Splitting>> {
        let configuration = self.track.route.same_modes[configuration];
        if !self.splittings.contains_key(&configuration) {
            let own = &self.track.route.configurations[configuration];
            let made = (!own.affine).then(|| self.split(configuration)).flatten();
            self.splittings.insert(configuration, made.map(Rc::new));
        }
        self.splittings[&configuration].clone()
    }

    fn split(&mut self, configuration: usize) -> Option<Splitting> {
        let (track, program) = (self.track, self.program);
        let route = &track.route;
        let rows = route.rows.iter().enumerate();
        let own = rows.filter(|(_, passed)| route.same_modes[passed.modes[1]] == configuration);
        let own: Vec<usize> = own.map(|(row, _)| row).collect();
        let mut room = Vectors::default();
        let mut look = |row: &usize| {
            let at = track.point(*row, When::After, self.p, &mut room);
            partials(program, at, &mut self.workspace)
        };
        let every = own.len().div_ceil(LOOKS).max(1);
        let looks: Vec<Vec<f64>> = own.iter().step_by(every).map(&mut look).collect();
        let mut room = Vectors::default();
        let at = track.made(configuration, self.p, &mut room);
        let workspace = &mut self.workspace;
        Splitting::new(track, program, &self.touched, at, &looks, workspace)
    }

    /// What bends takes errors on by half a step of a length in shortest ones, forces being as they are.
    pub(super) fn kick(
        &mut self,
        configuration: usize,
        bend: &Option<Rc<Bend>>,
        length: usize,
        forces: &DMatrix<f64>,
        errors: &mut DMatrix<f64>,
    ) {
        if let (Some(own), Some(bend)) = (self.splitting(configuration), bend) {
            own.kick(bend, length, forces, errors);
        }
    }

    /// Times errors and forces at the begin and the end of a row, all of it a step in one combination of modes, this is errors
    /// at its end: what bends takes them on for half of it, then the leg, then what bends at its end.
    pub(super) fn bent(
        &mut self,
        configuration: usize,
        [begin, end]: [&Option<Rc<Bend>>; 2],
        errors: &mut DMatrix<f64>,
    ) -> Result<(), Unsupported> {
        let (states, all) = errors.shape();
        let touched = (all - states) / 2;
        // Units of all there is: errors, and forces at both ends.
        let mut units = DMatrix::identity(all, all);
        let forces = |first: usize| units.rows(first, touched).into_owned();
        let [begins, ends] = [states, states + touched].map(forces);
        self.kick(configuration, begin, shortest_steps(), &begins, &mut units);
        errors.gemm(1.0, self.leg(configuration, 0)?, &units, 0.0);
        self.kick(configuration, end, shortest_steps(), &ends, errors);
        Ok(())
    }

    /// What bends at a point of a combination of modes.
    pub(super) fn bend(&mut self, configuration: usize, at: Point<'_>) -> Option<Rc<Bend>> {
        let own = self.splitting(configuration)?;
        Some(Rc::new(own.bend(self.program, at, &mut self.workspace)))
    }

    /// The rates of the states that forces in the equations that are touched make.
    fn rates(&mut self, configuration: usize) -> Result<&DMatrix<f64>, Unsupported> {
        if self.rates[configuration].is_none() {
            let track = self.track;
            let inverse = track
                .inverse(self.program, configuration, self.p, &mut self.workspace)
                .ok_or_else(Unsupported::singular)?;
            let of_states = -inverse.select_rows(&track.places.states);
            self.rates[configuration] = Some(of_states.select_columns(&self.touched));
        }
        self.rates[configuration]
            .as_ref()
            .ok_or_else(Unsupported::singular)
    }
}
