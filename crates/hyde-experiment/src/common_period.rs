//! The sampled loop under a sine `exp(st)`, over the time after which all its clocks stand to each other as before.
//!
//! The states are `X*exp(st) + xi`: what the sine alone makes of them, and what the held values add, `xi' = A*xi + B*h`.
//! Memory m and held values h change at ticks. In the steady state all of (xi, m, h) repeats after the common period T
//! but for the factor exp(sT), which is one linear system (lifting: Araki and Yamamoto, IEEE Trans. AC 31 (1986) 145).
//! Clocks of one period are the case of one tick in T.

use crate::linearize::Linear;
use crate::sampled::{Clocked, Sampled};
use nalgebra::{Complex, DMatrix};

/// More ticks in the common period are refused.
const MOST_TICKS: f64 = 4000.0;
/// Ticks that are closer, as a part of the common period, are one instant.
const SAME: f64 = 1e-9;

type Matrix = DMatrix<Complex<f64>>;

/// What happens within the common period, in order.
pub(crate) struct CommonPeriod<'a> {
    linear: &'a Linear,
    sampled: &'a Sampled,
    period: f64,
    instants: Vec<Instant>,
    /// exp(A*dt), and its integral times B, for each different time between instants.
    flows: Vec<(DMatrix<f64>, DMatrix<f64>)>,
}

/// An instant at which clocks tick or held values change.
struct Instant {
    t: f64,
    /// The clocks that tick, by their place in the order of clocks.
    clocks: Vec<usize>,
    /// The ticks of all clocks that tick, as one.
    tick: Option<Clocked>,
    /// The held values that change with their tick, and those of an earlier one.
    prompt: Vec<usize>,
    late: Vec<usize>,
    /// Which flow leads to the next instant.
    flow: usize,
}

/// Values of (xi, m, h), some columns of them.
#[derive(Clone)]
struct Values {
    xi: DMatrix<f64>,
    m: DMatrix<f64>,
    h: DMatrix<f64>,
}

/// The common period in s of clocks that have one.
pub(crate) fn common_period(clocks: &[Clocked]) -> Option<f64> {
    let longest = clocks.iter().map(|clock| clock.period).fold(0.0, f64::max);
    let whole = |number: f64| (number - number.round()).abs() < SAME * number;
    let mut times = 1.0;
    loop {
        let period = times * longest;
        let ticks: f64 = clocks.iter().map(|clock| period / clock.period).sum();
        if ticks.is_nan() || ticks > MOST_TICKS {
            return None;
        }
        if clocks.iter().all(|clock| whole(period / clock.period)) {
            return Some(period);
        }
        times += 1.0;
    }
}

impl<'a> CommonPeriod<'a> {
    pub(crate) fn new(linear: &'a Linear, sampled: &'a Sampled) -> Option<Self> {
        let period = common_period(&sampled.clocks)?;
        let mut marks = Vec::new();
        for (number, clock) in sampled.clocks.iter().enumerate() {
            let mut k = 0.0;
            while k < (period / clock.period).round() {
                let tick = clock.phase + k * clock.period;
                marks.push((tick.rem_euclid(period), number, true));
                if clock.delay > 0.0 {
                    marks.push(((tick + clock.delay).rem_euclid(period), number, false));
                }
                k += 1.0;
            }
        }
        // What rounding has put at the end of the period is at its beginning.
        for mark in &mut marks {
            if period - mark.0 < SAME * period {
                mark.0 = 0.0;
            }
        }
        marks.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut instants: Vec<Instant> = Vec::new();
        for (t, number, is_tick) in marks {
            if instants
                .last()
                .is_none_or(|last| t - last.t > SAME * period)
            {
                instants.push(Instant {
                    t,
                    clocks: Vec::new(),
                    tick: None,
                    prompt: Vec::new(),
                    late: Vec::new(),
                    flow: 0,
                });
            }
            let Some(instant) = instants.last_mut() else {
                continue;
            };
            let clock = &sampled.clocks[number];
            let holders = sampled.holder.iter().enumerate();
            let own = holders
                .filter(|(_, holder)| **holder == number)
                .map(|(row, _)| row);
            if !is_tick {
                instant.late.extend(own);
                continue;
            }
            instant.clocks.push(number);
            if clock.delay == 0.0 {
                instant.prompt.extend(own);
            }
            instant.tick = Some(match instant.tick.take() {
                None => clock.clone(),
                Some(before) => after(&before, clock),
            });
        }
        let mut flows = Vec::new();
        let mut spans: Vec<f64> = Vec::new();
        for k in 0..instants.len() {
            let next = instants
                .get(k + 1)
                .map_or(instants[0].t + period, |next| next.t);
            let span = next - instants[k].t;
            let known = spans
                .iter()
                .position(|known| (known - span).abs() < SAME * period);
            instants[k].flow = known.unwrap_or_else(|| {
                spans.push(span);
                flows.push(hold_equivalent(&linear.a, &linear.b_held, span));
                flows.len() - 1
            });
        }
        Some(Self {
            linear,
            sampled,
            period,
            instants,
            flows,
        })
    }

    /// The part of the held values that turns with the input, `H*exp(st)`: their Fourier coefficient.
    ///
    /// `driven` is X, the response of the states to the input alone.
    pub(crate) fn held(&self, input: usize, driven: &Matrix, s: Complex<f64>) -> Option<Matrix> {
        let (nx, nm) = (self.linear.a.nrows(), self.sampled.select.ncols());
        let start = self.repeated(input, driven, s)?;
        let mut values = Values::split(&start, nx, nm);
        let mut total = Matrix::zeros(self.sampled.select.nrows(), 1);
        self.through(&mut values, Some((input, driven, s)), |k, values| {
            total += columns(&values.h) * self.weight(k, s);
        });
        Some(total)
    }

    /// A combination of the memory behind each tick of a clock in the common period, over the input: a sine that the input's
    /// clocked readers see alone. With `exp(st)` taken out, it is the same at every tick where the loop has but that rate.
    pub(crate) fn at_ticks(
        &self,
        input: usize,
        clock: usize,
        row: &DMatrix<f64>,
        s: Complex<f64>,
    ) -> Option<Vec<Complex<f64>>> {
        let still = Matrix::zeros(self.linear.a.nrows(), 1);
        let start = self.repeated(input, &still, s)?;
        let mut values = Values::split(&start, still.nrows(), self.sampled.select.ncols());
        let mut found = Vec::new();
        self.through(&mut values, Some((input, &still, s)), |k, values| {
            let instant = &self.instants[k];
            if instant.clocks.contains(&clock) {
                let turned = (s * instant.t).exp();
                found.push(columns(&(row * &values.m))[(0, 0)] / turned);
            }
        });
        (!found.is_empty()).then_some(found)
    }

    /// The (xi, m, h) at the start of the common period that come again but for the turn of the input.
    fn repeated(&self, input: usize, driven: &Matrix, s: Complex<f64>) -> Option<Matrix> {
        let (nx, nm) = (self.linear.a.nrows(), self.sampled.select.ncols());
        let nh = self.sampled.select.nrows();
        let size = nx + nm + nh;
        let mut open = Values::zeros(nx, nm, nh, 2);
        self.through(&mut open, Some((input, driven, s)), |_, _| {});
        let turned = (s * self.period).exp();
        let mut matrix = Matrix::identity(size, size) * turned;
        matrix -= self.transition().map(|value| Complex::new(value, 0.0));
        matrix.lu().solve(&open.complex())
    }

    /// The weight that values from an instant to the next have in a Fourier coefficient at s.
    fn weight(&self, k: usize, s: Complex<f64>) -> Complex<f64> {
        let from = self.instants[k].t;
        let next = self.instants.get(k + 1).map(|next| next.t);
        let to = next.unwrap_or(self.instants[0].t + self.period);
        if s.norm() > 0.0 {
            ((-s * from).exp() - (-s * to).exp()) / (s * self.period)
        } else {
            Complex::new((to - from) / self.period, 0.0)
        }
    }

    /// The common period in s.
    pub(crate) fn period_s(&self) -> f64 {
        self.period
    }

    /// The first instant of the period, in s.
    pub(crate) fn first_s(&self) -> f64 {
        self.instants.first().map_or(0.0, |instant| instant.t)
    }

    /// What becomes of (xi, m, h) over the common period without an input.
    pub(crate) fn transition(&self) -> DMatrix<f64> {
        let (nx, nm) = (self.linear.a.nrows(), self.sampled.select.ncols());
        let size = nx + nm + self.sampled.select.nrows();
        let whole = DMatrix::identity(size, size);
        let mut values = Values::cut(&whole, nx, nm);
        self.through(&mut values, None, |_, _| {});
        values.whole()
    }

    /// Takes values through the common period; `each` sees them behind every instant.
    fn through(
        &self,
        values: &mut Values,
        drive: Option<(usize, &Matrix, Complex<f64>)>,
        mut each: impl FnMut(usize, &Values),
    ) {
        for (k, instant) in self.instants.iter().enumerate() {
            let before = values.m.clone();
            if let Some(tick) = &instant.tick {
                let mut m = &tick.memory * &values.m
                    + &tick.by_state * &values.xi
                    + &tick.by_held * &values.h;
                if let Some((input, driven, s)) = drive {
                    let turned = (s * instant.t).exp();
                    m += &tick.by_state * parts(&(driven * turned));
                    m += tick.by_input.columns(input, 1)
                        * parts(&Matrix::from_element(1, 1, turned));
                }
                values.m = m;
            }
            for (rows, source) in [(&instant.late, &before), (&instant.prompt, &values.m)] {
                for &row in rows {
                    let held = self.sampled.select.rows(row, 1) * source;
                    values.h.rows_mut(row, 1).copy_from(&held);
                }
            }
            each(k, values);
            let (phi, gamma) = &self.flows[instant.flow];
            values.xi = phi * &values.xi + gamma * &values.h;
        }
    }
}

impl Values {
    fn zeros(nx: usize, nm: usize, nh: usize, columns: usize) -> Self {
        Self {
            xi: DMatrix::zeros(nx, columns),
            m: DMatrix::zeros(nm, columns),
            h: DMatrix::zeros(nh, columns),
        }
    }

    fn cut(whole: &DMatrix<f64>, nx: usize, nm: usize) -> Self {
        Self {
            xi: whole.rows(0, nx).into_owned(),
            m: whole.rows(nx, nm).into_owned(),
            h: whole.rows(nx + nm, whole.nrows() - nx - nm).into_owned(),
        }
    }

    /// A complex column as two real ones.
    fn split(column: &Matrix, nx: usize, nm: usize) -> Self {
        Self::cut(&parts(column), nx, nm)
    }

    fn whole(&self) -> DMatrix<f64> {
        let (nx, nm, nh) = (self.xi.nrows(), self.m.nrows(), self.h.nrows());
        let mut whole = DMatrix::zeros(nx + nm + nh, self.xi.ncols());
        whole.rows_mut(0, nx).copy_from(&self.xi);
        whole.rows_mut(nx, nm).copy_from(&self.m);
        whole.rows_mut(nx + nm, nh).copy_from(&self.h);
        whole
    }

    fn complex(&self) -> Matrix {
        columns(&self.whole())
    }
}

/// Real and imaginary part of a column, side by side.
fn parts(column: &Matrix) -> DMatrix<f64> {
    DMatrix::from_fn(column.nrows(), 2, |row, part| {
        let value = column[(row, 0)];
        if part == 0 { value.re } else { value.im }
    })
}

/// The column of these parts.
fn columns(parts: &DMatrix<f64>) -> Matrix {
    Matrix::from_fn(parts.nrows(), 1, |row, _| {
        Complex::new(parts[(row, 0)], parts[(row, 1)])
    })
}

/// Two ticks at one instant as one: the second sees the memory that the first left, and the same states.
fn after(first: &Clocked, second: &Clocked) -> Clocked {
    Clocked {
        memory: &second.memory * &first.memory,
        by_state: &second.memory * &first.by_state + &second.by_state,
        by_input: &second.memory * &first.by_input + &second.by_input,
        by_held: &second.memory * &first.by_held + &second.by_held,
        ..first.clone()
    }
}

/// exp(A t) and its integral times B, from one exponential of the block matrix (Van Loan, IEEE Trans. AC 23 (1978) 395).
fn hold_equivalent(a: &DMatrix<f64>, b: &DMatrix<f64>, t: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    let (n, m) = (a.nrows(), b.ncols());
    let mut block = DMatrix::zeros(n + m, n + m);
    block.view_mut((0, 0), (n, n)).copy_from(&(a * t));
    block.view_mut((0, n), (n, m)).copy_from(&(b * t));
    let exponential = block.exp();
    (
        exponential.view((0, 0), (n, n)).into_owned(),
        exponential.view((0, n), (n, m)).into_owned(),
    )
}
