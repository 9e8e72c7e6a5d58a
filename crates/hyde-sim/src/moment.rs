//! [`Moment`]: the continuous values of the model at a time, and [`At`], the same borrowed by what reads it.

/// Values at a time.
#[derive(Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Moment {
    /// The time in s.
    pub(crate) t: f64,
    /// The solver's vector.
    pub(crate) y: Vec<f64>,
    /// Its derivative.
    pub(crate) yp: Vec<f64>,
}

/// A moment that is read: that of the run, one that a solver tries, or one beside it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At<'m> {
    pub(crate) t: f64,
    pub(crate) y: &'m [f64],
    pub(crate) yp: &'m [f64],
}

impl Moment {
    /// Room for the values of `n` unknowns at a time.
    pub(crate) fn zero(t: f64, n: usize) -> Self {
        let (y, yp) = (vec![0.0; n], vec![0.0; n]);
        Self { t, y, yp }
    }

    /// Takes the values of another one.
    pub(crate) fn copy_from(&mut self, at: At<'_>) {
        self.t = at.t;
        self.y.copy_from_slice(at.y);
        self.yp.copy_from_slice(at.yp);
    }

    /// What consistent values are solved for, into a list: the derivatives of states, the values of the others.
    pub(crate) fn read_solved(&self, differential: &[bool], into: &mut Vec<f64>) {
        into.clear();
        let pairs = self.y.iter().zip(&self.yp).zip(differential);
        into.extend(pairs.map(|((y, yp), state)| if *state { *yp } else { *y }));
    }

    /// Makes them what they were before, less a part of a correction.
    pub(crate) fn correct_solved(
        &mut self,
        differential: &[bool],
        (before, correction): (&[f64], &[f64]),
        part: f64,
    ) {
        let now = self.y.iter_mut().zip(&mut self.yp).zip(differential);
        // Both are written, for a loop without a way to choose works at several at once.
        for (((y, yp), state), (before, correction)) in now.zip(before.iter().zip(correction)) {
            let new = before - part * correction;
            (*y, *yp) = if *state { (*y, new) } else { (new, *yp) };
        }
    }

    /// Gives the algebraic variables their slopes along the flow, where these have a value.
    pub(crate) fn set_slopes(&mut self, differential: &[bool], flow: &[f64]) {
        for ((rate, &state), &slope) in self.yp.iter_mut().zip(differential).zip(flow) {
            if !state && slope.is_finite() {
                *rate = slope;
            }
        }
    }

    /// To read it.
    pub(crate) fn at(&self) -> At<'_> {
        let Self { t, y, yp } = self;
        At { t: *t, y, yp }
    }
}

impl Clone for Moment {
    fn clone(&self) -> Self {
        self.at().to_moment()
    }

    /// In the room that is there.
    fn clone_from(&mut self, other: &Self) {
        self.t = other.t;
        self.y.clone_from(&other.y);
        self.yp.clone_from(&other.yp);
    }
}

impl At<'_> {
    /// The same values at a time somewhat later.
    pub(crate) fn later(self, by_s: f64) -> Self {
        let t = self.t + by_s;
        Self { t, ..self }
    }

    /// To change it.
    pub(crate) fn to_moment(self) -> Moment {
        let (y, yp) = (self.y.to_vec(), self.yp.to_vec());
        Moment { t: self.t, y, yp }
    }
}
