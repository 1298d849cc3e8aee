//! The recovery log as bytes: checksummed records, of which the longest valid prefix counts.
//! Floor 5.

use std::io::{BufRead, BufReader, Read};

/// The signature of a log.
pub const MAGIC: [u8; 8] = *b"RILOG\0\0\x01";
/// Length, kind and checksum before each payload.
const HEADER: usize = 4 + 1 + 4;

/// What a record holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum RecordKind {
    /// JSON: whose drawing it is.
    Head = 1,
    /// Eight bytes of key, then bytes that states refer to by it.
    Blob = 2,
    /// JSON: the whole document after an edit, its large parts by their keys.
    State = 3,
    /// JSON: at this point the document equals its file, or is as it was created; nothing would be
    /// lost.
    Saved = 4,
}

impl RecordKind {
    fn from_byte(byte: u8) -> Option<Self> {
        [RecordKind::Head, RecordKind::Blob, RecordKind::State, RecordKind::Saved]
            .into_iter()
            .find(|kind| *kind as u8 == byte)
    }
}

/// Appends a record: its length, kind, checksum of kind and payload, payload.
///
/// A payload is shorter than 4 GiB; a longer one is not written, and the result is `false`.
#[must_use]
pub fn push(log: &mut Vec<u8>, kind: RecordKind, payload: &[&[u8]]) -> bool {
    let Ok(length) = u32::try_from(payload.iter().map(|part| part.len()).sum::<usize>()) else {
        return false;
    };
    log.extend(length.to_le_bytes());
    log.push(kind as u8);
    let mut crc = crc32fast::Hasher::new();
    crc.update(&[kind as u8]);
    payload.iter().for_each(|part| crc.update(part));
    log.extend(crc.finalize().to_le_bytes());
    payload.iter().for_each(|part| log.extend(*part));
    true
}

/// The records of a log up to the first invalid one.
pub struct Records<'a> {
    rest: &'a [u8],
}

/// Whether the bytes begin like a log decides whether there are any records.
pub fn records(log: &[u8]) -> Records<'_> {
    Records { rest: log.strip_prefix(&MAGIC).unwrap_or_default() }
}

impl<'a> Iterator for Records<'a> {
    type Item = (RecordKind, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let (header, rest) = self.rest.split_at_checked(HEADER)?;
        let length = u32::from_le_bytes(header[..4].try_into().ok()?);
        let kind = RecordKind::from_byte(header[4])?;
        let crc = u32::from_le_bytes(header[5..9].try_into().ok()?);
        let (payload, rest) = rest.split_at_checked(usize::try_from(length).ok()?)?;
        let mut found = crc32fast::Hasher::new();
        found.update(&[kind as u8]);
        found.update(payload);
        if found.finalize() != crc {
            self.rest = &[];
            return None;
        }
        self.rest = rest;
        Some((kind, payload))
    }
}

/// The end of a log, if all of it is valid: the kind of its last record, and the contents of the
/// last [`RecordKind::Saved`].
///
/// Reads piece by piece: a broken log may be long.
pub fn end(log: &mut dyn Read) -> Option<(RecordKind, Option<Vec<u8>>)> {
    let mut log = BufReader::with_capacity(1 << 16, log);
    let mut magic = [0; MAGIC.len()];
    log.read_exact(&mut magic).ok().filter(|()| magic == MAGIC)?;
    let (mut last, mut saved) = (None, None);
    loop {
        let mut header = [0; HEADER];
        match log.fill_buf() {
            Ok([]) => return last.map(|kind| (kind, saved)),
            _ => log.read_exact(&mut header).ok()?,
        }
        let kind = RecordKind::from_byte(header[4])?;
        let length = u32::from_le_bytes(header[..4].try_into().ok()?);
        let (mut found, mut kept) = (crc32fast::Hasher::new(), Vec::new());
        found.update(&[kind as u8]);
        let mut payload = log.by_ref().take(length.into());
        loop {
            let piece = payload.fill_buf().ok()?;
            if piece.is_empty() {
                break;
            }
            found.update(piece);
            if kind == RecordKind::Saved && kept.len() < SAVED_BYTES {
                kept.extend_from_slice(piece);
            }
            let n = piece.len();
            payload.consume(n);
        }
        if payload.limit() > 0 || found.finalize().to_le_bytes() != header[5..9] {
            return None;
        }
        last = Some(kind);
        saved = if kind == RecordKind::Saved { Some(kept) } else { saved };
    }
}

/// A record of kind [`RecordKind::Saved`] holds a name and a few figures.
const SAVED_BYTES: usize = 1 << 16;

#[cfg(test)]
mod tests {
    use super::*;

    fn log() -> Vec<u8> {
        let mut log = MAGIC.to_vec();
        assert!(push(&mut log, RecordKind::Head, &[b"{}"]));
        assert!(push(&mut log, RecordKind::Blob, &[&7u64.to_le_bytes(), b"pixels"]));
        assert!(push(&mut log, RecordKind::State, &[b""]));
        log
    }

    #[test]
    fn records_come_back_in_their_order() {
        let log = log();
        let kinds: Vec<RecordKind> = records(&log).map(|(kind, _)| kind).collect();
        assert_eq!(kinds, [RecordKind::Head, RecordKind::Blob, RecordKind::State]);
        assert_eq!(records(&log).nth(1).unwrap().1[8..], *b"pixels");
    }

    #[test]
    fn the_end_is_known_only_of_a_log_that_is_whole() {
        let mut log = log();
        assert_eq!(end(&mut &log[..]), Some((RecordKind::State, None)));
        assert!(push(&mut log, RecordKind::Saved, &[b"{}"]));
        assert_eq!(end(&mut &log[..]), Some((RecordKind::Saved, Some(b"{}".to_vec()))));
        for n in 0..log.len() {
            let seen = end(&mut &log[..n]);
            assert!(
                seen.is_none_or(|(kind, saved)| kind != RecordKind::Saved && saved.is_none()),
                "cut at {n}"
            );
        }
        for bit in 0..log.len() * 8 {
            let mut broken = log.clone();
            broken[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(end(&mut &broken[..]), None, "bit {bit}");
        }
    }

    #[test]
    fn a_log_cut_anywhere_or_with_any_bit_flipped_gives_a_prefix() {
        let whole = log();
        let all: Vec<_> = records(&whole).collect();
        let is_prefix =
            |bytes: &[u8]| records(bytes).zip(&all).all(|(found, known)| found == *known);
        for end in 0..whole.len() {
            assert!(is_prefix(&whole[..end]) && records(&whole[..end]).count() < all.len());
        }
        for bit in 0..whole.len() * 8 {
            let mut broken = whole.clone();
            broken[bit / 8] ^= 1 << (bit % 8);
            assert!(is_prefix(&broken) && records(&broken).count() < all.len(), "bit {bit}");
        }
    }
}
