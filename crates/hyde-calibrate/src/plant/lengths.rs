//! How long steps are: each level halves a row's time once more, down to the shortest.

/// How often a row's time may be halved, its whole included.
pub(crate) const LEVELS: usize = 8;

/// Shortest steps in a row's time.
pub(crate) fn shortest_steps() -> usize {
    1 << (LEVELS - 1)
}

/// Shortest steps in a step of a level.
pub(crate) fn size_of(level: usize) -> usize {
    1 << (LEVELS - 1 - level)
}
