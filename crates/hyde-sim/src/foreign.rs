//! Parts that are not equations, in a run: each has an instance, made at the first tick of its clock.

use crate::failure::{Failure, FailureKind};
use hyde_program::{ForeignInstance, ForeignTick, Program, Stopped};

/// The instances of a run, beside the parts of the program.
pub(crate) struct ForeignInstances {
    made: Vec<Option<Box<dyn ForeignInstance>>>,
    stop_s: f64,
}

impl ForeignInstances {
    pub(crate) fn new(program: &Program, stop_s: f64) -> Self {
        Self {
            made: program.foreign.iter().map(|_| None).collect(),
            stop_s,
        }
    }

    /// Steps the parts of a clock that has just ticked: `z` has what they read; it gets what they give.
    pub(crate) fn tick(
        &mut self,
        program: &Program,
        clock: usize,
        (t, period): (f64, f64),
        z: &mut [f64],
    ) -> Result<(), Box<Failure>> {
        for (part, made) in program.foreign.iter().zip(&mut self.made) {
            if part.clock != clock {
                continue;
            }
            let failed = |stopped: Stopped| {
                let kind = FailureKind::Foreign {
                    component: part.name.clone(),
                    file: part.file.clone(),
                    what: stopped.what,
                    log: stopped.log,
                };
                Failure::new(kind, t).at_origin(&part.origin)
            };
            let instance = match made {
                Some(instance) => instance,
                None => {
                    let new = match &part.computed_by {
                        Some(by) => by.instance(&part.name),
                        None => Err(Stopped {
                            what: "this command does not run FMUs".to_owned(),
                            log: Vec::new(),
                        }),
                    };
                    made.insert(new.map_err(failed)?)
                }
            };
            let read = |places: &[usize]| -> Vec<f64> { places.iter().map(|&at| z[at]).collect() };
            let (parameters, inputs) = (read(&part.parameters), read(&part.inputs));
            let mut outputs = read(&part.outputs);
            let tick = ForeignTick {
                t,
                period,
                stop: self.stop_s,
                parameters: &parameters,
                inputs: &inputs,
                outputs: &mut outputs,
            };
            instance.tick(tick).map_err(failed)?;
            for (&at, value) in part.outputs.iter().zip(outputs) {
                z[at] = value;
            }
        }
        Ok(())
    }
}
