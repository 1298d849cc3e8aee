//! A zip read within a budget: its names checked, its bytes counted, its entries found even if its
//! table of contents is lost. Floor 5. The other files of this folder interpret the entries.
//! Nothing is ever unpacked to the disk.

use crate::{Budget, Files, files};
use crate::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Read};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use zip::ZipArchive;
use zip::read::read_zipfile_from_stream;

/// The signature of local file headers.
const LOCAL_HEADER: [u8; 4] = *b"PK\x03\x04";

/// The entries of a zip in memory.
pub struct Archive<'a> {
    /// For messages.
    file: PathBuf,
    bytes: &'a [u8],
    zip: Option<ZipArchive<Cursor<&'a [u8]>>>,
    /// By the table of contents.
    listed: BTreeMap<String, usize>,
    /// Positions of entries by their own headers, used where the table of contents fails.
    found: BTreeMap<String, usize>,
    /// Bytes that may still be read; entries of a few bytes can expand to any number.
    left: AtomicU64,
}

impl<'a> Archive<'a> {
    /// Whether a file is a zip, by its first bytes.
    pub fn is_zip(bytes: &[u8]) -> bool {
        bytes.starts_with(&LOCAL_HEADER)
    }

    /// Reads the table of contents, and the headers before the entries.
    ///
    /// Fails where a name could lead out of the document's folder, where two entries could be taken
    /// for each other, where there are more entries than the budget allows, and where there is no
    /// entry at all.
    pub fn open(file: &Path, bytes: &'a [u8], budget: &Budget) -> Result<Self> {
        // The zip reader is third-party code: a panic in it counts as a damaged file.
        let opened = catch_unwind(AssertUnwindSafe(|| ZipArchive::new(Cursor::new(bytes))));
        let zip = opened.ok().and_then(std::result::Result::ok);
        let found = match zip {
            // Headers without sizes: what looks like a header within the entries may be anything.
            Some(_) if is_streamed(bytes) => BTreeMap::new(),
            _ => scan(file, bytes, budget)?,
        };
        let listed =
            zip.as_ref().map(|zip| list(file, zip, budget)).transpose()?.unwrap_or_default();
        if listed.is_empty() && found.is_empty() {
            return Err(Error::decode(file, "the zip file holds nothing"));
        }
        let left = AtomicU64::new(budget.unpacked_bytes);
        Ok(Self { file: file.into(), bytes, zip, listed, found, left })
    }

    /// Whether the table of contents is lost or incomplete.
    pub fn is_damaged(&self) -> bool {
        self.found.keys().any(|name| !self.listed.contains_key(name))
    }

    /// Every name, whether or not the entry can be read.
    pub fn names(&self) -> BTreeSet<&str> {
        self.listed.keys().chain(self.found.keys()).map(String::as_str).collect()
    }

    /// Whether there is an entry of this name.
    pub fn has_entry(&self, name: &str) -> bool {
        self.listed.contains_key(name) || self.found.contains_key(name)
    }

    /// An entry's bytes; its checksum holds.
    pub fn bytes(&self, name: &str, most: u64) -> Result<Vec<u8>> {
        if !self.has_entry(name) {
            let missing = std::io::Error::new(
                std::io::ErrorKind::NotFound,
                "there is no such entry in the file",
            );
            return Err(Error::io(self.path(name), missing));
        }
        let by_table = || {
            let index = self.listed.get(name)?;
            let mut zip = self.zip.clone()?;
            let entry = zip.by_index(*index).map_err(std::io::Error::other);
            Some(entry.and_then(|entry| self.all(entry, most)))
        };
        let by_header = || {
            let mut from = self.bytes.get(*self.found.get(name)?..)?;
            match read_zipfile_from_stream(&mut from) {
                Ok(Some(entry)) => Some(self.all(entry, most)),
                Ok(None) => None,
                Err(e) => Some(Err(std::io::Error::other(e))),
            }
        };
        let read = catch_unwind(AssertUnwindSafe(|| match by_table() {
            Some(Ok(bytes)) => Some(Ok(bytes)),
            failed => by_header().filter(std::result::Result::is_ok).or(failed),
        }));
        match read {
            Ok(Some(Ok(Some(bytes)))) => Ok(bytes),
            Ok(Some(Ok(None))) => Err(Error::too_large(
                self.path(name),
                format!("the entry has more than {most} bytes"),
            )),
            Ok(Some(Err(e))) => {
                Err(Error::decode(self.path(name), format!("the entry cannot be unpacked ({e})")))
            }
            Ok(None) | Err(_) => Err(Error::decode(self.path(name), "the entry is damaged")),
        }
    }

    /// The first bytes of an entry, unpacked no further; its checksum is not checked. `None` if
    /// there are none.
    pub fn beginning(&self, name: &str, most: usize) -> Option<Vec<u8>> {
        let first = |entry: &mut dyn Read| {
            let mut bytes = Vec::new();
            // An entry that is cut off or damaged farther on still has a beginning.
            let _ = entry.take(most as u64).read_to_end(&mut bytes);
            (!bytes.is_empty()).then_some(bytes)
        };
        let by_table = || first(&mut self.zip.clone()?.by_index(*self.listed.get(name)?).ok()?);
        let by_header = || {
            let mut from = self.bytes.get(*self.found.get(name)?..)?;
            first(&mut read_zipfile_from_stream(&mut from).ok()??)
        };
        catch_unwind(AssertUnwindSafe(|| by_table().or_else(by_header))).ok().flatten()
    }

    /// All of an entry; `None` where it has more than `most` bytes, or more than the whole file may
    /// still have.
    fn all(&self, entry: impl Read, most: u64) -> std::io::Result<Option<Vec<u8>>> {
        let most = most.min(self.left.load(Ordering::Relaxed));
        let mut bytes = Vec::new();
        entry.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
        let read = bytes.len() as u64;
        // Two threads may both use the remaining bytes; each entry alone stays within its own
        // limit.
        let less = |left: u64| Some(left.saturating_sub(read));
        let _ = self.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less);
        Ok((read <= most).then_some(bytes))
    }
}

impl Files for Archive<'_> {
    fn read(&self, name: &str, budget: &Budget) -> Result<Vec<u8>> {
        self.bytes(name, budget.file_bytes)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.file.join(name)
    }
}

/// Why an entry may not have this name. A colon names no drive here, and Krita calls folders by the
/// names of pictures.
fn refusal(name: &str) -> Option<&'static str> {
    files::refusal(&name.replace(':', "_"))
}

/// The table of contents.
fn list(
    file: &Path,
    zip: &ZipArchive<Cursor<&[u8]>>,
    budget: &Budget,
) -> Result<BTreeMap<String, usize>> {
    if zip.has_duplicate_names() {
        return Err(Error::decode(file, "two entries of the zip file have the same name"));
    }
    if zip.len() > budget.entries {
        let reason =
            format!("the zip file has {} entries; {} are allowed", zip.len(), budget.entries);
        return Err(Error::too_large(file, reason));
    }
    let (mut listed, mut folded) = (BTreeMap::new(), BTreeSet::new());
    for index in 0..zip.len() {
        let Ok(entry) = zip.by_index_data(index) else { continue };
        if entry.is_dir() {
            continue;
        }
        let name = entry
            .name()
            .map_err(|_| Error::decode(file, "the name of an entry is not UTF-8"))?
            .into_owned();
        if let Some(reason) = refusal(&name) {
            return Err(Error::unsupported_file(
                file,
                format!("the entry “{name}” is refused: {reason}"),
            ));
        }
        if entry.is_symlink() {
            return Err(Error::unsupported_file(file, format!("the entry “{name}” is a link")));
        }
        if !folded.insert(name.to_lowercase()) {
            return Err(Error::decode(
                file,
                format!("two entries are called “{name}”, apart from capitals"),
            ));
        }
        listed.insert(name, index);
    }
    Ok(listed)
}

/// Where entries begin, by the headers before them; the first of several of one name.
fn scan(file: &Path, bytes: &[u8], budget: &Budget) -> Result<BTreeMap<String, usize>> {
    let mut found = BTreeMap::new();
    let mut at = 0;
    while let Some(next) =
        bytes.get(at..).and_then(|rest| rest.windows(4).position(|w| w == LOCAL_HEADER))
    {
        at += next;
        let Some((name, length)) = header(&bytes[at..]) else {
            at += 1;
            continue;
        };
        if refusal(&name).is_none() && !name.ends_with('/') {
            found.entry(name).or_insert(at);
        }
        if found.len() > budget.entries {
            return Err(Error::too_large(
                file,
                format!("the zip file has more than {} entries", budget.entries),
            ));
        }
        at += length;
    }
    Ok(found)
}

/// Whether the first header leaves the entry's size to a later record.
fn is_streamed(bytes: &[u8]) -> bool {
    bytes.get(6).is_some_and(|flags| flags & 8 != 0)
}

/// The name in a local header, and how long the header and the entry are together; `None` where
/// that cannot be.
fn header(bytes: &[u8]) -> Option<(String, usize)> {
    let short =
        |at: usize| Some(usize::from(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?)));
    let long =
        |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    let (size, name_length, extra) = (long(18)?, short(26)?, short(28)?);
    let name = std::str::from_utf8(bytes.get(30..30 + name_length)?).ok()?;
    let end = (30 + name_length + extra).checked_add(size)?;
    // An entry cut short by the end of the file may still be partly readable; its reader decides.
    Some((name.to_owned(), end.min(bytes.len())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::packer::ZipPacker;

    fn packed() -> Vec<u8> {
        let mut packer = ZipPacker::default();
        packer.store("mimetype", b"image/openraster").unwrap();
        packer.deflate("a/text", &[7; 5000]).unwrap();
        packer.finish().unwrap()
    }

    fn open(bytes: &[u8]) -> Result<Archive<'_>> {
        Archive::open(Path::new("a.ora"), bytes, &Budget::default())
    }

    #[test]
    fn entries_are_read_by_name() {
        let bytes = packed();
        let archive = open(&bytes).unwrap();
        assert_eq!(archive.bytes("mimetype", 100).unwrap(), b"image/openraster");
        assert_eq!(archive.bytes("a/text", 5000).unwrap(), [7; 5000]);
        assert!(!archive.is_damaged());
        assert!(
            archive.bytes("a/text", 4999).unwrap_err().to_string().contains("more than 4999 bytes")
        );
        assert!(archive.bytes("b", 100).unwrap_err().to_string().contains("no such entry"));
        assert_eq!(archive.beginning("a/text", 3), Some(vec![7; 3]));
        assert_eq!(archive.beginning("b", 3), None);
    }

    #[test]
    fn entries_are_found_without_the_table_of_contents() {
        let mut bytes = packed();
        let table = bytes.windows(4).position(|w| w == b"PK\x01\x02").unwrap();
        bytes.truncate(table);
        let archive = open(&bytes).unwrap();
        assert!(archive.is_damaged());
        assert_eq!(archive.bytes("a/text", 5000).unwrap(), [7; 5000]);
        assert_eq!(archive.beginning("a/text", 3), Some(vec![7; 3]));
    }

    #[test]
    fn all_entries_together_stay_within_the_budget() {
        let bytes = packed();
        let budget = Budget { unpacked_bytes: 5010, ..Budget::default() };
        let archive = Archive::open(Path::new("a.ora"), &bytes, &budget).unwrap();
        assert!(archive.bytes("a/text", 9000).is_ok());
        assert!(archive.bytes("mimetype", 9000).is_err());
    }

    #[test]
    fn names_that_lead_out_and_twins_are_refused() {
        for (names, part) in [
            (["../a", "b"], "contains “..”"),
            (["/a", "b"], "absolute"),
            (["a", "A"], "apart from capitals"),
        ] {
            let mut packer = ZipPacker::default();
            names.iter().for_each(|name| packer.store(name, b"x").unwrap());
            let bytes = packer.finish().unwrap();
            let said = open(&bytes).err().unwrap().to_string();
            assert!(said.contains(part), "{said}");
        }
    }

    #[test]
    fn more_entries_than_allowed_are_refused() {
        let bytes = packed();
        let budget = Budget { entries: 1, ..Budget::default() };
        let said = Archive::open(Path::new("a.ora"), &bytes, &budget).err().unwrap().to_string();
        assert!(said.contains("entries"), "{said}");
    }
}
