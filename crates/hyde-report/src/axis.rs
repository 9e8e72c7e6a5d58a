//! What an axis shows: quantity, unit, and how its values are laid along it.

use crate::prefix;

/// An axis: what it is called, in which unit it is shown, and over which range.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity: `position`.
    pub label: String,
    /// The unit shown, in brackets behind the label: `mm`. No brackets if empty.
    pub unit: String,
    /// Shown value = value of the data times this: 1000 for metres shown in `mm`.
    pub factor: f64,
    /// How values are laid along the axis.
    pub scale: Scale,
    /// From where to where, in the unit of the data; `None` (or a range that cannot be shown): as the data need.
    pub range: Option<(f64, f64)>,
}

/// How values are laid along an [`Axis`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly, with ticks at 1, 2 or 5 times a power of ten.
    Linear,
    /// By decades; values that are not positive are left out.
    Log,
    /// Evenly, values being decibels: ticks at 20, 40, 60 where a linear axis has 20, 50, 100.
    Decibel,
    /// Evenly, values being degrees: ticks at 15, 30, 45, 90, 180 and multiples of 360.
    Degrees,
}

impl Axis {
    /// A linear axis that shows the data in the unit they have.
    #[must_use]
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            unit: unit.into(),
            factor: 1.0,
            scale: Scale::Linear,
            range: None,
        }
    }

    /// A linear axis for SI values, shown with the prefix that suits the largest of them: `m` becomes `µm`, `mm` or
    /// `m`, `A` becomes `mA`, `N` becomes `kN`, `N/m` becomes `N/µm`. A unit that is not in the table stays as it is.
    #[must_use]
    pub fn scaled(label: impl Into<String>, si_unit: &str, values: &[f64]) -> Self {
        Self::scaled_for(label, si_unit, values.iter().copied())
    }

    pub(crate) fn scaled_for(
        label: impl Into<String>,
        si_unit: &str,
        values: impl Iterator<Item = f64>,
    ) -> Self {
        let largest = values
            .filter(|value| value.is_finite())
            .fold(0.0, |most: f64, value| most.max(value.abs()));
        let (unit, factor) = prefix::shown_unit(si_unit, largest);
        Self {
            factor,
            ..Self::new(label, unit)
        }
    }

    /// The same axis laid out in another way.
    #[must_use]
    pub fn with_scale(self, scale: Scale) -> Self {
        Self { scale, ..self }
    }

    /// The same axis from `low` to `high`, in the unit of the data.
    #[must_use]
    pub fn with_range(self, low: f64, high: f64) -> Self {
        Self {
            range: Some((low, high)),
            ..self
        }
    }
}
