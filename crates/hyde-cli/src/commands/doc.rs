//! `hyde doc`: the pages of a package, of a file, or of the library.

use crate::args::{DocArgs, ModelArgs};
use crate::exit::Exit;
use crate::files;
use crate::project::{complain, print_output, report_errors};
use hyde_diag::{Diagnostics, FileId, Sources};
use hyde_present::package_pages::{Library, pages};
use hyde_study::world::{Disk, World};
use hyde_study::{MANIFEST, Manifest, Roots};
use hyde_syntax::ast;
use hyde_units::counted;
use std::path::Path;
use std::sync::Arc;

/// Writes a page for each package and an index of them, each file whole or not at all.
pub(crate) fn doc(args: &DocArgs) -> Exit {
    match written(args) {
        Ok(count) => {
            let index = args.out.join("index.html");
            print_output(&format!(
                "{}: {}",
                index.display(),
                counted(count, "package")
            ));
            Exit::Done
        }
        Err(exit) => exit,
    }
}

fn written(args: &DocArgs) -> Result<usize, Exit> {
    let path = args.path.clone().unwrap_or_default();
    let model = ModelArgs::of_file(&path);
    let library = if args.library {
        of_library(&model)?
    } else {
        of_path(&path, &model)?
    };
    let failed = |reason: String| complain(&model, Exit::CommandLine, &reason);
    let pages = pages(&library);
    files::make_folder(&args.out).map_err(failed)?;
    for (name, html) in &pages {
        files::write(&args.out.join(name), html.as_bytes()).map_err(failed)?;
    }
    Ok(library.documented)
}

fn of_library(model: &ModelArgs) -> Result<Library, Exit> {
    let mut library = Library {
        title: "The Hyde library".to_owned(),
        text:
            "Components, effects and quantities that come with Hyde. A model names what it uses: \
               `import Translational.*;`."
                .to_owned(),
        facts: vec![("version", env!("CARGO_PKG_VERSION").to_owned())],
        ..Library::default()
    };
    (library.sources, library.files) = parsed(library_texts(), model)?;
    library.documented = library.files.len();
    Ok(library)
}

/// A file, or the package of a folder.
fn of_path(path: &Path, model: &ModelArgs) -> Result<Library, Exit> {
    let failed = |reason: String| complain(model, Exit::CommandLine, &reason);
    let mut library = Library::default();
    let mut beside = Vec::new();
    let places = if files::is_folder(path) {
        if !files::is_file(&path.join(MANIFEST)) {
            return Err(failed(format!(
                "the folder `{}` has no `{MANIFEST}`",
                path.display()
            )));
        }
        let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
        let world: Arc<dyn World> = Arc::new(Disk);
        let roots = Roots::at(&world, path, &mut sources, &mut diagnostics);
        let manifest = roots.roots.first().and_then(|root| root.manifest.as_ref());
        let Some(manifest) = manifest.filter(|_| !diagnostics.has_errors()) else {
            return Err(report_errors(model, &sources, &diagnostics));
        };
        library.title.clone_from(&manifest.name);
        library.text.clone_from(&manifest.description);
        library.facts = facts(manifest);
        beside = roots.packages_depended_on();
        roots
            .own_packages()
            .into_iter()
            .map(|(_, place)| place)
            .collect()
    } else {
        library.title = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        vec![path.to_path_buf()]
    };
    library.documented = places.len();
    let mut texts = Vec::new();
    for place in places.into_iter().chain(beside) {
        let text = files::read_text(&place).map_err(failed)?;
        texts.push((place.to_string_lossy().into_owned(), text));
    }
    // What comes from dependencies and the library has no page here, but a unit, and is a connector or not.
    texts.extend(library_texts());
    (library.sources, library.files) = parsed(texts, model)?;
    Ok(library)
}

fn library_texts() -> Vec<(String, String)> {
    let packages = hyde_library::PACKAGES.iter();
    packages
        .map(|package| {
            let place = package.name.replace('.', "/");
            (format!("{place}.hyde"), package.text.to_owned())
        })
        .collect()
}

fn facts(manifest: &Manifest) -> Vec<(&'static str, String)> {
    let needed: Vec<&str> = manifest
        .dependencies
        .iter()
        .map(|dependency| dependency.name.as_str())
        .collect();
    let all = [
        ("version", manifest.version.clone()),
        ("licence", manifest.licence.clone()),
        ("depends on", needed.join(", ")),
        ("data", manifest.data.join(", ")),
    ];
    all.into_iter()
        .filter(|(_, fact)| !fact.is_empty())
        .collect()
}

type Parsed = (Sources, Vec<(FileId, Arc<ast::File>)>);

fn parsed(texts: Vec<(String, String)>, model: &ModelArgs) -> Result<Parsed, Exit> {
    let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
    let mut files = Vec::new();
    for (place, text) in texts {
        let id = sources.add(place, text);
        let tree = hyde_syntax::parse(&sources, id, &mut diagnostics);
        files.push((id, Arc::new(tree)));
    }
    if diagnostics.has_errors() {
        return Err(report_errors(model, &sources, &diagnostics));
    }
    Ok((sources, files))
}
