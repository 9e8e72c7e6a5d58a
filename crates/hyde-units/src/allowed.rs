//! The values that a quantity may have: its kind, and the least and the most of it.

use crate::{NamedUnit, format_value};

/// What kind of values a quantity has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Any number.
    #[default]
    Real,
    /// Whole numbers.
    Integer,
    /// 1 for true, 0 for false.
    Boolean,
}

/// The values that a quantity may have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Allowed {
    /// What kind of values.
    pub kind: Kind,
    /// The least of them, SI.
    pub min: Option<f64>,
    /// The most of them, SI.
    pub max: Option<f64>,
}

impl Allowed {
    /// Why a value (SI) is not among them; its unit is for the message.
    #[must_use]
    pub fn refusal(&self, si: f64, unit: &NamedUnit) -> Option<String> {
        let shown = |value| format_value(value, unit);
        let whole = si.fract() == 0.0;
        match self.kind {
            Kind::Integer if !whole => return Some("an Integer is a whole number".to_owned()),
            Kind::Boolean if si * (si - 1.0) != 0.0 => {
                return Some("a Boolean is `true` or `false`".to_owned());
            }
            Kind::Real | Kind::Integer | Kind::Boolean => {}
        }
        match (self.min, self.max) {
            (Some(min), _) if si < min => Some(format!("its `min` is {}", shown(min))),
            (_, Some(max)) if si > max => Some(format!("its `max` is {}", shown(max))),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_allowed_is_said_in_its_unit() {
        let mm = NamedUnit::parse("mm").unwrap();
        let one = NamedUnit::parse("1").unwrap();
        let stroke = Allowed {
            min: Some(0.0),
            max: Some(0.3),
            ..Allowed::default()
        };
        assert_eq!(stroke.refusal(0.3, &mm), None);
        assert_eq!(stroke.refusal(-0.001, &mm).unwrap(), "its `min` is 0 mm");
        assert_eq!(stroke.refusal(0.35, &mm).unwrap(), "its `max` is 300 mm");
        let teeth = Allowed {
            kind: Kind::Integer,
            ..Allowed::default()
        };
        assert_eq!(teeth.refusal(4.0, &one), None);
        assert_eq!(
            teeth.refusal(4.5, &one).unwrap(),
            "an Integer is a whole number"
        );
        let on = Allowed {
            kind: Kind::Boolean,
            ..Allowed::default()
        };
        assert_eq!(on.refusal(1.0, &one), None);
        assert_eq!(
            on.refusal(0.3, &one).unwrap(),
            "a Boolean is `true` or `false`"
        );
    }
}
