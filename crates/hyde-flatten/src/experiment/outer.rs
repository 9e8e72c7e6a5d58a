//! Parameters of an experiment that its model does not declare.

use crate::dimension::Dim;
use crate::instance::ParameterNotes;
use crate::model::Model;
use hyde_diag::Origin;
use hyde_ir::{Expr as Ir, ExprId, Parameter, Quantity};

/// A parameter that the model does not declare, for what drives it from outside.
pub(super) fn outer_parameter(
    model: &mut Model<'_, '_>,
    name: String,
    dim: Dim,
    quantity: Quantity,
    value: ExprId,
    origin: &Origin,
) -> ExprId {
    model.parameters.push(ParameterNotes::made(dim));
    let parameter = Parameter::new(name, value, quantity, origin.clone());
    let param = model.flat.parameters.push(parameter);
    model.flat.experiment.free.push(param);
    let parameter = Ir::Param(param, hyde_ir::Index::SCALAR);
    model.flat.exprs.add(parameter)
}
