//! A calibration: what its records determine, values with intervals, errors before and after, profiles.

pub mod identified;
pub mod json;
pub mod page;
pub mod plots;
pub mod text;

use hyde_study::fitted::{
    Fitted, Weight, experiment_name, named, shown, shown_difference, si_unit, unit,
};
