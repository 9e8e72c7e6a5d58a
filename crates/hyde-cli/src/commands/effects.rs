//! `hyde effects`: every effect of the library and of the file with the sites of the model it fits on: what a diagnosis
//! may try.

use super::effects_check;
use crate::args::{EffectsArgs, ModelArgs};
use crate::exit::Exit;
use crate::project::{self, Records, Told as _, print_output};
use hyde_compiler::{Candidate, Knob};
use hyde_present::lines::wrapped;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Lists effects and sites.
pub(crate) fn effects(args: &EffectsArgs) -> Exit {
    if args.check {
        return effects_check::check(&args.model);
    }
    match listed(args) {
        Ok(text) => {
            print_output(&text);
            Exit::Done
        }
        Err(exit) => exit,
    }
}

fn listed(args: &EffectsArgs) -> Result<String, Exit> {
    let args = ModelArgs {
        whole_library: true,
        ..args.model.clone()
    };
    let mut project = project::load(&args, Records::IfThere)?;
    project.experiment = None;
    let candidates = project.candidates_or_report(&args)?;
    if args.json {
        let list: Vec<_> = candidates.iter().map(as_json).collect();
        return Ok(format!("{:#}", json!({ "ok": true, "candidates": list })));
    }
    let mut text = String::new();
    let mut at = candidates.as_slice();
    while let Some(first) = at.first() {
        let sites = at.iter().take_while(|other| other.effect == first.effect);
        let sites: Vec<String> = sites.map(site).collect();
        at = &at[sites.len()..];
        let head = format!("{} on {}: {}", first.effect, first.host, first.doc);
        for line in wrapped(&head, 78) {
            let _ = writeln!(text, "{line}");
        }
        for line in wrapped(&sites.join(", "), 74) {
            let _ = writeln!(text, "    {line}");
        }
    }
    let nowhere: Vec<String> = project
        .file
        .effects_known()
        .filter(|name| candidates.iter().all(|known| known.effect != *name))
        .collect();
    if !nowhere.is_empty() {
        let line = format!("no site on this model: {}", nowhere.join(", "));
        for line in wrapped(&line, 78) {
            let _ = writeln!(text, "{line}");
        }
    }
    Ok(text)
}

/// A site with the other names it has.
fn site(candidate: &Candidate) -> String {
    match candidate.aliases.as_slice() {
        [] => candidate.site.clone(),
        aliases => format!("{} (= {})", candidate.site, aliases.join(", ")),
    }
}

fn as_json(candidate: &Candidate) -> Value {
    let knob = |knob: &Knob| {
        json!({
            "name": knob.name,
            "doc": knob.doc,
            "value": knob.value,
            "range": knob.range.map(|(from, to)| [from, to]),
            "unit": knob.quantity.dimension.usual_unit(),
            "integer": knob.integer,
        })
    };
    let marks = candidate.signature.iter();
    json!({
        "effect": candidate.effect,
        "on": candidate.host,
        "doc": candidate.doc,
        "site": candidate.site,
        "aliases": candidate.aliases,
        "sizes": candidate.sizes.iter().map(knob).collect::<Vec<_>>(),
        "shapes": candidate.shapes.iter().map(knob).collect::<Vec<_>>(),
        "signature": marks.map(|(mark, of)| json!({ "mark": mark, "of": of })).collect::<Vec<_>>(),
        "confounds": candidate.confounds,
    })
}
