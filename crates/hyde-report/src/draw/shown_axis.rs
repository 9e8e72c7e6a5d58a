//! An axis with its range and ticks settled: where a value lies along it, and what is written beside it.

use super::range::{Room, automatic, usable};
use super::ticks::{Ticks, ticks};
use crate::number::power_of_ten;
use crate::{Axis, Scale};

/// An axis ready to be drawn. Values are in the unit shown.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ShownAxis {
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    /// Shown value = value of the data times this.
    pub(crate) factor: f64,
    pub(crate) scale: Scale,
    pub(crate) ticks: Ticks,
    label: String,
    unit: String,
}

impl ShownAxis {
    /// The axis over its own range, or over what `values` (in the unit of the data) need.
    pub(crate) fn new(axis: &Axis, values: impl Iterator<Item = f64>, room: Room) -> Self {
        let shown = |value: f64| value * axis.factor;
        let asked = axis
            .range
            .and_then(|(lo, hi)| usable((shown(lo), shown(hi)), axis.scale));
        let (lo, hi) = asked.unwrap_or_else(|| automatic(values.map(shown), axis.scale, room));
        let (label, unit) = (axis.label.clone(), axis.unit.clone());
        Self {
            lo,
            hi,
            factor: axis.factor,
            scale: axis.scale,
            ticks: Ticks::default(),
            label,
            unit,
        }
    }

    /// Sets about `at_most` labelled ticks.
    pub(crate) fn divide(&mut self, at_most: usize) {
        self.ticks = ticks(self.scale, self.lo, self.hi, at_most);
    }

    /// Where a value (as shown) lies: 0 at the low end, 1 at the high end; NaN if the axis cannot show it.
    pub(crate) fn fraction(&self, shown: f64) -> f64 {
        let along = |value: f64| {
            if self.scale == Scale::Log {
                value.max(0.0).log10()
            } else {
                value
            }
        };
        let at = along(shown);
        let part = (at - along(self.lo)) / (along(self.hi) - along(self.lo));
        // Far outside is far enough; infinite is nowhere.
        if at.is_finite() {
            part.clamp(-1e6, 1e6)
        } else {
            f64::NAN
        }
    }

    /// `label [unit]`, with the power of ten of the tick labels.
    pub(crate) fn title(&self) -> String {
        let power = match self.ticks.exponent {
            0 => String::new(),
            exponent => power_of_ten(exponent),
        };
        match (power.is_empty(), self.unit.is_empty()) {
            (true, true) => self.label.clone(),
            (false, true) => format!("{} [{power}]", self.label),
            (true, false) => format!("{} [{}]", self.label, self.unit),
            (false, false) => format!("{} [{power} {}]", self.label, self.unit),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_show_unit_and_power() {
        let values = [0.0, 3e7];
        let mut axis = ShownAxis::new(&Axis::new("angle", "rad"), values.into_iter(), Room::Tight);
        axis.divide(4);
        assert_eq!(axis.title(), "angle [10⁶ rad]");
        let mut bare = ShownAxis::new(&Axis::new("ratio", ""), [0.0, 1.0].into_iter(), Room::Tight);
        bare.divide(4);
        assert_eq!(bare.title(), "ratio");
    }

    #[test]
    fn fractions_along_linear_and_log_axes() {
        let metres = Axis {
            factor: 1e3,
            ..Axis::new("x", "mm")
        };
        let linear = ShownAxis::new(
            &metres.with_range(0.0, 0.2),
            std::iter::empty(),
            Room::Tight,
        );
        assert!((linear.fraction(50.0) - 0.25).abs() < 1e-12); // rounding only
        assert!(linear.fraction(f64::NAN).is_nan());
        let axis = Axis::new("f", "Hz")
            .with_scale(Scale::Log)
            .with_range(1.0, 100.0);
        let log = ShownAxis::new(&axis, std::iter::empty(), Room::Tight);
        assert!((log.fraction(10.0) - 0.5).abs() < 1e-12); // rounding only
        assert!(log.fraction(0.0).is_nan() && log.fraction(-1.0).is_nan());
    }
}
