//! [`Layout`]: from what is written to inputs and factors: every name looked up, every unit checked.

use super::draft::{Choice, Draft, Fill, Varying, Written, path};
use super::plan::{Factor, Input, Model, Values};
use super::sample::{Points, SOBOL_LIMITS, Sampling};
use crate::refusals::sweeps as refused;
use hyde_diag::{Diagnostic, Span};
use hyde_program::{Given, Parameter, Prior};
use hyde_units::{Agreement, Kind};

/// So many values of a range are written out.
const LISTED: f64 = 12.0;

/// A plan in the making.
pub(super) struct Layout<'m> {
    model: &'m Model<'m>,
    pub(super) inputs: Vec<Input>,
    pub(super) factors: Vec<Factor>,
    /// Input, its bounds and its place in the block.
    ranges: Vec<(usize, f64, f64, Span)>,
}

impl<'m> Layout<'m> {
    /// Lays a draft out for a model.
    pub(super) fn of(draft: &Draft, model: &'m Model<'m>) -> Result<Self, Diagnostic> {
        let mut layout = Self {
            model,
            inputs: Vec::new(),
            factors: Vec::new(),
            ranges: Vec::new(),
        };
        for varying in &draft.varying {
            layout.add(draft, varying)?;
        }
        layout.fill(draft)?;
        Ok(layout)
    }

    fn add(&mut self, draft: &Draft, varying: &Varying) -> Result<(), Diagnostic> {
        match varying {
            Varying::Choice(choice) => {
                let input = self.choice(choice);
                let count = choice.options.len();
                self.factors.push(Factor {
                    inputs: vec![input],
                    values: Values::Options,
                    count,
                });
            }
            Varying::List(target, values) => {
                let name = path(target);
                let (input, parameter) = self.number(&name, target.span)?;
                for value in values {
                    check(value, &name, parameter)?;
                }
                let values: Vec<f64> = values.iter().map(|value| value.value).collect();
                self.list(input, values);
            }
            Varying::Range(target, from, to) => {
                let name = path(target);
                let (input, parameter) = self.number(&name, target.span)?;
                check(from, &name, parameter)?;
                check(to, &name, parameter)?;
                let ends = (from.value, to.value);
                self.range(draft, input, ends, (parameter.allowed.kind, target.span))?;
            }
            Varying::Uncertain(span) => {
                let mut found = false;
                for parameter in &self.model.program.parameters {
                    let Some(prior) = parameter.prior else {
                        continue;
                    };
                    if parameter.structural || parameter.is_final {
                        continue;
                    }
                    for element in 0..parameter.len {
                        let name = parameter.element_name(element);
                        if self.inputs.iter().any(|input| input.name == name) {
                            continue;
                        }
                        let value = self.model.parameters[parameter.place + element];
                        let spread = match prior {
                            Prior::Relative(part) => (value * part).abs(),
                            Prior::Absolute(spread) => spread,
                        };
                        let input = self.input(name, parameter);
                        let ends = (value - spread, value + spread);
                        self.range(draft, input, ends, (parameter.allowed.kind, *span))?;
                        found = true;
                    }
                }
                if !found {
                    return Err(refused::nothing_uncertain(*span));
                }
            }
            Varying::Cases(span) => self.cases(*span)?,
        }
        Ok(())
    }

    fn choice(&mut self, choice: &Choice) -> usize {
        self.inputs.push(Input {
            name: choice.name.clone(),
            unit: None,
            structural: true,
            options: choice.options.clone(),
        });
        self.inputs.len() - 1
    }

    /// A new input for the parameter of that name.
    fn number(&mut self, name: &str, span: Span) -> Result<(usize, &'m Parameter), Diagnostic> {
        let program = self.model.program;
        let Some((parameter, _)) = program.parameter(name) else {
            let last = name.rsplit('.').next().unwrap_or(name);
            let known = program.parameters.iter().map(|p| p.name.as_str());
            let near: Vec<&str> = known
                .filter(|known| known.rsplit('.').next() == Some(last))
                .take(3)
                .collect();
            return Err(refused::no_parameter(name, span, &near));
        };
        if parameter.is_whole(name) {
            return Err(refused::whole_array(name, parameter.len, span));
        }
        if parameter.is_final {
            return Err(refused::final_parameter(name, span, parameter.origin.span));
        }
        if self.inputs.iter().any(|input| input.name == name) {
            return Err(refused::varies_twice(name, span));
        }
        Ok((self.input(name.to_owned(), parameter), parameter))
    }

    fn input(&mut self, name: String, parameter: &Parameter) -> usize {
        self.inputs.push(Input {
            name,
            unit: Some(parameter.unit.clone()),
            structural: parameter.structural,
            options: Vec::new(),
        });
        self.inputs.len() - 1
    }

    fn list(&mut self, input: usize, values: Vec<f64>) {
        let count = values.len();
        self.factors.push(Factor {
            inputs: vec![input],
            values: Values::Lists(vec![values]),
            count,
        });
    }

    /// A range; in a grid a list of points from end to end.
    fn range(
        &mut self,
        draft: &Draft,
        input: usize,
        (from, to): (f64, f64),
        (kind, span): (Kind, Span),
    ) -> Result<(), Diagnostic> {
        let before = self.ranges.len();
        self.ranges.push((input, from, to, span));
        if let Some((Fill::Grid(counts), _)) = &draft.fill {
            let count = counts.get(before).or(counts.last()).copied().unwrap_or(1);
            let step = (to - from) / (count.max(2) - 1) as f64;
            let points = (0..count).map(|k| {
                if k + 1 == count && k > 0 {
                    to
                } else {
                    from + k as f64 * step
                }
            });
            let points: Vec<f64> = points.collect();
            self.are_values_of(input, kind, &points, (from, to), span)?;
            self.list(input, points);
            return Ok(());
        }
        // A plan fills the whole range, between whole numbers too.
        let between = [0.5];
        self.are_values_of(input, kind, &between, (from, to), span)
    }

    /// Whether all points of a range are values that its parameter may have: an Integer has whole numbers alone.
    fn are_values_of(
        &self,
        input: usize,
        kind: Kind,
        points: &[f64],
        ends: (f64, f64),
        span: Span,
    ) -> Result<(), Diagnostic> {
        let name = &self.inputs[input].name;
        match kind {
            Kind::Real => Ok(()),
            Kind::Boolean => Err(refused::range_of_boolean(name, span)),
            Kind::Integer if points.iter().all(|point| point.fract() == 0.0) => Ok(()),
            Kind::Integer => Err(refused::fractions_of_integer(name, &whole(ends), span)),
        }
    }

    /// The ranges that are sampled together, as the last factor.
    fn fill(&mut self, draft: &Draft) -> Result<(), Diagnostic> {
        let Some(&(.., first)) = self.ranges.first() else {
            return match &draft.fill {
                None => Ok(()),
                Some((_, span)) => Err(refused::plan_without_range(*span)),
            };
        };
        match &draft.fill {
            None => Err(refused::ranges_without_plan(first)),
            Some((Fill::Grid(counts), span)) => {
                if counts.len() > 1 && counts.len() != self.ranges.len() {
                    let ranges = self.ranges.len();
                    return Err(refused::counts_of_grid(counts.len(), ranges, *span));
                }
                Ok(())
            }
            Some((Fill::Sampled(how, count), span)) => {
                let (most, dimensions) = SOBOL_LIMITS;
                if *how == Sampling::Sobol && (*count > most || self.ranges.len() > dimensions) {
                    return Err(refused::long_sobol_sequence(SOBOL_LIMITS, *span));
                }
                if let Some((input, .., span)) = self
                    .ranges
                    .iter()
                    .find(|(input, ..)| self.inputs[*input].structural)
                {
                    let name = &self.inputs[*input].name;
                    return Err(refused::samples_structure(name, *span));
                }
                let seed = self.model.seed.unwrap_or(draft.seed);
                let ranges = self.ranges.iter().enumerate();
                let values = ranges
                    .map(|(dimension, (_, from, to, _))| {
                        (*from, *to, Points::new(*how, seed, dimension, *count))
                    })
                    .collect();
                self.factors.push(Factor {
                    inputs: self.ranges.iter().map(|(input, ..)| *input).collect(),
                    values: Values::Ranges(values),
                    count: *count,
                });
                Ok(())
            }
        }
    }

    /// A table: each row a case, each column a parameter.
    fn cases(&mut self, span: Span) -> Result<(), Diagnostic> {
        let table = self
            .model
            .cases
            .ok_or_else(|| refused::missing_table(span))?;
        let (mut inputs, mut lists) = (Vec::new(), Vec::new());
        for column in table.columns() {
            let (input, parameter) = self.number(column.name(), span)?;
            for &value in column.values() {
                check(
                    &Written {
                        value,
                        unit: column.unit().cloned(),
                        truth: false,
                        span,
                    },
                    column.name(),
                    parameter,
                )?;
            }
            inputs.push(input);
            lists.push(column.values().to_vec());
        }
        self.factors.push(Factor {
            inputs,
            values: Values::Lists(lists),
            count: table.rows(),
        });
        Ok(())
    }
}

/// The whole numbers of a range as a list; of a long one the first of them.
fn whole((from, to): (f64, f64)) -> String {
    let (least, most) = (from.min(to).ceil(), from.max(to).floor());
    let count = if most < least {
        0.0
    } else {
        most - least + 1.0
    };
    let numbers = (0..count.min(LISTED) as usize).map(|k| (least + k as f64).to_string());
    let mut numbers: Vec<String> = numbers.collect();
    if count > LISTED {
        numbers.push("…".to_owned());
    }
    format!("{{{}}}", numbers.join(", "))
}

/// Whether a number fits a parameter.
fn check(written: &Written, name: &str, parameter: &Parameter) -> Result<(), Diagnostic> {
    let given = Given {
        value: written.value,
        unit: written.unit.as_ref(),
        truth: written.truth,
    };
    let Some(misfit) = parameter.misfit(&given) else {
        return Ok(());
    };
    let other = written.unit.as_ref().is_some_and(|unit| {
        unit.unit().dimension.agreement(parameter.dimension) != Agreement::Same
    });
    let refuse = match other {
        true => refused::other_dimension,
        false => refused::misfit,
    };
    let declared = (parameter.origin.span, &*parameter.unit.to_string());
    Err(refuse(
        (name, &misfit.reason),
        written.span,
        declared,
        misfit.help(),
    ))
}
