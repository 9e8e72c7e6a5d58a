//! [`Store`]: where a long study keeps its finished tasks, as bytes by key.

/// Bytes by key that outlive the process. Tasks are pure: two that write the same key write the same bytes.
pub trait Store: Sync {
    /// Whether a key has bytes: then its task is finished.
    fn has(&self, key: &str) -> bool;

    /// How many keys have bytes.
    fn count(&self) -> usize;

    /// Puts bytes in; a key that has some keeps them. On return they outlive the process, however it ends.
    ///
    /// # Errors
    /// They cannot be kept, and why.
    fn put(&self, key: &str, bytes: &[u8]) -> Result<(), String>;

    /// Waits until all that was put in before outlives the machine too, and gives the number of keys of then.
    ///
    /// # Errors
    /// It cannot be kept, and why.
    fn sync(&self) -> Result<usize, String>;

    /// The bytes of a key, if it has some.
    ///
    /// # Errors
    /// They cannot be read, and why.
    fn get(&self, key: &str) -> Result<Option<Vec<u8>>, String>;
}
