//! Fields on a mesh: linear finite elements on equal cells.
//!
//! A domain of n cells has the nodes 0..n. A field that is a state lies at the nodes, a flux (a field whose value
//! contains `pder`) in the middle of the cells, cell j between nodes j-1 and j:
//!
//! ```text
//! field Torque q on bar = G*Ip*pder(th, x);      for j in 1..n:   q[j] = G*Ip*((th[j] - th[j-1])/h)
//! rho*Ip*der(w) = pder(q, x) indomain bar        for k in 1..n-1: M[k] = (q[k+1] - q[k])/h
//!                                                k = 0:           M[0] = (q[1] - q.left)/(h/2)
//!                                                k = n:           M[n] = (q.right - q[n])/(h/2)
//! ```
//!
//! with the end fluxes `q.left` and `q.right` as two more unknowns for the model's boundary equations (F2). M is what
//! stands beside the fluxes. `fv` takes it at the node. `fem` weights it by the mean of the consistent and the lumped
//! mass matrix, 1/12, 10/12, 1/12 (5/6, 1/6 at an end), which raises the order of the frequencies from two to four
//! (Goudreau and Taylor, Comp. Meth. Appl. Mech. Eng. 2, 1973); both conserve energy. `load(x, F)` adds F with the
//! same weights with which `field.at(x)` reads (F4): see `point`.

mod equation;
mod integral;
mod kernel;
mod mesh;
mod point;
mod resolution;
mod trace;
mod value;
