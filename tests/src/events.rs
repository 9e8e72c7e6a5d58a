//! Hard events with a known answer: every [`Case`] runs models of `tests/models/events` and says where they differ from it.

mod chain;
mod contacts;
mod grazing;
mod impacts;
mod instants;
mod relay;
mod sliding;
mod solved;
mod zeno;

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
    case("bounces add up to a time", zeno::sums),
    case("bounces without a flight", zeno::at_once),
    case("five balls in a row", contacts::cradle),
    case("two contacts at one instant", contacts::springs),
    case("backlash of no width", contacts::no_gap),
    case("a ball on a shaken table", contacts::table),
    case("a force exactly at its limit", contacts::limit),
    case("a clutch closes at no speed", contacts::at_speed),
    case("a sine just reaches a level", grazing::touches),
    case("a sine just misses a level", grazing::misses),
    case("a relay slides", sliding::relay),
    case("a relay slides on a surface", sliding::surface),
    case("a relay as friction", sliding::friction),
    case("two relays slide", sliding::two_relays),
    case("surfaces that bend and move", sliding::bent),
    case("events end a slide", sliding::kicked),
    case("ten masses on relays", sliding::row),
    case("a relay that cannot slide", sliding::refused),
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
