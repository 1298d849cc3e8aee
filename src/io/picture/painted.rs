//! Any readable picture as the tiles of a paint layer, a few rows at a time where its format lets them be had, so that
//! a large picture is never in memory as a whole beside its tiles. Floor 5.

use super::light;
use crate::exr::{ExrFile, ExrPass};
use crate::math::Size;
use crate::pixels::{self, Painted};
use crate::raster::{Picture, TileGrid};
use crate::{Budget, Error, Result};
use std::path::Path;

/// Decodes a picture as [`decode`](super::decode) does, its corner at a canvas pixel.
pub fn painted(file: &Path, bytes: &[u8], x: i32, y: i32, budget: &Budget) -> Result<Painted> {
    if ExrFile::is_exr(bytes) {
        let exr = ExrFile::open(file, bytes, budget)?;
        return of_light(file, &exr, light::chosen(file, &exr)?, x, y, budget);
    }
    if let Some(painted) = pixels::decode_tiles(bytes, x, y, budget) {
        return Ok(painted);
    }
    let picture = super::decode_bitmap(file, bytes, budget, super::KeptDepth::Bytes)?;
    Ok(Painted { size: picture.size, tiles: super::to_tiles(&picture, x, y) })
}

/// A layer of an EXR.
pub fn of_light(file: &Path, exr: &ExrFile, pass: &ExrPass, x: i32, y: i32, budget: &Budget) -> Result<Painted> {
    let size = exr.size();
    budget.room(file, &format!("a layer of {size} pixels"), size.area() as u64 * 4)?;
    let mut tiles = TileGrid::default();
    let mut top = y;
    light::in_bands(file, exr, pass, |band| {
        let rows = Size::new(size.width, (band.len() / size.width as usize) as u32);
        let texels = band.iter().map(|&texel| light::straight(texel)).collect();
        let band = Picture::linear(rows, texels).ok_or_else(|| Error::decode(file, "the picture has no pixels"))?;
        tiles.join(&super::to_tiles(&band, x, top));
        top = top.saturating_add(rows.height as i32);
        Ok(())
    })?;
    Ok(Painted { size, tiles })
}
