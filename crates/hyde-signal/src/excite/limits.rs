//! [`Bounds`]: what a signal must not exceed; [`Impossible`]: why none does that is asked for.

/// What a motion must not exceed, SI: of a slide m, m/s and so on, of a shaft rad, rad/s and so on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The whole way, from end to end.
    pub travel: f64,
    /// The speed either way.
    pub speed: f64,
    /// The acceleration either way.
    pub acceleration: f64,
    /// The jerk either way.
    pub jerk: f64,
}

impl Limits {
    /// The same a little narrower, for what is rounded to digits afterwards.
    pub(super) fn times(self, part: f64) -> Self {
        Self {
            travel: part * self.travel,
            speed: part * self.speed,
            acceleration: part * self.acceleration,
            jerk: part * self.jerk,
        }
    }

    /// How far a sine of this angular frequency may go either way; each limit counts, the narrowest most.
    pub(super) fn sine(self, omega: f64) -> f64 {
        let parts = [
            2.0 / self.travel,
            omega / self.speed,
            omega.powi(2) / self.acceleration,
            omega.powi(3) / self.jerk,
        ];
        1.0 / parts.iter().map(|part| part * part).sum::<f64>().sqrt()
    }
}

/// What a signal must not exceed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bounds {
    /// A reference position.
    Motion(Limits),
    /// A current, force, torque or voltage: its size either way, SI.
    Effort(f64),
}

/// What is limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The whole way.
    Travel,
    /// The first derivative of a position.
    Speed,
    /// The second one.
    Acceleration,
    /// The third one.
    Jerk,
    /// A current, force, torque or voltage.
    Effort,
}

/// The largest size that a design reaches of what is limited, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// What.
    pub quantity: Quantity,
    /// How much it reaches.
    pub reached: f64,
    /// How much it may reach.
    pub limit: f64,
}

impl Peak {
    /// The part of its limit that it reaches.
    #[must_use]
    pub fn part(&self) -> f64 {
        self.reached / self.limit
    }
}

/// Why there is no such design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Impossible {
    /// The band has no lower and upper end above 0, in Hz.
    Band(f64, f64),
    /// The band begins lower than the record is long.
    Low {
        /// The lower end of the band in Hz.
        from_hz: f64,
        /// How long a record must be for that, s.
        needed_s: f64,
    },
    /// The band ends higher than samples can show.
    High {
        /// The upper end of the band in Hz.
        to_hz: f64,
        /// The highest frequency at this sampling period, Hz.
        most_hz: f64,
    },
    /// No whole number of periods of the record is in the band.
    Narrow {
        /// How long a record must be for a line in the band, s.
        needed_s: f64,
    },
    /// The moves take longer than the record.
    Short {
        /// How long they take, s.
        needed_s: f64,
        /// The limit that makes them as slow.
        binds: Quantity,
    },
    /// A small reversal is as large as the travel.
    Reversal,
    /// The limit is so low for the sampling period that 15 digits do not resolve it.
    Digits(Quantity),
    /// The record has more samples than a design may have.
    Long,
    /// What is limited must be positive and finite.
    NotPositive(Quantity),
    /// Moves of a position are asked for of an effort.
    NoMotion,
}
