//! The library in every FMU of Hyde: the functions of FMI 3.0 and 2.0 in C, over [`hyde_fmi::Instance`]. It is the same for every
//! model; what it runs is in the folder of resources that an importer names.
//!
//! ```text
//! handle         what a pointer of an importer stands for: instance, log          handle.rs
//! memory         slices and texts of an importer                                  memory.rs
//! models         compiled models, shared by the instances of a process            models.rs
//! states         saved states of instances                                        states.rs
//! fmi_3_0        FMI 3.0: life, steps, events, states; values; what is not there   fmi_3_0.rs, fmi_3_0/
//! fmi_2_0        the same for FMI 2.0                                              fmi_2_0.rs, fmi_2_0/
//! ```
//! This crate alone exports symbols of C and dereferences pointers of others. Every function is checked against its type in the
//! headers of the standard, and catches what panics.
#![allow(
    unsafe_code,
    reason = "an importer hands over pointers: this is the boundary"
)]
#![allow(
    non_snake_case,
    reason = "the functions have the names of the standard"
)]

mod export;
mod fmi_2_0;
mod fmi_3_0;
mod handle;
mod memory;
mod models;
mod states;
