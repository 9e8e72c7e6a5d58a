//! `hyde effects`: every effect of the library and of the file, and the sites of the model it fits on.

use super::effects_check;
use crate::args::{EffectsArgs, ModelArgs};
use crate::exit::Exit;
use crate::project::{self, Records, print_output};
use serde_json::json;
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
    let fits = project.fits(&args)?;
    if args.json {
        let list: Vec<_> = fits
            .iter()
            .map(|fit| json!({ "effect": fit.effect, "on": fit.host, "doc": fit.doc, "sites": fit.sites }))
            .collect();
        return Ok(format!("{:#}", json!({ "ok": true, "effects": list })));
    }
    let mut text = String::new();
    for fit in fits {
        let head = format!("{} on {}: {}", fit.effect, fit.host, fit.doc);
        for line in wrapped(&head, 78) {
            let _ = writeln!(text, "{line}");
        }
        let sites = if fit.sites.is_empty() {
            "nowhere on this model".to_owned()
        } else {
            fit.sites.join(", ")
        };
        for line in wrapped(&sites, 74) {
            let _ = writeln!(text, "    {line}");
        }
    }
    Ok(text)
}

/// A list in lines of at most so many characters.
pub(super) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if !lines[last].is_empty() && lines[last].len() + 1 + word.len() > width {
            lines.push(word.to_owned());
            continue;
        }
        if !lines[last].is_empty() {
            lines[last].push(' ');
        }
        lines[last].push_str(word);
    }
    lines
}
