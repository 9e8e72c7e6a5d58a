//! Two effects that hide each other: neither gains enough alone, both together do.

use crate::driven_body::{SLOW, diagnosed};

/// How much later the second force is, in rad: nearly the first one's opposite, so that alone either gains next to nothing.
const LATER: f64 = 0.14;
/// Both forces in N, and how fast they swing in rad/s.
const FORCE: f64 = 1.0;
const SWING: f64 = 40.0;

const EARLY: &str = "effect Early on Rail
  size Force F = 0 in -50 .. 50 [N];
  add a.f = -F*sin(40 [rad/s]*time);
end Early;
";

const LATE: &str = "effect Late on Rail
  size Force F = 0 in -50 .. 50 [N];
  add a.f = -F*sin(40 [rad/s]*time + 0.14);
end Late;
";

#[test]
fn two_effects_that_hide_each_other_are_found_together() {
    let found = diagnosed(&[EARLY, LATE, SLOW], |t| {
        // The integral of cos(3 t) + sin(40 t) - sin(40 t + 0.14) with a mass of 1 kg.
        let early = (1.0 - (SWING * t).cos()) / SWING;
        let late = (LATER.cos() - (SWING * t + LATER).cos()) / SWING;
        let v = (3.0 * t).sin() / 3.0 + FORCE * (early - late);
        ((3.0 * t).cos(), v)
    });
    assert_eq!(found["verdict"], "effect");
    assert_eq!(found["unexplained"], false);
    let effects = found["effects"].as_array().unwrap();
    let of = |name: &str| -> f64 {
        let own = effects.iter().find(|effect| effect["effect"] == name);
        own.unwrap_or_else(|| panic!("{}", found["sentence"]))["size"]
            .as_f64()
            .unwrap()
    };
    assert_eq!(effects.len(), 2);
    assert!((of("Early") - FORCE).abs() < 0.03, "{}", found["sentence"]);
    assert!((of("Late") + FORCE).abs() < 0.03, "{}", found["sentence"]);
}

/// A swing of any frequency, and a chord of three that is nearly the first one's opposite in the middle.
const SWINGS: &str = "effect Swings on Rail
  size Force F = 0 in -50 .. 50 [N];
  shape AngularVelocity w = 35 [rad/s] in 20 .. 80 [rad/s];
  add a.f = -F*sin(w*time);
end Swings;
";

const CHORD: &str = "effect Chord on Rail
  size Force F = 0 in -50 .. 50 [N];
  add a.f = -F*(1.5*sin(30 [rad/s]*time) - 0.7*sin(40 [rad/s]*time) + 0.2*sin(50 [rad/s]*time));
end Chord;
";

/// Alone the swing is best at the chord's 30 rad/s. Beside it the chord stands for some of what is left; no fit leads the
/// swing from there to its 40 rad/s.
#[test]
fn a_shape_that_was_led_away_is_sought_anew() {
    let found = diagnosed(&[SWINGS, CHORD], |t| {
        let tone = |w: f64| (1.0 - (w * t).cos()) / w;
        let v = (3.0 * t).sin() / 3.0 + 1.5 * tone(30.0) + 0.3 * tone(40.0) + 0.2 * tone(50.0);
        ((3.0 * t).cos(), v)
    });
    assert_eq!(found["verdict"], "effect", "{}", found["sentence"]);
    assert_eq!(found["unexplained"], false);
    let effects = found["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 2, "{}", found["sentence"]);
    let of = |name: &str| {
        let own = effects.iter().find(|effect| effect["effect"] == name);
        own.unwrap_or_else(|| panic!("{}", found["sentence"]))
    };
    let size = |name: &str| of(name)["size"].as_f64().unwrap();
    assert!((size("Swings") - 1.0).abs() < 0.03, "{}", found["sentence"]);
    assert!((size("Chord") - 1.0).abs() < 0.03, "{}", found["sentence"]);
    let w = of("Swings")["shape"]["w"]["value"].as_f64().unwrap();
    assert!((w - 40.0).abs() < 0.1, "{}", found["sentence"]);
}
