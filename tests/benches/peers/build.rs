//! Compiles the reference programs of `../reference` with the SUNDIALS of this workspace, each into the build folder.

use std::path::Path;
use std::process::ExitCode;

const PROGRAMS: [&str; 4] = ["shaft", "stick_slip", "backlash", "nonlinear"];

/// In the order of the linker: what is used after what uses it.
const LIBRARIES: [&str; 9] = [
    "sundials_ida",
    "sundials_nvecserial",
    "sundials_sunmatrixsparse",
    "sundials_sunmatrixdense",
    "sundials_sunlinsolklu",
    "sundials_sunlinsoldense",
    "sundials_core",
    "klu",
    "m",
];

fn main() -> ExitCode {
    match compile() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            println!("cargo::error={message}");
            ExitCode::FAILURE
        }
    }
}

fn compile() -> Result<(), String> {
    let sources = Path::new("../reference");
    let out = std::env::var("OUT_DIR").map_err(|e| e.to_string())?;
    let sundials = std::env::var("DEP_SUNDIALS_ROOT").map_err(|_| "no SUNDIALS was built")?;
    println!("cargo::rerun-if-changed={}", sources.display());
    println!("cargo::rustc-env=REFERENCE={out}");
    let compiler = cc::Build::new()
        .opt_level(3)
        .flag("-march=native")
        .warnings(true)
        .get_compiler();
    for name in PROGRAMS {
        let mut command = compiler.to_command();
        command.arg(sources.join(name).with_extension("c"));
        command.args([
            format!("-I{sundials}/include"),
            "-I/usr/include/suitesparse".to_owned(),
        ]);
        command.arg(format!("-L{sundials}/lib"));
        command.args(LIBRARIES.map(|library| format!("-l{library}")));
        command.arg("-o").arg(Path::new(&out).join(name));
        let status = command.status().map_err(|e| e.to_string())?;
        if !status.success() {
            return Err(format!("{name}.c does not compile"));
        }
    }
    Ok(())
}
