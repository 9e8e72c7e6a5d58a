//! `hyde emit`: a stage of the compiler as text.

use crate::args::{EmitArgs, StageName};
use crate::exit::Exit;
use crate::project::{self, Records, Told as _, print_output};
use hyde_compiler::{Backend, Form, FreeInputs, Request, Stage};

/// Prints the result of a stage.
pub(crate) fn emit(args: &EmitArgs) -> Exit {
    let mut project = match project::load(&args.model, Records::Needed) {
        Ok(project) => project,
        Err(exit) => return exit,
    };
    let settings = project.set().into_iter().collect();
    let headers = hyde_study::headers(&project.records);
    let request = Request {
        sources: &project.sources,
        file: &project.file,
        model: &project.model,
        experiment: project.experiment.as_deref(),
        settings: &settings,
        records: &headers,
        free_inputs: FreeInputs::None,
        ledger: false,
        form: Form::Run,
        backend: Backend::Native,
    };
    let stage = match args.stage {
        StageName::Ast => Stage::Ast,
        StageName::Flat => Stage::Flat,
        StageName::Structure => Stage::Structure,
        StageName::Dae => Stage::Dae,
        StageName::Clif => Stage::Clif,
        StageName::Asm => Stage::Asm,
    };
    let mut texts = vec![hyde_compiler::emit(
        &request,
        stage,
        &mut project.diagnostics,
    )];
    if let Some(model) = &args.against {
        let other = Request {
            model,
            experiment: None,
            free_inputs: match request.experiment {
                None => FreeInputs::All,
                Some(_) => FreeInputs::None,
            },
            ..request
        };
        texts.push(hyde_compiler::emit(&other, stage, &mut project.diagnostics));
    }
    let texts: Option<Vec<String>> = texts.into_iter().collect();
    let text = texts.map(|mut texts| match texts.len() {
        1 => texts.remove(0),
        _ => differences(&texts[1], &texts[0]),
    });
    match text {
        Some(text) => {
            if args.model.json {
                print_output(&format!(
                    "{:#}",
                    serde_json::json!({ "ok": true, "text": text })
                ));
            } else {
                print_output(&text);
            }
            Exit::Done
        }
        None => project.finish_with_errors(&args.model),
    }
}

/// The lines that only one of two texts has, with `-` those of the first and `+` those of the second, in their order.
fn differences(before: &str, after: &str) -> String {
    let diff = similar::TextDiff::from_lines(before, after);
    let mut out = String::new();
    for change in diff.iter_all_changes() {
        let mark = match change.tag() {
            similar::ChangeTag::Equal => continue,
            similar::ChangeTag::Delete => '-',
            similar::ChangeTag::Insert => '+',
        };
        out.push(mark);
        out.push_str(change.value());
    }
    out
}
