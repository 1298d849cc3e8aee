//! GIMP's image hoses: two lines of text, then brushes one after the other.
//! Floor 5.

use super::gbr::{self, GbrBrush};
use super::{ImportedBrush, TipNames, text_of};
use crate::Budget;
use crate::paint::tip::{Hose, HoseRank, RankSelect};
use crate::psd::cursor::ByteCursor;
use crate::{Error, Result};
use std::path::Path;

/// More pictures than any hose was seen to have.
const MOST: usize = 1024;
/// GIMP's own ceiling.
const MOST_RANKS: usize = 4;

/// The pictures of a hose and how one is chosen.
pub struct GihHose {
    pub name: String,
    pub cells: Vec<GbrBrush>,
    pub ranks: Vec<HoseRank>,
    /// Sentences about a rule that has no counterpart here.
    pub notes: Vec<String>,
}

pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ImportedBrush> {
    let GihHose { name, cells, ranks, notes } = read_cells(file, bytes, budget)?;
    let spacing = cells.first().map_or(0.0, |cell| cell.spacing);
    let mut tips = TipNames::default();
    let numbered = (1..).zip(cells);
    let pictures =
        numbered.map(|(i, cell)| tips.add(file, cell.picture, &format!("{name} {i}"))).collect();
    Ok(ImportedBrush { notes, ..ImportedBrush::hose(name, Hose::new(pictures, ranks), spacing) })
}

/// Reads the text and every picture; at least one.
pub fn read_cells(file: &Path, bytes: &[u8], budget: &Budget) -> Result<GihHose> {
    let mut lines = bytes.splitn(3, |b| *b == b'\n');
    let (name, description) = (lines.next().unwrap_or_default(), lines.next().unwrap_or_default());
    let (name, description) = (text_of(name), text_of(description));
    let mut words = description.split_whitespace();
    let count = words.next().and_then(|n| n.parse::<usize>().ok()).filter(|n| *n > 0);
    let count = count.ok_or_else(|| {
        Error::decode(file, "its second line does not say how many pictures it holds")
    })?;
    if count > MOST {
        return Err(Error::too_large(file, format!("{count} pictures; a hose may have {MOST}")));
    }
    let mut cursor = ByteCursor::new(lines.next().unwrap_or_default());
    let (mut cells, mut used) = (Vec::new(), 0);
    for i in 0..count {
        // Some hoses hold fewer than they say.
        if i > 0 && cursor.rest().is_empty() {
            break;
        }
        let cell = gbr::next(file, &mut cursor, budget)?;
        used += cell.picture.size.area() as u64;
        if used > budget.area_px {
            let reason = format!("its pictures hold more than {} pixels together", budget.area_px);
            return Err(Error::too_large(file, reason));
        }
        cells.push(cell);
    }
    let mut notes = Vec::new();
    if cells.len() < count {
        notes.push(format!("it holds {} of the {count} pictures that it announces", cells.len()));
    }
    let ranks = ranks(words, cells.len(), &mut notes);
    Ok(GihHose { name, cells, ranks, notes })
}

/// `rank0:4 sel0:angular rank1:2 sel1:random …`; without usable words the pictures are used in
/// order.
fn ranks<'a>(
    words: impl Iterator<Item = &'a str>,
    count: usize,
    notes: &mut Vec<String>,
) -> Vec<HoseRank> {
    let mut ranks = [HoseRank { count: 0, select: RankSelect::Incremental }; MOST_RANKS];
    for (key, value) in words.filter_map(|word| word.split_once(':')) {
        let place = |key: &str, stem: &str| {
            key.strip_prefix(stem)?.parse::<usize>().ok().filter(|i| *i < MOST_RANKS)
        };
        if let Some(i) = place(key, "rank") {
            ranks[i].count = value.parse().unwrap_or(0);
        } else if let Some(i) = place(key, "sel") {
            ranks[i].select = RankSelect::from_name(value).unwrap_or_else(|| {
                notes.push(format!("Pictures chosen by “{value}” are chosen one after the other"));
                RankSelect::Incremental
            });
        }
    }
    let ranks: Vec<HoseRank> = ranks.into_iter().filter(|rank| rank.count > 0).collect();
    let product = ranks.iter().try_fold(1usize, |n, rank| n.checked_mul(rank.count as usize));
    if ranks.is_empty() || product.is_none_or(|n| n > count) {
        if !ranks.is_empty() {
            notes.push(
                "Its ranks need more pictures than it holds; the pictures are used in turn".into(),
            );
        }
        return vec![HoseRank { count: count as u32, select: RankSelect::Incremental }];
    }
    ranks
}
