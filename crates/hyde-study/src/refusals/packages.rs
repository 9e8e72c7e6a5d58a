//! What is said of packages and their manifests.

use hyde_diag::{Span, diagnostics};
use std::path::Path;

diagnostics! {
    fn unreadable(why: &str) = error NotDeclared {
        "{why}";
    }
    fn in_two_places(package: &str, first: &Path, second: &Path) = error Duplicate {
        "the package `{package}` is in `{}` and in `{}`", first.display(), second.display();
        help "rename one of the two, and its file as well";
    }
    /// A package of another folder, which the manifest does not name.
    fn not_a_dependency(package: &str, name: &str, manifest: &Path, folder: &Path) = error NotDeclared {
        "the package `{package}` is in `{name}`, which is not a dependency here";
        help "add it to `{}`, below `[dependencies]`: `\"{name}\" = \"…/{name}\"`, the path to `{}`",
            manifest.display(), folder.display();
    }
    fn not_among_data(path: &str, package: &str, manifest: &Path) = error NotDeclared {
        "`{path}` is not among the data of the package `{package}`";
        help "declare it in `{}`: `data = [\"{path}\"]`", manifest.display();
    }
    fn outside(path: &str, folder: &str) = error NotDeclared {
        "`{path}` is outside {folder}";
        help "move the file into the folder: Hyde reads no file outside it";
    }
    fn unreadable_manifest(why: &str) = error BadManifest {
        "{why}";
    }
    fn bad_manifest(why: &str, here: Span) = error BadManifest {
        "the manifest cannot be read: {why}"; at here, "here";
        help "a manifest has `name`, `version`, and as needed `description`, `licence`, `folders`, `data`, `[dependencies]`";
    }
    fn not_a_name(name: &str, here: Span) = error BadManifest {
        "`{name}` is not a name"; at here, "in this manifest";
        help "a name consists of letters, digits and `_`, with dots between words";
    }
    fn not_a_version(version: &str, here: Span) = error BadManifest {
        "`{version}` is not a version"; at here, "in this manifest";
        help "a version consists of three numbers: `0.1.0`";
    }
    fn absolute_path(dependency: &str, here: Span) = error BadManifest {
        "the path to `{dependency}` is absolute"; at here, "in this manifest";
        help "write it relative to this manifest: an absolute path differs from machine to machine";
    }
    fn nothing_there(path: &str, here: Span, what: &str) = error BadManifest {
        "there is no {what} `{path}`"; at here, "in this manifest";
        help "paths are relative to the manifest's folder";
    }
    fn outside_package(path: &str, here: Span) = error NotDeclared {
        "`{path}` is outside the folder of the package"; at here, "outside";
        help "put it below the manifest; the packages of other folders are `[dependencies]`";
    }
    fn no_manifest(manifest: &Path, dependency: &str, here: Span) = error BadManifest {
        "there is no `{}`", manifest.display(); at here, "the package `{dependency}` should be there";
        help "the path leads from this manifest's folder to the folder of the other manifest";
    }
    fn depends_on_itself(path: &str, here: Span) = error BadManifest {
        "a package depends on itself"; at here, "`{path}` leads to the folder of this manifest";
        help "remove the line: the files of a package import each other without a dependency";
    }
    fn other_name(name: &str, (dependency, path): (&str, &str), here: Span) = error BadManifest {
        "the package there is called `{name}`"; at here, "not `{dependency}`";
        help "write `\"{name}\" = \"{path}\"`";
    }
}
