//! `hyde export c`: the model as one C11 file and header with a fixed step.

use super::{identifier, no_arrays, switches};
use crate::args::{CArgs, ModelArgs};
use crate::exit::Exit;
use crate::files;
use crate::project::{self, Aim, Records, Told as _, complain, print_output};
use hyde_c::{FixedStep, Start, written};
use hyde_experiment::{RunError, extent, parameters};
use hyde_program::Program;
use hyde_study::ports::chosen_outputs;
use hyde_units::{counted, significant};
use serde_json::json;
use std::collections::BTreeSet;

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
    no_arrays(program, &args.output).map_err(refused)?;
    let outputs = chosen_outputs(program, &args.output).map_err(refused)?;
    let name = name(args.name.as_deref(), identifier(&project)).map_err(refused)?;
    let ((start_s, _), _) = extent(program, &tables, &p);
    let start = hyde_sim::known_start(program, &tables, &p, start_s, &[]);
    let start = start
        .map_err(|failure| project.report_refused(own, program, &RunError::Failed(failure)))?;
    // With what initial equations found: the code has them as numbers.
    let p = start.p;
    let start = Start {
        y: start.y,
        yp: start.yp,
        z: start.z,
    };
    let switches = switches::that_may_slide(program, &p, (start_s, &start));
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
    Ok(told(
        args,
        own,
        (program, &switches),
        &model,
        (&source, &header),
    ))
}

fn told(
    args: &CArgs,
    own: &ModelArgs,
    (program, switches): (&Program, &BTreeSet<String>),
    model: &FixedStep<'_>,
    (source, header): (&str, &str),
) -> String {
    let (source, header) = (args.out.join(source), args.out.join(header));
    if own.json {
        let told = json!({
            "ok": true, "source": source.display().to_string(), "header": header.display().to_string(),
            "step_s": args.step, "unknowns": program.n_unknowns, "inputs": model.inputs(), "parameters": model.parameters(),
            "may_slide": switches,
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
    for switch in switches {
        text.push_str(&format!(
            "\n  `{switch}` may slide: where both of its sides lead back to it, the code goes back and forth with the step, and only \
             the mean over the steps is right"
        ));
    }
    for input in &program.experiment.differentiated {
        text.push_str(&format!(
            "\n  the equations need the derivative of `{input}`; in a step it is 0"
        ));
    }
    text
}

/// A name of C.
fn name(asked: Option<&str>, usual: String) -> Result<String, String> {
    let asked = match asked {
        None if is_taken(&usual) => &usual,
        None => return Ok(usual),
        Some(asked) => asked,
    };
    if is_taken(asked) {
        return Err(format!(
            "`--name {asked}`: C, its libraries or the code itself use this name: write another one, `--name model_{asked}`"
        ));
    }
    let letters = asked.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let begins = asked.starts_with(|c: char| c.is_ascii_alphabetic());
    match letters && begins {
        true => Ok(asked.to_owned()),
        false => Err(format!(
            "`--name {asked}`: write a name of C: letters, digits and `_`, a letter first"
        )),
    }
}

/// Words of C and C++ that the code would not compile with as its name; its own names begin with `hy`.
const WORDS: [&str; 84] = [
    "auto",
    "bool",
    "break",
    "case",
    "catch",
    "char",
    "class",
    "const",
    "continue",
    "default",
    "delete",
    "do",
    "double",
    "else",
    "enum",
    "explicit",
    "export",
    "extern",
    "false",
    "float",
    "for",
    "friend",
    "goto",
    "if",
    "inline",
    "int",
    "long",
    "mutable",
    "namespace",
    "new",
    "operator",
    "private",
    "protected",
    "public",
    "register",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "struct",
    "switch",
    "template",
    "this",
    "throw",
    "true",
    "try",
    "typedef",
    "typename",
    "union",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "while",
    "main",
    "acos",
    "asin",
    "atan",
    "atan2",
    "ceil",
    "cos",
    "cosh",
    "exp",
    "fabs",
    "floor",
    "fmod",
    "log",
    "log10",
    "memcpy",
    "memset",
    "pow",
    "sin",
    "sinh",
    "sqrt",
    "tan",
    "tanh",
    "gamma",
    "j0",
    "j1",
    "y0",
    "y1",
];

fn is_taken(name: &str) -> bool {
    let own = name.to_ascii_lowercase();
    WORDS.contains(&name) || own == "hy" || own.starts_with("hy_")
}

/// The positions of parameters that are not to follow from others: those that were set, those of records, and those that
/// initial equations found.
fn given(program: &Program, set: &[(String, f64)]) -> Vec<usize> {
    let set = set.iter().filter_map(|(path, _)| {
        let (parameter, element) = program.parameter(path)?;
        Some(parameter.place + element)
    });
    let records = program.record_values.iter().map(|own| own.place);
    let found = program.parameters.iter().filter(|own| own.found);
    let found = found.flat_map(|own| own.place..own.place + own.len);
    set.chain(records).chain(found).collect()
}
