//! Solvers run beside each other and move between threads.

use std::thread;

use hyde_ida::LinearMethod;

use crate::robertson::{compare, solver};

#[test]
fn many_at_once_give_what_one_gives() {
    thread::scope(|scope| {
        for round in 0..8 {
            let method = if round % 2 == 0 {
                LinearMethod::Dense
            } else {
                LinearMethod::Klu
            };
            scope.spawn(move || compare(solver(method), method));
        }
    });
}

#[test]
fn a_solver_made_here_runs_there() {
    let solver = solver(LinearMethod::Klu);
    thread::spawn(move || compare(solver, LinearMethod::Klu))
        .join()
        .unwrap();
}
