//! The file with a new model that a study leaves: what stands before the model, so that the file is in order where it lies.
//!
//! Below the folders of a manifest a file is the package that its place says. There it imports the user's package, and
//! `hyde check` and `hyde test` of the folder stay in order. Elsewhere nothing could be imported, and the file begins with
//! the text of the user's.

use crate::world::World;
use crate::{Project, Roots};
use hyde_diag::{Diagnostics, Sources};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What stands before a new model.
pub struct Head {
    /// The text, without an end of line.
    pub text: String,
    /// It imports the user's package.
    pub imports: bool,
}

/// Refuses a folder below those of a manifest whose name no package can have.
pub fn check_folder(world: &Arc<dyn World>, folder: &Path) -> Result<(), String> {
    let place = place(world, folder, "m");
    let is_word = |part: &str| {
        let first = part
            .chars()
            .next()
            .is_some_and(|c| c.is_alphabetic() || c == '_');
        first && part.chars().all(|c| c.is_alphanumeric() || c == '_')
    };
    match place {
        Some(place) if !place.name.split('.').all(is_word) => Err(format!(
            "`{}` is below a folder of the package `{}`, where the path of a file is its package name, and this path is not a valid name: use a folder with a name such as `found`",
            folder.display(),
            place.of
        )),
        Some(_) | None => Ok(()),
    }
}

/// What stands before a model in the file `stem.hyde` of a folder that is there.
pub fn head(
    world: &Arc<dyn World>,
    project: &Project,
    user: &Path,
    folder: &Path,
    stem: &str,
) -> Head {
    let Some((own, tree)) = project.file.files.first() else {
        return Head {
            text: String::new(),
            imports: false,
        };
    };
    let text = project.sources.get(*own).text.trim_end();
    let beside = place(world, user.parent().unwrap_or(Path::new("")), stem);
    let whole = |text: String| Head {
        text,
        imports: false,
    };
    match (place(world, folder, stem), &tree.package) {
        (Some(place), Some((package, _))) if beside.is_some_and(|own| own.root == place.root) => {
            let each = tree.imports.iter();
            let imports = each.map(|import| {
                let all = if import.everything { ".*" } else { "" };
                format!("import {}{all};\n", import.path.dotted())
            });
            let text = format!(
                "package {};\nimport {}.*;\n{}",
                place.name,
                package.dotted(),
                imports.collect::<String>().trim_end()
            );
            Head {
                text: text.trim_end().to_owned(),
                imports: true,
            }
        }
        (Some(place), Some((package, _))) => {
            let (start, end) = (package.span.start as usize, package.span.end as usize);
            whole(format!("{}{}{}", &text[..start], place.name, &text[end..]))
        }
        (Some(place), None) => whole(format!("package {};\n{text}", place.name)),
        (None, _) => whole(text.to_owned()),
    }
}

/// The place of a file in a package with a manifest.
struct Place {
    /// The package that a file there is.
    name: String,
    /// The folder of the manifest, and its name.
    root: PathBuf,
    of: String,
}

/// The place of a file in a folder, which need not be there yet; `None` below no manifest.
fn place(world: &Arc<dyn World>, folder: &Path, stem: &str) -> Option<Place> {
    let above = folder.ancestors().find(|above| world.is_folder(above));
    let above = above.filter(|above| !above.as_os_str().is_empty());
    let there = world.real(above.unwrap_or(Path::new(".")))?;
    let rest = folder.strip_prefix(above.unwrap_or(Path::new(""))).ok()?;
    let file = there.join(rest).join(format!("{stem}.hyde"));
    let marker = there.join(format!("{stem}.hyde"));
    let roots = Roots::of(world, &marker, &mut Sources::new(), &mut Diagnostics::new());
    let name = roots.name_at(&file)?;
    let root = roots.roots.into_iter().next()?;
    Some(Place {
        name,
        of: root.manifest?.name,
        root: root.folder,
    })
}
