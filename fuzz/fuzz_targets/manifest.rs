//! Any text is a manifest of a package or is refused, with the folders and packages that it names looked for.
#![no_main]

use hyde_diag::{Diagnostics, Sources};
use hyde_study::world::{Buffers, World};
use hyde_study::{MANIFEST, Roots};
use libfuzzer_sys::fuzz_target;
use std::path::Path;
use std::sync::Arc;

fuzz_target!(|text: &str| {
    let mut files = Buffers::default();
    let folder = Path::new("/seals");
    files.put(folder.join(MANIFEST), text);
    files.put(folder.join("models/rings.hyde"), "package rings;\n");
    files.put(
        Path::new("/guides").join(MANIFEST),
        "name = \"guides\"\nversion = \"0.1.0\"\n",
    );
    let world: Arc<dyn World> = Arc::new(files);
    let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
    let roots = Roots::at(&world, folder, &mut sources, &mut diagnostics);
    let _ = roots.own_packages();
});
