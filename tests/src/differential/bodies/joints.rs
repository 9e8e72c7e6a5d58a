//! The parts between two bodies: springs, dampers, contacts, gears, racks, shafts, clutches.

use super::{Joint, Net};

impl Net {
    /// What is between two bodies.
    pub(super) fn join(&mut self, from: usize, to: usize, joint: Joint) {
        let name = format!("{from}_{to}");
        let (start, end) = (format!("body{from}.b"), format!("body{to}.a"));
        match joint {
            Joint::Compliant(which) => self.compliant(&name, which, (from, to), &start, &end),
            Joint::Geared(which) => {
                let ratio = self.ratio();
                self.declare(&format!("IdealGear gear{name}(ratio = {ratio})"));
                self.connect(&format!("{start}, gear{name}.a"));
                self.compliant(&name, which, (from, to), &format!("gear{name}.b"), &end);
            }
            Joint::Rigid | Joint::Lossy => {
                let ratio = self.ratio();
                let length = self.numbers.between(-0.1, 0.1);
                self.declare(&match (self.turns(from), joint) {
                    (true, Joint::Lossy) => format!(
                        "LossyGear link{name}(ratio = {ratio}, eta_mf1 = 0.95, eta_mf2 = 0.9, tau_bf1 = 0.1 [N.m], tau_bf2 = 0.1 [N.m])"
                    ),
                    (true, _) => format!("IdealGear link{name}(ratio = {ratio})"),
                    (false, _) => format!("Rod link{name}(L = {length} [m])"),
                });
                self.connect(&format!("{start}, link{name}.a"));
                self.connect(&format!("link{name}.b, {end}"));
            }
            Joint::Shaft => {
                let (length, diameter) = (
                    self.numbers.between(0.3, 1.0),
                    self.numbers.between(8.0, 20.0),
                );
                let cells = 3 + self.numbers.one_of(6);
                self.declare(&format!(
                    "Rotational.Shaft link{name}(len = {length} [m], d = {diameter} [mm], tv = 0.05 [ms], n = {cells})"
                ));
                self.connect(&format!("{start}, link{name}.a"));
                self.connect(&format!("link{name}.b, {end}"));
            }
            Joint::Clutch => {
                let size = self.numbers.between(1.0, 20.0);
                let instant = self.numbers.between(0.02, 0.25);
                self.declare(&format!(
                    "Clutch link{name}(f_normalized = if time < {instant} [s] then 0 else 1, fn_max = {size} [N])"
                ));
                self.connect(&format!("{start}, link{name}.a"));
                self.connect(&format!("link{name}.b, {end}"));
            }
            Joint::Rack | Joint::RigidRack => self.rack(&name, from, to, joint),
        }
    }

    /// Between a body that turns and one that slides.
    fn rack(&mut self, name: &str, from: usize, to: usize, joint: Joint) {
        let ratio = self.numbers.between(2.0, 20.0);
        self.declare(&format!("IdealGearR2T rack{name}(ratio = {ratio} [rad/m])"));
        let (turning, sliding) = match self.turns(from) {
            true => (format!("body{from}.b"), format!("body{to}.a")),
            false => (format!("body{to}.a"), format!("body{from}.b")),
        };
        self.connect(&format!("{turning}, rack{name}.a"));
        if joint == Joint::RigidRack {
            self.connect(&format!("rack{name}.b, {sliding}"));
            return;
        }
        let (stiffness, damping) = (
            self.numbers.between(500.0, 20_000.0),
            self.numbers.between(0.5, 20.0),
        );
        self.declare(&format!(
            "Translational.SpringDamper link{name}(c = {stiffness} [N/m], d = {damping} [N.s/m])"
        ));
        self.connect(&format!("rack{name}.b, link{name}.a"));
        self.connect(&format!("link{name}.b, {sliding}"));
    }

    /// A ratio of a gear, not near zero.
    fn ratio(&mut self) -> f64 {
        let size = self.numbers.between(0.5, 3.0);
        if self.numbers.one_of(2) == 0 {
            -size
        } else {
            size
        }
    }

    /// A compliant part between two ends.
    fn compliant(
        &mut self,
        name: &str,
        which: u64,
        (from, to): (usize, usize),
        start: &str,
        end: &str,
    ) {
        let stiffness = self.numbers.between(500.0, 20_000.0);
        let damping = self.numbers.between(0.5, 20.0);
        let play = self.numbers.between(0.0001, 0.01);
        let geared = !start.starts_with("body");
        if !self.turns(from) && which < 2 {
            let contact = match which {
                0 => format!("Contact link{name}(k = {stiffness} [N/m], c = {damping} [N.s/m]"),
                _ => format!(
                    "GapContact link{name}(k = {stiffness} [N/m], c = {damping} [N.s/m], gap = {play} [m]"
                ),
            };
            self.parameters.push(format!("link{name}.k"));
            self.declare(&format!("{contact}, e = body{from}.s - body{to}.s)"));
            self.declare(&format!(
                "Translational.Drive on{name}(F = -link{name}.F), from{name}(F = link{name}.F)"
            ));
            self.connect(&format!("on{name}.a, {start}"));
            self.connect(&format!("from{name}.a, {end}"));
            return;
        }
        if self.turns(from) && which == 2 && !geared {
            // A spring that stiffens, by plain equations: it has no account, so it is supplied.
            self.declare(&format!(
                "Angle twist{name} = body{from}.phi - body{to}.phi"
            ));
            self.declare(&format!(
                "Torque torque{name} = {stiffness} [N.m/rad]*twist{name}*(1 + 3*(twist{name}/(1 [rad]))^2)"
            ));
            self.declare(&format!(
                "Rotational.Drive on{name}(T = -torque{name}), from{name}(T = torque{name})"
            ));
            self.connect(&format!("on{name}.a, {start}"));
            self.connect(&format!("from{name}.a, {end}"));
            self.powers
                .push(format!("torque{name}*(body{to}.w - body{from}.w)"));
            return;
        }
        let has_stiffness = which != 4;
        let part = match (self.turns(from), which) {
            (false, 2) => format!(
                "ElastoGap link{name}(c = {stiffness} [N/m], d = {damping} [N.s/m], s_rel0 = {play} [m])"
            ),
            (false, 3) => format!("Translational.Spring link{name}(c = {stiffness} [N/m])"),
            (false, 4) => format!("Translational.Damper link{name}(d = {damping} [N.s/m])"),
            (false, _) => format!(
                "Translational.SpringDamper link{name}(c = {stiffness} [N/m], d = {damping} [N.s/m])"
            ),
            (true, 0) => format!(
                "ElastoBacklash link{name}(c = {stiffness} [N.m/rad], d = {damping} [N.m.s/rad], b0 = {play} [rad])"
            ),
            (true, 1 | 2) => format!(
                "ElastoBacklash2 link{name}(c = {stiffness} [N.m/rad], d = {damping} [N.m.s/rad], b0 = {play} [rad])"
            ),
            (true, 3) => format!("Rotational.Spring link{name}(c = {stiffness} [N.m/rad])"),
            (true, 4) => format!("Rotational.Damper link{name}(d = {damping} [N.m.s/rad])"),
            (true, _) => format!(
                "Rotational.SpringDamper link{name}(c = {stiffness} [N.m/rad], d = {damping} [N.m.s/rad])"
            ),
        };
        if has_stiffness {
            self.parameters.push(format!("link{name}.c"));
        }
        self.declare(&part);
        self.connect(&format!("{start}, link{name}.a"));
        self.connect(&format!("link{name}.b, {end}"));
    }
}
