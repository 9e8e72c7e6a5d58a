//! [`Meaning`]: what the expressions and parameters of a file are, for an editor: dimension, unit, value, spread, source.

use crate::dimension::constraints::Dimensions;
use crate::input::Input;
use crate::instance::{ParameterNotes, Typed};
use crate::shown::quantity_of;
use hyde_diag::{FileId, Span};
use hyde_ir::{Expr as Ir, ExprId, FlatModel, Id as _, ParamId, Prior, Quantity};
use std::collections::BTreeMap;

/// What a file means as a part of one model.
#[derive(Clone, Debug, Default)]
pub struct Meaning {
    /// The expressions, in the order of their places; of those below others each one too.
    pub expressions: Vec<MeaningOf>,
    /// The parameters of the model, in its order.
    pub parameters: Vec<ValueOf>,
    /// The variables that the file declares, by the place of their name, one for each instance; and those that the compiler
    /// makes, by the place they are made for.
    pub variables: Vec<(Span, Quantity)>,
    /// The variables of all files with their full names, by the place of the name in the declaration: one for each instance.
    pub names: Vec<(Span, String)>,
}

/// What an expression is.
#[derive(Clone, Debug)]
pub struct MeaningOf {
    /// Its place.
    pub span: Span,
    /// Its dimension and the unit it is read in; none of a truth, of a literal 0, and where several instances disagree.
    pub quantity: Option<Quantity>,
    /// Its value in SI, where it is made of numbers and parameters and is the same in all instances.
    pub value: Option<f64>,
    /// The full name, where it is the name of a parameter and means the same one in all instances.
    pub parameter: Option<String>,
}

/// A parameter with the value that it has in the model.
#[derive(Clone, Debug)]
pub struct ValueOf {
    /// Its full name.
    pub name: String,
    /// Where its value is given: the name in a declaration, or the target of a modification.
    pub span: Span,
    /// Its values, SI; empty where they are not known.
    pub values: Vec<f64>,
    /// Whether it is true or false.
    pub boolean: bool,
    /// Its dimension and the unit it is read in.
    pub quantity: Quantity,
    /// Its spread.
    pub prior: Option<Prior>,
    /// Where the number comes from.
    pub source: Option<String>,
}

/// An expression as it was lowered once.
pub(crate) struct Lowered {
    span: Span,
    typed: Typed,
}

/// The values of parameters, by element; empty where one is not known.
type Values = BTreeMap<ParamId, Vec<f64>>;

/// Notes an expression of the first file, if somebody asks for them.
pub(crate) fn note(
    lowered: &mut Option<Vec<Lowered>>,
    input: &Input<'_>,
    span: Span,
    typed: &Typed,
) {
    let first = input.files.first().map(|(id, _)| *id);
    if let Some(lowered) = lowered
        && first == Some(span.file)
    {
        lowered.push(Lowered {
            span,
            typed: typed.clone(),
        });
    }
}

/// What was noted, once dimensions are known and parameters are in order; `first` is the first file.
pub(crate) fn meaning(
    lowered: &[Lowered],
    flat: &FlatModel,
    notes: &[ParameterNotes<'_>],
    dimensions: &Dimensions,
    first: Option<FileId>,
) -> Meaning {
    let values = parameter_values(flat, notes);
    let mut found: BTreeMap<(u32, u32), MeaningOf> = BTreeMap::new();
    for lowered in lowered {
        let own = meaning_of(lowered, flat, dimensions, &values);
        let key = (own.span.start, own.span.end);
        match found.get_mut(&key) {
            None => drop(found.insert(key, own)),
            Some(known) => known.keep_common(own),
        }
    }
    let parameters = flat.parameters.enumerate();
    let parameters = parameters.filter(|(_, own)| !own.derived);
    let parameters = parameters.map(|(id, own)| ValueOf {
        name: own.name.clone(),
        span: own.origin.span,
        values: values.get(&id).cloned().unwrap_or_default(),
        boolean: notes[id.index()].boolean,
        quantity: own.quantity.clone(),
        prior: own.prior,
        source: own.source.clone(),
    });
    let names = flat.variables.iter();
    let names = names.map(|own| (own.origin.span, own.name.clone()));
    let variables = flat.variables.iter();
    let variables = variables
        .filter(|own| Some(own.origin.span.file) == first && !own.boolean)
        .map(|own| (own.origin.span, own.quantity.clone()));
    Meaning {
        variables: variables.collect(),
        names: names.collect(),
        parameters: parameters.collect(),
        expressions: found.into_values().collect(),
    }
}

fn meaning_of(
    lowered: &Lowered,
    flat: &FlatModel,
    dimensions: &Dimensions,
    values: &Values,
) -> MeaningOf {
    let typed = &lowered.typed;
    let dimension = dimensions.resolve(&typed.dim).as_known();
    let declared = quantity_of(flat, typed.id).cloned();
    let quantity = dimension.filter(|_| !typed.truth).map(|dimension| {
        let declared = declared
            .filter(|own| own.dimension.agreement(dimension) != hyde_units::Agreement::Different);
        declared.unwrap_or_else(|| Quantity::usual(dimension))
    });
    let mut parameter = None;
    if let Ir::Param(param, _) = flat.exprs[typed.id] {
        parameter = Some(&flat.parameters[param]).filter(|own| !own.derived);
    }
    MeaningOf {
        span: lowered.span,
        value: quantity
            .as_ref()
            .and_then(|_| constant_value(flat, typed.id, values)),
        quantity,
        parameter: parameter.map(|own| own.name.clone()),
    }
}

/// The values of all parameters, each after those that it uses.
fn parameter_values(flat: &FlatModel, notes: &[ParameterNotes<'_>]) -> Values {
    let mut known = Values::new();
    for &id in &flat.parameter_order {
        let own = &flat.parameters[id];
        if own.found || notes[id.index()].binding.is_none() {
            continue;
        }
        let all = own
            .value
            .iter()
            .map(|&value| constant_value(flat, value, &known));
        if let Some(all) = all.collect::<Option<Vec<f64>>>() {
            known.insert(id, all);
        }
    }
    known
}

/// The value of an expression that is made of numbers and known parameters.
fn constant_value(flat: &FlatModel, id: ExprId, values: &Values) -> Option<f64> {
    let leaf = |leaf: Ir| {
        let Ir::Param(param, index) = leaf else {
            return Err(());
        };
        let own = values.get(&param).filter(|_| index.stride == 0).ok_or(())?;
        let at = usize::try_from(index.offset).map_err(drop)?;
        match own.as_slice() {
            [only] => Ok(*only),
            several => several.get(at).copied().ok_or(()),
        }
    };
    let value = flat.exprs.evaluate(id, leaf).ok()?;
    value.is_finite().then_some(value)
}

impl MeaningOf {
    /// Keeps what is the same in another instance.
    fn keep_common(&mut self, other: Self) {
        if self.quantity != other.quantity {
            self.quantity = None;
        }
        if self.value != other.value {
            self.value = None;
        }
        if self.parameter != other.parameter {
            self.parameter = None;
        }
    }
}
