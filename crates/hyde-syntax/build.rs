//! Writes the matcher of `grammar/hyde.pest` in Rust: pest reads and optimises the grammar, [`write`] turns each rule into
//! a function on bytes. `src/matcher.rs` includes the result.

#![expect(
    clippy::disallowed_methods,
    reason = "a build script reads the grammar and writes where cargo says"
)]

#[path = "build/first.rs"]
mod first;
#[path = "build/write.rs"]
mod write;

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let grammar = "../../grammar/hyde.pest";
    println!("cargo::rerun-if-changed={grammar}");
    let text = std::fs::read_to_string(grammar)?;
    let (_, rules) = pest_meta::parse_and_optimize(&text).map_err(|errors| {
        let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
        errors.join("\n")
    })?;
    let out = std::env::var("OUT_DIR")?;
    std::fs::write(Path::new(&out).join("rules.rs"), write::functions(&rules)?)?;
    Ok(())
}
