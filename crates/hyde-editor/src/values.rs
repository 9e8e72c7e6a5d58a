//! What a place means in numbers: the value of a parameter with its spread and source, the dimension of an expression.

use crate::analysis::Analysis;
use crate::before::word_start;
use crate::describe;
use crate::occurrences::Occurrence;
use crate::scope::Thing;
use hyde_compiler::{FUNCTIONS, Meaning, MeaningOf, Prior, Quantity, ValueOf, usage};
use hyde_units::{engineering_difference, format_value, significant};
use std::ops::Range;

/// The most values of one name that are shown.
const SHOWN: usize = 4;

/// Lines about a name: the parameters whose value is given or read there, and the unit that the equations give to what is
/// declared without one.
pub(crate) fn of_name(analysis: &Analysis, found: &Occurrence<'_>) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for meaning in analysis.meanings_at(found.span.start as usize) {
        for parameter in parameters(&meaning, found) {
            let line = line_of(parameter);
            if let Some(line) = line.filter(|line| !lines.contains(line)) {
                lines.push(line);
            }
        }
        if lines.is_empty()
            && let Some(quantity) = found_unit(analysis, &meaning, found)
        {
            lines.push(format!(
                "unit found from the equations: {}",
                unit(&quantity)
            ));
        }
    }
    if lines.len() > SHOWN {
        let more = lines.len() - SHOWN;
        lines.truncate(SHOWN);
        lines.push(format!("… and {more} more"));
    }
    lines
}

/// The parameters that a name at a place gives a value to, or else means.
fn parameters<'m>(meaning: &'m Meaning, found: &Occurrence<'_>) -> Vec<&'m ValueOf> {
    let here = |span: hyde_diag::Span| {
        span.file == found.span.file && span.end == found.span.end && span.start <= found.span.start
    };
    let given = meaning.parameters.iter().filter(|own| here(own.span));
    let given: Vec<&ValueOf> = given.collect();
    if !given.is_empty() {
        return given;
    }
    let read = meaning.expressions.iter().filter(|own| here(own.span));
    let names = read.filter_map(|own| own.parameter.as_ref());
    let all = names.filter_map(|name| meaning.parameters.iter().find(|own| own.name == *name));
    all.collect()
}

/// `saddle.M` = 250 kg ±8%, from data sheet
fn line_of(own: &ValueOf) -> Option<String> {
    let value = |value: &f64| match own.boolean {
        true => (*value != 0.0).to_string(),
        false => format_value(*value, &own.quantity.unit),
    };
    let mut values: Vec<String> = own.values.iter().take(6).map(value).collect();
    if values.is_empty() {
        return None;
    }
    if own.values.len() > values.len() {
        values.push("…".to_owned());
    }
    let spread = match own.prior {
        None => String::new(),
        Some(Prior::Relative(part)) => format!(" ±{}%", significant(100.0 * part, 3)),
        Some(Prior::Absolute(spread)) => {
            let spread = engineering_difference(spread, &own.quantity.unit);
            format!(" ±{spread}")
        }
    };
    let source = own.source.as_ref();
    let source = source.map_or_else(String::new, |source| format!(", from {source}"));
    let values = values.join(", ");
    Some(format!("`{}` = {values}{spread}{source}", own.name))
}

/// The unit of what is declared without one.
pub(crate) fn found_unit(
    analysis: &Analysis,
    meaning: &Meaning,
    found: &Occurrence<'_>,
) -> Option<Quantity> {
    let definition = found.meaning?;
    let Thing::Variable(declaration, _) = definition.thing else {
        return None;
    };
    if describe::unit(analysis, definition.file, &declaration.type_name).is_some() {
        return None;
    }
    if found.declares {
        return declared(meaning, found.span);
    }
    let mut here = meaning.expressions.iter();
    let here =
        here.find(|own| own.span.end == found.span.end && own.span.start <= found.span.start);
    here?.quantity.clone().filter(has_unit)
}

/// The unit of what is declared at a place, the same in every instance.
pub(crate) fn declared(meaning: &Meaning, span: hyde_diag::Span) -> Option<Quantity> {
    let variables = meaning.variables.iter();
    let variables = variables
        .filter(|(own, _)| *own == span)
        .map(|(_, own)| own);
    let parameters = meaning.parameters.iter();
    let parameters = parameters
        .filter(|own| own.span == span && !own.boolean)
        .map(|own| &own.quantity);
    let mut all = variables.chain(parameters);
    let first = all.next()?;
    (has_unit(first) && all.all(|own| own.unit == first.unit)).then(|| first.clone())
}

/// Whether a quantity is not a pure number.
fn has_unit(quantity: &Quantity) -> bool {
    quantity.unit.text() != "1"
}

/// The smallest expression at a byte with its unit, its value if it has one, and the call if it is a function of the language.
pub(crate) fn of_expression(analysis: &Analysis, byte: usize) -> Option<(Range<usize>, String)> {
    let text = analysis.text();
    let mut smallest: Option<MeaningOf> = None;
    for meaning in analysis.meanings_at(byte) {
        for own in &meaning.expressions {
            let holds = (own.span.start as usize) <= byte && byte <= own.span.end as usize;
            // What ends at the byte is meant only where nothing else is there.
            let size = |own: &MeaningOf| {
                let length = own.span.end - own.span.start;
                (own.span.end as usize == byte, length)
            };
            let smaller = |known: &MeaningOf| size(own) < size(known);
            if holds && smallest.as_ref().is_none_or(smaller) {
                smallest = Some(own.clone());
            }
        }
    }
    let call = call_at(text, byte);
    let (bytes, mut lines) = match (&smallest, &call) {
        (Some(own), _) => (own.span.start as usize..own.span.end as usize, Vec::new()),
        (None, Some((bytes, _))) => (bytes.clone(), Vec::new()),
        (None, None) => return None,
    };
    lines.extend(call.map(|(_, call)| format!("```hyde\n{call}\n```")));
    if let Some(own) = smallest
        && let Some(quantity) = &own.quantity
    {
        let value = own.value.filter(|_| !is_literal(text, &bytes));
        let value = value.map(|value| format!(" = {}", format_value(value, &quantity.unit)));
        let written = text.get(bytes.clone()).unwrap_or_default();
        let written: Vec<&str> = written.split_whitespace().collect();
        let written = written.join(" ");
        let unit = unit(quantity);
        lines.push(format!(
            "`{written}`{}  \nunit {unit}",
            value.unwrap_or_default()
        ));
    }
    (!lines.is_empty()).then(|| (bytes, lines.join("\n\n")))
}

/// A number with its unit.
fn is_literal(text: &str, bytes: &Range<usize>) -> bool {
    let text = text.get(bytes.clone()).unwrap_or_default();
    let number = text.split('[').next().unwrap_or_default().trim();
    number.parse::<f64>().is_ok()
}

/// How the function of the language is called whose name stands at a byte.
fn call_at(text: &str, byte: usize) -> Option<(Range<usize>, String)> {
    let start = word_start(text.get(..byte)?);
    let rest = text.get(start..)?;
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let end = rest.find(|c| !word(c)).unwrap_or(rest.len());
    let name = &rest[..end];
    let called = rest[end..].trim_start().starts_with('(');
    if !called || text[..start].ends_with('.') || !FUNCTIONS.contains(&name) {
        return None;
    }
    Some((start..start + end, call_of(name)))
}

/// How a function of the language is called.
pub(crate) fn call_of(name: &str) -> String {
    usage(name).map_or_else(|| format!("{name}(x)"), str::to_owned)
}

/// The unit in which a quantity is read, and its base units.
fn unit(quantity: &Quantity) -> String {
    if quantity.dimension.is_dimensionless() && !has_unit(quantity) {
        return "1: a pure number".to_owned();
    }
    let (unit, base) = (quantity.unit.text(), quantity.dimension.base_units());
    match unit == base {
        true => format!("`{unit}`"),
        false => format!("`{unit}` ({base})"),
    }
}
