//! The pictures of a tip's file, as Krita sees them. Floor 5. Not here: what becomes of them (`tip`).

use super::super::{abr, gbr, gih};
use crate::math::{Size, Vec2, vec2};
use crate::paint::tip::HoseRank;
use crate::raster::Picture;
use crate::raster::picture::Texels;
use crate::{Budget, Error, Result, picture};
use std::path::Path;

/// A tip's pictures.
pub struct TipFile {
    pub pictures: Vec<TipPicture>,
    /// How one of several is chosen.
    pub ranks: Option<Vec<HoseRank>>,
    pub notes: Vec<String>,
}

/// One picture of a tip.
pub struct TipPicture {
    pub picture: Picture,
    /// Its opaque grays are coverage; else dark covers.
    pub is_coverage: bool,
    /// Its own sides, px, which may be others than those of a drawing's pixels.
    own_px: Vec2,
}

impl TipPicture {
    fn new(picture: Picture, is_coverage: bool) -> Self {
        let own_px = vec2(picture.size.width as f32, picture.size.height as f32);
        Self { picture, is_coverage, own_px }
    }

    fn texels(&self) -> &[[u8; 4]] {
        match &self.picture.texels {
            Texels::Srgb8(texels) => texels,
            Texels::Linear(_) => &[],
        }
    }

    /// It holds more than grays.
    pub fn is_colored(&self) -> bool {
        !self.is_coverage && self.texels().iter().any(|[r, g, b, _]| r != g || g != b)
    }

    /// The mean gray of what is not transparent.
    pub fn mean_gray(&self) -> f32 {
        let add = |(sum, weight): (f64, f64), texel: &[u8; 4]| {
            let alpha = f64::from(texel[3]);
            (sum + alpha * f64::from(gray(texel)), weight + alpha)
        };
        let (sum, weight) = self.texels().iter().fold((0.0, 0.0), add);
        if weight > 0.0 { (sum / weight) as f32 } else { 127.0 }
    }
}

impl TipFile {
    /// Of one picture.
    fn single(picture: TipPicture) -> Self {
        Self { pictures: vec![picture], ranks: None, notes: Vec::new() }
    }

    /// The longest sides, px.
    pub fn own_size(&self) -> Vec2 {
        self.pictures.iter().fold(Vec2::ONE, |size, picture| size.max(picture.own_px))
    }

    /// Some of it is transparent.
    pub fn has_alpha(&self) -> bool {
        self.pictures.iter().any(|tip| tip.texels().iter().any(|texel| texel[3] < 255))
    }

    /// The pixels of all pictures.
    pub fn area_px(&self) -> u64 {
        self.pictures.iter().map(|tip| tip.picture.size.area() as u64).sum()
    }
}

/// Reads a tip's file: a brush or a hose of GIMP, or a picture.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<TipFile> {
    let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if gbr::is_gbr(bytes) || extension == "gbr" {
        let mut cursor = crate::psd::cursor::ByteCursor::new(bytes);
        let brush = gbr::next(file, &mut cursor, budget)?;
        return Ok(TipFile::single(TipPicture::new(brush.picture, brush.is_coverage)));
    }
    if extension == "gih" {
        let hose = gih::read_cells(file, bytes, budget)?;
        let cells = hose.cells.into_iter();
        let pictures = cells.map(|cell| TipPicture::new(cell.picture, cell.is_coverage)).collect();
        return Ok(TipFile { pictures, ranks: Some(hose.ranks), notes: hose.notes });
    }
    let picture = picture::decode(file, bytes, budget)?;
    if matches!(picture.texels, Texels::Linear(_)) {
        return Err(Error::unsupported_file(file, "a tip of light beyond white"));
    }
    let Some(drawing) = picture.drawing.clone() else {
        return Ok(TipFile::single(TipPicture { ..TipPicture::new(bare(picture), false) }));
    };
    let own_px = drawing.size().max(Vec2::ONE);
    let size = drawn_size(own_px);
    let drawn = drawing.draw(size).and_then(|texels| Picture::srgb8(size, texels));
    let picture = drawn.unwrap_or_else(|| bare(picture));
    Ok(TipFile::single(TipPicture { own_px, ..TipPicture::new(picture, false) }))
}

/// Without the file that it was read from: the tip is another picture.
fn bare(picture: Picture) -> Picture {
    Picture { encoded: None, drawing: None, ..picture }
}

/// Pixels of a drawing that is a tip: enough for large ones.
fn drawn_size(own_px: Vec2) -> Size {
    const LONGEST_PX: f32 = 1024.0;
    let scale = LONGEST_PX / own_px.max_element();
    let side = |v: f32| (v * scale).round().max(1.0).min(LONGEST_PX) as u32;
    Size::new(side(own_px.x), side(own_px.y))
}

/// A tip of one of Photoshop's collections; `number` counts from 1.
pub fn decode_sampled(
    file: &Path,
    bytes: &[u8],
    number: usize,
    budget: &Budget,
) -> Result<TipFile> {
    let tips = abr::read_tips(file, bytes, budget)?;
    let count = tips.len();
    let picture = number.checked_sub(1).and_then(|i| tips.into_iter().nth(i)).ok_or_else(|| {
        Error::decode(file, format!("it has {count} sampled tips and no tip {number}"))
    })?;
    Ok(TipFile::single(TipPicture::new(picture, true)))
}

/// Krita's gray of a color.
pub fn gray(&[r, g, b, _]: &[u8; 4]) -> u8 {
    ((11 * u32::from(r) + 16 * u32::from(g) + 5 * u32::from(b)) / 32) as u8
}
