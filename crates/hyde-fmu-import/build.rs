//! Compiles the logger that FMI 2.0 requires: a C function with a variable number of arguments, which Rust cannot define.

fn main() {
    println!("cargo:rerun-if-changed=src/logger.c");
    cc::Build::new()
        .file("src/logger.c")
        .compile("hyde_fmu_logger");
}
