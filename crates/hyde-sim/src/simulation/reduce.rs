//! What of a run becomes one number: each stretch of the solution, and both sides of each instant.

use super::Simulation;
use hyde_program::Function;

impl Simulation<'_> {
    /// Takes in a stretch of the last step.
    pub(super) fn reduce_stretch(&mut self, from: f64, to: f64) {
        let Some((mut reductions, kernel)) = self.reductions.take() else {
            return;
        };
        let n = self.program.n_unknowns;
        let (mut y, mut yp) = (vec![0.0; n], vec![0.0; n]);
        reductions.stretch(from, to, &mut |t, out| {
            self.integrator.interpolate(t, &mut y, &mut yp);
            let state = self.integrator.state_mut();
            self.consistent.refine(state, t, &mut y, &mut yp);
            state.evaluate_rows(&*kernel, (t, &y, &yp), out);
        });
        self.reductions = Some((reductions, kernel));
        self.name_what_is_not_a_number();
    }

    /// Takes in the values now: one side of an instant.
    pub(super) fn reduce_instant(&mut self) {
        let Some((reductions, kernel)) = &mut self.reductions else {
            return;
        };
        let mut values = vec![0.0; reductions.outputs().len()];
        let integrator = &mut self.integrator;
        let (t, y, yp) = (integrator.t, integrator.y.clone(), integrator.yp.clone());
        let state = integrator.state_mut();
        state.evaluate_rows(&**kernel, (t, &y, &yp), &mut values);
        reductions.point(t, &values);
        self.name_what_is_not_a_number();
    }

    /// Finds the variable that is not a number: one that the reduction is written with, else the first of all.
    fn name_what_is_not_a_number(&mut self) {
        let Some((reductions, _)) = &self.reductions else {
            return;
        };
        for (number, t) in reductions.nameless() {
            let n = self.program.n_unknowns;
            let (mut y, mut yp) = (vec![0.0; n], vec![0.0; n]);
            self.integrator.interpolate(t, &mut y, &mut yp);
            let mut values = vec![0.0; self.program.outputs.len()];
            let state = self.integrator.state_mut();
            state.evaluate(Function::Outputs, t, &y, &yp, &mut values);
            let text = &self.setup.reductions[number].text;
            let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']');
            let outputs = self.program.outputs.iter().zip(&values);
            let bad = outputs.filter(|(output, value)| value.is_nan() && !output.auxiliary);
            let bad: Vec<&str> = bad.map(|(output, _)| output.name.as_str()).collect();
            let mut words = text.split(|c| !is_name(c));
            let written = words.find(|word| bad.contains(word));
            let name = written.or(bad.first().copied()).unwrap_or(text).to_owned();
            if let Some((reductions, _)) = &mut self.reductions {
                reductions.name(number, name);
            }
        }
    }
}
