//! Tests across crates: every example through every stage and on both backends, and small models with a closed form.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]

mod arrays;
mod backends;
mod bar;
mod bouncing_ball;
mod candidates;
mod chosen_states;
mod clocks;
mod closed_form;
mod clutch;
mod delays;
mod derivatives;
mod digests;
mod effects;
mod energy;
mod event_suite;
mod examples;
mod experiments;
mod first_order;
mod gradients;
mod ledger;
mod limit_cycle;
mod loops;
mod models;
mod multirate;
mod paper;
mod points;
mod reactions;
mod rectifier;
mod sampled;
mod stages;
mod starts;
mod stick_slip;
mod travelling_nut;
mod whole_arrays;
mod without_states;
