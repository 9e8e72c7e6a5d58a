//! [`with_written`]: a file with effects that were written by a program, as if the user had written them.

use crate::load::File;
use hyde_diag::{Diagnostics, Sources};
use std::sync::Arc;

/// The sources and the file with some texts added to what the user wrote; `None` if one of them cannot be read.
#[must_use]
pub fn with_written<'t>(
    sources: &Sources,
    file: &File,
    texts: impl IntoIterator<Item = &'t str>,
) -> Option<(Sources, File)> {
    let (mut sources, mut file) = (sources.clone(), file.clone());
    for text in texts {
        let id = sources.add("written", text);
        let mut diagnostics = Diagnostics::new();
        let tree = hyde_syntax::parse(&sources, id, &mut diagnostics);
        if diagnostics.has_errors() {
            return None;
        }
        let (_, own) = file.files.first_mut()?;
        Arc::make_mut(own).items.extend(tree.items);
    }
    Some((sources, file))
}
