//! The journal of a store: records of key and bytes, one behind the other, each with a checksum.
//!
//! ```text
//! header   "hyde journal 1\n" and the identity, 32 bytes
//! record   length of the key (4 bytes), length of the bytes (8), checksum (16), key, bytes
//! ```
//! A journal has one writer, who only appends. So what follows a record that is cut off or damaged was never finished: a
//! reader stops there.

use super::identity::{Identity, digest};

const MAGIC: &[u8; 15] = b"hyde journal 1\n";
const LENGTHS: usize = 12;
const CHECKSUM: usize = 16;

/// The length of a header.
pub const HEADER_LEN: usize = MAGIC.len() + 32;

/// The header of a journal of the batch of that identity.
#[must_use]
pub fn header(identity: &Identity) -> Vec<u8> {
    [&MAGIC[..], &identity.0[..]].concat()
}

/// A record.
#[must_use]
pub fn record(key: &str, bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(LENGTHS + CHECKSUM + key.len() + bytes.len());
    out.extend_from_slice(&u32::try_from(key.len()).unwrap_or(u32::MAX).to_le_bytes());
    out.extend_from_slice(&(bytes.len() as u64).to_le_bytes());
    let sum = checksum(&out, key.as_bytes(), bytes);
    out.extend_from_slice(&sum);
    out.extend_from_slice(key.as_bytes());
    out.extend_from_slice(bytes);
    out
}

/// What is found at a place of a journal.
#[derive(Debug, PartialEq, Eq)]
pub enum Scanned<'b> {
    /// A record, and where the next one begins.
    Record {
        /// Its key.
        key: &'b str,
        /// Its bytes.
        bytes: &'b [u8],
        /// Its length altogether.
        length: usize,
    },
    /// The record goes on for at least so many bytes altogether.
    More(usize),
    /// The end, or what was never finished.
    End,
}

/// The record that `bytes` begins with.
#[must_use]
pub fn scan(bytes: &[u8]) -> Scanned<'_> {
    let start = LENGTHS + CHECKSUM;
    let Some((lengths, rest)) = bytes.split_first_chunk::<LENGTHS>() else {
        return if bytes.is_empty() {
            Scanned::End
        } else {
            Scanned::More(start)
        };
    };
    let [k0, k1, k2, k3, b0, b1, b2, b3, b4, b5, b6, b7] = *lengths;
    let key_len = u32::from_le_bytes([k0, k1, k2, k3]) as usize;
    let Some(length) = usize::try_from(u64::from_le_bytes([b0, b1, b2, b3, b4, b5, b6, b7]))
        .ok()
        .and_then(|length| length.checked_add(key_len)?.checked_add(start))
    else {
        return Scanned::End;
    };
    if bytes.len() < length {
        return Scanned::More(length);
    }
    let (sum, rest) = rest.split_at(CHECKSUM);
    let (key, rest) = rest.split_at(key_len);
    let content = &rest[..length - start - key_len];
    match std::str::from_utf8(key) {
        Ok(text) if sum == checksum(lengths, key, content) => Scanned::Record {
            key: text,
            bytes: content,
            length,
        },
        Ok(_) | Err(_) => Scanned::End,
    }
}

fn checksum(lengths: &[u8], key: &[u8], bytes: &[u8]) -> [u8; CHECKSUM] {
    let whole = digest(&[lengths, key, bytes]).0;
    let mut sum = [0; CHECKSUM];
    sum.copy_from_slice(&whole[..CHECKSUM]);
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_come_back_one_behind_the_other() {
        let bytes = [
            record("a", b"one"),
            record("", b""),
            record("größe", &[0; 1000]),
        ]
        .concat();
        let (mut at, mut found) = (0, Vec::new());
        while let Scanned::Record { key, bytes, length } = scan(&bytes[at..]) {
            found.push((key.to_owned(), bytes.len()));
            at += length;
        }
        assert_eq!(
            found,
            [
                ("a".to_owned(), 3),
                (String::new(), 0),
                ("größe".to_owned(), 1000)
            ]
        );
        assert_eq!(scan(&bytes[at..]), Scanned::End);
    }

    #[test]
    fn what_is_cut_off_or_damaged_is_no_record() {
        let whole = record("key", b"some bytes");
        for end in 1..whole.len() {
            assert!(
                matches!(scan(&whole[..end]), Scanned::More(more) if more > end),
                "cut at {end}"
            );
        }
        for at in 0..whole.len() {
            let mut broken = whole.clone();
            broken[at] ^= 0x40;
            assert!(
                !matches!(scan(&broken), Scanned::Record { .. }),
                "bit at {at}"
            );
        }
    }
}
