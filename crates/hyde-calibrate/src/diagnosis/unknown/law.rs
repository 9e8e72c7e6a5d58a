//! [`Law`]: a sum of products of shapes at a site, and its text as an effect of the language.

use super::factor::{Constant, Factor};
use super::latent::Carrier;
use super::seen::Seen;
use super::site::{Site, Written};
use crate::diagnosis::{Hypothesis, Knob};
use hyde_ir::LawAxis;
use hyde_units::{Dimension, NamedUnit, significant};
use std::fmt::Write as _;

/// A product of shapes with one size, or as many as its shapes have values: of a wave two.
#[derive(Clone, Debug, PartialEq)]
pub struct Summand {
    /// Its shapes; none is a constant.
    pub factors: Vec<Factor>,
    /// Its sizes, SI.
    pub sizes: Vec<f64>,
}

/// A law at a site.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// Where it acts.
    pub site: Site,
    /// Its terms.
    pub terms: Vec<Summand>,
    /// What the records show of the site.
    pub seen: Seen,
}

impl Summand {
    pub(crate) fn new(factors: &[Factor]) -> Self {
        let sizes = factors.iter().map(|factor| factor.values().len());
        Self {
            factors: factors.to_vec(),
            sizes: vec![0.0; sizes.product()],
        }
    }

    /// Constants of all its shapes.
    pub(crate) fn constants(&self) -> Vec<f64> {
        let factors = self.factors.iter();
        factors.flat_map(Factor::constants).copied().collect()
    }

    pub(crate) fn with(&self, constants: &[f64]) -> Self {
        let mut rest = constants;
        let factors = self.factors.iter().map(|factor| {
            let (own, others) = rest.split_at(factor.constants().len());
            rest = others;
            factor.with(own)
        });
        Self {
            factors: factors.collect(),
            sizes: self.sizes.clone(),
        }
    }

    /// Its course along a record a unit of each size.
    pub(crate) fn along(&self, carrier: &Carrier, seen: &Seen) -> Vec<Vec<f64>> {
        let mut lists = vec![vec![1.0; carrier.course.time.len()]];
        for factor in &self.factors {
            let own = factor.along(&carrier.course, seen);
            lists = own
                .iter()
                .flat_map(|one| {
                    lists.iter().map(move |list| {
                        let pairs = list.iter().zip(one);
                        pairs.map(|(a, b)| a * b).collect::<Vec<f64>>()
                    })
                })
                .collect();
        }
        lists
    }
}

impl Law {
    /// Number of sizes and constants.
    #[must_use]
    pub fn freedoms(&self) -> usize {
        let terms = self.terms.iter();
        terms
            .map(|term| term.sizes.len() + term.constants().len())
            .sum()
    }

    /// What it is a function of beside place, speed and time, with the greatest magnitude that records show, SI.
    #[must_use]
    pub fn of_more(&self) -> Vec<(String, f64)> {
        let all = [
            (
                LawAxis::Acceleration,
                "acceleration".to_owned(),
                self.seen.acceleration,
            ),
            (LawAxis::Signal, self.site.kind.signal(), self.seen.signal),
        ];
        let read = all.into_iter().filter(|(axis, ..)| self.reads(*axis));
        read.map(|(_, name, most)| (name, most)).collect()
    }

    /// Whether it is a function of a variable of its site, beside others.
    fn reads(&self, axis: LawAxis) -> bool {
        let mut factors = self.terms.iter().flat_map(|term| &term.factors);
        factors.any(|factor| factor.reads(axis))
    }

    /// The law with other values: sizes, then constants, in the order of its terms.
    pub(crate) fn with(&self, values: &[f64]) -> Self {
        let count: usize = self.terms.iter().map(|term| term.sizes.len()).sum();
        let (mut sizes, mut constants) = values.split_at(count.min(values.len()));
        let terms = self.terms.iter().map(|term| {
            let own;
            (own, sizes) = sizes.split_at(term.sizes.len().min(sizes.len()));
            let shapes;
            (shapes, constants) = constants.split_at(term.constants().len().min(constants.len()));
            Summand {
                sizes: own.to_vec(),
                ..term.with(shapes)
            }
        });
        Self {
            terms: terms.collect(),
            ..self.clone()
        }
    }

    /// The law as an effect of that name, and what a search may vary of it. Sizes are declared 0, where the effect is
    /// nothing, or with their values.
    pub(crate) fn written(&self, name: &str, with_sizes: bool) -> (Written, Hypothesis) {
        let kind = &self.site.kind;
        let scales = self.seen.scales();
        let mut text = String::new();
        let (mut sizes, mut shapes) = (Vec::new(), Vec::new());
        let (mut declared, mut equations) = (String::new(), String::new());
        let mut sum: Vec<String> = Vec::new();
        let mut used = [false; 5];
        let mut signature: Vec<String> = Vec::new();
        let mut taken = kind.taken.clone();
        let single = self.terms.len() == 1;
        let unit = &kind.value;
        for (number, term) in self.terms.iter().enumerate() {
            let mut products = vec![String::new()];
            let mut endings = vec![String::new()];
            for factor in &term.factors {
                let mut names = Vec::new();
                for constant in factor.written(kind, &self.seen) {
                    let own = taken.free(&constant.stem);
                    let _ = writeln!(
                        text,
                        "  shape Real {own} = {} in {};",
                        quantity(constant.value, &constant),
                        range(&constant)
                    );
                    shapes.push(knob(&own, &constant));
                    names.push(own);
                }
                let (variable, equation) = factor.equations(kind, &names);
                declared.push_str(&variable);
                equations.push_str(&equation);
                for (used, own) in used.iter_mut().zip(factor.scales()) {
                    *used |= own;
                }
                let mark = factor.mark(kind, &names);
                if !signature.contains(&mark) {
                    signature.push(mark);
                }
                let own = factor.expressions(kind, &names);
                products = own
                    .iter()
                    .flat_map(|one| {
                        products.iter().map(move |product| match one.as_str() {
                            "1" => product.clone(),
                            one => format!("{product}*{one}"),
                        })
                    })
                    .collect();
                let values = factor.values();
                endings = values
                    .iter()
                    .flat_map(|value| endings.iter().map(move |ending| format!("{ending}{value}")))
                    .collect();
            }
            for (which, (product, ending)) in products.iter().zip(&endings).enumerate() {
                let mut own = kind.size.clone();
                if !single {
                    let _ = write!(own, "{}", number + 1);
                }
                own.push_str(ending);
                let value = term.sizes.get(which).copied().unwrap_or(0.0);
                let most = up(20.0
                    * value
                        .abs()
                        .max(term.sizes.iter().fold(0.0, |m, s| f64::max(m, s.abs()))));
                let _ = writeln!(
                    text,
                    "  size Real {own} = {} [{unit}] in {} .. {} [{unit}];",
                    significant(if with_sizes { value } else { 0.0 }, 6),
                    significant(-most, 3),
                    significant(most, 3)
                );
                sizes.push(Knob {
                    name: own.clone(),
                    value: 0.0,
                    range: (-most, most),
                    integer: false,
                    unit: unit.clone(),
                });
                sum.push(format!("{own}{product}"));
            }
        }
        let second = NamedUnit::usual(Dimension::TIME);
        let of = |axis| kind.named(axis).map(|own| (&own.round, &own.unit));
        let units = [
            (of(LawAxis::Speed), scales.speed),
            (of(LawAxis::Place), scales.place),
            (of(LawAxis::Acceleration), scales.acceleration),
            (of(LawAxis::Signal), scales.signal),
            (Some((&kind.round_time, &second)), scales.time),
        ];
        for ((named, value), _) in units.iter().zip(used).filter(|(_, used)| *used) {
            let Some((own, unit)) = named else { continue };
            let _ = writeln!(
                text,
                "  parameter Real {own} = {} [{unit}] \"only a unit for the sizes\";",
                significant(unit.unit().from_si(*value), 3)
            );
        }
        text.push_str(&declared);
        let mut law = sum.join(" + ");
        if kind.is_grip() && sum.len() > 1 {
            law = format!("({law})");
        }
        text.push_str(&kind.clauses(&law, &|axis| self.reads(axis)));
        let recurs = signature
            .iter()
            .any(|mark| mark.starts_with("position(") || mark.starts_with("angle"));
        if signature.is_empty() {
            signature.push("offset".to_owned());
        }
        let _ = writeln!(text, "  signature {};", signature.join(", "));
        if !equations.is_empty() {
            let _ = write!(text, "equation\n{equations}");
        }
        let text = format!(
            "effect {name} on {} \"found in records, in no library\"\n{text}end {name};\n",
            kind.host
        );
        let written = Written {
            name: name.to_owned(),
            text,
            site: self.site.path.clone(),
        };
        let hypothesis = Hypothesis {
            effect: name.to_owned(),
            site: self.site.path.clone(),
            aliases: self.site.aliases.clone(),
            sizes,
            shapes,
            periodic: None,
            resonant: None,
            recurs,
        };
        (written, hypothesis)
    }
}

fn knob(name: &str, constant: &Constant) -> Knob {
    Knob {
        name: name.to_owned(),
        value: constant.value,
        range: constant.range,
        integer: false,
        unit: constant.unit.clone(),
    }
}

fn quantity(value: f64, constant: &Constant) -> String {
    let number = significant(constant.unit.unit().from_si(value), 6);
    match constant.unit.text() {
        "1" => number,
        unit => format!("{number} [{unit}]"),
    }
}

fn range(constant: &Constant) -> String {
    let number = |value: f64| significant(constant.unit.unit().from_si(value), 6);
    let (low, high) = (number(constant.range.0), number(constant.range.1));
    match constant.unit.text() {
        "1" => format!("{low} .. {high}"),
        unit => format!("{low} .. {high} [{unit}]"),
    }
}

/// A round number above.
fn up(value: f64) -> f64 {
    let power = 10.0_f64.powf(value.max(1e-9).log10().floor());
    power * (value / power).ceil()
}
