//! Aseprite's files (`.ase`, `.aseprite`): the layers and groups of the first frame, by the format's
//! published description. Floor 5. Not here: tilemaps, further frames and reference layers, which a
//! note names.

use crate::document::{Content, Document, Group, Layer, PixelLayer};
use crate::math::Size;
use crate::project::ProjectContents;
use crate::raster::{BlendMode, TileGrid};
use crate::{Budget, Error, Result};
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

const HEADER: usize = 128;
const FILE_MAGIC: [u8; 2] = 0xa5e0u16.to_le_bytes();
const FRAME_MAGIC: u16 = 0xf1fa;

/// Whether a file begins like one of Aseprite.
pub fn is_aseprite(bytes: &[u8]) -> bool {
    bytes.len() > HEADER && bytes[4..6] == FILE_MAGIC
}

/// A document of the first frame's layers.
///
/// Fails with a sentence on anything damaged or beyond `budget`.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ProjectContents> {
    let damaged = || Error::decode(file, "the Aseprite data is damaged or cut short");
    let mut header = LittleEndian { rest: &bytes[6.min(bytes.len())..] };
    let frames = header.u16().ok_or_else(damaged)?;
    let [width, height] = [header.u16(), header.u16()].map(|side| side.ok_or_else(damaged));
    let size = budget.size(file, width?.into(), height?.into())?;
    let bits = header.u16().ok_or_else(damaged)?;
    let flags = header.u32().ok_or_else(damaged)?;
    let clear = bytes.get(28).copied().ok_or_else(damaged)?;
    if !matches!(bits, 8 | 16 | 32) {
        return Err(Error::decode(
            file,
            format!("its pixels have {bits} bits; 8, 16 and 32 are supported"),
        ));
    }
    let mut sprite = Sprite {
        file,
        budget,
        bytes_a_pixel: usize::from(bits / 8),
        layers_have_opacity: flags & 1 == 1,
        groups_are_blended: flags & 2 == 2,
        clear,
        palette: vec![[0; 4]; 256],
        layers: Vec::new(),
        used_px: 0,
        notes: Vec::new(),
    };
    let mut frame = LittleEndian { rest: bytes.get(HEADER..).unwrap_or_default() };
    sprite.frame(&mut frame).ok_or_else(damaged)??;
    if frames > 1 {
        sprite.notes.push(format!("only the first of its {frames} frames is shown"));
    }
    let mut rows = sprite.layers.into_iter().peekable();
    let layers = nest(&mut rows, 0, budget.group_depth);
    let document = Document { layers, ..Document::empty(size) };
    Ok(ProjectContents { document, notes: sprite.notes, is_whole: true, picture: None })
}

/// Numbers with their low byte first, never read beyond the end.
struct LittleEndian<'a> {
    rest: &'a [u8],
}

impl<'a> LittleEndian<'a> {
    fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(length)?;
        self.rest = rest;
        Some(taken)
    }

    fn u8(&mut self) -> Option<u8> {
        Some(self.take(1)?[0])
    }

    fn u16(&mut self) -> Option<u16> {
        Some(u16::from_le_bytes(*self.take(2)?.first_chunk()?))
    }

    fn i16(&mut self) -> Option<i16> {
        Some(i16::from_le_bytes(*self.take(2)?.first_chunk()?))
    }

    fn u32(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(*self.take(4)?.first_chunk()?))
    }
}

/// A layer and how deep it lies in groups.
struct SpriteLayer {
    depth: u16,
    /// No palette index is transparent.
    is_background: bool,
    layer: Layer,
}

struct Sprite<'a> {
    file: &'a Path,
    budget: &'a Budget,
    bytes_a_pixel: usize,
    layers_have_opacity: bool,
    groups_are_blended: bool,
    /// The palette index that is transparent, except on a background.
    clear: u8,
    palette: Vec<[u8; 4]>,
    layers: Vec<SpriteLayer>,
    used_px: u64,
    notes: Vec<String>,
}

impl Sprite<'_> {
    /// The chunks of a frame; palettes come before the pixels that use them.
    fn frame(&mut self, data: &mut LittleEndian) -> Option<Result<()>> {
        data.u32()?;
        (data.u16()? == FRAME_MAGIC).then_some(())?;
        let old_count = data.u16()?;
        data.take(4)?;
        let new_count = data.u32()?;
        let count = if new_count == 0 { old_count.into() } else { new_count };
        let (mut cels, mut has_palette) = (Vec::new(), false);
        for _ in 0..count {
            let length = data.u32()? as usize;
            let kind = data.u16()?;
            let mut chunk = LittleEndian { rest: data.take(length.checked_sub(6)?)? };
            match kind {
                0x2004 => {
                    if self.layers.len() >= self.budget.layers {
                        let reason = format!("more than {} layers", self.budget.layers);
                        return Some(Err(Error::too_large(self.file, reason)));
                    }
                    let layer = self.layer(&mut chunk)?;
                    self.layers.push(layer);
                }
                0x2005 => cels.push(chunk),
                0x2019 => {
                    self.palette(&mut chunk)?;
                    has_palette = true;
                }
                0x0004 if !has_palette => self.old_palette(&mut chunk)?,
                _ => {}
            }
        }
        for mut cel in cels {
            if let Err(error) = self.cel(&mut cel)? {
                return Some(Err(error));
            }
        }
        Some(Ok(()))
    }

    fn layer(&mut self, chunk: &mut LittleEndian) -> Option<SpriteLayer> {
        let (flags, kind, depth) = (chunk.u16()?, chunk.u16()?, chunk.u16()?);
        chunk.take(4)?;
        let (mode, opacity) = (chunk.u16()?, chunk.u8()?);
        chunk.take(3)?;
        let length = chunk.u16()?;
        let name = String::from_utf8_lossy(chunk.take(length.into())?).into_owned();
        let is_group = kind == 1;
        let content = match is_group {
            true => {
                Content::Group(Group { layers: Vec::new(), pass_through: !self.groups_are_blended })
            }
            false => empty(),
        };
        if kind > 1 {
            self.notes.push(format!("“{name}” is a tilemap, which is not supported"));
        }
        let is_blended = !is_group || self.groups_are_blended;
        let has_opacity = if is_group { self.groups_are_blended } else { self.layers_have_opacity };
        let blend = blend_mode(mode).unwrap_or_else(|| {
            self.notes.push(format!("the blend mode of “{name}” is unknown; it blends normally"));
            BlendMode::Normal
        });
        let is_reference = flags & 0x40 != 0;
        if is_reference {
            self.notes.push(format!(
                "“{name}” is a reference, which is not part of the picture; it is hidden"
            ));
        }
        let layer = Layer {
            visible: flags & 1 == 1 && !is_reference,
            opacity: if has_opacity { f32::from(opacity) / 255.0 } else { 1.0 },
            blend: if is_blended { blend } else { BlendMode::Normal },
            clip_to_surface: false,
            ..Layer::new(name, content)
        };
        Some(SpriteLayer { depth, is_background: flags & 8 != 0, layer })
    }

    /// A layer's pixels in this frame.
    fn cel(&mut self, chunk: &mut LittleEndian) -> Option<Result<()>> {
        let index = usize::from(chunk.u16()?);
        let (x, y, opacity, kind) = (chunk.i16()?, chunk.i16()?, chunk.u8()?, chunk.u16()?);
        let order = chunk.i16()?;
        chunk.take(5)?;
        if order != 0 {
            let name = &self.layers.get(index)?.layer.name;
            self.notes.push(format!(
                "“{name}” is moved up or down in this frame only; it is in its usual place"
            ));
        }
        if !matches!(kind, 0 | 2) {
            return Some(Ok(()));
        }
        let (width, height) = (chunk.u16()?, chunk.u16()?);
        let size = match self.budget.size(self.file, width.into(), height.into()) {
            Ok(size) => size,
            Err(error) => return Some(Err(error)),
        };
        self.used_px += size.area() as u64;
        if self.used_px > self.budget.document_px {
            let most = self.budget.document_px;
            let reason = format!("its layers hold more than {most} pixels together");
            return Some(Err(Error::too_large(self.file, reason)));
        }
        let stored = size.area() * self.bytes_a_pixel;
        // Its tiles stay, so those of the layers before it are asked for again.
        let asked = stored as u64 + 4 * size.area() as u64 + 4 * self.used_px;
        if let Err(error) = self.budget.room(self.file, "what its layers hold", asked) {
            return Some(Err(error));
        }
        let pixels = match kind {
            0 => chunk.take(stored)?.to_vec(),
            _ => {
                let mut pixels = Vec::new();
                let mut inflated = flate2::read::ZlibDecoder::new(chunk.rest).take(stored as u64);
                inflated.read_to_end(&mut pixels).ok()?;
                pixels
            }
        };
        (pixels.len() == stored).then_some(())?;
        let is_background = self.layers.get(index)?.is_background;
        let rgba = self.rgba(&pixels, is_background);
        let tiles = tiles_of(&rgba, size, x.into(), y.into());
        let row = self.layers.get_mut(index)?;
        row.layer.opacity *= f32::from(opacity) / 255.0;
        let (x, y) = (x.into(), y.into());
        row.layer.content = Content::Pixels(PixelLayer { file: String::new(), x, y, tiles });
        Some(Ok(()))
    }

    /// Straight RGBA of stored pixels.
    fn rgba(&self, pixels: &[u8], is_background: bool) -> Vec<u8> {
        match self.bytes_a_pixel {
            1 => {
                let color = |&index: &u8| match index == self.clear && !is_background {
                    true => [0; 4],
                    false => self.palette[usize::from(index)],
                };
                pixels.iter().flat_map(color).collect()
            }
            2 => pixels.as_chunks().0.iter().flat_map(|&[v, a]| [v, v, v, a]).collect(),
            _ => pixels.to_vec(),
        }
    }

    fn palette(&mut self, chunk: &mut LittleEndian) -> Option<()> {
        chunk.u32()?;
        let (first, last) = (chunk.u32()?, chunk.u32()?);
        chunk.take(8)?;
        for index in first..=last.min(255) {
            let has_name = chunk.u16()? & 1 == 1;
            self.palette[index as usize] = *chunk.take(4)?.first_chunk()?;
            if has_name {
                let length = chunk.u16()?;
                chunk.take(length.into())?;
            }
        }
        Some(())
    }

    /// Packets of colors: how many to skip, how many follow.
    fn old_palette(&mut self, chunk: &mut LittleEndian) -> Option<()> {
        let mut index = 0usize;
        for _ in 0..chunk.u16()? {
            index += usize::from(chunk.u8()?);
            let count = match chunk.u8()? {
                0 => 256,
                count => usize::from(count),
            };
            for _ in 0..count {
                let &[r, g, b] = chunk.take(3)?.first_chunk()?;
                *self.palette.get_mut(index)? = [r, g, b, 255];
                index += 1;
            }
        }
        Some(())
    }
}

fn tiles_of(rgba: &[u8], size: Size, x: i32, y: i32) -> TileGrid {
    TileGrid::from_straight_rgba(rgba, size.width as usize, size.height as usize, x, y)
}

fn empty() -> Content {
    Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles: TileGrid::default() })
}

/// The rows at a depth and what lies in their groups, the lowest first. What is deeper than
/// `deepest` lies in the last group that may be.
fn nest(
    rows: &mut std::iter::Peekable<impl Iterator<Item = SpriteLayer>>,
    depth: u16,
    deepest: usize,
) -> Vec<Arc<Layer>> {
    let mut layers = Vec::new();
    while let Some(mut row) = rows.next_if(|row| row.depth >= depth) {
        if let Content::Group(group) = &mut row.layer.content
            && usize::from(depth) < deepest
        {
            group.layers = nest(rows, depth + 1, deepest);
        }
        layers.push(Arc::new(row.layer));
    }
    layers
}

fn blend_mode(number: u16) -> Option<BlendMode> {
    use BlendMode::*;
    let modes = [
        Normal,
        Multiply,
        Screen,
        Overlay,
        Darken,
        Lighten,
        ColorDodge,
        ColorBurn,
        HardLight,
        SoftLight,
        Difference,
        Exclusion,
        Hue,
        Saturation,
        Color,
        Luminosity,
        LinearDodge,
        Subtract,
        Divide,
    ];
    modes.get(usize::from(number)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn chunk(kind: u16, data: &[u8]) -> Vec<u8> {
        let length = (data.len() as u32 + 6).to_le_bytes();
        [&length[..], &kind.to_le_bytes(), data].concat()
    }

    fn layer(flags: u16, kind: u16, depth: u16, mode: u16, opacity: u8, name: &str) -> Vec<u8> {
        let words = [flags, kind, depth, 0, 0, mode].map(u16::to_le_bytes).concat();
        let length = (name.len() as u16).to_le_bytes();
        chunk(0x2004, &[&words[..], &[opacity, 0, 0, 0], &length, name.as_bytes()].concat())
    }

    fn cel(index: u16, at: [i16; 2], opacity: u8, size: [u16; 2], pixels: &[u8]) -> Vec<u8> {
        let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        packed.write_all(pixels).unwrap();
        let place = [index.to_le_bytes(), at[0].to_le_bytes(), at[1].to_le_bytes()].concat();
        let size = size.map(u16::to_le_bytes).concat();
        let rest = [&[opacity, 2, 0][..], &[0; 7], &size, &packed.finish().unwrap()].concat();
        chunk(0x2005, &[place, rest].concat())
    }

    fn sprite(bits: u16, frames: u16, chunks: &[Vec<u8>]) -> Vec<u8> {
        let data = chunks.concat();
        let mut header = vec![0; HEADER];
        header[4..6].copy_from_slice(&FILE_MAGIC);
        for (at, value) in [(6, frames), (8, 4), (10, 3), (12, bits), (14, 3)] {
            header[at..at + 2].copy_from_slice(&value.to_le_bytes());
        }
        let length = (data.len() as u32 + 16).to_le_bytes();
        let frame = [&length[..], &FRAME_MAGIC.to_le_bytes(), &(chunks.len() as u16).to_le_bytes()];
        [header, frame.concat(), vec![0; 8], data].concat()
    }

    fn opened(bytes: &[u8]) -> ProjectContents {
        read(Path::new("a.aseprite"), bytes, &Budget::default()).unwrap()
    }

    fn pixel(layer: &Layer, x: i32, y: i32) -> [u8; 4] {
        let Content::Pixels(pixels) = &layer.content else { panic!("it has pixels") };
        let straight = pixels.tiles.to_straight_rgba(crate::math::Rect::new(x, y, x + 1, y + 1));
        straight[..4].try_into().unwrap()
    }

    #[test]
    fn layers_have_their_names_groups_blend_modes_and_places() {
        let chunks = [
            layer(1, 0, 0, 0, 255, "paper"),
            layer(1, 1, 0, 1, 128, "figure"),
            layer(0, 0, 1, 16, 51, "light"),
            layer(1, 0, 0, 0, 255, "top"),
            cel(0, [0, 0], 255, [1, 1], &[10, 20, 30, 255]),
            cel(2, [2, 1], 255, [1, 1], &[200, 100, 50, 255]),
        ];
        let contents = opened(&sprite(32, 1, &chunks));
        assert_eq!((contents.document.size, contents.notes.len()), (Size::new(4, 3), 0));
        let [paper, figure, top] = &contents.document.layers[..] else { panic!("three layers") };
        assert_eq!([&paper.name, &figure.name, &top.name], ["paper", "figure", "top"]);
        assert_eq!(pixel(paper, 0, 0), [10, 20, 30, 255]);
        let Content::Group(group) = &figure.content else { panic!("a group") };
        assert_eq!((figure.blend, (figure.opacity * 255.0).round()), (BlendMode::Multiply, 128.0));
        let light = &group.layers[0];
        assert_eq!(
            (light.visible, light.opacity, light.blend),
            (false, 0.2, BlendMode::LinearDodge)
        );
        assert_eq!(pixel(light, 2, 1), [200, 100, 50, 255]);
    }

    #[test]
    fn indexed_pixels_have_the_colors_of_the_palette_and_later_frames_are_named() {
        let numbers = [3u32, 1, 2].map(u32::to_le_bytes).concat();
        let colors = [0, 0, 9, 8, 7, 255, 0, 0, 5, 6, 7, 255];
        let palette = chunk(0x2019, &[&numbers[..], &[0; 8], &colors].concat());
        let chunks =
            [layer(1, 0, 0, 0, 255, "a"), cel(0, [1, 0], 255, [3, 1], &[1, 0, 2]), palette];
        let contents = opened(&sprite(8, 5, &chunks));
        let layer = &contents.document.layers[0];
        let row = [1, 2, 3].map(|x| pixel(layer, x, 0));
        assert_eq!(row, [[9, 8, 7, 255], [0; 4], [5, 6, 7, 255]]);
        assert_eq!(contents.notes, ["only the first of its 5 frames is shown"]);
    }

    #[test]
    fn references_and_places_of_one_frame_are_named() {
        let mut moved = cel(0, [0, 0], 255, [1, 1], &[10, 20, 30, 255]);
        moved[6 + 9] = 2;
        let chunks = [layer(1, 0, 0, 0, 255, "a"), layer(0x41, 0, 0, 0, 255, "photo"), moved];
        let contents = opened(&sprite(32, 1, &chunks));
        assert_eq!(
            contents.document.layers.iter().map(|l| l.visible).collect::<Vec<_>>(),
            [true, false]
        );
        let [reference, place] = &contents.notes[..] else { panic!("{:?}", contents.notes) };
        assert!(reference.contains("“photo” is a reference"), "{reference}");
        assert!(place.contains("“a” is moved up or down in this frame"), "{place}");
    }

    #[test]
    fn a_file_cut_anywhere_is_read_or_gets_a_sentence() {
        let chunks = [layer(1, 0, 0, 0, 255, "a"), cel(0, [1, 0], 255, [2, 2], &[200; 16])];
        let bytes = sprite(32, 1, &chunks);
        for length in HEADER + 1..bytes.len() {
            let said = read(Path::new("a.ase"), &bytes[..length], &Budget::default()).err();
            assert!(said.unwrap().to_string().contains("cut short"), "{length}");
        }
    }
}
