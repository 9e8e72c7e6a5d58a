//! Equations of the model's sections: equalities, `for`, `if`, `when`, `assert`, in the scope of their instance.
//!
//! A `for` equation stays one equation over a range where every subscript is affine in its counter and names an element
//! of an array; otherwise (components, products of counters) it is unrolled. An `if` whose condition is made of
//! parameters alone chooses its branch here and makes them structural; any other becomes one equation with the
//! branches inside.

mod branch;
mod event;
mod kind;
mod range;
mod unroll;

pub(crate) use event::lower_action;
pub(crate) use kind::lower_equation;
pub(crate) use unroll::can_unroll;

use crate::experiment::add_measure;
use crate::instance::{InstanceId, Scope, Setting};
use crate::model::Model;
use crate::modes::lower_modes;
use hyde_ir::flat::ClockedEquation;
use hyde_syntax::ast::{self, Element, EquationKind};

/// Lowers the equations, modes and events of every instance.
pub(crate) fn lower_equations(model: &mut Model<'_, '_>) {
    for id in model.tree.ids() {
        let clock = model.clock_of(id);
        let setting = if clock.is_some() {
            Setting::Clocked
        } else {
            Setting::Equation
        };
        let scope = Scope::new(id, setting);
        for (_, element) in model.tree[id].elements.clone() {
            match element {
                Element::Equation(equation) | Element::Add(equation) => {
                    let list = lower_equation(model, equation, &scope);
                    match clock {
                        Some(clock) => {
                            let list = list
                                .into_iter()
                                .map(|equation| ClockedEquation { clock, equation });
                            model.flat.clocked_equations.extend(list);
                        }
                        None => model.flat.equations.extend(list),
                    }
                }
                Element::InitialEquation(equation) => {
                    let list = lower_equation(model, equation, &scope);
                    model.flat.initial_equations.extend(list);
                }
                Element::Modes(modes) => lower_modes(model, modes, id),
                Element::Measure(measure) if model.tree[id].parent.is_none() => {
                    lower_measure(model, measure, id)
                }
                Element::Measure(_)
                | Element::Account(..)
                | Element::Extends(..)
                | Element::Declaration(_)
                | Element::Domain(_)
                | Element::Discretize(_)
                | Element::Clocked(_)
                | Element::Wrap(..)
                | Element::Replace(..)
                | Element::Signature(_)
                | Element::Confounds(_) => {}
            }
        }
    }
}

/// Finds the end fluxes that field equations need, before anything reads them.
pub(crate) fn make_traces_of_equations(model: &mut Model<'_, '_>) {
    for id in model.tree.ids() {
        for (_, element) in model.tree[id].elements.clone() {
            if let Element::Equation(ast::Equation {
                kind:
                    EquationKind::Equality {
                        lhs,
                        rhs,
                        place: Some(place),
                    },
                span,
            }) = element
                && place.end.is_none()
            {
                model.traces_of(lhs, rhs, place, &Scope::new(id, Setting::Equation), *span);
            }
        }
    }
}

/// A measure declared in the model itself.
fn lower_measure<'a>(model: &mut Model<'a, '_>, measure: &'a ast::Measure, id: InstanceId) {
    let scope = Scope::new(id, Setting::Measure);
    add_measure(model, measure, &scope);
}
