//! Whether the layers look like the file's picture of them, and what is done if they do not. Floor
//! 5.
//!
//! Photoshop has features that this program cannot express. What is left out may or may not show,
//! so the pictures are compared:
//!
//! * alike, and nothing left out: the layers alone;
//! * alike, though something was left out: the file's picture is hidden above them;
//! * nearly alike, and nothing but adjustments, effects or the edges of text can be the reason: the
//!   same, with a note;
//! * unlike: the file's picture is shown, and the layers are hidden beneath it, in a group.

use super::ink_layers::ADJUSTED;
use super::merged::Merged;
use super::{blocks, filled};
use crate::document::{Content, Document, Group, Layer, Progress, flatten};
use crate::math::Size;
use crate::raster::tile::TILE;
use crate::raster::{BlendMode, TileAt, TileGrid};
use std::sync::Arc;

/// Largest differences of pictures that count as alike, of 255: in the mean, and in all but a
/// hundredth of the pixels.
const ALIKE_MEAN: f64 = 1.0;
const ALIKE_P99: usize = 8;
/// Those of pictures that are near enough for live adjustments and effects, whose formulas are fitted.
const NEAR_MEAN: f64 = 3.0;
const NEAR_P99: usize = 16;
/// As far as edges of text differ, which Photoshop blends by a curve of its own.
const MOST_OF_TEXT: usize = 40;
/// What ends the notes of files of other colors.
const BLENDED_AS_SRGB: &str = "layers blend in those";
/// Names of what is added.
pub(super) const PICTURE: &str = "The file's own picture";
const LAYERS: &str = "Layers";

/// How far two pictures differ: the farthest channel of each pixel, on white, of 255.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Difference {
    mean: f64,
    p99: usize,
    most: usize,
}

impl Difference {
    fn is_alike(self) -> bool {
        self.mean <= ALIKE_MEAN && self.p99 <= ALIKE_P99
    }

    fn is_near(self) -> bool {
        self.mean <= NEAR_MEAN && self.p99 <= NEAR_P99
    }

    fn is_near_for_text(self) -> bool {
        self.mean <= ALIKE_MEAN && self.most <= MOST_OF_TEXT
    }

    /// How many pixels differ by how much.
    fn of(counts: &[u64; 256]) -> Self {
        let all: u64 = counts.iter().sum::<u64>().max(1);
        let total: u64 = counts.iter().zip(0..).map(|(count, by)| count * by).sum();
        let mut left = all / 100;
        let mut within = |count: &u64| {
            let fits = *count <= left;
            left = left.saturating_sub(*count);
            fits
        };
        let beyond = counts.iter().rev().take_while(|count| within(count)).count();
        let most = counts.iter().rposition(|count| *count > 0).unwrap_or(0);
        Self { mean: total as f64 / all as f64, p99: 255usize.saturating_sub(beyond), most }
    }
}

/// The document with the file's own picture if needed; the notes say what was done. `is_less`:
/// something was left out.
pub fn check_against_merged(
    document: Document,
    merged: Option<Merged>,
    is_less: bool,
    notes: &mut Vec<String>,
) -> Document {
    let without = |notes: &mut Vec<String>, why: &str| {
        if is_less {
            notes.push(format!("{why}, so what is left out cannot be seen"));
        }
    };
    let Some(merged) = merged else {
        without(notes, "the file's own picture is damaged or missing");
        return document;
    };
    if !merged.is_real {
        without(notes, "the file was saved without a picture of its own");
        return document;
    }
    let Some(shown) = flatten(&document, &Progress::default()) else { return document };
    let difference = measure_difference(document.size, &shown, &merged);
    if difference.is_alike() {
        if is_less {
            notes.push(format!(
                "the layers look like the file's own picture, which is hidden above them as \
                               “{PICTURE}”"
            ));
            return with_picture(document, &merged, false);
        }
        return document;
    }
    let Difference { mean, most, .. } = difference;
    if let Some(what) = name_fitted_part(&document, difference, notes).filter(|_| !is_less) {
        notes.push(format!(
            "{what} differ from the file's own picture by {mean:.1} of 255 on average, {most} at most; \
             that is hidden above them as “{PICTURE}”"
        ));
        return with_picture(document, &merged, false);
    }
    if is_blank(&merged.pixels.rgba) {
        notes
            .push("the file's own picture is empty, so it was not compared with the layers".into());
        return document;
    }
    let cause = name_cause(&document, is_less, notes);
    notes.push(format!(
        "the layers differ from the file's own picture by {mean:.1} of 255 on average, {most} at most, {cause}: \
         “{PICTURE}” is shown, and the layers are hidden below it in the group “{LAYERS}”"
    ));
    let group = Group { layers: document.layers, pass_through: true };
    let layers = Layer {
        visible: false,
        clip_to_surface: false,
        ..Layer::new(LAYERS, Content::Group(group))
    };
    with_picture(Document { layers: vec![Arc::new(layers)], ..document }, &merged, true)
}

/// Whether the layers do not look like the file's own picture, which would be shown.
pub fn is_shown_otherwise(
    document: &Document,
    merged: &Merged,
    is_less: bool,
    notes: &[String],
) -> bool {
    if !merged.is_real || is_blank(&merged.pixels.rgba) {
        return false;
    }
    let shown = flatten(document, &Progress::default());
    let difference = shown.map(|shown| measure_difference(document.size, &shown, merged));
    difference.is_some_and(|difference| {
        let is_fitted = !is_less && name_fitted_part(document, difference, notes).is_some();
        !difference.is_alike() && !is_fitted
    })
}

/// What is known to be drawn a little differently here, where pictures are near enough for that.
fn name_fitted_part(
    document: &Document,
    difference: Difference,
    notes: &[String],
) -> Option<&'static str> {
    let has_text = || notes.iter().any(|note| note.ends_with(blocks::TEXT_NOTE));
    let has_adjusted = || notes.iter().any(|note| note.ends_with(ADJUSTED));
    if difference.is_near() && (has_fitted(document) || has_adjusted()) {
        Some("its adjustments and effects")
    } else if difference.is_near_for_text() && has_text() {
        Some("the edges of its text")
    } else {
        None
    }
}

/// The likeliest cause of what differs.
fn name_cause(document: &Document, is_less: bool, notes: &[String]) -> &'static str {
    let walk = document.walk();
    let has =
        |is: &dyn Fn(&Layer) -> bool| walk.iter().any(|(_, layer)| layer.visible && is(layer));
    if is_less {
        "because of what is left out"
    } else if notes.iter().any(|note| note.ends_with(BLENDED_AS_SRGB)) {
        "because its colors are blended and adjusted as sRGB here"
    } else if has(&|layer| layer.effects.iter().any(|effect| effect.on)) {
        "probably because its effects are drawn otherwise here"
    } else if has(&|layer| matches!(layer.content, Content::Adjustment(_))) {
        "probably because its adjustments are computed otherwise here"
    } else if has(&|layer| layer.blend != BlendMode::Normal) {
        "probably because its layers are blended otherwise here"
    } else if notes.iter().any(|note| note.ends_with(blocks::TEXT_NOTE)) {
        "probably at the edges of its text"
    } else {
        "perhaps because that picture was made by another program, or before its layers were changed"
    }
}

/// Whether there are adjustments or effects, whose formulas are fitted.
fn has_fitted(document: &Document) -> bool {
    let is_fitted = |layer: &Layer| {
        matches!(layer.content, Content::Adjustment(_)) || layer.effects.iter().any(|e| e.on)
    };
    document.walk().iter().any(|(_, layer)| is_fitted(layer))
}

fn with_picture(mut document: Document, merged: &Merged, visible: bool) -> Document {
    let pixels = filled::paint(&merged.pixels.rgba, &merged.pixels.rgba16, document.size.rect());
    document.layers.push(Arc::new(Layer {
        visible,
        clip_to_surface: false,
        ..Layer::new(PICTURE, pixels)
    }));
    document
}

/// White, black or transparent everywhere: the writer left the picture out without saying so.
pub(super) fn is_blank(rgba: &[u8]) -> bool {
    let pixels = rgba.as_chunks::<4>().0;
    let all = |value: u8| pixels.iter().all(|pixel| pixel[..3] == [value; 3]);
    all(255) || all(0) || pixels.iter().all(|pixel| pixel[3] == 0)
}

fn measure_difference(size: Size, shown: &TileGrid, merged: &Merged) -> Difference {
    let mut counts = [0; 256];
    for at in TileAt::covering(size.rect()) {
        let inside = at.rect().intersect(size.rect());
        let tile = shown.tile(at).map(|tile| tile.bytes());
        for y in inside.y0..inside.y1 {
            for x in inside.x0..inside.x1 {
                let in_tile =
                    ((y - at.rect().y0) as usize * TILE + (x - at.rect().x0) as usize) * 4;
                let own = tile
                    .and_then(|bytes| bytes.get(in_tile..)?.first_chunk())
                    .copied()
                    .unwrap_or([0; 4]);
                let in_picture = (y as usize * size.width as usize + x as usize) * 4;
                let other = merged
                    .pixels
                    .rgba
                    .get(in_picture..)
                    .and_then(|rest| rest.first_chunk())
                    .copied();
                counts[usize::from(channel_distance(
                    own,
                    other.unwrap_or([0; 4]),
                    merged.has_alpha,
                ))] += 1;
            }
        }
    }
    Difference::of(&counts)
}

/// How far a premultiplied pixel is from a straight one.
fn channel_distance(own: [u8; 4], straight: [u8; 4], with_alpha: bool) -> u8 {
    let alpha = u32::from(straight[3]);
    let on_white = |c: u8| ((u32::from(c) * alpha + 255 * (255 - alpha) + 127) / 255) as u8;
    let color =
        (0..3).map(|c| own[c].saturating_add(255 - own[3]).abs_diff(on_white(straight[c]))).max();
    let alpha = if with_alpha { own[3].abs_diff(straight[3]) } else { 0 };
    color.unwrap_or(0).max(alpha)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::srgb::Color;
    use crate::psd::colors::StraightPixels;

    fn gray(value: u8) -> Document {
        let fill = Content::Fill(Color { r: value, g: value, b: value, a: 255 });
        Document {
            layers: vec![Arc::new(Layer::new("gray", fill))],
            ..Document::empty(Size::new(10, 20))
        }
    }

    /// One gray except for one black pixel.
    fn picture(value: u8) -> Option<Merged> {
        let mut rgba = [value, value, value, 255].repeat(200);
        rgba[..3].fill(0);
        Some(Merged {
            pixels: StraightPixels { rgba, rgba16: Vec::new() },
            is_real: true,
            ..Merged::default()
        })
    }

    fn check_as(merged: Option<Merged>, is_less: bool) -> (Vec<(String, bool)>, Vec<String>) {
        let mut notes = Vec::new();
        let document = check_against_merged(gray(100), merged, is_less, &mut notes);
        (document.layers.iter().map(|layer| (layer.name.clone(), layer.visible)).collect(), notes)
    }

    #[test]
    fn the_file_s_picture_is_shown_where_the_layers_look_otherwise() {
        let (layers, notes) = check_as(picture(120), false);
        assert_eq!(layers, [(LAYERS.to_owned(), false), (PICTURE.to_owned(), true)]);
        assert!(
            notes.len() == 1 && notes[0].contains("20.4 of 255 on average, 100 at most"),
            "{notes:?}"
        );
        assert_eq!(check_as(picture(100), false), (vec![("gray".to_owned(), true)], vec![]));
        let (layers, notes) = check_as(picture(100), true);
        assert_eq!(layers, [("gray".to_owned(), true), (PICTURE.to_owned(), false)]);
        assert!(notes[0].contains("is hidden above"), "{notes:?}");
    }

    #[test]
    fn edges_of_text_may_differ() {
        let mut near = picture(100).unwrap();
        near.pixels.rgba[..16].copy_from_slice(&[140, 140, 140, 255].repeat(4));
        let shown = |said: &str| {
            let mut notes = vec![format!("“Title”: {said}")];
            let own = Merged { pixels: near.pixels.clone(), is_real: true, ..Merged::default() };
            let document = check_against_merged(gray(100), Some(own), false, &mut notes);
            assert!(notes[1].contains("differ from the file's own picture by 0.8 of 255"));
            document.layers[0].visible
        };
        assert_eq!([blocks::TEXT_NOTE, "its fill became pixels"].map(shown), [true, false]);
    }

    #[test]
    fn a_picture_that_is_none_is_not_believed() {
        let white = || StraightPixels { rgba: vec![255; 800], rgba16: Vec::new() };
        let plain = |is_real| Some(Merged { pixels: white(), is_real, ..Merged::default() });
        for (merged, is_less, said) in [
            (None, true, "damaged or missing"),
            (plain(false), true, "saved without a picture"),
            (plain(true), false, "is empty"),
        ] {
            let (layers, notes) = check_as(merged, is_less);
            assert_eq!(layers, [("gray".to_owned(), true)]);
            assert!(notes.len() == 1 && notes[0].contains(said), "{notes:?}");
        }
        assert_eq!(check_as(plain(false), false).1, [""; 0]);
    }

    #[test]
    fn the_hundredth_part_that_differs_most_does_not_count() {
        let mut counts = [0; 256];
        (counts[0], counts[3], counts[200]) = (980, 10, 10);
        assert_eq!(Difference::of(&counts), Difference { mean: 2.03, p99: 3, most: 200 });
        counts[200] = 11;
        assert_eq!(Difference::of(&counts).p99, 200);
    }
}
