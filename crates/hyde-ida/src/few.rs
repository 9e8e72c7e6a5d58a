//! [`with_few!`](crate::with_few): loops over a few values have a length that the compiler knows.

/// Evaluates a body with a count in `$n`: for each of `$few` the body is compiled once more with that constant, so that its
/// loops are unrolled and work on several values at once; the operations and their order are the same.
///
/// ```
/// let sum = |n: usize| hyde_ida::with_few!(n, n in [1 2 3], (0..n).sum::<usize>());
/// assert_eq!([sum(2), sum(5)], [1, 10]);
/// ```
#[macro_export]
macro_rules! with_few {
    ($count:expr, $n:ident in [$($few:literal)*], $body:expr) => {
        match $count {
            $($few => {
                let $n = $few;
                $body
            })*
            $n => $body,
        }
    };
}
