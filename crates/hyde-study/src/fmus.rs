//! The FMUs that a file names: `model Controller = fmu("controller.fmu");`. Each becomes a model of its own source file.

use crate::aim::Aim;
use crate::asked::Asked;
use crate::inputs::Kind;
use crate::package::Roots;
use crate::refusals::files as refused;
use hyde_compiler::{File, FmuInterface, fmu_has_no_equations};
use hyde_diag::{Diagnostic, Diagnostics, FileId, Sources, Span};
use hyde_fmu_import::{Fmu, InProcess};
use hyde_program::{Foreign, Program};
use hyde_sim::{Failure, FailureKind};
use hyde_syntax::ast::{Change, ClassBody, Item, Reference};
use sha2::{Digest, Sha256};
use std::fmt::Debug;
use std::path::PathBuf;
use std::sync::Arc;

/// Who runs the instances of FMUs, if not this process.
pub trait FmuHost: Debug + Send + Sync {
    /// What makes the instances of an FMU.
    fn host(&self, fmu: &Arc<Fmu>) -> Arc<dyn Foreign>;
}

/// An FMU that was read.
#[derive(Clone, Debug)]
pub struct NamedFmu {
    /// Where it is.
    pub path: PathBuf,
    /// SHA-256 of its content.
    pub hash: String,
    /// What it is.
    pub fmu: Arc<Fmu>,
    /// The source file that stands for it.
    pub source: FileId,
    /// Each instance runs in a process of its own.
    pub in_own_process: bool,
    /// What makes its instances.
    pub computed_by: Arc<dyn Foreign>,
}

/// Reads every FMU that the files name, and puts a model for it beside them. What is missing or wrong is reported.
pub(crate) fn read(
    file: &mut File,
    asked: &Asked,
    roots: &Roots,
    sources: &mut Sources,
    diagnostics: &mut Diagnostics,
) -> Vec<NamedFmu> {
    let mut found = Vec::new();
    let mut models = Vec::new();
    for (id, tree) in &mut file.files {
        if !tree.items.iter().any(is_fmu) {
            continue;
        }
        for item in &mut Arc::make_mut(tree).items {
            let Item::Class(class) = item else { continue };
            let ClassBody::Short {
                base,
                fmu: Some((name, span)),
                changes,
                ..
            } = &mut class.body
            else {
                continue;
            };
            let model = class.name.text.as_str();
            // Beside packages of the user, which have other names: no one begins like this and ends in a number.
            let package = format!("fmu_{model}_{}", found.len() + 1);
            let importer = sources.get(*id).name.clone();
            match of_file(asked, roots, (&importer, name, *span), &package, model) {
                Ok((path, hash, fmu)) => {
                    for diagnostic in mistaken(&fmu, changes, *span) {
                        diagnostics.push(diagnostic);
                    }
                    *base = Reference::of_path(&format!("{package}.{model}"), *span);
                    let fmu = Arc::new(fmu);
                    let computed_by: Arc<dyn Foreign> = match &asked.fmu_host {
                        Some(host) => host.host(&fmu),
                        None => Arc::new(InProcess::new(fmu.clone())),
                    };
                    let source = sources.add(name.as_str(), fmu.interface.text.as_str());
                    let tree = hyde_syntax::parse(sources, source, diagnostics);
                    models.push((
                        source,
                        tree,
                        FmuInterface {
                            file: name.clone(),
                            parameters: fmu.interface.parameters.clone(),
                            inputs: fmu.interface.inputs.clone(),
                            outputs: fmu.interface.outputs.clone(),
                        },
                    ));
                    found.push(NamedFmu {
                        path,
                        hash,
                        fmu,
                        source,
                        in_own_process: asked.fmu_host.is_some(),
                        computed_by,
                    });
                }
                Err(diagnostic) => diagnostics.push(*diagnostic),
            }
        }
    }
    for (source, tree, interface) in models {
        file.files.push((source, Arc::new(tree)));
        file.fmus.insert(source, interface);
    }
    found
}

/// Whether an item is an FMU.
fn is_fmu(item: &Item) -> bool {
    match item {
        Item::Class(class) => matches!(class.body, ClassBody::Short { fmu: Some(_), .. }),
        Item::Type(_) | Item::Experiment(_) | Item::Study(_) => false,
    }
}

/// What an FMU is given that it does not have, and a communication step that it is not given.
fn mistaken(fmu: &Fmu, changes: &[Change], span: Span) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let file = &fmu.file;
    let parameters: Vec<&str> = fmu.interface.parameter_names().collect();
    for change in changes {
        let Some(word) = change.target.as_word().filter(|word| *word != "step") else {
            continue;
        };
        if parameters.contains(&word) {
            continue;
        }
        let other = fmu.interface.names.iter().any(|name| name == word);
        let here = (word, change.target.span);
        found.push(refused::no_parameter_of_fmu(file, here, other, &parameters));
    }
    let given = changes
        .iter()
        .any(|own| own.target.as_word() == Some("step"));
    if !given && fmu.description.step.is_none() {
        found.push(refused::no_step(file, span));
    }
    found
}

fn of_file(
    asked: &Asked,
    roots: &Roots,
    (importer, name, span): (&str, &str, Span),
    package: &str,
    model: &str,
) -> Result<(PathBuf, String, Fmu), Box<Diagnostic>> {
    let path = match &asked.inputs {
        Some(inputs) if inputs.is_replayed() => PathBuf::from(name),
        Some(_) | None => roots
            .data(importer, name)
            .map_err(|diagnostic| Box::new(diagnostic.label(span, "named here")))?,
    };
    let content = asked
        .read(Kind::Fmu, importer, name, &path)
        .map_err(|reason| Box::new(refused::no_fmu(&reason, span)))?;
    let hash = format!("{:x}", Sha256::digest(&content));
    match Fmu::read(name, content, package, model) {
        Ok(fmu) => Ok((path, hash, fmu)),
        Err(unusable) => Err(Box::new(refused::unusable_fmu(
            &unusable.what,
            span,
            &unusable.help,
        ))),
    }
}

/// Gives the parts of a program what computes them.
pub(crate) fn attach(program: &mut Program, fmus: &[NamedFmu]) {
    for part in &mut program.foreign {
        let fmu = fmus.iter().find(|fmu| fmu.source == part.source);
        part.computed_by = fmu.map(|fmu| fmu.computed_by.clone());
    }
}

/// Refuses a program with an FMU to what needs the equations of the whole model.
pub(crate) fn refused(program: &Program, aim: Aim) -> Option<Diagnostic> {
    let needs = match aim {
        Aim::Run | Aim::Ledger | Aim::Look => return None,
        Aim::Linearize => "a linearised model",
        Aim::Observe => "an observer",
        Aim::Export => "an exported model",
    };
    let part = program.foreign.first()?;
    let place = (part.name.as_str(), part.file.as_str(), part.origin.span);
    Some(fmu_has_no_equations(place, needs))
}

/// The diagnostic of an FMU that did not go on, if that is what failed.
pub(crate) fn failed(failure: &Failure, at: &str) -> Option<Diagnostic> {
    let FailureKind::Foreign {
        component,
        file,
        what,
        log,
    } = &failure.kind
    else {
        return None;
    };
    let of = (file.as_str(), component.as_str());
    Some(refused::fmu_failed(of, at, what, log, &failure.origins))
}
