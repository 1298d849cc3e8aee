//! Pictures that become image layers: their places, and their names in the document. Floor 6. Not
//! here: pictures of existing layers (`pictures`).

use crate::Result;
use crate::document::{Content, Document, Layer, Live};
use crate::io::{Budget, files::read_file, picture, profile_change};
use crate::math::{ColorProfile, Vec2};
use crate::paint::{Adjust, ImageFilter, PictureSource, PlacedImage, Placement};
use crate::raster::{Outside, Picture};
use crate::session::actions::file_names::free_file;
use crate::session::actions::layers::slot_above;
use crate::session::{OpenDocument, Session, storage};
use crate::surface::operator::{MapValues, reflection};
use crate::surface::{Anchor, Bend, Operator};
use std::path::Path;
use std::sync::Arc;

/// A picture of the user's own, with its name; its colors are sRGB until it is in a document.
pub fn read_picture(file: &Path) -> Result<(String, Picture)> {
    let bytes = read_file(file, Budget::of_this_machine().file_bytes)?;
    let picture = picture::decode(file, &bytes, &Budget::of_this_machine())?;
    Ok((file.file_name().unwrap_or_default().to_string_lossy().into_owned(), picture))
}

/// A picture becomes an image layer, bent by the current operator (by normals, if that is flat),
/// pinned at `at`. If no document is open, it becomes one itself.
///
/// * `from`: the profile of its colors.
pub fn place(session: &mut Session, name: &str, picture: Picture, from: ColorProfile, at: Vec2) {
    let operator = match session.tools.operator {
        Operator::None => DROPPED,
        operator => operator,
    };
    let Some(open) = session.active_mut() else {
        let open = OpenDocument::new(name, of_picture(name, picture), None);
        return session.add_document(open);
    };
    let document = open.document();
    let operator = if document.surface.is_some() { operator } else { Operator::None };
    let at =
        at.clamp(Vec2::ZERO, Vec2::new(document.size.width as f32, document.size.height as f32));
    let lies = Lies {
        placement: placement(document, operator, at),
        outside: Outside::Mirror,
        bend: Bend { operator, anchors: vec![Anchor::pin(at)], ..Bend::default() },
    };
    let picture = in_profile(&picture, from, document);
    add_image(open, name, picture, lies, "Place image");
}

/// A picture whose colors are of a profile, in that of a document.
pub(super) fn in_profile(picture: &Picture, from: ColorProfile, document: &Document) -> Picture {
    let budget = Budget::of_this_machine();
    profile_change::convert_picture(picture, from, document.profile, &budget)
}

/// How a picture lies on the canvas.
pub(super) struct Lies {
    pub placement: Placement,
    pub outside: Outside,
    pub bend: Bend,
}

/// A picture becomes an image layer above the selected one, and is selected; returns whether it
/// could. Its colors are in the document's profile.
pub(super) fn add_image(
    open: &mut OpenDocument,
    name: &str,
    picture: Picture,
    lies: Lies,
    label: &str,
) -> bool {
    let document = open.document();
    let Lies { placement, outside, bend } = lies;
    let source = PictureSource::new(free_file(document, name), picture, Adjust::default());
    let filter = ImageFilter::Antialias;
    let image = PlacedImage { source, placement, outside, bend, filter, frame: Default::default() };
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    let layer = Layer::new(document.free_layer_name(&stem), Content::Image(Live::new(image)));
    let id = layer.id;
    let next = document.with_inserted(layer, slot_above(open));
    let is_added = next.is_some_and(|next| open.commit(label, next));
    if is_added {
        open.active_layer = Some(id);
    }
    is_added
}

/// The place of a picture that is pinned at a point: over the canvas, or over all that a mirror
/// looks up.
fn placement(document: &Document, operator: Operator, at: Vec2) -> Placement {
    match (operator, &document.surface) {
        (Operator::Reflection { alpha, .. }, Some(surface)) => {
            let MapValues { nbar, nz, .. } = surface.values_near(at);
            let turn = reflection::mirrored(nbar, nz);
            Placement::covering_mirror(document.size, alpha, turn)
        }
        _ => Placement::covering(document.size),
    }
}

/// The operator of a dropped picture if the current one is flat: like a reflection that is still
/// recognizable.
const DROPPED: Operator = Operator::Normal { alpha: 0.5, beta: 1.5, detail: 0.0 };

/// A picture as a document of its own size; in Display P3 if its file is.
pub fn of_picture(name: &str, picture: Picture) -> Document {
    let size = picture.size;
    let empty =
        Document { profile: profile_change::own_profile(&picture), ..Document::empty(size) };
    let picture = in_profile(&picture, ColorProfile::Srgb, &empty);
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    let layers = vec![Arc::new(storage::flat_image(&stem, name, picture, size))];
    Document { layers, ..empty }
}
