//! What goes between the brackets at a place: parameters of a component, arguments of a function.

use crate::analysis::Analysis;
use crate::before::{chain_words, open_brackets};
use crate::describe;
use crate::place::Place;
use crate::scope::{Inside, Thing};
use crate::values::call_of;
use hyde_compiler::FUNCTIONS;
use hyde_syntax::ast::{ClassKind, Prefix};
use lsp_types::{
    Documentation, ParameterInformation, ParameterLabel, SignatureHelp, SignatureInformation,
};

/// A parameter: its name, how it is declared, what it is.
type Parameter = (String, String, Option<String>);

/// What may stand in the innermost bracket that is open at a byte.
pub(crate) fn signature(analysis: &Analysis, byte: usize) -> Option<SignatureHelp> {
    let before = analysis.text().get(..byte)?;
    let open = open_brackets(before)?;
    let number = open.iter().rposition(|(_, sign)| *sign == '(')?;
    let (at, _) = open[number];
    let place = Place::at(analysis, byte);
    let written = arguments(&before[at + 1..]);
    let words = chain_words(before[..at].trim_end());
    if let [word] = words.as_slice()
        && FUNCTIONS.contains(word)
        && place.modified(before, &open, number).is_none()
    {
        return Some(of_language(word, written.len() - 1));
    }
    let function = place.reference(&words).and_then(|name| {
        let (file, class) = analysis.files().class(0, &name)?;
        (class.kind == ClassKind::Function).then_some((file, class))
    });
    let (name, doc, inside, positional) = match function {
        Some((file, class)) => (
            words.join("."),
            class.doc.clone(),
            Inside::Class(file, class),
            true,
        ),
        None => {
            let inside = place.modified(before, &open, number)?;
            let Inside::Class(_, class) = inside else {
                return None;
            };
            (class.name.text.clone(), class.doc.clone(), inside, false)
        }
    };
    let list = parameters(&place, inside, positional);
    let last = written.last().copied().unwrap_or_default();
    let named = last.split('=').next().unwrap_or_default().trim();
    let active = list.iter().position(|(own, ..)| own == named);
    let active = active.or((positional && written.len() <= list.len()).then(|| written.len() - 1));
    Some(help(&name, doc, list, active))
}

/// The arguments that are written in a bracket so far, those of inner brackets left out; the last one is being written.
fn arguments(list: &str) -> Vec<&str> {
    let (mut depth, mut start, mut found) = (0_i32, 0, Vec::new());
    let mut in_text = false;
    for (at, sign) in list.char_indices() {
        match sign {
            '"' => in_text = !in_text,
            _ if in_text => {}
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            ',' if depth == 0 => {
                found.push(&list[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    found.push(&list[start..]);
    found
}

/// A function of the language.
fn of_language(name: &str, active: usize) -> SignatureHelp {
    let label = call_of(name);
    let inner = label
        .split_once('(')
        .and_then(|(_, rest)| rest.strip_suffix(')'))
        .unwrap_or_default()
        .to_owned();
    let names = arguments(&inner).into_iter().map(str::trim);
    let parameters: Vec<ParameterInformation> = names
        .filter(|own| !own.is_empty())
        .map(|own| ParameterInformation {
            label: ParameterLabel::Simple(own.to_owned()),
            documentation: None,
        })
        .collect();
    one(label, None, parameters, Some(active))
}

/// The parameters of a component that can be set, those without a value first; the inputs of a function in their order.
fn parameters(place: &Place<'_>, inside: Inside<'_>, function: bool) -> Vec<Parameter> {
    let mut found: Vec<(bool, Parameter)> = Vec::new();
    place.files.each_member(inside, &mut |member| {
        let Thing::Variable(declaration, declarator) = member.thing else {
            return;
        };
        let has = |prefix| declaration.prefixes.contains(&prefix);
        let set = [
            Prefix::Parameter,
            Prefix::Input,
            Prefix::Size,
            Prefix::Shape,
        ];
        let wanted = match function {
            true => has(Prefix::Input),
            false => set.into_iter().any(has) && !has(Prefix::Final),
        };
        let name = &member.name.text;
        if wanted && !found.iter().any(|(_, (own, ..))| own == name) {
            let (line, doc) = describe::signature(place.analysis, &member);
            let given = declarator.binding.is_some() && !function;
            found.push((given, (name.clone(), line, doc)));
        }
    });
    found.sort_by_key(|(given, _)| *given);
    found.into_iter().map(|(_, own)| own).collect()
}

fn help(
    name: &str,
    doc: Option<String>,
    list: Vec<Parameter>,
    active: Option<usize>,
) -> SignatureHelp {
    let names: Vec<&str> = list.iter().map(|(own, ..)| own.as_str()).collect();
    let label = format!("{name}({})", names.join(", "));
    let mut at = u32::try_from(name.encode_utf16().count() + 1).unwrap_or(0);
    let mut parameters = Vec::new();
    for (own, line, doc) in &list {
        let end = at + u32::try_from(own.encode_utf16().count()).unwrap_or(0);
        let text = doc
            .as_ref()
            .map_or_else(|| line.clone(), |doc| format!("{line}\n{doc}"));
        parameters.push(ParameterInformation {
            label: ParameterLabel::LabelOffsets([at, end]),
            documentation: Some(Documentation::String(text)),
        });
        at = end + 2;
    }
    one(label, doc, parameters, active)
}

fn one(
    label: String,
    doc: Option<String>,
    parameters: Vec<ParameterInformation>,
    active: Option<usize>,
) -> SignatureHelp {
    let active = active.and_then(|own| u32::try_from(own).ok());
    SignatureHelp {
        signatures: vec![SignatureInformation {
            label,
            documentation: doc.map(Documentation::String),
            parameters: Some(parameters),
            active_parameter: active,
        }],
        active_signature: Some(0),
        active_parameter: active,
    }
}
