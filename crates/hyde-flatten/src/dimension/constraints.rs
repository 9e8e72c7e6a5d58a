//! [`Dimensions`]: the constraints between dimensions, what they solve, and what is told where two disagree.

use super::{Dim, Unknown};
use crate::instance::InstanceId;
use crate::refusals::dimensions::{self as refused, short};
use crate::turns::{self, Said};
use hyde_diag::{Diagnostic, InstancePath, Span};
use hyde_ir::ExprId;
use hyde_units::{Agreement, Dimension};

/// Why two dimensions must agree.
#[derive(Clone, Debug)]
pub(crate) struct Demand {
    /// `+ adds`, `= equates`: as said in the message.
    pub(crate) what: &'static str,
    /// The two sides.
    pub(crate) spans: (Span, Span),
    /// In which instance: its names may repair it.
    pub(crate) instance: InstanceId,
    /// The sides are bare numbers without a unit.
    pub(crate) bare: (bool, bool),
    /// The bare numbers as written.
    pub(crate) written: (String, String),
    /// The sides as a repair may name them.
    pub(crate) said: (Said, Said),
    /// The two sides.
    pub(crate) sides: (ExprId, ExprId),
}

impl Demand {
    /// Whether only the second side is an expression: the first one is demanded or declared.
    fn has_one_side(&self) -> bool {
        let declared = [
            "the declared type and",
            "the measure and",
            "the parameter and",
            "the input and",
        ];
        self.spans.0 == self.spans.1 || declared.iter().any(|said| self.what.starts_with(said))
    }
}

/// The path of an instance, and its parameters with their dimensions: what a repair may name.
pub(crate) type InScope<'s> = &'s dyn Fn(InstanceId) -> (InstancePath, Vec<(String, Dim)>);

/// What disagrees, each with the two sides of it.
pub(crate) type Disagreements = Vec<(Diagnostic, (ExprId, ExprId))>;

/// All unknown dimensions and the constraints that wait for them.
#[derive(Default)]
pub(crate) struct Dimensions {
    solved: Vec<Option<Dimension>>,
    waiting: Vec<(Dim, Dim, Demand)>,
}

impl Dimensions {
    pub(crate) fn fresh(&mut self) -> Unknown {
        self.solved.push(None);
        self.solved.len() - 1
    }

    /// Demands that two dimensions agree.
    pub(crate) fn agree(
        &mut self,
        a: &Dim,
        b: &Dim,
        demand: Demand,
        in_scope: InScope<'_>,
    ) -> Option<Diagnostic> {
        if *a == Dim::Any || *b == Dim::Any {
            return None;
        }
        let (a, b) = (self.resolve(a), self.resolve(b));
        match (a.as_known(), b.as_known()) {
            (Some(a), Some(b)) => self.verdict(a, b, &demand, in_scope),
            _ => {
                self.waiting.push((a, b, demand));
                None
            }
        }
    }

    /// With every unknown that is solved by now put in.
    pub(crate) fn resolve(&self, dim: &Dim) -> Dim {
        let Dim::Of(known, unknowns) = dim else {
            return Dim::Any;
        };
        let mut result = Dim::known(*known);
        for &(unknown, exponent) in unknowns {
            let factor = match self.solved[unknown] {
                Some(dimension) => Dim::known(dimension).power(exponent).unwrap_or(Dim::Any),
                None => Dim::Of(Dimension::DIMENSIONLESS, vec![(unknown, exponent)]),
            };
            result = result.multiply(&factor);
        }
        result
    }

    /// Solves what the constraints determine, makes the rest pure numbers, and reports what disagrees.
    pub(crate) fn solve(&mut self, in_scope: InScope<'_>) -> Disagreements {
        let mut found = self.propagate(in_scope);
        while let Some(free) = self.first_free() {
            self.solved[free] = Some(Dimension::DIMENSIONLESS);
            found.extend(self.propagate(in_scope));
        }
        found
    }

    /// Solves for what is determined by what is known until now.
    pub(crate) fn propagate(&mut self, in_scope: InScope<'_>) -> Disagreements {
        let mut found = Vec::new();
        loop {
            let mut progress = false;
            for (a, b, demand) in std::mem::take(&mut self.waiting) {
                let Dim::Of(known, unknowns) = self.resolve(&a.divide(&b)) else {
                    continue;
                };
                match unknowns.as_slice() {
                    [] => {
                        progress = true;
                        let (a, b) = (self.resolve(&a), self.resolve(&b));
                        // Powers of the same unknown may have cancelled: compare what is left.
                        let (a, b) = match (a.as_known(), b.as_known()) {
                            (Some(a), Some(b)) => (a, b),
                            _ => (known, Dimension::DIMENSIONLESS),
                        };
                        let verdict = self.verdict(a, b, &demand, in_scope);
                        found.extend(verdict.map(|diagnostic| (diagnostic, demand.sides)));
                    }
                    [(unknown, exponent)] => {
                        progress = true;
                        let root = Dimension::DIMENSIONLESS.divide(known).root(*exponent);
                        self.solved[*unknown] = Some(root.unwrap_or(Dimension::DIMENSIONLESS));
                        match root {
                            Some(_) => self.waiting.push((a, b, demand)),
                            None => found
                                .push((refused::no_root(*exponent, demand.spans), demand.sides)),
                        }
                    }
                    _ => self.waiting.push((a, b, demand)),
                }
            }
            if !progress {
                return found;
            }
        }
    }

    /// The dimension of an unknown after [`Dimensions::solve`].
    pub(crate) fn solution(&self, unknown: Unknown) -> Dimension {
        self.solved[unknown].unwrap_or(Dimension::DIMENSIONLESS)
    }

    /// What is wrong with two dimensions that have to agree.
    fn verdict(
        &self,
        a: Dimension,
        b: Dimension,
        demand: &Demand,
        in_scope: InScope<'_>,
    ) -> Option<Diagnostic> {
        let (left, right) = demand.spans;
        match a.agreement(b) {
            Agreement::Same => None,
            Agreement::AngleDiffers => Some(refused::angle_differs(
                &disagreement(demand.what, a, b),
                (left, a),
                (right, b),
                &turns::repair(demand.what, a, b, &demand.said),
            )),
            Agreement::Different => {
                let (instance, names) = in_scope(demand.instance);
                let known =
                    |(name, dim): (String, Dim)| Some((name, self.resolve(&dim).as_known()?));
                let names: Vec<(String, Dimension)> = names.into_iter().filter_map(known).collect();
                Some(refused::dimensions_differ(
                    &disagreement(demand.what, a, b),
                    (left, a),
                    (right, b),
                    &instance,
                    repair(a, b, demand, &names),
                ))
            }
        }
    }

    fn first_free(&self) -> Option<Unknown> {
        self.waiting
            .iter()
            .find_map(|(a, b, _)| match self.resolve(&a.divide(b)) {
                Dim::Of(_, unknowns) => unknowns.first().map(|(unknown, _)| *unknown),
                Dim::Any => None,
            })
    }
}

/// `310` with its unit.
fn with_unit(number: &str, unit: &str) -> String {
    let single = number
        .chars()
        .all(|c| c.is_ascii_alphanumeric() || c == '.');
    if single {
        format!("give the number a unit: `{number} [{unit}]`")
    } else {
        format!("give its numbers a unit: `… [{unit}]`")
    }
}

/// What disagrees: two sides, or the value that is found where a dimension is demanded.
fn disagreement(what: &str, a: Dimension, b: Dimension) -> String {
    if what.ends_with("found") {
        format!("{what} {}", short(b))
    } else {
        format!("{what} {} and {}", short(a), short(b))
    }
}

/// What would make the only side that is an expression have the dimension `wanted`.
fn repair_of_value(
    wanted: Dimension,
    found: Dimension,
    demand: &Demand,
    names: &[(String, Dimension)],
) -> String {
    let ratio = wanted.divide(found);
    let same = |x: Dimension, y: Dimension| x.agreement(y) != Agreement::Different;
    let inverse = |d: Dimension| Dimension::DIMENSIONLESS.divide(d);
    let named = names.iter().filter(|(_, d)| !d.is_dimensionless());
    let factor = named.clone().find(|(_, d)| same(*d, ratio));
    let divisor = named.clone().find(|(_, d)| same(inverse(*d), ratio));
    let declared = match demand.what.starts_with("the measure") {
        true => format!("declare it in {}, or ", short(found)),
        false => String::new(),
    };
    if let Some((name, _)) = factor {
        return format!("multiply the value by `{name}`");
    }
    if let Some((name, _)) = divisor {
        return format!("divide the value by `{name}`");
    }
    if same(ratio, Dimension::TIME) {
        return format!("{declared}multiply the value by a time");
    }
    if same(ratio, inverse(Dimension::TIME)) {
        return format!("{declared}take its derivative, `der(…)`, or divide the value by a time");
    }
    if same(wanted.multiply(found), Dimension::DIMENSIONLESS) {
        return unit_of_number(wanted);
    }
    let twice = |d: Dimension| inverse(d).divide(d);
    let upside_down = named
        .clone()
        .find(|(_, d)| same(twice(*d), ratio) || same(inverse(twice(*d)), ratio));
    if let Some((name, _)) = upside_down {
        return reciprocal(name);
    }
    format!(
        "{declared}give the value in {}: a factor in {} is missing or redundant",
        short(wanted),
        short(ratio)
    )
}

/// `20/3 [N]` is read as 20/(3 [N]).
fn unit_of_number(wanted: Dimension) -> String {
    let unit = wanted.usual_unit();
    format!(
        "a unit belongs only to the number before it: write `20 [{unit}]/3`, not `20/3 [{unit}]`"
    )
}

fn reciprocal(name: &str) -> String {
    format!(
        "`{name}` is the reciprocal of the required dimension; a unit belongs only to the number before it: write `1 [UNIT]/3`, not `1/3 [UNIT]`"
    )
}

/// What would make the two sides agree.
fn repair(
    a: Dimension,
    b: Dimension,
    demand: &Demand,
    names: &[(String, Dimension)],
) -> Option<String> {
    if demand.bare.0 && a.is_dimensionless() {
        return Some(with_unit(&demand.written.0, &b.usual_unit()));
    }
    if demand.bare.1 && b.is_dimensionless() {
        return Some(with_unit(&demand.written.1, &a.usual_unit()));
    }
    let ratio = a.divide(b);
    let same = |x: Dimension, y: Dimension| x.agreement(y) != Agreement::Different;
    let turning =
        |x: Dimension, y: Dimension| same(x, Dimension::TIME) && same(y, Dimension::DIMENSIONLESS);
    if turning(a, b) || turning(b, a) {
        return Some(
            "multiply the time by a frequency, `2*pi*5 [Hz]*time`, or divide it by a time"
                .to_owned(),
        );
    }
    if demand.has_one_side() {
        return Some(repair_of_value(a, b, demand, names));
    }
    for (name, dimension) in names {
        if dimension.is_dimensionless() {
            continue;
        }
        if same(*dimension, ratio) {
            return Some(format!(
                "multiply the second by `{name}`, or divide the first by it"
            ));
        }
        if same(dimension.divide(*dimension).divide(*dimension), ratio) {
            return Some(format!(
                "multiply the first by `{name}`, or divide the second by it"
            ));
        }
    }
    if same(ratio, Dimension::TIME) {
        return Some("the second is a rate of the first: take `der(…)` of the first, or multiply the second by a time".to_owned());
    }
    if same(ratio, Dimension::DIMENSIONLESS.divide(Dimension::TIME)) {
        return Some("the first is a rate of the second: take `der(…)` of the second, or multiply the first by a time".to_owned());
    }
    if same(a.multiply(b), Dimension::DIMENSIONLESS) {
        return Some(unit_of_number(a));
    }
    // `1/3e-3 [rad/m]` is m/rad.
    let inverse = |d: Dimension| Dimension::DIMENSIONLESS.divide(d);
    let upside_down = names.iter().find(|(_, dimension)| {
        let twice = inverse(*dimension).divide(*dimension);
        !dimension.is_dimensionless() && (same(twice, ratio) || same(inverse(twice), ratio))
    });
    if let Some((name, _)) = upside_down {
        return Some(reciprocal(name));
    }
    Some(format!(
        "the first divided by the second is {}: a factor of that dimension is missing or redundant",
        short(ratio)
    ))
}
