//! Reads numbers and sections from bytes in order, big-endian, never beyond the end.
//! Floor 5.

use crate::math::Rect;

/// A position in bytes. Each read is `None` if it would go beyond the end.
#[derive(Clone, Copy)]
pub struct ByteCursor<'a> {
    rest: &'a [u8],
}

impl<'a> ByteCursor<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }

    pub fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(n)?;
        self.rest = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    pub fn u8(&mut self) -> Option<u8> {
        self.array::<1>().map(|[byte]| byte)
    }

    pub fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_be_bytes)
    }

    pub fn i16(&mut self) -> Option<i16> {
        self.array().map(i16::from_be_bytes)
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_be_bytes)
    }

    pub fn i32(&mut self) -> Option<i32> {
        self.array().map(i32::from_be_bytes)
    }

    pub fn key(&mut self) -> Option<[u8; 4]> {
        self.array()
    }

    /// A length: four bytes, or eight where the file is large.
    pub fn length(&mut self, large: bool) -> Option<usize> {
        if large {
            usize::try_from(u64::from_be_bytes(self.array()?)).ok()
        } else {
            usize::try_from(self.u32()?).ok()
        }
    }

    /// A section preceded by its length.
    pub fn section(&mut self, large: bool) -> Option<ByteCursor<'a>> {
        let length = self.length(large)?;
        self.take(length).map(ByteCursor::new)
    }

    /// Top, left, bottom, right.
    pub fn rect(&mut self) -> Option<Rect> {
        let (y0, x0, y1, x1) = (self.i32()?, self.i32()?, self.i32()?, self.i32()?);
        Some(Rect::new(x0, y0, x1, y1))
    }

    /// A length byte and so many bytes of text, padded so that both together fill a multiple of
    /// `pad`.
    pub fn pascal(&mut self, pad: usize) -> Option<&'a [u8]> {
        let length = usize::from(self.u8()?);
        let text = self.take(length)?;
        let filled = (1 + length).next_multiple_of(pad) - (1 + length);
        self.take(filled)?;
        Some(text)
    }

    /// A number of 16-bit letters, then they; without what ends them, and without what cannot be
    /// shown.
    pub fn unicode(&mut self) -> Option<String> {
        let count = usize::try_from(self.u32()?).ok()?;
        let letters = self.take(count.checked_mul(2)?)?;
        let letters: Vec<u16> =
            letters.as_chunks().0.iter().map(|pair| u16::from_be_bytes(*pair)).collect();
        Some(shown_text(&String::from_utf16_lossy(&letters)))
    }

    pub fn f64(&mut self) -> Option<f64> {
        self.array().map(f64::from_be_bytes)
    }
}

/// A text as it can be shown: no control characters, no blanks around it.
pub fn shown_text(text: &str) -> String {
    let plain: String = text.chars().filter(|c| !c.is_control()).collect();
    plain.trim().to_owned()
}
