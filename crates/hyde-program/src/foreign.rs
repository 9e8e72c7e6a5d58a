//! Parts of a model that are not equations: an FMU, stepped by the ticks of a clock.

use hyde_diag::{FileId, Origin};
use std::fmt::Debug;
use std::sync::Arc;

/// A component that something outside the program computes. It is stepped behind each tick of its clock; where it reads
/// and writes are values of that clock, in the memory.
#[derive(Clone, Debug)]
pub struct ForeignPart {
    /// Full name of the component.
    pub name: String,
    /// The file that it comes from, as the model names it.
    pub file: String,
    /// The source file that stands for it.
    pub source: FileId,
    /// Its clock.
    pub clock: usize,
    /// Positions of its parameters in the memory, read at the first tick.
    pub parameters: Vec<usize>,
    /// Positions of what it reads at a tick.
    pub inputs: Vec<usize>,
    /// Positions of what it gives at a tick.
    pub outputs: Vec<usize>,
    /// Where the component is declared.
    pub origin: Origin,
    /// What computes it; none where the program is compiled and not run.
    pub computed_by: Option<Arc<dyn Foreign>>,
}

/// Makes instances: each run has its own.
pub trait Foreign: Debug + Send + Sync {
    /// A new instance for the component of that name.
    ///
    /// # Errors
    /// It cannot be made.
    fn instance(&self, component: &str) -> Result<Box<dyn ForeignInstance>, Stopped>;
}

/// One instance in a run.
pub trait ForeignInstance: Send {
    /// A tick: takes what there is just before it, gives the outputs that are valid from it on. At the first tick the
    /// parameters are set and the initial outputs given; after that the outputs are those of the step that ends here.
    /// Values are those of the model, SI.
    ///
    /// # Errors
    /// It cannot go on.
    fn tick(&mut self, tick: ForeignTick<'_>) -> Result<(), Stopped>;
}

/// What an instance has and gives at a tick.
pub struct ForeignTick<'a> {
    /// Time in s.
    pub t: f64,
    /// Time to the next tick in s.
    pub period: f64,
    /// The end of the run in s, if that is known.
    pub stop: f64,
    /// The parameters, in the order of the part.
    pub parameters: &'a [f64],
    /// The inputs.
    pub inputs: &'a [f64],
    /// The outputs, to be written.
    pub outputs: &'a mut [f64],
}

/// Why an instance does not go on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stopped {
    /// What failed: the function with its status, or what the file lacks.
    pub what: String,
    /// What was logged, the newest last.
    pub log: Vec<String>,
}
