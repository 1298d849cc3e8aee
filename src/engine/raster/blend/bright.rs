//! Blending light that is brighter than white, which pictures composed for HDR files keep. Floor 1.

use super::rows::load;
use super::{BlendMode, Mix, TileCoverage, TilePaint};
use crate::raster::planar::{PixelRow, PlanarTile};
use crate::raster::tile::TILE;

impl BlendMode {
    /// Its formula also holds for light brighter than white.
    fn is_valid_above_white(self) -> bool {
        matches!(self, BlendMode::Normal | BlendMode::Multiply)
    }
}

impl PlanarTile {
    /// As [`PlanarTile::blend`], where colors may be above their alpha. Formulas that hold only up
    /// to white see both sides clipped; the backdrop's light beyond white then shows through as far
    /// as the paint leaves it.
    pub fn blend_bright(&mut self, mix: Mix, paint: TilePaint<'_>, coverage: &TileCoverage) {
        if mix.mode.is_valid_above_white() && !mix.linear {
            return self.blend(mix, paint, coverage);
        }
        let mut excess = self.clone();
        self.clip_to_white();
        for (excess, clipped) in excess.rows_mut().iter_mut().zip(self.rows()) {
            for (v, clipped) in
                excess.rgb.as_flattened_mut().iter_mut().zip(clipped.rgb.as_flattened())
            {
                *v -= clipped;
            }
        }
        let own = match paint {
            TilePaint::Planar(tile) => {
                let mut tile = tile.clone();
                tile.clip_to_white();
                Some(tile)
            }
            _ => None,
        };
        let paint = own.as_ref().map_or(paint, TilePaint::Planar);
        self.blend(mix, paint, coverage);
        for (y, (row, excess)) in self.rows_mut().iter_mut().zip(excess.rows()).enumerate() {
            let mut source = PixelRow::TRANSPARENT;
            load(&mut source, &paint, y, coverage);
            for (channel, excess) in row.rgb.iter_mut().zip(&excess.rgb) {
                for x in 0..TILE {
                    channel[x] += excess[x] * (1.0 - source.a[x]).max(0.0);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::tile::transparent_f32;

    fn tile(pixel: [f32; 4]) -> PlanarTile {
        let mut pixels = transparent_f32();
        pixels.fill(pixel);
        PlanarTile::from_bright(&pixels)
    }

    #[test]
    fn within_white_it_is_the_usual_blending_to_the_bit() {
        for (mode, ..) in BlendMode::ALL {
            for linear in [false, true] {
                let mix = Mix { mode, linear, ..Mix::default() };
                let (mut a, paint) = (tile([0.3, 0.5, 0.1, 0.6]), tile([0.2, 0.05, 0.4, 0.5]));
                let mut b = a.clone();
                let coverage = TileCoverage::uniform(0.7);
                a.blend(mix, TilePaint::Planar(&paint), &coverage);
                b.blend_bright(mix, TilePaint::Planar(&paint), &coverage);
                assert_eq!(a.rows()[5].pixel(7), b.rows()[5].pixel(7), "{mode:?}");
            }
        }
    }

    #[test]
    fn light_beyond_white_stays_beneath_nothing_and_fades_beneath_paint_of_every_mode() {
        for (mode, ..) in
            BlendMode::ALL.into_iter().filter(|(mode, ..)| *mode != BlendMode::Dissolve)
        {
            let mix = Mix { mode, ..Mix::default() };
            let after = |alpha: f32| {
                let mut sun = tile([4.0, 2.0, 1.5, 1.0]);
                let paint = TilePaint::Solid([0.5 * alpha, 0.5 * alpha, 0.5 * alpha, alpha]);
                sun.blend_bright(mix, paint, &TileCoverage::FULL);
                sun.rows()[0].pixel(0)
            };
            assert_eq!(after(0.0), [4.0, 2.0, 1.5, 1.0], "{mode:?}");
            let (little, more) = (after(0.1), after(0.6));
            assert!(
                little[0] > 3.0 && little[0] >= more[0] && more.iter().all(|v| v.is_finite()),
                "{mode:?} {more:?}"
            );
        }
    }
}
