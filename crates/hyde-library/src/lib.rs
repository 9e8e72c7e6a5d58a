//! The packages shipped with the language, as text: quantity types, mechanics in rotation and translation, drives. The
//! package `A.B` is the file `A/B.hyde`.
//!
//! They are ordinary source files; nothing in them is known to the compiler. A model names what it uses:
//! `import Rotational.*;`. The shapes of the package `Laws` alone need no import: a diagnosis always has them.

/// A package: its name and its source text.
#[derive(Clone, Copy, Debug)]
pub struct Package {
    /// What `import` names.
    pub name: &'static str,
    /// Its source text.
    pub text: &'static str,
}

/// Every package of the library.
pub const PACKAGES: &[Package] = &[
    Package {
        name: "SI",
        text: include_str!("../models/SI.hyde"),
    },
    Package {
        name: "Blocks",
        text: include_str!("../models/Blocks.hyde"),
    },
    Package {
        name: "Clocked",
        text: include_str!("../models/Clocked.hyde"),
    },
    Package {
        name: "Rotational",
        text: include_str!("../models/Rotational.hyde"),
    },
    Package {
        name: "Translational",
        text: include_str!("../models/Translational.hyde"),
    },
    Package {
        name: "Thermal",
        text: include_str!("../models/Thermal.hyde"),
    },
    Package {
        name: "Planar",
        text: include_str!("../models/Planar.hyde"),
    },
    Package {
        name: "Electrical",
        text: include_str!("../models/Electrical.hyde"),
    },
    Package {
        name: "Drives",
        text: include_str!("../models/Drives.hyde"),
    },
    Package {
        name: "Drives.Control",
        text: include_str!("../models/Drives/Control.hyde"),
    },
    Package {
        name: "Drives.Motors",
        text: include_str!("../models/Drives/Motors.hyde"),
    },
    Package {
        name: "Drives.Transmission",
        text: include_str!("../models/Drives/Transmission.hyde"),
    },
    Package {
        name: "Drives.Screws",
        text: include_str!("../models/Drives/Screws.hyde"),
    },
    Package {
        name: "Drives.Slides",
        text: include_str!("../models/Drives/Slides.hyde"),
    },
    Package {
        name: "Drives.FrictionLaws",
        text: include_str!("../models/Drives/FrictionLaws.hyde"),
    },
    Package {
        name: "Drives.FixedStep",
        text: include_str!("../models/Drives/FixedStep.hyde"),
    },
    Package {
        name: "Laws",
        text: include_str!("../models/Laws.hyde"),
    },
    Package {
        name: "Effects",
        text: include_str!("../models/Effects.hyde"),
    },
    Package {
        name: "Effects.Signals",
        text: include_str!("../models/Effects/Signals.hyde"),
    },
];

/// The package of that name.
#[must_use]
pub fn package(name: &str) -> Option<Package> {
    PACKAGES
        .iter()
        .copied()
        .find(|package| package.name == name)
}
