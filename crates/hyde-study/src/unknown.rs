//! What is missing and in no library: the sites where a law may act, and written effects compiled.

use hyde_calibrate::{Built, Kind, LawVariable, Site, Unknown, Written};
use hyde_compiler::{Additions, Candidate, Request};
use hyde_diag::{Diagnostics, Severity};
use hyde_units::NamedUnit;

/// A site of a model where a law may act, as a diagnosis takes it.
pub fn site(declared: hyde_compiler::LawSite) -> Site {
    let variable = |own: hyde_compiler::LawVariable| LawVariable {
        unit: match own.derivative {
            true => NamedUnit::usual(own.dimension()),
            false => own.quantity.unit.clone(),
        },
        name: own.name,
        derivative: own.derivative,
    };
    Site {
        kind: Kind::new(
            declared.host,
            declared.form,
            declared.target,
            declared.dimension,
            declared.over.map(variable),
            declared.signal.map(variable),
        ),
        path: declared.path,
        aliases: declared.aliases,
    }
}

/// Puts candidates, by number, and written effects on the model.
pub fn built(
    request: &Request<'_>,
    candidates: &[Candidate],
    known: &[usize],
    written: &[Written],
) -> Option<Built> {
    put(request, candidates, known, written, &mut Diagnostics::new())
}

fn put(
    request: &Request<'_>,
    candidates: &[Candidate],
    known: &[usize],
    written: &[Written],
    diagnostics: &mut Diagnostics,
) -> Option<Built> {
    let texts = written.iter().map(|one| one.text.as_str());
    let (sources, file) = hyde_compiler::with_written(request.sources, request.file, texts)?;
    let own = file.files.first()?.0;
    let mut additions = Additions::kept();
    let mut paths: Vec<String> = known
        .iter()
        .map(|&number| additions.put(own, &candidates[number]))
        .collect();
    paths.extend(
        written
            .iter()
            .map(|one| additions.put(own, &candidate(one))),
    );
    let request = Request {
        sources: &sources,
        file: &file,
        ..*request
    };
    let compiled = hyde_compiler::compile_with(&request, &additions, diagnostics)?;
    Some(Built {
        program: compiled.program,
        paths,
    })
}

/// Why a candidate cannot be put on the model, in the compiler's words.
pub fn hindrance(request: &Request<'_>, candidates: &[Candidate], number: usize) -> String {
    let mut diagnostics = Diagnostics::new();
    put(request, candidates, &[number], &[], &mut diagnostics);
    let error = diagnostics
        .iter()
        .find(|own| own.severity == Severity::Error);
    error.map_or_else(
        || "the model with it cannot be run".to_owned(),
        |error| error.message.clone(),
    )
}

/// A written effect as what a search puts on a model.
pub fn candidate(written: &Written) -> Candidate {
    Candidate {
        effect: written.name.clone(),
        package: String::new(),
        host: String::new(),
        host_package: String::new(),
        doc: String::new(),
        site: written.site.clone(),
        aliases: Vec::new(),
        instance: written.name.clone(),
        sizes: Vec::new(),
        shapes: Vec::new(),
        signature: Vec::new(),
        confounds: Vec::new(),
        replaces: Vec::new(),
    }
}

/// `a force at table.a that goes with speed`: the place that gains most, and the variable, if it gains more than by chance.
pub fn most_like(unknown: &Unknown) -> Option<String> {
    let map = &unknown.map;
    let told = map.panels.iter().filter(|panel| panel.gain > panel.band);
    let best = told.max_by(|a, b| a.gain.total_cmp(&b.gain))?;
    let (what, path) = (map.site.kind.what(), &map.site.path);
    let variable = best.variable.name(&map.site.kind);
    Some(format!("{what} at {path} that depends on {variable}"))
}
