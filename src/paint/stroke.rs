//! The brush tool: a stroke is a list of dabs, each a footprint bent around its own centre (SF sec. 5.2, fig. 7).
//! Floor 3.

use super::brush::Brush;
use super::scene::Scene;
use crate::math::{Rect, Vec2, srgb::Color};
use crate::raster::{Tile, TileAt};
use crate::surface::Operator;
use std::sync::Arc;

/// One reading of the pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Canvas px.
    pub at: Vec2,
    /// `[0, 1]`.
    pub pressure: f32,
    /// Degrees from upright, right and down positive.
    pub tilt: Vec2,
    /// Since the stroke began.
    pub time_secs: f32,
}

impl Sample {
    /// A sample as a mouse gives it: full pressure, upright.
    pub fn at(at: Vec2) -> Self {
        Self { at, pressure: 1.0, tilt: Vec2::ZERO, time_secs: 0.0 }
    }
}

/// One stroke of a stroke layer. Never changed once made: the dabs found from it are kept beside it.
#[derive(Clone)]
pub struct Stroke {
    brush: Brush,
    operator: Operator,
    color: Color,
    samples: Vec<Sample>,
}

impl Stroke {
    pub fn new(brush: Brush, operator: Operator, color: Color, samples: Vec<Sample>) -> Self {
        Self { brush, operator, color, samples }
    }
    pub fn brush(&self) -> &Brush {
        &self.brush
    }
    pub fn operator(&self) -> Operator {
        self.operator
    }
    /// The colour of one-colour tips; of a stamp only its alpha counts.
    pub fn color(&self) -> Color {
        self.color
    }
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }
    /// The pixels that the stroke can touch; never fewer.
    pub fn bounds(&self, scene: &Scene) -> Rect {
        scene.size.rect()
    }
}

/// One tile of a stroke layer, the first stroke lowest. `None` where it is transparent.
pub fn render_tile(_strokes: &[Arc<Stroke>], _scene: &Scene, _at: TileAt) -> Option<Tile> {
    None
}
