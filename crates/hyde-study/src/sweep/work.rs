//! Solves what is missing of a batch, on all cores. A case is written to the journal by the thread that solved it, at once;
//! a thread of its own brings what is written to the disk, while others solve.

use super::prepare::Prepared;
use crate::progress::Progress;
use crate::store::Store;
use hyde_experiment::Options;
use hyde_experiment::batch::{Outcome, solve};
use rayon::iter::{
    IndexedParallelIterator as _, IntoParallelRefIterator as _, ParallelIterator as _,
};
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Time between two writes to the disk: what the fall of the machine, not of the process, may lose.
const SYNC: Duration = Duration::from_millis(50);
/// Time between two lines of progress.
const TELL: Duration = Duration::from_millis(500);

/// How work is done.
pub struct How<'p> {
    /// Cases solved at once; 0 is one a core.
    pub jobs: usize,
    /// Set by whoever wants it to end early.
    pub interrupted: Arc<AtomicBool>,
    /// Hears how far it is.
    pub progress: &'p dyn Progress,
}

/// What work took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Took {
    /// Cases solved.
    pub solved: usize,
    /// On the clock.
    pub wall: Duration,
    /// In the solutions, of all threads together.
    pub solving: Duration,
}

/// Why work ended before its end.
pub enum Ended {
    /// It was told to.
    Interrupted,
    /// A result could not be kept.
    Store(String),
}

/// Solves the cases of a range that the store does not have.
///
/// # Errors
/// It was interrupted, or a result could not be kept.
#[allow(
    clippy::disallowed_methods,
    reason = "the time that a batch took is printed, and is not part of its data set"
)]
pub fn solve_missing(
    batch: &Prepared,
    store: &dyn Store,
    range: RangeInclusive<usize>,
    how: &How<'_>,
) -> Result<Took, Ended> {
    let total = range.clone().count();
    let missing: Vec<usize> = range
        .filter(|&case| !store.has(&Prepared::key(case)))
        .collect();
    if missing.is_empty() {
        return Ok(Took::default());
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(how.jobs)
        .build()
        .map_err(|error| Ended::Store(error.to_string()))?;
    let others = store.count() - (total - missing.len());
    let progress = how.progress;
    progress.begin(total, total - missing.len());
    let (start, solving) = (Instant::now(), AtomicU64::new(0));
    let (finished, done) = channel::<()>();
    let outcome = std::thread::scope(|scope| {
        let syncing = scope.spawn(|| {
            let done = done;
            let mut told = Instant::now();
            loop {
                let more = done.recv_timeout(SYNC) == Err(RecvTimeoutError::Timeout);
                let count = store.sync()?;
                if told.elapsed() >= TELL || !more {
                    progress.at(count.saturating_sub(others));
                    told = Instant::now();
                }
                if !more {
                    return Ok(());
                }
            }
        });
        let solved = pool.install(|| {
            missing.par_iter().with_max_len(1).try_for_each(|&case| {
                let began = Instant::now();
                let outcome = solved(batch, case, how).ok_or(Ended::Interrupted)?;
                let nanoseconds = u64::try_from(began.elapsed().as_nanos()).unwrap_or(u64::MAX);
                solving.fetch_add(nanoseconds, Ordering::Relaxed);
                if outcome.fault.is_some() {
                    progress.failed();
                }
                store
                    .put(&Prepared::key(case), &outcome.encode())
                    .map_err(Ended::Store)
            })
        });
        drop(finished);
        let synced: Result<(), String> = match syncing.join() {
            Ok(synced) => synced,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        solved.and(synced.map_err(Ended::Store))
    });
    progress.finish();
    outcome.map(|()| Took {
        solved: missing.len(),
        wall: start.elapsed(),
        solving: Duration::from_nanos(solving.into_inner()),
    })
}

/// Solves one case; `None` if it was interrupted. A case that fails has an outcome like others.
fn solved(batch: &Prepared, case: usize, how: &How<'_>) -> Option<Outcome> {
    if how.interrupted.load(Ordering::Relaxed) {
        return None;
    }
    let source = batch.source();
    let case = batch.plan.case(case);
    let outcome = batch
        .variants
        .with(&source, &batch.plan, &case, |ready, wanted| {
            let mut set = batch.project.set();
            set.extend(batch.plan.settings(&case));
            let options = Options {
                set,
                interrupted: Arc::clone(&how.interrupted),
                ..Options::default()
            };
            match solve(&ready.program, &ready.tables, &options, wanted) {
                Ok(outcome) => Some(outcome),
                Err(error) => source.failed(&error, &ready.program).map(Outcome::failed),
            }
        });
    outcome.unwrap_or_else(|fault| Some(Outcome::failed(fault)))
}
