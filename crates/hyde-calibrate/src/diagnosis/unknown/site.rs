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

/// The words of the language at a kind of place. Units are as they are written, with how many of them an SI unit is.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    /// What an effect there is on.
    pub(crate) host: &'static str,
    /// What the law is.
    pub what: &'static str,
    /// What a size of the law is called, and its unit.
    pub(crate) value: (&'static str, &'static str),
    /// The place as the law's text names it, and its unit.
    pub(crate) place: (&'static str, (&'static str, f64)),
    /// The speed as the law's text names it, and its unit.
    pub(crate) speed: (&'static str, (&'static str, f64)),
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
            ("Electrical", "CurrentControl") => Some(Self::Amplifier),
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

    /// The SI unit of a force there.
    #[must_use]
    pub fn force_unit(self) -> &'static str {
        si(self.words().value.1)
    }

    /// The SI unit of its place.
    #[must_use]
    pub fn place_unit(self) -> &'static str {
        si(self.words().place.1.0)
    }

    /// The SI unit of its speed.
    #[must_use]
    pub fn speed_unit(self) -> &'static str {
        si(self.words().speed.1.0)
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

    /// The words of the language for it.
    #[must_use]
    pub fn words(self) -> Words {
        let of = |host, what, value, place, speed| Words {
            host,
            what,
            value,
            place,
            speed,
        };
        let (mm, mm_s) = (("mm", 1e3), ("mm/s", 1e3));
        let (rad, rad_s) = (("rad", 1.0), ("rad/s", 1.0));
        let (mrad, um) = (("mrad", 1e3), ("um", 1e6));
        let (slides, speed) = (("a.s", mm), ("v", mm_s));
        let (turns, rate) = (("a.phi", rad), ("w", rad_s));
        let (force, torque) = (("F", "N"), ("T", "N.m"));
        match self {
            Self::Rail => of("Translational.Rail", "a force", force, slides, speed),
            Self::Guide => of("Translational.Guide", "a force", force, slides, speed),
            Self::Flange => of("Rotational.Flange", "a torque", torque, turns, rate),
            Self::Bearing => of("Rotational.Friction", "a torque", torque, turns, rate),
            // What a spring holds is called T or F already.
            Self::Belt => of(
                "Drives.Belt",
                "a torque",
                ("M", "N.m"),
                ("stretch", mrad),
                rate,
            ),
            Self::Joint => {
                let (host, rate) = ("Rotational.SpringDamper", ("w_rel", rad_s));
                of(host, "a torque", ("M", "N.m"), ("twist", mrad), rate)
            }
            Self::Contact => of(
                "Translational.Contact",
                "a force",
                ("P", "N"),
                ("e", um),
                speed,
            ),
            Self::Scale => {
                let host = "Translational.PositionSensor";
                of(host, "an error", ("e", "m"), slides, speed)
            }
            Self::Encoder => {
                let host = "Rotational.AngleSensor";
                of(host, "an error", ("e", "rad"), turns, rate)
            }
            Self::Tacho => {
                let host = "Drives.Control.Tachogenerator";
                of(host, "a voltage", ("U", "V"), turns, rate)
            }
            Self::Amplifier => {
                let (host, demand) = ("Electrical.CurrentControl", ("i_ref", ("A", 1.0)));
                let rise = ("rise", ("A/s", 1.0));
                of(host, "a current", ("I", "A"), demand, rise)
            }
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

/// The SI unit of what is written in one of the units of [`Words`].
pub(crate) fn si(unit: &'static str) -> &'static str {
    match unit {
        "mm" | "um" => "m",
        "mm/s" => "m/s",
        "mrad" => "rad",
        other => other,
    }
}

/// An effect by which a force at a site is felt, or a sensor's error: its sizes are the force, and forces a unit of
/// place and of speed.
pub(crate) fn probe(site: &Site, name: &str) -> Written {
    let kind = site.kind;
    let words = kind.words();
    let ((_, unit), (place, (of_place, _)), (speed, (of_speed, _))) =
        (words.value, words.place, words.speed);
    let (of_place, of_speed) = (si(of_place), si(of_speed));
    let law =
        format!("(force + by_place*{place}/(1 [{of_place}]) + by_speed*{speed}/(1 [{of_speed}]))");
    let size = format!("= 0 [{unit}] in -1 .. 1 [{unit}]");
    let text = format!(
        "effect {name} on {}\n  size Real force {size}, by_place {size}, by_speed {size};\n{}end {name};\n",
        words.host,
        kind.clauses(&law)
    );
    Written {
        name: name.to_owned(),
        text,
        site: site.path.clone(),
    }
}
