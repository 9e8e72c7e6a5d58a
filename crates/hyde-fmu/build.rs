//! Tells the linker where the library in an FMU finds the libraries beside it.

fn main() {
    // The old form of the entry counts for the libraries that those load in turn, too.
    println!("cargo:rustc-cdylib-link-arg=-Wl,--disable-new-dtags,-rpath,$ORIGIN");
    // Importers copy it about: what only a debugger reads stays in the build.
    println!("cargo:rustc-cdylib-link-arg=-Wl,--strip-debug");
}
