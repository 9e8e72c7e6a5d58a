//! What a study found, as text of at most 80 columns, as JSON, and as pages with figures: from data to data. Nothing here
//! knows arguments or a terminal, and nothing is written here: the command line, and whoever else shows results, writes what
//! these functions return.
//!
//! It is a crate of its own between the studies and the command line. hyde-study computes and knows no layout; hyde-report
//! draws and knows no study; this crate knows both, so that text, JSON and page of a study are made of the same data.
//!
//! ```text
//! figures, asked_figures, panels, thinned   the curves of a run
//! summary, ledger, forces, start            a run as text and JSON, with its energies, its forces, its start
//! states                                    the states of a model, where its equations leave a choice
//! assumptions, assumed                      what was assumed of the data, and where a model was linearised
//! head, run_page                            the head of every page; the page of a run
//! fitted, diagnosed                         a calibration; a diagnosis
//! comparison, compared, unknown             their parts: errors, measured beside simulated, an effect of no library
//! package_pages                             the documentation of packages
//! excitation                                what to record next
//! bode                                      frequency responses and margins
//! modes, state_space                        natural frequencies; a linearised model as matrices
//! budget, selftest, trend                   shares of imperfections; what verdicts are worth; how sizes went
//! look                                      what is in traces
//! experiment_tests                          the tests of experiments
//! plot                                      columns of files as a figure
//! sweep                                     the summary of a sweep, and its page
//! lines                                     a text in lines of a width
//! ```
//! Start reading at [`summary`].

pub mod asked_figures;
pub mod assumed;
pub mod assumptions;
pub mod bode;
pub mod budget;
mod compared;
pub mod comparison;
pub mod diagnosed;
pub mod excitation;
pub mod experiment_tests;
pub mod figures;
pub mod fitted;
pub mod forces;
pub mod head;
pub mod ledger;
pub mod lines;
pub mod look;
pub mod modes;
pub mod package_pages;
pub mod panels;
pub mod plot;
pub mod run_page;
pub mod selftest;
pub mod start;
pub mod state_space;
pub mod states;
pub mod summary;
pub mod sweep;
pub mod thinned;
pub mod trend;
pub mod unknown;
