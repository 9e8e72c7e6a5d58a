//! What the tests across crates and the figures share: the examples, compiled as the command line compiles them.
