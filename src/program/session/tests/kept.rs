//! Seeded stories of transforms, canvases, parts, attachments and maps: what stands afterwards is
//! saved, opens as it was, and shows the same picture. `KEPT_STORIES=5000 cargo test kept::`
//! searches further.

mod lines;

use super::held::everything;
use super::*;
use crate::io::{Budget, project};
use crate::math::{Rect, hash};
use std::path::PathBuf;

/// Numbers that are the same in every run.
pub struct Dice(u32);

impl Dice {
    fn of(seed: u32) -> Self {
        Self(hash::mix(seed ^ 0x5eed))
    }

    pub fn next(&mut self) -> u32 {
        self.0 = hash::mix(self.0.wrapping_add(0x9e37_79b9));
        self.0 >> 4
    }

    pub fn below(&mut self, n: usize) -> usize {
        self.next() as usize % n.max(1)
    }

    pub fn one<'a, T>(&mut self, of: &'a [T]) -> &'a T {
        &of[self.below(of.len())]
    }

    /// In `[low, high]`.
    pub fn number(&mut self, low: f32, high: f32) -> f32 {
        let t = self.next() as f32 / (u32::MAX >> 4) as f32;
        low + t * (high - low)
    }
}

/// Maps of two sizes, neither the canvas's.
fn maps_in(folder: &Path) -> [PathBuf; 3] {
    [(48, 40), (60, 31), (20, 30)].map(|(w, h)| {
        let picture = image::RgbaImage::from_fn(w, h, |x, y| {
            let (u, v) =
                ((x as f32 + 0.5) / w as f32 * 2.2 - 1.1, (y as f32 + 0.5) / h as f32 * 2.2 - 1.1);
            let z = (1.0 - u * u - v * v).max(0.0).sqrt();
            let byte = |v: f32| (v * 127.5 + 127.5).round() as u8;
            image::Rgba([byte(u), byte(-v), byte(z), if z > 0.0 { 255 } else { 0 }])
        });
        let file = folder.join(format!("n{w}.png"));
        picture.save(&file).unwrap();
        file
    })
}

/// A drawing of every kind of layer: flat, on maps, or on parts with layers that lie on them.
fn begin_drawing(kind: usize, maps: &[PathBuf; 3]) -> Session {
    let mut session = Session::default();
    let all = Document { surface: None, ..everything() };
    match kind {
        0 => session.add_document(OpenDocument::new("flat", all, None)),
        1 => {
            let open = serde_json::json!({ "in": "file", "do": "open maps", "normal": maps[0], "depth": null });
            session.replay(Path::new("story"), &open.to_string()).unwrap();
            let open = session.active_mut().unwrap();
            let next = Document { layers: all.layers, ..open.document().clone() };
            assert!(open.commit("Layers", next));
        }
        _ => {
            session.add_document(OpenDocument::new("parts", all, None));
            session.replay(Path::new("story"), lines::SHAPED).unwrap();
        }
    }
    session
}

/// What became of a drawing that was saved and opened; `None` if it is the same.
fn difference_after_saving(document: &Document) -> Option<String> {
    if let Err(why) = document.fits(None) {
        return Some(format!("does not fit: {why}"));
    }
    let file = Path::new("a.ora");
    let bytes = match project::write(file, document, &Progress::default()) {
        Ok(bytes) => bytes.unwrap(),
        Err(error) => return Some(format!("not written: {error}")),
    };
    if let Err(error) = project::read_back(file, &bytes, document, &Budget::holding(document)) {
        return Some(error.to_string());
    }
    let read = match project::read(file, &bytes, &Budget::default()) {
        Ok(read) => read,
        Err(error) => return Some(format!("not read: {error}")),
    };
    let picture = |document: &Document| {
        let flat = flatten(document, &Progress::default()).unwrap();
        flat.to_straight_rgba(Rect::new(
            0,
            0,
            document.size.width as i32,
            document.size.height as i32,
        ))
    };
    let (a, b) = (picture(document), picture(&read.document));
    let off = a.iter().zip(&b).filter(|(a, b)| a != b).count();
    let most = a.iter().zip(&b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or_default();
    (off > 0).then(|| format!("another picture: {off} of {} bytes, by at most {most}", a.len()))
}

/// Performs lines, and says what became of the drawing; `None` if all is well.
fn failure(kind: usize, maps: &[PathBuf; 3], story: &[String]) -> Option<String> {
    let mut session = begin_drawing(kind, maps);
    for line in story {
        if let Err(error) = session.replay(Path::new("story"), line) {
            return Some(format!("{line}: {error}"));
        }
    }
    difference_after_saving(session.active().unwrap().document())
}

/// As few of the lines as fail in the same way.
fn shortest(kind: usize, maps: &[PathBuf; 3], mut story: Vec<String>, why: &str) -> Vec<String> {
    let class = |why: &str| why.chars().filter(|c| !c.is_ascii_digit()).collect::<String>();
    let mut i = 0;
    while i < story.len() {
        let mut fewer = story.clone();
        fewer.remove(i);
        match failure(kind, maps, &fewer) {
            Some(found) if class(&found) == class(why) => story = fewer,
            _ => i += 1,
        }
    }
    story
}

#[test]
fn what_stands_after_any_story_is_saved_and_opens_as_it_was() {
    let stories = std::env::var("KEPT_STORIES").ok().and_then(|n| n.parse().ok()).unwrap_or(60);
    let first = std::env::var("KEPT_FIRST").ok().and_then(|n| n.parse().ok()).unwrap_or(0);
    let folder = tempfile::tempdir().unwrap();
    let maps = maps_in(folder.path());
    let mut failures: Vec<String> = Vec::new();
    for seed in first..first + stories {
        let mut dice = Dice::of(seed);
        let kind = dice.below(3);
        let mut session = begin_drawing(kind, &maps);
        let mut story = Vec::new();
        for _ in 0..1 + dice.below(9) {
            let line = lines::line(&mut dice, session.active().unwrap().document(), &maps);
            session
                .replay(Path::new("story"), &line)
                .unwrap_or_else(|error| panic!("{line}: {error}"));
            story.push(line);
        }
        if let Some(why) = difference_after_saving(session.active().unwrap().document()) {
            let short = shortest(kind, &maps, story, &why);
            failures
                .push(format!("story {seed} of kind {kind}: {why}\n    {}", short.join("\n    ")));
            if failures.len() >= 12 {
                break;
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{} of {stories} stories:\n{}",
        failures.len(),
        failures.join("\n")
    );
}
