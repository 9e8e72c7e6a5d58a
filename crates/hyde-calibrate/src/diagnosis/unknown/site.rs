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
    /// What the site has beside them.
    pub(crate) signal: Option<Named>,
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
    /// What is declared: the class of the site, what a law is and is added to, its dimension, its two variables, and what it has
    /// beside them.
    #[must_use]
    pub fn new(
        host: String,
        form: LawForm,
        target: LawTarget,
        dimension: Dimension,
        [place, speed]: [LawVariable; 2],
        signal: Option<LawVariable>,
    ) -> Self {
        let variables = [&place, &speed].into_iter().chain(&signal);
        let mut taken = Taken::of(&target, variables);
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
            signal: signal.map(|own| Named::new(own, "u", inside, false, &mut taken)),
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
            LawRole::Signal => self.signal.is_some(),
            LawRole::Motion | LawRole::Time => true,
        }
    }

    /// What it has beside its two variables: a quantity, or the name of the variable.
    #[must_use]
    pub fn signal(&self) -> String {
        let Some(signal) = &self.signal else {
            return String::new();
        };
        let noun = noun_of(signal.unit.si().text());
        noun.unwrap_or(&signal.text).to_owned()
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

    /// The SI unit of what it has beside its two variables.
    #[must_use]
    pub fn signal_unit(&self) -> String {
        let signal = self.signal.as_ref();
        signal.map_or_else(String::new, |signal| signal.unit.si().text().to_owned())
    }

    /// The mark that a law of what it has beside its two variables leaves.
    pub(crate) fn mark_of_signal(&self) -> &'static str {
        match self.signal_unit().as_str() {
            "A" => "current",
            "N" | "N.m" => "torque",
            "V" | "W" => "velocity",
            _ => "offset",
        }
    }

    /// The mark that a law of the place leaves.
    pub(crate) fn mark_of_place(&self) -> &'static str {
        match self.form {
            LawForm::Motion | LawForm::Friction => "position",
            LawForm::Elastic => "torque",
            LawForm::Demand => "current",
        }
    }

    /// A variable of the site as a law names it; of the time there is none to declare.
    pub(crate) fn named(&self, axis: LawAxis) -> Option<&Named> {
        match axis {
            LawAxis::Place => Some(&self.place),
            LawAxis::Speed => Some(&self.speed),
            LawAxis::Acceleration => {
                Some(&self.acceleration).filter(|_| self.has(LawRole::Acceleration))
            }
            LawAxis::Signal => self.signal.as_ref(),
            LawAxis::Time => None,
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
            (reads(LawAxis::Place), Some(&self.place)),
            (reads(LawAxis::Speed) || accelerates, Some(&self.speed)),
            (accelerates, Some(&self.acceleration)),
            (reads(LawAxis::Signal), self.signal.as_ref()),
        ];
        let read = variables
            .into_iter()
            .filter_map(|(read, own)| own.filter(|_| read));
        for variable in read {
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
        "W" => Some("power"),
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
    fn of<'v>(target: &LawTarget, variables: impl Iterator<Item = &'v LawVariable>) -> Self {
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
