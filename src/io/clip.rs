//! The picture that a Clip Studio drawing (`.clip`) holds of itself: a PNG in a row of the SQLite
//! database that is one of the file's chunks. Floor 5. Not here: its layers.

use std::ops::Range;

const MAGIC: &[u8] = b"CSFCHUNK";
const DATABASE: &[u8] = b"CHNKSQLi";
const SQLITE: &[u8] = b"SQLite format 3\0";
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// A page that holds rows of a table.
const LEAF: u8 = 13;

/// Whether a file begins like one of Clip Studio.
pub fn is_clip(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// The largest PNG in the rows of the database; `None` where there is none.
pub fn preview(bytes: &[u8]) -> Option<Vec<u8>> {
    let database = Database::find_in(bytes)?;
    let (mut largest, mut gathered): (Option<Vec<u8>>, usize) = (None, 0);
    for page in 0..database.pages() {
        for cell in database.cells(page) {
            let Some(row) = database.row(cell) else { continue };
            // Rows that lie over each other would be read again and again.
            gathered += row.len();
            if gathered > 4 * database.bytes.len() {
                return largest;
            }
            let picture = row.windows(PNG.len()).position(|part| part == PNG);
            let picture = picture.map(|at| row[at..].to_vec());
            let is_larger = |png: &Vec<u8>| png.len() > largest.as_ref().map_or(0, Vec::len);
            if let Some(picture) = picture.filter(is_larger) {
                largest = Some(picture);
            }
        }
    }
    largest
}

/// An SQLite database, read without its schema.
struct Database<'a> {
    bytes: &'a [u8],
    page_bytes: usize,
    /// Bytes of a page that hold anything.
    used: usize,
}

impl<'a> Database<'a> {
    fn find_in(file: &'a [u8]) -> Option<Self> {
        let mut at = 24usize;
        let chunk = loop {
            let head = file.get(at..at.checked_add(16)?)?;
            let length = usize::try_from(u64::from_be_bytes(*head[8..].first_chunk()?)).ok()?;
            let end = at.checked_add(16)?.checked_add(length)?;
            if head.starts_with(DATABASE) {
                break file.get(at + 16..end.min(file.len()))?;
            }
            at = end;
        };
        let bytes = chunk.get(chunk.windows(SQLITE.len()).position(|part| part == SQLITE)?..)?;
        let page_bytes = match u16::from_be_bytes(*bytes.get(16..)?.first_chunk()?) {
            1 => 65536,
            size => usize::from(size),
        };
        let used = page_bytes.checked_sub(usize::from(*bytes.get(20)?))?;
        (page_bytes >= 512 && used >= 480).then_some(Self { bytes, page_bytes, used })
    }

    fn pages(&self) -> usize {
        self.bytes.len() / self.page_bytes
    }

    /// Where the rows of a page begin, each up to the page's end.
    fn cells(&self, page: usize) -> Vec<Range<usize>> {
        let start = page * self.page_bytes;
        let head = start + if page == 0 { 100 } else { 0 };
        let number = |at: usize| {
            let pair = self.bytes.get(at..)?.first_chunk()?;
            Some(usize::from(u16::from_be_bytes(*pair)))
        };
        if self.bytes.get(head) != Some(&LEAF) {
            return Vec::new();
        }
        let count = number(head + 3).unwrap_or(0).min(self.page_bytes / 2);
        let places = (0..count).filter_map(|i| number(head + 8 + 2 * i));
        let end = start + self.used;
        places.filter(|at| *at < self.used).map(|at| start + at..end).collect()
    }

    /// The whole of a row whose beginning holds a PNG's signature, from the pages it goes on in.
    fn row(&self, cell: Range<usize>) -> Option<Vec<u8>> {
        let cell = self.bytes.get(cell)?;
        let (length, first) = varint(cell)?;
        let (_, second) = varint(&cell[first..])?;
        let cell = &cell[first + second..];
        let length = usize::try_from(length).ok()?;
        let (most, least) = (self.used - 35, (self.used - 12) * 32 / 255 - 23);
        if length <= most {
            return cell.get(..length).filter(|row| has_png(row)).map(<[u8]>::to_vec);
        }
        let fitting = least + length.checked_sub(least)? % (self.used - 4);
        let local = if fitting <= most { fitting } else { least };
        let mut row = cell.get(..local).filter(|row| has_png(row))?.to_vec();
        let mut next = u32::from_be_bytes(*cell.get(local..)?.first_chunk()?) as usize;
        while row.len() < length && row.len() < self.bytes.len() {
            let start = next.checked_sub(1)?.checked_mul(self.page_bytes)?;
            let page = self.bytes.get(start..start.checked_add(self.used)?)?;
            next = u32::from_be_bytes(*page.first_chunk()?) as usize;
            row.extend(&page[4..page.len().min(4 + length - row.len())]);
        }
        (row.len() == length).then_some(row)
    }
}

fn has_png(row: &[u8]) -> bool {
    row.windows(PNG.len()).any(|part| part == PNG)
}

/// A number of up to nine bytes of which the highest bit says that more follow, and its length.
fn varint(bytes: &[u8]) -> Option<(u64, usize)> {
    let mut value = 0;
    for (i, &byte) in bytes.iter().take(9).enumerate() {
        if i == 8 {
            return Some((value << 8 | u64::from(byte), 9));
        }
        value = value << 7 | u64::from(byte & 127);
        if byte < 128 {
            return Some((value, i + 1));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A database of pages of 512 bytes: a row with a PNG that goes on in two more pages.
    fn clip(png: &[u8]) -> Vec<u8> {
        let payload = [&[3, 1, 0][..], &[7, 7], png].concat();
        let mut pages = vec![0u8; 512 * 4];
        pages[..16].copy_from_slice(SQLITE);
        pages[16..18].copy_from_slice(&512u16.to_be_bytes());
        let least = (512 - 12) * 32 / 255 - 23;
        let fitting = least + (payload.len() - least) % 508;
        let local = if fitting <= 512 - 35 { fitting } else { least };
        let length = payload.len();
        let cell = [&[128 | (length >> 7) as u8, (length & 127) as u8, 1][..], &payload[..local]];
        let cell = [&cell.concat()[..], &3u32.to_be_bytes()].concat();
        let page = &mut pages[512..1024];
        (page[0], page[4]) = (LEAF, 1);
        let at = 512 - cell.len();
        page[8..10].copy_from_slice(&(at as u16).to_be_bytes());
        page[at..].copy_from_slice(&cell);
        // The next pages are the fourth and the third, counted from 1.
        let mut rest = &payload[local..];
        for (page, next) in [(2, 4u32), (3, 0)] {
            let part = rest.len().min(508);
            pages[page * 512..page * 512 + 4].copy_from_slice(&next.to_be_bytes());
            pages[page * 512 + 4..page * 512 + 4 + part].copy_from_slice(&rest[..part]);
            rest = &rest[part..];
        }
        let chunk =
            |name: &[u8], data: &[u8]| [name, &(data.len() as u64).to_be_bytes(), data].concat();
        let head = [MAGIC, &0u64.to_be_bytes(), &24u64.to_be_bytes()].concat();
        [head, chunk(b"CHNKHead", &[0; 40]), chunk(DATABASE, &pages)].concat()
    }

    #[test]
    fn the_picture_is_gathered_from_the_pages_of_the_database() {
        let png = [PNG, &(0..900u32).map(|i| (i * 7 % 251) as u8).collect::<Vec<_>>()].concat();
        let bytes = clip(&png);
        assert!(is_clip(&bytes) && preview(&bytes) == Some(png));
        for length in 0..bytes.len() {
            let _ = preview(&bytes[..length]);
        }
    }
}
