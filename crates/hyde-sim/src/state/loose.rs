//! Relations that are followed instead of located: beyond the end of a branch, and near a zero where their truth changes
//! nothing.
//!
//! The `abs(x)` in `sqrt(abs(x))` is x as long as x > 0; a trial step to x < 0, which finds that x crosses, has no root. There
//! the equations are those of the other branch.
//!
//! `sign(p - 10)*sqrt(abs(p - 10))` is 0 at p = 10 with either sign, and upright: a moment beyond, the branch that was left
//! drives p away from its zero, the one that is entered drives it back, and each crossing would lead to the next. Until its
//! root function has left what the tolerance of the run knows far behind, such a relation is evaluated with the equations, as
//! below `noEvent`.

use super::State;
use crate::moment::At;
use crate::zero;
use hyde_program::{Function, Point, RelationUse, Workspace};

impl State<'_> {
    /// Follows relations from here on.
    pub(crate) fn follow(&mut self, relations: &[usize], at: At<'_>) {
        let far = zero::followed(self, at);
        for &relation in relations {
            if !self.is_loose(relation) {
                self.loose.push((relation, far[relation]));
            }
        }
    }

    /// Whether a relation is followed.
    pub(crate) fn is_loose(&self, relation: usize) -> bool {
        self.loose.iter().any(|(loose, _)| *loose == relation)
    }

    /// Relations that are far from their zeros are located again; their truths stay what they are here.
    pub(crate) fn follow_no_longer(&mut self, at: At<'_>) {
        if self.loose.is_empty() {
            return;
        }
        self.read_loose(at);
        let roots = self.values(Function::Roots, at);
        self.loose
            .retain(|(relation, far)| roots[*relation].abs() <= *far);
    }

    /// The values of a function that has none with the memory as it is: those behind the end of a branch, if it has any there.
    #[cold]
    pub(crate) fn evaluate_beyond(&mut self, function: Function, at: At<'_>, out: &mut [f64]) {
        let program = self.program;
        match function {
            Function::Residual => self.with_own_truths(at, |state| {
                let (point, workspace) = state.point(at);
                program.kernels.evaluate(function, point, workspace, out);
            }),
            Function::Outputs => self.replace_not_finite(at, out, |point, workspace, own| {
                program.kernels.evaluate(function, point, workspace, own);
            }),
            Function::Roots
            | Function::Assignments
            | Function::Initial
            | Function::Delayed
            | Function::Angles => {}
        }
    }

    /// Where there is no finite value, that with the truths which relations have at the point itself.
    pub(crate) fn replace_not_finite(
        &mut self,
        at: At<'_>,
        out: &mut [f64],
        evaluate: impl FnOnce(Point<'_>, &mut Workspace, &mut [f64]),
    ) {
        let mut own = out.to_vec();
        self.with_own_truths(at, |state| {
            let (point, workspace) = state.point(at);
            evaluate(point, workspace, &mut own);
        });
        for (value, own) in out.iter_mut().zip(own) {
            if !value.is_finite() {
                *value = own;
            }
        }
    }

    /// Evaluates with the truths that relations of equations have at a point, as they are behind the end of a branch.
    pub(crate) fn with_own_truths(&mut self, at: At<'_>, evaluate: impl FnOnce(&mut Self)) {
        let before = self.z.clone();
        let of_equations = |&number: &usize| {
            let relation = &self.program.relations[number];
            relation.used == RelationUse::Equation && !relation.scheduled
        };
        let relations: Vec<usize> = (0..self.program.relations.len())
            .filter(of_equations)
            .collect();
        if relations.is_empty() {
            return;
        }
        self.read_truths(at, &relations);
        evaluate(self);
        self.z = before;
    }

    /// Takes the truths of followed relations from a point.
    #[inline]
    pub(crate) fn read_loose(&mut self, at: At<'_>) {
        if !self.loose.is_empty() {
            let loose: Vec<usize> = self.loose.iter().map(|(relation, _)| *relation).collect();
            self.read_truths(at, &loose);
        }
    }

    fn read_truths(&mut self, at: At<'_>, relations: &[usize]) {
        let program = self.program;
        let mut roots = vec![0.0; program.relations.len()];
        let (point, workspace) = self.point(at);
        let kernels = &program.kernels;
        kernels.evaluate(Function::Roots, point, workspace, &mut roots);
        for &relation in relations {
            let truth = program.relations[relation].truth(roots[relation]);
            self.z[relation] = f64::from(u8::from(truth));
        }
    }
}
