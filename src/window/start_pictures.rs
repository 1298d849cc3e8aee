//! Pictures of the start screen: recent files and samples, small, made on a thread of their own when
//! their card is first in sight. Floor 7. Not here: the screen (`panels::start`).

use super::mood_pictures::image_of;
use super::sample::SAMPLES;
use super::{Error, jobs};
use crate::io::Budget;
use crate::io::thumbnail::thumbnail;
use eframe::egui::{self, ColorImage, TextureHandle, TextureId, TextureOptions, Vec2};
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};

/// The longer side of a picture, px.
const SIDE_PX: u32 = 256;
/// Files larger than this show a sign instead: their picture would take seconds.
const LARGEST_BYTES: u64 = 64 << 20;

/// What a card shows.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum StartCard {
    File(PathBuf),
    /// By its place among the samples.
    Sample(usize),
}

/// The finished pictures, and the thread that makes them.
#[derive(Default)]
pub struct StartPictures {
    thread: Option<StartThread>,
    wanted: HashSet<StartCard>,
    made: HashMap<StartCard, TextureHandle>,
    /// An error to report once.
    pub trouble: Option<Error>,
}

/// What it is asked for, and what it made.
struct StartThread {
    orders: Sender<StartCard>,
    coming: Receiver<(StartCard, ColorImage)>,
}

impl StartPictures {
    /// The picture of a card and its size, once it is there.
    pub fn of(&mut self, ctx: &egui::Context, card: &StartCard) -> Option<(TextureId, Vec2)> {
        if self.thread.is_none() && self.trouble.is_none() {
            self.begin(ctx.clone());
        }
        let StartThread { orders, coming } = self.thread.as_ref()?;
        for (card, image) in coming.try_iter() {
            let name = format!("{card:?}");
            self.made.insert(card, ctx.load_texture(name, image, TextureOptions::LINEAR));
        }
        if self.wanted.insert(card.clone()) {
            // If the thread has ended, nothing is painted.
            let _ = orders.send(card.clone());
        }
        self.made.get(card).map(|texture| (texture.id(), texture.size_vec2()))
    }

    /// Makes them again when they are next in sight: files may have changed meanwhile.
    pub fn forget(&mut self) {
        self.wanted.clear();
    }

    fn begin(&mut self, waker: egui::Context) {
        let ((orders, wanted), (sender, coming)) = (channel::<StartCard>(), channel());
        let work = move || {
            for card in wanted {
                let Some(image) = painted(&card) else { continue };
                if sender.send((card, image)).is_err() {
                    return;
                }
                waker.request_repaint();
            }
        };
        self.trouble = jobs::spawn("pictures of recent files", work).err();
        self.thread = Some(StartThread { orders, coming });
    }
}

/// A file that is missing, broken or large has none.
fn painted(card: &StartCard) -> Option<ColorImage> {
    match card {
        StartCard::File(file) => {
            let length = std::fs::metadata(file).ok()?.len();
            let budget = Budget::of_this_machine();
            let small =
                (length <= LARGEST_BYTES).then(|| thumbnail(file, SIDE_PX, &budget).ok())??;
            let size = [small.size.width as usize, small.size.height as usize];
            Some(ColorImage::from_rgba_unmultiplied(size, &small.rgba))
        }
        StartCard::Sample(index) => {
            image_of(&SAMPLES.get(*index)?.document(SIDE_PX as usize).ok()?)
        }
    }
}
