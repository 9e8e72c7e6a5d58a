//! Hard events with a known answer: every [`Case`] runs models of `tests/models/events` and says where they differ from it.

mod chain;
mod grazing;
mod impacts;
mod instants;
mod relay;
mod solved;

/// A hard event with a known answer.
pub struct Case {
    /// What happens, in a few words.
    pub name: &'static str,
    /// Runs it; what differs from the answer.
    pub check: fn() -> Result<(), String>,
}

/// Every case.
pub const CASES: &[Case] = &[
    case("a ball comes to rest", impacts::ball_comes_to_rest),
    case("a ball without rest", impacts::ball_without_rest),
    case("two balls and a wall", impacts::two_balls_and_a_wall),
    case("two impacts at one instant", impacts::two_pairs),
    case("a row of impacts at one instant", impacts::three_balls),
    case("a sine just reaches a level", grazing::touches),
    case("a sine just misses a level", grazing::misses),
    case("a relay that chatters", relay::chatters),
    case("a relay with a width", relay::oscillates),
    case("ten masses stick and slip", chain::ten_masses),
    case("events at the start", instants::start),
    case("an impact at the start", instants::struck),
    case("events at the stop time", instants::stop),
    case("events at a tick", instants::tick),
];

const fn case(name: &'static str, check: fn() -> Result<(), String>) -> Case {
    Case { name, check }
}
