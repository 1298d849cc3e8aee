//! OpenEXR: every channel of every part, whatever the layers are called. Floor 5. The header and
//! the chunk table are checked against the budget before anything is decoded or allocated; a chunk
//! is decoded by the `exr` crate. Not here: what a channel means (`picture`, `maps`).

mod chunks;
mod names;
mod write;

pub use names::{ExrPass, passes};
pub use write::{chromaticities, encode_channels, encode_light};

use super::Budget;
use crate::math::{ColorProfile, Size};
use crate::raster::{Plane, TILE};
use crate::{Error, Remedy, Result};
use exr::meta::{BlockDescription, MetaData, attribute::SampleType, header::Header};
use std::{
    io::Cursor,
    ops::Range,
    panic::{AssertUnwindSafe, catch_unwind},
    path::Path,
};

/// One channel of one part.
#[derive(Clone, Debug)]
pub struct ExrChannel {
    /// `part.channel` where the part's name is needed to distinguish channels, else the channel's
    /// own name.
    pub name: String,
    /// Half, float or unsigned integer.
    pub kind: &'static str,
    part: usize,
    index: usize,
}

/// An EXR whose header has been read and found within the budget; no pixel decoded yet.
pub struct ExrFile<'a> {
    file: &'a Path,
    bytes: &'a [u8],
    meta: MetaData,
    chunks: Vec<chunks::Chunk>,
    channels: Vec<ExrChannel>,
    passes: Vec<ExrPass>,
    size: Size,
}

impl<'a> ExrFile<'a> {
    /// Whether a file is an OpenEXR file, by its first bytes.
    pub fn is_exr(bytes: &[u8]) -> bool {
        bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01])
    }

    /// Reads the header and the chunk table.
    ///
    /// Fails on deep or subsampled channels, compressions the decoder lacks, windows beyond the
    /// budget, and files that end before their last chunk.
    pub fn open(file: &'a Path, bytes: &'a [u8], budget: &Budget) -> Result<Self> {
        let mut cursor = Cursor::new(bytes);
        let meta = guard(file, "header", || MetaData::read_from_buffered(&mut cursor, false))?;
        let size = window(file, &meta, budget)?;
        for header in &meta.headers {
            check_part(file, header, budget)?;
        }
        guard(file, "header", || MetaData::validate(&meta.headers, false))?;
        let chunks = chunks::walk(file, bytes, cursor.position() as usize, &meta)?;
        let channels = names::channels(&meta);
        let passes = passes(&channels);
        Ok(Self { file, bytes, meta, chunks, channels, passes, size })
    }

    /// The display window's size, which is that of every plane.
    pub fn size(&self) -> Size {
        self.size
    }

    /// The channels of all parts.
    pub fn channels(&self) -> &[ExrChannel] {
        &self.channels
    }

    /// The channels grouped by layer.
    pub fn passes(&self) -> &[ExrPass] {
        &self.passes
    }

    /// The profile of its light, by its chromaticities; sRGB where it says nothing, or others.
    pub fn profile(&self) -> ColorProfile {
        let said = self.meta.headers.iter().find_map(|h| h.shared_attributes.chromaticities);
        let is_p3 = said.is_some_and(|said| {
            let found = [said.red, said.green, said.blue, said.white].map(|v| [v.x(), v.y()]);
            let known = ColorProfile::DisplayP3.chromaticities();
            let pairs = found.as_flattened().iter().zip(known.as_flattened());
            pairs.into_iter().all(|(a, b)| (a - b).abs() < 2e-3)
        });
        if is_p3 { ColorProfile::DisplayP3 } else { ColorProfile::Srgb }
    }

    /// How many pictures the file says it holds, each of its own layers.
    pub fn parts(&self) -> usize {
        self.meta.headers.len()
    }

    /// The name of the compression, for people.
    pub fn compression(&self) -> String {
        self.meta.headers.first().map_or_else(String::new, |h| h.compression.to_string())
    }

    /// The first part's `worldToCamera` attribute, as stored: row by row, for row vectors.
    pub fn world_to_camera(&self) -> Option<[f32; 16]> {
        self.meta.headers.iter().find_map(|h| h.own_attributes.world_to_camera)
    }

    /// The horizontal field of view in degrees, if the header has it.
    pub fn fov_degrees(&self) -> Option<f32> {
        let fov = self.meta.headers.iter().find_map(|h| h.own_attributes.horizontal_field_of_view);
        fov.filter(|fov| *fov > 0.0 && *fov < 180.0)
    }

    /// Decodes some channels (indices into [`Self::channels`]) over the display window; NaN outside
    /// the data window. Unsigned integers become floats.
    pub fn read(&self, wanted: &[usize]) -> Result<Vec<Plane<f32>>> {
        self.read_rows(wanted, 0..self.size.height as usize)
    }

    /// The rows of the display window in runs that touch few chunks, each a multiple of the height
    /// of tiles except the last.
    pub fn bands(&self) -> impl Iterator<Item = Range<usize>> {
        let height = self.size.height as usize;
        let tallest =
            self.meta.headers.iter().map(|h| h.max_block_pixel_size().y()).max().unwrap_or(1);
        let band = tallest.min(height).next_multiple_of(TILE);
        (0..height).step_by(band).map(move |top| top..(top + band).min(height))
    }

    /// As [`Self::read`], some rows of the display window.
    pub fn read_rows(&self, wanted: &[usize], rows: Range<usize>) -> Result<Vec<Plane<f32>>> {
        let size = Size::new(self.size.width, rows.len() as u32);
        let mut planes = vec![Plane::full(size, f32::NAN); wanted.len()];
        let targets: Vec<&ExrChannel> =
            wanted.iter().filter_map(|&w| self.channels.get(w)).collect();
        let (first, end) = (rows.start as i64, rows.end as i64);
        let is_needed = |chunk: &&chunks::Chunk| {
            let held = self.meta.headers.get(chunk.part).map_or(0..0, |header| chunk.rows(header));
            held.start < end && held.end > first && targets.iter().any(|t| t.part == chunk.part)
        };
        let needed: Vec<&chunks::Chunk> = self.chunks.iter().filter(is_needed).collect();
        chunks::decode(self.file, self.bytes, &self.meta, &needed, |block| {
            let Some(header) = self.meta.headers.get(block.index.layer) else { return };
            for (target, plane) in targets.iter().zip(&mut planes) {
                if target.part == block.index.layer {
                    copy_block(header, block, target.index, first, plane);
                }
            }
        })?;
        Ok(planes)
    }
}

/// The display window, which all parts share, or the first data window where they have none to
/// share.
fn window(file: &Path, meta: &MetaData, budget: &Budget) -> Result<Size> {
    let first = meta.headers.first().ok_or_else(|| Error::decode(file, "the EXR has no parts"))?;
    let display = first.shared_attributes.display_window;
    if meta.headers.iter().any(|h| h.shared_attributes.display_window.size != display.size) {
        return Err(Error::unsupported_file(file, "EXR parts whose display windows differ"));
    }
    budget.size(file, display.size.x() as u64, display.size.y() as u64)
}

fn check_part(file: &Path, header: &Header, budget: &Budget) -> Result<()> {
    if header.deep {
        return Err(Error::unsupported_file(file, "deep EXR data; flatten it first"));
    }
    if header.channels.list.iter().any(|c| c.sampling.x() != 1 || c.sampling.y() != 1) {
        return Err(Error::unsupported_file(
            file,
            "EXR channels stored at a lower resolution (subsampling)",
        ));
    }
    let data = budget.size(file, header.layer_size.x() as u64, header.layer_size.y() as u64)?;
    // The memory of the largest picture within the budget: four floats a pixel; a G-buffer has more
    // but smaller channels.
    let bytes = data.area() as u64 * header.channels.bytes_per_pixel as u64;
    if bytes > budget.area_px.saturating_mul(16) {
        let reason = format!("{data} pixels of {} channels", header.channels.list.len());
        return Err(Error::too_large(file, reason).with_remedy(Remedy::MorePixels));
    }
    if let BlockDescription::Tiles(tiles) = header.blocks {
        let (w, h) = (tiles.tile_size.x() as u64, tiles.tile_size.y() as u64);
        // Tiles larger than the picture are legal but have no use beyond the next power of two.
        let most = |side: u32| u64::from(side.next_power_of_two()).max(1024);
        if w == 0 || h == 0 || w > most(data.width) || h > most(data.height) {
            return Err(Error::decode(file, format!("the EXR claims tiles of {w} × {h} pixels")));
        }
    }
    Ok(())
}

/// Copies one channel of a decoded block into its place in the display window.
///
/// * `first`: the row of the display window that the plane begins with.
fn copy_block(
    header: &Header,
    block: &exr::block::UncompressedBlock,
    channel: usize,
    first: i64,
    plane: &mut Plane<f32>,
) {
    let display = header.shared_attributes.display_window.position;
    let data = header.own_attributes.layer_position;
    let shift =
        |data: i32, display: i32, at: usize| i64::from(data) - i64::from(display) + at as i64;
    let left = shift(data.x(), display.x(), block.index.pixel_position.x());
    let top = shift(data.y(), display.y(), block.index.pixel_position.y());
    let (width, height) = (block.index.pixel_size.x(), block.index.pixel_size.y());
    let Some(kind) = header.channels.list.get(channel).map(|c| c.sample_type) else { return };
    // Rows follow each other; within a row the channels do.
    let row_bytes = header.channels.bytes_per_pixel * width;
    let before: usize = header.channels.list[..channel]
        .iter()
        .map(|c| c.sample_type.bytes_per_sample() * width)
        .sum();
    for row in 0..height {
        let y = top + row as i64 - first;
        let start = row * row_bytes + before;
        let samples = block.data.get(start..start + kind.bytes_per_sample() * width);
        let (Some(samples), true) = (samples, (0..plane.height() as i64).contains(&y)) else {
            continue;
        };
        let begin = (-left).max(0).min(width as i64) as usize;
        let count = (plane.width() as i64 - left).max(0).min(width as i64) as usize;
        let target = plane.row_mut(y as usize);
        for column in begin..count {
            target[(left + column as i64) as usize] = sample(kind, samples, column);
        }
    }
}

fn sample(kind: SampleType, samples: &[u8], at: usize) -> f32 {
    let word = |i: usize| samples.as_chunks::<4>().0[i];
    match kind {
        SampleType::F16 => {
            exr::prelude::f16::from_ne_bytes(samples.as_chunks::<2>().0[at]).to_f32()
        }
        SampleType::F32 => f32::from_ne_bytes(word(at)),
        SampleType::U32 => u32::from_ne_bytes(word(at)) as f32,
    }
}

/// Runs a step of the decoder; its errors and its panics become sentences.
fn guard<T>(file: &Path, what: &str, step: impl FnOnce() -> exr::error::Result<T>) -> Result<T> {
    match catch_unwind(AssertUnwindSafe(step)) {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(exr::error::Error::NotSupported(reason))) => {
            Err(Error::unsupported_file(file, format!("EXR: {reason}")))
        }
        Ok(Err(exr::error::Error::Invalid(reason))) if reason.contains("compression attribute") => {
            Err(Error::unsupported_file(file, "the compression of the EXR is not supported"))
        }
        Ok(Err(error)) => {
            Err(Error::decode(file, format!("the EXR {what} is damaged or cut short ({error})")))
        }
        Err(_) => Err(Error::decode(file, format!("the EXR {what} is damaged"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::exr::prelude::*;

    const W: usize = 21;
    const H: usize = 13;

    fn plane(scale: f32) -> FlatSamples {
        FlatSamples::F32((0..W * H).map(|i| i as f32 * scale).collect())
    }

    fn layer(
        name: &str,
        channels: &[(&str, f32)],
        encoding: Encoding,
        at: (i32, i32),
    ) -> Layer<AnyChannels<FlatSamples>> {
        let list =
            channels.iter().map(|(name, scale)| AnyChannel::new(*name, plane(*scale))).collect();
        let attributes = LayerAttributes::named(name).with_position(Vec2(at.0, at.1));
        Layer::new((W, H), attributes, encoding, AnyChannels::sort(list))
    }

    fn bytes(layers: Vec<Layer<AnyChannels<FlatSamples>>>, display: (usize, usize)) -> Vec<u8> {
        let mut attributes = ImageAttributes::with_size(Vec2(display.0, display.1));
        attributes.pixel_aspect = 1.0;
        let mut out = Cursor::new(Vec::new());
        Image::from_layers(attributes, layers.into_iter().collect::<SmallVec<_>>())
            .write()
            .to_buffered(&mut out)
            .unwrap();
        out.into_inner()
    }

    fn encodings() -> Vec<Encoding> {
        let lines = |line_order| Encoding {
            compression: Compression::ZIP16,
            blocks: Blocks::ScanLines,
            line_order,
        };
        let tiles = Encoding {
            compression: Compression::PIZ,
            blocks: Blocks::Tiles(Vec2(8, 8)),
            line_order: LineOrder::Increasing,
        };
        vec![
            lines(LineOrder::Increasing),
            lines(LineOrder::Decreasing),
            tiles,
            Encoding::UNCOMPRESSED,
        ]
    }

    #[test]
    fn rows_tiles_and_reversed_lines_give_the_same_plane() {
        for encoding in encodings() {
            let file =
                bytes(vec![layer("main", &[("N.X", 1.0), ("Z", 2.0)], encoding, (0, 0))], (W, H));
            let exr = ExrFile::open(Path::new("a.exr"), &file, &Budget::default()).unwrap();
            let z = exr.channels().iter().position(|c| c.name == "Z").unwrap();
            let planes = exr.read(&[z]).unwrap();
            let parts: Vec<f32> = [0..4, 4..13]
                .into_iter()
                .flat_map(|rows| exr.read_rows(&[z], rows).unwrap().remove(0).into_values())
                .collect();
            assert_eq!(planes[0].values(), parts, "{encoding:?}");
            let expected: Vec<f32> = (0..W * H).map(|i| i as f32 * 2.0).collect();
            assert_eq!(planes[0].values(), expected, "{encoding:?}");
        }
    }

    #[test]
    fn the_data_window_stands_where_it_says_in_the_display_window() {
        for encoding in encodings() {
            let file = bytes(vec![layer("main", &[("Z", 1.0)], encoding, (5, -3))], (24, 16));
            let exr = ExrFile::open(Path::new("a.exr"), &file, &Budget::default()).unwrap();
            let plane = &exr.read(&[0]).unwrap()[0];
            assert_eq!(plane.size(), Size::new(24, 16));
            assert!(plane.at(4, 0).is_nan() && plane.at(5, 10).is_nan());
            assert_eq!(plane.at(5, 0), (3 * W) as f32);
            assert_eq!(plane.at(23, 9), (12 * W + 18) as f32);
        }
    }

    #[test]
    fn parts_are_layers_and_names_split_at_the_last_dot() {
        let parts = vec![
            layer(
                "normal",
                &[("N.X", 1.0), ("N.Y", 2.0), ("N.Z", 3.0)],
                Encoding::UNCOMPRESSED,
                (0, 0),
            ),
            layer("depth", &[("Z", 4.0)], Encoding::UNCOMPRESSED, (0, 0)),
            layer("my.view", &[("deep id", 5.0), ("a.b.red", 6.0)], Encoding::UNCOMPRESSED, (0, 0)),
        ];
        let file = bytes(parts, (W, H));
        let exr = ExrFile::open(Path::new("a.exr"), &file, &Budget::default()).unwrap();
        let names: Vec<&str> = exr.passes().iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["N", "depth", "a.b", "my.view.deep id"]);
        assert!(exr.passes()[0].letters("xyz").is_some());
        let depth = exr.passes()[1].letters("z").unwrap();
        assert_eq!(exr.read(&depth).unwrap()[0].at(1, 0), 4.0);
    }

    #[test]
    fn a_file_cut_anywhere_is_refused() {
        let file =
            bytes(vec![layer("main", &[("Z", 1.0)], Encoding::UNCOMPRESSED, (0, 0))], (W, H));
        for length in (8..file.len()).step_by(7) {
            let said = ExrFile::open(Path::new("a.exr"), &file[..length], &Budget::default())
                .err()
                .unwrap()
                .to_string();
            assert!(said.starts_with("a.exr: cannot be read"), "{said}");
        }
    }
}
