//! The picture that a project holds of itself, which the window's canvas shows until its layers are
//! painted. Floor 6.

use crate::document::Document;
use crate::io::{Budget, picture};
use crate::raster::{Asset, TileGrid};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// The pixels of that picture, until they are taken.
#[derive(Default)]
pub struct StoredPreview(Mutex<Option<TileGrid>>);

impl StoredPreview {
    /// From a PNG as large as the canvas; none from any other or a damaged one, or if memory lacks.
    pub fn of(file: &Path, png: Option<&Asset>, document: &Document) -> Self {
        let read = || {
            let (canvas, profile) = (document.size, document.profile);
            let budget = Budget { profile, ..Budget::of_this_machine() };
            budget.room(file, "the picture of it", canvas.area() as u64 * 4).ok()?;
            let painted = picture::decode_paint(file, png?.bytes(), 0, 0, &budget).ok()?;
            (painted.size == canvas).then_some(painted.tiles)
        };
        Self(Mutex::new(read()))
    }

    /// The pixels, once.
    pub fn take(&self) -> Option<TileGrid> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, Layer, Progress, flatten};
    use crate::io::Overwrite;
    use crate::math::Size;
    use crate::math::srgb::Color;
    use crate::session::storage;
    use std::sync::Arc;

    #[test]
    fn a_reopened_project_has_its_picture_before_anything_is_painted() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.ora");
        let fill = Content::Fill(Color { r: 9, g: 90, b: 200, a: 255 });
        let layers = vec![Arc::new(Layer::new("sky", fill))];
        let document = Document { layers, ..Document::empty(Size::new(90, 70)) };
        storage::save(&file, &document, Overwrite::Nothing, &Progress::default()).unwrap();
        let open = storage::open(&file).unwrap().open;
        let picture = open.stored_preview.take().expect("the stored picture");
        let painted = flatten(&document, &Progress::default()).unwrap();
        let rect = document.size.rect();
        assert!(picture.to_straight_rgba(rect) == painted.to_straight_rgba(rect));
        assert!(open.stored_preview.take().is_none(), "it is held no longer than it is needed");
        let damaged = Asset::from(vec![1, 2, 3]);
        assert!(StoredPreview::of(&file, Some(&damaged), &document).take().is_none());
    }
}
