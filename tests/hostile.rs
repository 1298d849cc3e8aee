//! Damaged and lying files: no panic, no allocation beyond what the budget allows.

use super::watch;
use rilievo::files::{Files, MapSource, SurfaceSource, maps, picture};
use rilievo::{Budget, Error, Result};
use rilievo_io::inspect;
use std::io::Cursor;
use std::path::{Path, PathBuf};

const SIDE: usize = 24;

struct One(Vec<u8>);

impl Files for One {
    fn read(&self, _: &str, _: &Budget) -> Result<Vec<u8>> {
        Ok(self.0.clone())
    }

    fn path(&self, name: &str) -> PathBuf {
        name.into()
    }
}

/// Reads the bytes in every way there is; what they say does not matter.
fn read_all(name: &str, bytes: &[u8], budget: &Budget) -> Vec<Error> {
    let path = Path::new(name);
    let map = || Some(MapSource { file: name.into(), ..MapSource::default() });
    let files = One(bytes.to_vec());
    let pairs = [
        SurfaceSource { normal: map(), ..SurfaceSource::default() },
        SurfaceSource {
            depth: Some(MapSource { file: name.into(), ..MapSource::default() }),
            ..SurfaceSource::default()
        },
    ];
    let mut errors: Vec<Error> = Vec::new();
    errors.extend(picture::decode(path, bytes, budget).err());
    errors.extend(picture::decode_coverage(path, bytes, budget).err());
    errors.extend(inspect::describe(path, bytes, budget).err());
    for source in pairs {
        match maps::import(&source, &files, budget) {
            Ok(import) => {
                let s = import.surface;
                let finite =
                    |p: &rilievo::raster::Plane<f32>| p.values().iter().all(|v| v.is_finite());
                assert!(
                    finite(s.depth_plane()) && s.normal_planes().iter().all(|p| finite(p)),
                    "{name}"
                );
            }
            Err(e) => errors.push(e),
        }
    }
    errors
}

fn bitmap(format: image::ImageFormat) -> Vec<u8> {
    let n = SIDE as u32;
    let image = image::RgbImage::from_fn(n, n, |x, y| {
        image::Rgb([128 + x as u8 * 3, 128 - y as u8 * 3, 240])
    });
    let image = image::DynamicImage::ImageRgb8(image);
    let image = if format == image::ImageFormat::Hdr { image.to_rgb32f().into() } else { image };
    let mut out = Cursor::new(Vec::new());
    image.write_to(&mut out, format).unwrap();
    out.into_inner()
}

fn exr(compression: exr::prelude::Compression, tiles: bool) -> Vec<u8> {
    use exr::prelude::*;
    let plane = |f: fn(f32) -> f32| {
        FlatSamples::F32((0..SIDE * SIDE).map(|i| f(i as f32 / 600.0)).collect())
    };
    let half = |f: fn(f32) -> f32| {
        FlatSamples::F16((0..SIDE * SIDE).map(|i| f16::from_f32(f(i as f32 / 600.0))).collect())
    };
    let list = [
        AnyChannel::new("N.X", plane(|v| v * 0.4)),
        AnyChannel::new("N.Y", plane(|v| 0.3 - v * 0.5)),
        AnyChannel::new("N.Z", plane(|v| 1.0 - v * 0.2)),
        AnyChannel::new("Z", plane(|v| 2.0 + v.sin())),
        AnyChannel::new("R", half(|v| v)),
        AnyChannel::new("G", half(|v| v * v)),
        AnyChannel::new("B", half(|v| 1.0 - v)),
        AnyChannel::new("A", half(|_| 1.0)),
    ];
    let blocks = if tiles { Blocks::Tiles(Vec2(16, 16)) } else { Blocks::ScanLines };
    let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    let layer = Layer::new(
        (SIDE, SIDE),
        LayerAttributes::named("main"),
        encoding,
        AnyChannels::sort(list.into_iter().collect()),
    );
    let mut out = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut out).unwrap();
    out.into_inner()
}

/// xorshift64*: the same files on every run.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, below: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % below.max(1)
    }
}

/// Flips bits, cuts, doubles a stretch, or writes an extreme figure, mostly near the front where
/// headers are.
fn damage(seed: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=dice.roll(3) {
        let front = if dice.roll(2) == 0 { bytes.len() } else { bytes.len().min(600) };
        let at = dice.roll(front);
        match dice.roll(6) {
            0 => bytes.truncate(at.max(1)),
            1 => {
                let extreme =
                    [0u32, 1, 0x7fff_ffff, 0xffff_ffff, 60_000, 0x0100_0000][dice.roll(6)];
                let figure =
                    if dice.roll(2) == 0 { extreme.to_le_bytes() } else { extreme.to_be_bytes() };
                bytes.iter_mut().skip(at).zip(figure).for_each(|(b, v)| *b = v);
            }
            2 => {
                let end = (at + dice.roll(64)).min(bytes.len());
                let stretch = bytes[at.min(end)..end].to_vec();
                bytes.splice(at..at, stretch);
            }
            _ => bytes[at] ^= 1 << dice.roll(8),
        }
    }
    bytes
}

#[test]
fn damaged_files_neither_panic_nor_allocate_beyond_the_budget() {
    let _turn = watch::turn();
    use exr::prelude::Compression;
    use image::ImageFormat;
    // Decoders' panics are caught at the door; their traces would bury this test's own.
    std::panic::set_hook(Box::new(|panic| {
        if panic.location().is_some_and(|l| l.file().contains("hostile")) {
            eprintln!("{panic}");
        }
    }));
    let seeds: Vec<(&str, Vec<u8>)> = vec![
        ("a.png", bitmap(ImageFormat::Png)),
        ("a.jpg", bitmap(ImageFormat::Jpeg)),
        ("a.webp", bitmap(ImageFormat::WebP)),
        ("a.tif", bitmap(ImageFormat::Tiff)),
        ("a.bmp", bitmap(ImageFormat::Bmp)),
        ("a.tga", bitmap(ImageFormat::Tga)),
        ("a.hdr", bitmap(ImageFormat::Hdr)),
        ("zip.exr", exr(Compression::ZIP16, false)),
        ("rle.exr", exr(Compression::RLE, true)),
        ("piz.exr", exr(Compression::PIZ, false)),
        ("b44.exr", exr(Compression::B44, false)),
        ("pxr24.exr", exr(Compression::PXR24, true)),
        ("dwaa.exr", exr(Compression::DWAA(None), false)),
        ("dwab.exr", exr(Compression::DWAB(None), true)),
        ("none.exr", exr(Compression::Uncompressed, false)),
    ];
    let budget = Budget { side_px: 2048, area_px: 1 << 20, ..Budget::default() };
    let mut refused = 0;
    for (name, seed) in &seeds {
        assert!(read_all(name, seed, &budget).len() < 5, "{name} should be readable in some way");
        let mut dice = Dice(0x9e37_79b9_7f4a_7c15 ^ seed.len() as u64);
        for _ in 0..60 {
            let bytes = damage(seed, &mut dice);
            watch::forget();
            for error in read_all(name, &bytes, &budget) {
                assert!(error.to_string().contains(name), "{error}");
                refused += 1;
            }
            let largest = watch::largest();
            assert!(largest <= 64 << 20, "{name}: a block of {largest} bytes");
        }
    }
    assert!(refused > 500, "only {refused} refusals: the damage does nothing");
}

#[test]
fn headers_that_promise_too_much_are_refused_before_anything_is_allocated() {
    let _turn = watch::turn();
    let mut png = bitmap(image::ImageFormat::Png);
    png[16..24].copy_from_slice(&[0, 0, 0x27, 0x10, 0, 0, 0x27, 0x10]);
    let crc = crc32(&png[12..29]);
    png[29..33].copy_from_slice(&crc.to_be_bytes());
    let mut exr = exr(exr::prelude::Compression::ZIP16, false);
    let window = exr.windows(11).position(|w| w == b"dataWindow\0").unwrap() + 11 + 6 + 4;
    exr[window + 8..window + 12].copy_from_slice(&9_999i32.to_le_bytes());
    exr[window + 12..window + 16].copy_from_slice(&9_999i32.to_le_bytes());
    for (name, bytes) in [("bomb.png", png), ("bomb.exr", exr)] {
        watch::forget();
        let errors = read_all(name, &bytes, &Budget::default());
        assert_eq!(errors.len(), 5, "{name}");
        assert!(watch::largest() < 8 << 20, "{name}: {}", watch::largest());
    }
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, b| {
        (0..8).fold(
            crc ^ u32::from(*b),
            |c, _| if c & 1 == 1 { (c >> 1) ^ 0xedb8_8320 } else { c >> 1 },
        )
    })
}
