//! The table of the figures that an experiment asks for: which outputs their curves are.

use hyde_ir::flat;
use hyde_program::{Curve, Figure, FigureKind};

/// How many outputs the curves are, one each.
pub(crate) fn outputs(figures: &[flat::Figure]) -> usize {
    figures.iter().flat_map(flat::Figure::curves).count()
}

/// The table, the first output given.
pub(crate) fn figures(figures: &[flat::Figure], first: usize) -> Vec<Figure> {
    let mut next = first;
    let mut take = |curve: &flat::Curve| {
        next += 1;
        Curve {
            name: curve.name.clone(),
            output: next - 1,
        }
    };
    let table = figures.iter().map(|figure| Figure {
        name: figure.name.clone(),
        title: figure.title.clone(),
        kind: match &figure.kind {
            flat::FigureKind::Panels(panels, over) => {
                let mut panel = |curves: &Vec<flat::Curve>| curves.iter().map(&mut take).collect();
                let panels = panels.iter().map(&mut panel).collect();
                FigureKind::Panels(panels, over.as_ref().map(&mut take))
            }
            flat::FigureKind::Circle([x, y], _) => {
                let x = take(x);
                FigureKind::Circle([x, take(y)])
            }
        },
    });
    table.collect()
}
