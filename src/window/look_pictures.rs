//! Pictures of the looks and of the materials: the user's own drawing in each look, and a ball in the
//! color of a part of each material, small, painted on another thread. Floor 7. Not here: what they
//! are (`io::recipe`).

use super::jobs;
use super::mood_pictures::image_of;
use crate::Error;
use crate::document::{Document, DocumentReducer};
use crate::io::recipe::{LiveLook, PartMaterial};
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
    /// `dressed`: what is painted for a document, one after the other, by keys.
    pub fn new<T>(waker: egui::Context, dressed: fn(Document) -> T) -> Self
    where
        T: Iterator<Item = (&'static str, Option<Document>)> + 'static,
    {
        let ((wanted, orders), (sender, coming)) = (channel::<Document>(), channel());
        let work = move || {
            while let Ok(document) = orders.recv() {
                for (key, dressed) in dressed(document) {
                    let Some(image) = dressed.as_ref().and_then(image_of) else { continue };
                    // Once the dialog is closed, nobody waits for the others.
                    if sender.send((key, image)).is_err() {
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
        self.collect(ctx);
    }

    /// Collects what is painted.
    pub fn collect(&mut self, ctx: &egui::Context) {
        for (key, image) in self.coming.try_iter() {
            self.made.insert(key, ctx.load_texture(key, image, TextureOptions::LINEAR));
        }
    }

    /// A picture and its size, once it is painted.
    pub fn picture(&self, key: &str) -> Option<(TextureId, Vec2)> {
        self.made.get(key).map(|texture| (texture.id(), texture.size_vec2()))
    }
}

/// A document in every look, small.
pub fn in_looks(document: Document) -> impl Iterator<Item = (&'static str, Option<Document>)> {
    let factor = (SIDE / document.size.longer_side()).min(1.0);
    let small = DocumentReducer::new(factor).of(&document).ok();
    let dressed = move |look: LiveLook| (look.key, small.as_ref().and_then(|s| look.on(s).ok()));
    LiveLook::all().map(dressed)
}

/// A ball of every material.
pub fn in_materials(ball: Document) -> impl Iterator<Item = (&'static str, Option<Document>)> {
    PartMaterial::all().map(move |of| (of.key, of.on(&ball, None).ok().map(|given| given.0)))
}
