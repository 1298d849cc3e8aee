//! What a placed picture is read from: its texels, what is done to them, and the textures that are
//! made of both. Floor 3.

use super::super::adjust::Adjust;
use super::super::path::LivePath;
use super::super::stamp::{StampCache, TipStamp};
use super::super::text::Text;
use super::Placement;
use crate::math::Size;
use crate::memory::RemadeCell;
use crate::raster::sampler::TapRule;
use crate::raster::{FloatTexture, Outside, Picture, Texture};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// What a picture is drawn from.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum PictureOrigin {
    /// Its file alone.
    #[default]
    File,
    /// The words that it shows.
    Text(Arc<Text>),
    /// A path, which needs no file.
    Path(Arc<LivePath>),
}

/// A picture and its adjustments; the texture is made once, on first use.
#[derive(Clone)]
pub struct PictureSource {
    /// Its name in the document: a path relative to the recipe, or an entry of the project.
    pub file: String,
    /// As it was decoded.
    pub picture: Picture,
    /// What is done to it before it is read.
    pub adjust: Adjust,
    /// What it is drawn from.
    pub origin: PictureOrigin,
    pub(super) derived: Arc<DerivedTextures>,
    /// How closely it is read if it is antialiased.
    pub(super) rule: TapRule,
}

/// What is made of a picture when it is read for the first time.
#[derive(Default)]
pub(super) struct DerivedTextures {
    texture: RemadeCell<Arc<Texture>>,
    /// The texture of a drawing that is drawn 2, 4 and 8 times as large; `None` where it cannot be.
    enlarged: [RemadeCell<Option<Arc<Texture>>>; 3],
    /// Its finest levels of detail, which are left out of the texture.
    left_out: u32,
    /// The texture of a picture that is the same beyond some rows, until this one's is made of it.
    like: Mutex<Option<(Arc<Texture>, Range<u32>)>>,
    /// The texture in floats, as long as it is in use.
    pub(super) floats: Mutex<Weak<FloatTexture>>,
    /// The stamps made from it if it is a brush's tip.
    stamps: StampCache,
}

impl PartialEq for PictureSource {
    /// The same picture with the same adjustments, whatever its name.
    fn eq(&self, other: &Self) -> bool {
        self.adjust == other.adjust && self.origin == other.origin && self.picture == other.picture
    }
}

/// A picture made here, as it is.
impl From<Picture> for PictureSource {
    fn from(picture: Picture) -> Self {
        Self::new(String::new(), picture, Adjust::default())
    }
}

impl PictureSource {
    /// A picture under its name in the document, and what is done to it.
    pub fn new(file: String, picture: Picture, adjust: Adjust) -> Self {
        let (origin, derived) = (PictureOrigin::default(), Arc::default());
        Self { file, picture, adjust, origin, derived, rule: TapRule::AT_REST }
    }

    /// The same picture with other adjustments.
    pub fn adjusted(&self, adjust: Adjust) -> Self {
        let origin = self.origin.clone();
        Self { origin, ..Self::new(self.file.clone(), self.picture.clone(), adjust) }
    }

    /// The words that it shows, if it is a text.
    pub fn text(&self) -> Option<&Arc<Text>> {
        match &self.origin {
            PictureOrigin::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The path that it shows, if it is one.
    pub fn path(&self) -> Option<&Arc<LivePath>> {
        match &self.origin {
            PictureOrigin::Path(path) => Some(path),
            _ => None,
        }
    }

    /// Where it lies unless something else is said: a text at the size of its type in the middle of
    /// the canvas, a path where its points are, a picture over all of the canvas.
    pub fn default_placement(&self, canvas: Size) -> Placement {
        match &self.origin {
            PictureOrigin::Text(_) => {
                Placement::at_own_size(canvas, &self.picture, canvas.center())
            }
            PictureOrigin::Path(path) => self.path_placement(canvas, path),
            PictureOrigin::File => Placement::covering(canvas),
        }
    }

    /// What is beyond its edges unless something else is said.
    pub fn default_outside(&self) -> Outside {
        if self.origin == PictureOrigin::File { Outside::Mirror } else { Outside::None }
    }

    /// The same picture, read as closely as a rule demands if it is antialiased.
    pub fn read_by(&self, rule: TapRule) -> Self {
        Self { rule, ..self.clone() }
    }

    /// The same picture without its finest `levels` of detail: showing it that much smaller reads
    /// fewer texels.
    pub fn coarser(&self, levels: u32) -> Self {
        let left_out = self.derived.left_out + levels;
        let derived = DerivedTextures { left_out, ..DerivedTextures::default() };
        derived.texture.get_or_make(|| Arc::new(self.texture().coarser(levels)));
        Self { derived: Arc::new(derived), ..self.clone() }
    }

    /// Another picture in the place of this one, of which it differs in some rows alone: its texture
    /// is made of this one's.
    pub fn repainted(&self, file: String, picture: Picture, rows: Range<u32>) -> Self {
        let next = Self::new(file, picture, self.adjust);
        let derived = &self.derived;
        if self.adjust == Adjust::default() && derived.left_out == 0 {
            let lock = |derived: &DerivedTextures| {
                derived.like.lock().unwrap_or_else(PoisonError::into_inner).clone()
            };
            let like = match derived.texture.get() {
                Some(made) => Some((made, rows)),
                None => lock(derived).map(|(made, older)| {
                    (made, rows.start.min(older.start)..rows.end.max(older.end))
                }),
            };
            *next.derived.like.lock().unwrap_or_else(PoisonError::into_inner) = like;
        }
        next
    }

    /// Bytes of the textures that were made.
    pub fn texture_bytes(&self) -> u64 {
        let enlarged = self.derived.enlarged.iter().filter_map(|texture| texture.get().flatten());
        self.derived.texture.get().into_iter().chain(enlarged).map(|texture| texture.bytes()).sum()
    }

    /// Drops the textures; they are made again when they are read.
    pub fn clear_textures(&self) {
        self.derived.texture.clear();
        self.derived.enlarged.iter().for_each(RemadeCell::clear);
    }

    /// The address of what clones share of its textures.
    pub fn place(&self) -> usize {
        Arc::as_ptr(&self.derived).cast::<()>() as usize
    }

    /// The picture as a tip, with a softness in `[0, 1]`.
    pub(in crate::paint) fn stamp(&self, softness: f32) -> Arc<TipStamp> {
        self.derived.stamps.stamp(&self.texture(), softness)
    }

    pub(in crate::paint) fn stamps(&self) -> &StampCache {
        &self.derived.stamps
    }

    /// The adjusted texture, of a drawing at the size at which a pixel reads no less than a texel.
    ///
    /// * `texels_per_px`: how many texels of the picture as it is a pixel is wide.
    ///
    /// An enlarged texture that cannot be had is the next smaller one.
    pub fn texture_of(&self, texels_per_px: f32) -> Arc<Texture> {
        if self.picture.drawing.is_none() || texels_per_px.is_nan() || texels_per_px <= 0.0 {
            return self.texture();
        }
        let steps =
            (-texels_per_px.log2() - 1e-3).ceil().max(0.0).min(self.derived.enlarged.len() as f32);
        let made = (1..=steps as u32).rev().find_map(|step| self.enlarge(step));
        made.unwrap_or_else(|| self.texture())
    }

    /// The texture of the drawing with sides 2^step times as long.
    fn enlarge(&self, step: u32) -> Option<Arc<Texture>> {
        let make = || {
            let picture = self.picture.enlarged(1 << step)?;
            let blur = self.adjust.blur * (1 << step) as f32;
            let adjust = Adjust { blur: blur.min(*Adjust::BLUR.end()), ..self.adjust };
            Some(Arc::new(Texture::new(&adjust.apply(&picture))))
        };
        self.derived.enlarged[step as usize - 1].get_or_make(make)
    }

    /// The adjusted texture.
    ///
    /// Made by the calling thread alone: a worker that waited for others here could be given a tile
    /// that waits for this same texture.
    pub fn texture(&self) -> Arc<Texture> {
        self.derived.texture.get_or_make(|| {
            let like = self.derived.like.lock().unwrap_or_else(PoisonError::into_inner).take();
            let repainted = like.and_then(|(of, rows)| of.repainted(&self.picture, rows));
            let make = || Texture::new(&self.adjust.apply(&self.picture));
            let whole = repainted.unwrap_or_else(make);
            Arc::new(match self.derived.left_out {
                0 => whole,
                levels => whole.coarser(levels),
            })
        })
    }
}
