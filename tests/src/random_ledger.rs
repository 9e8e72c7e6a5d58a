//! Random chains of bodies with springs, dampers, contacts, gears, frictions and drives: does their energy ledger close?
//!
//! What drives the chains from outside is known by itself as well: force times speed over the rows of the results.

use crate::Example;
use crate::numbers::Numbers;
use hyde_experiment::{EnergyLedger, Options};
use std::fmt::Write as _;

/// Of the energy that passed, what may be missing in all balances together.
const CLOSES: f64 = 1e-6;

/// What is wrong with the ledger of the chain of a seed; nothing if it closes.
///
/// # Errors
/// The model does not compile or does not run.
pub fn open(seed: u64) -> Result<Option<String>, String> {
    let text = chain(seed);
    let with_text = |reason: String| format!("{reason}\n{text}");
    let example = Example::load("tests/models/ledger.hyde", None)?.replaced(&text, "run");
    let found = example.ledger().run_with(&Options::default());
    let (compiled, run) = found.map_err(|error| with_text(format!("{error:?}")))?;
    let sums = run.results.energies.as_ref();
    let sums = sums.ok_or("the run has no ledger")?;
    let ledger = EnergyLedger::new(&compiled.program.experiment.ledger, sums);
    if ledger.closure() > CLOSES || ledger.closure().is_nan() {
        let list: Vec<String> = ledger.entries.iter().map(|e| format!("{e:?}")).collect();
        let reason = format!("the remainders are {:e}", ledger.closure());
        return Ok(Some(with_text(format!("{reason}\n{}", list.join("\n")))));
    }
    let measure = run.measures.first().ok_or("the work is not measured")?;
    let supplied = ledger.total().supplied;
    let off = (supplied - measure.value).abs();
    Ok((off > CLOSES * ledger.passed).then(|| {
        let reason = format!(
            "{supplied} J are supplied, but the drive does {} J",
            measure.value
        );
        with_text(reason)
    }))
}

/// The model of a seed.
fn chain(seed: u64) -> String {
    let mut numbers = Numbers::of(seed);
    let turns = numbers.one_of(2) == 1;
    let bodies = 2 + numbers.one_of(3) as usize;
    let mut chain = Chain {
        turns,
        numbers,
        declared: String::new(),
        equations: String::new(),
    };
    for i in 1..=bodies {
        chain.body(i);
    }
    for i in 1..bodies {
        chain.link(i);
    }
    let (amplitude, rate) = (
        chain.numbers.between(1.0, 20.0),
        chain.numbers.between(20.0, 90.0),
    );
    let (flow, size, speed) = match turns {
        true => ("T", "[N.m]", "w"),
        false => ("F", "[N]", "v"),
    };
    format!(
        "package random \"a chain of bodies\";\nimport SI.*;\nimport {}.*;\n\nmodel Chain\n  \
         Drive push({flow} = {amplitude} {size}*sin({rate} [rad/s]*time));\n  \
         Power power = push.{flow}*body1.{speed};\n{}equation\n  connect(push.a, body1.a);\n{}end Chain;\n\n\
         experiment run of Chain\n  measure Energy work = integral(power);\n  \
         solve ida(rtol = 1e-9, atol = 1e-12) stop 0.3 [s] every 10 [ms];\nend run;\n",
        if turns { "Rotational" } else { "Translational" },
        chain.declared,
        chain.equations,
    )
}

struct Chain {
    turns: bool,
    numbers: Numbers,
    declared: String,
    equations: String,
}

impl Chain {
    fn declare(&mut self, line: &str) {
        let _ = writeln!(self.declared, "  {line};");
    }

    fn connect(&mut self, line: &str) {
        let _ = writeln!(self.equations, "  connect({line});");
    }

    /// A body that moves, mostly with a friction.
    fn body(&mut self, i: usize) {
        let speed = self.numbers.between(-1.0, 1.0);
        let size = self.numbers.between(0.1, 2.0);
        let (friction, drag) = (
            self.numbers.between(0.1, 4.0),
            self.numbers.between(0.0, 1.0),
        );
        match self.turns {
            true => self.declare(&format!(
                "Inertia body{i}(J = {size} [kg.m2], w(start = {speed} [rad/s]))"
            )),
            false => self.declare(&format!(
                "Mass body{i}(M = {size} [kg], v(start = {speed} [m/s]))"
            )),
        }
        if self.numbers.one_of(3) == 0 {
            return;
        }
        match self.turns {
            true => self.declare(&format!(
                "Friction drag{i}(T = {friction} [N.m], b = {drag} [N.m.s/rad])"
            )),
            false => self.declare(&format!(
                "Guide drag{i}(F = {friction} [N], b = {drag} [N.s/m])"
            )),
        }
        self.connect(&format!("drag{i}.a, body{i}.a"));
    }

    /// What is between a body and the next.
    fn link(&mut self, i: usize) {
        let next = i + 1;
        let stiffness = self.numbers.between(500.0, 20_000.0);
        let damping = self.numbers.between(0.5, 20.0);
        let play = self.numbers.between(0.0001, 0.01);
        let which = self.numbers.one_of(6);
        let contact = match which {
            0 => Some(format!(
                "Contact link{i}(k = {stiffness} [N/m], c = {damping} [N.s/m]"
            )),
            1 => Some(format!(
                "GapContact link{i}(k = {stiffness} [N/m], c = {damping} [N.s/m], gap = {play} [m]"
            )),
            _ => None,
        };
        if let (false, Some(contact)) = (self.turns, contact) {
            self.declare(&format!("{contact}, e = body{i}.s - body{next}.s)"));
            self.declare(&format!(
                "Drive on{i}(F = -link{i}.F), from{i}(F = link{i}.F)"
            ));
            self.connect(&format!("on{i}.a, body{i}.b"));
            self.connect(&format!("from{i}.a, body{next}.a"));
            return;
        }
        let part = match (self.turns, which) {
            (false, 2) => format!(
                "ElastoGap link{i}(c = {stiffness} [N/m], d = {damping} [N.s/m], s_rel0 = {play} [m])"
            ),
            (false, 3) => format!("Spring link{i}(c = {stiffness} [N/m])"),
            (false, 4) => format!("Damper link{i}(d = {damping} [N.s/m])"),
            (false, _) => {
                format!("SpringDamper link{i}(c = {stiffness} [N/m], d = {damping} [N.s/m])")
            }
            (true, 0) => format!(
                "ElastoBacklash link{i}(c = {stiffness} [N.m/rad], d = {damping} [N.m.s/rad], b0 = {play} [rad])"
            ),
            (true, 1 | 2) => format!(
                "ElastoBacklash2 link{i}(c = {stiffness} [N.m/rad], d = {damping} [N.m.s/rad], b0 = {play} [rad])"
            ),
            (true, 3) => format!("Spring link{i}(c = {stiffness} [N.m/rad])"),
            (true, 4) => format!("Damper link{i}(d = {damping} [N.m.s/rad])"),
            (true, _) => format!(
                "SpringDamper link{i}(c = {stiffness} [N.m/rad], d = {damping} [N.m.s/rad])"
            ),
        };
        self.declare(&part);
        // A gear between a body and what follows.
        let geared = self.turns && self.numbers.one_of(2) == 0;
        let from = match geared {
            true => {
                let ratio = self.numbers.between(-3.0, 3.0);
                self.declare(&format!("IdealGear gear{i}(ratio = {ratio})"));
                self.connect(&format!("body{i}.b, gear{i}.a"));
                format!("gear{i}.b")
            }
            false => format!("body{i}.b"),
        };
        self.connect(&format!("{from}, link{i}.a"));
        self.connect(&format!("link{i}.b, body{next}.a"));
    }
}
