//! [`Site`]: a place where an unwritten law may act, and the words that the language has for it there.

/// A kind of place: a force or torque on a connector, the grip of a friction that sticks, or what a sensor tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A force on what slides.
    Rail,
    /// A torque on what turns.
    Flange,
    /// The Coulomb force of a guideway: against the motion, whatever its sign.
    Guide,
    /// The Coulomb torque of a bearing.
    Bearing,
    /// What a position sensor reads.
    Scale,
    /// What an angle sensor reads.
    Encoder,
    /// The voltage of a tachogenerator.
    Tacho,
}

/// A place where a law may act.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Site {
    /// What kind of place it is.
    pub kind: Kind,
    /// Path of the instance.
    pub path: String,
    /// Other connectors that are the same site.
    pub aliases: Vec<String>,
}

impl Kind {
    /// The kind of the type that an effect is on: its package and its name; `None` for all others.
    #[must_use]
    pub fn of(package: &str, host: &str) -> Option<Self> {
        match (package, host.rsplit('.').next().unwrap_or(host)) {
            ("Translational", "Rail") => Some(Self::Rail),
            ("Rotational", "Flange") => Some(Self::Flange),
            ("Translational", "Guide") => Some(Self::Guide),
            ("Rotational", "Friction") => Some(Self::Bearing),
            ("Translational", "PositionSensor") => Some(Self::Scale),
            ("Rotational", "AngleSensor") => Some(Self::Encoder),
            ("Drives.Control", "Tachogenerator") => Some(Self::Tacho),
            _ => None,
        }
    }

    /// Whether the law is of the size of a friction, its sign that of the motion.
    #[must_use]
    pub fn is_grip(self) -> bool {
        matches!(self, Self::Guide | Self::Bearing)
    }

    /// Whether it turns.
    #[must_use]
    pub fn turns(self) -> bool {
        matches!(
            self,
            Self::Flange | Self::Bearing | Self::Encoder | Self::Tacho
        )
    }

    pub(crate) fn host(self) -> &'static str {
        match self {
            Self::Rail => "Translational.Rail",
            Self::Flange => "Rotational.Flange",
            Self::Guide => "Translational.Guide",
            Self::Bearing => "Rotational.Friction",
            Self::Scale => "Translational.PositionSensor",
            Self::Encoder => "Rotational.AngleSensor",
            Self::Tacho => "Drives.Control.Tachogenerator",
        }
    }

    /// The unit of the law's value.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Rail | Self::Guide => "N",
            Self::Flange | Self::Bearing => "N.m",
            Self::Scale => "m",
            Self::Encoder => "rad",
            Self::Tacho => "V",
        }
    }

    /// What a size of the law is called.
    pub(crate) fn stem(self) -> &'static str {
        match self {
            Self::Rail | Self::Guide => "F",
            Self::Flange | Self::Bearing => "T",
            Self::Scale | Self::Encoder => "e",
            Self::Tacho => "U",
        }
    }

    /// What the law is, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Rail | Self::Guide => "a force",
            Self::Flange | Self::Bearing => "a torque",
            Self::Scale | Self::Encoder => "an error",
            Self::Tacho => "a voltage",
        }
    }

    /// The units of place and speed at the site, as they are written, and how many of them an SI unit is.
    pub(crate) fn place_unit(self) -> (&'static str, f64) {
        if self.turns() {
            ("rad", 1.0)
        } else {
            ("mm", 1e3)
        }
    }

    pub(crate) fn speed_unit(self) -> (&'static str, f64) {
        if self.turns() {
            ("rad/s", 1.0)
        } else {
            ("mm/s", 1e3)
        }
    }

    /// Place and speed as the law's text names them.
    pub(crate) fn place(self) -> &'static str {
        if self.turns() { "a.phi" } else { "a.s" }
    }

    pub(crate) fn speed(self) -> &'static str {
        match self {
            Self::Rail | Self::Guide | Self::Scale => "v",
            Self::Flange | Self::Bearing | Self::Encoder | Self::Tacho => "w",
        }
    }

    /// The lines that put a law on the site.
    pub(crate) fn clauses(self, law: &str) -> String {
        match self {
            Self::Rail => format!("  add a.f = -({law});\n  Real v = der(a.s);\n"),
            Self::Flange => format!("  add a.tau = -({law});\n  Real w = der(a.phi);\n"),
            Self::Guide => format!("  wrap grip by grip + {law};\n  wrap hold by hold + {law};\n"),
            Self::Bearing => format!("  wrap grip by grip + {law};\n"),
            Self::Scale => format!("  wrap s by s + {law};\n  Real v = der(a.s);\n"),
            Self::Encoder => format!("  wrap phi by phi + {law};\n  Real w = der(a.phi);\n"),
            Self::Tacho => format!("  wrap V6 by V6 + {law};\n"),
        }
    }
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

/// An effect by which a force at a site is felt, or a sensor's error: its sizes are the force, and forces proportional to
/// place and to speed.
pub(crate) fn probe(site: &Site, name: &str) -> Written {
    let kind = site.kind;
    let (place, speed) = (kind.place(), kind.speed());
    let unit = kind.unit();
    let (per_place, per_speed) = match kind {
        Kind::Rail | Kind::Guide => ("[N/m]", "[N.s/m]"),
        Kind::Flange | Kind::Bearing => ("[N.m/rad]", "[N.m.s/rad]"),
        Kind::Scale | Kind::Encoder => ("", "[s]"),
        Kind::Tacho => ("[V/rad]", "[V.s/rad]"),
    };
    let law = format!("(force + by_place*{place} + by_speed*{speed})");
    let text = format!(
        "effect {name} on {}\n  size Real force = 0 [{unit}] in -1 .. 1 [{unit}], by_place = 0 {per_place} in -1 .. 1 \
         {per_place}, by_speed = 0 {per_speed} in -1 .. 1 {per_speed};\n{}end {name};\n",
        kind.host(),
        kind.clauses(&law)
    );
    Written {
        name: name.to_owned(),
        text,
        site: site.path.clone(),
    }
}
