//! [`Thresholds`]: every number that decides an answer of a diagnosis, in one place, each with the reason for its value.
//!
//! ```text
//! inquiry -> ground, gates -> where it is read      no other number of this folder decides an answer
//! TABLE                                             the same as data: for the table of the book and for ablations
//! ```
//! Numbers that only say how finely a grid, a sum or a step of an algorithm works stay beside their algorithm. Their
//! documentation begins with `Numerics:`; a test accepts no other number there.

/// A number of a threshold.
trait Number: Copy {
    fn of(number: f64) -> Self;
}

impl Number for f64 {
    fn of(number: f64) -> Self {
        number
    }
}

impl Number for usize {
    /// An infinite number is as many as there are.
    fn of(number: f64) -> Self {
        number as Self
    }
}

/// A threshold as data.
#[derive(Clone, Copy)]
pub struct Threshold {
    /// The name of its field.
    pub name: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// The value that a diagnosis uses.
    pub value: f64,
    /// Why it has this value.
    pub reason: &'static str,
    /// The value with which it decides nothing.
    pub removed: f64,
    set: fn(&mut Thresholds, f64),
}

impl Threshold {
    /// Gives it another value; counts are cut to whole numbers.
    pub fn set(&self, thresholds: &mut Thresholds, value: f64) {
        (self.set)(thresholds, value);
    }
}

macro_rules! thresholds {
    ($(
        $(#[doc = $meaning:literal])+
        $name:ident: $kind:ty = $value:expr, because $reason:literal, removed $removed:expr;
    )+) => {
        /// Every threshold of a diagnosis. `default` has the values of the method.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Thresholds {
            $( $(#[doc = $meaning])+ pub $name: $kind, )+
        }

        impl Default for Thresholds {
            fn default() -> Self {
                Self { $( $name: $value, )+ }
            }
        }

        /// All thresholds, in the order of the search.
        pub const TABLE: &[Threshold] = &[
            $( Threshold {
                name: stringify!($name),
                meaning: concat!($($meaning),+),
                value: $value as f64,
                reason: $reason,
                removed: $removed,
                set: |thresholds, value| thresholds.$name = <$kind as Number>::of(value),
            }, )+
        ];
    };
}

thresholds! {
    /// Probability with which a single test may pass by chance in a data set without any effect.
    chance: f64 = 0.01,
        because "one false alarm in a hundred data sets is acceptable; the figure `false_alarms_of_100` counts them",
        removed 0.5;
    /// Improvement in cross-validation per innovation, and per part explained by an effect with modes.
    material: f64 = crate::observer::MATERIAL,
        because "an improvement below it changes the error of a prediction by less than 0.1 %, however significant it is",
        removed 0.0;
    /// Mean square of whitened innovations up to which a channel is explained.
    explained_size: f64 = 1.05,
        because "the standard deviation of a sensor is seldom declared more accurately than to 2.5 %",
        removed 1.0;
    /// Autocorrelation of innovations up to which a channel is explained.
    explained_likeness: f64 = 0.1,
        because "rounding of an encoder correlates neighbouring samples without a missing effect",
        removed 0.0;
    /// Share of the residual in excess of noise that findings must explain, or the verdict is unknown; that an effect must promise to be tried before a law; of what a law could explain that it must; of an effect that must be a function of one variable to be drawn as a curve; of the difference between a recorded and a computed command that a shift in time must explain.
    mostly: f64 = 0.5,
        because "most is more than half",
        removed 0.0;
    /// Share below which a part is not worth a word: of the residual beside an unknown rest; of the first term's improvement in the third of a law, which is a series otherwise; of a recorded command that the controller of the model may leave for their times to be compared.
    a_part: f64 = 0.1,
        because "a tenth changes no conclusion",
        removed 0.0;
    /// Factor by which a fit may exceed the predicted improvement of a linear effect.
    too_good: f64 = 3.0,
        because "the prediction of a linear effect is good to a factor of two; more is a better fit of everything else",
        removed f64::INFINITY;
    /// Improvement per innovation above which a fit may exceed the prediction by any factor.
    remainder: f64 = 0.02,
        because "ten times the material improvement: a larger effect is no longer linear",
        removed 0.0;
    /// Relative distance of two periods, orders or frequencies below which they are one.
    alike: f64 = 0.1,
        because "the same effect twice, with nearly the same period, imitates one with another course",
        removed 0.0;
    /// Factor beyond its range up to which a size on its bound is fitted, and a detectable size is stated.
    room: f64 = 10.0,
        because "the ranges of the library are usual values; one decade more is still the same effect",
        removed 1.0;
    /// Share of the curvature's increase of cost that a profile must show, or its interval is widened.
    grown: f64 = 0.25,
        because "a cost that grows by a quarter of the prediction has an interval twice as wide",
        removed 0.0;
    /// Share of the best improvement above which a hypothesis may still become the best: of scores, of fits after a few steps, of rivals beside a residual, of terms whose constants are not refined, of a law in place of effects that explain as much.
    contender: f64 = 0.5,
        because "the linear prediction is good to a factor of two",
        removed 1.0;
    /// Share of the best improvement above which another effect, another site, another place of a period or another first term of a law is a rival of the best, and is fitted on as long as it can reach the best.
    rival: f64 = 0.8,
        because "an effect bends towards what is missing beside it by up to a fifth of its improvement",
        removed 1.0;
    /// Alternatives that are pursued at most: places of an effect or of a period, pairs, rivals, sites of a law; twice as many hypotheses or terms are fitted in a round.
    few: usize = 3,
        because "the linear prediction orders candidates well enough that the answer is among the first three",
        removed 1.0;
    /// Attempts beyond the first after an effect was dropped again.
    retries: usize = 2,
        because "each attempt costs a round or a whole search and has fewer hypotheses left",
        removed 0.0;
    /// Share of the best improvement below which a hypothesis, or a further term of a law, is not pursued; that an alternative fails to repeat at most to be no other answer; advantage of a variable over a better known one for a curve.
    negligible: f64 = 0.01,
        because "what gains a hundredth of the best is found in a later round, if it is there",
        removed 0.0;
    /// Share of the required improvement that a prediction must reach to be checked by a simulation.
    passable: f64 = 0.25,
        because "a simulation gains at most a few times what its prediction promises",
        removed 0.0;
    /// Sum of the costs of two shapes that are multiplied.
    law_cost: usize = 2,
        because "the dictionary grows with the square of its shapes, and so does what chance finds in it",
        removed 0.0;
    /// Terms of a law at most.
    law_terms: usize = 3,
        because "a law of more terms is a series, which explains nothing",
        removed 1.0;
    /// Share of the best knot's information that a knot of a curve must have.
    shown: f64 = 1e-4,
        because "a point whose deviation is a hundred times that of the best one says nothing",
        removed 0.0;
    /// Records of the same motion beyond which no experiment is proposed.
    more_records: f64 = 1000.0,
        because "nobody records a motion a thousand times",
        removed f64::INFINITY;
}
