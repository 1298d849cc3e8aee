//! A decoded picture: what a file held, before it becomes a texture, a tip or an environment.
//! Floor 1. Reading files is `io::picture`'s work.

use super::Asset;
use super::tile::sixteen_bit::byte_of;
use crate::math::{Size, Vec2, srgb, vec2};
use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// Straight (not premultiplied) RGBA, row by row, the top row first. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Its sides, px.
    pub size: Size,
    /// One for each pixel.
    pub texels: Texels,
    /// What the bytes were rounded from, if a file holds 16 bits a channel: straight, encoded, one
    /// for each texel.
    pub texels16: Option<Arc<[[u16; 4]]>>,
    /// The file it was decoded from, so that a project can keep the original bytes; `None` for a
    /// picture made here.
    pub encoded: Option<Asset>,
    /// What it was drawn from, if that can be drawn larger.
    pub drawing: Option<Arc<dyn VectorDrawing>>,
}

/// Something without pixels of its own, such as an SVG: its picture is one of its sizes.
pub trait VectorDrawing: fmt::Debug + Send + Sync {
    /// Its own sides, px.
    fn size(&self) -> Vec2;
    /// Draws it with sides of so many pixels: straight, encoded bytes, one for each pixel; `None`
    /// where they cannot be had.
    fn draw(&self, size: Size) -> Option<Vec<[u8; 4]>>;
    /// What it is, for the code that made it.
    fn as_any(&self) -> &dyn Any;
}

/// The two kinds of light a file can hold.
#[derive(Clone, Debug)]
pub enum Texels {
    /// Display-referred: sRGB-encoded bytes.
    Srgb8(Arc<[[u8; 4]]>),
    /// Scene-referred (EXR, HDR): linear light, finite and not negative, alpha in `[0, 1]`.
    Linear(Arc<[[f32; 4]]>),
}

impl PartialEq for Texels {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Texels::Srgb8(a), Texels::Srgb8(b)) => Arc::ptr_eq(a, b) || a == b,
            (Texels::Linear(a), Texels::Linear(b)) => Arc::ptr_eq(a, b) || a == b,
            _ => false,
        }
    }
}

impl PartialEq for Picture {
    /// The same texels, from any file.
    fn eq(&self, other: &Self) -> bool {
        let is_same16 = match (&self.texels16, &other.texels16) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b) || a == b,
            (None, None) => true,
            _ => false,
        };
        self.size == other.size && self.texels == other.texels && is_same16
    }
}

impl Picture {
    /// The longest side that is read by default, px.
    pub const LONGEST_SIDE_PX: u32 = 32_768;
    /// The longest side to which a drawing is drawn again, px.
    pub const LONGEST_DRAWN_PX: u32 = 16_384;
    /// The most pixels that are read by default.
    pub const MOST_PX: usize = 268_435_456;

    /// `None` unless there is one texel per pixel and at least one pixel.
    pub fn srgb8(size: Size, texels: Vec<[u8; 4]>) -> Option<Self> {
        Self::of_bytes(size, texels.into())
    }

    /// As [`Picture::srgb8`], of texels that something else may share.
    pub fn of_bytes(size: Size, texels: Arc<[[u8; 4]]>) -> Option<Self> {
        (size.area() > 0 && texels.len() == size.area())
            .then(|| Self::of_texels(size, Texels::Srgb8(texels)))
    }

    /// As [`Picture::srgb8`], of 16 bits a channel: its bytes are these, rounded.
    pub fn srgb16(size: Size, texels16: Vec<[u16; 4]>) -> Option<Self> {
        let bytes = texels16.iter().map(|texel| texel.map(byte_of)).collect();
        Some(Self { texels16: Some(texels16.into()), ..Self::srgb8(size, bytes)? })
    }

    /// As [`Picture::srgb8`]; NaN and negative light become 0, infinite light the largest half
    /// float.
    pub fn linear(size: Size, mut texels: Vec<[f32; 4]>) -> Option<Self> {
        const HALF_MAX: f32 = 65504.0;
        for [r, g, b, a] in &mut texels {
            for c in [r, g, b] {
                *c = c.max(0.0).min(HALF_MAX);
            }
            *a = a.max(0.0).min(1.0);
        }
        (size.area() > 0 && texels.len() == size.area())
            .then(|| Self::of_texels(size, Texels::Linear(texels.into())))
    }

    fn of_texels(size: Size, texels: Texels) -> Self {
        Self { size, texels, texels16: None, encoded: None, drawing: None }
    }

    /// The sides at which it is seen at 100 %, px: of a drawing its own, however large it was drawn.
    pub fn own_size(&self) -> Vec2 {
        let pixels = vec2(self.size.width as f32, self.size.height as f32);
        self.drawing.as_ref().map_or(pixels, |drawing| drawing.size())
    }

    /// The same drawing with sides `times` as long; `None` for pictures that have only the pixels
    /// they have, and where these would be too many.
    pub fn enlarged(&self, times: u32) -> Option<Self> {
        let drawing = self.drawing.as_ref()?;
        let side = |side: u32| side.checked_mul(times).filter(|s| *s <= Self::LONGEST_DRAWN_PX);
        let size = Size::new(side(self.size.width)?, side(self.size.height)?);
        let texels = drawing.draw(size)?;
        Some(Self { encoded: self.encoded.clone(), ..Self::srgb8(size, texels)? })
    }

    /// It holds more than 8 bits a channel.
    pub fn is_16_bit(&self) -> bool {
        self.texels16.is_some() || matches!(self.texels, Texels::Linear(_))
    }

    /// Where its texels are in memory: the same for pictures that share them.
    pub fn place(&self) -> usize {
        match &self.texels {
            Texels::Srgb8(texels) => texels.as_ptr() as usize,
            Texels::Linear(texels) => texels.as_ptr() as usize,
        }
    }

    /// Bytes that its texels take.
    pub fn bytes(&self) -> usize {
        let texel = match &self.texels {
            Texels::Srgb8(_) => size_of::<[u8; 4]>(),
            Texels::Linear(_) => size_of::<[f32; 4]>(),
        };
        let texels16 = self.texels16.as_ref().map_or(0, |_| size_of::<[u16; 4]>());
        self.size.area() * (texel + texels16)
    }

    /// Linear light of one texel, straight alpha.
    pub fn linear_at(&self, x: usize, y: usize) -> [f32; 4] {
        self.linear_texel(y * self.size.width as usize + x)
    }

    /// The same by the texel's number, row by row.
    #[inline(always)]
    pub fn linear_texel(&self, i: usize) -> [f32; 4] {
        match &self.texels {
            Texels::Linear(t) => t[i],
            Texels::Srgb8(t) => {
                let [r, g, b, a] = t[i];
                [srgb::decode_u8(r), srgb::decode_u8(g), srgb::decode_u8(b), f32::from(a) / 255.0]
            }
        }
    }
}
