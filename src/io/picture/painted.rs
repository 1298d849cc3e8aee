//! Any readable picture as the tiles of a paint layer, a few rows at a time if its format allows,
//! so that a large picture is never in memory as a whole next to its tiles. Floor 5. Not here: what
//! is done where 16 bits do not fit (`sixteen_bit_paint`).

use super::light;
use crate::bitmap::Bitmap;
use crate::exr::{ExrFile, ExrPass};
use crate::math::Size;
use crate::pixels::{self, Painted};
use crate::raster::TileGrid;
use crate::{Budget, Result, svg};
use std::path::Path;

/// Decodes a picture as [`decode`](super::decode) does, its corner at a canvas pixel: paint of 16
/// bits a channel where the file has more than 8 and the budget allows it.
pub fn decode_paint(file: &Path, bytes: &[u8], x: i32, y: i32, budget: &Budget) -> Result<Painted> {
    if ExrFile::is_exr(bytes) {
        let exr = ExrFile::open(file, bytes, budget)?;
        return of_light(file, &exr, light::choose_pass(file, &exr)?, x, y, budget);
    }
    if svg::is_svg(bytes) {
        return svg::decode_paint(file, bytes, x, y, budget);
    }
    if let Some(painted) = pixels::decode_tiles(bytes, x, y, budget) {
        return Ok(painted);
    }
    let bitmap = super::decode_upright(file, bytes, budget)?;
    let warning = bitmap.warning;
    let gathered = GatheredTiles::new(
        file,
        budget,
        Size::new(bitmap.image.width(), bitmap.image.height()),
        [x, y],
    );
    let painted = match &bitmap.image {
        image if super::is_sixteen_bits(image) => gathered.of_sixteen_bits(&bitmap)?,
        image if super::is_light(image) => gathered.of_floats(&bitmap)?,
        _ => {
            let picture = super::picture_of(file, bitmap, budget)?;
            Painted { size: picture.size, tiles: super::to_tiles(&picture, x, y), warning: None }
        }
    };
    Ok(Painted { warning, ..painted })
}

/// A layer of an EXR.
pub fn of_light(
    file: &Path,
    exr: &ExrFile,
    pass: &ExrPass,
    x: i32,
    y: i32,
    budget: &Budget,
) -> Result<Painted> {
    let size = exr.size();
    budget.room(
        file,
        &format!("a layer of {size} pixels"),
        size.area() as u64 * budget.paint_bytes(),
    )?;
    let mut gathered = GatheredTiles::new(file, budget, size, [x, y]);
    let conversion = light::conversion(exr, budget);
    light::in_bands(file, exr, pass, |band| {
        let straight = |texel: &[f32; 4]| light::convert(light::straight(*texel), conversion);
        let texels: Vec<[f32; 4]> = band.iter().map(straight).collect();
        gathered.add(|[w, h], [x, y]| TileGrid::from_light(&texels, w, h, x, y), texels.len())
    })?;
    Ok(gathered.finish())
}

/// The tiles of a picture whose rows are read from the top.
struct GatheredTiles<'a> {
    file: &'a Path,
    budget: &'a Budget,
    size: Size,
    x: i32,
    /// Where the next rows belong.
    y: i32,
    /// What is in memory besides them.
    beside_bytes: u64,
    tiles: TileGrid,
}

impl<'a> GatheredTiles<'a> {
    fn new(file: &'a Path, budget: &'a Budget, size: Size, [x, y]: [i32; 2]) -> Self {
        Self { file, budget, size, x, y, beside_bytes: 0, tiles: TileGrid::default() }
    }

    /// The next rows, which have so many texels; `cut` makes tiles of them, given their width and
    /// height and their corner.
    fn add(
        &mut self,
        cut: impl FnOnce([usize; 2], [i32; 2]) -> TileGrid,
        texels: usize,
    ) -> Result<()> {
        let width = self.size.width as usize;
        let rows = texels / width.max(1);
        let tiles = cut([width, rows], [self.x, self.y]);
        self.tiles.join(&if self.budget.sixteen_bit_paint { tiles } else { tiles.rounded() });
        self.y = self.y.saturating_add(rows as i32);
        self.ask(self.tiles.bytes() as u64)
    }

    fn ask(&self, bytes: u64) -> Result<()> {
        let what = format!("a picture of {} pixels of more than 8 bits a channel", self.size);
        self.budget.room(self.file, &what, self.beside_bytes.saturating_add(bytes))
    }

    fn finish(self) -> Painted {
        Painted { size: self.size, tiles: self.tiles, warning: None }
    }

    /// Integers of 16 bits, through their profile if there is one.
    fn of_sixteen_bits(mut self, bitmap: &Bitmap) -> Result<Painted> {
        self.beside_bytes = bitmap.image.as_bytes().len() as u64;
        let mut profiled = None;
        if let Some(icc) = bitmap.icc.as_deref() {
            let bytes = (size_of::<[u16; 4]>() * self.size.area()) as u64;
            self.ask(bytes)?;
            profiled = super::convert_by_profile(&bitmap.image, icc);
            self.beside_bytes += if profiled.is_some() { bytes } else { 0 };
        }
        let mut add = |texels: &[[u16; 4]]| {
            self.add(|[w, h], [x, y]| TileGrid::from_straight16(texels, w, h, x, y), texels.len())
        };
        match profiled {
            Some(texels) => texels
                .chunks(super::STRIP_ROWS as usize * bitmap.image.width() as usize)
                .try_for_each(add)?,
            None => super::strips(&bitmap.image)
                .try_for_each(|strip| add(strip.into_rgba16().as_raw().as_chunks().0))?,
        }
        Ok(self.finish())
    }

    /// Linear light, through its profile if there is one.
    fn of_floats(mut self, bitmap: &Bitmap) -> Result<Painted> {
        self.beside_bytes = bitmap.image.as_bytes().len() as u64;
        for strip in super::strips(&bitmap.image) {
            let strip = strip.into_rgba32f();
            let texels = strip.as_raw().as_chunks().0;
            let profiled =
                bitmap.icc.as_deref().and_then(|icc| super::light_through_profile(texels, icc));
            let texels = profiled.as_deref().unwrap_or(texels);
            self.add(|[w, h], [x, y]| TileGrid::from_light(texels, w, h, x, y), texels.len())?;
        }
        Ok(self.finish())
    }
}
