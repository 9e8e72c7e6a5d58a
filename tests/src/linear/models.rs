//! Random chains of bodies with something between them that switches.

use crate::numbers::Numbers;
use std::fmt::Write as _;

/// A model with its operating point.
pub(crate) struct Model {
    /// The file.
    pub(crate) text: String,
    /// The point, 0 at the start.
    pub(crate) at_s: f64,
    /// The parameters that are start values.
    pub(crate) starts: Vec<String>,
}

/// The model of a seed.
pub(crate) fn random(seed: u64) -> Model {
    let mut numbers = Numbers::of(seed);
    let at_s = match numbers.one_of(2) {
        0 => 0.0,
        _ => numbers.between(0.05, 0.4),
    };
    let bodies = 1 + numbers.one_of(3) as usize;
    let (mut declared, mut equations, mut starts) = (String::new(), String::new(), Vec::new());
    for i in 1..=bodies {
        let (x0, v0) = (numbers.between(-0.02, 0.02), numbers.between(-0.2, 0.2));
        let _ = writeln!(
            declared,
            "  parameter Length x{i}_0 = {x0} [m], switch{i} = {x0} [m];\n  parameter Velocity v{i}_0 = {v0} [m/s];\n  \
             Length x{i}(start = x{i}_0, fixed = true);\n  Velocity v{i}(start = v{i}_0, fixed = true) = der(x{i});"
        );
        starts.extend([format!("x{i}_0"), format!("v{i}_0")]);
        let (below, slower) = match i {
            1 => ("0".to_owned(), "0".to_owned()),
            _ => (format!("x{}", i - 1), format!("v{}", i - 1)),
        };
        let (k, d) = (numbers.between(200.0, 2000.0), numbers.between(0.5, 5.0));
        let _ = writeln!(
            declared,
            "  Force f{i} = {k} [N/m]*(x{i} - {below}) + {d} [N.s/m]*(v{i} - {slower});"
        );
    }
    for i in 1..=bodies {
        let mass = numbers.between(0.5, 3.0);
        let above = if i < bodies {
            format!(" + f{}", i + 1)
        } else {
            String::new()
        };
        let extra = special(&mut numbers, i, at_s, &mut declared, &mut equations);
        let _ = writeln!(equations, "  {mass} [kg]*der(v{i}) = -f{i}{above}{extra};");
    }
    let text = format!(
        "package random \"a chain of bodies with something that switches\";\nimport SI.*;\nimport Translational.*;\n\n\
         model Gap\n  input Length x;\n  output Force f;\n  parameter Length edge = 0;\n  parameter Stiffness k = 0;\n  \
         modes initial apart {{\n    mode apart {{ f = 0; exit x > edge -> touching; }}\n    \
         mode touching {{ f = k*(x - edge); exit x < edge -> apart; }}\n  }}\nend Gap;\n\n\
         model Relay\n  input Length x;\n  output Force f;\n  parameter Stiffness low = 0, high = 0;\n  parameter Length up = 0, down = 0;\n  \
         modes initial high_one {{\n    mode low_one {{ f = low*x; exit x > up -> high_one; }}\n    \
         mode high_one {{ f = high*x; exit x < down -> low_one; }}\n  }}\nend Relay;\n\n\
         model M\n{declared}equation\n{equations}end M;\n\nexperiment run of M\n  stop 1 [s];\nend run;\n"
    );
    Model { text, at_s, starts }
}

/// A force on body i that switches, and what declares it.
fn special(
    numbers: &mut Numbers,
    i: usize,
    at_s: f64,
    declared: &mut String,
    equations: &mut String,
) -> String {
    let (k1, k2) = (
        numbers.between(100.0, 1500.0),
        numbers.between(1600.0, 4000.0),
    );
    let edge = numbers.between(-0.015, 0.015);
    let speed = numbers.between(-0.15, 0.15);
    // On either side of the operating point.
    let instant = match numbers.one_of(2) {
        0 => at_s + 0.05,
        _ => (at_s - 0.03).max(-0.01),
    };
    let stiff = |declared: &mut String, condition: &str| {
        let _ = writeln!(
            declared,
            "  Stiffness k{i} = if {condition} then {k1} [N/m] else {k2} [N/m];"
        );
        format!(" - k{i}*x{i}")
    };
    match numbers.one_of(17) {
        0 => stiff(declared, &format!("x{i} > {edge} [m]")),
        1 => stiff(declared, &format!("time < {instant} [s]")),
        2 => stiff(
            declared,
            &format!("v{i} <= {speed} [m/s] or x{i} > {edge} [m]"),
        ),
        3 => format!(" - {k1} [N/m]*abs(x{i} - {edge} [m])"),
        4 => {
            format!(" - {k2} [N.s/m]*v{i}*abs(v{i})/1 [m/s]*0.01 - {k1} [N/m]*0.01*sign(v{i})*x{i}")
        }
        5 => format!(" - max({k1} [N/m]*x{i}, {k2} [N/m]*(x{i} - {edge} [m]))"),
        6 => format!(
            " - min({k1} [N/m]*x{i}, {} [N])",
            numbers.between(-5.0, 5.0)
        ),
        7 => {
            let _ = writeln!(declared, "  Boolean b{i} = x{i} > {edge} [m];");
            stiff(declared, &format!("b{i}"))
        }
        8 => {
            let _ = writeln!(declared, "  Boolean b{i} = time > {instant} [s];");
            stiff(declared, &format!("b{i} and v{i} < {speed} [m/s]"))
        }
        9 => {
            let _ = writeln!(declared, "  Integer n{i}(start = 0);");
            let _ = writeln!(
                equations,
                "  when x{i} > {edge} [m] then\n    n{i} = pre(n{i}) + 1;\n  end when;"
            );
            stiff(declared, &format!("n{i} > 0"))
        }
        10 => {
            let _ = writeln!(
                declared,
                "  Gap gap{i}(x = x{i}, edge = {edge} [m], k = {k2} [N/m]);"
            );
            format!(" - gap{i}.f")
        }
        11 => {
            let low = edge - 0.004;
            let _ = writeln!(
                declared,
                "  Relay relay{i}(x = x{i}, up = {edge} [m], down = {low} [m], low = {k1} [N/m], high = {k2} [N/m]);"
            );
            format!(" - relay{i}.f")
        }
        12 => stiff(
            declared,
            &format!("(if time < {instant} [s] then x{i} > {edge} [m] else v{i} > {speed} [m/s])"),
        ),
        13 => {
            // A tick is never within the time that differences are followed.
            let (period, phase) = (numbers.between(0.02, 0.03), 0.006);
            let phase = (at_s + phase) % period;
            let _ = writeln!(
                declared,
                "  Force u{i} = hold(c{i}.u);\n  clocked c{i}({period} [s], phase = {phase} [s])\n    \
                 Force sum(start = 0) = pre(sum) - {k1} [N/(m.s)]*sample(x{i})*interval();\n    \
                 Force u = sum - {k1} [N/m]*sample(x{i});\n  end c{i};"
            );
            format!(" + u{i} - (if u{i} > 0 then 1 else 2)*{k1} [N/m]*x{i}")
        }
        14 => {
            let _ = writeln!(
                declared,
                "  Mass m{i}(M = 1 [kg], s(start = x{i}_0, fixed = true), v(start = v{i}_0, fixed = true));\n  \
                 ElastoGap stop{i}(c = {k2} [N/m], d = 3 [N.s/m], s_rel0 = {edge} [m]);\n  Fixed ground{i};\n  \
                 Translational.SpringDamper spring{i}(c = {k1} [N/m], d = 1 [N.s/m]);"
            );
            let _ = writeln!(
                equations,
                "  connect(m{i}.a, stop{i}.b, spring{i}.b);\n  connect(stop{i}.a, spring{i}.a, ground{i}.a);"
            );
            String::new()
        }
        15 => {
            let _ = writeln!(
                declared,
                "  Mass m{i}(M = 1 [kg], s(start = x{i}_0, fixed = true), v(start = v{i}_0, fixed = true));\n  \
                 Guide guide{i}(F = 0.3 [N], b = 2 [N.s/m]);\n  Fixed ground{i};\n  \
                 Translational.SpringDamper spring{i}(c = {k1} [N/m], d = 1 [N.s/m]);"
            );
            let _ = writeln!(
                equations,
                "  connect(m{i}.a, guide{i}.a, spring{i}.b);\n  connect(spring{i}.a, ground{i}.a);"
            );
            String::new()
        }
        // Exactly at its switch, which stays where it is while the start is changed.
        _ => format!(" - (if x{i} > switch{i} then {k1} else {k2})*1 [N/m]*(x{i} - switch{i})"),
    }
}
