//! [`Goal`]: how much a fit is to gain for it to be gone on with.

use super::solution::Solution;

/// What a fit is to gain over another solution. A rival of a better fit ends where it falls behind: the steps that it has left would
/// not reach the goal, each as good as the last.
#[derive(Clone, Copy)]
pub(crate) struct Goal<'s> {
    pub(crate) over: &'s Solution,
    pub(crate) gain: f64,
}

impl Goal<'_> {
    /// Whether a solution reaches it.
    pub(crate) fn is_reached_by(&self, solution: &Solution) -> bool {
        solution.gain_over(self.over) >= self.gain
    }

    /// Whether so many more steps that gain as much as the last do not reach it, from a solution as
    /// [`Solution::gained_by`] takes it.
    pub(super) fn is_out_of_reach(&self, here: (f64, f64, f64), gained: f64, steps: usize) -> bool {
        self.over.gained_by(here) + gained * (steps as f64) < self.gain
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    fn solution(data: f64) -> Solution {
        Solution {
            values: Vec::new(),
            data,
            priors: 0.0,
            weight: 1.0,
            innovations: Vec::new(),
            curvature: (DMatrix::zeros(0, 0), DMatrix::zeros(0, 0)),
            scatter: (DMatrix::zeros(0, 0), 0),
            wider: Vec::new(),
            steps: 0,
            converged: false,
        }
    }

    #[test]
    fn a_goal_is_out_of_reach_where_the_steps_left_do_not_come_to_it() {
        let declared = solution(1000.0);
        let goal = Goal {
            over: &declared,
            gain: 900.0,
        };
        assert!(goal.is_reached_by(&solution(100.0)) && !goal.is_reached_by(&solution(101.0)));
        // 400 gained so far; 500 are missing, which ten steps of 50 gain and ten of 49 do not.
        assert!(!goal.is_out_of_reach((600.0, 0.0, 1.0), 50.0, 10));
        assert!(goal.is_out_of_reach((600.0, 0.0, 1.0), 49.0, 10));
    }
}
