//! [`Grid`]: the values of an effect's shapes that a scan tries.
//!
//! One shape is varied, the others stay as declared. What is a period or an order has a peak as narrow as the axis goes far:
//! half a turn over all of it more or less, and nothing is left of the gain. So it is looked for in two steps: over parts of
//! a second, each with sizes of its own, where peaks are wide; and finely around the best of those. What else is missing
//! leads the first of them astray, so there are several, and whole orders are tried for themselves.

use super::hypothesis::{Hypothesis, Knob};

/// Numerics: nodes of a shape at most.
const NODES: usize = 12;
/// Numerics: nodes of a resonance, and of a period around each place that is looked at finely.
const FINE: usize = 24;
/// Numerics: nodes of a period or an order: so many by ratio, so many evenly spread over orders, and whole orders.
const PERIODIC_NODES: usize = 64;
/// Numerics: nodes nearer than this to a whole order are it.
const WHOLE: f64 = 0.02;
/// Numerics: nodes are beside each other up to so many steps.
const BESIDE: f64 = 1.5;

/// The values that are tried.
pub(crate) struct Grid<'h> {
    hypothesis: &'h Hypothesis,
    /// The shape that is varied.
    axis: Option<usize>,
    /// Its values, rising in its own measure.
    values: Vec<f64>,
}

impl<'h> Grid<'h> {
    /// A grid of the shape that is varied: a period, an order or a resonance, else the first.
    pub(crate) fn new(hypothesis: &'h Hypothesis) -> Self {
        let first = (!hypothesis.shapes.is_empty()).then_some(0);
        let axis = hypothesis.periodic.or(hypothesis.resonant).or(first);
        let mut grid = Self {
            hypothesis,
            axis,
            values: Vec::new(),
        };
        if let Some(axis) = axis {
            grid.values = grid.coarse(&hypothesis.shapes[axis]);
        }
        grid
    }

    /// All of them.
    pub(crate) fn shapes(&self) -> Vec<Vec<f64>> {
        match self.axis {
            None => vec![self.declared()],
            Some(_) => self.with(&self.declared(), &self.values),
        }
    }

    /// Around so many places at most of the grid that gain most where parts of a second are apart, for what is periodic. What does
    /// not reach the gate there does not reach it with one size for all parts.
    pub(crate) fn fine(&self, gains: &[f64], most: usize, gate: f64) -> Vec<Vec<f64>> {
        let Some(axis) = self.hypothesis.periodic else {
            return Vec::new();
        };
        let mut order: Vec<usize> = (0..gains.len()).filter(|&k| gains[k] >= gate).collect();
        order.sort_by(|&a, &b| gains[b].total_cmp(&gains[a]));
        let mut places: Vec<usize> = Vec::new();
        for k in order {
            if places.len() < most && places.iter().all(|place| place.abs_diff(k) > 1) {
                places.push(k);
            }
        }
        let shape = &self.hypothesis.shapes[axis];
        let mut values: Vec<f64> = Vec::new();
        for place in places {
            let (low, high) = self.around(self.values[place]);
            let parts = (0..FINE).map(|k| (k as f64 + 0.5) / FINE as f64);
            values.extend(parts.map(|part| self.value(low + (high - low) * part)));
        }
        if shape.integer {
            values.iter_mut().for_each(|value| *value = value.round());
            values.sort_by(f64::total_cmp);
            values.dedup();
            values.retain(|value| self.values.iter().all(|known| (known - value).abs() > 0.5));
        }
        self.with(&self.declared(), &values)
    }

    /// Values between a node and its neighbours.
    pub(crate) fn between(&self, best: &[f64]) -> Vec<Vec<f64>> {
        let Some(axis) = self
            .axis
            .filter(|&axis| !self.hypothesis.shapes[axis].integer)
        else {
            return Vec::new();
        };
        let (at, step) = (self.measure(best[axis]), self.step(best[axis]));
        let (low, high) = self.hypothesis.shapes[axis].range;
        let parts = [-0.75, -0.5, -0.25, 0.25, 0.5, 0.75];
        let values = parts.map(|part| self.value(at + part * step).clamp(low, high));
        self.with(best, &values)
    }

    /// Whether two nodes are so near each other that fits from them end at one place.
    pub(crate) fn beside(&self, a: &[f64], b: &[f64]) -> bool {
        self.axis.is_none_or(|axis| {
            let apart = self.measure(a[axis]) - self.measure(b[axis]);
            apart.abs() <= BESIDE * self.step(a[axis])
        })
    }

    fn declared(&self) -> Vec<f64> {
        self.hypothesis
            .shapes
            .iter()
            .map(|shape| shape.value)
            .collect()
    }

    fn with(&self, shapes: &[f64], values: &[f64]) -> Vec<Vec<f64>> {
        let one = |&value: &f64| {
            let mut shapes = shapes.to_vec();
            if let Some(axis) = self.axis {
                shapes[axis] = value;
            }
            shapes
        };
        values.iter().map(one).collect()
    }

    /// What the varied shape is measured in: an order by itself, a period by its inverse, a wide range by its logarithm.
    fn measure(&self, value: f64) -> f64 {
        match self.kind() {
            Measure::Itself => value,
            Measure::Inverse => 1.0 / value,
            Measure::Logarithm => value.ln(),
        }
    }

    fn value(&self, measure: f64) -> f64 {
        match self.kind() {
            Measure::Itself => measure,
            Measure::Inverse => 1.0 / measure,
            Measure::Logarithm => measure.exp(),
        }
    }

    fn kind(&self) -> Measure {
        let Some(shape) = self.axis.map(|axis| &self.hypothesis.shapes[axis]) else {
            return Measure::Itself;
        };
        let order = shape.is_number();
        match self.hypothesis.periodic {
            Some(_) if order || shape.range.0 <= 0.0 => Measure::Itself,
            Some(_) => Measure::Inverse,
            None if by_ratio(shape) => Measure::Logarithm,
            None => Measure::Itself,
        }
    }

    /// How far nodes are apart around a value, in its measure; of what is periodic, those of the fine grid.
    fn step(&self, value: f64) -> f64 {
        let (low, high) = self.around(value);
        let steps = match self.hypothesis.periodic {
            Some(_) => FINE as f64,
            None => 2.0,
        };
        (high - low).abs() / steps
    }

    /// The neighbours of a value in the grid, in its measure.
    fn around(&self, value: f64) -> (f64, f64) {
        let measures = self.values.iter().map(|&value| self.measure(value));
        let at = self.measure(value);
        let near = 1e-9 * (1.0 + at.abs());
        let low = measures.clone().filter(|&m| m < at - near);
        let high = measures.filter(|&m| m > at + near);
        let (low, high) = (
            low.fold(f64::NEG_INFINITY, f64::max),
            high.fold(f64::INFINITY, f64::min),
        );
        match (low.is_finite(), high.is_finite()) {
            (true, true) => (low, high),
            (true, false) => (low, at),
            (false, true) => (at, high),
            (false, false) => (at, at),
        }
    }

    fn coarse(&self, shape: &Knob) -> Vec<f64> {
        let (low, high) = shape.range;
        let most = match (self.hypothesis.periodic, self.hypothesis.resonant) {
            (Some(_), _) => PERIODIC_NODES,
            (None, Some(_)) => FINE,
            (None, None) => NODES,
        };
        if shape.integer && high - low < (2 * most) as f64 {
            let count = (high - low).round().max(0.0) as usize + 1;
            return (0..count).map(|k| low + k as f64).collect();
        }
        let parts = || (0..most).map(|k| (k as f64 + 0.5) / most as f64);
        let mut values: Vec<f64> = match by_ratio(shape) {
            true => parts().map(|part| low * (high / low).powf(part)).collect(),
            false => parts().map(|part| low + (high - low) * part).collect(),
        };
        if self.hypothesis.periodic.is_some() {
            let (from, to) = (self.measure(low), self.measure(high));
            values.extend(parts().map(|part| self.value(from + (to - from) * part)));
            // What is fixed to a shaft comes back with each turn: the peak there is not left to the places looked at finely.
            if shape.is_number() && !shape.integer {
                values.retain(|value| (value - value.round()).abs() > WHOLE);
                let (first, last) = (low.ceil().max(1.0) as u32, high.floor() as u32);
                values.extend((first..=last).map(f64::from).take(most));
            }
        }
        if shape.integer {
            values.push(shape.value);
            values.iter_mut().for_each(|value| *value = value.round());
        }
        values.sort_by(|a, b| self.measure(*a).total_cmp(&self.measure(*b)));
        values.dedup();
        values
    }
}

/// What a shape is measured in.
enum Measure {
    Itself,
    Inverse,
    Logarithm,
}

/// Whether nodes follow each other by a ratio.
fn by_ratio(shape: &Knob) -> bool {
    let (low, high) = shape.range;
    low > 0.0 && high / low > 4.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_orders_are_nodes_with_none_beside_them() {
        let order = Knob {
            name: "order".to_owned(),
            value: 1.0,
            range: (0.5, 20.0),
            integer: false,
            unit: hyde_units::NamedUnit::usual(hyde_units::Dimension::DIMENSIONLESS),
        };
        let hypothesis = Hypothesis {
            effect: "LeadError".to_owned(),
            site: "screw".to_owned(),
            aliases: Vec::new(),
            sizes: Vec::new(),
            shapes: vec![order],
            periodic: Some(0),
            resonant: None,
            recurs: true,
        };
        let grid = Grid::new(&hypothesis);
        for whole in (1..=20).map(f64::from) {
            let near = |value: &&f64| (*value - whole).abs() <= WHOLE;
            let nodes: Vec<&f64> = grid.values.iter().filter(near).collect();
            assert_eq!(nodes, [&whole]);
        }
    }
}
