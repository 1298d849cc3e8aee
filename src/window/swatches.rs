//! The pictures of the brushes: each is painted once, on another thread, when its row is first
//! visible. Floor 7. Not here: painting them (`session::swatch`).

use super::jobs;
use crate::Error;
use crate::io::recipe::BrushPreset;
use crate::session::swatch;
use eframe::egui::{self, ColorImage, TextureHandle, TextureId, TextureOptions};
use std::collections::{HashMap, HashSet};
use std::sync::mpsc::{Receiver, Sender, channel};

/// The pictures of the brushes.
#[derive(Default)]
pub struct Swatches {
    thread: Option<SwatchThread>,
    requested: HashSet<String>,
    made: HashMap<String, TextureHandle>,
    /// None is begun at present: a document is opened or painted, which is waited for.
    pub is_held: bool,
    /// Errors to report once.
    pub trouble: Option<Error>,
}

struct SwatchThread {
    wanted: Sender<BrushPreset>,
    coming: Receiver<(String, ColorImage)>,
}

/// Side of a swatch, px.
const SIDE: u32 = 128;

impl Swatches {
    /// The picture of a brush, once it is painted.
    pub fn of(&mut self, ctx: &egui::Context, preset: &BrushPreset) -> Option<TextureId> {
        if self.thread.is_none() {
            let (thread, trouble) = SwatchThread::start(ctx.clone());
            // Without a thread there are no pictures, only names.
            (self.thread, self.trouble) = (Some(thread), trouble);
        }
        let thread = self.thread.as_ref()?;
        for (key, image) in thread.coming.try_iter() {
            self.made.insert(key.clone(), ctx.load_texture(key, image, TextureOptions::LINEAR));
        }
        if !self.is_held && self.requested.insert(preset.key.clone()) {
            // If the thread has ended, nothing is painted.
            let _ = thread.wanted.send(preset.clone());
        }
        self.made.get(&preset.key).map(TextureHandle::id)
    }
}

impl SwatchThread {
    fn start(waker: egui::Context) -> (Self, Option<Error>) {
        let ((wanted, orders), (sender, coming)) = (channel::<BrushPreset>(), channel());
        let work = move || {
            for preset in orders {
                if let Some(image) = paint_swatch(&preset) {
                    if sender.send((preset.key, image)).is_err() {
                        return;
                    }
                    waker.request_repaint();
                }
            }
        };
        let trouble = jobs::spawn("pictures of the brushes", work).err();
        (Self { wanted, coming }, trouble)
    }
}

fn paint_swatch(preset: &BrushPreset) -> Option<ColorImage> {
    let pixels = swatch::render_swatch(preset, SIDE)?;
    Some(ColorImage::from_rgba_unmultiplied([SIDE as usize; 2], &pixels))
}
