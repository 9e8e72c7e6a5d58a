//! The parameters that initial equations are to find, and how they are given new values in a run.

use super::State;

/// The places of the parameters that initial equations are to find.
pub(crate) fn places_to_find(state: &State<'_>) -> Vec<usize> {
    let parameters = state.program.parameters.iter();
    let to_find = parameters.filter(|parameter| parameter.found);
    to_find.flat_map(|p| p.place..p.place + p.len).collect()
}

impl State<'_> {
    /// Gives parameters that are to be found new values, and all that follow from them.
    pub(crate) fn set_parameters(&mut self, values: &[(usize, f64)]) {
        if values.is_empty() {
            return;
        }
        let to_find = places_to_find(self);
        let mut set = self.parameters_said(&to_find);
        let value = |&place: &usize| {
            let new = values.iter().find(|(other, _)| *other == place);
            (place, new.map_or(self.p[place], |(_, value)| *value))
        };
        set.extend(to_find.iter().map(value));
        let kernels = &self.program.kernels;
        kernels.parameters(&set, &mut self.p);
    }

    /// The values of all parameters that do not follow from those to be found; known from the first call on.
    fn parameters_said(&mut self, to_find: &[usize]) -> Vec<(usize, f64)> {
        if let Some(said) = &self.said {
            return said.clone();
        }
        let kernels = &self.program.kernels;
        let filled = |set: &[(usize, f64)]| {
            let mut p = vec![0.0; self.p.len()];
            kernels.parameters(set, &mut p);
            p
        };
        let as_they_are: Vec<(usize, f64)> = to_find.iter().map(|&p| (p, self.p[p])).collect();
        let other = |&(place, value): &(usize, f64)| (place, 1.1 * value + 0.1);
        let others: Vec<(usize, f64)> = as_they_are.iter().map(other).collect();
        let (one, two) = (filled(&as_they_are), filled(&others));
        let plain = self.program.parameters.iter();
        let (follow, mut said): (Vec<usize>, Vec<usize>) = plain
            .flat_map(|p| p.place..p.place + p.len)
            .filter(|place| !to_find.contains(place))
            .partition(|&place| one[place].to_bits() != two[place].to_bits());
        let with_values = |places: &[usize]| -> Vec<(usize, f64)> {
            places.iter().map(|&place| (place, self.p[place])).collect()
        };
        // What follows by its declaration may have been set to something else.
        let again = filled(&[with_values(&said), as_they_are].concat());
        let set = follow.into_iter();
        said.extend(set.filter(|&place| again[place].to_bits() != self.p[place].to_bits()));
        let said = with_values(&said);
        self.said = Some(said.clone());
        said
    }
}
