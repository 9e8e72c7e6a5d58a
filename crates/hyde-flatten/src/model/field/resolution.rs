//! How many cells a domain needs: `fem(f_max = 500 [Hz])`.
//!
//! The equations of a domain are looked at where no end is near, with every derivative in time a factor s and every one in
//! space a factor i*k. With its bindings put in, an equation M = fluxes of one field becomes
//!
//! ```text
//! rho*Ip*der(w) = pder(q, x),  q = G*Ip*(pder(th, x) + tv*pder(w, x)),  w = der(th)
//! rho*Ip*s^2 + G*Ip*(1 + tv*s)*k^2 = 0
//! ```
//!
//! so that a motion of the frequency f has the wave number `|k| = sqrt(|m(s)/e(s)|)` at s = 2*pi*f*i: that of a wave, or
//! of what diffuses. Cells of the length h get the frequency of a wave wrong by `(k*h)^4/480` with `fem` and by
//! `(k*h)^2/24` with `fv` (the next term of their dispersion relations), and the ends of a bar do not add to that.

use crate::instance::{InstanceId, Scope, Setting};
use crate::model::Model;
use crate::refusals::fields as refused;
use hyde_diag::Span;
use hyde_syntax::ast::{
    self, Binary, Element, EquationKind, ExperimentItem, Expr, ExprKind, Reference, Unary,
};
use std::f64::consts::TAU;

/// What the frequency of a wave may be wrong by, at the highest frequency asked for.
const ACCURACY: f64 = 1e-3;
/// With fewer cells a place that moves would reach both ends; and with an even number the middle is a node.
const LEAST_CELLS: f64 = 4.0;
/// Frequency in Hz that `fem()` takes where no experiment asks for one: above the first waves of screws.
const USUAL_HZ: f64 = 2000.0;

/// How deep the bindings of fields may refer to each other.
const MAX_DEPTH: usize = 16;

/// The fields of a domain, with their bindings.
struct Waves<'a> {
    scope: Scope<'a>,
    domain: &'a ast::Domain,
    fields: Vec<(&'a str, Option<&'a Expr>)>,
}

/// `factor` times so many derivatives in time and in space of a field.
#[derive(Clone, Copy)]
struct Share<'a> {
    field: &'a str,
    time: u32,
    space: u32,
    factor: f64,
}

/// What stands in the way, and why; none where that was reported.
type Obstacle<'a> = Option<(&'a Expr, &'static str)>;

impl<'a> Model<'a, '_> {
    /// The cells for waves up to a frequency in Hz, from the equations of the domain among the elements of its model.
    /// `asked` is what asks for them.
    pub(crate) fn cells_for(
        &mut self,
        id: InstanceId,
        domain: &'a ast::Domain,
        elements: &[&'a Element],
        averaged: bool,
        (f_max, asked): (f64, Span),
    ) -> Option<i64> {
        let waves = Waves {
            scope: Scope::new(id, Setting::Parameter),
            domain,
            fields: fields(domain, elements),
        };
        let from = self.structural_number(&waves.scope, &domain.range.from)?;
        let to = self.structural_number(&waves.scope, &domain.range.to)?;
        let mut largest = 0.0_f64;
        for (lhs, rhs) in equations(domain, elements) {
            match self.wave_number(&waves, lhs, rhs, f_max) {
                Ok(k) => largest = largest.max(k),
                Err(obstacle) => {
                    let (expr, why) = obstacle?;
                    let name = &domain.name.text;
                    self.report(refused::unknown_wave_speed(name, (expr.span, why), asked));
                    return None;
                }
            }
        }
        let longest = if averaged {
            (480.0 * ACCURACY).sqrt().sqrt()
        } else {
            (24.0 * ACCURACY).sqrt()
        };
        // Rounding does not add a cell.
        let pairs = (0.5 * largest * (to - from).abs() / longest - 1e-9).ceil();
        Some((2.0 * pairs).max(LEAST_CELLS) as i64)
    }

    /// The highest frequency in Hz that the experiment asks for, in its frequency responses and swept sines.
    pub(crate) fn highest_frequency(&mut self) -> f64 {
        let name = self.input.experiment;
        let Some(experiment) = name.and_then(|name| self.names.own_experiment(name)) else {
            return USUAL_HZ;
        };
        let mut asked: Vec<&'a Expr> = Vec::new();
        for item in &experiment.items {
            match item {
                ExperimentItem::Bode(bode) => asked.push(&bode.band.to),
                ExperimentItem::Margins(margins) => {
                    asked.extend(margins.band.as_ref().map(|band| &band.to));
                }
                ExperimentItem::Stimulus(drives) => {
                    drives
                        .iter()
                        .for_each(|drive| sweeps(&drive.value, &mut asked));
                }
                ExperimentItem::Measured(_)
                | ExperimentItem::Replay(_)
                | ExperimentItem::Expect(..)
                | ExperimentItem::Measure(_)
                | ExperimentItem::Solve(..)
                | ExperimentItem::Start(_)
                | ExperimentItem::Stop(_)
                | ExperimentItem::Every(_)
                | ExperimentItem::Skip(_)
                | ExperimentItem::Figure(_)
                | ExperimentItem::Budget(_) => {}
            }
        }
        let scope = Scope::new(0, Setting::Parameter);
        let mut highest = 0.0_f64;
        for expr in asked {
            highest = highest.max(self.structural_number(&scope, expr).unwrap_or(0.0));
        }
        if highest > 0.0 { highest } else { USUAL_HZ }
    }

    /// The wave number of an equation at a frequency; 0 where nothing in it depends on the place.
    fn wave_number(
        &mut self,
        waves: &Waves<'a>,
        lhs: &'a Expr,
        rhs: &'a Expr,
        f_max: f64,
    ) -> Result<f64, Obstacle<'a>> {
        let mut terms = self.terms(waves, lhs, 0)?;
        let right = self.terms(waves, rhs, 0)?;
        terms.extend(right.into_iter().map(|term| scaled(term, -1.0)));
        if terms.iter().all(|term| term.space == 0) {
            return Ok(0.0);
        }
        if terms.iter().any(|term| term.field != terms[0].field) {
            return Err(Some((lhs, "the equation couples fields")));
        }
        if terms.iter().any(|term| !matches!(term.space, 0 | 2)) {
            return Err(Some((rhs, "this term transports the field (convection)")));
        }
        let s = TAU * f_max;
        let size = |space: u32| {
            let (mut real, mut imaginary) = (0.0, 0.0);
            for term in terms.iter().filter(|term| term.space == space) {
                let value = term.factor * s.powi(term.time as i32);
                match term.time % 4 {
                    0 => real += value,
                    1 => imaginary += value,
                    2 => real -= value,
                    _ => imaginary -= value,
                }
            }
            f64::hypot(real, imaginary)
        };
        let k = (size(0) / size(2)).sqrt();
        if k.is_finite() {
            Ok(k)
        } else {
            Err(Some((rhs, "no term couples neighbouring points")))
        }
    }

    /// An expression of fields as a sum of terms. What has no field in it drives the waves and does not change them.
    fn terms(
        &mut self,
        waves: &Waves<'a>,
        expr: &'a Expr,
        depth: usize,
    ) -> Result<Vec<Share<'a>>, Obstacle<'a>> {
        let not_linear = Some((expr, "is not linear in the fields"));
        if !waves.has_field(expr) {
            return Ok(Vec::new());
        }
        if depth > MAX_DEPTH {
            return Err(Some((expr, "the bindings go in a circle")));
        }
        match &expr.kind {
            ExprKind::Reference(name) => {
                let field = waves.field(name);
                match field.ok_or(not_linear)? {
                    (_, Some(binding)) => self.terms(waves, binding, depth + 1),
                    (field, None) => Ok(vec![Share {
                        field,
                        time: 0,
                        space: 0,
                        factor: 1.0,
                    }]),
                }
            }
            ExprKind::Call(function, arguments) => {
                let (time, space) = match function.as_word() {
                    Some("der") => (1, 0),
                    Some("pder") => (0, 1),
                    _ => return Err(not_linear),
                };
                let of = &arguments.first().ok_or(not_linear)?.value;
                let mut terms = self.terms(waves, of, depth)?;
                for term in &mut terms {
                    term.time += time;
                    term.space += space;
                }
                Ok(terms)
            }
            ExprKind::Unary(Unary::Positive, inner) => self.terms(waves, inner, depth),
            ExprKind::Unary(Unary::Negative, inner) => {
                let terms = self.terms(waves, inner, depth)?;
                Ok(terms.into_iter().map(|term| scaled(term, -1.0)).collect())
            }
            ExprKind::Binary(operator @ (Binary::Add | Binary::Sub), left, right) => {
                let sign = if *operator == Binary::Sub { -1.0 } else { 1.0 };
                let mut terms = self.terms(waves, left, depth)?;
                let right = self.terms(waves, right, depth)?;
                terms.extend(right.into_iter().map(|term| scaled(term, sign)));
                Ok(terms)
            }
            ExprKind::Binary(Binary::Mul, left, right) => {
                let (factor, of) = if waves.has_field(left) {
                    (right, left)
                } else {
                    (left, right)
                };
                let factor = self.factor(waves, factor)?;
                let terms = self.terms(waves, of, depth)?;
                Ok(terms.into_iter().map(|term| scaled(term, factor)).collect())
            }
            ExprKind::Binary(Binary::Div, left, right) => {
                let factor = 1.0 / self.factor(waves, right)?;
                let terms = self.terms(waves, left, depth)?;
                Ok(terms.into_iter().map(|term| scaled(term, factor)).collect())
            }
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Unary(Unary::Not, _)
            | ExprKind::Binary(..)
            | ExprKind::If(..)
            | ExprKind::Array(..)
            | ExprKind::Comprehension(_)
            | ExprKind::Slice(..) => Err(not_linear),
        }
    }

    /// The value of a factor of parameters.
    fn factor(&mut self, waves: &Waves<'a>, expr: &'a Expr) -> Result<f64, Obstacle<'a>> {
        if waves.has_field(expr) {
            return Err(Some((expr, "is not linear in the fields")));
        }
        if waves.has_coordinate(expr) {
            return Err(Some((expr, "varies along the domain")));
        }
        self.structural_number(&waves.scope, expr).ok_or(None)
    }
}

impl<'a> Waves<'a> {
    fn field(&self, name: &Reference) -> Option<(&'a str, Option<&'a Expr>)> {
        let word = name.as_word()?;
        self.fields
            .iter()
            .copied()
            .find(|(field, _)| *field == word)
    }

    fn has_field(&self, expr: &Expr) -> bool {
        expr.any(&|expr| {
            let by_name =
                matches!(&expr.kind, ExprKind::Reference(name) if self.field(name).is_some());
            // `th.at(x)` reads a field by the first part of its name.
            let at_a_place = matches!(&expr.kind, ExprKind::Call(name, _) if name.parts.len() > 1);
            by_name || at_a_place
        })
    }

    fn has_coordinate(&self, expr: &Expr) -> bool {
        let coordinate = Some(self.domain.coordinate.text.as_str());
        expr.any(
            &|expr| matches!(&expr.kind, ExprKind::Reference(name) if name.as_word() == coordinate),
        )
    }
}

fn scaled(term: Share<'_>, factor: f64) -> Share<'_> {
    Share {
        factor: factor * term.factor,
        ..term
    }
}

/// The fields on a domain.
fn fields<'a>(
    domain: &'a ast::Domain,
    elements: &[&'a Element],
) -> Vec<(&'a str, Option<&'a Expr>)> {
    let mut found = Vec::new();
    for element in elements {
        let Element::Declaration(declaration) = element else {
            continue;
        };
        for declarator in &declaration.declarators {
            let on = declarator.domain.as_ref();
            if on.is_some_and(|on| on.text == domain.name.text) {
                found.push((declarator.name.text.as_str(), declarator.binding.as_ref()));
            }
        }
    }
    found
}

/// Both sides of the equations that hold everywhere on a domain.
fn equations<'a>(domain: &ast::Domain, elements: &[&'a Element]) -> Vec<(&'a Expr, &'a Expr)> {
    let mut found = Vec::new();
    for element in elements {
        let Element::Equation(equation) = element else {
            continue;
        };
        if let EquationKind::Equality {
            lhs,
            rhs,
            place: Some(place),
        } = &equation.kind
            && place.end.is_none()
            && place.domain.text == domain.name.text
        {
            found.push((lhs, rhs));
        }
    }
    found
}

/// The last frequency of every `chirp(time, from, to, T)` in an expression.
fn sweeps<'a>(expr: &'a Expr, found: &mut Vec<&'a Expr>) {
    if let ExprKind::Call(name, arguments) = &expr.kind
        && name.as_word() == Some("chirp")
        && let Some(to) = arguments.get(2)
    {
        found.push(&to.value);
    }
    expr.children()
        .into_iter()
        .for_each(|child| sweeps(child, found));
}
