//! A lit sphere whose brush marks stay whole: its settings, and where a figure looks different after
//! its ball was painted on. Floor 3. Not here: which place of the ball each pixel shows
//! (`surface::chunks`), its colors (`sphere`).

use super::{LitSphere, Shading};
use crate::math::number_settings::number_settings;
use crate::raster::{Picture, TileAt};
use crate::surface::chunks::{BallCells, BallPlaces, ChunkSettings};
use crate::surface::{Scene, Surface};
use std::sync::Arc;

number_settings! {
    /// How the brush marks of a painted ball lie on a figure.
    pub struct BallStrokes {
        /// The ball's diameter on the canvas, px: how large its marks are.
        size: "Ball size", "The ball's diameter, px: how large its brush marks are", 16.0..=8192.0, 512.0, px;
        /// The size of the largest pieces of the ball, px.
        chunk: "Chunk size", "The largest pieces of the ball that are shown whole, px", 1.0..=1024.0, 64.0, px;
        /// How far marks bend as the form does.
        follow: "Strokes follow form", "0 keeps the marks as they are, 1 bends them with the form", 0.0..=1.0, 0.0;
        /// The width in which pieces blend, px.
        seams: "Seams", "How far pieces blend where they meet, px", 0.0..=32.0, 1.0, px;
        and
        /// Whether brush marks stay whole; else the ball is looked up as a lit sphere is.
        on: bool = false;
    }
}

impl BallStrokes {
    /// The same on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let mut next = *self;
        for setting in Self::lengths() {
            setting.put(&mut next, (setting.get)(self) * factor);
        }
        next
    }

    /// The places of a surface, if marks stay whole.
    pub fn places(&self, surface: &Surface) -> Option<Arc<BallPlaces>> {
        self.on.then(|| surface.ball_places(&self.chunk_settings()))
    }

    fn chunk_settings(&self) -> ChunkSettings {
        ChunkSettings {
            ball_px: self.size,
            chunk_px: self.chunk,
            follow: self.follow,
            seam_px: self.seams,
        }
    }
}

impl Shading {
    /// The tiles that may look different from those of an earlier version whose balls were painted
    /// on since; `None` if more is different, or if it may be all of them.
    pub fn repainted_tiles(&self, old: &Self, scene: &Scene) -> Option<Vec<TileAt>> {
        // How strong scaling is depends on the brightest place of the ball.
        if !self.has_strokes() || self.specular.is_scaled() {
            return None;
        }
        let of_old = Self {
            sphere: old.sphere.clone(),
            sphere_concave: old.sphere_concave.clone(),
            ..self.clone()
        };
        let mut cells = BallCells::none();
        for hollows in [false, true] {
            match (old.ball(hollows), self.ball(hollows)) {
                (None, None) => {}
                (Some(old), Some(new)) => {
                    mark_repainted(&old.picture, &new.picture, self.strokes.size, &mut cells)?;
                }
                _ => return None,
            }
        }
        let surface = scene.surface.as_ref().filter(|_| of_old == *old)?;
        Some(surface.tiles_showing_ball(&self.strokes.chunk_settings(), &cells))
    }
}

/// Marks where two pictures of a ball look different at a diameter of so many px; `None` if they
/// are of different sizes.
fn mark_repainted(
    old: &Picture,
    new: &Picture,
    diameter_px: f32,
    cells: &mut BallCells,
) -> Option<()> {
    /// Texels that a place reads beside it, and those of the rim that go on beyond it.
    const REACH: f32 = 4.0;
    let size = new.size;
    if old.size != size {
        return None;
    }
    let (w, h) = (size.width as usize, size.height as usize);
    let mut own = BallCells::none();
    for i in (0..w * h).filter(|i| old.linear_texel(*i) != new.linear_texel(*i)) {
        let (x, y) = ((i % w) as f32 + 0.5, (i / w) as f32 + 0.5);
        own.mark([x / w as f32, y / h as f32]);
    }
    let texels = LitSphere::halvings(size, diameter_px).exp2() * REACH;
    let cell = w.min(h) as f32 / BallCells::SIDE as f32;
    cells.add(&own.grown((texels / cell).ceil() as usize + 1));
    Some(())
}
