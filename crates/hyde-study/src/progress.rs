//! [`Progress`]: how far a study of many tasks is, for whoever shows it.

/// Hears how far a study is. It may be called from several threads.
pub trait Progress: Sync {
    /// Work begins on so many tasks, of which so many were finished before.
    fn begin(&self, total: usize, before: usize);

    /// A task failed.
    fn failed(&self);

    /// So many tasks are finished, those of before among them.
    fn at(&self, done: usize);

    /// Work ended.
    fn finish(&self);
}
