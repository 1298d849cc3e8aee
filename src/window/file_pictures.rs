//! Small pictures of files, for lists of files: made on a thread of their own, the one that was asked
//! for last first. Floor 7. Not here: how they are made (`io::thumbnail`).

use crate::io::Budget;
use crate::io::platform::files;
use crate::io::thumbnail::thumbnail;
use crate::jobs;
use crate::memory::catch_out_of_memory;
use eframe::egui::{ColorImage, Context, TextureHandle, TextureOptions};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// The longer side of a picture in a list, px.
const SIDE_PX: u32 = 128;
/// The most pictures that are kept.
const MOST: usize = 400;
/// Larger files show no picture: opening one would take too long.
const LARGEST_BYTES: u64 = 256 << 20;

/// A file, and its picture if it has one.
type FilePicture = (PathBuf, Option<ColorImage>);

/// A picture that was asked for.
pub enum PictureState {
    Awaited,
    /// The file cannot be shown.
    Missing,
    Made(TextureHandle, Arc<ColorImage>),
}

/// The pictures that are made, and the thread that makes them.
pub struct FilePictures {
    /// Their longer side, px.
    side_px: u32,
    thread: Option<(Sender<PathBuf>, Receiver<FilePicture>)>,
    made: HashMap<PathBuf, PictureState>,
}

impl Default for FilePictures {
    fn default() -> Self {
        Self::with_side(SIDE_PX)
    }
}

impl FilePictures {
    /// Pictures whose longer side has so many pixels at most.
    pub fn with_side(side_px: u32) -> Self {
        Self { side_px, thread: None, made: HashMap::new() }
    }

    /// The picture of a file, once it is made; `None` before, and if the file has none.
    pub fn of(&mut self, ctx: &Context, file: &Path) -> Option<&TextureHandle> {
        match self.state(ctx, file) {
            PictureState::Made(texture, _) => Some(texture),
            PictureState::Awaited | PictureState::Missing => None,
        }
    }

    /// What became of the picture of a file.
    pub fn state(&mut self, ctx: &Context, file: &Path) -> &PictureState {
        self.collect(ctx);
        if !self.made.contains_key(file) {
            self.order(ctx, file);
        }
        self.made.get(file).unwrap_or(&PictureState::Missing)
    }

    /// The file has changed: its picture is made again when it is asked for.
    pub fn forget(&mut self, file: &Path) {
        self.made.remove(file);
    }

    fn order(&mut self, ctx: &Context, file: &Path) {
        if self.made.len() >= MOST {
            self.made.clear();
        }
        if self.thread.is_none() {
            let (orders, coming) = channel();
            let (finished, done) = channel();
            let waker = ctx.clone();
            let side_px = self.side_px;
            let work = move || make_all(side_px, &coming, &finished, &waker);
            // Without a thread there are no pictures.
            let _ = jobs::spawn("pictures of files", work);
            self.thread = Some((orders, done));
        }
        let Some((orders, _)) = &self.thread else { return };
        let _ = orders.send(file.to_owned());
        self.made.insert(file.to_owned(), PictureState::Awaited);
    }

    fn collect(&mut self, ctx: &Context) {
        let Some((_, done)) = &self.thread else { return };
        for (file, image) in done.try_iter() {
            let load = |image: ColorImage| {
                let (name, image) = (file.to_string_lossy(), Arc::new(image));
                let texture = ctx.load_texture(name, image.clone(), TextureOptions::LINEAR);
                PictureState::Made(texture, image)
            };
            // What was forgotten meanwhile is not wanted.
            if let Some(place) = self.made.get_mut(&file) {
                *place = image.map_or(PictureState::Missing, load);
            }
        }
    }
}

/// The thread: until nobody asks any more.
fn make_all(
    side_px: u32,
    coming: &Receiver<PathBuf>,
    finished: &Sender<FilePicture>,
    waker: &Context,
) {
    let mut waiting = Vec::new();
    loop {
        if waiting.is_empty() {
            let Ok(file) = coming.recv() else { return };
            waiting.push(file);
        }
        waiting.extend(coming.try_iter());
        // What is in sight now was asked for last.
        let Some(file) = waiting.pop() else { continue };
        let image = catch_out_of_memory(|| make(&file, side_px)).ok().flatten();
        if finished.send((file, image)).is_err() {
            return;
        }
        waker.request_repaint();
    }
}

fn make(file: &Path, side_px: u32) -> Option<ColorImage> {
    if files::metadata(file).ok()?.len() > LARGEST_BYTES {
        return None;
    }
    let small = thumbnail(file, side_px, &Budget::of_this_machine()).ok()?;
    let size = [small.size.width as usize, small.size.height as usize];
    Some(ColorImage::from_rgba_unmultiplied(size, &small.rgba))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

    #[test]
    fn a_picture_comes_after_a_while_and_a_file_that_is_none_has_none() {
        let folder = tempfile::tempdir().unwrap();
        let (letter, recipe) = (folder.path().join("a.txt"), folder.path().join("b.json"));
        std::fs::write(&letter, "Dear reader").unwrap();
        let fill = r##"{"format":"rilievo","version":1,"canvas":{"width":40,"height":20},
            "layers":[{"kind":"fill","name":"f","color":"#336699"}]}"##;
        std::fs::write(&recipe, fill).unwrap();
        let (ctx, mut pictures) = (Context::default(), FilePictures::default());
        let began = Instant::now();
        while pictures.of(&ctx, &recipe).is_none() {
            assert!(began.elapsed() < Duration::from_secs(60), "no picture came");
            std::thread::sleep(Duration::from_millis(5));
        }
        assert_eq!(pictures.of(&ctx, &recipe).unwrap().size(), [40, 20]);
        assert!(pictures.of(&ctx, &letter).is_none());
        pictures.forget(&recipe);
        assert!(pictures.of(&ctx, &recipe).is_none(), "it is made again");
    }
}
