//! [`Plant`]: the fixed-step form of a program, driven by a record: as cheap as a search needs it, as exact as one wants.
//!
//! Time is divided dyadically: a row's time into 2 steps, each down to 64 parts. In a combination of modes the linear part
//! of the flow is carried exactly and the rest by two stages (ETD2RK, Cox and Matthews, J. Comput. Phys. 176, 2002, 430),
//! so a drive with friction in modes needs no small steps: steps get smaller where the rest bends, and where a guard
//! becomes true, until the event is known to a 64th of a step. Events follow [`super::events`]. A state that a mode fixes
//! stays there bitwise.

use super::configuration::{Configuration, Places};
use super::events::watched;
use super::leg::{Event, Instant, Leg};
use super::lengths::{LEVELS, shortest_steps, size_of};
use super::outputs::output_matrix;
use super::past::Past;
use super::stepping::{Outcome, Room, gather};
use super::unsupported::Unsupported;
use crate::records::Recording;
use hyde_program::{Function, Point, Program, Workspace};
use hyde_sim::{Failure, PointModes, PointTime, Setup};
use nalgebra::DMatrix;

/// The level of the longest step: half of a row's time.
const LONGEST: usize = 1;
/// A step as short as this, and still too long, asks for another linear part; so many there are of a combination of modes.
const SHORT: usize = 3;
const LINEAR_PARTS: usize = 8;

/// How exact a step is before an observer says what is worth it, SI.
const DEFAULT_TOLERANCE: f64 = 1e-7;

/// A program with its parameters and a record, at an instant.
pub(crate) struct Plant<'a> {
    pub(crate) program: &'a Program,
    pub(crate) recording: &'a Recording,
    pub(crate) places: Places,
    pub(crate) p: Vec<f64>,
    /// How exact a step is to be, one number a state, SI.
    pub(crate) tolerances: Vec<f64>,
    /// Combinations of modes met so far, by the numbers that tell them apart; several of one are linear at several points.
    pub(crate) configurations: Vec<(Vec<u64>, Configuration<'a>)>,
    pub(crate) current: usize,
    /// Places of the memory that tell combinations of modes apart.
    key_places: Vec<usize>,
    pub(crate) row: usize,
    /// Shortest steps since the row.
    pub(crate) index: usize,
    /// How short the next step is.
    pub(crate) level: usize,
    /// The last rows in which no linear part would do for a step of each level.
    none_did: [Option<usize>; LEVELS],
    /// Where the last of them was made: row and index.
    made: Option<(usize, usize)>,
    /// Up to which row, and in steps of which level, rates were last seen to change evenly.
    pub(crate) even: Option<(usize, usize)>,
    pub(crate) y: Vec<f64>,
    pub(crate) yp: Vec<f64>,
    pub(crate) z: Vec<f64>,
    pub(crate) u: Vec<f64>,
    pub(crate) workspace: Workspace,
    pub(crate) watched: Vec<usize>,
    pub(crate) conditions: Vec<bool>,
    /// Positions fixed by modes, with their values.
    pub(crate) pinned: Vec<(usize, f64)>,
    /// Those that any mode fixed since the last row or event began: friction that slips back has held in between.
    met: Vec<usize>,
    pub(crate) room: Room,
    /// The steps of the last row, where somebody follows them.
    pub(crate) legs: Option<Vec<Leg>>,
    pub(crate) past: Past,
    /// Delayed values where the next step begins, and where it ends.
    pub(crate) late: (Vec<f64>, Vec<f64>),
}

impl<'a> Plant<'a> {
    /// The plant at the first row, where the record shows it to be and else where the model starts.
    pub(crate) fn new(
        program: &'a Program,
        recording: &'a Recording,
        set: &[(usize, f64)],
    ) -> Result<Self, Unsupported> {
        Self::beginning(program, recording, set, &recording.beginning)
    }

    /// The plant at the first row with some states (by name) elsewhere than the model starts, in the modes of its start that
    /// can be there.
    pub(crate) fn beginning(
        program: &'a Program,
        recording: &'a Recording,
        set: &[(usize, f64)],
        beginning: &[(String, f64)],
    ) -> Result<Self, Unsupported> {
        supported(program)?;
        let p = recording.parameters(program, set);
        let known = positions(program, beginning);
        let (tables, t) = (&recording.tables, recording.start_s);
        let start = hyde_sim::known_start(program, tables, &p, t, &known).map_err(no_start)?;
        let mut plant = Self::from(program, recording, p, (start.y, start.yp, start.z))?;
        plant.settle();
        Ok(plant)
    }

    /// The plant at the first row in chosen modes; of automata not named, friction slips.
    pub(crate) fn at(
        program: &'a Program,
        recording: &'a Recording,
        p: Vec<f64>,
        modes: &[(usize, usize)],
    ) -> Result<Self, Unsupported> {
        let setup = Setup {
            start_s: recording.start_s,
            ..Setup::new(p, &recording.tables, recording.start_s + 1.0)
        };
        let modes = PointModes::Sliding(modes);
        let start = hyde_sim::operating_point(program, &setup, PointTime::Start, modes);
        let start = start.map_err(no_start)?;
        Self::from(program, recording, start.p, (start.y, start.yp, start.z))
    }

    fn from(
        program: &'a Program,
        recording: &'a Recording,
        p: Vec<f64>,
        (y, yp, z): (Vec<f64>, Vec<f64>, Vec<f64>),
    ) -> Result<Self, Unsupported> {
        let past = Past::new(program, recording, &p)?;
        let places = Places::new(program, &z);
        let n_states = places.states.len();
        let equation =
            |number: &usize| program.relations[*number].used == hyde_program::RelationUse::Equation;
        let key_places = (0..program.relations.len())
            .filter(equation)
            .chain(program.automata.iter().map(|automaton| automaton.place))
            .collect();
        let mut plant = Self {
            program,
            recording,
            tolerances: vec![DEFAULT_TOLERANCE; n_states],
            configurations: Vec::new(),
            current: 0,
            key_places,
            row: 0,
            index: 0,
            level: LONGEST,
            none_did: [None; LEVELS],
            made: None,
            even: None,
            y,
            yp,
            z,
            u: vec![0.0; 2 * program.columns.len() + program.delays.len()],
            workspace: Workspace::new(program.n_work),
            watched: Vec::new(),
            conditions: vec![false; program.reactions.len()],
            pinned: Vec::new(),
            met: Vec::new(),
            room: Room::new(program, &places),
            legs: None,
            past,
            late: (
                vec![0.0; program.delays.len()],
                vec![0.0; program.delays.len()],
            ),
            places,
            p,
        };
        plant.read_inputs();
        plant.pin();
        plant.enter()?;
        Ok(plant)
    }

    /// The combination of modes it is in.
    pub(crate) fn configuration(&self) -> &Configuration<'a> {
        &self.configurations[self.current].1
    }

    /// What tells the combination of modes it is in from others.
    pub(crate) fn combination(&self) -> &[u64] {
        &self.configurations[self.current].0
    }

    /// The numbers of the states that modes fix, or did where the last events began, or in passing.
    pub(crate) fn fixed_states(&self) -> Vec<usize> {
        let states = self.places.states.iter().enumerate();
        let fixed = states.filter(|(_, position)| self.met.contains(position));
        fixed.map(|(number, _)| number).collect()
    }

    /// The rates of the states.
    pub(crate) fn rates(&self, out: &mut [f64]) {
        gather(&self.yp, &self.places.states, out);
    }

    /// Time in s.
    pub(crate) fn time(&self) -> f64 {
        let part = self.index as f64 / shortest_steps() as f64;
        self.recording.start_s + self.recording.step_s * (self.row as f64 + part)
    }

    /// Where the plant is.
    pub(crate) fn here(&self) -> Point<'_> {
        Point {
            t: self.time(),
            y: &self.y,
            yp: &self.yp,
            z: &self.z,
            u: &self.u,
            p: &self.p,
        }
    }

    /// The model where the plant is.
    pub(crate) fn point(&mut self) -> (Point<'_>, &mut Workspace) {
        let (at, _, workspace) = self.point_and_places();
        (at, workspace)
    }

    /// Derivatives of the measured channels by the states where the plant is.
    pub(crate) fn outputs(&mut self) -> DMatrix<f64> {
        let at = Point {
            t: self.time(),
            y: &self.y,
            yp: &self.yp,
            z: &self.z,
            u: &self.u,
            p: &self.p,
        };
        let configuration = &self.configurations[self.current].1;
        let (program, places) = (self.program, &self.places);
        output_matrix(program, places, configuration, at, &mut self.workspace)
    }

    fn point_and_places(&mut self) -> (Point<'_>, &Places, &mut Workspace) {
        let t = self.time();
        let at = Point {
            t,
            y: &self.y,
            yp: &self.yp,
            z: &self.z,
            u: &self.u,
            p: &self.p,
        };
        (at, &self.places, &mut self.workspace)
    }

    /// Begins a row: what drives the axis jumps, the states change by an increment, those that modes fix apart.
    pub(crate) fn begin_row(&mut self, increment: &[f64]) {
        self.read_inputs();
        self.forget_fixed();
        for (&position, change) in self.places.states.iter().zip(increment) {
            self.y[position] += change;
        }
        self.apply_pins();
        self.make_consistent();
        if self.changed() {
            self.settle();
        }
    }

    /// On to the next row, up to what drives the axis there.
    pub(crate) fn advance(&mut self) {
        // Linear parts that would not do for the next step: their configurations, and the errors.
        let mut tried = Vec::new();
        while self.index < shortest_steps() {
            while !self.index.is_multiple_of(size_of(self.level)) {
                self.level += 1;
            }
            if !self.past.is_empty() && !self.read_past() {
                self.level += 1;
                continue;
            }
            let level = self.level;
            match self.step(level) {
                Outcome::Taken => {
                    self.index += size_of(level);
                    self.keep(level, None);
                    if self.level > LONGEST && self.index.is_multiple_of(size_of(self.level - 1)) {
                        self.level -= 1;
                    }
                }
                Outcome::Bent(error) if self.other_linear_part(error, &mut tried) => continue,
                Outcome::Bent(_) | Outcome::TooLong => self.level += 1,
                Outcome::Event => {
                    self.index += size_of(level);
                    let event = self.event();
                    self.keep(level, event);
                }
            }
            tried.clear();
        }
        self.row += 1;
        self.index = 0;
    }

    /// Goes through what happens where a guard has become true, and tells it where somebody follows.
    fn event(&mut self) -> Option<Event> {
        let followed = self.legs.is_some();
        let before = followed.then(|| Instant::of(self.here()));
        self.forget_fixed();
        self.settle();
        before.map(|before| Event {
            configuration: self.current,
            fixed: self.fixed_states(),
            before,
            after: Instant::of(self.here()),
        })
    }

    fn keep(&mut self, level: usize, event: Option<Event>) {
        if let Some(legs) = &mut self.legs {
            legs.push(Leg { level, event });
        }
    }

    /// After a step with too large an error: goes over to another linear part of the same modes, one met before, else that of
    /// this very point. Where all have been tried for this step, to the best of them, and the step must be shorter: false.
    ///
    /// A drag with a power of the speed below 1 is met where the axis begins to slide, and is steeper there by orders of
    /// magnitude than ever after.
    fn other_linear_part(&mut self, error: f64, tried: &mut Vec<(usize, f64)>) -> bool {
        if self.level < SHORT || self.none_did[self.level] == Some(self.row) {
            return false;
        }
        tried.push((self.current, error));
        let (key, _) = &self.configurations[self.current];
        let all = self.configurations.iter().enumerate();
        let alike = all.filter(|(_, (other, _))| other == key);
        let alike: Vec<usize> = alike.map(|(number, _)| number).collect();
        let is_new = |number: &&usize| tried.iter().all(|(other, _)| other != *number);
        if let Some(&next) = alike.iter().find(is_new) {
            self.current = next;
            return true;
        }
        let here = Some((self.row, self.index));
        if alike.len() < LINEAR_PARTS && self.made != here {
            let key = key.clone();
            self.made = here;
            if self.linearise(key) {
                return true;
            }
        }
        self.none_did[self.level] = Some(self.row);
        let best = tried.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        self.current = best.map_or(self.current, |(best, _)| *best);
        false
    }

    /// Whether the truth of a watched relation is another than the memory says.
    fn changed(&mut self) -> bool {
        if self.watched.is_empty() {
            return false;
        }
        let mut roots = std::mem::take(&mut self.room.roots);
        let program = self.program;
        let (at, workspace) = self.point();
        program
            .kernels
            .evaluate(Function::Roots, at, workspace, &mut roots);
        let changed = self
            .watched
            .iter()
            .any(|&number| self.differs(number, roots[number]));
        self.room.roots = roots;
        changed
    }

    fn differs(&self, relation: usize, root: f64) -> bool {
        self.program.relations[relation].truth(root) != (self.z[relation] != 0.0)
    }

    /// Finds or makes the configuration of the modes it is in.
    pub(crate) fn enter(&mut self) -> Result<(), Unsupported> {
        let key: Vec<u64> = self
            .key_places
            .iter()
            .map(|&place| self.z[place].to_bits())
            .collect();
        if let Some(known) = self
            .configurations
            .iter()
            .position(|(other, _)| *other == key)
        {
            self.current = known;
        } else if !self.linearise(key) {
            // Modes in which nothing follows: stay with the last ones' linear part.
            return Err(Unsupported::singular());
        }
        self.even = None;
        self.watched = watched(self.program, &self.z);
        self.make_consistent();
        Ok(())
    }

    /// Linearises the model where the plant is, and goes over to that; false where nothing follows from its equations.
    fn linearise(&mut self, key: Vec<u64>) -> bool {
        let (program, step_s) = (self.program, self.recording.step_s);
        let (at, places, workspace) = self.point_and_places();
        let Some(made) = Configuration::new(program, places, at, workspace, step_s, LEVELS) else {
            return false;
        };
        self.current = self.configurations.len();
        self.configurations.push((key, made));
        true
    }

    /// What the linear part of this very point makes of the states in a row's time, exp(A T); none where nothing follows from
    /// the equations, or where it is not finite.
    pub(crate) fn step_here(&mut self) -> Option<DMatrix<f64>> {
        let (program, step_s) = (self.program, self.recording.step_s);
        let (at, places, workspace) = self.point_and_places();
        let made = Configuration::new(program, places, at, workspace, step_s, 1)?;
        let exp = &made.steps[0].exp;
        exp.iter()
            .all(|entry| entry.is_finite())
            .then(|| exp.clone())
    }

    /// Whether rates need no look within a step of a level.
    pub(crate) fn is_even(&self, level: usize) -> bool {
        let known = self.even;
        known.is_some_and(|(until, known)| self.row < until && level >= known)
    }

    pub(crate) fn apply_pins(&mut self) {
        for &(position, value) in &self.pinned {
            self.y[position] = value;
            self.yp[position] = 0.0;
            self.met.push(position);
        }
    }

    fn forget_fixed(&mut self) {
        self.met.clear();
        self.met
            .extend(self.pinned.iter().map(|(position, _)| *position));
    }
}

/// The positions of states among the unknowns of a program; those it does not have are left out.
fn positions(program: &Program, beginning: &[(String, f64)]) -> Vec<(usize, f64)> {
    if beginning.is_empty() {
        return Vec::new();
    }
    let unknowns = 0..program.n_unknowns;
    let known = unknowns.filter_map(|position| {
        let name = program.unknown_name(position);
        let own = beginning.iter().find(|(state, _)| *state == name)?;
        Some((position, own.1))
    });
    known.collect()
}

#[allow(clippy::needless_pass_by_value, reason = "a function to map errors by")]
fn no_start(failure: Box<Failure>) -> Unsupported {
    Unsupported::Start(format!("{:?}", failure.kind))
}

fn supported(program: &Program) -> Result<(), Unsupported> {
    if let Some(hold) = program.holds.iter().find(|hold| hold.read) {
        return Err(Unsupported::Clock(program.clocks[hold.clock].name.clone()));
    }
    if let Some(measured) = program.experiment.measured.iter().find(|m| m.clocked) {
        return Err(Unsupported::Clock(measured.name.clone()));
    }
    if !program.selections.is_empty() {
        return Err(Unsupported::ChosenStates);
    }
    Ok(())
}
