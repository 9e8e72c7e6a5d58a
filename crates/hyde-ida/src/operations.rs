//! The vector operations IDA spends its time in, written so that they vectorise.
//!
//! Those of SUNDIALS do one operation per call and sum in one accumulator. Here linear combinations and the update of
//! IDA's history take one pass, and norms have several accumulators. Each is compiled twice: a machine with AVX2 does the
//! same operations in the same order, more of them at once, so that the bits are those of any machine. Every function
//! works on blocks of numbers, read before they are written, so that an output may be one of the inputs. Without AVX2, on
//! a shaft of 10, 100 and 1000 cells, a whole run takes 0.71, 0.79 and 0.77 of the time with SUNDIALS' own operations
//! compiled by gcc -O2, 0.84, 0.93 and 0.97 by -O3.

use std::array;
use std::ffi::c_int;

use multiversion::multiversion;
use sundials_sys as sys;

use crate::vector::parts;

/// The numbers of a block: enough sums at once to hide the latency of an addition, few left over in short vectors.
const LANES: usize = 4;
type Block = [f64; LANES];

/// Replaces operations of a serial vector.
pub(crate) fn install(ops: &mut sys::_generic_N_Vector_Ops) {
    ops.nvclone = Some(clone);
    ops.nvlinearsum = Some(linear_sum);
    ops.nvconst = Some(constant);
    ops.nvscale = Some(scale);
    ops.nvwrmsnorm = Some(weighted_norm);
    ops.nvwrmsnormmask = Some(masked_norm);
    ops.nvlinearcombination = Some(linear_combination);
    ops.nvlinearsumvectorarray = Some(linear_sums);
}

/// Writes the error weights `1 / (rtol |y| + atol)`.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn error_weights(rtol: f64, atol: &[f64], y: &[f64], weights: &mut [f64]) {
    for ((weight, &y), &atol) in weights.iter_mut().zip(y).zip(atol) {
        *weight = 1.0 / (rtol * y.abs() + atol);
    }
}

/// The index of the first NaN or infinity.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn find_not_finite(values: &[f64]) -> Option<usize> {
    // Zero times a finite number is zero, else NaN: a sum that vectorises, where a search would stop at each number.
    let (blocks, rest) = values.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for block in blocks {
        sums = array::from_fn(|lane| sums[lane] + 0.0 * block[lane]);
    }
    let sum = sums
        .iter()
        .chain(rest)
        .map(|value| 0.0 * value)
        .sum::<f64>();
    if sum.is_nan() {
        values.iter().position(|value| !value.is_finite())
    } else {
        None
    }
}

/// A vector like this one, of zeros: the model, which is safe code, may see any of them before IDA has written to it.
unsafe extern "C" fn clone(like: sys::N_Vector) -> sys::N_Vector {
    // SAFETY: IDA gives a vector made after ours; the new one is of the same kind, and nothing else refers to it yet.
    unsafe {
        let vector = sys::N_VClone_Serial(like);
        if !vector.is_null() {
            let (n, data) = parts(vector);
            data.write_bytes(0, n);
        }
        vector
    }
}

/// `z = a x + b y`.
#[multiversion(targets("x86_64+avx2"))]
unsafe extern "C" fn linear_sum(
    a: f64,
    x: sys::N_Vector,
    b: f64,
    y: sys::N_Vector,
    z: sys::N_Vector,
) {
    // SAFETY: IDA gives vectors made after ours, all of one length.
    unsafe {
        let ((n, x), (_, y), (_, z)) = (parts(x), parts(y), parts(z));
        #[expect(
            clippy::float_cmp,
            reason = "a shortcut for exactly 1, by far the commonest factor"
        )]
        if a == 1.0 {
            write_blocks(
                n,
                z,
                |i| block_sum(read(x, i), b, read(y, i)),
                |i| *x.add(i) + b * *y.add(i),
            );
        } else {
            write_blocks(
                n,
                z,
                |i| block_sum(block_scaled(a, read(x, i)), b, read(y, i)),
                |i| a * *x.add(i) + b * *y.add(i),
            );
        }
    }
}

/// `z = c`.
unsafe extern "C" fn constant(c: f64, z: sys::N_Vector) {
    // SAFETY: as in `linear_sum`; nothing else refers to `z` now.
    unsafe { crate::vector::values_mut(z).fill(c) };
}

/// `z = c x`.
#[multiversion(targets("x86_64+avx2"))]
unsafe extern "C" fn scale(c: f64, x: sys::N_Vector, z: sys::N_Vector) {
    // SAFETY: as in `linear_sum`.
    unsafe {
        let ((n, x), (_, z)) = (parts(x), parts(z));
        write_blocks(n, z, |i| block_scaled(c, read(x, i)), |i| c * *x.add(i));
    }
}

/// `sqrt(sum((x w)^2) / n)`.
#[multiversion(targets("x86_64+avx2"))]
unsafe extern "C" fn weighted_norm(x: sys::N_Vector, w: sys::N_Vector) -> f64 {
    // SAFETY: as in `linear_sum`.
    unsafe {
        let ((n, x), (_, w)) = (parts(x), parts(w));
        root_mean_square(
            n,
            |i| block_product(read(x, i), read(w, i)),
            |i| *x.add(i) * *w.add(i),
        )
    }
}

/// `sqrt(sum over id > 0 of (x w)^2 / n)`.
#[multiversion(targets("x86_64+avx2"))]
unsafe extern "C" fn masked_norm(x: sys::N_Vector, w: sys::N_Vector, id: sys::N_Vector) -> f64 {
    // SAFETY: as in `linear_sum`. The mask is 0 or 1 everywhere, so that a product selects; an excluded infinity would
    // give NaN, with which IDA rejects the step, as it should.
    unsafe {
        let ((n, x), (_, w), (_, id)) = (parts(x), parts(w), parts(id));
        root_mean_square(
            n,
            |i| block_product(block_product(read(x, i), read(w, i)), read(id, i)),
            |i| *x.add(i) * *w.add(i) * *id.add(i),
        )
    }
}

/// `z = sum over k of c[k] x[k]`.
#[multiversion(targets("x86_64+avx2"))]
unsafe extern "C" fn linear_combination(
    count: c_int,
    c: *mut f64,
    x: *mut sys::N_Vector,
    z: sys::N_Vector,
) -> sys::SUNErrCode {
    // SAFETY: IDA gives `count` factors and vectors.
    unsafe {
        match count {
            1 => combine::<1>(c, x, z),
            2 => combine::<2>(c, x, z),
            3 => combine::<3>(c, x, z),
            4 => combine::<4>(c, x, z),
            5 => combine::<5>(c, x, z),
            6 => combine::<6>(c, x, z),
            _ => return sys::N_VLinearCombination_Serial(count, c, x, z),
        }
    }
    0
}

/// `z[k] = a x[k] + b y[k]`, in this order of `k`.
///
/// IDA calls this once a step, to add the correction up through its history: `x[k] += y[k]` with `y[k] = x[k - 1]`,
/// where `y[0]` is the correction. That is one pass of running sums.
#[multiversion(targets("x86_64+avx2"))]
unsafe extern "C" fn linear_sums(
    count: c_int,
    a: f64,
    x: *mut sys::N_Vector,
    b: f64,
    y: *mut sys::N_Vector,
    z: *mut sys::N_Vector,
) -> c_int {
    // SAFETY: IDA gives `count` vectors in each array.
    unsafe {
        #[expect(
            clippy::float_cmp,
            reason = "running sums are those with factors of exactly 1"
        )]
        let running = a == 1.0
            && b == 1.0
            && (0..count as usize)
                .all(|k| *z.add(k) == *x.add(k) && (k == 0 || *y.add(k) == *x.add(k - 1)));
        match count {
            2 if running => accumulate::<2>(*y, x),
            3 if running => accumulate::<3>(*y, x),
            4 if running => accumulate::<4>(*y, x),
            5 if running => accumulate::<5>(*y, x),
            6 if running => accumulate::<6>(*y, x),
            _ => {
                for k in 0..count as usize {
                    linear_sum(a, *x.add(k), b, *y.add(k), *z.add(k));
                }
            }
        }
    }
    0
}

#[inline(always)]
unsafe fn combine<const K: usize>(c: *const f64, x: *const sys::N_Vector, z: sys::N_Vector) {
    // SAFETY: the caller gives `K` factors and vectors of one length; `z` may be one of them.
    unsafe {
        let c: [f64; K] = array::from_fn(|k| *c.add(k));
        let x: [*mut f64; K] = array::from_fn(|k| parts(*x.add(k)).1);
        let (n, z) = parts(z);
        write_blocks(
            n,
            z,
            |i| {
                (1..K).fold(block_scaled(c[0], read(x[0], i)), |sum, k| {
                    block_sum(sum, c[k], read(x[k], i))
                })
            },
            |i| (1..K).fold(c[0] * *x[0].add(i), |sum, k| sum + c[k] * *x[k].add(i)),
        );
    }
}

#[inline(always)]
unsafe fn accumulate<const K: usize>(first: sys::N_Vector, x: *const sys::N_Vector) {
    // SAFETY: the caller gives `K` vectors of the length of `first`.
    unsafe {
        let (n, first) = parts(first);
        let x: [*mut f64; K] = array::from_fn(|k| parts(*x.add(k)).1);
        for i in (0..n - n % LANES).step_by(LANES) {
            let mut sum = read(first, i);
            for x in x {
                sum = block_sum(read(x, i), 1.0, sum);
                x.add(i).cast::<Block>().write(sum);
            }
        }
        for i in n - n % LANES..n {
            let mut sum = *first.add(i);
            for x in x {
                sum += *x.add(i);
                *x.add(i) = sum;
            }
        }
    }
}

/// Writes `block(i)` to the whole blocks of `z`, and `one(i)` to the rest.
#[inline(always)]
unsafe fn write_blocks(
    n: usize,
    z: *mut f64,
    block: impl Fn(usize) -> Block,
    one: impl Fn(usize) -> f64,
) {
    // SAFETY: `z` has `n` entries (given by the caller).
    unsafe {
        for i in (0..n - n % LANES).step_by(LANES) {
            z.add(i).cast::<Block>().write(block(i));
        }
        for i in n - n % LANES..n {
            *z.add(i) = one(i);
        }
    }
}

#[inline(always)]
fn root_mean_square(n: usize, block: impl Fn(usize) -> Block, one: impl Fn(usize) -> f64) -> f64 {
    let mut sums = [0.0; LANES];
    for i in (0..n - n % LANES).step_by(LANES) {
        let terms = block(i);
        sums = array::from_fn(|lane| sums[lane] + terms[lane] * terms[lane]);
    }
    let rest: f64 = (n - n % LANES..n).map(|i| one(i) * one(i)).sum();
    ((sums.iter().sum::<f64>() + rest) / n as f64).sqrt()
}

/// # Safety
/// `x` must have `LANES` entries from `i` on.
#[inline(always)]
unsafe fn read(x: *const f64, i: usize) -> Block {
    // SAFETY: given by the caller; a block needs no more alignment than a number.
    unsafe { x.add(i).cast::<Block>().read() }
}

#[inline(always)]
fn block_sum(x: Block, factor: f64, y: Block) -> Block {
    array::from_fn(|lane| x[lane] + factor * y[lane])
}

#[inline(always)]
fn block_scaled(factor: f64, x: Block) -> Block {
    array::from_fn(|lane| factor * x[lane])
}

#[inline(always)]
fn block_product(x: Block, y: Block) -> Block {
    array::from_fn(|lane| x[lane] * y[lane])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::context::Context;
    use crate::vector::Vector;

    /// Lengths with and without whole blocks and a rest.
    const LENGTHS: std::ops::Range<usize> = 1..3 * LANES;

    fn vector(n: usize, seed: f64, context: &Context) -> Vector {
        let values: Vec<f64> = (0..n).map(|i| (seed + i as f64).sin()).collect();
        Vector::from_slice(&values, context).unwrap()
    }

    fn assert_close(found: &[f64], expected: impl Iterator<Item = f64>) {
        for (found, expected) in found.iter().zip(expected) {
            // A few roundings of numbers of order 1 to 10.
            assert!(
                (found - expected).abs() < 1e-14,
                "{found} instead of {expected}"
            );
        }
    }

    #[test]
    fn sums_and_multiples_may_overwrite_their_arguments() {
        let context = Context::new().unwrap();
        for n in LENGTHS {
            for a in [1.0, 0.3] {
                let (x, y) = (vector(n, 1.0, &context), vector(n, 2.0, &context));
                let (before_x, before_y) = (x.as_slice().to_vec(), y.as_slice().to_vec());
                let sum = || before_x.iter().zip(&before_y).map(|(x, y)| a * x - 0.7 * y);
                let z = vector(n, 3.0, &context);
                // SAFETY: all vectors have the same length.
                unsafe {
                    linear_sum(a, x.raw(), -0.7, y.raw(), z.raw());
                    assert_close(z.as_slice(), sum());
                    linear_sum(a, x.raw(), -0.7, y.raw(), x.raw());
                    assert_close(x.as_slice(), sum());
                    scale(a, y.raw(), y.raw());
                    assert_close(y.as_slice(), before_y.iter().map(|y| a * y));
                    constant(a, z.raw());
                    assert_close(z.as_slice(), (0..n).map(|_| a));
                }
            }
        }
    }

    #[test]
    fn norms_are_root_mean_squares() {
        let context = Context::new().unwrap();
        for n in LENGTHS {
            let (x, w) = (vector(n, 1.0, &context), vector(n, 2.0, &context));
            let mask: Vec<f64> = (0..n).map(|i| (i % 2) as f64).collect();
            let id = Vector::from_slice(&mask, &context).unwrap();
            let squares: Vec<f64> = x
                .as_slice()
                .iter()
                .zip(w.as_slice())
                .map(|(x, w)| (x * w).powi(2))
                .collect();
            let norm = |sum: f64| (sum / n as f64).sqrt();
            // SAFETY: all vectors have the same length.
            let found = unsafe {
                [
                    weighted_norm(x.raw(), w.raw()),
                    masked_norm(x.raw(), w.raw(), id.raw()),
                ]
            };
            let odd = squares.iter().skip(1).step_by(2).sum();
            assert_close(&found, [norm(squares.iter().sum()), norm(odd)].into_iter());
        }
    }

    #[test]
    fn combinations_of_any_count() {
        let context = Context::new().unwrap();
        for n in LENGTHS {
            for count in 1..=7 {
                let x: Vec<Vector> = (0..count).map(|k| vector(n, k as f64, &context)).collect();
                let mut raw: Vec<_> = x.iter().map(Vector::raw).collect();
                let mut c: Vec<f64> = (0..count).map(|k| 0.5 + k as f64).collect();
                let z = vector(n, 0.0, &context);
                // SAFETY: there are as many factors and vectors as said, all of one length.
                let flag =
                    unsafe { linear_combination(count, c.as_mut_ptr(), raw.as_mut_ptr(), z.raw()) };
                assert_eq!(flag, 0);
                let term = |i: usize| move |(c, x): (&f64, &Vector)| c * x.as_slice()[i];
                assert_close(
                    z.as_slice(),
                    (0..n).map(|i| c.iter().zip(&x).map(term(i)).sum()),
                );
            }
        }
    }

    #[test]
    fn running_sums_are_sums_one_after_the_other() {
        let context = Context::new().unwrap();
        for n in LENGTHS {
            for count in 1..=7_usize {
                for factor in [1.0, 0.5] {
                    let first = vector(n, 9.0, &context);
                    let x: Vec<Vector> =
                        (0..count).map(|k| vector(n, k as f64, &context)).collect();
                    let mut expected = vec![first.as_slice().to_vec()];
                    for x in &x {
                        let last = &expected[expected.len() - 1];
                        let sum = x.as_slice().iter().zip(last).map(|(x, y)| x + factor * y);
                        expected.push(sum.collect());
                    }
                    let mut x_raw: Vec<_> = x.iter().map(Vector::raw).collect();
                    let mut z_raw = x_raw.clone();
                    let mut y_raw = vec![first.raw()];
                    y_raw.extend(&x_raw[..count - 1]);
                    let (x_raw, y_raw, z_raw) =
                        (x_raw.as_mut_ptr(), y_raw.as_mut_ptr(), z_raw.as_mut_ptr());
                    // SAFETY: there are `count` vectors in each array, all of one length.
                    unsafe { linear_sums(count as c_int, 1.0, x_raw, factor, y_raw, z_raw) };
                    for (x, expected) in x.iter().zip(&expected[1..]) {
                        assert_close(x.as_slice(), expected.iter().copied());
                    }
                }
            }
        }
    }

    #[test]
    fn finds_what_is_not_finite() {
        for n in LENGTHS {
            let mut values = vec![f64::MAX; n];
            assert_eq!(find_not_finite(&values), None);
            for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                values[n - 1] = wrong;
                assert_eq!(find_not_finite(&values), Some(n - 1));
            }
            values[0] = f64::INFINITY;
            assert_eq!(find_not_finite(&values), Some(0));
        }
    }
}
