//! `clif_growth`: does code grow with the number of cells?

use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;
use hyde_compiler::Stage;

pub(super) const FIGURE: Figure = Figure {
    name: "clif_growth",
    unit: "ratio",
    promise: Promise::Exactly(1.0),
    measure,
};

/// Instructions of a distributed screw of 5000 cells over those of one of 50.
fn measure(_: &Session) -> Result<Measured, String> {
    let (short, long) = (instructions(50)?, instructions(5000)?);
    Ok(Measured::Value(f64::from(long) / f64::from(short)))
}

/// Instructions of all kernels. In the printed code they are the indented lines between the first block of a function and
/// its end; declarations stand before that.
fn instructions(cells: u32) -> Result<u32, String> {
    let screw = Example::load("tests/models/screw.hyde", None)?.set("n", f64::from(cells));
    let code = screw.emit(Stage::Clif)?;
    let (mut count, mut in_body) = (0, false);
    for line in code.lines() {
        if line.starts_with("block") {
            in_body = true;
        } else if line.starts_with('}') {
            in_body = false;
        } else if in_body && line.starts_with("    ") {
            count += 1;
        }
    }
    if count == 0 {
        return Err("the printed code has no instructions".to_owned());
    }
    Ok(count)
}
