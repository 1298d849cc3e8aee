//! Selections that a Photoshop file keeps: channels beyond the colors of the merged picture, with
//! their names. Floor 5. Not here: the channels themselves (`merged`, `write`).

use super::cursor::{ByteCursor, shown_text};
use super::header::resource;
use crate::document::{Document, NamedSelection};
use crate::paint::Selection;
use crate::raster::CoverageGrid;
use std::collections::HashSet;
use std::sync::Arc;

/// Names of the channels beyond the colors, with 8 and 16 bits per letter; the identifier of each;
/// how each is shown.
const NAMES: u16 = 1006;
const UNICODE_NAMES: u16 = 1045;
pub const NUMBERS: u16 = 1053;
const SHOWN: u16 = 1077;
const SHOWN_BEFORE: u16 = 1007;
/// Where channels are kept, one of these says something of them.
pub const ABOUT: [u16; 5] = [NAMES, UNICODE_NAMES, NUMBERS, SHOWN, SHOWN_BEFORE];
/// The name of the transparency among them.
const TRANSPARENCY: &str = "Transparency";
/// Channels that a file may have besides its colors and their transparency.
const MOST: usize = 56 - 4;

/// The selections of a document that a file keeps for other programs, in their order.
pub fn of_document(document: &Document) -> Vec<NamedSelection> {
    let canvas = document.size.rect();
    let within = |kept: &NamedSelection| NamedSelection {
        name: kept.name.clone(),
        selection: Arc::new(Selection::new(kept.selection.coverage.within(canvas))),
    };
    document
        .selections
        .iter()
        .map(within)
        .filter(|kept| !kept.selection.is_empty())
        .take(MOST)
        .collect()
}

/// The resources that name them: their numbers and data. Empty if there are none.
pub fn resources(kept: &[NamedSelection]) -> Vec<(u16, Vec<u8>)> {
    if kept.is_empty() {
        return Vec::new();
    }
    let names: Vec<&str> =
        std::iter::once(TRANSPARENCY).chain(kept.iter().map(|kept| &*kept.name)).collect();
    let (mut short, mut long) = (Vec::new(), Vec::new());
    for name in &names {
        let plain = name
            .chars()
            .take(255)
            .map(|c| if c.is_ascii() && !c.is_control() { c as u8 } else { b'?' });
        let plain: Vec<u8> = plain.collect();
        short.push(plain.len() as u8);
        short.extend(plain);
        let units: Vec<u16> = name.encode_utf16().collect();
        long.extend((units.len() as u32).to_be_bytes());
        long.extend(units.iter().flat_map(|unit| unit.to_be_bytes()));
    }
    // The transparency has the number 0.
    let numbers = (0..names.len() as u32).flat_map(u32::to_be_bytes).collect();
    vec![(NAMES, short), (UNICODE_NAMES, long), (NUMBERS, numbers)]
}

/// The channels beyond colors and transparency as selections, and how many of them are inks
/// instead.
pub fn selections(
    channels: Vec<CoverageGrid>,
    has_alpha: bool,
    resources: ByteCursor,
) -> (Vec<NamedSelection>, usize) {
    let names = names(resources, has_alpha, channels.len());
    let inks = inks(resources, channels.len());
    let mut known = HashSet::new();
    let mut kept = Vec::new();
    for (i, coverage) in channels.into_iter().enumerate().filter(|(i, _)| !inks.contains(i)) {
        let given = names.get(i).filter(|name| !name.is_empty()).cloned();
        let given = given.unwrap_or_else(|| format!("Alpha {}", i + 1));
        let given: String = given.chars().take(NamedSelection::LONGEST_NAME - 4).collect();
        let numbered = (2..).map(|n| format!("{given} {n}"));
        let name = std::iter::once(given.clone())
            .chain(numbered)
            .find(|name| !known.contains(name))
            .unwrap_or(given);
        if !coverage.is_empty() {
            known.insert(name.clone());
            kept.push(NamedSelection { name, selection: Arc::new(Selection::new(coverage)) });
        }
    }
    (kept, inks.len())
}

fn names(resources: ByteCursor, has_alpha: bool, count: usize) -> Vec<String> {
    let long = resource(resources, UNICODE_NAMES).map(|data| {
        let mut data = ByteCursor::new(data);
        std::iter::from_fn(|| data.unicode()).take(64).collect::<Vec<_>>()
    });
    let short = || {
        let mut data = ByteCursor::new(resource(resources, NAMES).unwrap_or_default());
        let text = |bytes: &[u8]| shown_text(&String::from_utf8_lossy(bytes));
        std::iter::from_fn(|| data.pascal(1).map(text)).take(64).collect()
    };
    let mut names: Vec<String> = long.unwrap_or_else(short);
    // Some programs name the transparency too.
    if has_alpha && (names.len() > count || names.first().is_some_and(|name| name == TRANSPARENCY))
    {
        names.remove(0);
    }
    names
}

/// Which of the channels are inks of their own.
fn inks(resources: ByteCursor, count: usize) -> HashSet<usize> {
    /// Offset of the kind among the bytes of a channel, and the kind of inks.
    const KIND: usize = 12;
    const INK: u8 = 2;
    let newer = resource(resources, SHOWN).and_then(|data| Some((data.get(4..)?, 13)));
    let Some((data, bytes)) = newer.or(resource(resources, SHOWN_BEFORE).map(|data| (data, 14)))
    else {
        return HashSet::new();
    };
    let kinds: Vec<u8> = data.chunks_exact(bytes).map(|channel| channel[KIND]).collect();
    // These are the last ones, whether or not the transparency precedes them.
    let before = kinds.len().saturating_sub(count);
    kinds[before..].iter().enumerate().filter(|(_, kind)| **kind == INK).map(|(i, _)| i).collect()
}
