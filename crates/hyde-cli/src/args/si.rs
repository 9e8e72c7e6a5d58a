//! A time or a frequency as an option has it: `0.5`, which is in the SI unit, or `500 [ms]`.

use hyde_study::settings;
use hyde_units::Dimension;

/// A time in s.
///
/// # Errors
/// What to write instead, where it is no time.
pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    value(text, Dimension::TIME).ok_or_else(|| wanted("a time in s, `0.5`", "500 [ms]"))
}

/// A frequency in Hz.
///
/// # Errors
/// What to write instead, where it is no frequency.
pub(crate) fn hertz(text: &str) -> Result<f64, String> {
    let wanted = || wanted("a frequency in Hz, `500`", "0.5 [kHz]");
    value(text, Dimension::FREQUENCY).ok_or_else(|| match angular(text) {
        Some(hertz) => {
            let hertz = hyde_units::significant(hertz, 6);
            format!(
                "it is an angular frequency; {}: `{hertz}` is the same",
                wanted()
            )
        }
        None => wanted(),
    })
}

/// The frequency in Hz of an angular frequency with its unit.
fn angular(text: &str) -> Option<f64> {
    let number = text.split_once("[rad/s]")?.0;
    let value: f64 = number.trim().parse().ok()?;
    Some(value / std::f64::consts::TAU)
}

fn wanted(plain: &str, with_unit: &str) -> String {
    format!("write {plain}, or with its unit, `'{with_unit}'`")
}

/// The value of a text. What is not finite is a number too: the command says why it cannot be meant.
fn value(text: &str, dimension: Dimension) -> Option<f64> {
    let plain = text.trim().parse().ok();
    plain.or_else(|| settings::quantity(text, dimension))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_may_have_its_unit() {
        for text in ["0.5", "5e-1", "0.5 [s]", "500 [ms]"] {
            assert!((seconds(text).unwrap() - 0.5).abs() < 1e-15, "{text}");
        }
        for text in ["soon", "0.5 [m]", "0.5 [Hz]", "true", ""] {
            assert!(seconds(text).unwrap_err().contains("500 [ms]"), "{text}");
        }
    }

    #[test]
    fn a_frequency_may_have_its_unit() {
        for text in ["500", "500 [Hz]", "0.5 [kHz]", "30000 [1/min]"] {
            assert!((hertz(text).unwrap() - 500.0).abs() < 1e-9, "{text}");
        }
        // An angular frequency is another quantity.
        for text in ["500 [rad/s]", "500 [s]"] {
            assert!(hertz(text).unwrap_err().contains("0.5 [kHz]"), "{text}");
        }
        let refused = hertz("400 [rad/s]").unwrap_err();
        assert!(refused.contains("`63.662` is the same"), "{refused}");
    }
}
