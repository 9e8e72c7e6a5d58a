//! Shapes: explicit arrays whose elements all read the same few scalars, as the weights of a place that moves along a field do.
//!
//! An equation that reads a shape reads many of its elements. With the definitions put in, its derivative would be the sum of as
//! many derivatives of a definition. So the derivatives of a shape are arrays of their own, explicit ones that only
//! derivatives read, and the chain rule goes through them:
//! ```text
//! weights[i] = f(x - i);  F = sum(weights[i]*q[i])
//!     d weights/d x[i] = f'(x - i);  F by x: sum(d weights/d x[i]*q[i])
//! ```

use crate::partials::{Pieces, wrt};
use hyde_ir::dae::{Dae, Definition, Place, Space, Wrt};
use hyde_ir::{Expr, ExprArena, ExprId, Range, VarId};
use std::collections::BTreeMap;

/// More values than the components of a drive have connectors, fewer than a field has nodes.
pub(crate) const A_FEW: usize = 8;

/// The derivatives of each shape: by what, and the array that has them.
pub(crate) type Slopes = BTreeMap<VarId, Vec<(Wrt, VarId)>>;

/// Defines the derivatives of all shapes among the definitions.
pub(crate) fn define_slopes(dae: &mut Dae, definitions: &Pieces) -> Slopes {
    let mut shapes: Vec<VarId> = definitions.keys().copied().collect();
    shapes.sort_unstable();
    shapes.retain(|&var| {
        dae.variables[var].len.is_some()
            && definitions[&var]
                .values()
                .all(|piece| is_shape(&dae.exprs, piece.range, piece.value))
    });
    let mut slopes = Slopes::new();
    for shape in shapes {
        let mut of_pieces = Vec::new();
        let mut all: Vec<(Wrt, Expr)> = Vec::new();
        for piece in definitions[&shape].values() {
            let gradient = dae.exprs.gradient(piece.value, is_leaf);
            let known: Vec<(Wrt, Expr, ExprId)> = gradient
                .into_iter()
                .filter_map(|(leaf, slope)| Some((wrt(dae, leaf)?, leaf, slope)))
                .collect();
            for &(by, leaf, _) in &known {
                if all.iter().all(|(other, _)| *other != by) {
                    all.push((by, leaf));
                }
            }
            of_pieces.push((piece.clone(), known));
        }
        let arrays = all.into_iter().map(|(by, leaf)| {
            let array = array_of_slopes(dae, shape, leaf);
            for (piece, known) in &of_pieces {
                let own = known.iter().find(|(other, ..)| *other == by);
                let value = own.map_or_else(|| dae.exprs.constant(0.0), |(.., slope)| *slope);
                dae.definitions.push(Definition {
                    var: array,
                    value,
                    slope: true,
                    ..piece.clone()
                });
            }
            (by, array)
        });
        let arrays = arrays.collect();
        slopes.insert(shape, arrays);
    }
    slopes
}

/// Whether a value is that of more than a few elements, all of which read the same variables.
pub(crate) fn is_shape(exprs: &ExprArena, range: Range, value: ExprId) -> bool {
    let all = exprs.below(&[value]);
    let mut read = all.into_iter().filter_map(|id| exprs[id].access());
    range.len() > A_FEW && read.all(|(_, index, _)| index.stride == 0)
}

/// What derivatives are by.
pub(crate) fn is_leaf(expr: Expr) -> bool {
    matches!(expr, Expr::Var(..) | Expr::Der(..) | Expr::Time)
}

/// A new array with the elements of a shape.
fn array_of_slopes(dae: &mut Dae, shape: VarId, by: Expr) -> VarId {
    let mut variable = dae.variables[shape].clone();
    let by = match by.access() {
        Some((var, index, derivative)) => {
            let element = usize::try_from(index.offset).unwrap_or(0);
            let name = dae.variables[var].element_name(element);
            if derivative {
                format!("der({name})")
            } else {
                name
            }
        }
        None => "time".to_owned(),
    };
    variable.name = format!("d {}/d {by}", variable.name);
    let place = Place {
        space: Space::Work,
        base: dae.n_work,
    };
    dae.n_work += variable.size();
    dae.places.push(Some(place));
    dae.variables.push(variable)
}

/// The derivatives of a row: those by the elements of shapes become those by what the shapes read.
pub(crate) fn through_shapes(
    dae: &mut Dae,
    gradient: Vec<(Expr, ExprId)>,
    slopes: &Slopes,
) -> Vec<(Wrt, ExprId)> {
    let mut found: Vec<(Wrt, ExprId)> = Vec::new();
    for (leaf, derivative) in gradient {
        let shape = leaf.access().and_then(|(var, index, derivative)| {
            let arrays = slopes.get(&var).filter(|_| !derivative)?;
            Some((index, arrays))
        });
        let Some((index, arrays)) = shape else {
            found.extend(wrt(dae, leaf).map(|by| (by, derivative)));
            continue;
        };
        for &(by, array) in arrays {
            let slope = dae.exprs.add(Expr::Var(array, index));
            let term = dae.exprs.times(derivative, slope);
            match found.iter_mut().find(|(other, _)| *other == by) {
                Some((_, sum)) => *sum = dae.exprs.plus(*sum, term),
                None => found.push((by, term)),
            }
        }
    }
    found
}
