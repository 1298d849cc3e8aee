//! Pictures of other programs, pasted: as paint at their own size, as an image layer, or as a
//! document. Floor 6. Not here: the system's clipboard (the window), what was copied in the program
//! itself (`clipboard`).

use crate::document::{Content, Document, Layer, PixelLayer};
use crate::io::{Budget, base64, picture, profile_change};
use crate::math::range::clamp_to_range;
use crate::math::{COORDINATE, ColorProfile, Vec2};
use crate::raster::{Asset, Picture, TileGrid};
use crate::session::actions::layers::slot_above;
use crate::session::actions::placing::{in_profile, place};
use crate::session::replay::{ReplayValue, names};
use crate::session::{OpenDocument, Session};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

rilievo_engine::named! {
    /// What a pasted picture becomes.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum PasteTo {
        Paint = "paint" => "Paste",
        Image = "image" => "Paste as image layer",
        Document = "document" => "Paste as new document",
    }
}
names!(PasteTo);

/// A picture with the name of its file, or one like a file's. A replay holds the whole file.
#[derive(Clone)]
pub struct PastedPicture {
    /// The name of its layer.
    pub name: String,
    /// The picture itself.
    pub picture: Picture,
}

impl PastedPicture {
    /// The bytes of its file, or of one made now.
    fn file(&self) -> Option<Asset> {
        let made = || Some(picture::encode(Path::new("pasted"), &self.picture).ok()?.0);
        self.picture.encoded.clone().or_else(made)
    }
}

impl ReplayValue for PastedPicture {
    fn to_value(&self) -> Value {
        json!({ "name": self.name, "file": self.file().map(|file| base64::encode(file.bytes())) })
    }

    fn read(value: &Value) -> Result<Self, String> {
        let text = |name: &str| value.get(name).and_then(Value::as_str);
        let (Some(name), Some(file)) = (text("name"), text("file")) else {
            return Err("must have a name and a file".into());
        };
        let bytes = base64::decode(file).ok_or("has a file that is not base64")?;
        let read = picture::decode(Path::new(name), &bytes, &Budget::of_this_machine());
        Ok(Self { name: name.into(), picture: read.map_err(|error| error.to_string())? })
    }
}

/// Pastes a picture with its middle at a canvas point. Without a point: the middle of the view.
///
/// * `from`: the profile of its colors.
pub(super) fn paste(
    session: &mut Session,
    pasted: &PastedPicture,
    from: ColorProfile,
    to: PasteTo,
    at: Option<Vec2>,
) {
    let Some(open) = session.active_mut().filter(|_| to != PasteTo::Document) else {
        return open(session, pasted);
    };
    let at = at.unwrap_or_else(|| view_middle(open));
    let at = Vec2::new(clamp_to_range(at.x, &COORDINATE), clamp_to_range(at.y, &COORDINATE));
    if to == PasteTo::Image {
        return place(session, &pasted.name, pasted.picture.clone(), from, at);
    }
    let size = pasted.picture.size;
    let corner = (at - Vec2::new(size.width as f32, size.height as f32) / 2.0).round();
    let picture = in_profile(&pasted.picture, from, open.document());
    let tiles = picture::to_tiles(&picture, corner.x as i32, corner.y as i32);
    let layer = paint(open.document().free_layer_name(&stem(&pasted.name)), tiles);
    let id = layer.id;
    if let Some(next) = open.document().with_inserted(layer, slot_above(open))
        && open.commit("Paste", next)
    {
        open.select_layers(vec![id]);
    }
}

/// The canvas point in the middle of the window; of the canvas, while the surface is shown
/// unwrapped.
fn view_middle(open: &OpenDocument) -> Vec2 {
    let size = open.document().size;
    let view = open.view.filter(|_| open.unwrap_settings().is_none());
    let side = Vec2::new(size.width as f32, size.height as f32);
    view.map_or(size.center(), |view| view.center.max(Vec2::ZERO).min(side))
}

/// Paint that nothing cuts off, neither the surface's edge nor what is selected.
fn paint(name: String, tiles: TileGrid) -> Layer {
    let pixels = PixelLayer { tiles, ..PixelLayer::default() };
    Layer { clip_to_surface: false, ..Layer::new(name, Content::Pixels(pixels)) }
}

/// A document of the picture's size, which is its paint; in Display P3 if its file is.
fn open(session: &mut Session, pasted: &PastedPicture) {
    let profile = profile_change::own_profile(&pasted.picture);
    let empty = Document { profile, ..Document::empty(pasted.picture.size) };
    let picture = in_profile(&pasted.picture, ColorProfile::Srgb, &empty);
    let layer = paint(stem(&pasted.name), picture::to_tiles(&picture, 0, 0));
    let document = Document { layers: vec![Arc::new(layer)], ..empty };
    let name = session.new_title();
    let mut open = OpenDocument::new(name, document, None);
    open.mark_unsaved();
    session.add_document(open);
}

/// The name of a layer: that of a file without its ending.
fn stem(name: &str) -> String {
    Path::new(name).file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
