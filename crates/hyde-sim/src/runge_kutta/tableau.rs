//! The coefficients of ESDIRK5(4)7L[2]SA2 and of its interpolant.
//!
//! C. A. Kennedy, M. H. Carpenter, Diagonally implicit Runge-Kutta methods for stiff ODEs, Appl. Numer. Math. 146 (2019)
//! 221, table 8 there; the same numbers are in ARKODE of SUNDIALS as `ARKODE_ESDIRK547L2SA2_7_4_5`.

/// Stages, of which the first is explicit: the end of the step before.
pub(super) const STAGES: usize = 7;

/// The diagonal of [`A`] below the first row.
pub(super) const GAMMA: f64 = 23.0 / 125.0;

/// The time of each stage as a part of the step.
pub(super) const C: [f64; STAGES] = [
    0.0,
    46.0 / 125.0,
    7_121_331_996_143.0 / 11_335_814_405_378.0,
    49.0 / 353.0,
    3_706_679_970_760.0 / 5_295_570_149_437.0,
    347.0 / 382.0,
    1.0,
];

/// The weights of the slopes in each stage. The last stage is the end of the step.
pub(super) const A: [[f64; STAGES]; STAGES] = [
    row(0.0, [0.0; 5], 0.0, 0),
    row(C[1], [0.0; 5], GAMMA, 1),
    row(
        C[2],
        [791_020_047_304.0 / 3_561_426_431_547.0, 0.0, 0.0, 0.0, 0.0],
        GAMMA,
        2,
    ),
    row(
        C[3],
        [
            -158_159_076_358.0 / 11_257_294_102_345.0,
            -85_517_644_447.0 / 5_003_708_988_389.0,
            0.0,
            0.0,
            0.0,
        ],
        GAMMA,
        3,
    ),
    row(
        C[4],
        [
            -1_653_327_111_580.0 / 4_048_416_487_981.0,
            1_514_767_744_496.0 / 9_099_671_765_375.0,
            14_283_835_447_591.0 / 12_247_432_691_556.0,
            0.0,
            0.0,
        ],
        GAMMA,
        4,
    ),
    row(
        C[5],
        [
            -4_540_011_970_825.0 / 8_418_487_046_959.0,
            -1_790_937_573_418.0 / 7_393_406_387_169.0,
            10_819_093_665_085.0 / 7_266_595_846_747.0,
            4_109_463_131_231.0 / 7_386_972_500_302.0,
            0.0,
        ],
        GAMMA,
        5,
    ),
    row(
        C[6],
        [
            -188_593_204_321.0 / 4_778_616_380_481.0,
            2_809_310_203_510.0 / 10_304_234_040_467.0,
            1_021_729_336_898.0 / 2_364_210_264_653.0,
            870_612_361_811.0 / 2_470_410_392_208.0,
            -1_307_970_675_534.0 / 8_059_683_598_661.0,
        ],
        GAMMA,
        6,
    ),
];

/// The weights of the embedded formula of order 4.
const EMBEDDED: [f64; STAGES] = row(
    1.0,
    [
        -582_099_335_757.0 / 7_214_068_459_310.0,
        615_023_338_567.0 / 3_362_626_566_945.0,
        3_192_122_436_311.0 / 6_174_152_374_399.0,
        6_156_034_052_041.0 / 14_430_468_657_929.0,
        -1_011_318_518_279.0 / 9_693_750_372_484.0,
    ],
    1_914_490_192_573.0 / 13_754_262_428_401.0,
    6,
);

/// The weights of the slopes in the estimated error of a step: of order 5, less of order 4.
pub(super) const ERROR: [f64; STAGES] = {
    let mut error = A[STAGES - 1];
    let mut i = 0;
    while i < STAGES {
        error[i] -= EMBEDDED[i];
        i += 1;
    }
    error
};

/// The weights of the slopes in what the interpolant has beyond the cubic through both ends and their slopes:
/// `h s^2 (1-s)^2 sum BUBBLE[i] K[i]`. They make it of order 4 (the conditions are in the tests), and are the smallest
/// that do. So its error is of the order of the estimated error, which the tolerance bounds.
pub(super) const BUBBLE: [f64; STAGES] = [
    -1.681_711_057_314_285_5,
    2.329_264_413_981_866,
    -0.898_931_831_751_723_3,
    1.510_968_766_974_482_2,
    -2.808_229_307_153_754_3,
    0.929_669_674_669_686_8,
    0.618_969_340_593_729_7,
];

/// The weights of the slopes in the difference of the interpolant to the third stage, at [`C`]`[2]` of the step.
pub(super) const INSIDE: [f64; STAGES] = {
    let (s, last) = (C[2], STAGES - 1);
    let (rest, mut weights) = (1.0 - s, [0.0; STAGES]);
    let mut i = 0;
    while i < STAGES {
        let cubic = s * s * (3.0 - 2.0 * s) * A[last][i];
        weights[i] = cubic + s * s * rest * rest * BUBBLE[i] - A[2][i];
        i += 1;
    }
    weights[0] += s * rest * rest;
    weights[last] -= s * s * rest;
    weights
};

/// A row with this sum, the weights behind the first column, and the weight at the diagonal.
const fn row(sum: f64, inner: [f64; 5], diagonal: f64, at: usize) -> [f64; STAGES] {
    let mut row = [0.0; STAGES];
    let mut rest = sum;
    let mut i = 0;
    while i < 5 {
        row[i + 1] = inner[i];
        rest -= inner[i];
        i += 1;
    }
    if at > 0 {
        row[at] = diagonal;
        rest -= diagonal;
    }
    row[0] = rest;
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `sum w[i] f(i)`.
    fn sum(weights: &[f64; STAGES], f: impl Fn(usize) -> f64) -> f64 {
        weights.iter().enumerate().map(|(i, w)| w * f(i)).sum()
    }

    /// Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, table II.2.2: the conditions of orders 1 to 4,
    /// of which stage order 2 leaves these.
    fn conditions(weights: &[f64; STAGES]) -> [f64; 5] {
        let c_squared = |i: usize| sum(&A[i], |j| C[j].powi(2));
        [
            sum(weights, |_| 1.0),
            sum(weights, |i| C[i]),
            sum(weights, |i| C[i].powi(2)),
            sum(weights, |i| C[i].powi(3)),
            sum(weights, c_squared),
        ]
    }

    fn close(found: &[f64], wanted: &[f64]) {
        for (found, wanted) in found.iter().zip(wanted) {
            // The coefficients are rounded; sums of seven of them of up to 3.
            assert!((found - wanted).abs() < 1e-14, "{found} {wanted}");
        }
    }

    #[test]
    fn every_stage_is_of_order_2() {
        for i in 0..STAGES {
            close(&[sum(&A[i], |_| 1.0)], &[C[i]]);
            close(&[sum(&A[i], |j| C[j])], &[C[i].powi(2) / 2.0]);
        }
    }

    #[test]
    fn both_formulas_are_of_order_4_and_the_method_of_order_5() {
        let order_4 = [1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 12.0];
        close(&conditions(&EMBEDDED), &order_4);
        let b = &A[STAGES - 1];
        close(&conditions(b), &order_4);
        let c_squared = |i: usize| sum(&A[i], |j| C[j].powi(2));
        let order_5 = [
            sum(b, |i| C[i].powi(4)),
            sum(b, |i| C[i] * c_squared(i)),
            sum(b, |i| sum(&A[i], |j| C[j].powi(3))),
            sum(b, |i| sum(&A[i], c_squared)),
        ];
        close(&order_5, &[1.0 / 5.0, 1.0 / 15.0, 1.0 / 20.0, 1.0 / 60.0]);
    }

    #[test]
    fn the_interpolant_is_of_order_4() {
        close(
            &conditions(&BUBBLE),
            &[0.0, 0.0, 0.0, 1.0 / 4.0, 1.0 / 12.0],
        );
    }

    #[test]
    fn what_is_infinitely_stiff_is_forgotten_in_one_step() {
        // y = 0 in every stage: 0 = sum a[i][j]*K[j], with K[0] = 1. The last slope must not remember it.
        let mut slopes = [0.0; STAGES];
        slopes[0] = 1.0;
        for i in 1..STAGES {
            slopes[i] = -sum(&A[i], |j| if j < i { slopes[j] } else { 0.0 }) / GAMMA;
        }
        assert!(slopes[STAGES - 1].abs() < 1e-13, "{slopes:?}");
    }
}
