//! The maps of a shape as files for engines and other programs: normals, depth, height, mask and
//! parts. Floor 5. PNG keeps the coverage as alpha; EXR holds the numbers as they are.

use super::OutputFile;
use crate::Terms;
use crate::exr::encode_channels;
use crate::math::{Size, srgb::quantize};
use crate::surface::Surface;
use crate::{Error, Result};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use std::io::Cursor;
use std::path::{Path, PathBuf};

rilievo_engine::named! {
    /// One of the maps, named by what is added to a file's name, as engines expect it.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum ShapeMap {
        /// Camera space.
        Normals = "_n",
        /// 0 near … 1 far over the surface.
        Depth = "_d",
        /// 1 near … 0 far; in an EXR px toward the viewer.
        Height = "_h",
        Mask = "_mask",
        /// The number of the visible part, from 1; 0 if there is none.
        Parts = "_id",
    }
}

/// The files of one shape, checked before any of them is made: all may be written, or none is.
pub struct ShapeFiles {
    targets: Vec<(ShapeMap, PathBuf, OutputFile)>,
    options: ShapeOptions,
}

impl ShapeFiles {
    /// `base`: the folder and the name that the suffixes are added to; an ending that pictures have
    /// is left out.
    pub fn new(
        base: &Path,
        maps: &[ShapeMap],
        options: ShapeOptions,
        terms: &Terms,
    ) -> Result<Self> {
        let extension = if options.is_exr { "exr" } else { "png" };
        let known = |ending: &std::ffi::OsStr| {
            ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known))
        };
        let stem =
            if base.extension().is_some_and(known) { base.file_stem() } else { base.file_name() };
        let stem = stem.unwrap_or_default().to_string_lossy();
        let target = |map: &ShapeMap| {
            let file = base.with_file_name(format!("{stem}{}.{extension}", map.name()));
            Ok((*map, file.clone(), OutputFile::new(&file, terms.clone())?))
        };
        Ok(Self { targets: maps.iter().map(target).collect::<Result<_>>()?, options })
    }

    /// Writes them; their paths.
    pub fn write(&self, surface: &Surface) -> Result<Vec<PathBuf>> {
        let write = |(map, file, target): &(ShapeMap, PathBuf, OutputFile)| {
            target.replace(&encode(file, surface, *map, &self.options)?)?;
            Ok(file.clone())
        };
        self.targets.iter().map(write).collect()
    }
}

/// Extensions of the files that shapes are made from and written to.
const ENDINGS: [&str; 10] =
    ["png", "exr", "ora", "psd", "jpg", "jpeg", "webp", "tif", "tiff", "json"];

/// How maps are written.
#[derive(Clone, Copy, Debug)]
pub struct ShapeOptions {
    /// Green points down, as in Direct3D; else up.
    pub is_directx: bool,
    /// 16 bits a channel of a PNG in place of 8; masks have 8.
    pub is_16_bit: bool,
    /// EXR of 32 bits in place of PNG.
    pub is_exr: bool,
}

/// The bytes of one map; `file` is for messages.
pub fn encode(
    file: &Path,
    surface: &Surface,
    map: ShapeMap,
    options: &ShapeOptions,
) -> Result<Vec<u8>> {
    if options.is_exr {
        return exr(file, surface, map, options);
    }
    let texel = |i: usize| -> ([f32; 3], f32) {
        let (x, y) = at(surface, i);
        let covered = f32::from(surface.coverage(x, y)) / 255.0;
        let value = match map {
            ShapeMap::Normals => {
                let n = surface.normal(x, y);
                let up = if options.is_directx { -n.y } else { n.y };
                let flat = if covered > 0.0 { [n.x, up, n.z] } else { [0.0, 0.0, 1.0] };
                return (flat.map(|v| 0.5 + 0.5 * v), covered);
            }
            ShapeMap::Depth => surface.depth(x, y),
            ShapeMap::Height => 1.0 - surface.depth(x, y),
            ShapeMap::Mask => covered,
            ShapeMap::Parts => part(surface, x, y) as f32 / 65535.0,
        };
        ([if covered > 0.0 { value } else { 0.0 }; 3], covered)
    };
    let count = surface.size().area();
    match map {
        ShapeMap::Mask => {
            let bytes: Vec<u8> = (0..count).map(|i| quantize(texel(i).1)).collect();
            png(file, &bytes, surface.size(), ExtendedColorType::L8)
        }
        // Numbers are not shades: no bit may be lost, and most programs show 16 bits.
        ShapeMap::Parts => {
            let bytes: Vec<u8> = (0..count).flat_map(|i| sixteen(texel(i).0[0])).collect();
            png(file, &bytes, surface.size(), ExtendedColorType::L16)
        }
        ShapeMap::Normals if options.is_16_bit => {
            let texels = (0..count).map(texel);
            let bytes =
                texels.flat_map(|([r, g, b], a)| [r, g, b, a].into_iter().flat_map(sixteen));
            png(file, &bytes.collect::<Vec<u8>>(), surface.size(), ExtendedColorType::Rgba16)
        }
        ShapeMap::Normals => {
            let bytes = (0..count).map(texel).flat_map(|([r, g, b], a)| [r, g, b, a].map(quantize));
            png(file, &bytes.collect::<Vec<u8>>(), surface.size(), ExtendedColorType::Rgba8)
        }
        ShapeMap::Depth | ShapeMap::Height if options.is_16_bit => {
            let bytes =
                (0..count).map(texel).flat_map(|([v, ..], a)| [v, a].into_iter().flat_map(sixteen));
            png(file, &bytes.collect::<Vec<u8>>(), surface.size(), ExtendedColorType::La16)
        }
        ShapeMap::Depth | ShapeMap::Height => {
            let bytes = (0..count).map(texel).flat_map(|([v, ..], a)| [v, a].map(quantize));
            png(file, &bytes.collect::<Vec<u8>>(), surface.size(), ExtendedColorType::La8)
        }
    }
}

fn at(surface: &Surface, i: usize) -> (usize, usize) {
    let width = surface.size().width as usize;
    (i % width, i / width)
}

/// The part that a pixel shows, or its object where the surface is not made of parts.
fn part(surface: &Surface, x: usize, y: usize) -> u32 {
    match surface.parts_plane() {
        Some(parts) => parts.at(x, y),
        None => surface.objects().labels().at(x, y),
    }
}

/// 16 bits in the machine's own order, as the encoder takes them.
fn sixteen(v: f32) -> [u8; 2] {
    ((v.max(0.0).min(1.0) * 65535.0).round() as u16).to_ne_bytes()
}

fn png(file: &Path, bytes: &[u8], size: Size, color: ExtendedColorType) -> Result<Vec<u8>> {
    let mut out = Cursor::new(Vec::new());
    let encoder = PngEncoder::new(&mut out);
    encoder
        .write_image(bytes, size.width, size.height, color)
        .map_err(|e| Error::unsupported_file(file, e))?;
    Ok(out.into_inner())
}

fn exr(file: &Path, surface: &Surface, map: ShapeMap, options: &ShapeOptions) -> Result<Vec<u8>> {
    let plane = |value: &dyn Fn(usize, usize) -> f32| -> Vec<f32> {
        let covered = |x, y| surface.coverage(x, y) > 0;
        let pixels = (0..surface.size().area()).map(|i| at(surface, i));
        pixels.map(|(x, y)| if covered(x, y) { value(x, y) } else { 0.0 }).collect()
    };
    let alpha = plane(&|x, y| f32::from(surface.coverage(x, y)) / 255.0);
    let sign = if options.is_directx { -1.0 } else { 1.0 };
    let mut channels = match map {
        ShapeMap::Normals => vec![
            ("N.X", plane(&|x, y| surface.normal(x, y).x)),
            ("N.Y", plane(&|x, y| sign * surface.normal(x, y).y)),
            ("N.Z", plane(&|x, y| surface.normal(x, y).z)),
        ],
        ShapeMap::Depth => vec![("Z", plane(&|x, y| surface.depth(x, y)))],
        ShapeMap::Height => {
            vec![("Y", plane(&|x, y| (1.0 - surface.depth(x, y)) * surface.depth_range_px()))]
        }
        ShapeMap::Mask => vec![("Y", alpha.clone())],
        ShapeMap::Parts => vec![("Y", plane(&|x, y| part(surface, x, y) as f32))],
    };
    channels.push(("A", alpha));
    encode_channels(file, surface.size(), channels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use crate::shape::{Combine, Primitive, Relief, primitive::Body};

    fn ball() -> Surface {
        let mut relief = Relief::empty(Size::new(64, 48));
        let form = Primitive::new(Body::Sphere, vec2(32.0, 24.0), 20.0).form(1 << 16).unwrap();
        relief.add(&form, Combine::Over, 7);
        relief.into_surface(&mut crate::surface::NearestCache::default()).unwrap()
    }

    fn written(map: ShapeMap, is_directx: bool, is_16_bit: bool) -> image::DynamicImage {
        let options = ShapeOptions { is_directx, is_16_bit, is_exr: false };
        image::load_from_memory(&encode(Path::new("a.png"), &ball(), map, &options).unwrap())
            .unwrap()
    }

    #[test]
    fn normals_have_their_green_where_the_engine_wants_it_and_keep_alpha() {
        for (is_directx, above) in [(false, 191u8..=220), (true, 35..=64)] {
            let normals = written(ShapeMap::Normals, is_directx, false).into_rgba8();
            let p = normals.get_pixel(32, 12).0;
            assert!(above.contains(&p[1]) && p[3] == 255, "{p:?}");
            assert_eq!(normals.get_pixel(1, 1).0, [128, 128, 255, 0]);
        }
        let pixels16 = written(ShapeMap::Normals, false, true).into_rgba16();
        assert_eq!(pixels16.get_pixel(32, 24).0[3], 65535);
    }

    #[test]
    fn depth_is_low_where_height_is_high_and_parts_keep_their_numbers() {
        let depth = written(ShapeMap::Depth, false, true).into_luma_alpha16();
        let height = written(ShapeMap::Height, false, true).into_luma_alpha16();
        assert!(depth.get_pixel(32, 24).0[0] < 100 && height.get_pixel(32, 24).0[0] > 65000);
        assert_eq!(written(ShapeMap::Parts, false, false).into_luma16().get_pixel(32, 24).0[0], 7);
        assert_eq!(written(ShapeMap::Mask, false, false).into_luma8().get_pixel(32, 24).0[0], 255);
    }

    #[test]
    fn files_are_named_after_the_drawing_and_none_is_written_where_one_is_in_the_way() {
        let folder = tempfile::tempdir().unwrap();
        let options = ShapeOptions { is_directx: false, is_16_bit: true, is_exr: false };
        let maps = ShapeMap::ALL.map(|(map, _)| map);
        let terms = Terms::export(crate::Overwrite::Nothing, Vec::new());
        let names = |base: &str| {
            let files = ShapeFiles::new(&folder.path().join(base), &maps, options, &terms)?
                .write(&ball())?;
            let name = |file: &PathBuf| file.file_name().unwrap().to_string_lossy().into_owned();
            Ok::<Vec<String>, crate::Error>(files.iter().map(name).collect())
        };
        assert_eq!(names("snail v1.2").unwrap()[0], "snail v1.2_n.png");
        let all = ["snail_n.png", "snail_d.png", "snail_h.png", "snail_mask.png", "snail_id.png"];
        std::fs::write(folder.path().join("snail_id.png"), b"mine").unwrap();
        assert!(names("snail.png").is_err() && !folder.path().join("snail_n.png").exists());
        std::fs::remove_file(folder.path().join("snail_id.png")).unwrap();
        assert_eq!(names("snail.png").unwrap(), all);
    }

    #[test]
    fn an_exr_holds_normals_that_are_read_back() {
        let options = ShapeOptions { is_directx: false, is_16_bit: false, is_exr: true };
        for (map, _) in ShapeMap::ALL {
            assert!(encode(Path::new("a.exr"), &ball(), map, &options).unwrap().len() > 500);
        }
    }
}
