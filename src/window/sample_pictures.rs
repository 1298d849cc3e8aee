//! Pictures of the samples, small, made on a thread of their own when the start screen first shows
//! them. Floor 7. Not here: the samples (`sample`), pictures of files (`file_pictures`).

use super::mood_pictures::image_of;
use super::sample::SAMPLES;
use super::{Error, jobs};
use eframe::egui::{self, ColorImage, TextureHandle, TextureOptions};
use std::collections::HashMap;
use std::sync::mpsc::{Receiver, channel};

/// Sides of a picture, px.
const SIDE_PX: usize = 256;

/// The finished pictures, by the places of the samples.
#[derive(Default)]
pub struct SamplePictures {
    coming: Option<Receiver<(usize, ColorImage)>>,
    made: HashMap<usize, TextureHandle>,
    /// An error to report once.
    pub trouble: Option<Error>,
}

impl SamplePictures {
    /// The picture of a sample, once it is there.
    pub fn of(&mut self, ctx: &egui::Context, sample: usize) -> Option<&TextureHandle> {
        if self.coming.is_none() && self.trouble.is_none() {
            self.begin(ctx.clone());
        }
        for (i, image) in self.coming.as_ref()?.try_iter() {
            let texture = ctx.load_texture(format!("sample {i}"), image, TextureOptions::LINEAR);
            self.made.insert(i, texture);
        }
        self.made.get(&sample)
    }

    fn begin(&mut self, waker: egui::Context) {
        let (sender, coming) = channel();
        let work = move || {
            for (i, sample) in SAMPLES.iter().enumerate() {
                let document = sample.document(SIDE_PX).ok();
                let Some(image) = document.as_ref().and_then(image_of) else { continue };
                if sender.send((i, image)).is_err() {
                    return;
                }
                waker.request_repaint();
            }
        };
        // Without a thread there are no pictures, only names.
        self.trouble = jobs::spawn("pictures of samples", work).err();
        self.coming = Some(coming);
    }
}
