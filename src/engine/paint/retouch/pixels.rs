//! The pixels of a layer while they are retouched: f32 where they changed, the layer's own
//! elsewhere. Floor 3.

use crate::math::{Vec2, vec2};
use crate::raster::{PlanarTile, TILE, Tile, TileAt, TileGrid};
use std::collections::HashMap;
use std::sync::Arc;

/// A clone shares its tiles until one is set.
#[derive(Clone)]
pub(super) struct RetouchPixels {
    base: TileGrid,
    tiles: HashMap<TileAt, Arc<PlanarTile>>,
}

impl RetouchPixels {
    pub fn new(base: TileGrid) -> Self {
        Self { base, tiles: HashMap::new() }
    }

    /// A tile to be worked on.
    pub fn tile(&self, at: TileAt) -> PlanarTile {
        if let Some(tile) = self.tiles.get(&at) {
            return PlanarTile::clone(tile);
        }
        PlanarTile::of_tile(self.base.tile(at).map(|tile| &**tile))
    }

    pub fn set(&mut self, at: TileAt, tile: PlanarTile) {
        self.tiles.insert(at, Arc::new(tile));
    }

    /// A tile as the layer stores it.
    pub fn stored_tile(&self, at: TileAt) -> Option<Arc<Tile>> {
        match self.tiles.get(&at) {
            Some(tile) => tile.to_tile_over(self.base.tile(at).map(|tile| &**tile)).map(Arc::new),
            None => self.base.tile(at).cloned(),
        }
    }

    pub fn reader(&self) -> PixelReader<'_> {
        PixelReader { retouched: Some(self), base: &self.base, tile: None }
    }
}

/// Reads pixels; consecutive reads from one tile need no lookup.
pub(super) struct PixelReader<'p> {
    retouched: Option<&'p RetouchPixels>,
    base: &'p TileGrid,
    tile: Option<(TileAt, TileSource<'p>)>,
}

#[derive(Clone, Copy)]
enum TileSource<'p> {
    Nothing,
    Dry(&'p Tile),
    Wet(&'p PlanarTile),
}

impl<'p> PixelReader<'p> {
    pub fn of(base: &'p TileGrid) -> Self {
        Self { retouched: None, base, tile: None }
    }

    /// A premultiplied pixel; transparent if there is none.
    pub fn pixel(&mut self, x: i32, y: i32) -> [f32; 4] {
        let at = TileAt::of_pixel(x, y);
        let held = match self.tile {
            Some((known, held)) if known == at => held,
            _ => self.hold(at),
        };
        let (x, y) = (x.rem_euclid(TILE as i32) as usize, y.rem_euclid(TILE as i32) as usize);
        match held {
            TileSource::Nothing => [0.0; 4],
            TileSource::Dry(tile) if tile.is_16_bit() => {
                tile.pixel16(x, y).map(|v| f32::from(v) / 65535.0)
            }
            TileSource::Dry(tile) => {
                let bytes =
                    tile.bytes().as_chunks::<4>().0.get(y * TILE + x).copied().unwrap_or_default();
                bytes.map(|b| f32::from(b) / 255.0)
            }
            TileSource::Wet(tile) => tile.rows().get(y).map_or([0.0; 4], |row| row.pixel(x)),
        }
    }

    fn hold(&mut self, at: TileAt) -> TileSource<'p> {
        let held = match (
            self.retouched.and_then(|retouched| retouched.tiles.get(&at)),
            self.base.tile(at),
        ) {
            (Some(tile), _) => TileSource::Wet(tile),
            (None, Some(tile)) => TileSource::Dry(tile),
            (None, None) => TileSource::Nothing,
        };
        self.tile = Some((at, held));
        held
    }

    /// The color at a canvas point, interpolated from the four pixels around it.
    pub fn sample(&mut self, at: Vec2) -> [f32; 4] {
        let corner = (at - 0.5).floor();
        let t = at - 0.5 - corner;
        let (x, y) = (corner.x as i32, corner.y as i32);
        let mut sum = [0.0; 4];
        let weights = [
            (0, 0, vec2(1.0 - t.x, 1.0 - t.y)),
            (1, 0, vec2(t.x, 1.0 - t.y)),
            (0, 1, vec2(1.0 - t.x, t.y)),
            (1, 1, t),
        ];
        for (dx, dy, weight) in weights {
            let weight = weight.x * weight.y;
            if weight > 0.0 {
                let pixel = self.pixel(x.saturating_add(dx), y.saturating_add(dy));
                sum = std::array::from_fn(|c| sum[c] + weight * pixel[c]);
            }
        }
        sum
    }
}
