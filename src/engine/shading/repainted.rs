//! Where a figure looks different after its ball was painted on, so that a dab costs what it changes.
//! Floor 3. Not here: which pixels show a place of the ball (`surface::chunks`).

use super::{LitSphere, Shading};
use crate::raster::picture::Texels;
use crate::raster::{Picture, TileAt};
use crate::surface::Scene;
use crate::surface::chunks::BallCells;

impl Shading {
    /// The tiles that may look different from those of an earlier version whose balls were painted
    /// on since; `None` if more is different, or if it may be all of them.
    pub fn repainted_tiles(&self, old: &Self, scene: &Scene) -> Option<Vec<TileAt>> {
        // How strong scaling is depends on the brightest place of the ball.
        if !self.has_strokes() || self.specular.is_scaled() || self.has_ground_shadow() {
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
    let has_bytes_alone = old.texels16.is_none() && new.texels16.is_none();
    let mut own = BallCells::none();
    let is_other = |i: &usize| match (&old.texels, &new.texels) {
        // Bytes are compared sooner than light.
        (Texels::Srgb8(a), Texels::Srgb8(b)) if has_bytes_alone => a[*i] != b[*i],
        _ => old.linear_texel(*i) != new.linear_texel(*i),
    };
    for i in (0..w * h).filter(is_other) {
        let (x, y) = ((i % w) as f32 + 0.5, (i / w) as f32 + 0.5);
        own.mark([x / w as f32, y / h as f32]);
    }
    let texels = LitSphere::halvings(size, diameter_px).exp2() * REACH;
    let cell = w.min(h) as f32 / BallCells::SIDE as f32;
    cells.add(&own.grown((texels / cell).ceil() as usize + 1));
    Some(())
}
