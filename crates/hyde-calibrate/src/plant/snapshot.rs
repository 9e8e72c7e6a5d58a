//! [`Snapshot`]: a plant at a row, to come back to.

use super::driven::Plant;

/// A plant at a row, before the row has begun.
pub(crate) struct Snapshot {
    y: Vec<f64>,
    yp: Vec<f64>,
    z: Vec<f64>,
    u: Vec<f64>,
    pub(crate) row: usize,
    index: usize,
    level: usize,
    current: usize,
    pinned: Vec<(usize, f64)>,
    watched: Vec<usize>,
    conditions: Vec<bool>,
}

impl Snapshot {
    pub(crate) fn of(plant: &Plant<'_>) -> Self {
        Self {
            y: plant.y.clone(),
            yp: plant.yp.clone(),
            z: plant.z.clone(),
            u: plant.u.clone(),
            row: plant.row,
            index: plant.index,
            level: plant.level,
            current: plant.current,
            pinned: plant.pinned.clone(),
            watched: plant.watched.clone(),
            conditions: plant.conditions.clone(),
        }
    }

    pub(crate) fn restore(&self, plant: &mut Plant<'_>) {
        plant.y.clone_from(&self.y);
        plant.yp.clone_from(&self.yp);
        plant.z.clone_from(&self.z);
        plant.u.clone_from(&self.u);
        (plant.row, plant.index, plant.level) = (self.row, self.index, self.level);
        plant.current = self.current;
        plant.pinned.clone_from(&self.pinned);
        plant.watched.clone_from(&self.watched);
        plant.conditions.clone_from(&self.conditions);
    }
}
