//! [`CommandTiming`]: whether the model puts a command out when the recorded one was put out.
//!
//! A replay cuts the loop (C4): the record drives the axis, and the controller of the model drives nothing. Here it runs beside
//! the track of the observer. At each of its ticks it samples what the observer knows of the axis, a state that is measured
//! as it was measured, and what it puts out is compared with the record moved by whole rows:
//!
//! ```text
//! e_s(k) = recorded(k + s) - computed(k)     s = 0       the model is right in time
//!                                            s < 0       it puts its command out later than the true controller
//! ```
//! The least sum of squares decides, the mean of each e_s left out: an integrator begins where nobody knows. The axis
//! itself tells a controller that is late from a column that was recorded early: it follows what really drove it.

mod controller;

use super::answer::Diagnosis;
use super::inquiry::Inquiry;
use super::thresholds::Thresholds;
use crate::fit::Problem;
use crate::observer::{Innovations, Track};
use crate::plant::Unsupported;
use crate::records::Recording;
use controller::Controller;
use hyde_program::Program;

/// When the model puts out a command, beside when it was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandTiming {
    /// The number of the command among those that the program replays.
    pub replayed: usize,
    /// By how much the model is later than the record, s: negative where it is earlier, 0 where it is right.
    pub late_s: f64,
    /// The number of the clock that puts it out.
    pub clock: usize,
    /// Its period, s.
    pub period_s: f64,
    /// From its tick to the change of what it holds, s.
    pub delay_s: f64,
    /// Recorded less computed command, rms over that of the command, its mean left out.
    pub error: f64,
    /// The same with the record moved by that.
    pub error_moved: f64,
    /// The axis follows the command that is moved better than the one that was recorded: the column is at fault.
    pub of_column: bool,
}

/// A command that is not compared with its record.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncompared {
    /// The number of the command among those that the program replays.
    pub replayed: usize,
    /// The number of a clock that puts it out.
    pub clock: usize,
    /// Why not.
    pub why: Why,
}

/// Why a command is not compared with its record.
#[derive(Clone, Debug, PartialEq)]
pub enum Why {
    /// The model has parts that are not equations, which run in no other way than with it.
    Parts,
    /// What is replayed is not made of one column.
    Columns,
    /// The clock does not tick with the rows of a record: its period and the time of a row, s.
    Clock {
        /// Its period.
        period_s: f64,
        /// The time of a row.
        step_s: f64,
    },
    /// What the model puts out is something else, whatever it is moved by: the difference at best, rms over that of the command.
    Differs(f64),
}

/// Commands that clocked parts put out, beside their records.
#[derive(Clone, Debug, Default)]
pub struct Commands {
    /// Those that are compared.
    pub timings: Vec<CommandTiming>,
    /// The others.
    pub uncompared: Vec<Uncompared>,
}

impl CommandTiming {
    /// Moves the column of the command to where it acted, in a record that the same program reads.
    pub fn mend(&self, program: &Program, recording: &mut Recording) {
        let rows = (-self.late_s / recording.step_s).round() as i64;
        if let Some(column) = program.experiment.replayed[self.replayed].column {
            recording.move_column(column, rows);
        }
    }
}

impl Diagnosis {
    /// When the model that was found puts out its commands: those whose controllers tick with the rows of all records.
    ///
    /// # Errors
    /// The model has no fixed-step form.
    pub fn commands(&self, inquiry: &Inquiry<'_>) -> Result<Commands, Unsupported> {
        let ground = self.ground(inquiry);
        let set = ground.set_in(&self.program, &self.kept);
        let problem = ground.problem(&self.program, &self.varied, &set, None);
        commands(&problem, &self.after.values, ground.thresholds)
    }
}

/// The columns that were recorded at other times than they acted, of the model as it is declared: calibrated where a
/// command is put out at another time than recorded.
///
/// # Errors
/// The model has no fixed-step form.
pub fn moved_columns(
    problem: &Problem<'_>,
    thresholds: &Thresholds,
) -> Result<Vec<CommandTiming>, Unsupported> {
    let nominal: Vec<f64> = problem.varied.iter().map(|own| own.nominal).collect();
    let timings = commands(problem, &nominal, thresholds)?.timings;
    if timings.iter().all(|own| own.late_s == 0.0) {
        return Ok(Vec::new());
    }
    let values = problem.solve(&nominal)?.values;
    let mut timings = commands(problem, &values, thresholds)?.timings;
    timings.retain(|own| own.of_column);
    Ok(timings)
}

/// Every replayed command that clocked parts put out, parameters at some values.
fn commands(
    problem: &Problem<'_>,
    values: &[f64],
    thresholds: &Thresholds,
) -> Result<Commands, Unsupported> {
    let program = problem.program;
    let set = problem.settings(values);
    let each = problem.recordings.iter();
    let p: Vec<Vec<f64>> = each.map(|own| own.parameters(program, &set)).collect();
    let (mut found, mut ticking) = (Commands::default(), Vec::new());
    for number in 0..program.experiment.replayed.len() {
        let pairs = problem.recordings.iter().zip(&p);
        let each = pairs.filter_map(|(recording, p)| Controller::of(program, recording, p, number));
        match each.collect::<Result<Vec<Controller<'_>>, Uncompared>>() {
            Ok(controllers) if controllers.is_empty() => {}
            Ok(controllers) => ticking.push((number, controllers)),
            Err(uncompared) => found.uncompared.push(uncompared),
        }
    }
    if ticking.is_empty() {
        return Ok(found);
    }
    let tracks = Track::all(program, problem.recordings, problem.observer, &set)?;
    for (number, controllers) in &ticking {
        match timing(problem, thresholds, (&tracks, &set), *number, controllers)? {
            Some(Ok(timing)) => found.timings.push(timing),
            Some(Err(uncompared)) => found.uncompared.push(uncompared),
            None => {}
        }
    }
    Ok(found)
}

/// The time of a command with its controllers, one a record; `None` where records have different clocks, or none ends.
fn timing(
    problem: &Problem<'_>,
    thresholds: &Thresholds,
    (tracks, set): (&[Track<'_>], &[(usize, f64)]),
    number: usize,
    controllers: &[Controller<'_>],
) -> Result<Option<Result<CommandTiming, Uncompared>>, Unsupported> {
    let program = problem.program;
    let replayed = &program.experiment.replayed[number];
    let (Some(controller), Some(recording)) = (controllers.first(), problem.recordings.first())
    else {
        return Ok(None);
    };
    let (clock, step_s) = (&controller.clocks[0], recording.step_s);
    let mut sums = Vec::new();
    let records = problem.recordings.iter().zip(tracks);
    for ((recording, track), controller) in records.zip(controllers) {
        let p = recording.parameters(program, set);
        let [computed, recorded] = controller.along(track, recording, &p);
        let own = moved(&recorded, &computed, recording.first_row, controller.most());
        if sums.is_empty() {
            sums = vec![(0.0, 0.0); own.len()];
        }
        if sums.len() != own.len() {
            return Ok(None);
        }
        for (sum, own) in sums.iter_mut().zip(own) {
            *sum = (sum.0 + own.0, sum.1 + own.1);
        }
    }
    let part = |place: usize| {
        let (error, command): (f64, f64) = sums[place];
        if command > 0.0 {
            error / command
        } else {
            f64::INFINITY
        }
    };
    let middle = sums.len() / 2;
    let Some(best) = (0..sums.len()).min_by(|&a, &b| part(a).total_cmp(&part(b))) else {
        return Ok(None);
    };
    if part(best) > thresholds.a_part {
        let why = Why::Differs(part(best).sqrt());
        return Ok(Some(Err(clock.uncompared(number, why))));
    }
    let clear = part(best) <= (1.0 - thresholds.mostly) * part(middle);
    let best = if clear { best } else { middle };
    let rows = middle as i64 - best as i64;
    let of_column = match replayed.column {
        Some(column) if rows != 0 => follows_moved(problem, set, column, -rows)?,
        Some(_) | None => false,
    };
    Ok(Some(Ok(CommandTiming {
        replayed: number,
        late_s: rows as f64 * step_s,
        clock: clock.clock,
        period_s: clock.period_s,
        delay_s: clock.delay_s,
        error: part(middle).sqrt(),
        error_moved: part(best).sqrt(),
        of_column,
    })))
}

/// Of every shift of the record, in rows from `-most` to `most`: the sum of squares of its difference from what was computed,
/// and that of the record, means left out. The same rows of what was computed count in all.
fn moved(recorded: &[f64], computed: &[f64], first_row: usize, most: i64) -> Vec<(f64, f64)> {
    let edge = usize::try_from(most).unwrap_or(0);
    let rows = first_row.max(edge)..computed.len().saturating_sub(edge);
    let variation = |values: &mut dyn Iterator<Item = f64>| {
        let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
        values.filter(|value| value.is_finite()).for_each(|value| {
            count += 1.0;
            sum += value;
            squares += value * value;
        });
        (squares - sum * sum / f64::max(count, 1.0)).max(0.0)
    };
    (-most..=most)
        .map(|shift| {
            let at = |row: usize| {
                let moved = usize::try_from(row as i64 + shift).unwrap_or(0);
                recorded.get(moved).copied().unwrap_or(f64::NAN)
            };
            let mut errors = rows.clone().map(|row| at(row) - computed[row]);
            let mut commands = rows.clone().map(at);
            (variation(&mut errors), variation(&mut commands))
        })
        .collect()
}

/// Whether the axis follows a column better that is moved by some rows.
fn follows_moved(
    problem: &Problem<'_>,
    set: &[(usize, f64)],
    column: usize,
    rows: i64,
) -> Result<bool, Unsupported> {
    let squares = |recording: &Recording| -> Result<f64, Unsupported> {
        let all = Innovations::of(problem.program, recording, problem.observer, set)?;
        Ok(all.channels.iter().flatten().map(|e| e * e).sum())
    };
    let mut gained = 0.0;
    for recording in problem.recordings {
        let mut other = recording.clone();
        other.move_column(column, rows);
        gained += squares(recording)? - squares(&other)?;
    }
    Ok(gained > 0.0)
}
