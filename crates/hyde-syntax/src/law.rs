//! [`LawForm`] and [`LawTarget`]: what a law of a site is, and what it is added to, as the site's `over` says.

/// What a law of a site is, by the roles of its two variables: a place and its speed, or what stands for them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawForm {
    /// `place` and `speed`: a force on what moves, the error of a sensor.
    Motion,
    /// `place` and `slip`, the speed with which two surfaces slip: the size of a friction, its sign that of the motion.
    Friction,
    /// `stretch` and `rate`: what is elastic; it bends about 0.
    Elastic,
    /// `demand` and `rate`: what an amplifier is asked for, and how fast that which follows it changes; it bends about 0.
    Demand,
}

/// What a law is added to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LawTarget {
    /// The flow of a connector, by name.
    Flow(String),
    /// A site, an input or an output of a component.
    Value {
        /// Its name.
        name: String,
        /// The site that holds a friction at rest: it takes the same law.
        hold: Option<String>,
        /// Whether it is an output, as the reading of a sensor is.
        output: bool,
    },
}
