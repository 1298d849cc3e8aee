//! The first directory of a TIFF or BigTIFF: where its entries are, and the file with a replaced
//! directory. Floor 5. Not here: what entries mean (`tiff`); the `tiff` crate reads their values.

/// A directory and how its file writes numbers.
pub struct Directory {
    is_little: bool,
    is_big: bool,
    /// Where each entry begins.
    entries: Vec<usize>,
}

/// Entries that are looked at.
const MOST_ENTRIES: usize = 4096;
/// Numbers of 16, 32 and 64 bits.
const SHORT: u16 = 3;
const LONG: u16 = 4;
const LONG8: u16 = 16;

impl Directory {
    /// `None` where the file is cut short.
    pub fn first(bytes: &[u8]) -> Option<Self> {
        let is_little = bytes.starts_with(b"II");
        let empty = Self { is_little, is_big: false, entries: Vec::new() };
        let is_big = empty.number(bytes, 2, 2)? == 43;
        let it = Self { is_big, ..empty };
        let address = it.number(bytes, it.address_at(), it.address_bytes())?;
        let first = usize::try_from(address).ok()?;
        let count =
            usize::try_from(it.number(bytes, first, it.count_bytes())?).ok()?.min(MOST_ENTRIES);
        let start = first.checked_add(it.count_bytes())?;
        let entries: Vec<usize> =
            (0..count).map(|i| start.saturating_add(i * it.entry_bytes())).collect();
        let is_there =
            |at: &usize| at.checked_add(it.entry_bytes()).is_some_and(|end| end <= bytes.len());
        Some(Self { entries: entries.into_iter().take_while(is_there).collect(), ..it })
    }

    /// Where the value of a tag is.
    pub fn place(&self, bytes: &[u8], tag: u16) -> Option<usize> {
        let found =
            self.entries.iter().find(|at| self.number(bytes, **at, 2) == Some(tag.into()))?;
        Some(found + self.entry_bytes() - self.address_bytes())
    }

    /// A number of the file.
    pub fn number(&self, bytes: &[u8], at: usize, length: usize) -> Option<u64> {
        let digits = bytes.get(at..at.checked_add(length)?)?.iter();
        let push = |sum: u64, digit: &u8| sum << 8 | u64::from(*digit);
        Some(if self.is_little { digits.rev().fold(0, push) } else { digits.fold(0, push) })
    }

    pub fn digits(&self, value: u64, length: usize) -> Vec<u8> {
        let mut digits = value.to_le_bytes()[..length].to_vec();
        if !self.is_little {
            digits.reverse();
        }
        digits
    }

    /// The file with some pieces in place of its own.
    ///
    /// * `tags`: those of the pieces' starts and lengths.
    /// * `short`: other tags that become one number of 16 bits each; `None` leaves one out.
    pub fn with_pieces(
        &self,
        bytes: &[u8],
        pieces: &[Vec<u8>],
        tags: [u16; 2],
        short: &[(u16, Option<u16>)],
    ) -> Vec<u8> {
        let mut out = bytes.to_vec();
        let mut starts = Vec::new();
        for piece in pieces {
            starts.push(out.len() as u64);
            out.extend(piece);
        }
        let lengths: Vec<u64> = pieces.iter().map(|piece| piece.len() as u64).collect();
        let [starts, lengths] = [starts, lengths].map(|list| self.list(&mut out, &list));
        let mut rows: Vec<(u64, Vec<u8>)> = Vec::new();
        for &at in &self.entries {
            let Some(tag) = self.number(bytes, at, 2) else { continue };
            let is_other = |other: u16| tag != u64::from(other);
            if tags.into_iter().chain(short.iter().map(|row| row.0)).all(is_other) {
                rows.push((tag, bytes[at..at + self.entry_bytes()].to_vec()));
            }
        }
        let kind = if self.is_big { LONG8 } else { LONG };
        rows.push((tags[0].into(), self.entry(tags[0], kind, pieces.len(), starts)));
        rows.push((tags[1].into(), self.entry(tags[1], kind, pieces.len(), lengths)));
        for &(tag, value) in short {
            if let Some(value) = value {
                rows.push((tag.into(), self.entry(tag, SHORT, 1, self.digits(value.into(), 2))));
            }
        }
        rows.sort_by_key(|row| row.0);
        let at = out.len() as u64;
        out.extend(self.digits(rows.len() as u64, self.count_bytes()));
        out.extend(rows.into_iter().flat_map(|row| row.1));
        out.extend(self.digits(0, self.address_bytes()));
        let header = self.address_at()..self.address_at() + self.address_bytes();
        if let Some(place) = out.get_mut(header) {
            place.copy_from_slice(&self.digits(at, self.address_bytes()));
        }
        out
    }

    /// Addresses as the value of an entry: a single one itself, several by the place where they
    /// were written.
    fn list(&self, out: &mut Vec<u8>, values: &[u64]) -> Vec<u8> {
        let all: Vec<u8> =
            values.iter().flat_map(|v| self.digits(*v, self.address_bytes())).collect();
        if values.len() == 1 {
            return all;
        }
        let at = out.len() as u64;
        out.extend(all);
        self.digits(at, self.address_bytes())
    }

    fn entry(&self, tag: u16, kind: u16, count: usize, mut value: Vec<u8>) -> Vec<u8> {
        value.resize(self.address_bytes(), 0);
        let head = [self.digits(tag.into(), 2), self.digits(kind.into(), 2)].concat();
        [head, self.digits(count as u64, self.address_bytes()), value].concat()
    }

    fn address_at(&self) -> usize {
        self.address_bytes()
    }

    fn address_bytes(&self) -> usize {
        if self.is_big { 8 } else { 4 }
    }

    fn count_bytes(&self) -> usize {
        if self.is_big { 8 } else { 2 }
    }

    fn entry_bytes(&self) -> usize {
        if self.is_big { 20 } else { 12 }
    }
}
