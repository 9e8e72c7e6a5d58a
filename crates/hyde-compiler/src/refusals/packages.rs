//! What is said of packages that are not found, or not where they are looked for.

use hyde_diag::{Span, diagnostics};

diagnostics! {
    fn also_in_library(package: &str, place: &str, here: Span) = error Duplicate {
        "the package `{package}` is in the library and in `{place}`"; at here, "which of them?";
        help "rename yours, and its file as well";
    }
    fn hides_the_library((package, here): (&str, Span)) = warning Duplicate {
        "this file hides the package `{package}` of the library"; at here, "the same name";
        help "rename the package, and its file as well";
    }
    fn called_otherwise((found, here): (&str, Span), place: &str, required: &str) = error PackagePath {
        "the package in `{place}` is called `{found}`"; at here, "its path requires `{required}`";
        help "write `package {required};`, or move the file: the package `a.b` is in `a/b.hyde`";
    }
    fn not_declared(place: &str, top: Span, required: &str) = error PackagePath {
        "`{place}` does not declare its package"; at top, "its path requires `{required}`";
        help "write `package {required};`, or move the file: the package `a.b` is in `a/b.hyde`";
    }
    /// `searched` says where it was looked for beside the library; `instead` is for a package of another language, and `near`
    /// is one that may be meant.
    fn no_package(
        (package, here): (&str, Span), searched: &str, (instead, near): (Option<&str>, Option<&str>),
        (library, own): (&[String], &[String]),
    ) = error UnknownType {
        "there is no package `{package}`"; at here, "neither in the library nor {searched}";
        match (instead, near) {
            (Some(instead), _) => { help "{instead}"; }
            (None, Some(near)) => { help "did you mean `{near}`?"; }
            (None, None) if own.is_empty() => { help "the library has {}", library.join(", "); }
            (None, None) => { help "the library has {}; here are {}", library.join(", "), own.join(", "); }
        }
    }
}
