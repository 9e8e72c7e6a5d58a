//! The tree of a source file: what was written.

use hyde_diag::Span;

/// A word and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// The word.
    pub text: String,
    /// Its place.
    pub span: Span,
}

/// A dotted name, possibly with subscripts: `m[2].a.s`.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Its parts.
    pub parts: Vec<Part>,
    /// Its place.
    pub span: Span,
}

/// A part of a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The word.
    pub name: Name,
    /// Subscripts, from 1.
    pub subscripts: Vec<Expr>,
}

impl Reference {
    /// The reference as text, without subscripts.
    #[must_use]
    pub fn dotted(&self) -> String {
        let names: Vec<&str> = self
            .parts
            .iter()
            .map(|part| part.name.text.as_str())
            .collect();
        names.join(".")
    }

    /// The word, if it is a single one without subscripts.
    #[must_use]
    pub fn as_word(&self) -> Option<&str> {
        match self.parts.as_slice() {
            [part] if part.subscripts.is_empty() => Some(&part.name.text),
            _ => None,
        }
    }
}

/// A unit as written between brackets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitText {
    /// The text between the brackets.
    pub text: String,
    /// Its place.
    pub span: Span,
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Its place.
    pub span: Span,
}

/// Operators on one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unary {
    /// `-a`
    Negative,
    /// `+a`
    Positive,
    /// `not a`
    Not,
}

/// Operators on two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    Lt,
    Le,
    Gt,
    Ge,
    Eq,
    Ne,
    And,
    Or,
}

/// The kinds of expressions.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// `0.35 [ohm]`
    Number(f64, Option<UnitText>),
    /// `"text"`
    String(String),
    /// `true`, `false`
    Boolean(bool),
    /// `motor.phi`
    Reference(Reference),
    /// `der(x)`, `th.at(xn)`, `max(a, b)`
    Call(Reference, Vec<Argument>),
    /// `-a`
    Unary(Unary, Box<Expr>),
    /// `a + b`
    Binary(Binary, Box<Expr>, Box<Expr>),
    /// `if a then b elseif c then d else e`
    If(Vec<(Expr, Expr)>, Box<Expr>),
    /// `{1, 2, 3} [mm]`
    Array(Vec<Expr>, Option<UnitText>),
}

/// An argument of a call, named or not.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// `n` in `fem(n = 24)`.
    pub name: Option<Name>,
    /// Its value.
    pub value: Expr,
}

/// `a .. b`
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Lower bound.
    pub from: Expr,
    /// Upper bound.
    pub to: Expr,
}

/// A source file.
#[derive(Clone, Debug, PartialEq)]
pub struct File {
    /// `package bench_axis "doc";`
    pub package: Option<(Reference, Option<String>)>,
    /// `import SI.*;`
    pub imports: Vec<Import>,
    /// Everything else, in the order written.
    pub items: Vec<Item>,
}

/// `import A.B;` or `import A.*;`
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// The package or the thing imported.
    pub path: Reference,
    /// `.*`
    pub everything: bool,
}

/// A top-level item.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// `type Angle = Real [rad];`
    Type(TypeItem),
    /// `model`, `connector`, `effect`
    Class(Class),
    /// `experiment`
    Experiment(Experiment),
    /// `calibrate`, `diagnose`, `sweep`
    Study(Study),
}

/// `type Angle = Real [rad] "doc";`
#[derive(Clone, Debug, PartialEq)]
pub struct TypeItem {
    /// The new type.
    pub name: Name,
    /// What it specialises.
    pub base: Reference,
    /// Its unit.
    pub unit: Option<UnitText>,
    /// Its documentation.
    pub doc: Option<String>,
}

/// What kind of class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClassKind {
    /// `model`
    Model,
    /// `connector`
    Connector,
    /// `effect`
    Effect,
}

/// A model, connector or effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Class {
    /// Which.
    pub kind: ClassKind,
    /// Its name.
    pub name: Name,
    /// Its documentation.
    pub doc: Option<String>,
    /// What is in it.
    pub body: ClassBody,
    /// From the keyword to the end.
    pub span: Span,
}

/// The two forms of a class.
#[derive(Clone, Debug, PartialEq)]
pub enum ClassBody {
    /// Written out.
    Long {
        /// `on Guide`: the type an effect is for.
        host: Option<Reference>,
        /// Its elements.
        elements: Vec<Element>,
    },
    /// `model A = B(R = 2) with E(dF = 1) on guide;`
    Short {
        /// The model it is.
        base: Reference,
        /// With these changes.
        changes: Vec<Change>,
        /// And these effects.
        effects: Vec<EffectUse>,
    },
}

/// `Stribeck(dF = 150 [N]) on guide`
#[derive(Clone, Debug, PartialEq)]
pub struct EffectUse {
    /// The effect.
    pub effect: Reference,
    /// With these changes.
    pub changes: Vec<Change>,
    /// Where.
    pub sites: Vec<Reference>,
}

/// An element of a class.
#[derive(Clone, Debug, PartialEq)]
pub enum Element {
    /// `extends Base(R = 2);`
    Extends(Reference, Vec<Change>),
    /// `parameter Resistance R = 0.35 [ohm];`
    Declaration(Declaration),
    /// `domain bar(x in 0 .. len);`
    Domain(Domain),
    /// `discretize bar by fem(n = 24);`
    Discretize(Discretize),
    /// `modes initial stuck { … }`
    Modes(Modes),
    /// `clocked cnc(1 [ms]) … end cnc;`
    Clocked(Clocked),
    /// An equation.
    Equation(Equation),
    /// An equation of an `initial equation` section.
    InitialEquation(Equation),
    /// `wrap grip by grip + dF;`
    Wrap(Reference, Expr),
    /// `add a.tau = …;`
    Add(Equation),
    /// `replace contact by GapContact(gap = gap);`
    Replace(Reference, Reference, Vec<Change>),
    /// `signature velocity, angle(N);`
    Signature(Vec<(Name, Vec<Argument>)>),
    /// `confounds LuGre;`
    Confounds(Vec<Reference>),
    /// `measure Length peak = max(abs(e));`
    Measure(Measure),
}

/// The words before a declaration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Prefix {
    Parameter,
    Constant,
    Final,
    Flow,
    Input,
    Output,
    Replaceable,
    Site,
    Field,
    Size,
    Shape,
}

/// `prefixes Type[dims] a, b;`
#[derive(Clone, Debug, PartialEq)]
pub struct Declaration {
    /// The words before the type.
    pub prefixes: Vec<Prefix>,
    /// The type.
    pub type_name: Reference,
    /// Dimensions after the type.
    pub dims: Vec<Expr>,
    /// What is declared.
    pub declarators: Vec<Declarator>,
    /// Its place.
    pub span: Span,
}

/// One declared name.
#[derive(Clone, Debug, PartialEq)]
pub struct Declarator {
    /// The name.
    pub name: Name,
    /// Dimensions after the name.
    pub dims: Vec<Expr>,
    /// Changes to the component, or `start` and `fixed` of a variable.
    pub changes: Vec<Change>,
    /// `on bar`, of a field.
    pub domain: Option<Name>,
    /// `= e`
    pub binding: Option<Expr>,
    /// `~ ±8%`
    pub prior: Option<Prior>,
    /// `from "datasheet"`
    pub source: Option<String>,
    /// `in 0 .. 1 [kN]`
    pub within: Option<Range>,
    /// Its documentation.
    pub doc: Option<String>,
}

/// `~ ±8%`, `~ ±0.1 [mm]`
#[derive(Clone, Debug, PartialEq)]
pub struct Prior {
    /// The number.
    pub value: f64,
    /// Whether it is in percent of the value.
    pub percent: bool,
    /// Its unit, if not.
    pub unit: Option<UnitText>,
    /// Its place.
    pub span: Span,
}

/// A modification: `R = 2`, `contact.k = 1e8`, `redeclare Contact contact(…)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// What is changed.
    pub target: Reference,
    /// The new model of a replaceable component.
    pub redeclare: Option<Reference>,
    /// Applies to each element of an array.
    pub each: bool,
    /// May not be changed further.
    pub is_final: bool,
    /// Nested changes.
    pub changes: Vec<Change>,
    /// The new value.
    pub value: Option<Expr>,
    /// Its prior.
    pub prior: Option<Prior>,
    /// Its source.
    pub source: Option<String>,
}

/// `domain bar(x in 0 .. len);`
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// Its name.
    pub name: Name,
    /// The coordinate.
    pub coordinate: Name,
    /// Its bounds.
    pub range: Range,
}

/// `discretize bar by fem(n = 24);`
#[derive(Clone, Debug, PartialEq)]
pub struct Discretize {
    /// The domain.
    pub domain: Name,
    /// The method.
    pub method: Name,
    /// Its arguments.
    pub arguments: Vec<Argument>,
}

/// `modes initial stuck { … }`
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// Its name, if it has one.
    pub name: Option<Name>,
    /// The first mode.
    pub initial: Name,
    /// Values of the first mode's parameters.
    pub arguments: Vec<Argument>,
    /// The modes.
    pub modes: Vec<Mode>,
    /// Its place.
    pub span: Span,
}

/// `mode slip(Real s) { … }`
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Its name.
    pub name: Name,
    /// Its parameters: type and name.
    pub parameters: Vec<(Reference, Name)>,
    /// Its equations.
    pub equations: Vec<Equation>,
    /// Its exits.
    pub exits: Vec<Exit>,
}

/// `exit s*w < 0 -> stuck;`
#[derive(Clone, Debug, PartialEq)]
pub struct Exit {
    /// The guard.
    pub guard: Expr,
    /// The mode entered.
    pub target: Name,
    /// Values of its parameters.
    pub arguments: Vec<Argument>,
    /// `impact`
    pub impact: bool,
    /// `{ reinit(v, 0); }`
    pub actions: Vec<Equation>,
    /// Its place.
    pub span: Span,
}

/// `clocked cnc(1 [ms], delay = 2 [ms]) … end cnc;`
#[derive(Clone, Debug, PartialEq)]
pub struct Clocked {
    /// Its name.
    pub name: Name,
    /// Period, delay, phase.
    pub arguments: Vec<Argument>,
    /// What is in it.
    pub elements: Vec<Element>,
    /// Its place.
    pub span: Span,
}

/// `measure Length peak = max(abs(e)) "doc";`
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Its type.
    pub type_name: Reference,
    /// Its name.
    pub name: Name,
    /// Its value.
    pub value: Expr,
    /// Its documentation.
    pub doc: Option<String>,
}

/// An equation or what stands among equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// What it is.
    pub kind: EquationKind,
    /// Its place.
    pub span: Span,
}

/// The kinds of equations.
#[derive(Clone, Debug, PartialEq)]
pub enum EquationKind {
    /// `a = b indomain bar load(x, F);`
    Equality {
        /// Left side.
        lhs: Expr,
        /// Right side.
        rhs: Expr,
        /// Where it holds, for equations of fields.
        place: Option<Place>,
    },
    /// `connect(a, b, c);`
    Connect(Vec<Reference>),
    /// `for i in 1:n loop … end for;`
    For {
        /// The counter.
        counter: Name,
        /// First value.
        first: Expr,
        /// Last value.
        last: Expr,
        /// What holds for each.
        equations: Vec<Equation>,
    },
    /// `if a then … else … end if;`
    If {
        /// Conditions with their equations.
        branches: Vec<(Expr, Vec<Equation>)>,
        /// The equations where no condition holds.
        otherwise: Vec<Equation>,
    },
    /// `when a then … elsewhen b then … end when;`
    When(Vec<(Expr, Vec<Equation>)>),
    /// `assert(a, "message");`
    Assert(Expr, String),
    /// `reinit(x, e);`
    Reinit(Reference, Expr),
}

/// `indomain bar`, `indomain bar.left`, with loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The domain.
    pub domain: Name,
    /// `left` or `right`.
    pub end: Option<Name>,
    /// Position and force of each point load.
    pub loads: Vec<(Expr, Expr)>,
}

/// `experiment bench(record file) of Axis … end bench;`
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// Its name.
    pub name: Name,
    /// Its records.
    pub records: Vec<RecordItem>,
    /// Its model.
    pub model: Reference,
    /// With these changes.
    pub changes: Vec<Change>,
    /// Its documentation.
    pub doc: Option<String>,
    /// What is in it.
    pub items: Vec<ExperimentItem>,
    /// From the keyword to the end.
    pub span: Span,
}

/// `record file every 1 [ms] = "records/strokes.csv"`
#[derive(Clone, Debug, PartialEq)]
pub struct RecordItem {
    /// The name in the experiment.
    pub name: Name,
    /// Time between rows, where the record's own time is not to be used.
    pub every: Option<Expr>,
    /// The file used where no other is given, relative to the model's file.
    pub default: Option<Name>,
}

/// `target = value`, of a stimulus or a replay.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// What is driven.
    pub target: Reference,
    /// By what.
    pub value: Expr,
}

/// `file.i = motor.i ~ 0.02 [A]`
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The recorded signal.
    pub signal: Expr,
    /// What the model has for it.
    pub value: Expr,
    /// Standard deviation of its noise.
    pub noise: Option<Expr>,
    /// What it is called in reports.
    pub doc: Option<String>,
}

/// An element of an experiment.
#[derive(Clone, Debug, PartialEq)]
pub enum ExperimentItem {
    /// `stimulus r = file.r;`
    Stimulus(Vec<Drive>),
    /// `measured file.i = motor.i;`
    Measured(Vec<Channel>),
    /// `replay motor.i_ref = file.i_ref;`
    Replay(Vec<Drive>),
    /// `expect max(abs(v)) < 1 [m/s] "doc";`
    Expect(Expr, Option<String>),
    /// `measure Length peak = max(abs(e));`
    Measure(Measure),
    /// `solve ida(rtol = 1e-6)`
    Solve(Name, Vec<Argument>),
    /// `stop 10 [s]`
    Stop(Expr),
    /// `every 1 [ms]`
    Every(Expr),
    /// `skip 50 [ms]`
    Skip(Expr),
    /// `bode from u to y over 1 .. 50 [Hz] in guide = slip;`
    Bode(Bode),
}

/// `bode from u to y over 1 .. 50 [Hz] in guide = slip;`
#[derive(Clone, Debug, PartialEq)]
pub struct Bode {
    /// The driven input.
    pub input: Reference,
    /// The responses.
    pub outputs: Vec<Expr>,
    /// The band of frequencies.
    pub band: Range,
    /// The modes in which the linearised system is taken: instance and mode.
    pub modes: Vec<(Reference, Name)>,
}

/// What kind of study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StudyKind {
    /// `calibrate`
    Calibrate,
    /// `diagnose`
    Diagnose,
    /// `sweep`
    Sweep,
}

/// `calibrate bench of Axis … end bench;`
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// Which.
    pub kind: StudyKind,
    /// Its name.
    pub name: Name,
    /// The model, experiment or calibration it is of.
    pub of: Reference,
    /// Its documentation.
    pub doc: Option<String>,
    /// What is in it.
    pub items: Vec<StudyItem>,
    /// From the keyword to the end.
    pub span: Span,
}

/// An element of a study.
#[derive(Clone, Debug, PartialEq)]
pub enum StudyItem {
    /// `vary saddle.M in 200 .. 400 [kg];`
    Vary(Vec<Variation>),
    /// `max_effects 3;`, `fit bench("fit-*.csv");`
    Setting(Name, Vec<SettingValue>),
}

/// What is varied, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    /// A parameter, or the word `uncertain`.
    pub target: Reference,
    /// `in a .. b`
    pub within: Option<Range>,
    /// `= {…}`
    pub values: Option<Expr>,
}

/// The value of a setting.
#[derive(Clone, Debug, PartialEq)]
pub enum SettingValue {
    /// `Effects.*`
    Everything(Reference),
    /// Any expression.
    Expr(Expr),
}
