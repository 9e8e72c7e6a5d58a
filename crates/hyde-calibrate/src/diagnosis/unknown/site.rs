//! [`Site`]: a place where an unwritten law may act, and the words that the language has for it there.

/// A kind of place: a force or torque on a connector, the grip of a friction that sticks, what a spring holds, what a sensor
/// tells, or what an amplifier is asked for. Place and speed are those of the site; of a spring its stretch and how fast that
/// grows, of an amplifier the demand and how fast its current changes ([`Kind::variables`]).
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
    /// The torque of a belt.
    Belt,
    /// The torque of an elastic joint of two shafts.
    Joint,
    /// The force of an elastic contact.
    Contact,
    /// What a position sensor reads.
    Scale,
    /// What an angle sensor reads.
    Encoder,
    /// The voltage of a tachogenerator.
    Tacho,
    /// The demand that reaches a current amplifier.
    Amplifier,
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
            ("Drives", "Belt") => Some(Self::Belt),
            ("Rotational", "SpringDamper") => Some(Self::Joint),
            ("Translational", "Contact") => Some(Self::Contact),
            ("Translational", "PositionSensor") => Some(Self::Scale),
            ("Rotational", "AngleSensor") => Some(Self::Encoder),
            ("Drives.Control", "Tachogenerator") => Some(Self::Tacho),
            ("Electrical", "CurrentAmplifier") => Some(Self::Amplifier),
            _ => None,
        }
    }

    /// Whether the law is of the size of a friction, its sign that of the motion.
    #[must_use]
    pub fn is_grip(self) -> bool {
        matches!(self, Self::Guide | Self::Bearing)
    }

    /// Whether the law bends about where the site's place is 0, as that of a spring does, and no wave goes along it.
    #[must_use]
    pub fn bends_about_zero(self) -> bool {
        matches!(
            self,
            Self::Belt | Self::Joint | Self::Contact | Self::Amplifier
        )
    }

    /// What place and speed of the site are.
    #[must_use]
    pub fn variables(self) -> [&'static str; 2] {
        match self {
            Self::Rail
            | Self::Flange
            | Self::Guide
            | Self::Bearing
            | Self::Scale
            | Self::Encoder
            | Self::Tacho => ["place", "speed"],
            Self::Belt | Self::Joint | Self::Contact => ["stretch", "rate of stretch"],
            Self::Amplifier => ["demand", "rate of current"],
        }
    }

    /// Whether it turns.
    #[must_use]
    pub fn turns(self) -> bool {
        match self {
            Self::Rail | Self::Guide | Self::Contact | Self::Scale | Self::Amplifier => false,
            Self::Flange
            | Self::Bearing
            | Self::Belt
            | Self::Joint
            | Self::Encoder
            | Self::Tacho => true,
        }
    }

    /// The mark that a law of the place leaves.
    pub(crate) fn mark_of_place(self) -> &'static str {
        match self {
            Self::Rail
            | Self::Flange
            | Self::Guide
            | Self::Bearing
            | Self::Scale
            | Self::Encoder
            | Self::Tacho => "position",
            Self::Belt | Self::Joint | Self::Contact => "torque",
            Self::Amplifier => "current",
        }
    }

    pub(crate) fn host(self) -> &'static str {
        match self {
            Self::Rail => "Translational.Rail",
            Self::Flange => "Rotational.Flange",
            Self::Guide => "Translational.Guide",
            Self::Bearing => "Rotational.Friction",
            Self::Belt => "Drives.Belt",
            Self::Joint => "Rotational.SpringDamper",
            Self::Contact => "Translational.Contact",
            Self::Scale => "Translational.PositionSensor",
            Self::Encoder => "Rotational.AngleSensor",
            Self::Tacho => "Drives.Control.Tachogenerator",
            Self::Amplifier => "Electrical.CurrentAmplifier",
        }
    }

    /// The unit of the law's value.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Rail | Self::Guide | Self::Contact => "N",
            Self::Flange | Self::Bearing | Self::Belt | Self::Joint => "N.m",
            Self::Scale => "m",
            Self::Encoder => "rad",
            Self::Tacho => "V",
            Self::Amplifier => "A",
        }
    }

    /// What a size of the law is called.
    pub(crate) fn stem(self) -> &'static str {
        match self {
            Self::Rail | Self::Guide => "F",
            // What a spring holds is called F or T already.
            Self::Contact => "P",
            Self::Belt | Self::Joint => "M",
            Self::Flange | Self::Bearing => "T",
            Self::Scale | Self::Encoder => "e",
            Self::Tacho => "U",
            Self::Amplifier => "I",
        }
    }

    /// What the law is, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Rail | Self::Guide | Self::Contact => "a force",
            Self::Flange | Self::Bearing | Self::Belt | Self::Joint => "a torque",
            Self::Scale | Self::Encoder => "an error",
            Self::Tacho => "a voltage",
            Self::Amplifier => "a current",
        }
    }

    /// The units of place and speed at the site, as they are written, and how many of them an SI unit is.
    pub(crate) fn place_unit(self) -> (&'static str, f64) {
        match self {
            Self::Contact => ("um", 1e6),
            Self::Belt | Self::Joint => ("mrad", 1e3),
            Self::Rail | Self::Guide | Self::Scale => ("mm", 1e3),
            Self::Flange | Self::Bearing | Self::Encoder | Self::Tacho => ("rad", 1.0),
            Self::Amplifier => ("A", 1.0),
        }
    }

    pub(crate) fn speed_unit(self) -> (&'static str, f64) {
        match self {
            Self::Rail | Self::Guide | Self::Contact | Self::Scale => ("mm/s", 1e3),
            Self::Flange
            | Self::Bearing
            | Self::Belt
            | Self::Joint
            | Self::Encoder
            | Self::Tacho => ("rad/s", 1.0),
            Self::Amplifier => ("A/s", 1.0),
        }
    }

    /// Place and speed as the law's text names them.
    pub(crate) fn place(self) -> &'static str {
        match self {
            Self::Belt => "stretch",
            Self::Joint => "twist",
            Self::Contact => "e",
            Self::Rail | Self::Guide | Self::Scale => "a.s",
            Self::Flange | Self::Bearing | Self::Encoder | Self::Tacho => "a.phi",
            Self::Amplifier => "i_ref",
        }
    }

    pub(crate) fn speed(self) -> &'static str {
        match self {
            Self::Rail | Self::Guide | Self::Contact | Self::Scale => "v",
            Self::Flange | Self::Bearing | Self::Belt | Self::Encoder | Self::Tacho => "w",
            Self::Joint => "w_rel",
            Self::Amplifier => "rise",
        }
    }

    /// The lines that put a law on the site.
    pub(crate) fn clauses(self, law: &str) -> String {
        match self {
            Self::Rail => format!("  add a.f = -({law});\n  Real v = der(a.s);\n"),
            Self::Flange => format!("  add a.tau = -({law});\n  Real w = der(a.phi);\n"),
            Self::Guide => format!("  wrap grip by grip + {law};\n  wrap hold by hold + {law};\n"),
            Self::Bearing => format!("  wrap grip by grip + {law};\n"),
            Self::Belt => format!("  wrap T by T + {law};\n  Real w = der(stretch);\n"),
            Self::Joint => format!("  wrap T by T + {law};\n"),
            Self::Contact => format!("  wrap F by F + {law};\n  Real v = der(e);\n"),
            Self::Scale => format!("  wrap s by s + {law};\n  Real v = der(a.s);\n"),
            Self::Encoder => format!("  wrap phi by phi + {law};\n  Real w = der(a.phi);\n"),
            Self::Tacho => format!("  wrap V6 by V6 + {law};\n"),
            Self::Amplifier => {
                format!("  wrap demand by demand + {law};\n  Real rise = der(i);\n")
            }
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
        Kind::Rail | Kind::Guide | Kind::Contact => ("[N/m]", "[N.s/m]"),
        Kind::Flange | Kind::Bearing | Kind::Belt | Kind::Joint => ("[N.m/rad]", "[N.m.s/rad]"),
        Kind::Scale | Kind::Encoder => ("", "[s]"),
        Kind::Tacho => ("[V/rad]", "[V.s/rad]"),
        Kind::Amplifier => ("", "[s]"),
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
