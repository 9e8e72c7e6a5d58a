//! Figures that an experiment asks for: `figure lag = r - s, {guide.a.f, screw.F} over time in 0.8 [s] .. 1 [s] "title";`

use super::bode::shown_quantity;
use super::time::agree_time;
use crate::dimension::Dim;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::experiment as refused;
use hyde_ir::flat::{Curve, Figure, FigureKind};
use hyde_syntax::ast::{self, Argument, Expr, ExprKind};
use hyde_units::Dimension;

pub(super) fn lower_figure<'a>(
    model: &mut Model<'a, '_>,
    figure: &'a ast::Figure,
    root: InstanceId,
) {
    let name = &figure.name;
    let known = &mut model.flat.experiment.figures;
    if known.iter().any(|known| known.name == name.text) {
        model.report(refused::figure_twice(name));
        return;
    }
    let kind = match figure.panels.as_slice() {
        [only] if circle_of(only).is_some() => circle_figure(model, only, figure, root),
        panels => Some(lower_panels(model, panels, figure.over.as_ref(), root)),
    };
    let within = figure.within.as_ref().map(|within| {
        let scope = Scope::new(root, Setting::Parameter);
        let (from, to) = (
            model.value(&within.from, &scope),
            model.value(&within.to, &scope),
        );
        agree_time(model, &from, "a figure shows times, found", root);
        agree_time(model, &to, "a figure shows times, found", root);
        (from.id, to.id)
    });
    if let Some(kind) = kind {
        model.flat.experiment.figures.push(Figure {
            name: name.text.clone(),
            title: figure.doc.clone().unwrap_or_default(),
            kind,
            within,
        });
    }
}

/// Each expression a panel; the curves of a list share one.
fn lower_panels<'a>(
    model: &mut Model<'a, '_>,
    panels: &'a [Expr],
    over: Option<&'a Expr>,
    root: InstanceId,
) -> FigureKind {
    let panels = panels.iter().map(|panel| {
        let list = if let ExprKind::Array(list, None) = &panel.kind {
            list.as_slice()
        } else {
            std::slice::from_ref(panel)
        };
        if circle_of(panel).is_some() {
            model.report(refused::circle_among_panels(panel.span));
            return Vec::new();
        }
        let curves: Vec<(Curve, Typed)> = list.iter().map(|one| curve(model, one, root)).collect();
        for pair in curves.windows(2) {
            model.agree(&pair[0].1, &pair[1].1, "the curves of a panel are", root);
        }
        curves.into_iter().map(|(curve, _)| curve).collect()
    });
    let panels = panels.collect();
    FigureKind::Panels(panels, over.map(|over| curve(model, over, root).0))
}

/// `circle(x, y, R)`
fn circle_figure<'a>(
    model: &mut Model<'a, '_>,
    call: &'a Expr,
    figure: &'a ast::Figure,
    root: InstanceId,
) -> Option<FigureKind> {
    let arguments = circle_of(call)?;
    let positional = arguments.iter().all(|argument| argument.name.is_none());
    let [x, y, radius] = arguments else {
        model.report(refused::circle_takes_three(call.span));
        return None;
    };
    if !positional {
        model.report(refused::named_arguments_of_circle(call.span));
        return None;
    }
    if let Some(over) = &figure.over {
        model.report(refused::circle_over(over.span));
    }
    let (x, of_x) = curve(model, &x.value, root);
    let (y, of_y) = curve(model, &y.value, root);
    let radius = model.value(&radius.value, &Scope::new(root, Setting::Parameter));
    let length = Typed {
        dim: Dim::known(Dimension::LENGTH),
        ..of_x.clone()
    };
    for given in [&of_x, &of_y, &radius] {
        let length = Typed {
            span: given.span,
            ..length.clone()
        };
        model.agree(&length, given, "a circle has lengths, found", root);
    }
    Some(FigureKind::Circle([x, y], radius.id))
}

fn curve<'a>(model: &mut Model<'a, '_>, expr: &'a Expr, root: InstanceId) -> (Curve, Typed) {
    let scope = Scope {
        records: true,
        ..Scope::new(root, Setting::Report)
    };
    let typed = model.value(expr, &scope);
    let curve = Curve {
        name: hyde_syntax::format_expression(expr),
        value: typed.id,
        quantity: shown_quantity(model, &typed),
    };
    (curve, typed)
}

/// The arguments of `circle(…)`.
fn circle_of(expr: &Expr) -> Option<&[Argument]> {
    match &expr.kind {
        ExprKind::Call(function, arguments) if function.as_word() == Some("circle") => {
            Some(arguments)
        }
        ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => None,
    }
}
