//! Circuits: pins joined by resistors, inductors, capacitors, diodes, switches and sources, with a motor that drives a body.

use super::model::Model;
use crate::numbers::Numbers;
use std::fmt::Write as _;

/// The model of a seed.
pub(crate) fn random(seed: u64) -> Model {
    let mut numbers = Numbers::of(seed);
    let nodes = 2 + numbers.one_of(4) as usize;
    let mut circuit = Circuit {
        numbers,
        declared: String::new(),
        equations: String::new(),
        parameters: Vec::new(),
        parts: 0,
    };
    // A source behind a resistance, so that no loop of voltages closes.
    circuit.source("node1");
    for node in 1..=nodes {
        // A pin of its own in each node; it leads to the ground, so that no node is left alone.
        let ohm = circuit.numbers.between(20.0, 500.0);
        circuit.declare(&format!("Resistor node{node}(R = {ohm} [ohm])"));
        circuit.connect(&format!("node{node}.n, ground.p"));
        circuit.parameters.push(format!("node{node}.R"));
        if node > 1 {
            let from = 1 + circuit.numbers.one_of(node as u64 - 1) as usize;
            circuit.part(&format!("node{from}"), &format!("node{node}"));
        }
    }
    for _ in 0..circuit.numbers.one_of(3) {
        let (from, to) = (
            1 + circuit.numbers.one_of(nodes as u64),
            1 + circuit.numbers.one_of(nodes as u64),
        );
        if from != to {
            circuit.part(&format!("node{from}"), &format!("node{to}"));
        }
    }
    if circuit.numbers.one_of(2) == 0 {
        circuit.motor(&format!("node{nodes}"));
    }
    let text = circuit.text();
    Model {
        // What has no accounts, as a coil that saturates, is a supply in the ledger.
        measures_work: !text.contains("SaturatingInductor"),
        text,
        unrolled: None,
        point: None,
        parameters: circuit.parameters,
    }
}

/// A model that is being written.
struct Circuit {
    numbers: Numbers,
    declared: String,
    equations: String,
    parameters: Vec<String>,
    parts: usize,
}

impl Circuit {
    fn declare(&mut self, what: &str) {
        let _ = writeln!(self.declared, "  {what};");
    }

    fn connect(&mut self, ends: &str) {
        let _ = writeln!(self.equations, "  connect({ends});");
    }

    fn source(&mut self, node: &str) {
        let (volt, hertz) = (
            self.numbers.between(5.0, 50.0),
            self.numbers.between(5.0, 60.0),
        );
        let (late, width) = (
            self.numbers.between(0.01, 0.05),
            self.numbers.between(20.0, 80.0),
        );
        let source = match self.numbers.one_of(4) {
            0 => format!("StepVoltage source(V = {volt} [V], startTime = {late} [s])"),
            1 => {
                format!("PulseVoltage source(V = {volt} [V], width = {width}, period = 0.0413 [s])")
            }
            _ => format!("SineVoltage source(V = {volt} [V], f = {hertz} [Hz])"),
        };
        let ohm = self.numbers.between(0.5, 10.0);
        self.declare("Ground ground");
        self.declare(&source);
        self.declare(&format!("Resistor line(R = {ohm} [ohm])"));
        self.connect("source.n, ground.p");
        self.connect("source.p, line.p");
        self.connect(&format!("line.n, {node}.p"));
    }

    /// Something between two nodes.
    fn part(&mut self, from: &str, to: &str) {
        self.parts += 1;
        let name = format!("part{}", self.parts);
        let mut size = |low: f64, high: f64| self.numbers.between(low, high);
        let (ohm, farad, henry) = (size(1.0, 100.0), size(5.0, 500.0), size(2.0, 100.0));
        let (volt, instant) = (size(0.1, 0.8), size(0.01, 0.28));
        let declared = match self.numbers.one_of(9) {
            0 => format!("Resistor {name}(R = {ohm} [ohm])"),
            1 | 2 => format!("Capacitor {name}(C = {farad} [uF])"),
            3 | 4 => format!("Inductor {name}(L = {henry} [mH])"),
            5 => {
                format!("IdealDiode {name}(Ron = 0.05 [ohm], Goff = 1e-5 [S], Vknee = {volt} [V])")
            }
            6 => format!("Diode {name}(Ids = 1e-6 [A])"),
            7 => format!(
                "SaturatingInductor {name}(Inom = 0.5 [A], Lnom = {henry} [mH], Lzer = 1.7*{henry} [mH], Linf = 0.6*{henry} [mH])"
            ),
            _ => format!(
                "IdealClosingSwitch {name}(Ron = 0.1 [ohm], Goff = 1e-4 [S], control = time > {instant} [s])"
            ),
        };
        self.declare(&declared);
        self.connect(&format!("{from}.p, {name}.p"));
        self.connect(&format!("{name}.n, {to}.p"));
    }

    /// A motor with its winding and a body with friction.
    fn motor(&mut self, node: &str) {
        let (ohm, henry) = (
            self.numbers.between(0.5, 5.0),
            self.numbers.between(1.0, 10.0),
        );
        let (constant, inertia) = (
            self.numbers.between(0.05, 0.5),
            self.numbers.between(1e-4, 5e-3),
        );
        let torque = self.numbers.between(0.005, 0.1);
        self.declare(&format!("Resistor copper(R = {ohm} [ohm])"));
        self.declare(&format!("Inductor winding(L = {henry} [mH])"));
        self.declare(&format!("EMF emf(k = {constant} [N.m/A])"));
        self.declare(&format!("Rotational.Inertia rotor(J = {inertia} [kg.m2])"));
        self.declare(&format!(
            "Rotational.Friction bearing(T = {torque} [N.m], b = 1e-4 [N.m.s/rad])"
        ));
        self.connect(&format!("{node}.p, copper.p"));
        self.connect("copper.n, winding.p");
        self.connect("winding.n, emf.p");
        self.connect("emf.n, ground.p");
        self.connect("emf.flange, rotor.a");
        self.connect("rotor.b, bearing.a");
        self.parameters
            .extend(["rotor.J", "copper.R"].map(str::to_owned));
    }

    fn text(&self) -> String {
        format!(
            "package random \"a circuit\";\nimport SI.*;\nimport Electrical.*;\n\nmodel M\n{}  Power power = -source.v*source.i;\nequation\n{}end M;\n\nexperiment run of M\n  measure Energy work = integral(power);\n  solve ida(rtol = 1e-9, atol = 1e-12) stop 0.3 [s] every 10 [ms];\nend run;\n",
            self.declared, self.equations
        )
    }
}
