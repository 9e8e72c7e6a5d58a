//! The figures of a cut loop, and its numbers as CSV.

use hyde_report::{BodeCurve, Figure, LineStyle, OpenLoop, bode_plot, nichols_plot, nyquist_plot};
use hyde_study::responses::OfLoop;
use hyde_units::significant;
use std::fmt::Write as _;

/// The figures of the open loop, with the stems of their files.
pub fn figures(title: &str, of: &OfLoop) -> [(&'static str, Figure); 3] {
    let title = format!("{title}: loop cut at {}", of.signal);
    let curve = open_loop(of);
    [
        ("open-loop", bode(&title, of, &curve)),
        ("nyquist", nyquist_plot(title.as_str(), &curve)),
        ("nichols", nichols_plot(title.as_str(), &curve)),
    ]
}

/// The curve with the crossovers that decide.
fn open_loop(of: &OfLoop) -> OpenLoop {
    let found = &of.found;
    let hz = |f: f64| format!("{} Hz", significant(f, 3));
    let gain = found.phase_margin().map(|(angle, f)| {
        let at = angle - std::f64::consts::PI;
        ((at.cos(), at.sin()), hz(f))
    });
    let phase = found.gain_margin().filter(|(_, f)| f.is_finite());
    let phase = phase.map(|(factor, f)| ((-1.0 / factor, 0.0), hz(f)));
    OpenLoop {
        response: found.open_loop.iter().map(|(_, l)| (l.re, l.im)).collect(),
        distance: 1.0 / found.sensitivity_peak.0,
        marks: gain.into_iter().chain(phase).collect(),
    }
}

fn bode(title: &str, of: &OfLoop, curve: &OpenLoop) -> Figure {
    let marks = [of.found.phase_margin(), of.found.gain_margin()];
    let marks = marks.into_iter().flatten();
    let crossovers: Vec<(f64, String)> = marks
        .filter(|(_, f)| f.is_finite())
        .map(|(_, f)| (f, format!("{} Hz", significant(f, 3))))
        .collect();
    let curves = [BodeCurve {
        label: String::new(),
        frequency: of.found.open_loop.iter().map(|(f, _)| *f).collect(),
        response: curve.response.clone(),
        style: LineStyle::Solid,
        coherence: None,
        deviation: None,
        colour: None,
    }];
    bode_plot(title, ("L", ""), &curves, &crossovers)
}

/// The numbers of the open loop.
pub(super) fn csv(of: &OfLoop) -> String {
    let mut csv = String::from("f [Hz],re,im\n");
    for (f, l) in &of.found.open_loop {
        let _ = writeln!(csv, "{f},{},{}", l.re, l.im);
    }
    csv
}
