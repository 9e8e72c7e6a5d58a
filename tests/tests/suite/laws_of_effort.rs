//! Laws of what drives and of what is lost: of an acceleration and its direction, of losses behind a low pass.

use crate::unknown_effects::{AMPLIFIER, diagnosed, diagnosed_on, law_alone};
use serde_json::Value;

/// The size of the law that was found, or a constant of its shape.
fn size(found: &Value) -> f64 {
    found["effects"][0]["size"].as_f64().unwrap()
}

fn constant(found: &Value, name: &str) -> f64 {
    let shape = &found["effects"][0]["shape"];
    shape[name]["value"].as_f64().unwrap()
}

/// A sign that no speed and no place has: it grips while it is accelerated, and lets go while it is braked.
#[test]
fn a_friction_that_goes_with_the_acceleration_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Translational.Guide
           wrap grip by grip + 25 [N]*tanh(der(v)/(0.3 [m/s2]));
           wrap hold by hold + 25 [N]*tanh(der(v)/(0.3 [m/s2]));
         end Odd;",
        " with Odd on guide",
    );
    let law = law_alone(&found);
    assert!(law.contains("wrap grip by grip + F*tanh(acc/a0);"), "{law}");
    assert!(law.contains("Real acc = der(v);"), "{law}");
    let size = size(&found);
    assert!((size / 25.0 - 1.0).abs() < 0.05, "{size}");
    let a0 = constant(&found, "a0");
    assert!((a0 / 0.3 - 1.0).abs() < 0.2, "{a0}");
}

/// A table that takes something along in one direction.
#[test]
fn a_mass_of_one_direction_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Translational.Rail
           add a.f = 12 [kg]*tanh(v/(2 [mm/s]))*der(v);
           Velocity v = der(a.s);
         end Odd;",
        " with Odd on saddle.a",
    );
    let law = law_alone(&found);
    assert!(law.contains("acc/acc1"), "{law}");
    assert!(law.contains("Real acc = der("), "{law}");
}

/// The losses of viscous friction, behind a low pass.
#[test]
fn a_friction_that_goes_with_viscous_losses_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Translational.Guide
           Real warm(start = 0, fixed = true);
           wrap grip by grip + 25 [N]*warm;
           wrap hold by hold + 25 [N]*warm;
         equation
           der(warm) = ((v/(100 [mm/s]))^2 - warm)/(0.15 [s]);
         end Odd;",
        " with Odd on guide",
    );
    let law = law_alone(&found);
    assert!(law.contains("wrap grip by grip + F*warmth_tau;"), "{law}");
    let filter = "tau*der(warmth_tau) = (v/v1)^2 - warmth_tau;";
    assert!(law.contains(filter), "{law}");
    let tau = constant(&found, "tau");
    assert!((tau / 0.15 - 1.0).abs() < 0.1, "{tau}");
    // 25 N at 100 mm/s are 100 N at the 200 mm/s that sizes are given at.
    let size = size(&found);
    assert!((size / 100.0 - 1.0).abs() < 0.1, "{size}");
}

/// Friction that warms by its own losses: the force that the guide has beside place and speed, times the speed.
#[test]
fn a_friction_that_goes_with_its_own_losses_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Translational.Guide
           Real warm(start = 0, fixed = true);
           wrap grip by grip - 30 [N]*warm;
           wrap hold by hold - 30 [N]*warm;
         equation
           der(warm) = (a.f*v/(20 [W]) - warm)/(0.2 [s]);
         end Odd;",
        " with Odd on guide",
    );
    let law = law_alone(&found);
    assert!(law.contains("wrap grip by grip + F*lost_tau;"), "{law}");
    let filter = "tau*der(lost_tau) = a.f/u1*v/v1 - lost_tau;";
    assert!(law.contains(filter), "{law}");
    let tau = constant(&found, "tau");
    assert!((tau / 0.2 - 1.0).abs() < 0.1, "{tau}");
}

/// A tacho whose gain goes with the current of the motor beside it.
#[test]
fn a_tacho_whose_gain_goes_with_a_current_is_found_and_written() {
    let tacho = "  Tachogenerator tacho(K_ta = 0.05 [V.s/rad]";
    let beside = "  Tachogenerator tacho(i = i, K_ta = 0.05 [V.s/rad]";
    let changes: Vec<(&str, &str)> = AMPLIFIER.into_iter().chain([(tacho, beside)]).collect();
    let found = diagnosed_on(
        &changes,
        "effect Odd on Tachogenerator
           wrap V6 by V6 + K_ta*w*0.002*i/(1 [A]);
         end Odd;",
        " with Odd on tacho",
        "few",
    );
    let law = law_alone(&found);
    assert_eq!(found["effects"][0]["site"], "tacho");
    assert!(law.contains("wrap V6 by V6 + U*w/w1*i/u1;"), "{law}");
}

/// A winding that warms by its own losses, and gives less for its current then.
#[test]
fn a_drive_that_weakens_as_its_current_warms_it_is_found_and_written() {
    let found = diagnosed_on(
        &AMPLIFIER,
        "effect Odd on Electrical.CurrentAmplifier
           Real heat(start = 0, fixed = true);
           wrap demand by demand*(1 - 0.1*heat);
         equation
           der(heat) = ((i_ref/(50 [A]))^2 - heat)/(0.2 [s]);
         end Odd;",
        " with Odd on amplifier",
        "few",
    );
    let law = law_alone(&found);
    assert_eq!(found["effects"][0]["site"], "amplifier");
    let text = "wrap demand by demand + I*i_ref/x1*heat_tau;";
    assert!(law.contains(text), "{law}");
    let filter = "tau*der(heat_tau) = (i_ref/x1)^2 - heat_tau;";
    assert!(law.contains(filter), "{law}");
    let tau = constant(&found, "tau");
    assert!((tau / 0.2 - 1.0).abs() < 0.1, "{tau}");
}

/// A reading head whose holder bends as it is accelerated.
#[test]
fn an_error_of_the_scale_that_goes_with_the_acceleration_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Translational.PositionSensor
           wrap s by s - 3 [um]*der(v)/(1 [m/s2]);
           Velocity v = der(a.s);
         end Odd;",
        " with Odd on scale",
    );
    let law = law_alone(&found);
    assert_eq!(found["effects"][0]["site"], "scale");
    assert!(law.contains("wrap s by s + e*acc/acc1;"), "{law}");
}
