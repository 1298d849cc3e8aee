//! Reads a Photoshop file: its own document if it is ours as it was written, otherwise its layers, in
//! the way that looks most like the file's own picture. Floor 5.

use super::colors::Mode;
use super::compare::{check_against_merged, is_shown_otherwise};
use super::ink_layers::{self, InkView, fitting_bytes};
use super::marks;
use super::merged::Merged;
use super::parse::{ParsedPsd, RecordView, parse, parse_as};
use super::profiled::{self, show_in_srgb};
use super::restore::restore;
use super::tree::build_document;
use crate::Budget;
use crate::document::{Document, Guides};
use crate::project::ProjectContents;
use crate::{Remedy, Result};
use std::path::Path;

/// Reads a Photoshop file; what was not imported is in the notes.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ProjectContents> {
    let mut parsed = parse(file, bytes, budget)?;
    let damage = std::mem::take(&mut parsed.damage);
    let mut notes = damage.clone();
    if let Some(ours) = parsed.ours {
        match restore(file, ours, &parsed.records, budget) {
            Ok(Some(contents)) => {
                notes.extend(contents.notes);
                let document = with_guides_of(contents.document, parsed.guides.0);
                let is_whole = contents.is_whole && damage.is_empty();
                return Ok(ProjectContents { document, is_whole, notes, ..contents });
            }
            Ok(None) => notes.push(
                "the layers were changed by another program: live layers became pixels".into(),
            ),
            // Read again with paint of 8 bits, it may fit.
            Err(error)
                if budget.sixteen_bit_paint && error.remedy() == Some(Remedy::MoreMemory) =>
            {
                return Err(error);
            }
            Err(error) => notes.push(format!("live layers became pixels: {error}")),
        }
    }
    notes.extend(color_notes(&parsed));
    let mut own_notes = notes.clone();
    let has_shapes = parsed.records.iter().any(|record| record.path.is_some());
    let (mut document, mut is_less) = build_document(&mut parsed, budget, &mut own_notes);
    if parsed.merged.is_some() {
        let compared = parsed.held_bytes.saturating_add(document.flattening_bytes());
        budget.room(file, "comparing its layers with its own picture", compared)?;
    }
    let has_own_values =
        matches!(parsed.header.mode, Mode::Cmyk | Mode::Lab) || parsed.gray.is_some();
    let has_profile = parsed.header.mode == Mode::Rgb && parsed.has_profile;
    let merged = parsed.merged.as_ref().filter(|_| has_own_values || has_profile || has_shapes);
    let unlike = merged.filter(|merged| is_shown_otherwise(&document, merged, is_less, &own_notes));
    let fitted = unlike.and_then(|merged| match () {
        () if has_profile => keep_values(file, bytes, budget, merged, &mut notes),
        () if has_own_values => fit_inks(file, bytes, budget, &mut notes),
        () => keep_pixels(file, bytes, budget, merged, &mut notes),
    });
    if let Some(fitted) = fitted {
        (document, is_less) = fitted;
        own_notes = notes;
    }
    let mut notes = own_notes;
    let document = check_against_merged(
        document,
        parsed.merged.take(),
        is_less || !damage.is_empty(),
        &mut notes,
    );
    Ok(ProjectContents { document, notes, is_whole: damage.is_empty(), picture: None })
}

/// The document of a file whose layers look as the values of its colors do on each other, and whether
/// something was left out; `None` where that is not known, or too large.
fn fit_inks(
    file: &Path,
    bytes: &[u8],
    budget: &Budget,
    notes: &mut Vec<String>,
) -> Option<(Document, bool)> {
    let mut parsed = parse_as(file, bytes, budget, RecordView::Values).ok()?;
    let (size, is_deep) = (parsed.header.size, parsed.header.bits > 8);
    let held = parsed.held_bytes.saturating_add(fitting_bytes(&parsed.records, size));
    budget.room(file, "blending its inks", held).ok()?;
    let (mode, gray) = (parsed.header.mode, parsed.gray.as_ref());
    let view = InkView::of(mode, parsed.icc, gray, is_deep)?;
    ink_layers::try_fit(&mut parsed.records, size, &view, is_deep)
        .then(|| build_document(&mut parsed, budget, notes))
}

/// The document of a file of RGB with its own values, shown as sRGB, and whether something was left
/// out; `None` unless it looks like the file's own picture.
fn keep_values(
    file: &Path,
    bytes: &[u8],
    budget: &Budget,
    merged: &Merged,
    notes: &mut Vec<String>,
) -> Option<(Document, bool)> {
    let mut parsed = parse_as(file, bytes, budget, RecordView::Values).ok()?;
    let held = parsed.held_bytes.saturating_mul(2).saturating_add(profiled::TABLE_BYTES);
    budget.room(file, "blending the values of its profile", held).ok()?;
    let icc = parsed.icc?;
    let show = |document| show_in_srgb(document, icc);
    build_alike(&mut parsed, budget, (profiled::NOTE, merged), notes, show)
}

/// The document of a file whose shapes are pixels, and whether something was left out; `None` unless
/// it looks like the file's own picture.
fn keep_pixels(
    file: &Path,
    bytes: &[u8],
    budget: &Budget,
    merged: &Merged,
    notes: &mut Vec<String>,
) -> Option<(Document, bool)> {
    const NOTE: &str = "its shapes became pixels: the edges of live ones look otherwise together";
    let mut parsed = parse_as(file, bytes, budget, RecordView::Pixels).ok()?;
    budget.room(file, "the pixels of its shapes", parsed.held_bytes.saturating_mul(2)).ok()?;
    build_alike(&mut parsed, budget, (NOTE, merged), notes, Some)
}

/// The document that a file's records say, as it is shown, and whether something was left out; `None`
/// unless it looks like the file's own picture, `merged`. `note` is told of it.
fn build_alike(
    parsed: &mut ParsedPsd,
    budget: &Budget,
    (note, merged): (&str, &Merged),
    notes: &mut Vec<String>,
    show: impl FnOnce(Document) -> Option<Document>,
) -> Option<(Document, bool)> {
    let mut found = notes.clone();
    found.push(note.into());
    let (document, is_less) = build_document(parsed, budget, &mut found);
    let document = show(document)?;
    if is_shown_otherwise(&document, merged, is_less, &found) {
        return None;
    }
    *notes = found;
    Some((document, is_less))
}

/// Ours keep their places to the last digit, unless another program moved them.
fn with_guides_of(document: Document, found: Guides) -> Document {
    if marks::guides_to_write(&document) == found {
        document
    } else {
        Document { guides: found.into(), ..document }
    }
}

/// What the file's colors were converted to.
fn color_notes(parsed: &ParsedPsd) -> Option<String> {
    let header = &parsed.header;
    let what = match header.mode {
        Mode::Cmyk => "its CMYK colors became sRGB; layers blend in those",
        Mode::Lab => "its Lab colors became sRGB; layers blend in those",
        Mode::Multichannel => {
            "its inks were read as cyan, magenta, yellow and black; others are left out"
        }
        Mode::Duotone => "its inks are left out: it became gray",
        _ if header.is_16_bit && header.bits == 32 => {
            "its 32 bits a channel became 16, and values brighter than white are lost; a Photoshop file that is saved \
             here has 8 for other programs"
        }
        _ if header.is_16_bit => {
            "its 16 bits a channel are kept here; a Photoshop file that is saved here has 8 for other programs"
        }
        _ if header.bits == 32 => {
            "its 32 bits per channel became 8, and values brighter than white are lost"
        }
        _ if header.bits == 16 => "its 16 bits a channel became 8",
        _ => return None,
    };
    Some(what.into())
}
