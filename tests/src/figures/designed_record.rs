//! `designed_record_resolves_percent`: of the planted effects that a diagnosis cannot distinguish from others, those that it
//! names alone with one more record, which is designed within the limits of the axis and measured with the same noise. On the
//! small axis, on the rack and on the linear motor; the cases are those of the other figures of the self-test.

use super::promise::{Figure, Measured, Promise, Session};
use super::selftest::{Axis, planted};

pub(super) const FIGURE: Figure = Figure {
    name: "designed_record_resolves_percent",
    unit: "%",
    promise: Promise::AtLeast(80.0),
    measure: resolved,
};

fn resolved(session: &Session) -> Result<Measured, String> {
    let (mut all, mut resolved) = (0.0, 0.0);
    for axis in Axis::ALL {
        let report = planted(session, axis)?;
        let number = |name: &str| {
            let own = report["designed"][name].as_f64();
            own.ok_or("the report has no designed records")
        };
        all += number("one_of")?;
        resolved += number("resolved")?;
    }
    if all == 0.0 {
        return Err("no verdict is `one of`".to_owned());
    }
    let percent = 100.0 * resolved / all;
    Ok(Measured::Partly(
        percent,
        "24 effects at their sites of each of three axes, spread over all",
    ))
}
