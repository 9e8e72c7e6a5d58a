//! Why a call of the solver did not do what was asked.

use crate::PatternError;

/// What went wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// The pattern of the Jacobian is not well-formed, or empty.
    Pattern(PatternError),
    /// A slice has the wrong length.
    Length {
        /// Which.
        what: &'static str,
        /// The length it should have.
        expected: usize,
        /// The length it has.
        found: usize,
    },
    /// A number given is NaN or infinite.
    NotFinite {
        /// In which argument.
        what: &'static str,
        /// At which index of it.
        index: usize,
    },
    /// An option is outside its range.
    Option {
        /// Which.
        what: &'static str,
        /// What it must be.
        requirement: &'static str,
    },
    /// The time to stop at lies before the time reached.
    Behind {
        /// The time reached, in s.
        t: f64,
        /// The time asked for, in s.
        asked: f64,
    },
    /// The time to interpolate at lies outside the last step.
    OutsideLastStep {
        /// The time asked for, in s.
        t: f64,
        /// The beginning of the last step, in s.
        from: f64,
        /// The end of the last step, in s.
        to: f64,
    },
    /// The last step has no derivative of this order.
    NoSuchDerivative {
        /// The order of the derivative asked for.
        derivative: usize,
        /// The largest there is, the order of the last step.
        largest: usize,
    },
    /// IDA or KLU could not allocate what it needs.
    OutOfMemory,
    /// IDA could not go on.
    Failed(Box<Failure>),
}

/// How IDA failed, where, and which part of the system is to blame.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// What failed.
    pub kind: FailureKind,
    /// The last time reached, in s.
    pub t: f64,
    /// The size of the step that failed, in s.
    pub step_s: f64,
    /// The unknown to look at: the one with the largest weighted error or correction, or without a pivot.
    pub unknown: Option<usize>,
    /// The equation to look at: the one without a value, or farthest from satisfied, its residual measured by what a
    /// change of the unknowns within tolerance would make of it.
    pub equation: Option<usize>,
    /// The residual of that equation in the last attempt.
    pub residual: Option<f64>,
    /// The root function without a value.
    pub root: Option<usize>,
    /// The name of IDA's return code.
    pub flag: &'static str,
    /// What IDA said.
    pub message: String,
}

/// The ways IDA fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FailureKind {
    /// `max_steps_per_solve` steps did not reach the output time.
    TooMuchWork,
    /// The tolerances ask for more than the arithmetic has.
    TooMuchAccuracy,
    /// The estimated error stayed too large however small the step.
    ErrorTest,
    /// Newton's method did not converge however small the step.
    Convergence,
    /// The Jacobian is singular.
    SingularJacobian,
    /// The residual has no value.
    Residual,
    /// The Jacobian has no value.
    Jacobian,
    /// A root function has no value.
    RootFunction,
    /// No consistent initial conditions were found.
    InitialConditions,
    /// IDA refused the call; the message says why.
    Refused,
    /// Something else; the message says what.
    Other,
}

impl From<PatternError> for Error {
    fn from(error: PatternError) -> Self {
        Self::Pattern(error)
    }
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Pattern(error) => error.fmt(f),
            Self::Length {
                what,
                expected,
                found,
            } => write!(f, "`{what}` has {found} entries instead of {expected}"),
            Self::NotFinite { what, index } => {
                write!(f, "entry {index} of `{what}` is not a finite number")
            }
            Self::Option { what, requirement } => write!(f, "`{what}` {requirement}"),
            Self::Behind { t, asked } => {
                write!(f, "t = {asked:e} s lies before the time reached, {t:e} s")
            }
            Self::OutsideLastStep { t, from, to } => {
                write!(
                    f,
                    "t = {t:e} s lies outside the last step, {from:e} s to {to:e} s"
                )
            }
            Self::NoSuchDerivative {
                derivative,
                largest,
            } => {
                write!(
                    f,
                    "the last step has derivatives up to order {largest}, not {derivative}"
                )
            }
            Self::OutOfMemory => write!(f, "out of memory"),
            Self::Failed(failure) => failure.fmt(f),
        }
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} at t = {:e} s with a step of {:e} s",
            self.kind.as_str(),
            self.t,
            self.step_s
        )?;
        for (name, index) in [
            ("equation", self.equation),
            ("unknown", self.unknown),
            ("root function", self.root),
        ] {
            if let Some(index) = index {
                write!(f, ", {name} {index}")?;
            }
        }
        write!(f, " ({}", self.flag)?;
        if !self.message.is_empty() {
            write!(f, ": {}", self.message)?;
        }
        write!(f, ")")
    }
}

impl FailureKind {
    /// One line on what failed.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::TooMuchWork => "the output time was not reached in the allowed number of steps",
            Self::TooMuchAccuracy => "the tolerances are tighter than the arithmetic",
            Self::ErrorTest => "the error test failed repeatedly",
            Self::Convergence => "Newton's method did not converge",
            Self::SingularJacobian => "the Jacobian is singular",
            Self::Residual => "the residual has no value",
            Self::Jacobian => "the Jacobian has no value",
            Self::RootFunction => "a root function has no value",
            Self::InitialConditions => "no consistent initial conditions were found",
            Self::Refused => "IDA refused the call",
            Self::Other => "IDA failed",
        }
    }
}

impl std::error::Error for Error {}
impl std::error::Error for Failure {}
