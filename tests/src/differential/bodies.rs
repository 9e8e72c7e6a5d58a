//! Bodies that slide or turn, joined to a chain, a tree or a loop by parts of the library, with frictions, stops, gears, shafts
//! and drives that follow the time, a clock, a delay or a relation.

mod joints;

use super::model::Model;
use crate::numbers::Numbers;
use std::fmt::Write as _;

/// The model of a seed.
pub(crate) fn random(seed: u64) -> Model {
    let mut numbers = Numbers::of(seed);
    let count = 2 + numbers.one_of(4) as usize;
    let turns = numbers.one_of(2) == 1;
    // From this body on they move in the other way; a rack is between.
    let changes = match numbers.one_of(5) {
        0 => 2 + numbers.one_of(count as u64 - 1) as usize,
        _ => usize::MAX,
    };
    let tree = numbers.one_of(3) == 0;
    let mut net = Net {
        kinds: (1..=count).map(|i| turns != (i >= changes)).collect(),
        numbers,
        declared: String::new(),
        equations: String::new(),
        powers: Vec::new(),
        parameters: Vec::new(),
    };
    let parents: Vec<usize> = (2..=count)
        .map(|i| match tree {
            true => 1 + net.numbers.one_of(i as u64 - 1) as usize,
            false => i - 1,
        })
        .collect();
    let mut joints: Vec<Joint> = Vec::new();
    for i in 2..=count {
        let held = joints.iter().any(|joint| joint.may_stick());
        joints.push(net.chosen_joint(parents[i - 2], i, held));
    }
    // Bodies that move as one have one number.
    let mut groups: Vec<usize> = (1..=count).collect();
    for i in 2..=count {
        if joints[i - 2].is_rigid() {
            groups[i - 1] = groups[parents[i - 2] - 1];
        }
    }
    // The ends of a shaft start as it does.
    let still = joints.contains(&Joint::Shaft);
    for i in 1..=count {
        let moved = i > 1 && joints[i - 2].is_rigid();
        net.body(i, still, moved);
        // A motion that two parts hold at once is refused.
        let group = groups[i - 1];
        let holds = |(child, joint): (usize, &Joint)| {
            let ends = [groups[child - 1], groups[parents[child - 2] - 1]];
            joint.may_stick() && ends.contains(&group)
        };
        if !moved && !(2..=count).zip(&joints).any(holds) {
            net.friction(i);
        }
    }
    for (i, joint) in (2..=count).zip(&joints) {
        net.join(parents[i - 2], i, *joint);
    }
    net.close_a_loop();
    net.push();
    net.extra();
    // A run with a delay has no gradient.
    if net.declared.contains("delay(body") {
        net.parameters.clear();
    }
    Model {
        text: net.text(),
        unrolled: None,
        point: None,
        parameters: net.parameters,
        measures_work: true,
    }
}

/// What is between two bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Joint {
    /// One of the compliant parts.
    Compliant(u64),
    /// A compliant part behind a gear.
    Geared(u64),
    /// A gear or a rod alone: both move as one.
    Rigid,
    /// A gear with losses alone.
    Lossy,
    /// A field.
    Shaft,
    Clutch,
    /// A rack and a spring.
    Rack,
    /// A rack alone.
    RigidRack,
}

impl Joint {
    /// Whether the motion of one body is that of the other.
    fn is_rigid(self) -> bool {
        [Self::Rigid, Self::Lossy, Self::RigidRack].contains(&self)
    }

    /// Whether it may hold a motion by itself.
    fn may_stick(self) -> bool {
        [Self::Lossy, Self::Clutch].contains(&self)
    }
}

/// A model that is being written.
struct Net {
    /// Whether each body turns.
    kinds: Vec<bool>,
    numbers: Numbers,
    declared: String,
    equations: String,
    /// What is supplied from outside, term by term.
    powers: Vec<String>,
    parameters: Vec<String>,
}

impl Net {
    fn declare(&mut self, line: &str) {
        let _ = writeln!(self.declared, "  {line};");
    }

    fn connect(&mut self, line: &str) {
        let _ = writeln!(self.equations, "  connect({line});");
    }

    fn turns(&self, body: usize) -> bool {
        self.kinds[body - 1]
    }

    /// One of the bodies.
    fn any(&mut self) -> usize {
        1 + self.numbers.one_of(self.kinds.len() as u64) as usize
    }

    fn chosen_joint(&mut self, from: usize, to: usize, held: bool) -> Joint {
        let which = self.numbers.one_of(12);
        if self.turns(from) != self.turns(to) {
            return match which % 3 {
                0 => Joint::RigidRack,
                _ => Joint::Rack,
            };
        }
        let compliant = self.numbers.one_of(6);
        match (self.turns(from), which) {
            (_, 0) => Joint::Rigid,
            (true, 1) if !held => Joint::Lossy,
            (true, 2) => Joint::Shaft,
            (true, 3) if !held => Joint::Clutch,
            (true, 4..8) => Joint::Geared(compliant),
            _ => Joint::Compliant(compliant),
        }
    }

    /// A body; one that another moves has no start of its own.
    fn body(&mut self, i: usize, still: bool, moved: bool) {
        let speed = match still {
            true => 0.0,
            false => self.numbers.between(-1.0, 1.0),
        };
        let size = self.numbers.between(0.1, 2.0);
        let stopped = self.numbers.one_of(8) == 0;
        self.parameters.push(match (self.turns(i), stopped) {
            (true, _) => format!("body{i}.J"),
            (false, true) if !moved && !still => format!("body{i}.m"),
            (false, _) => format!("body{i}.M"),
        });
        let (place, rate) = match self.turns(i) {
            true => ("phi", "w"),
            false => ("s", "v"),
        };
        let unit = if self.turns(i) { "rad/s" } else { "m/s" };
        let start = match moved {
            true => format!("{place}(fixed = false), {rate}(fixed = false)"),
            false => format!("{rate}(start = {speed} [{unit}])"),
        };
        match self.turns(i) {
            true => self.declare(&format!("Inertia body{i}(J = {size} [kg.m2], {start})")),
            false if stopped && !moved && !still => {
                let (below, above) = (
                    self.numbers.between(-20.0, -5.0),
                    self.numbers.between(5.0, 20.0),
                );
                let friction = self.numbers.between(0.0, 2.0);
                self.declare(&format!(
                    "MassWithStopAndFriction body{i}(m = {size} [kg], smin = {below} [mm], smax = {above} [mm], \
                     F_Coulomb = {friction} [N], {start})"
                ));
            }
            false => self.declare(&format!("Mass body{i}(M = {size} [kg], {start})")),
        }
    }

    /// Mostly something that rubs.
    fn friction(&mut self, i: usize) {
        let size = self.numbers.between(0.1, 4.0);
        let drag = self.numbers.between(0.0, 1.0);
        let stopped = self
            .declared
            .contains(&format!("MassWithStopAndFriction body{i}("));
        let which = self.numbers.one_of(6);
        if stopped || which < 2 {
            return;
        }
        let turns = self.turns(i);
        let instant = self.numbers.between(0.02, 0.25);
        let part = match (turns, which) {
            (true, 2) => format!(
                "BearingFriction drag{i}(tau0 = {size} [N.m], tau1 = {drag} [N.m.s/rad], peak = 1.2)"
            ),
            (false, 2) => format!(
                "SupportFriction drag{i}(F_Coulomb = {size} [N], F_prop = {drag} [N.s/m], F_Stribeck = {} [N])",
                0.3 * size
            ),
            (true, 3) => format!(
                "Rotational.Brake drag{i}(f_normalized = if time < {instant} [s] then 0 else 1, fn_max = {size} [N])"
            ),
            (false, 3) => format!(
                "Translational.Brake drag{i}(f_normalized = if time < {instant} [s] then 1 else 0, fn_max = {size} [N])"
            ),
            (true, _) => format!("Friction drag{i}(T = {size} [N.m], b = {drag} [N.m.s/rad])"),
            (false, _) => format!("Guide drag{i}(F = {size} [N], b = {drag} [N.s/m])"),
        };
        if which > 3 {
            let name = if turns { "T" } else { "F" };
            self.parameters.push(format!("drag{i}.{name}"));
        }
        self.declare(&part);
        self.connect(&format!("drag{i}.a, body{i}.a"));
    }

    /// A second way between two bodies, or one to the ground.
    fn close_a_loop(&mut self) {
        let (a, b) = (self.any(), self.any());
        let (stiffness, damping) = (
            self.numbers.between(500.0, 20_000.0),
            self.numbers.between(0.5, 20.0),
        );
        let which = self.numbers.one_of(3);
        let (kind, per) = match self.turns(a) {
            true => ("Rotational", ("N.m/rad", "N.m.s/rad")),
            false => ("Translational", ("N/m", "N.s/m")),
        };
        let spring = format!(
            "{kind}.SpringDamper brace(c = {stiffness} [{}], d = {damping} [{}])",
            per.0, per.1
        );
        if which == 0 && a != b && self.turns(a) == self.turns(b) {
            self.declare(&spring);
            self.connect(&format!("body{a}.b, brace.a"));
            self.connect(&format!("brace.b, body{b}.a"));
        } else if which == 1 {
            self.declare(&spring);
            self.declare(&format!("{kind}.Fixed ground"));
            self.connect(&format!("body{a}.b, brace.a"));
            self.connect("brace.b, ground.a");
        }
    }

    /// Names of a force on a body, its unit, and the body's place and speed.
    fn words(&self, body: usize) -> [&'static str; 7] {
        match self.turns(body) {
            true => ["Rotational", "Torque", "T", "N.m", "phi", "w", "rad"],
            false => ["Translational", "Force", "F", "N", "s", "v", "m"],
        }
    }

    /// A force of the time on the first body.
    fn push(&mut self) {
        let (amplitude, rate) = (
            self.numbers.between(1.0, 20.0),
            self.numbers.between(20.0, 90.0),
        );
        let [kind, _, flow, unit, _, speed, _] = self.words(1);
        self.declare(&format!("parameter Real amplitude = {amplitude} [{unit}]"));
        self.declare(&format!(
            "{kind}.Drive push({flow} = amplitude*sin({rate} [rad/s]*time))"
        ));
        self.connect("push.a, body1.a");
        self.parameters.push("amplitude".to_owned());
        self.powers.push(format!("push.{flow}*body1.{speed}"));
    }

    /// Perhaps another force: of a clock, of a delay, of a relation, of a step.
    fn extra(&mut self) {
        let body = self.any();
        let [kind, force, flow, unit, place, speed, way] = self.words(body);
        let size = self.numbers.between(0.5, 5.0);
        let instant = self.numbers.between(0.02, 0.25);
        let edge = self.numbers.between(-0.01, 0.01);
        let value = match self.numbers.one_of(8) {
            0 => format!("if time < {instant} [s] then 0 [{unit}] else {size} [{unit}]"),
            1 => {
                let period = self.numbers.between(1.0, 6.0);
                let late = match self.numbers.one_of(2) {
                    0 => String::new(),
                    _ => format!(", delay = {} [ms]", (0.3 * period * 1e3).round() / 1e3),
                };
                self.declare(&format!(
                    "clocked cnc({period} [ms]{late})\n    {force} sum(start = 0) = pre(sum) - {} [{unit}/{way}]*sample(body{body}.{speed})*interval();\n    \
                     {force} u = sum - {size} [{unit}.s/{way}]*sample(body{body}.{speed});\n  end cnc",
                    10.0 * size
                ));
                "hold(cnc.u)".to_owned()
            }
            2 => {
                let late = self.numbers.between(1.0, 20.0);
                format!("-{size} [{unit}.s/{way}]*delay(body{body}.{speed}, {late} [ms])")
            }
            3 => format!(
                "if body{body}.{place} > {edge} [{way}] then -{size} [{unit}] else {size} [{unit}]"
            ),
            4 => format!(
                "-{size} [{unit}]*min(max(body{body}.{speed}/(0.2 [{way}/s]), -1), abs(body{body}.{place}/(0.1 [{way}])))"
            ),
            5 => format!(
                "-{size} [{unit}]*atan(body{body}.{speed}/(0.3 [{way}/s]))*exp(-body{body}.{place}/(1 [{way}]))"
            ),
            _ => return,
        };
        self.declare(&format!("{kind}.Drive extra({flow} = {value})"));
        self.connect(&format!("extra.a, body{body}.b"));
        self.powers.push(format!("extra.{flow}*body{body}.{speed}"));
    }

    fn text(&self) -> String {
        let mixed = self.kinds.contains(&true) && self.kinds.contains(&false);
        let imports = match (mixed, self.kinds[0]) {
            (true, _) => {
                "import Rotational.Inertia;\nimport Rotational.Friction;\nimport Rotational.BearingFriction;\nimport Rotational.ElastoBacklash;\n\
                 import Rotational.ElastoBacklash2;\nimport Rotational.IdealGear;\nimport Rotational.LossyGear;\nimport Rotational.Clutch;\n\
                 import Rotational.IdealGearR2T;\nimport Translational.Mass;\nimport Translational.MassWithStopAndFriction;\n\
                 import Translational.Guide;\nimport Translational.SupportFriction;\nimport Translational.Contact;\n\
                 import Translational.GapContact;\nimport Translational.ElastoGap;\nimport Translational.Rod;"
            }
            (false, true) => "import Rotational.*;",
            (false, false) => "import Translational.*;",
        };
        format!(
            "package random \"bodies and joints\";\nimport SI.*;\n{imports}\n\nmodel M\n{}  Power power = {};\nequation\n{}end M;\n\n\
             experiment run of M\n  measure Energy work = integral(power);\n  \
             solve ida(rtol = 1e-9, atol = 1e-12) stop 0.3 [s] every 10 [ms];\nend run;\n",
            self.declared,
            self.powers.join(" + "),
            self.equations,
        )
    }
}
