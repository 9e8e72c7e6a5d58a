//! [`LawShape`]s: the functions with a signature, of which laws from records are made.
//!
//! ```text
//! function falling "an exponential decrease with {v} over {vs}"           LawShape
//!   input Velocity v, v_max;                                                inputs [v, v_max, vs]
//!   input Velocity vs = {0.01, 0.1, 1}*v_max in 0 .. 2*v_max;               constants [vs]
//!   output Real f(cost = 2) = exp(-noEvent(abs(v))/vs) over (slip);         outputs [f], roles [slip], cost 2
//!   signature velocity;                                                     mark velocity
//! end falling;
//! ```
//! Each input is a variable, so that values, ranges and outputs are lowered, and their units checked, as those of any
//! function.

mod attributes;
mod draft;
mod filter;
mod text;

use crate::dimension::Dim;
use crate::instance::{Elementwise, Position, Typed};
use crate::instantiate::quantity;
use crate::law_roles::{Refusal, wrong};
use crate::law_sites::full_name;
use crate::model::Model;
use crate::names::{FileIndex, TypeName};
use crate::refusals::laws as refused;
use attributes::{attributes_of_output, constant_of_shape};
use draft::{Draft, Mark, READ_IN, every_role};
use filter::filters;
use hyde_diag::{FileId, MadeBy, Span};
use hyde_ir::{
    Expr as Ir, ExprArena, ExprId, FlatModel, Id as _, Index, LawAxis, LawConstant, LawInput,
    LawShape, VarId, VariableKind,
};
use hyde_syntax::ast::{
    Class, ClassBody, ClassKind, Declaration, Declarator, Element, Equation, Expr, File, Item,
    Prefix,
};
use hyde_units::Dimension;
use std::sync::Arc;
use text::text_in_shape;

/// The shapes that the files declare; those that are declared wrongly are reported.
pub(crate) fn law_shapes(model: &mut Model<'_, '_>) -> Vec<LawShape> {
    let mut found = Vec::new();
    for (file, class, marks) in marked(model.input.files) {
        match law_shape(model, file, class, marks) {
            Ok(shape) => found.push(shape),
            Err(Some(diagnostic)) => model.report(*diagnostic),
            Err(None) => {}
        }
    }
    found
}

fn law_shape<'a>(
    model: &mut Model<'a, '_>,
    file: FileIndex,
    class: &'a Class,
    marks: &'a [Mark],
) -> Result<LawShape, Refusal> {
    let mut draft = Draft {
        file,
        class,
        shape: LawShape {
            name: full_name(model.input, file, class),
            words: class.doc.clone().unwrap_or_default(),
            roles: Vec::new(),
            exprs: ExprArena::new(),
            inputs: Vec::new(),
            constants: Vec::new(),
            states: Vec::new(),
            outputs: Vec::new(),
            mark: (String::new(), None),
            cost: 0,
            few: None,
        },
        variables: Vec::new(),
        names: Vec::new(),
        locals: Vec::new(),
        axes: Vec::new(),
        declared: Vec::new(),
        equations: Vec::new(),
    };
    for (declaration, declarator) in elements(class, &mut draft.equations)? {
        if declaration.prefixes.contains(&Prefix::Output) {
            draft.roles(declarator)?;
        }
        declared_in_shape(model, &mut draft, declaration, declarator)?;
    }
    if draft.shape.roles.is_empty() {
        return Err(wrong(refused::shape_without_role(
            &class.name,
            &every_role(),
        )));
    }
    for number in 0..draft.declared.len() {
        constant_of_shape(model, &mut draft, number)?;
    }
    filters(model, &mut draft)?;
    draft.shape.mark = draft.mark(marks)?;
    Ok(finished(&model.flat, draft))
}

/// Reads a declaration of a shape.
fn declared_in_shape<'a>(
    model: &mut Model<'a, '_>,
    draft: &mut Draft<'a>,
    declaration: &'a Declaration,
    declarator: &'a Declarator,
) -> Result<(), Refusal> {
    let name = declarator.name.text.as_str();
    let span = declarator.name.span;
    let has = |prefix| declaration.prefixes.contains(&prefix);
    let Some(kind) = model.names.quantity(draft.file, &declaration.type_name) else {
        let unknown = model.names.unknown(draft.file, &declaration.type_name);
        return Err(Some(Box::new(unknown)));
    };
    let dim = match kind {
        TypeName::Real => Dim::NUMBER,
        TypeName::Integer | TypeName::Boolean | TypeName::Quantity(..) => {
            quantity(model, kind, None).0
        }
    };
    let dimension = dim.as_known().unwrap_or(Dimension::DIMENSIONLESS);
    match (&declarator.binding, has(Prefix::Input)) {
        (None, true) => {
            let Some(input) = LawInput::named(name) else {
                return Err(wrong(refused::constant_without_value(&declarator.name)));
            };
            if let LawInput::Variable(axis)
            | LawInput::Round(axis)
            | LawInput::Least(axis)
            | LawInput::Greatest(axis) = input
            {
                // A signal may have any unit: no constant has that of it.
                if axis != LawAxis::Signal {
                    draft.axes.push((axis, dimension));
                }
            }
            input_of_shape(model, draft, name, input, (dim, span));
        }
        (Some(values), true) => {
            let values = values_of_constant(model, draft, values, &typed_as(model, &dim, span));
            draft.shape.constants.push(LawConstant {
                name: name.to_owned(),
                unit: draft.unit(dimension),
                step: hyde_ir::LawStep::Ratio(values[0]),
                range: [values[0]; 2],
                limits: [values[0]; 2],
                values,
            });
            let number = draft.declared.len();
            draft.declared.push(declarator);
            input_of_shape(model, draft, name, LawInput::Constant(number), (dim, span));
        }
        (None, false) => {
            let state = draft.state(declarator, dimension);
            input_of_shape(model, draft, name, state, (dim, span));
        }
        (Some(value), false) => {
            let typed = in_shape(model, draft, value, &typed_as(model, &dim, span));
            if has(Prefix::Output) {
                let text = text_in_shape(model, draft, value, typed.id)?;
                draft.shape.outputs.push((name.to_owned(), text));
                attributes_of_output(model, draft, declarator)?;
            }
            draft.locals.push((name, value));
            draft.names.push((name, Typed { dim, ..typed }));
        }
    }
    Ok(())
}

/// Adds an input to a shape.
fn input_of_shape<'a>(
    model: &mut Model<'a, '_>,
    draft: &mut Draft<'a>,
    name: &'a str,
    input: LawInput,
    (dim, span): (Dim, Span),
) {
    let kind = VariableKind::Continuous;
    let made_by = MadeBy::Source;
    let var = model.add_variable(READ_IN, name.to_owned(), kind, dim.clone(), span, made_by);
    let id = model.flat.exprs.var(var);
    draft.variables.push(var);
    draft.shape.inputs.push(input);
    draft.names.push((name, model.typed(id, dim, span)));
}

/// The values of a constant that are tried: of a list each one.
fn values_of_constant<'a>(
    model: &mut Model<'a, '_>,
    draft: &Draft<'a>,
    values: &'a Expr,
    declared: &Typed,
) -> Vec<ExprId> {
    let scope = draft.scope();
    let Some(count) = model.array_length(values, &scope) else {
        return vec![in_shape(model, draft, values, declared).id];
    };
    let each = (0..count.max(1)).map(|at| {
        let position = Position { at, of: count };
        let value = model.lower(values, &scope.elements(Elementwise::One(position)));
        model.agree(
            declared,
            &value,
            "the declared type and the value are",
            READ_IN,
        );
        value.id
    });
    each.collect()
}

/// A value within a shape.
fn in_shape<'a>(
    model: &mut Model<'a, '_>,
    draft: &Draft<'a>,
    value: &'a Expr,
    declared: &Typed,
) -> Typed {
    let typed = model.lower(value, &draft.scope());
    model.agree(
        declared,
        &typed,
        "the declared type and the value are",
        READ_IN,
    );
    typed
}

/// A quantity of a dimension that is not yet known by its value.
fn typed_as(model: &Model<'_, '_>, dim: &Dim, span: Span) -> Typed {
    model.typed(ExprId::from_index(0), dim.clone(), span)
}

/// The shape with its expressions in an arena of its own.
fn finished<'a>(flat: &FlatModel, draft: Draft<'a>) -> LawShape {
    let Draft {
        mut shape,
        variables,
        ..
    } = draft;
    let mut roots = Vec::new();
    shape.each_expression(&mut |id| roots.push(*id));
    let number = |var: VarId| variables.iter().position(|known| *known == var);
    let (exprs, copies) = flat.exprs.copied(&roots, |leaf| {
        let number = leaf.access().and_then(|(var, ..)| number(var));
        number.map_or(leaf, |number| {
            Ir::Var(VarId::from_index(number), Index::SCALAR)
        })
    });
    let mut copies = copies.into_iter();
    shape.each_expression(&mut |id| *id = copies.next().unwrap_or(*id));
    shape.exprs = exprs;
    shape
}

/// The functions with a signature, in the order of the files.
fn marked(files: &[(FileId, Arc<File>)]) -> Vec<(FileIndex, &Class, &[Mark])> {
    let mut found = Vec::new();
    for (file, (_, tree)) in files.iter().enumerate() {
        for item in &tree.items {
            if let Item::Class(class) = item
                && class.kind == ClassKind::Function
                && let ClassBody::Long { elements, .. } = &class.body
            {
                let marks = elements.iter().find_map(|element| {
                    if let Element::Signature(marks) = element {
                        Some(marks.as_slice())
                    } else {
                        None
                    }
                });
                found.extend(marks.map(|marks| (file, class, marks)));
            }
        }
    }
    found
}

/// The declarations of a shape; its equations are added to `equations`.
fn elements<'a>(
    class: &'a Class,
    equations: &mut Vec<&'a Equation>,
) -> Result<Vec<(&'a Declaration, &'a Declarator)>, Refusal> {
    let mut found = Vec::new();
    let ClassBody::Long { elements, .. } = &class.body else {
        return Ok(found);
    };
    for element in elements {
        if let Element::Declaration(declaration) = element {
            found.extend(declaration.declarators.iter().map(|d| (declaration, d)));
        } else if let Element::Equation(equation) = element {
            equations.push(equation);
        } else if !matches!(element, Element::Signature(_)) {
            return Err(wrong(refused::not_in_a_shape(&class.name)));
        }
    }
    Ok(found)
}
