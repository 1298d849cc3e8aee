//! Cut, copy and paste of what is selected. What is copied stays a layer of its own kind: strokes
//! stay strokes, live layers live; other programs get its pixels. Floor 6. Not here: the system's
//! clipboard (the window), pictures of other programs (`pasted`).

mod pasted;

pub use pasted::{PasteTo, PastedPicture};

use super::layers::{LayerAction, slot_above};
use crate::document::cut::multiply;
use crate::document::{
    Content, Document, Layer, LayerId, LayerLock, LayerSlot, PixelLayer, Progress, flatten_to_paint,
};
use crate::io::{Budget, profile_change};
use crate::math::{ColorProfile, Rect, Size, Vec2};
use crate::raster::{CoverageGrid, Picture, TileGrid};
use crate::session::replay::actions;
use crate::session::{OpenDocument, Session};
use std::sync::Arc;

actions! {
    ClipboardAction {
        /// From the selected layers, or from all that shows.
        "copy" Copy { merged: bool }
        "cut" Cut {}
        /// In place, above the selected layer.
        "paste" Paste {}
        /// As a document of its size.
        "paste new" PasteNew {}
        /// As an image layer, bent by the current operator and pinned at a canvas point; in the
        /// middle of the view without one.
        "paste image" PasteImage { at: Option<Vec2> }
        /// A picture of another program, with its middle at a canvas point; in that of the view
        /// without one.
        "paste picture" PastePicture { picture: PastedPicture, to: PasteTo, at: Option<Vec2> }
        /// A new layer with what is selected of this one: copied, or taken out of it.
        "layer via" LayerVia { cut: bool }
    }
}

/// What was copied last.
#[derive(Clone)]
pub struct Copied {
    /// As layers of their own kinds, bottom first.
    layers: Vec<Layer>,
    canvas: Size,
    /// The same for other programs: straight RGBA, with its place.
    pub rect: Rect,
    /// Straight RGBA, sRGB.
    pub rgba: Arc<Vec<u8>>,
    /// The profile that it was copied from.
    profile: ColorProfile,
    /// Straight RGBA in that profile.
    own: Arc<Vec<u8>>,
    /// The same with 16 bits, if some of it has them.
    texels16: Option<Arc<Vec<[u16; 4]>>>,
}

impl Copied {
    /// The name for one layer that holds all of it.
    fn name(&self) -> String {
        self.layers.last().map_or_else(String::new, |layer| layer.name.clone())
    }

    /// All of it as paint, with its corner at a pixel.
    fn tiles(&self, x: i32, y: i32) -> TileGrid {
        let (width, height) = (self.rect.width(), self.rect.height());
        match &self.texels16 {
            Some(texels16) => TileGrid::from_straight16(texels16, width, height, x, y),
            None => TileGrid::from_straight_rgba(&self.own, width, height, x, y),
        }
    }
}

impl ClipboardAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        session.drop_gesture();
        match self {
            ClipboardAction::PasteNew {} => return paste_new(session),
            ClipboardAction::PasteImage { at } => return paste_image(session, *at),
            ClipboardAction::PastePicture { picture, to, at } => {
                return pasted::paste(session, picture, ColorProfile::Srgb, *to, *at);
            }
            _ => {}
        }
        let copied = session.copied.clone();
        let Some(open) = session.active_mut() else { return session.say("There is no document.") };
        open.forget_preview();
        let said = match self {
            ClipboardAction::Copy { merged } => {
                match copy(open.document(), &open.outermost_selected(), *merged) {
                    Ok(copied) => {
                        session.copied = Some(copied);
                        return session.say("Copied.");
                    }
                    Err(why) => why,
                }
            }
            ClipboardAction::Cut {} => match cut(open) {
                Ok(copied) => return session.copied = Some(copied),
                Err(why) => why,
            },
            ClipboardAction::Paste {} => match copied {
                Some(copied) => return paste(open, &copied),
                None => NOTHING_COPIED,
            },
            ClipboardAction::LayerVia { cut } => match layer_via(open, *cut) {
                Ok(()) => return,
                Err(why) => why,
            },
            ClipboardAction::PasteNew {}
            | ClipboardAction::PasteImage { .. }
            | ClipboardAction::PastePicture { .. } => {
                return;
            }
        };
        session.say(said);
    }
}

const NOTHING_COPIED: &str = "Nothing has been copied yet.";
const NO_LAYER: &str = "Select a layer first.";
const NOTHING_THERE: &str = "The layer has nothing where you selected.";
const LOCKED: &str = "The layer is locked. Unlock it to cut from it.";

/// What is selected, or all of the canvas.
fn covered_area(document: &Document) -> CoverageGrid {
    document.active_coverage().cloned().unwrap_or_else(|| CoverageGrid::full(document.size.rect()))
}

fn copy(document: &Document, ids: &[LayerId], merged: bool) -> Result<Copied, &'static str> {
    let (covered, progress) = (covered_area(document), Progress::default());
    let (layers, tiles) = if merged {
        let tiles =
            multiply(&flatten_to_paint(document, &progress).ok_or(NOTHING_THERE)?, &covered);
        let pixels = PixelLayer { tiles: tiles.clone(), ..PixelLayer::default() };
        (
            vec![Layer { clip_to_surface: false, ..Layer::new("Copy", Content::Pixels(pixels)) }],
            tiles,
        )
    } else if let [id] = *ids {
        let copied = document.copy_covered(id, &covered).ok_or(NOTHING_THERE)?;
        let look = document.with_layer(id, |layer| {
            (layer.opacity, layer.visible, layer.clip_below) = (1.0, true, false);
        });
        let painted = look
            .and_then(|look| flatten_to_paint(&look.with_only(&[id])?, &progress))
            .ok_or(NOTHING_THERE)?;
        (vec![copied], multiply(&painted, &covered))
    } else {
        let copies: Vec<Layer> =
            ids.iter().filter_map(|id| document.copy_covered(*id, &covered)).collect();
        if copies.is_empty() {
            return Err(if ids.is_empty() {
                NO_LAYER
            } else {
                "The layers have nothing where you selected."
            });
        }
        let layers = copies.iter().cloned().map(Arc::new).collect();
        let alone = Document { layers, ..document.clone() };
        (copies, multiply(&flatten_to_paint(&alone, &progress).ok_or(NOTHING_THERE)?, &covered))
    };
    let rect = CoverageGrid::of_alpha(&tiles).covered_rect().intersect(document.size.rect());
    if rect.is_empty() && merged {
        return Err("Nothing is visible where you selected.");
    }
    let own = Arc::new(tiles.to_straight_rgba(rect));
    let profile = document.profile;
    let rgba = match profile {
        ColorProfile::Srgb => own.clone(),
        ColorProfile::DisplayP3 => {
            let mut rgba = own.to_vec();
            profile_change::show_in_srgb(&mut rgba, profile);
            Arc::new(rgba)
        }
    };
    let texels16 = tiles.is_16_bit_in(rect).then(|| Arc::new(tiles.to_straight16(rect)));
    Ok(Copied { layers, canvas: document.size, rect, rgba, profile, own, texels16 })
}

fn cut(open: &mut OpenDocument) -> Result<Copied, &'static str> {
    let document = open.document();
    let ids = open.outermost_selected();
    if ids.iter().any(|id| document.layer(*id).is_some_and(|layer| layer.lock != LayerLock::None)) {
        return Err(if ids.len() > 1 {
            "One of the layers is locked. Unlock it to cut from it."
        } else {
            LOCKED
        });
    }
    let copied = copy(document, &ids, false)?;
    let covered = covered_area(document);
    let cleared = |next: Document, id: &LayerId| next.with_cleared(*id, &covered);
    let next = ids.iter().try_fold(document.clone(), cleared).ok_or(LOCKED)?;
    open.commit("Cut", next);
    Ok(copied)
}

fn paste(open: &mut OpenDocument, copied: &Copied) {
    let slot = slot_above(open);
    let (mut next, mut ids) = (open.document().clone(), Vec::new());
    for (i, layer) in paste_layers(copied, &next).into_iter().enumerate() {
        let layer = Layer { name: next.free_layer_name(&layer.name), ..layer };
        let slot = LayerSlot { index: slot.index.saturating_add(i), ..slot };
        ids.push(layer.id);
        let Some(with) = next.with_inserted(layer, slot) else { return };
        next = with;
    }
    if open.commit("Paste", next) {
        open.select_layers(ids);
    }
}

/// What was copied as new layers of a document, in its color profile.
fn paste_layers(copied: &Copied, document: &Document) -> Vec<Layer> {
    let layers = own_layers(copied, document);
    let budget = Budget::of_this_machine();
    profile_change::convert_layers(layers, copied.profile, document.profile, &budget)
}

/// What was copied as new layers of a document; on a canvas of another size masks become pixels,
/// because a mask has the size of its canvas.
fn own_layers(copied: &Copied, document: &Document) -> Vec<Layer> {
    let is_plain = |layer: &Layer| layer.mask.is_none() && layer.content.group().is_none();
    if copied.canvas != document.size && !copied.layers.iter().all(is_plain) {
        let Rect { x0, y0, .. } = copied.rect;
        let content =
            Content::Pixels(PixelLayer { tiles: copied.tiles(x0, y0), ..PixelLayer::default() });
        return vec![Layer::new(copied.name(), content)];
    }
    // Pasted twice, they are other layers.
    copied.layers.iter().map(|layer| super::layers::copy_layer(layer, &layer.name)).collect()
}

fn paste_new(session: &mut Session) {
    let Some(copied) = session.copied.clone().filter(|copied| !copied.rect.is_empty()) else {
        return session.say(NOTHING_COPIED);
    };
    let size = Size::new(copied.rect.width() as u32, copied.rect.height() as u32);
    let tiles = copied.tiles(0, 0);
    let layer =
        Layer::new(copied.name(), Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }));
    let (profile, layers) = (copied.profile, vec![Arc::new(layer)]);
    let document = Document { layers, profile, ..Document::empty(size) };
    let name = session.new_title();
    let mut open = OpenDocument::new(name, document, None);
    open.mark_unsaved();
    session.add_document(open);
}

/// What was copied here, as a picture.
fn paste_image(session: &mut Session, at: Option<Vec2>) {
    let Some(copied) = session.copied.clone().filter(|copied| !copied.rect.is_empty()) else {
        return session.say(NOTHING_COPIED);
    };
    let size = Size::new(copied.rect.width() as u32, copied.rect.height() as u32);
    let picture = match &copied.texels16 {
        Some(texels16) => Picture::srgb16(size, texels16.to_vec()),
        None => Picture::srgb8(size, copied.own.as_chunks::<4>().0.to_vec()),
    };
    let Some(picture) = picture else { return };
    let pasted = PastedPicture { name: format!("{}.png", copied.name()), picture };
    pasted::paste(session, &pasted, copied.profile, PasteTo::Image, at);
}

/// Copies what is selected of the layer to a new one above it, and takes it out of this one if it
/// is cut.
fn layer_via(open: &mut OpenDocument, cut: bool) -> Result<(), &'static str> {
    let document = open.document();
    let id = open.active_layer.ok_or(NO_LAYER)?;
    let old = document.layer(id).ok_or(NO_LAYER)?;
    if cut && old.lock != LayerLock::None {
        return Err(LOCKED);
    }
    let Some(selected) = document.active_coverage() else {
        if cut {
            return Err("Nothing is selected.");
        }
        let layer = crate::session::LayerPaths::of(document, &open.outermost_selected());
        LayerAction::Duplicate { layer }.step_on(open);
        return Ok(());
    };
    let mut layer = document.copy_covered(id, selected).ok_or(NOTHING_THERE)?;
    layer.name = document.free_layer_name(&format!("{} copy", old.name));
    let left = match cut {
        true => document.with_cleared(id, selected).ok_or(LOCKED)?,
        false => document.clone(),
    };
    let (new, place) = (layer.id, document.place_of(id).ok_or(NO_LAYER)?);
    let next =
        left.with_inserted(layer, LayerSlot { index: place.index + 1, ..place }).ok_or(NO_LAYER)?;
    if open.commit(if cut { "Layer via cut" } else { "Layer via copy" }, next) {
        open.active_layer = Some(new);
    }
    Ok(())
}
