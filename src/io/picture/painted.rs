//! Any readable picture as the tiles of a paint layer, a few rows at a time if its format allows, so that a large
//! picture is never in memory as a whole next to its tiles. Floor 5.

use super::light;
use crate::bitmap::Bitmap;
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
    let bitmap = super::upright(file, bytes, budget)?;
    if super::is_sixteen_bits(&bitmap.image) {
        return of_sixteen_bits(file, &bitmap, x, y, budget);
    }
    let picture = super::picture_of(file, bitmap, budget)?;
    Ok(Painted { size: picture.size, tiles: super::to_tiles(&picture, x, y) })
}

/// Integers of 16 bits, through their profile if there is one; else a few rows at a time.
fn of_sixteen_bits(file: &Path, bitmap: &Bitmap, x: i32, y: i32, budget: &Budget) -> Result<Painted> {
    let size = Size::new(bitmap.image.width(), bitmap.image.height());
    let (w, decoded) = (size.width as usize, bitmap.image.as_bytes().len() as u64);
    let room = |bytes: u64| budget.room(file, &format!("a picture of {size} pixels of 16 bits a channel"), bytes);
    let mut tiles = TileGrid::default();
    if let Some(icc) = bitmap.icc.as_deref() {
        room(decoded + 8 * size.area() as u64)?;
        if let Some(texels) = super::through_profile(&bitmap.image, icc) {
            return Ok(Painted { size, tiles: TileGrid::from_straight_deep(&texels, w, size.height as usize, x, y) });
        }
    }
    let mut top = y;
    for strip in super::strips(&bitmap.image) {
        let (rows, texels) = (strip.height(), strip.into_rgba16().into_raw());
        tiles.join(&TileGrid::from_straight_deep(texels.as_chunks().0, w, rows as usize, x, top));
        room(decoded + tiles.bytes() as u64)?;
        top = top.saturating_add(rows as i32);
    }
    Ok(Painted { size, tiles })
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
