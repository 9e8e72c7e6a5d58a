//! [`Routine`]: what a kernel computes, step by step, with every leaf resolved to a place in memory.

use hyde_ir::dae::{Dae, Function, Partial, Space};
use hyde_ir::{ClockId, Expr, ExprId, Id as _, Index, ParamId, Range, VariableKind};
use std::collections::BTreeSet;

/// The memory a kernel reads and writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Slot {
    /// The solver's vector.
    Unknown,
    /// Its derivative.
    Derivative,
    /// The memory between events.
    Memory,
    /// Record columns.
    Input,
    /// Parameters.
    Parameter,
    /// Explicit variables.
    Work,
    /// The result.
    Out,
}

impl Slot {
    /// All of them, in the order of the frame.
    pub(crate) const ALL: [Self; 7] = [
        Self::Unknown,
        Self::Derivative,
        Self::Memory,
        Self::Input,
        Self::Parameter,
        Self::Work,
        Self::Out,
    ];

    /// Its letter in printed code.
    pub(crate) fn letter(self) -> &'static str {
        match self {
            Self::Unknown => "y",
            Self::Derivative => "yp",
            Self::Memory => "z",
            Self::Input => "u",
            Self::Parameter => "p",
            Self::Work => "work",
            Self::Out => "out",
        }
    }
}

/// What a leaf of an expression is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Leaf {
    Number(f64),
    Time,
    Counter,
    /// A value in memory; the index counts from the start of the slot.
    Load(Slot, Index),
    /// Whether the memory at a position has this value.
    IsMode(usize, u32),
}

/// One expression over a range, and where its values go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub(crate) range: Range,
    pub(crate) slot: Slot,
    pub(crate) target: Index,
    pub(crate) value: ExprId,
}

/// What a kernel computes.
#[derive(Clone, Debug)]
pub(crate) struct Routine {
    pub(crate) name: String,
    pub(crate) steps: Vec<Step>,
    /// In the tick of a clock its own variables are read where they are written.
    pub(crate) tick: Option<ClockId>,
}

impl Routine {
    /// The values of a function.
    pub(crate) fn values(dae: &Dae, function: Function) -> Self {
        let rows = hyde_analysis::rows(dae, function);
        let rows = rows.into_iter().map(|(range, target, value)| Step {
            range,
            slot: Slot::Out,
            target,
            value,
        });
        Self::with_definitions(dae, name(function).to_owned(), rows.collect(), None)
    }

    /// The values of some rows of a function, in their order.
    pub(crate) fn some_rows(dae: &Dae, function: Function, chosen: &[usize]) -> Self {
        let mut steps = Vec::new();
        for (range, index, value) in hyde_analysis::rows(dae, function) {
            for counter in range.iter() {
                let row = usize::try_from(index.at(counter)).ok();
                let places = (0..).zip(chosen).filter(|(_, own)| Some(**own) == row);
                steps.extend(places.map(|(place, _)| Step {
                    range: Range {
                        first: counter,
                        last: counter,
                    },
                    slot: Slot::Out,
                    target: Index::fixed(place),
                    value,
                }));
            }
        }
        Self::with_definitions(dae, format!("some_{}", name(function)), steps, None)
    }

    /// Derivatives, one block of values a [`Partial`].
    pub(crate) fn partials(dae: &Dae, name: String, partials: &[Partial]) -> Self {
        let mut next = 0;
        let mut steps = Vec::new();
        for partial in partials {
            let target = if partial.range.len() == 1 {
                Index::fixed(next)
            } else {
                Index {
                    stride: 1,
                    offset: next - partial.range.first,
                }
            };
            steps.push(Step {
                range: partial.range,
                slot: Slot::Out,
                target,
                value: partial.value,
            });
            next += i32::try_from(partial.range.len()).unwrap_or(0);
        }
        Self::with_definitions(dae, name, steps, None)
    }

    /// The assignments of a tick.
    pub(crate) fn tick(dae: &Dae, clock: ClockId) -> Self {
        let steps = dae.ticks[clock].assignments.iter().map(|assignment| {
            let base = dae.place(assignment.var).map_or(0, |place| place.base);
            let offset = assignment.index.offset + i32::try_from(base).unwrap_or(0);
            let target = Index {
                offset,
                ..assignment.index
            };
            Step {
                range: assignment.range,
                slot: Slot::Out,
                target,
                value: assignment.value,
            }
        });
        Self::with_definitions(
            dae,
            format!("tick_{}", clock.index()),
            steps.collect(),
            Some(clock),
        )
    }

    /// The truth of the reactions' conditions.
    pub(crate) fn conditions(dae: &Dae) -> Self {
        let steps = dae.reactions.iter().zip(0..).map(|(reaction, row)| Step {
            range: Range::SCALAR,
            slot: Slot::Out,
            target: Index::fixed(row),
            value: reaction.condition,
        });
        Self::with_definitions(dae, "conditions".to_owned(), steps.collect(), None)
    }

    /// The values of a parameter's elements, from parameters alone.
    pub(crate) fn parameter(dae: &Dae, param: ParamId) -> Self {
        let place = i32::try_from(dae.parameter_places[param]).unwrap_or(0);
        let parameter = &dae.parameters[param];
        let rows = parameter.rows(place).into_iter();
        let steps = rows.map(|(range, target, value)| Step {
            range,
            slot: Slot::Out,
            target,
            value,
        });
        Self::plain(&parameter.name, steps.collect())
    }

    /// The name of the function of a part.
    pub(crate) fn part_name(&self, part: usize) -> String {
        match part {
            0 => self.name.clone(),
            _ => format!("{}_part_{}", self.name, part + 1),
        }
    }

    /// Steps with nothing before them.
    pub(crate) fn plain(name: &str, steps: Vec<Step>) -> Self {
        Self {
            name: name.to_owned(),
            steps,
            tick: None,
        }
    }

    /// The definitions that the steps read, before them.
    fn with_definitions(dae: &Dae, name: String, steps: Vec<Step>, tick: Option<ClockId>) -> Self {
        let of_variables = dae.definitions_of_variables();
        let mut needed: BTreeSet<usize> = BTreeSet::new();
        let mut pending: Vec<ExprId> = steps.iter().map(|step| step.value).collect();
        while let Some(root) = pending.pop() {
            for id in dae.exprs.below(&[root]) {
                let Expr::Var(var, _) = dae.exprs[id] else {
                    continue;
                };
                let own = of_variables.get(&var).into_iter().flatten();
                for &number in own.filter(|&&number| needed.insert(number)) {
                    pending.push(dae.definitions[number].value);
                }
            }
        }
        let mut all: Vec<Step> = needed
            .into_iter()
            .map(|number| {
                let definition = &dae.definitions[number];
                let base = dae.place(definition.var).map_or(0, |place| place.base);
                let offset = definition.index.offset + i32::try_from(base).unwrap_or(0);
                let target = Index {
                    offset,
                    ..definition.index
                };
                Step {
                    range: definition.range,
                    slot: Slot::Work,
                    target,
                    value: definition.value,
                }
            })
            .collect();
        all.extend(steps);
        Self {
            name,
            steps: all,
            tick,
        }
    }

    /// What a node without children is; `None` for a node with children.
    pub(crate) fn leaf(&self, dae: &Dae, expr: Expr) -> Option<Leaf> {
        let shifted = |base: usize, index: Index| Index {
            offset: index.offset + i32::try_from(base).unwrap_or(0),
            ..index
        };
        Some(match expr {
            Expr::Const(number) => Leaf::Number(number.0),
            Expr::Time => Leaf::Time,
            Expr::Counter => Leaf::Counter,
            Expr::Param(param, index) => {
                Leaf::Load(Slot::Parameter, shifted(dae.parameter_places[param], index))
            }
            Expr::Var(var, index) => {
                let place = dae.place(var)?;
                let own = self
                    .tick
                    .is_some_and(|clock| dae.variables[var].kind == VariableKind::Clocked(clock));
                let slot = match place.space {
                    Space::Memory if own => Slot::Out,
                    Space::Unknown => Slot::Unknown,
                    Space::Memory => Slot::Memory,
                    Space::Input => Slot::Input,
                    Space::Work => Slot::Work,
                    Space::Parameter => Slot::Parameter,
                };
                Leaf::Load(slot, shifted(place.base, index))
            }
            Expr::Der(var, index) => {
                Leaf::Load(Slot::Derivative, shifted(dae.place(var)?.base, index))
            }
            Expr::Pre(var, index) => Leaf::Load(Slot::Memory, shifted(dae.place(var)?.base, index)),
            Expr::Relation(relation) => {
                Leaf::Load(Slot::Memory, shifted(relation.index(), Index::SCALAR))
            }
            Expr::InMode(automaton, mode) => Leaf::IsMode(dae.automata[automaton].place, mode),
            Expr::Unary(..) | Expr::Binary(..) | Expr::If(..) | Expr::NoEvent(_) => return None,
        })
    }
}

/// The name of a function in printed code.
pub(crate) fn name(function: Function) -> &'static str {
    match function {
        Function::Residual => "residual",
        Function::Roots => "roots",
        Function::Assignments => "assignments",
        Function::Outputs => "outputs",
        Function::Initial => "initial",
        Function::Delayed => "delayed",
        Function::Angles => "angles",
    }
}
