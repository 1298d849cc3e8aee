//! A lit sphere whose brush marks stay whole: its settings. Floor 3. Not here: which place of the
//! ball each pixel shows (`surface::chunks`), its colors (`sphere`).

use crate::math::number_settings::number_settings;
use crate::surface::Surface;
use crate::surface::chunks::{BallPlaces, ChunkSettings};
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

    /// How its places are found.
    pub fn chunk_settings(&self) -> ChunkSettings {
        ChunkSettings {
            ball_px: self.size,
            chunk_px: self.chunk,
            follow: self.follow,
            seam_px: self.seams,
        }
    }
}
