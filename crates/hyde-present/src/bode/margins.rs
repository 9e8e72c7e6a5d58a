//! The stability margins of the loops that an experiment cuts, as text and as JSON.

use crate::assumed;
use hyde_experiment::{DelayMargin, Margins, Pole};
use hyde_program::Program;
use hyde_study::responses::OfLoop;
use hyde_units::significant;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// What was found, as text of 80 columns.
pub fn text(of: &OfLoop) -> String {
    let found = &of.found;
    let mut text = format!("margins at {}\n", of.signal);
    for pole in &of.unstable {
        let _ = writeln!(text, "  UNSTABLE: the closed loop {}", grows(pole));
    }
    if !found.in_loop {
        let _ = writeln!(text, "  in no loop: the signal has no feedback");
        return text;
    }
    if of.unstable.is_empty() {
        let _ = writeln!(text, "  the closed loop is stable");
        for (name, value, at) in summary(found) {
            let line = format!("  {name:<18}{value:<30}{at}");
            let _ = writeln!(text, "{}", line.trim_end());
        }
    } else {
        let _ = writeln!(text, "  an unstable loop has no margins");
    }
    let stable = of.unstable.is_empty();
    let heading = if stable {
        "phase margin   delay margin"
    } else {
        "  phase of L"
    };
    let _ = writeln!(text, "  |L| = 1          {heading}");
    for crossover in found.gain_crossovers.iter().take(LISTED) {
        let f = frequency(crossover.frequency_hz);
        let margin = crossover.phase_margin.to_degrees();
        let (angle, delay) = if stable {
            (margin, time(crossover.delay_s))
        } else {
            (margin - 180.0, String::new())
        };
        let angle = format!("{} °", significant(angle, 4));
        let line = format!("  {f:>14} {angle:>14} {delay:>14}");
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text.push_str(&others(found.gain_crossovers.len()));
    let heading = if stable { "gain factor" } else { "" };
    let line = format!("  phase of L -180°          |L|    {heading}");
    let _ = writeln!(text, "{}", line.trim_end());
    for crossover in found.phase_crossovers.iter().take(LISTED) {
        let f = frequency(crossover.frequency_hz);
        let gain = format!("{} dB", significant(20.0 * crossover.gain.log10(), 4));
        let factor = if stable {
            significant(1.0 / crossover.gain, 4)
        } else {
            String::new()
        };
        let line = format!("  {f:>14} {gain:>14} {factor:>14}");
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text.push_str(&others(found.phase_crossovers.len()));
    for line in stands_on(of) {
        let _ = writeln!(text, "  {line}");
    }
    text
}

/// What is told of the numbers: name, value, where.
fn summary(found: &Margins) -> Vec<(&'static str, String, String)> {
    let factor = |(factor, f): (f64, f64)| {
        let value = format!(
            "{} dB (factor {})",
            significant(20.0 * factor.log10(), 4),
            significant(factor, 4)
        );
        (value, format!("at {}", frequency(f)))
    };
    let unbounded = |what: &str| (what.to_owned(), String::new());
    let rows = [
        (
            "gain margin",
            found
                .gain_margin()
                .map_or_else(|| unbounded("any larger gain"), factor),
        ),
        (
            "gain reduction",
            found
                .gain_reduction()
                .map_or_else(|| unbounded("any smaller gain"), factor),
        ),
        (
            "phase margin",
            found.phase_margin().map_or_else(
                || unbounded("any: |L| is never 1"),
                |(angle, f)| {
                    let value = format!("{} °", significant(angle.to_degrees(), 4));
                    (value, format!("at {}", frequency(f)))
                },
            ),
        ),
        (
            "delay margin",
            match found.delay_margin() {
                DelayMargin::Any => unbounded("any delay"),
                DelayMargin::Nothing if found.period_s.is_some() => {
                    unbounded("less than one period: |L| is above 1 at half the rate")
                }
                DelayMargin::Nothing => unbounded("0 s: |L| stays above 1 at high frequencies"),
                DelayMargin::UpTo(delay, f) => {
                    let periods = found.period_s.map_or_else(String::new, |period| {
                        format!(" ({} periods)", significant(delay / period, 3))
                    });
                    (
                        format!("{}{periods}", time(delay)),
                        format!("at {}", frequency(f)),
                    )
                }
            },
        ),
        ("sensitivity Ms", peak(found.sensitivity_peak)),
        ("complementary Mt", peak(found.complementary_peak)),
    ];
    rows.into_iter()
        .map(|(name, (value, at))| (name, value, at))
        .collect()
}

fn peak((value, f): (f64, f64)) -> (String, String) {
    let decibels = significant(20.0 * value.log10(), 3);
    (
        format!("{} ({decibels} dB)", significant(value, 4)),
        format!("at {}", frequency(f)),
    )
}

/// What the numbers stand on.
fn stands_on(of: &OfLoop) -> Vec<String> {
    let found = &of.found;
    let mut lines = vec![
        "L is taken with negative feedback: -1 is critical. The loop is cut where the".to_owned(),
        "signal is given: all that reads it reads it with the test signal added.".to_owned(),
    ];
    let (from, to) = (
        significant(found.band_hz.0, 3),
        significant(found.band_hz.1, 3),
    );
    let whence = match (of.given, found.period_s) {
        (true, _) => "as asked",
        (false, None) => "slowest pole/100 .. fastest pole*100",
        (false, Some(_)) => "slowest pole/100 .. half the sampling rate",
    };
    lines.push(format!("Searched: {from} .. {to} Hz, {whence};"));
    lines.push("phase crossovers where |L| is between -100 and 100 dB.".to_owned());
    if let Some(period) = found.period_s {
        lines.push(format!(
            "Sampled every {}: L is exact, from tick to tick.",
            time(period)
        ));
    }
    lines
}

fn others(count: usize) -> String {
    match count {
        0 => format!("  {:>14}\n", "nowhere"),
        _ if count > LISTED => format!("  and {} more, all in the JSON\n", count - LISTED),
        _ => String::new(),
    }
}

fn grows(pole: &Pole) -> String {
    if !pole.oscillates() {
        return format!("has a pole that doubles every {}", time(pole.doubling_s()));
    }
    let mode = pole.mode();
    format!(
        "oscillates at {} Hz with damping {}",
        significant(mode.frequency_hz, 4),
        significant(mode.damping, 3)
    )
}

fn frequency(f: f64) -> String {
    if f.is_finite() {
        format!("{} Hz", significant(f, 4))
    } else {
        "high frequency".to_owned()
    }
}

fn time(seconds: f64) -> String {
    let (value, unit) = if seconds >= 1.0 {
        (seconds, "s")
    } else if seconds >= 1e-3 {
        (1e3 * seconds, "ms")
    } else {
        (1e6 * seconds, "us")
    };
    format!("{} {unit}", significant(value, 4))
}

/// The same as JSON.
pub(super) fn json(program: &Program, of: &OfLoop) -> Value {
    let found = &of.found;
    let stable = of.unstable.is_empty();
    let valid = stable && found.in_loop;
    let factor = |margin: Option<(f64, f64)>| {
        margin.filter(|_| valid).map(|(factor, f)| {
            json!({ "factor": factor, "db": 20.0 * factor.log10(), "frequency_hz": finite(f) })
        })
    };
    let peak = |(value, f): (f64, f64)| {
        valid.then(|| json!({ "value": value, "db": 20.0 * value.log10(), "frequency_hz": f }))
    };
    let phase = found.phase_margin().filter(|_| valid);
    let delay = match found.delay_margin() {
        _ if !valid => Value::Null,
        DelayMargin::Any => Value::Null,
        DelayMargin::Nothing => json!({ "s": 0.0, "frequency_hz": null }),
        DelayMargin::UpTo(s, f) => json!({ "s": s, "frequency_hz": f }),
    };
    let gains: Vec<Value> = found
        .gain_crossovers
        .iter()
        .map(|c| {
            json!({
                "frequency_hz": c.frequency_hz, "phase_margin_deg": c.phase_margin.to_degrees(), "delay_margin_s": c.delay_s,
            })
        })
        .collect();
    let phases: Vec<Value> = found
        .phase_crossovers
        .iter()
        .map(|c| json!({ "frequency_hz": finite(c.frequency_hz), "gain": c.gain, "factor": 1.0 / c.gain }))
        .collect();
    let unstable: Vec<Value> = of
        .unstable
        .iter()
        .map(|pole| {
            let mode = pole.mode();
            json!({ "frequency_hz": mode.frequency_hz, "damping": mode.damping, "eigenvalue": [pole.s.re, pole.s.im] })
        })
        .collect();
    let (frequencies, open): (Vec<f64>, Vec<[f64; 2]>) = found
        .open_loop
        .iter()
        .map(|(f, l)| (*f, [l.re, l.im]))
        .unzip();
    json!({
        "experiment": of.experiment, "signal": of.signal, "stable": stable, "in_loop": found.in_loop,
        "unstable_poles": unstable, "assumptions": assumed::listed(program, &of.linear), "period_s": found.period_s, "band_hz": found.band_hz,
        "gain_margin": factor(found.gain_margin()), "gain_reduction": factor(found.gain_reduction()),
        "phase_margin": phase.map(|(angle, f)| json!({ "deg": angle.to_degrees(), "frequency_hz": f })),
        "delay_margin": delay,
        "sensitivity_peak": peak(found.sensitivity_peak), "complementary_peak": peak(found.complementary_peak),
        "gain_crossovers": gains, "phase_crossovers": phases,
        "assumed": stands_on(of).join(" "),
        "frequency_hz": frequencies, "open_loop_re_im": open,
    })
}

fn finite(f: f64) -> Option<f64> {
    f.is_finite().then_some(f)
}

/// Crossovers listed in the text, of each kind; JSON has all.
const LISTED: usize = 8;
