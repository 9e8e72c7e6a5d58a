//! [`ResidualPartials`]: the derivatives of the residual where they were taken last, and whether they are those of here.
//!
//! Those of an affine residual follow from the memory and the parameters. As long as neither changes they are not taken again,
//! and as long as they are the same, so are the matrices made of them and the factors of these.

/// Values of the residual's derivatives, before they are put in their places.
#[derive(Default)]
pub(crate) struct ResidualPartials {
    values: Vec<f64>,
    /// The memory and the parameters that they follow from, if they follow from these alone.
    of: Option<(Vec<f64>, Vec<f64>)>,
    /// How often values were others than before.
    changes: u64,
    room: Vec<f64>,
}

impl ResidualPartials {
    pub(crate) fn zeros(n: usize) -> Self {
        Self {
            values: vec![0.0; n],
            room: vec![0.0; n],
            ..Self::default()
        }
    }

    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// How often they have changed. Of values that follow from memory and parameters alone.
    pub(crate) fn changes(&self) -> u64 {
        self.changes
    }

    /// Whether the values follow from this memory and these parameters alone.
    pub(crate) fn are_of(&self, memory: &[f64], parameters: &[f64]) -> bool {
        let of = self.of.as_ref();
        of.is_some_and(|(z, p)| same(z, memory) && same(p, parameters))
    }

    /// Room for new values, to be given to [`ResidualPartials::take`].
    pub(crate) fn room(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.room)
    }

    /// Takes new values, with the memory and the parameters that they follow from, if they follow from these alone.
    pub(crate) fn take(&mut self, values: Vec<f64>, of: Option<(&[f64], &[f64])>) {
        self.room = std::mem::replace(&mut self.values, values);
        let Some((memory, parameters)) = of else {
            self.of = None;
            self.changes += 1;
            return;
        };
        self.changes += u64::from(!same(&self.room, &self.values));
        let (z, p) = self.of.get_or_insert_default();
        z.clear();
        z.extend_from_slice(memory);
        if !same(p, parameters) {
            p.clear();
            p.extend_from_slice(parameters);
        }
    }
}

/// Whether values are the same to the last bit.
fn same(one: &[f64], other: &[f64]) -> bool {
    // To the end: without a way out the loop compares several at a time.
    let pairs = one.iter().zip(other);
    one.len() == other.len() && pairs.fold(true, |same, (a, b)| same & (a.to_bits() == b.to_bits()))
}
