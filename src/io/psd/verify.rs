//! Reads a Photoshop file that was just made, like any file, and compares it with its source.
//! Floor 5. Not here: the check of projects (`project::read_back`).

use super::merged::remove_white;
use super::parse::{ParsedPsd, parse};
use super::restore::restore;
use super::shape::TOO_LARGE;
use super::{LayerRecord, RecordSection};
use crate::Budget;
use crate::document::{Document, Guides, NamedSelection};
use crate::{Error, Result};
use std::path::Path;

/// The source of a file.
pub struct Meant<'a> {
    pub document: &'a Document,
    pub records: &'a [LayerRecord],
    /// RGBA of the canvas, on white where it is transparent.
    pub merged: Vec<u8>,
    pub selections: Vec<NamedSelection>,
    pub guides: Guides,
}

/// Fails with a sentence that says what would not come back: to other programs, or here.
pub fn read_back(file: &Path, bytes: &[u8], meant: Meant) -> Result<()> {
    let lost = |what: String| {
        Err(Error::unsupported_file(file, format!("the drawing would not open as it is: {what}")))
    };
    let budget = Budget::holding(meant.document);
    let mut parsed = match parse(file, bytes, &budget) {
        Ok(parsed) => parsed,
        Err(error) => return lost(error.to_string()),
    };
    if !parsed.damage.is_empty() {
        return lost(parsed.damage.join("; "));
    }
    if let Some(what) = difference(&mut parsed, &meant) {
        return lost(what);
    }
    let Some(ours) = parsed.ours else { return lost("what is live in it is missing".into()) };
    let mut read = match restore(file, ours, &parsed.records, &budget) {
        Err(error) => return lost(error.to_string()),
        Ok(None) => return lost("its layers are not recognized as this program's".into()),
        Ok(Some(read)) => read,
    };
    // What is said about the document itself was true before.
    let own = meant.document.notes_of_parts();
    read.notes.retain(|note| !own.contains(note));
    if !read.notes.is_empty() {
        return lost(read.notes.join("; "));
    }
    meant.document.difference(&read.document).map_or(Ok(()), lost)
}

/// What other programs would see differently from what was meant.
fn difference(parsed: &mut ParsedPsd, meant: &Meant) -> Option<String> {
    if parsed.header.size != meant.document.size {
        return Some(format!("the canvas is {}", parsed.header.size));
    }
    if parsed.records.len() != meant.records.len() {
        return Some(format!(
            "of {} layers and groups {} are there",
            meant.records.len(),
            parsed.records.len()
        ));
    }
    let differs = parsed.records.iter().zip(meant.records).find_map(|(read, meant)| {
        // What is live in it is in our own part of the file, whatever room there was to draw it.
        let is_too_large = meant.path.is_some() && read.converted.contains(&TOO_LARGE);
        let what = match is_too_large {
            true => differing_field(&without_shape(read), &without_shape(meant))?,
            false => differing_field(read, meant)?,
        };
        let of = if meant.section == RecordSection::End { "a group" } else { &meant.name };
        Some(format!("{what} of “{of}”"))
    });
    if differs.is_some() {
        return differs;
    }
    if parsed.guides != (meant.guides.clone(), 0) {
        return Some("the guides".into());
    }
    let mut expected = meant.merged.clone();
    if !meant.records.is_empty() {
        // As the reader takes the white away: no two pixels become the same by that.
        remove_white::<u8>(expected.as_chunks_mut().0);
    }
    let Some(read) = parsed.merged.take() else { return Some("the picture of all layers".into()) };
    if !read.is_real || read.pixels.rgba != expected {
        return Some("the picture of all layers".into());
    }
    let is_kept = |(a, b): (&NamedSelection, &NamedSelection)| {
        a.selection.coverage.is_same(&b.selection.coverage)
    };
    let are_kept = read.selections.len() == meant.selections.len()
        && read.selections.iter().zip(&meant.selections).all(is_kept);
    (!are_kept).then(|| "the selections that are kept by name".into())
}

/// A record as programs see it that know no paths.
fn without_shape(record: &LayerRecord) -> LayerRecord {
    LayerRecord { path: None, outline: None, converted: Vec::new(), ..record.clone() }
}

fn differing_field(read: &LayerRecord, meant: &LayerRecord) -> Option<&'static str> {
    let fields = [
        (read.name == meant.name, "the name"),
        (read.section == meant.section, "the kind"),
        (read.blend == meant.blend, "the blend mode"),
        ((read.opacity, read.fill_opacity) == (meant.opacity, meant.fill_opacity), "the opacity"),
        (read.rect == meant.rect, "the place"),
        (read.rgba == meant.rgba, "the pixels"),
        (read.mask == meant.mask, "the mask"),
        (
            (read.clipped, read.visible) == (meant.clipped, meant.visible),
            "what it is clipped to, or whether it is seen",
        ),
        ((read.lock_alpha, read.lock_all) == (meant.lock_alpha, meant.lock_all), "the lock"),
        (read.label == meant.label, "the label"),
        (read.adjustment == meant.adjustment, "the adjustment"),
        (read.effects == meant.effects, "the effects"),
        (
            (&read.path, &read.outline, &read.fill) == (&meant.path, &meant.outline, &meant.fill),
            "the shape",
        ),
        (read == meant, "something that was not put there"),
    ];
    fields.into_iter().find(|(is_same, _)| !is_same).map(|(_, what)| what)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{LayerLabel, Progress, flatten};
    use crate::math::Rect;
    use crate::project::sample::{everything, everything_json, files, read};
    use crate::psd::{alpha_channels, export, marks, write};
    use serde_json::json;

    const FILE: &str = "a.psd";

    /// The message if a file was meant to hold something else.
    fn message_of(
        bytes: &[u8],
        document: &Document,
        change: impl FnOnce(&mut Vec<LayerRecord>, &mut Vec<u8>),
    ) -> String {
        let file = Path::new(FILE);
        let written = export::write(file, document, &Progress::default()).unwrap().unwrap().bytes;
        let mut records = parse(file, &written, &Budget::default()).unwrap().records;
        let shown = flatten(document, &Progress::default()).unwrap();
        let mut merged = write::on_white(&shown.to_straight_rgba(document.size.rect()));
        change(&mut records, &mut merged);
        let (selections, guides) =
            (alpha_channels::of_document(document), marks::guides_to_write(document));
        let meant = Meant { document, records: &records, merged, selections, guides };
        read_back(file, bytes, meant).err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn nothing_is_called_saved_that_other_programs_would_see_otherwise() {
        type Change = fn(&mut Vec<LayerRecord>, &mut Vec<u8>);
        let document = everything(32);
        let bytes =
            export::write(Path::new(FILE), &document, &Progress::default()).unwrap().unwrap().bytes;
        assert_eq!(message_of(&bytes, &document, |_, _| ()), "");
        let changes: [(Change, &str); 10] = [
            (|records, _| records[1].name.push('x'), "the name of"),
            (|records, _| records[1].opacity ^= 1, "the opacity of"),
            (|records, _| records[1].blend = *b"scrn", "the blend mode of"),
            (|records, _| records[1].rect = Rect::new(1, 2, 3, 4), "the place of"),
            (
                |records, _| records.iter_mut().find(|r| !r.rgba.is_empty()).unwrap().rgba[0] ^= 1,
                "the pixels of",
            ),
            (|records, _| records[1].visible ^= true, "whether it is seen"),
            (|records, _| records[1].lock_all ^= true, "the lock of"),
            (|records, _| records[1].label = LayerLabel::Purple, "the label of"),
            (|records, _| drop(records.pop()), "layers and groups"),
            (|_, merged| merged[0] ^= 1, "the picture of all layers"),
        ];
        for (change, expected) in changes {
            let said = message_of(&bytes, &document, change);
            assert!(
                said.contains("would not open as it is") && said.contains(expected),
                "{expected}: {said}"
            );
        }
    }

    #[test]
    fn what_is_said_about_the_document_itself_is_no_reason_not_to_save_it() {
        let mut json = everything_json(32);
        let astray = json!({ "id": "b", "kind": "sculpt", "on": "gone", "strokes": [] });
        json["surface"]["parts"] = json!([astray]);
        let document = read(&json, &files(32));
        assert_eq!(document.notes_of_parts().len(), 1);
        let written = export::write(Path::new(FILE), &document, &Progress::default());
        assert!(written.unwrap().is_some());
    }

    #[test]
    fn nothing_is_called_saved_that_is_cut_short_or_no_longer_live() {
        let document = everything(32);
        let bytes =
            export::write(Path::new(FILE), &document, &Progress::default()).unwrap().unwrap().bytes;
        for length in [0, 30, bytes.len() / 2, bytes.len() - 1] {
            assert!(
                message_of(&bytes[..length], &document, |_, _| ())
                    .contains("would not open as it is"),
                "{length}"
            );
        }
        let other =
            document.with_layer(document.layers[0].id, |layer| layer.opacity *= 0.999).unwrap();
        let meant = |document| {
            let records = parse(Path::new(FILE), &bytes, &Budget::default()).unwrap().records;
            let shown = flatten(&everything(32), &Progress::default()).unwrap();
            let merged = write::on_white(&shown.to_straight_rgba(other.size.rect()));
            let (selections, guides) =
                (alpha_channels::of_document(document), marks::guides_to_write(document));
            let meant = Meant { document, records: &records, merged, selections, guides };
            read_back(Path::new(FILE), &bytes, meant)
        };
        assert!(meant(&document).is_ok());
        let said = meant(&other).unwrap_err().to_string();
        assert!(said.contains("opacity"), "{said}");
    }
}
