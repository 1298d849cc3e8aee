//! Pictures of the looks: the user's own drawing in each of them, small, painted on another thread.
//! Floor 7. Not here: what a look is (`io::recipe::looks`).

use super::jobs;
use super::mood_pictures::image_of;
use crate::Error;
use crate::document::{Document, DocumentReducer};
use crate::io::recipe::LiveLook;
use eframe::egui::{self, ColorImage, TextureHandle, TextureId, TextureOptions, Vec2};
use std::collections::HashMap;
use std::sync::mpsc::{Receiver, Sender, channel};

/// The longer side of a picture, px.
const SIDE: f32 = 128.0;

/// The pictures of one document.
pub struct LookPictures {
    wanted: Sender<Document>,
    coming: Receiver<(&'static str, ColorImage)>,
    made: HashMap<&'static str, TextureHandle>,
    is_ordered: bool,
    /// Why there is no thread, and so no picture.
    pub trouble: Option<Error>,
}

impl LookPictures {
    pub fn new(waker: egui::Context) -> Self {
        let ((wanted, orders), (sender, coming)) = (channel::<Document>(), channel());
        let work = move || {
            while let Ok(document) = orders.recv() {
                let factor = (SIDE / document.size.longer_side()).min(1.0);
                let Ok(small) = DocumentReducer::new(factor).of(&document) else { continue };
                for look in LiveLook::all() {
                    let Some(image) = painted(&small, &look) else { continue };
                    // Once the dialog is closed, nobody waits for the others.
                    if sender.send((look.key, image)).is_err() {
                        return;
                    }
                    waker.request_repaint();
                }
            }
        };
        let trouble = jobs::spawn("pictures of the looks", work).err();
        let (made, is_ordered) = (HashMap::new(), false);
        Self { wanted, coming, made, is_ordered, trouble }
    }

    /// Collects what is painted of a document, which stays the same.
    pub fn follow(&mut self, ctx: &egui::Context, document: &Document) {
        if !std::mem::replace(&mut self.is_ordered, true) {
            // Without a thread there are no pictures, only names.
            let _ = self.wanted.send(document.clone());
        }
        for (key, image) in self.coming.try_iter() {
            self.made.insert(key, ctx.load_texture(key, image, TextureOptions::LINEAR));
        }
    }

    /// A picture and its size, once it is painted.
    pub fn picture(&self, key: &str) -> Option<(TextureId, Vec2)> {
        self.made.get(key).map(|texture| (texture.id(), texture.size_vec2()))
    }
}

/// A small document in a look.
fn painted(small: &Document, look: &LiveLook) -> Option<ColorImage> {
    image_of(&look.on(small).ok()?)
}
