//! `hyde export c`: the model as one C11 file and header with a fixed step.

use super::identifier;
use crate::args::{CArgs, ModelArgs};
use crate::exit::Exit;
use crate::files;
use crate::project::{self, Aim, Records, Told as _, complain, print_output};
use hyde_c::{FixedStep, Start, written};
use hyde_experiment::{RunError, extent, parameters};
use hyde_program::Program;
use hyde_study::ports::chosen_outputs;
use hyde_study::run_failure;
use hyde_units::{counted, significant};
use serde_json::json;

/// Writes the two files.
pub(crate) fn export(args: &CArgs) -> Exit {
    match left(args) {
        Ok(text) => {
            if !args.model.quiet {
                print_output(&text);
            }
            Exit::Done
        }
        Err(exit) => exit,
    }
}

fn left(args: &CArgs) -> Result<String, Exit> {
    let own = &args.model;
    let refused = |reason: String| complain(own, Exit::CommandLine, &reason);
    if !(args.step > 0.0 && args.step.is_finite()) {
        return Err(refused(
            "`--step`: write the step in seconds, above 0: `--step 1e-4`".to_owned(),
        ));
    }
    let mut project = project::load(own, Records::Needed)?;
    project.release(&args.input).map_err(refused)?;
    let compiled = project.compile_or_report(own, Aim::Export)?;
    project.print_warnings(own);
    let program = &compiled.program;
    let tables = hyde_study::tables(&project.records);
    let p = parameters(program, &tables, &project.set())
        .map_err(|error| project.report_refused(own, program, &error))?;
    let outputs = chosen_outputs(program, &args.output).map_err(refused)?;
    let name = name(args.name.as_deref(), identifier(&project)).map_err(refused)?;
    let ((start_s, _), _) = extent(program, &tables, &p);
    let start = hyde_sim::known_start(program, &tables, &p, start_s, &[]);
    let start = start.map_err(|failure| {
        let (diagnostic, fault) =
            run_failure::diagnostic(&RunError::Failed(failure), program, None);
        project.diagnostics.push(diagnostic);
        project.finish_with_errors(own);
        Exit::from(fault)
    })?;
    let start = Start {
        y: start.y,
        yp: start.yp,
        z: start.z,
    };
    let given = given(program, &project.set());
    let outputs: Vec<usize> = outputs.into_iter().collect();
    let model = FixedStep::of(
        program,
        &p,
        (start_s, start),
        (&name, args.step),
        (outputs.clone(), given),
    );
    let model = model.map_err(|diagnostic| {
        project.diagnostics.push(*diagnostic);
        project.finish_with_errors(own)
    })?;
    let Some(kernels) = project.kernels_as_c(&outputs) else {
        return Err(project.finish_with_errors(own));
    };
    let text = written(&model, &kernels);
    files::make_folder(&args.out).map_err(refused)?;
    let (source, header) = (format!("{name}.c"), format!("{name}.h"));
    files::write(&args.out.join(&source), text.source.as_bytes()).map_err(refused)?;
    files::write(&args.out.join(&header), text.header.as_bytes()).map_err(refused)?;
    Ok(told(args, own, program, &model, (&source, &header)))
}

fn told(
    args: &CArgs,
    own: &ModelArgs,
    program: &Program,
    model: &FixedStep<'_>,
    (source, header): (&str, &str),
) -> String {
    let (source, header) = (args.out.join(source), args.out.join(header));
    if own.json {
        let told = json!({
            "ok": true, "source": source.display().to_string(), "header": header.display().to_string(),
            "step_s": args.step, "unknowns": program.n_unknowns, "inputs": model.inputs(), "parameters": model.parameters(),
        });
        return format!("{told:#}");
    }
    let mut text = format!(
        "  {}\n  {}\n  implicit Euler with {} ms, {}, {}, {}\n  \
         events and ticks happen at the end of the step in which they are due",
        source.display(),
        header.display(),
        significant(1e3 * args.step, 6),
        counted(program.n_unknowns, "unknown"),
        counted(model.inputs(), "input"),
        counted(model.parameters(), "parameter"),
    );
    for input in &program.experiment.differentiated {
        text.push_str(&format!(
            "\n  the equations need the derivative of `{input}`; in a step it is 0"
        ));
    }
    text
}

/// A name of C.
fn name(asked: Option<&str>, usual: String) -> Result<String, String> {
    let Some(asked) = asked else {
        return Ok(usual);
    };
    let letters = asked.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let begins = asked.starts_with(|c: char| c.is_ascii_alphabetic());
    match letters && begins {
        true => Ok(asked.to_owned()),
        false => Err(format!(
            "`--name {asked}`: write a name of C: letters, digits and `_`, a letter first"
        )),
    }
}

/// The positions of parameters that are not to follow from others: those that were set, and those of records.
fn given(program: &Program, set: &[(String, f64)]) -> Vec<usize> {
    let set = set.iter().filter_map(|(path, _)| {
        let (parameter, element) = program.parameter(path)?;
        Some(parameter.place + element)
    });
    let records = program.record_values.iter().map(|own| own.place);
    set.chain(records).collect()
}
