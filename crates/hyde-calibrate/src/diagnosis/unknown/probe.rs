//! [`probe`]: an effect by which a force at a site is felt, and [`Point`]: what its sizes tell of the site.
//!
//! ```text
//! add a.f = -(probe_force + probe_by_place*a.s/(1 [m]) + probe_by_speed*v/(1 [m/s]) + probe_by_acceleration*acc/(1 [m/s2]))
//! ```
//! A unit of each size changes the equation in which the force stands by the force, by the place, by the speed: with the sizes
//! at 0 the run stays what it is, and the changes say where the site is.

use super::site::{Kind, Site, Written};
use hyde_ir::LawAxis;
use hyde_program::Program;
use nalgebra::DMatrix;

/// What the probe is called: no effect of a user is likely to be.
pub(crate) const PROBE: &str = "ProbeOfUnknown";

/// The size of the force, and those by place and by speed. No variable of a site is likely to be called so.
const FORCE: &str = "probe_force";
const OF_EACH: [(LawAxis, &str); 2] = [
    (LawAxis::Place, "probe_by_place"),
    (LawAxis::Speed, "probe_by_speed"),
];
/// The sizes by what not every site has.
const OF_SOME: [(LawAxis, &str); 2] = [
    (LawAxis::Acceleration, "probe_by_acceleration"),
    (LawAxis::Signal, "probe_by_signal"),
];

/// What the probes of a site tell beside place and speed, that which tells most first: a place that no state has cannot always
/// be differentiated twice.
pub(crate) fn probes(kind: &Kind) -> Vec<Vec<LawAxis>> {
    let mut some = OF_SOME.map(|(axis, _)| axis).to_vec();
    some.retain(|&axis| kind.named(axis).is_some());
    let mut all = vec![some.clone()];
    if some.len() > 1 {
        all.extend(some.iter().map(|&axis| vec![axis]));
    }
    if !some.is_empty() {
        all.push(Vec::new());
    }
    all
}

/// The probe of a site, or of a sensor's error, which tells some more.
pub(crate) fn probe(site: &Site, more: &[LawAxis]) -> Written {
    let kind = &site.kind;
    let unit = kind.force_unit();
    let size = format!("= 0 [{unit}] in -1 .. 1 [{unit}]");
    let mut sizes = format!("{FORCE} {size}");
    let mut law = FORCE.to_owned();
    let told = OF_SOME.iter().filter(|(axis, _)| more.contains(axis));
    for (axis, name) in OF_EACH.iter().chain(told) {
        if let Some(variable) = kind.named(*axis) {
            sizes.push_str(&format!(", {name} {size}"));
            let (own, of) = (&variable.text, variable.unit.si());
            law.push_str(&format!(" + {name}*{own}/(1 [{}])", of.text()));
        }
    }
    let read = |axis| OF_EACH.iter().any(|(own, _)| *own == axis) || more.contains(&axis);
    let clauses = kind.clauses(&format!("({law})"), &read);
    let host = &kind.host;
    Written {
        name: PROBE.to_owned(),
        text: format!("effect {PROBE} on {host}\n  size Real {sizes};\n{clauses}end {PROBE};\n"),
        site: site.path.clone(),
    }
}

/// The sizes that a probe of this path has in a program, the force first.
pub(crate) fn sizes_of(program: &Program, path: &str) -> Vec<String> {
    let names = OF_EACH.iter().chain(&OF_SOME).map(|(_, name)| *name);
    let names = std::iter::once(FORCE).chain(names);
    let names = names.map(|name| format!("{path}.{name}"));
    names
        .filter(|name| program.parameter(name).is_some())
        .collect()
}

/// Where a site is, and how it moves.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Point {
    pub(crate) place: f64,
    pub(crate) speed: f64,
    /// 0 where the probe does not tell it.
    pub(crate) acceleration: f64,
    /// What the site has beside them; 0 where there is nothing, or the probe does not tell it.
    pub(crate) signal: f64,
}

impl Point {
    /// From what the sizes of a probe behind the force add to the equation of the force, in units of the force.
    pub(crate) fn told(sizes: &[String], added: &[f64]) -> Self {
        let mut point = Self::default();
        for (name, value) in sizes.iter().skip(1).zip(added) {
            let mut known = OF_EACH.iter().chain(&OF_SOME);
            let axis = known.find(|(_, own)| name.ends_with(own));
            let place = match axis.map(|(axis, _)| axis) {
                Some(LawAxis::Place) => &mut point.place,
                Some(LawAxis::Speed) => &mut point.speed,
                Some(LawAxis::Acceleration) => &mut point.acceleration,
                Some(LawAxis::Signal) => &mut point.signal,
                Some(LawAxis::Time) | None => continue,
            };
            *place = *value;
        }
        point
    }
}

/// What each direction behind a unit of force adds to the equation that the force changes most, in units of the force.
pub(crate) fn strongest(added: &DMatrix<f64>) -> Option<Vec<f64>> {
    let unit = added.column(0);
    let largest = (0..unit.len()).max_by(|&a, &b| unit[a].abs().total_cmp(&unit[b].abs()));
    let at = largest.filter(|&at| unit[at] != 0.0)?;
    let others = 1..added.ncols();
    Some(
        others
            .map(|number| added[(at, number)] / unit[at])
            .collect(),
    )
}
