//! [`Projection`]: what a change of innovations gains once the parameters have answered it.
//!
//! Most effects look like a change of parameters to begin with. With the derivatives J of the innovations r by the
//! parameters, and what is known of these beforehand, the least sum of squares near here is
//! `V(r) = r'r - h'A^-1 h`, `A = J'J + P`, `h = J'r + P(p - p0)`. An effect that changes r by d gains `V(r) - V(r + d)`. For
//! a small size s with d = s*c that is the score test of Rao (Proc. Camb. Phil. Soc. 44, 1948, 50) with nuisance
//! parameters: `b^2/M`.

use super::products::Products;
use super::stage::{Ground, Stage, flat};
use crate::fit::Linearised;
use crate::observer::{Innovations, KNOWN_TO, Track, changes_if_late};
use crate::plant::Unsupported;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Innovations, with what parameters can do about them.
pub(crate) struct Projection {
    pub(crate) innovations: DVector<f64>,
    /// The derivatives, a row a parameter.
    derivatives: DMatrix<f64>,
    /// Of each record, row by row with its channels beside each other: derivatives, and the innovation below them.
    pub(crate) records: Vec<DMatrix<f64>>,
    factor: Cholesky<f64, Dyn>,
    h: DVector<f64>,
    least: f64,
}

/// A linear answer of innovations to some sizes.
pub(crate) struct Answer {
    /// The sizes that gain most, in units of the columns.
    pub(crate) sizes: Vec<f64>,
    /// What they gain.
    pub(crate) gain: f64,
    /// The squares of each column.
    pub(crate) squares: Vec<f64>,
    m: DMatrix<f64>,
    b: DVector<f64>,
}

impl Answer {
    /// What other sizes gain.
    pub(crate) fn gain_of(&self, sizes: &[f64]) -> f64 {
        let sizes = DVector::from_column_slice(sizes);
        2.0 * self.b.dot(&sizes) - sizes.dot(&(&self.m * &sizes))
    }

    /// The size at which a gain is reached where the other sizes are 0.
    pub(crate) fn reaches(&self, gain: f64, number: usize) -> f64 {
        (gain / self.m[(number, number)]).sqrt()
    }
}

/// Products of columns: with the derivatives, with each other, with the innovations.
pub(crate) struct Sums {
    onto: DMatrix<f64>,
    own: DMatrix<f64>,
    with_innovations: DVector<f64>,
}

impl Sums {
    /// Those of columns beside others; `common` are products of these columns, row by row, with the others.
    pub(crate) fn beside(&self, others: &Self, common: &DMatrix<f64>) -> Self {
        let (n, a, b) = (self.onto.nrows(), self.own.nrows(), others.own.nrows());
        let mut own = DMatrix::zeros(a + b, a + b);
        own.view_mut((0, 0), (a, a)).copy_from(&self.own);
        own.view_mut((a, a), (b, b)).copy_from(&others.own);
        own.view_mut((0, a), (a, b)).copy_from(common);
        own.view_mut((a, 0), (b, a)).copy_from(&common.transpose());
        let mut onto = DMatrix::zeros(n, a + b);
        onto.columns_mut(0, a).copy_from(&self.onto);
        onto.columns_mut(a, b).copy_from(&others.onto);
        let mut with_innovations = DVector::zeros(a + b);
        with_innovations
            .rows_mut(0, a)
            .copy_from(&self.with_innovations);
        with_innovations
            .rows_mut(a, b)
            .copy_from(&others.with_innovations);
        Self {
            onto,
            own,
            with_innovations,
        }
    }
}

impl Projection {
    /// Where a stage is, without what driving columns explain that come a little later or earlier than their record says.
    /// `None` if the parameters have no curvature at all.
    pub(crate) fn of(
        stage: &Stage,
        tracks: &[Track<'_>],
        ground: &Ground<'_>,
    ) -> Result<Option<Self>, Unsupported> {
        let mut at = stage.linearise_on(tracks, ground)?;
        let Some(mut projection) = Self::new(stage, &at) else {
            return Ok(None);
        };
        let set = ground.set_in(&stage.program, &stage.values());
        let pairs = tracks.iter().zip(ground.recordings);
        let late = pairs.map(|(track, recording)| {
            let p = recording.parameters(&stage.program, &set);
            changes_if_late(track, &stage.program, recording, &p)
        });
        let late = late.collect::<Result<Vec<DMatrix<f64>>, Unsupported>>()?;
        for column in 0..stage.program.columns.len() {
            let of_records = late
                .iter()
                .flat_map(|own| own.column(column).iter().copied().collect::<Vec<_>>());
            let all: Vec<f64> = of_records.collect();
            if all.iter().all(|change| *change == 0.0) {
                continue;
            }
            let answer = projection.answer(&[all]);
            let rows = answer.sizes[0].clamp(-KNOWN_TO, KNOWN_TO);
            for (innovations, own) in at.innovations.iter_mut().zip(&late) {
                let channels = innovations.channels.iter_mut().flatten();
                channels
                    .zip(own.column(column).iter())
                    .for_each(|(into, change)| *into += rows * change);
            }
            let Some(next) = Self::new(stage, &at) else {
                return Ok(None);
            };
            projection = next;
        }
        Ok(Some(projection))
    }

    /// `None` if the parameters have no curvature at all.
    fn new(stage: &Stage, at: &Linearised) -> Option<Self> {
        let innovations = DVector::from_vec(flat(&at.innovations));
        let n = stage.varied.len();
        let mut derivatives = DMatrix::zeros(n, innovations.len());
        let mut first = 0;
        for own in &at.derivatives {
            let rows = own.nrows();
            derivatives.columns_mut(first, rows).tr_copy_from(own);
            first += rows;
        }
        let records = at.derivatives.iter().zip(&at.innovations);
        let records = records
            .map(|(own, innovations)| beside(own, innovations))
            .collect();
        let mut a = &derivatives * derivatives.transpose();
        let mut h = &derivatives * &innovations;
        for (i, varied) in stage.varied.iter().enumerate() {
            if let Some(sd) = varied.prior {
                let (scale, weight) = (varied.scale() / sd, stage.solution.weight);
                a[(i, i)] += weight * scale * scale;
                h[i] += weight * scale * (stage.solution.values[i] - varied.nominal) / sd;
            }
        }
        let floor = 1e-12 * a.diagonal().iter().fold(1e-300_f64, |most, v| most.max(*v));
        for i in 0..n {
            a[(i, i)] += floor;
        }
        let factor = Cholesky::new(a)?;
        let least = innovations.dot(&innovations) - h.dot(&factor.solve(&h));
        Some(Self {
            innovations,
            derivatives,
            records,
            factor,
            h,
            least,
        })
    }

    /// The number of parameters.
    pub(crate) fn parameters(&self) -> usize {
        self.h.len()
    }

    /// The product of two changes of innovations without what parameters answer to them.
    pub(crate) fn common(&self, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
        let (onto_a, onto_b) = (&self.derivatives * a, &self.derivatives * b);
        a.dot(b) - onto_a.dot(&self.factor.solve(&onto_b))
    }

    /// A change of innovations without what parameters answer to it.
    pub(crate) fn rest(&self, change: &DVector<f64>) -> DVector<f64> {
        let answered = self.factor.solve(&(&self.derivatives * change));
        change - self.derivatives.tr_mul(&answered)
    }

    /// What a change of innovations gains, and how far the parameters go to answer it, in units of their scales.
    pub(crate) fn answered(&self, change: &DVector<f64>) -> (f64, Vec<f64>) {
        let changed = &self.innovations + change;
        let h = &self.h + &self.derivatives * change;
        let back = self.factor.solve(&h);
        let gain = self.least - (changed.norm_squared() - h.dot(&back));
        (gain, back.iter().map(|step| -step).collect())
    }

    /// The sizes that gain most if the answer is linear: columns are the changes of innovations a unit.
    pub(crate) fn answer(&self, columns: &[Vec<f64>]) -> Answer {
        self.answer_from(&self.sums(columns))
    }

    /// Products of columns with all there is.
    pub(crate) fn sums(&self, columns: &[Vec<f64>]) -> Sums {
        self.sums_beside(columns, &self.derivatives * self.matrix(columns))
    }

    /// The same of several lists of columns, apart from each other.
    pub(crate) fn sums_each(&self, lists: &[Vec<Vec<f64>>]) -> Vec<Sums> {
        let onto = &self.derivatives * self.matrix(lists.iter().flatten());
        let mut first = 0;
        let own = |columns: &Vec<Vec<f64>>| {
            let onto = onto.columns(first, columns.len()).into_owned();
            first += columns.len();
            self.sums_beside(columns, onto)
        };
        lists.iter().map(own).collect()
    }

    /// The same where the products with derivatives are known.
    fn sums_beside(&self, columns: &[Vec<f64>], onto: DMatrix<f64>) -> Sums {
        Sums {
            onto,
            own: common(columns, columns),
            with_innovations: with(columns, self.innovations.as_slice()),
        }
    }

    fn matrix<'c>(&self, columns: impl IntoIterator<Item = &'c Vec<f64>>) -> DMatrix<f64> {
        let all: Vec<&[f64]> = columns.into_iter().map(Vec::as_slice).collect();
        DMatrix::from_vec(self.innovations.len(), all.len(), all.concat())
    }

    /// The sizes that gain most if the answer is linear, from products.
    pub(crate) fn answer_from(&self, sums: &Sums) -> Answer {
        self.answer_to(
            &sums.onto,
            sums.own.clone(),
            &sums.with_innovations,
            &self.h,
        )
    }

    /// What columns gain of each of some innovations that have nothing to do with them.
    pub(crate) fn by_chance(
        &self,
        columns: &[Vec<f64>],
        others: impl Iterator<Item = Vec<f64>>,
    ) -> Vec<f64> {
        let sums = self.sums(columns);
        let gain = |innovations: Vec<f64>| {
            let with_innovations = with(columns, &innovations);
            let h = &self.derivatives * DVector::from_vec(innovations);
            self.answer_to(&sums.onto, sums.own.clone(), &with_innovations, &h)
                .gain
        };
        others.map(gain).collect()
    }

    /// The same from products apart: of derivatives, of columns, and of innovations with columns.
    fn answer_to(
        &self,
        onto: &DMatrix<f64>,
        mut m: DMatrix<f64>,
        with_innovations: &DVector<f64>,
        h: &DVector<f64>,
    ) -> Answer {
        let solved = self.factor.solve(onto);
        let squares: Vec<f64> = m.diagonal().iter().copied().collect();
        m -= onto.tr_mul(&solved);
        // What parameters answer to within rounding is no column of its own.
        for (i, own) in squares.iter().enumerate() {
            m[(i, i)] += 1e-9 * own + 1e-300;
        }
        let b = solved.tr_mul(h) - with_innovations;
        let factor = Cholesky::new(m.clone());
        let best = factor.map_or_else(|| DVector::zeros(b.len()), |factor| factor.solve(&b));
        Answer {
            gain: best.dot(&b),
            sizes: best.iter().copied().collect(),
            squares,
            m,
            b,
        }
    }

    /// The sizes that gain most if answers are linear, shape by shape.
    pub(crate) fn answers(&self, products: &Products) -> Vec<Answer> {
        let (n, sizes) = (self.h.len(), products.sizes);
        let answer = |(shape, own): (usize, &DMatrix<f64>)| {
            let columns = products.with_record.columns(shape * sizes, sizes);
            let onto = columns.rows(0, n).into_owned();
            let with_innovations = columns.row(n).transpose();
            self.answer_to(&onto, own.clone(), &with_innovations, &self.h)
        };
        products
            .with_each_other
            .iter()
            .enumerate()
            .map(answer)
            .collect()
    }
}

/// Derivatives and innovations of a record as [`Products`] takes them.
fn beside(derivatives: &DMatrix<f64>, innovations: &Innovations) -> DMatrix<f64> {
    let (n, channels) = (derivatives.ncols(), innovations.channels.len());
    let rows = derivatives.nrows() / channels.max(1);
    DMatrix::from_fn(n + 1, rows * channels, |i, at| {
        let (row, channel) = (at / channels, at % channels);
        match i == n {
            true => innovations.channels[channel][row],
            false => derivatives[(channel * rows + row, i)],
        }
    })
}

/// Products of columns with innovations.
fn with(columns: &[Vec<f64>], innovations: &[f64]) -> DVector<f64> {
    let each = columns.iter().map(|column| dot(column, innovations));
    DVector::from_iterator(columns.len(), each)
}

/// Products of columns with others: a row a column, a column another.
pub(crate) fn common(columns: &[Vec<f64>], others: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(columns.len(), others.len(), |i, j| {
        dot(&columns[i], &others[j])
    })
}

/// The change of innovations by some sizes: columns are that a unit.
pub(crate) fn change<'c>(
    columns: impl IntoIterator<Item = &'c Vec<f64>>,
    sizes: &[f64],
) -> DVector<f64> {
    let each = columns.into_iter().zip(sizes);
    each.map(|(column, &size)| DVector::from_column_slice(column) * size)
        .reduce(|sum, own| sum + own)
        .unwrap_or_else(|| DVector::zeros(0))
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    // Eight sums at a time, in a fixed order.
    let mut sums = [0.0; 8];
    let (x, y) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = x
        .remainder()
        .iter()
        .zip(y.remainder())
        .map(|(a, b)| a * b)
        .sum();
    for (x, y) in x.zip(y) {
        for i in 0..8 {
            sums[i] += x[i] * y[i];
        }
    }
    sums.iter().sum::<f64>() + rest
}
