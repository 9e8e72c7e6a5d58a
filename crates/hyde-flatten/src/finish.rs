//! The end of flatten: dimensions that are still unknown, quantities for printing, parameters in order.

use crate::dimension::Dim;
use crate::instance::Lowering;
use crate::model::Model;
use hyde_diag::{Code, Diagnostic};
use hyde_ir::{Expr as Ir, Id as _, ParamId, Quantity};
use hyde_units::Dimension;

impl Model<'_, '_> {
    /// Completes the flat model.
    pub(crate) fn finish(&mut self) {
        self.flat.declared = self
            .instances
            .iter()
            .map(|instance| (instance.path.clone(), instance.span))
            .collect();
        self.report_undriven();
        self.solve_dimensions();
        for id in self.flat.variables.ids().collect::<Vec<_>>() {
            let dimension = self.dimension(&self.variables[id.index()].dim.clone());
            let known = self.flat.variables[id].quantity.clone();
            self.flat.variables[id].quantity = settled(known, dimension);
        }
        self.report_units_in_names();
        for id in self.flat.parameters.ids().collect::<Vec<_>>() {
            let dimension = self.dimension(&self.parameters[id.index()].dim.clone());
            let known = self.flat.parameters[id].quantity.clone();
            self.flat.parameters[id].quantity = settled(known, dimension);
        }
        self.order_parameters();
    }

    fn dimension(&self, dim: &Dim) -> Dimension {
        let Dim::Of(known, unknowns) = dim else {
            return Dimension::DIMENSIONLESS;
        };
        unknowns
            .iter()
            .fold(*known, |product, &(unknown, exponent)| {
                let factor = self.dimensions.solution(unknown).power(exponent);
                product.multiply(factor.unwrap_or(Dimension::DIMENSIONLESS))
            })
    }

    /// Orders parameters so that each comes after those its value uses.
    fn order_parameters(&mut self) {
        let mut state = vec![Lowering::Waiting; self.flat.parameters.len()];
        for id in self.flat.parameters.ids() {
            self.visit(id, &mut state);
        }
    }

    fn circle(&self, circle: &[ParamId]) -> Diagnostic {
        let names: Vec<String> = circle
            .iter()
            .map(|&id| format!("`{}`", self.flat.parameters[id].name))
            .collect();
        let message = match names.as_slice() {
            [only] => format!("the value of {only} uses itself"),
            several => format!("the values of {} use each other", several.join(", ")),
        };
        let mut diagnostic = Diagnostic::error(Code::Cycle, message);
        for (number, &id) in circle.iter().enumerate() {
            let next = &names[(number + 1) % names.len()];
            let span = self.flat.parameters[id].origin.span;
            diagnostic = diagnostic.label(span, format!("uses {next}"));
        }
        diagnostic.help("give one of them a number")
    }

    fn visit(&mut self, root: ParamId, state: &mut [Lowering]) {
        let mut stack = vec![(root, false)];
        while let Some((id, left)) = stack.pop() {
            if left {
                state[id.index()] = Lowering::Done;
                self.flat.parameter_order.push(id);
                continue;
            }
            match state[id.index()] {
                Lowering::Done => continue,
                Lowering::InProgress => {
                    let circle = stack
                        .iter()
                        .filter(|(_, entered)| *entered)
                        .map(|(id, _)| *id)
                        .skip_while(|&on_the_way| on_the_way != id);
                    let diagnostic = self.circle(&circle.collect::<Vec<_>>());
                    self.report(diagnostic);
                    continue;
                }
                Lowering::Waiting => state[id.index()] = Lowering::InProgress,
            }
            stack.push((id, true));
            let values = self.flat.parameters[id].value.clone();
            for below in self.flat.exprs.below(&values) {
                if let Ir::Param(used, _) = self.flat.exprs[below]
                    && state[used.index()] != Lowering::Done
                {
                    stack.push((used, false));
                }
            }
        }
    }
}

/// The quantity chosen for printing if it fits the dimension, else the usual unit.
fn settled(known: Quantity, dimension: Dimension) -> Quantity {
    let agrees = known.dimension.agreement(dimension) != hyde_units::Agreement::Different;
    if agrees && known.unit.text() != "1" {
        known
    } else {
        Quantity::usual(dimension)
    }
}
