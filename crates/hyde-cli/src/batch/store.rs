//! [`Journals`]: the [`Store`] of a folder: bytes by key, durable.
//!
//! - [`Journals::open`] a folder with the identity of the study; one of another identity is refused.
//! - [`Store::has`] a key? then its task is done and need not be again.
//! - [`Store::put`] bytes for a key: when it returns they outlive the process, killed however; they outlive the machine once
//!   [`Store::sync`] has returned after it.
//! - [`Store::get`] the bytes of a key.
//!
//! The folder holds journals (see [`hyde_experiment::batch`]). Each process appends to one of its own, so any number of them
//! may work in one folder; where two did the same task the first found counts. A record that was cut off is not there. If
//! the disk is full, the journal is cut back to its last whole record, and `put` says so.

use crate::files;
use hyde_experiment::batch::{HEADER_LEN, Identity, Scanned, digest, header, record, scan};
use hyde_study::Store;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Bytes by key in a folder.
pub(crate) struct Journals {
    folder: PathBuf,
    identity: Identity,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    journals: Vec<PathBuf>,
    /// By the digest of the key, the same few bytes for each: a batch has many.
    places: BTreeMap<[u8; 16], Place>,
    /// The journal that was read last.
    opened: Option<(u32, File)>,
    own: Option<Own>,
}

/// Where the bytes of a key are.
#[derive(Clone, Copy)]
struct Place {
    at: u64,
    len: u32,
    journal: u32,
}

impl Place {
    fn new(journal: usize, at: u64, len: usize) -> Self {
        // More journals, or longer bytes, than a u32 counts are no batch of this world.
        let short = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        Self {
            at,
            len: short(len),
            journal: short(journal),
        }
    }
}

/// The journal that this process writes.
struct Own {
    file: File,
    number: usize,
    end: u64,
    dirty: bool,
}

impl Journals {
    /// Opens the store of a folder; what is missing is made when something is put in.
    pub(crate) fn open(folder: &Path, identity: Identity) -> Result<Self, String> {
        let mut state = State::default();
        for path in files::below(folder, "journal", "") {
            let number = state.journals.len();
            for_each(&path, &identity, |key, at, bytes| {
                let place = Place::new(number, at, bytes.len());
                state.places.entry(short(key)).or_insert(place);
            })?;
            state.journals.push(path);
        }
        Ok(Self {
            folder: folder.to_path_buf(),
            identity,
            state: Mutex::new(state),
        })
    }

    /// Begins this process's journal: a file that nobody else has.
    fn begin(&self, state: &mut State) -> Result<(), String> {
        files::make_folder(&self.folder)?;
        let (mut file, path) = files::make_own(&self.folder, ".journal")?;
        let header = header(&self.identity);
        let begun = file.write_all(&header).and_then(|()| file.sync_all());
        begun.map_err(|error| files::cannot_write(&path, &error))?;
        files::sync_folder(&self.folder)?;
        state.own = Some(Own {
            file,
            number: state.journals.len(),
            end: header.len() as u64,
            dirty: false,
        });
        state.journals.push(path);
        Ok(())
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Store for Journals {
    fn has(&self, key: &str) -> bool {
        self.locked().places.contains_key(&short(key))
    }

    fn count(&self) -> usize {
        self.locked().places.len()
    }

    fn put(&self, key: &str, bytes: &[u8]) -> Result<(), String> {
        let record = record(key, bytes);
        let mut state = self.locked();
        if state.places.contains_key(&short(key)) {
            return Ok(());
        }
        if state.own.is_none() {
            self.begin(&mut state)?;
        }
        let State {
            journals,
            places,
            own,
            ..
        } = &mut *state;
        let Some(own) = own else { return Ok(()) };
        if let Err(error) = own.file.write_all(&record) {
            // The part of the record that was written is taken back; if even that fails, readers stop there.
            drop(own.file.set_len(own.end));
            drop(own.file.seek(SeekFrom::Start(own.end)));
            return Err(files::cannot_write(&journals[own.number], &error));
        }
        let at = own.end + (record.len() - bytes.len()) as u64;
        own.end += record.len() as u64;
        own.dirty = true;
        places.insert(short(key), Place::new(own.number, at, bytes.len()));
        Ok(())
    }

    fn sync(&self) -> Result<usize, String> {
        let (file, path, count) = {
            let mut state = self.locked();
            let count = state.places.len();
            let State { journals, own, .. } = &mut *state;
            match own {
                Some(own) if own.dirty => {
                    own.dirty = false;
                    let path = journals[own.number].clone();
                    let file = own
                        .file
                        .try_clone()
                        .map_err(|error| files::cannot_write(&path, &error))?;
                    (file, path, count)
                }
                Some(_) | None => return Ok(count),
            }
        };
        // Others write meanwhile.
        file.sync_data()
            .map_err(|error| files::cannot_write(&path, &error))?;
        Ok(count)
    }

    fn get(&self, key: &str) -> Result<Option<Vec<u8>>, String> {
        let mut state = self.locked();
        let Some(place) = state.places.get(&short(key)).copied() else {
            return Ok(None);
        };
        let path = state.journals[place.journal as usize].clone();
        // Neighbours are mostly in one journal.
        let file = match &mut state.opened {
            Some((number, file)) if *number == place.journal => file,
            opened => &mut opened.insert((place.journal, files::open(&path)?)).1,
        };
        let mut bytes = vec![0; place.len as usize];
        file.seek(SeekFrom::Start(place.at))
            .and_then(|_| file.read_exact(&mut bytes))
            .map_err(|error| files::cannot_read(&path, &error))?;
        Ok(Some(bytes))
    }
}

/// Keys in few bytes: 128 bits of their digest, which no two share.
fn short(key: &str) -> [u8; 16] {
    let mut short = [0; 16];
    short.copy_from_slice(&digest(&[key.as_bytes()]).0[..16]);
    short
}

/// Goes through the whole records of a journal: key, place of the bytes, and the bytes.
fn for_each(
    path: &Path,
    identity: &Identity,
    mut take: impl FnMut(&str, u64, &[u8]),
) -> Result<(), String> {
    let mut file = files::open(path)?;
    let mut head = vec![0; HEADER_LEN];
    if file.read_exact(&mut head).is_err() {
        return Ok(()); // It was never begun.
    }
    if head != header(identity) {
        return Err(format!(
            "`{}` is a journal of another batch",
            path.display()
        ));
    }
    let (mut buffer, mut at) = (Vec::new(), HEADER_LEN as u64);
    // As many bytes as the record at hand has, and never less than this at once.
    let mut wanted = 1 << 16;
    loop {
        let before = buffer.len();
        let missing = (wanted as u64).saturating_sub(before as u64);
        std::io::Read::by_ref(&mut file)
            .take(missing)
            .read_to_end(&mut buffer)
            .map_err(|error| files::cannot_read(path, &error))?;
        let ended = buffer.len() == before;
        let mut used = 0;
        wanted = 1 << 16;
        loop {
            match scan(&buffer[used..]) {
                Scanned::Record { key, bytes, length } => {
                    take(key, at + (length - bytes.len()) as u64, bytes);
                    used += length;
                    at += length as u64;
                }
                Scanned::More(length) => {
                    wanted = wanted.max(length);
                    break;
                }
                Scanned::End if used == buffer.len() => break,
                Scanned::End => return Ok(()),
            }
        }
        buffer.drain(..used);
        if ended {
            return Ok(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::TempDir;

    #[test]
    fn what_was_put_in_is_there_for_the_next_process() {
        let folder = TempDir::new().unwrap();
        let open = || Journals::open(folder.path(), digest(&[b"a"])).unwrap();
        let (one, two) = (open(), open());
        one.put("b", &[2; 100_000]).unwrap();
        two.put("a", b"from two").unwrap();
        one.put("c", b"").unwrap();
        two.put("b", b"too late").unwrap();
        assert!(one.has("b") && !one.has("a"));
        assert_eq!(one.sync().unwrap(), 2);
        let again = open();
        assert_eq!(again.count(), 3);
        let get = |key| again.get(key).unwrap();
        assert_eq!(get("a"), Some(b"from two".to_vec()));
        assert_eq!(get("c"), Some(Vec::new()));
        assert_eq!(get("d"), None);
        // Whichever journal comes first by name: bytes of one task are the same, as tasks are pure.
        let either = [vec![2; 100_000], b"too late".to_vec()];
        assert!(either.contains(&get("b").unwrap()));
    }

    #[test]
    fn a_record_that_was_cut_off_is_not_there_and_hides_none_before() {
        let folder = TempDir::new().unwrap();
        let identity = digest(&[b"a"]);
        let store = Journals::open(folder.path(), identity).unwrap();
        for key in ["a", "b", "c"] {
            store.put(key, key.as_bytes()).unwrap();
        }
        drop(store);
        let journal = files::below(folder.path(), "journal", "").remove(0);
        let whole = std::fs::metadata(&journal).unwrap().len();
        let one = (whole - HEADER_LEN as u64) / 3;
        for cut in 0..whole {
            let scratch = TempDir::new().unwrap();
            let copy = scratch.path().join("x.journal");
            std::fs::copy(&journal, &copy).unwrap();
            std::fs::OpenOptions::new()
                .write(true)
                .open(&copy)
                .unwrap()
                .set_len(cut)
                .unwrap();
            let store = Journals::open(scratch.path(), identity).unwrap();
            let expected = cut.saturating_sub(HEADER_LEN as u64) / one;
            assert_eq!(store.count() as u64, expected, "cut at {cut}");
        }
    }

    #[test]
    fn another_batch_is_refused() {
        let folder = TempDir::new().unwrap();
        Journals::open(folder.path(), digest(&[b"a"]))
            .unwrap()
            .put("k", b"v")
            .unwrap();
        let error = Journals::open(folder.path(), digest(&[b"b"]))
            .err()
            .unwrap();
        assert!(error.contains("another batch"), "{error}");
    }
}
