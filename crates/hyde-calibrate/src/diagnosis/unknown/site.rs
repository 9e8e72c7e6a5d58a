//! [`Site`]: a place where an unwritten law may act, and the words that the language has for it there. All of it follows
//! from what the model declares at the site: `site Force grip = F over (place = a.s, slip = v);`.

use hyde_ir::{LawAxis, LawRole};
use hyde_syntax::{LawForm, LawTarget};
use hyde_units::{Dimension, NamedUnit};

/// A variable of a law as the site's class declares it.
#[derive(Clone, Debug, PartialEq)]
pub struct LawVariable {
    /// The variable, `a.s`.
    pub name: String,
    /// Whether it is the derivative of that.
    pub derivative: bool,
    /// The unit of its values as they are shown to people.
    pub unit: NamedUnit,
}

/// A variable as the text of a law names it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Named {
    /// Its name there.
    pub(crate) text: String,
    /// What it is, where the law has to declare it.
    definition: Option<String>,
    /// The unit in which its constants are written.
    pub(crate) unit: NamedUnit,
    /// What a round value of it is called there.
    pub(crate) round: String,
}

/// What is declared at a site: what a law there is added to, and of what it is a function.
#[derive(Clone, Debug, PartialEq)]
pub struct Kind {
    form: LawForm,
    target: LawTarget,
    /// What an effect there is on.
    pub(crate) host: String,
    /// What a size of a law is called.
    pub(crate) size: String,
    /// The SI unit of a law.
    pub(crate) value: NamedUnit,
    pub(crate) place: Named,
    pub(crate) speed: Named,
    pub(crate) acceleration: Named,
    /// What a round time is called.
    pub(crate) round_time: String,
    /// The names that a law must not give to anything of its own.
    pub(crate) taken: Taken,
}

/// A place where a law may act.
#[derive(Clone, Debug, PartialEq)]
pub struct Site {
    /// What is declared there.
    pub kind: Kind,
    /// Path of the instance.
    pub path: String,
    /// Other connectors that are the same site.
    pub aliases: Vec<String>,
}

/// An effect of the language that was written here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// Its name.
    pub name: String,
    /// Its text.
    pub text: String,
    /// Path of the instance it is put on.
    pub site: String,
}

impl Kind {
    /// What is declared: the class of the site, what a law is and is added to, its dimension, and its two variables.
    #[must_use]
    pub fn new(
        host: String,
        form: LawForm,
        target: LawTarget,
        dimension: Dimension,
        [place, speed]: [LawVariable; 2],
    ) -> Self {
        let mut taken = Taken::of(&target, [&place, &speed]);
        let value = NamedUnit::usual(dimension);
        let sizes: &[&str] = match value.text() {
            "N" => &["F", "P"],
            "N.m" => &["T", "M"],
            "V" => &["U"],
            "A" => &["I"],
            "m" | "rad" => &["e"],
            _ => &["k"],
        };
        let inside = matches!(target, LawTarget::Flow(_));
        let fine = form == LawForm::Elastic;
        let rate = match speed.unit.si().text() {
            "m/s" => "v",
            "rad/s" => "w",
            _ => "rate",
        };
        let size = taken.stem(sizes);
        let place = Named::new(place, "x", inside, fine, &mut taken);
        let speed = Named::new(speed, rate, inside, false, &mut taken);
        Self {
            size,
            place,
            acceleration: Named::derivative_of(&speed, &mut taken),
            speed,
            round_time: taken.free("t1"),
            taken,
            form,
            target,
            host,
            value,
        }
    }

    /// Whether the law is of the size of a friction, its sign that of the motion.
    #[must_use]
    pub fn is_grip(&self) -> bool {
        self.form == LawForm::Friction
    }

    /// Whether one of its variables has a role of a shape, or time has.
    pub(crate) fn has(&self, role: LawRole) -> bool {
        let lies = matches!(self.form, LawForm::Motion | LawForm::Friction);
        match role {
            LawRole::Speed => self.form == LawForm::Motion,
            LawRole::Slip => self.form == LawForm::Friction,
            LawRole::Rate => !lies,
            LawRole::Place => lies,
            LawRole::Distance => lies && !self.turns(),
            LawRole::Angle => lies && self.turns(),
            LawRole::Stretch => self.form == LawForm::Elastic,
            LawRole::Demand => self.form == LawForm::Demand,
            LawRole::Acceleration => lies,
            LawRole::Motion | LawRole::Time => true,
        }
    }

    /// What the derivative of its speed is.
    #[must_use]
    pub fn acceleration(&self) -> &'static str {
        match self.form {
            LawForm::Motion | LawForm::Friction => "acceleration",
            LawForm::Elastic | LawForm::Demand => "second derivative",
        }
    }

    /// What place and speed of the site are.
    #[must_use]
    pub fn variables(&self) -> [String; 2] {
        let [place, speed] = match self.form {
            LawForm::Motion | LawForm::Friction => ["place", "speed"],
            LawForm::Elastic => ["stretch", "rate of stretch"],
            LawForm::Demand => match noun_of(self.place.unit.si().text()) {
                Some(noun) => {
                    let place = match self.noun() == Some(noun) {
                        true => "demand",
                        false => noun,
                    };
                    return [place.to_owned(), format!("rate of {noun}")];
                }
                None => ["demand", "rate"],
            },
        };
        [place, speed].map(str::to_owned)
    }

    /// What a law there is: `a force`.
    #[must_use]
    pub fn what(&self) -> String {
        match self.noun() {
            Some(noun) => format!("a {noun}"),
            None if self.is_reading() => "an error".to_owned(),
            None => "a change".to_owned(),
        }
    }

    /// What the axis of a figure over which a law is drawn is called.
    #[must_use]
    pub fn axis(&self) -> String {
        match (self.form, self.noun()) {
            (LawForm::Friction, Some(noun)) => format!("friction {noun}"),
            (_, Some(noun)) if self.is_reading() => format!("{noun} error"),
            (_, None) if self.is_reading() => "reading error".to_owned(),
            (_, Some(noun)) => noun.to_owned(),
            (LawForm::Friction, None) => "friction".to_owned(),
            (_, None) => "change".to_owned(),
        }
    }

    /// Which way a positive law acts: a sentence.
    #[must_use]
    pub fn sign(&self) -> &'static str {
        match (&self.target, self.form) {
            (_, LawForm::Friction) => "Positive values act against the motion.",
            (LawTarget::Flow(_), _) => "Positive values drive in the positive direction.",
            (LawTarget::Value { .. }, _) => "Positive values add to what the declared model has.",
        }
    }

    fn noun(&self) -> Option<&'static str> {
        noun_of(self.value.text())
    }

    /// Whether it is what a sensor tells.
    fn is_reading(&self) -> bool {
        let output = matches!(self.target, LawTarget::Value { output: true, .. });
        output && self.form == LawForm::Motion
    }

    /// Whether its place is an angle.
    #[must_use]
    pub fn turns(&self) -> bool {
        self.place.unit.unit().dimension == Dimension::ANGLE
    }

    /// The SI unit of a force there.
    #[must_use]
    pub fn force_unit(&self) -> String {
        self.value.text().to_owned()
    }

    /// The SI unit of its place.
    #[must_use]
    pub fn place_unit(&self) -> String {
        self.place.unit.si().text().to_owned()
    }

    /// The SI unit of its speed.
    #[must_use]
    pub fn speed_unit(&self) -> String {
        self.speed.unit.si().text().to_owned()
    }

    /// The SI unit of its acceleration.
    #[must_use]
    pub fn acceleration_unit(&self) -> String {
        self.acceleration.unit.si().text().to_owned()
    }

    /// The mark that a law of the place leaves.
    pub(crate) fn mark_of_place(&self) -> &'static str {
        match self.form {
            LawForm::Motion | LawForm::Friction => "position",
            LawForm::Elastic => "torque",
            LawForm::Demand => "current",
        }
    }

    /// What probes of the site tell, the one that tells most first: a place that no state has cannot always be differentiated
    /// twice.
    pub(crate) fn probes(&self) -> &'static [Tells] {
        match self.has(LawRole::Acceleration) {
            true => &[Tells::Acceleration, Tells::Speed],
            false => &[Tells::Speed],
        }
    }

    /// The lines that put a law on the site, and declare those of its variables that it is a function of.
    pub(crate) fn clauses(&self, law: &str, reads: &dyn Fn(LawAxis) -> bool) -> String {
        let mut text = match &self.target {
            LawTarget::Flow(flow) => format!("  add a.{flow} = -({law});\n"),
            LawTarget::Value { name, hold, .. } => {
                let wrapped = std::iter::once(name).chain(hold);
                wrapped
                    .map(|value| format!("  wrap {value} by {value} + {law};\n"))
                    .collect()
            }
        };
        let accelerates = reads(LawAxis::Acceleration);
        let variables = [
            (reads(LawAxis::Place), &self.place),
            (reads(LawAxis::Speed) || accelerates, &self.speed),
            (accelerates, &self.acceleration),
        ];
        for (_, variable) in variables.iter().filter(|(read, _)| *read) {
            if let Some(definition) = &variable.definition {
                text.push_str(&format!("  Real {} = {definition};\n", variable.text));
            }
        }
        text
    }
}

/// What a quantity with an SI unit is called.
fn noun_of(unit: &str) -> Option<&'static str> {
    match unit {
        "N" => Some("force"),
        "N.m" => Some("torque"),
        "V" => Some("voltage"),
        "A" => Some("current"),
        _ => None,
    }
}

impl Named {
    /// How a law names a variable; one that it has to declare is called `own`. In a connector, `inside`, names are those of
    /// the connector `a` of the effect.
    fn new(variable: LawVariable, own: &str, inside: bool, fine: bool, taken: &mut Taken) -> Self {
        let name = match inside {
            true => format!("a.{}", variable.name),
            false => variable.name,
        };
        let (text, definition) = match variable.derivative {
            true => (taken.free(own), Some(format!("der({name})"))),
            false => (name, None),
        };
        Self {
            round: taken.free(&format!("{own}1")),
            unit: usual_on_drives(variable.unit, fine),
            text,
            definition,
        }
    }

    /// The derivative of a speed, which a law always has to declare.
    fn derivative_of(speed: &Self, taken: &mut Taken) -> Self {
        let dimension = speed.unit.unit().dimension.divide(Dimension::TIME);
        Self {
            round: taken.free("acc1"),
            unit: NamedUnit::usual(dimension),
            text: taken.free("acc"),
            definition: Some(format!("der({})", speed.text)),
        }
    }
}

/// The unit in which people who build drives write a quantity: that of its declaration, or of what is declared in the units
/// of SI a usual part of it; a stretch is small.
fn usual_on_drives(declared: NamedUnit, small: bool) -> NamedUnit {
    let text = match (declared.text(), small) {
        ("m", false) => "mm",
        ("m", true) => "um",
        ("rad", true) => "mrad",
        ("m/s", _) => "mm/s",
        _ => return declared,
    };
    NamedUnit::parse(text).unwrap_or(declared)
}

/// The names that the text of a law has already.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Taken(Vec<String>);

impl Taken {
    /// Those that the site itself needs.
    fn of(target: &LawTarget, variables: [&LawVariable; 2]) -> Self {
        let mut words: Vec<String> = ["a", "time", "pi"].map(str::to_owned).to_vec();
        if let LawTarget::Value { name, hold, .. } = target {
            words.push(name.clone());
            words.extend(hold.clone());
        }
        for variable in variables {
            words.extend(variable.name.split('.').next().map(str::to_owned));
        }
        Self(words)
    }

    /// A name, or the same with a number where that is taken; it is taken then.
    pub(crate) fn free(&mut self, name: &str) -> String {
        let numbered = (2..).map(|number| format!("{name}{number}"));
        let mut all = std::iter::once(name.to_owned()).chain(numbered);
        let free = all.find(|name| !self.0.contains(name)).unwrap_or_default();
        self.0.push(free.clone());
        free
    }

    /// The first of some words with which no name begins, or the last one with a number.
    fn stem(&self, words: &[&str]) -> String {
        let last = words.last().unwrap_or(&"k");
        let numbered = (2..).map(|number| format!("{last}{number}"));
        let mut all = words.iter().map(|word| (*word).to_owned()).chain(numbered);
        let is_free = |word: &String| !self.0.iter().any(|name| name.starts_with(word.as_str()));
        all.find(is_free).unwrap_or_default()
    }
}

/// Up to which derivative of the place a probe tells where its site is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tells {
    Speed,
    Acceleration,
}

/// An effect by which a force at a site is felt, or a sensor's error: its sizes are the force, and forces a unit of
/// place, of speed, and of acceleration where it tells it.
pub(crate) fn probe(site: &Site, name: &str, tells: Tells) -> Written {
    let kind = &site.kind;
    let (unit, of_place, of_speed) = (kind.force_unit(), kind.place_unit(), kind.speed_unit());
    let (place, speed) = (&kind.place.text, &kind.speed.text);
    let [force, by_place, by_speed] = PROBE;
    let size = format!("= 0 [{unit}] in -1 .. 1 [{unit}]");
    let mut sizes = format!("{force} {size}, {by_place} {size}, {by_speed} {size}");
    let mut law = format!(
        "{force} + {by_place}*{place}/(1 [{of_place}]) + {by_speed}*{speed}/(1 [{of_speed}])"
    );
    if tells == Tells::Acceleration {
        let (own, of) = (&kind.acceleration.text, kind.acceleration.unit.text());
        sizes.push_str(&format!(", {PROBE_BY_ACCELERATION} {size}"));
        law.push_str(&format!(" + {PROBE_BY_ACCELERATION}*{own}/(1 [{of}])"));
    }
    let text = format!(
        "effect {name} on {}\n  size Real {sizes};\n{}end {name};\n",
        kind.host,
        kind.clauses(&format!("({law})"), &|axis| {
            axis != LawAxis::Acceleration || tells == Tells::Acceleration
        })
    );
    Written {
        name: name.to_owned(),
        text,
        site: site.path.clone(),
    }
}

/// The probe's sizes: force, by place, by speed. No variable of a site is likely to be called so.
pub(crate) const PROBE: [&str; 3] = ["probe_force", "probe_by_place", "probe_by_speed"];
pub(crate) const PROBE_BY_ACCELERATION: &str = "probe_by_acceleration";
