//! [`LawShape`]: a function of the language that laws from records are made of, as data.
//!
//! ```text
//! function falling "an exponential decrease with {v} over {vs}"
//!   input Velocity v, v_max;                                                   inputs
//!   input Velocity vs = {0.01, 0.1, 1}*v_max in 0 .. 2*v_max;                  constants
//!   output Real f(cost = 2) = exp(-noEvent(abs(v))/vs) over (slip);            outputs, cost, roles
//!   signature velocity;                                                        mark
//! end falling;
//! ```
//! Expressions are in [`LawShape::exprs`]: their leaf `Var(n)` is the input of number `n`.

use crate::expr::{Expr, ExprArena};
use crate::id::{ExprId, Id as _};
use hyde_units::NamedUnit;

/// The role that a variable has at a site where the shape is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawRole {
    /// The speed of what moves.
    Speed,
    /// The speed with which two surfaces slip.
    Slip,
    /// The rate of a stretch or of a demand.
    Rate,
    /// Any of these three, of which the past counts: the shape multiplies those of the speed.
    Motion,
    /// The acceleration of what moves or slips.
    Acceleration,
    /// Where something is that moves or slips.
    Place,
    /// The same where it is not an angle.
    Distance,
    /// The same where it is an angle.
    Angle,
    /// How far something elastic is stretched.
    Stretch,
    /// What an amplifier is asked for.
    Demand,
    /// What a site has beside its two variables: a current, a force.
    Signal,
    /// The time.
    Time,
}

/// The variable of a site that a shape is a function of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawAxis {
    /// A speed or a rate: `v`.
    Speed,
    /// A place, or what stands for it: `x`.
    Place,
    /// The derivative of a speed: `a`.
    Acceleration,
    /// Another variable that the site declares: `u`.
    Signal,
    /// The time: `t`.
    Time,
}

/// What an input of a shape is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawInput {
    /// The variable itself: `v`, `x`, `a`, `u`, `t`.
    Variable(LawAxis),
    /// A round value of it: `v1`, `x1`, `a1`, `u1`, `t1`.
    Round(LawAxis),
    /// The least value that records show: `x_min`, `t_min`.
    Least(LawAxis),
    /// The greatest: `x_max`, `t_max`; of the others the greatest magnitude, `v_max`, `a_max`, `u_max`.
    Greatest(LawAxis),
    /// The constant of that number.
    Constant(usize),
    /// The state of that number.
    State(usize),
}

/// The unit of a constant or a state at a site.
#[derive(Clone, Debug, PartialEq)]
pub enum LawUnit {
    /// That of a variable of the site.
    Of(LawAxis),
    /// One of its own.
    Own(NamedUnit),
}

/// How a search changes a constant at first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawStep {
    /// By so much.
    Added(ExprId),
    /// By so much of its logarithm.
    Ratio(ExprId),
}

/// A constant of a shape.
#[derive(Clone, Debug, PartialEq)]
pub struct LawConstant {
    /// What it is called in the text of a law.
    pub name: String,
    /// Its unit there.
    pub unit: LawUnit,
    /// The values tried at first, or one that depends on the constants before it.
    pub values: Vec<ExprId>,
    /// The values that records determine: from, to.
    pub range: [ExprId; 2],
    /// The first step of a search.
    pub step: LawStep,
    /// The values that a fit may take: from, to.
    pub limits: [ExprId; 2],
}

/// A filter of the first order: `time_constant*der(state) = input - state`.
#[derive(Clone, Debug, PartialEq)]
pub struct LawState {
    /// Its name.
    pub name: String,
    /// What it is, in words.
    pub doc: String,
    /// Its unit.
    pub unit: LawUnit,
    /// The time constant, s.
    pub time_constant: LawText,
    /// What is filtered.
    pub input: LawText,
}

/// An expression with its text.
#[derive(Clone, Debug, PartialEq)]
pub struct LawText {
    /// The expression.
    pub value: ExprId,
    /// Its text in the language.
    pub pieces: Vec<LawPiece>,
    /// Whether it needs parentheses as a factor of a product.
    pub is_sum: bool,
}

/// A piece of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LawPiece {
    /// Letters.
    Letters(String),
    /// The name of the input of that number.
    Input(usize),
}

/// A shape that a law may be made of.
#[derive(Clone, Debug)]
pub struct LawShape {
    /// The function, with its package.
    pub name: String,
    /// What it is, in words: `{v}`, `{x}`, `{a}` and `{u}` are the words of the site, `{vs}` is the value of a constant.
    pub words: String,
    /// Where it is tried: at sites with one of these roles.
    pub roles: Vec<LawRole>,
    /// Its expressions.
    pub exprs: ExprArena,
    /// Its inputs.
    pub inputs: Vec<LawInput>,
    /// Its constants.
    pub constants: Vec<LawConstant>,
    /// Its filters.
    pub states: Vec<LawState>,
    /// Its values, each with its name: two of a wave.
    pub outputs: Vec<(String, LawText)>,
    /// The mark that it leaves in measurements, with the constant that says where.
    pub mark: (String, Option<usize>),
    /// Two shapes are multiplied with each other if their costs together are at most 2.
    pub cost: u32,
    /// In a product of a cost, so many values of the constants are tried.
    pub few: Option<usize>,
}

impl LawRole {
    /// Each role with its word.
    pub const ALL: [(Self, &'static str); 12] = [
        (Self::Speed, "speed"),
        (Self::Slip, "slip"),
        (Self::Rate, "rate"),
        (Self::Motion, "motion"),
        (Self::Acceleration, "acceleration"),
        (Self::Signal, "signal"),
        (Self::Place, "place"),
        (Self::Distance, "distance"),
        (Self::Angle, "angle"),
        (Self::Stretch, "stretch"),
        (Self::Demand, "demand"),
        (Self::Time, "time"),
    ];

    /// The variable that has the role.
    #[must_use]
    pub fn axis(self) -> LawAxis {
        match self {
            Self::Speed | Self::Slip | Self::Rate | Self::Motion => LawAxis::Speed,
            Self::Place | Self::Distance | Self::Angle | Self::Stretch | Self::Demand => {
                LawAxis::Place
            }
            Self::Acceleration => LawAxis::Acceleration,
            Self::Signal => LawAxis::Signal,
            Self::Time => LawAxis::Time,
        }
    }
}

impl LawInput {
    /// What an input of that name is, constants and states apart.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "v" => Self::Variable(LawAxis::Speed),
            "x" => Self::Variable(LawAxis::Place),
            "a" => Self::Variable(LawAxis::Acceleration),
            "u" => Self::Variable(LawAxis::Signal),
            "t" => Self::Variable(LawAxis::Time),
            "v1" => Self::Round(LawAxis::Speed),
            "x1" => Self::Round(LawAxis::Place),
            "a1" => Self::Round(LawAxis::Acceleration),
            "u1" => Self::Round(LawAxis::Signal),
            "t1" => Self::Round(LawAxis::Time),
            "x_min" => Self::Least(LawAxis::Place),
            "t_min" => Self::Least(LawAxis::Time),
            "v_max" => Self::Greatest(LawAxis::Speed),
            "a_max" => Self::Greatest(LawAxis::Acceleration),
            "u_max" => Self::Greatest(LawAxis::Signal),
            "x_max" => Self::Greatest(LawAxis::Place),
            "t_max" => Self::Greatest(LawAxis::Time),
            _ => return None,
        })
    }
}

impl LawShape {
    /// Visits every expression that it has.
    pub fn each_expression(&mut self, visit: &mut dyn FnMut(&mut ExprId)) {
        for constant in &mut self.constants {
            constant.values.iter_mut().for_each(&mut *visit);
            constant.range.iter_mut().for_each(&mut *visit);
            constant.limits.iter_mut().for_each(&mut *visit);
            let (LawStep::Added(step) | LawStep::Ratio(step)) = &mut constant.step;
            visit(step);
        }
        for state in &mut self.states {
            visit(&mut state.time_constant.value);
            visit(&mut state.input.value);
        }
        let outputs = self.outputs.iter_mut();
        outputs.for_each(|(_, text)| visit(&mut text.value));
    }

    /// The number of values of its constants that are tried.
    #[must_use]
    pub fn count(&self) -> usize {
        let counts = self.constants.iter().map(|constant| constant.values.len());
        counts.max().unwrap_or(1)
    }

    /// The input that a leaf is.
    #[must_use]
    pub fn input(&self, leaf: Expr) -> Option<LawInput> {
        let (var, ..) = leaf.access()?;
        self.inputs.get(var.index()).copied()
    }

    /// Whether an input is read by its values or its filters.
    #[must_use]
    pub fn reads(&self, input: LawInput) -> bool {
        let states = self.states.iter();
        let filtered = states.flat_map(|state| [&state.time_constant, &state.input]);
        let mut all = self.outputs.iter().map(|(_, text)| text).chain(filtered);
        all.any(|text| {
            let mut pieces = text.pieces.iter();
            pieces.any(|piece| match piece {
                LawPiece::Input(number) => self.inputs.get(*number) == Some(&input),
                LawPiece::Letters(_) => false,
            })
        })
    }
}

impl PartialEq for LawShape {
    /// There is one shape of a name.
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
