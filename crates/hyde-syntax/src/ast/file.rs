//! A file and its items.

use super::{Class, Experiment, Name, Reference, Study, UnitText};

/// A source file.
#[derive(Clone, Debug, Default, PartialEq)]
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
