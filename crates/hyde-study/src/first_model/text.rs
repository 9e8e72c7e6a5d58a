//! The text of a first model.

use super::channels::{Channels, Measured};
use super::parts::Parts;
use super::{FirstModel, Template, Wish};
use std::f64::consts::TAU;

const TURNS: &str = "import SI.*;
import Rotational.*;
import Translational.*;
import Drives.*;
import Drives.Control.Stroke;

model Motor \"a motor whose current is known\"
  extends Electrical.Winding(R = 0, L = 0);
  input Current demand;
equation
  i = demand;
  shaft.tau = -T;
end Motor;
";

const SLIDES: &str = "import SI.*;
import Translational.*;
import Drives.Control.Stroke;
import Drives.Motors.ForceConstant;

model Motor \"a linear motor whose current is known\"
  extends Electrical.LinearMotorBase(emf = K*v, F = K*i);
  input Current demand;
  parameter ForceConstant K \"force per current\";
equation
  i = demand;
  slide.f = -F;
end Motor;
";

fn template_text(template: Template) -> &'static str {
    match template {
        Template::Screw => include_str!("../../templates/screw.txt"),
        Template::Belt => include_str!("../../templates/belt.txt"),
        Template::Rack => include_str!("../../templates/rack.txt"),
        Template::Linear => include_str!("../../templates/linear.txt"),
        Template::Table => include_str!("../../templates/table.txt"),
        Template::Bench => include_str!("../../templates/bench.txt"),
    }
}

/// A model with a loop of its own, which runs at once.
pub(super) fn with_a_loop(wish: &Wish, parts: &Parts) -> FirstModel {
    let text = format!("{}\n{}", model(wish, parts), controlled(wish, parts));
    FirstModel {
        text: ended(&text),
        notes: Vec::new(),
        experiment: "move",
    }
}

/// A model that a trace drives, with what it is compared with.
pub(super) fn with_a_trace(
    wish: &Wish,
    channels: &Channels,
    parts: &Parts,
    notes: Vec<String>,
) -> FirstModel {
    let text = format!("{}\n{}", model(wish, parts), studies(wish, channels, parts));
    FirstModel {
        text: ended(&text),
        notes,
        experiment: "trial",
    }
}

fn ended(text: &str) -> String {
    format!("{}\n", text.trim_end())
}

fn model(wish: &Wish, parts: &Parts) -> String {
    let template = wish.template;
    let head = if template.turns() { TURNS } else { SLIDES };
    let spread = if parts.both_ends {
        " ~ ±90% from \"guess\""
    } else {
        ""
    };
    let slides = template.slides();
    let unit =
        |sliding: &'static str, turning: &'static str| if slides { sliding } else { turning };
    let (stiffness, damping) = match template {
        Template::Screw | Template::Belt => ("N/m", "N.s/m"),
        Template::Rack | Template::Linear | Template::Table | Template::Bench => {
            ("N.m/rad", "N.m.s/rad")
        }
    };
    let ratio = match template {
        Template::Table => digits(parts.ratio, 6),
        Template::Screw | Template::Belt | Template::Rack | Template::Linear | Template::Bench => {
            format!("{} [mm/rev]", digits(parts.ratio * TAU * 1e3, 6))
        }
    };
    // Both channels decide a ratio to a part of what they are read to.
    let ratio_spread = if parts.both_ends {
        " ~ ±0.5% from \"the trace\""
    } else {
        ""
    };
    let constant = match template {
        Template::Linear => "N/A",
        Template::Screw | Template::Belt | Template::Rack | Template::Table | Template::Bench => {
            "N.m/A"
        }
    };
    let values = [
        ("@RATIO_FROM@", parts.ratio_from.to_owned()),
        ("@RATIO_SPREAD@", ratio_spread.to_owned()),
        ("@RATIO@", ratio),
        ("@K_FROM@", parts.constant_from.to_owned()),
        ("@K@", value(parts.constant, constant)),
        ("@J@", value(parts.rotor, "kg.m2")),
        ("@C_SPREAD@", spread.to_owned()),
        ("@C@", value(parts.stiffness, stiffness)),
        ("@DAMP@", value(parts.damping, damping)),
        ("@M_FROM@", parts.from.to_owned()),
        ("@M@", value(parts.mass, unit("kg", "kg.m2"))),
        ("@F@", value(parts.coulomb, unit("N", "N.m"))),
        ("@B@", value(parts.viscous, unit("N.s/m", "N.m.s/rad"))),
        ("@LEN@", value(parts.length, "m")),
        ("@D@", value(parts.diameter * 1e3, "mm")),
    ];
    let mut text = format!(
        "package {} \"{}\";\n{head}\n{}",
        wish.name,
        template.about(),
        template_text(template)
    );
    for (key, value) in values {
        text = text.replace(key, &value);
    }
    text
}

/// The axis with a position loop round a speed loop at its motor.
fn controlled(wish: &Wish, parts: &Parts) -> String {
    let template = wish.template;
    // The loop is tuned in the motor's units: a speed loop of 25 Hz.
    let bandwidth = TAU * 25.0;
    let gain = parts.inertia * bandwidth / parts.constant;
    let (shown, reference, speed, per) = match template {
        Template::Linear => (
            "axis.position",
            "sample(way.s)".to_owned(),
            "Velocity",
            "A.s/m",
        ),
        Template::Table => (
            "axis.motor_angle",
            "sample(way.s)*axis.n*1 [rad/m]".to_owned(),
            "AngularVelocity",
            "A.s/rad",
        ),
        Template::Bench => (
            "axis.motor_angle",
            "sample(way.s)*20 [rad/m]".to_owned(),
            "AngularVelocity",
            "A.s/rad",
        ),
        Template::Screw | Template::Belt | Template::Rack => (
            "axis.motor_angle",
            "sample(way.s)/axis.lead".to_owned(),
            "AngularVelocity",
            "A.s/rad",
        ),
    };
    let place = if speed == "Velocity" {
        "Length"
    } else {
        "Angle"
    };
    let integral = per.replace("A.s/", "A/");
    let (gain, integral, limit) = (
        value(gain, per),
        value(gain * bandwidth / 4.0, &integral),
        "30 [A]",
    );
    format!(
        "model Controlled \"the axis with a position loop round a speed loop\"
  Axis axis(i = hold(control.i_ref));
  Stroke way(distance = 0.2 [m], v_max = 0.2 [m/s], a_max = 2 [m/s2], begin = 50 [ms]); // confirm: the motion
  clocked control(1 [ms]) // confirm: sampling time and gains
    {place} r(start = 0) = {reference}, e(start = 0) = sample({shown});
    {speed} missing = 40 [1/s]*(r - e) + (r - pre(r))/interval() - (e - pre(e))/interval();
    Current int(start = 0) = clamp(pre(int) + {integral}*missing*interval(), -{limit}, {limit});
    Current i_ref = clamp({gain}*missing + int, -{limit}, {limit});
  end control;
end Controlled;

experiment move of Controlled \"a stroke\"
  figure motion = axis.position;
  figure current = axis.i;
  solve auto(rtol = 1e-6) stop 2 [s] every 1 [ms];
end move;
"
    )
}

/// Experiment, calibration and diagnosis of a model that a trace drives.
fn studies(wish: &Wish, channels: &Channels, parts: &Parts) -> String {
    let Some(first) = wish.traces.first() else {
        return String::new();
    };
    let drive = &channels.drive;
    let column = |name: &str| format!("log.{}", reference(name));
    let sign = if parts.reversed { "-" } else { "" };
    let per = match (drive.is_force, wish.template) {
        (false, _) => String::new(),
        (true, Template::Linear) => "/(1 [N/A])".to_owned(),
        (true, _) => "/(1 [N.m/A])".to_owned(),
    };
    let noise = match drive.is_force {
        false if drive.noise > 0.0 => format!(" ~ {}", value(drive.noise, &drive.unit)),
        _ => String::new(),
    };
    let confirm = match parts.reversed {
        true => " // confirm: it acts against the measured direction",
        false => " // confirm: its unit and direction",
    };
    let mut lines = format!(
        "  stimulus i = {sign}{}{per}{noise};{confirm}\n",
        column(&drive.name)
    );
    let sides = [
        (&channels.motor, "motor_", parts.motor_reversed),
        (&channels.load, "", false),
    ];
    for (measured, side, reversed) in sides {
        if let Some(measured) = measured {
            lines += &compared(measured, side, reversed, wish.template);
        }
    }
    let start = start(channels, parts, wish.template);
    let step = first.table.usual_step().unwrap_or(1e-3);
    let settings = match first.settings.as_str() {
        "" => String::new(),
        settings => format!(" {settings}"),
    };
    let fits = wish.traces.len().saturating_sub(1).max(1);
    let files = |from: usize, to: usize, word: &str| -> String {
        let own = wish.traces[from.min(wish.traces.len())..to.min(wish.traces.len())].iter();
        own.map(|trace| format!("  {word} trial({:?});\n", trace.file))
            .collect()
    };
    let holdout = match wish.traces.len() {
        1 => "  // A record that the calibration does not see tells whether it holds: holdout trial(\"other.csv\");\n".to_owned(),
        all => files(fits, all, "holdout"),
    };
    format!(
        "experiment trial(record log = {:?}{settings}) of Axis{start} \"driven by the trace\"
{lines}  solve auto(rtol = 1e-6) stop log.end every {};
end trial;

calibrate trial of Axis
{}{holdout}  vary uncertain;
end trial;

diagnose trial of calibrate trial
  candidates Effects.*;
  max_effects 3;
  seed 1;
end trial;
",
        first.file,
        value(step * 1e3, "ms"),
        files(0, fits, "fit"),
    )
}

/// A measured channel beside what it shows.
fn compared(measured: &Measured, side: &str, reversed: bool, template: Template) -> String {
    let shown = match (side, measured.is_speed) {
        ("motor_", false) => "motor_angle",
        ("motor_", true) => "motor_speed",
        (_, false) => "position",
        (_, true) => "speed",
    };
    let as_way = side == "motor_" && measured.is_way(template);
    let shown = if as_way {
        format!("lead*{shown}")
    } else {
        shown.to_owned()
    };
    let sign = if reversed && !as_way { "-" } else { "" };
    let quantised = match measured.step {
        Some(step) if step > 0.0 => format!("floor_to({shown}, {})", value(step, &measured.unit)),
        _ => shown.clone(),
    };
    // The noise of look has the quantisation in it.
    let rounding = measured.step.unwrap_or(0.0) / 12.0_f64.sqrt();
    let own = (measured.noise * measured.noise - rounding * rounding)
        .max(0.0)
        .sqrt();
    let noise = match (own > 0.3 * rounding, measured.step) {
        (true, _) if own > 0.0 => format!(" ~ {}", value(own, &measured.unit)),
        _ => String::new(),
    };
    let what = if side.is_empty() {
        "of the load"
    } else {
        "of the motor"
    };
    format!(
        "  measured {sign}log.{} = {quantised}{noise}; // confirm: it is {what}\n",
        reference(&measured.name)
    )
}

/// Where the axis begins, as far as its positions are measured.
fn start(channels: &Channels, parts: &Parts, template: Template) -> String {
    let first = |measured: &Measured| format!("log.{}.first", reference(&measured.name));
    let place = |measured: &&Measured| !measured.is_speed;
    let load = channels.load.as_ref().filter(place).map(first);
    let motor = channels.motor.as_ref().filter(place);
    let sign = if parts.motor_reversed { "-" } else { "" };
    let motor = motor.map(|motor| match (motor.is_way(template), template) {
        (true, Template::Linear) => first(motor),
        (true, _) => {
            let lead = digits(parts.ratio * TAU * 1e3, 6);
            format!("{}/({lead} [mm/rev])", first(motor))
        }
        (false, _) => format!("{sign}{}", first(motor)),
    });
    let starts = [("x0", load), ("motor0", motor)];
    let starts = starts
        .into_iter()
        .filter_map(|(name, first)| Some(format!("{name} = {}", first?)));
    let starts: Vec<String> = starts.collect();
    match starts.is_empty() {
        true => String::new(),
        false => format!("({})", starts.join(", ")),
    }
}

/// A column as an experiment writes it.
fn reference(name: &str) -> String {
    let mut letters = name.chars();
    let first = letters
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    let plain = first && letters.all(|c| c.is_ascii_alphanumeric() || c == '_');
    match plain && !hyde_syntax::is_reserved(name) {
        true => name.to_owned(),
        false => format!("{name:?}"),
    }
}

fn value(number_: f64, unit: &str) -> String {
    format!("{} [{unit}]", number(number_))
}

fn number(value: f64) -> String {
    digits(value, 4)
}

fn digits(value: f64, count: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", count - 1).parse().unwrap_or(value);
    match rounded.abs() {
        size if size == 0.0 || (1e-3..1e6).contains(&size) => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}
