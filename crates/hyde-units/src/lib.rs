//! Dimensions, units and their conversion to SI.
//!
//! A [`Unit`] is read from text by [`parse_unit`]; it turns a value into SI where a number is read, and back where
//! one is printed. In between there is only SI. What remains of the unit is its [`Dimension`], which is multiplied
//! along with the quantities and compared by [`Dimension::agreement`] wherever two of them should be the same.
//!
//! Angles have no dimension in SI, and every drive has both `rad/s` and `Hz`, lengths and lengths per revolution. So
//! a dimension carries the exponent of the angle beside the base units; where two sides differ in nothing else the
//! answer is [`Agreement::AngleDiffers`], worth a warning. In a product the radian may be 1 by the physics (`v = w*r`), so the
//! angle of a [composed](Dimension::composed) dimension matches any. Torque, inertia and motor constants do not tell how often
//! the angle is in them (a stiffness in N.m/rad times rad is N.m), so they are [`AngleExponent::Neutral`] and match any.
//!
//! ```
//! use hyde_units::{Agreement, parse_unit};
//!
//! let lead = parse_unit("mm/rev")?;
//! assert_eq!(lead.to_si(10.0), 0.01 / std::f64::consts::TAU);
//! let advance = lead.dimension.multiply(parse_unit("deg")?.dimension);
//! assert_eq!(advance.agreement(parse_unit("um")?.dimension), Agreement::Same);
//! assert_eq!(parse_unit("Nm").unwrap_err().to_string(), "unknown unit `Nm`: write `N.m`");
//! # Ok::<(), hyde_units::UnitError>(())
//! ```

mod allowed;
mod angle;
mod count;
mod dimension;
mod displayed;
mod error;
mod exponent;
mod format;
mod in_name;
mod name;
mod parse;
mod scale;
mod spelled;
mod suggest;
mod symbol;
mod unit;

pub use allowed::{Allowed, Kind};
pub use angle::with_angle_of;
pub use count::counted;
pub use dimension::{Agreement, AngleExponent, Dimension};
pub use displayed::{difference_in, drawn_in, error_in, shown};
pub use error::{UnitError, UnitErrorKind};
pub use exponent::Exponent;
pub use format::{engineering, engineering_as, engineering_difference, format_value, significant};
pub use in_name::unit_in_name;
pub use parse::parse_unit;
pub use scale::Scale;
pub use spelled::parse_spelled;
pub use unit::{NamedUnit, Unit};
