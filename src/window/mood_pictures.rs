//! Pictures of the moods: the user's own drawing in each of them, small, painted on another thread.
//! Floor 7. Not here: what a mood is (`shading::mood`).

use super::jobs;
use crate::Error;
use crate::document::{
    Content, Document, DocumentReducer, Layer, LayerId, Live, Progress, flatten,
};
use crate::io::profile_change::show_in_srgb;
use crate::shading::Mood;
use eframe::egui::{self, ColorImage, TextureHandle, TextureId, TextureOptions, Vec2};
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// The longer side of a picture, px.
const SIDE: f32 = 96.0;

/// The pictures of the last layer that they were asked for.
#[derive(Default)]
pub struct MoodPictures {
    thread: Option<MoodThread>,
    /// What they were ordered for last.
    ordered: Option<MoodSight>,
    made: HashMap<Mood, TextureHandle>,
    /// Errors to report once.
    pub trouble: Option<Error>,
}

/// What the pictures show, whatever light the layer is in: the layer and, by their addresses, all
/// others and the surface.
#[derive(Clone, PartialEq)]
struct MoodSight {
    layer: LayerId,
    others: Vec<*const Layer>,
    surface: Option<usize>,
    beneath: bool,
}

struct MoodThread {
    wanted: Sender<(Document, LayerId)>,
    coming: Receiver<(Mood, ColorImage)>,
}

impl MoodPictures {
    /// Updates the pictures to a layer of a document.
    pub fn follow(&mut self, ctx: &egui::Context, document: &Document, layer: &Layer) {
        let Content::Shading(live) = &layer.content else { return };
        if self.thread.is_none() {
            let (thread, trouble) = MoodThread::start(ctx.clone());
            // Without a thread there are no pictures, only names.
            (self.thread, self.trouble) = (Some(thread), trouble);
        }
        let Some(thread) = &self.thread else { return };
        for (mood, image) in thread.coming.try_iter() {
            let texture = ctx.load_texture(mood.name(), image, TextureOptions::LINEAR);
            self.made.insert(mood, texture);
        }
        let others = document.walk().into_iter().map(|(_, other)| other);
        let sight = MoodSight {
            layer: layer.id,
            others: others.filter(|other| other.id != layer.id).map(Arc::as_ptr).collect(),
            surface: document.surface.as_ref().map(|surface| Arc::as_ptr(surface) as usize),
            beneath: live.params().is_lighting_beneath(),
        };
        // While parts are dragged, their surface is still to come.
        if !document.is_ahead() && self.ordered.as_ref() != Some(&sight) {
            self.ordered = Some(sight);
            // If the thread has ended, nothing is painted.
            let _ = thread.wanted.send((document.clone(), layer.id));
        }
    }

    /// A picture and its size, once it is painted.
    pub fn picture(&self, mood: Mood) -> Option<(TextureId, Vec2)> {
        self.made.get(&mood).map(|texture| (texture.id(), texture.size_vec2()))
    }
}

impl MoodThread {
    fn start(waker: egui::Context) -> (Self, Option<Error>) {
        let ((wanted, orders), (sender, coming)) = (channel::<(Document, LayerId)>(), channel());
        let work = move || {
            while let Ok(order) = orders.recv() {
                // Only the last one counts.
                let (document, layer) = orders.try_iter().last().unwrap_or(order);
                for (mood, image) in paint_moods(&document, layer) {
                    if sender.send((mood, image)).is_err() {
                        return;
                    }
                    waker.request_repaint();
                }
            }
        };
        let trouble = jobs::spawn("pictures of the moods", work).err();
        (Self { wanted, coming }, trouble)
    }
}

/// A document in each mood, small.
fn paint_moods(document: &Document, layer: LayerId) -> Vec<(Mood, ColorImage)> {
    let factor = (SIDE / document.size.longer_side()).min(1.0);
    let Ok(small) = DocumentReducer::new(factor).of(document) else { return Vec::new() };
    let in_mood = |mood: Mood| {
        let lit = small.with_layer(layer, |layer| {
            if let Content::Shading(live) = &layer.content {
                layer.content = Content::Shading(Live::new(mood.on(live.params())));
            }
        })?;
        Some((mood, image_of(&lit)?))
    };
    Mood::ALL.iter().filter_map(|(mood, _)| in_mood(*mood)).collect()
}

/// What a document shows, as an image of its size.
pub fn image_of(document: &Document) -> Option<ColorImage> {
    let shown = flatten(document, &Progress::default())?;
    let mut pixels = shown.to_straight_rgba(document.size.rect());
    show_in_srgb(&mut pixels, document.profile);
    let size = [document.size.width as usize, document.size.height as usize];
    Some(ColorImage::from_rgba_unmultiplied(size, &pixels))
}
