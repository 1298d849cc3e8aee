//! A surface known by its formula, and files made of it in memory.
#![allow(dead_code, reason = "each test program uses its own part")]

use glam::{Vec3, vec3};
use rilievo::files::Files;
use rilievo::{Budget, Error, Result};
use std::collections::HashMap;
use std::io::Cursor;
use std::path::PathBuf;

/// Width and height of every map.
pub const SIDE: usize = 96;

/// A ball with a bump, which no turn and no mirror leaves the same.
pub struct Ball {
    surface: Vec<Option<(Vec3, f32)>>,
}

impl Ball {
    pub fn new() -> Self {
        let surface = (0..SIDE * SIDE)
            .map(|i| Self::formula((i % SIDE) as f32 + 0.5, (i / SIDE) as f32 + 0.5))
            .collect();
        Self { surface }
    }

    /// Normal (y up) and planar depth in pixels from a camera 150 pixels away.
    fn formula(x: f32, y: f32) -> Option<(Vec3, f32)> {
        let (dx, dy) = (x - 48.0, 48.0 - y);
        let rest = 40.0f32.powi(2) - dx * dx - dy * dy;
        if rest <= 40.0 {
            return None;
        }
        let (bx, by) = (dx - 12.0, dy - 9.0);
        let bump = 5.0 * (-(bx * bx + by * by) / 90.0).exp();
        let height = rest.sqrt() + bump;
        let slope = |d: f32, b: f32| -d / rest.sqrt() - bump * 2.0 * b / 90.0;
        Some((vec3(-slope(dx, bx), -slope(dy, by), 1.0).normalize(), 150.0 - height))
    }

    pub fn at(&self, x: usize, y: usize) -> Option<(Vec3, f32)> {
        self.surface[y * SIDE + x]
    }

    /// Whether a pixel and its neighbors are on the surface.
    pub fn is_inner(&self, x: usize, y: usize) -> bool {
        x > 0
            && y > 0
            && x < SIDE - 1
            && y < SIDE - 1
            && (y - 1..=y + 1).all(|y| (x - 1..=x + 1).all(|x| self.at(x, y).is_some()))
    }

    /// Nearest and farthest depth.
    pub fn range(&self) -> (f32, f32) {
        let depths = self.surface.iter().flatten().map(|s| s.1);
        depths.fold((f32::INFINITY, 0.0), |(a, b), z| (a.min(z), b.max(z)))
    }

    /// OpenGL, 16 bits, flat outside.
    pub fn normal_png(&self) -> Vec<u8> {
        png(16, |x, y| self.at(x, y).map_or([0.5, 0.5, 1.0, 1.0], |(n, _)| encode(n.x, n.y, n.z)))
    }

    /// 16 bits, 0 near, far outside.
    pub fn depth_png(&self) -> Vec<u8> {
        let (near, far) = self.range();
        png(16, |x, y| [self.at(x, y).map_or(1.0, |(_, z)| (z - near) / (far - near)); 4])
    }

    pub fn mask_png(&self) -> Vec<u8> {
        png(8, |x, y| if self.at(x, y).is_some() { [1.0; 4] } else { [0.0, 0.0, 0.0, 1.0] })
    }
}

/// Components in [−1, 1] to [0, 1], opaque.
pub fn encode(x: f32, y: f32, z: f32) -> [f32; 4] {
    [x * 0.5 + 0.5, y * 0.5 + 0.5, z * 0.5 + 0.5, 1.0]
}

/// An RGB(A) PNG of 8 or 16 bits; alpha is left out where it is 1 everywhere.
pub fn png(bits: u8, texel: impl Fn(usize, usize) -> [f32; 4]) -> Vec<u8> {
    png_of(SIDE, bits, texel)
}

pub fn png_of(side: usize, bits: u8, texel: impl Fn(usize, usize) -> [f32; 4]) -> Vec<u8> {
    let texels: Vec<[f32; 4]> = (0..side * side).map(|i| texel(i % side, i / side)).collect();
    let opaque = texels.iter().all(|t| t[3] == 1.0);
    let n = side as u32;
    let image = if bits == 8 {
        let bytes = texels.iter().flat_map(|t| t.map(|v| (v * 255.0).round() as u8)).collect();
        let image =
            image::DynamicImage::ImageRgba8(image::RgbaImage::from_raw(n, n, bytes).unwrap());
        if opaque { image.to_rgb8().into() } else { image }
    } else {
        let words = texels.iter().flat_map(|t| t.map(|v| (v * 65535.0).round() as u16)).collect();
        let image =
            image::DynamicImage::ImageRgba16(image::ImageBuffer::from_raw(n, n, words).unwrap());
        if opaque { image.to_rgb16().into() } else { image }
    };
    let mut out = Cursor::new(Vec::new());
    image.write_to(&mut out, image::ImageFormat::Png).unwrap();
    out.into_inner()
}

/// A float EXR of named channels.
pub fn exr_bytes(channels: &[(&str, Vec<f32>)], world_to_camera: Option<[f32; 16]>) -> Vec<u8> {
    use exr::prelude::*;
    let list = channels
        .iter()
        .map(|(name, values)| AnyChannel::new(*name, FlatSamples::F32(values.clone())))
        .collect();
    let attributes = LayerAttributes { world_to_camera, ..LayerAttributes::named("main") };
    let encoding = Encoding { compression: Compression::ZIP16, ..Encoding::default() };
    let layer = Layer::new((SIDE, SIDE), attributes, encoding, AnyChannels::sort(list));
    let mut out = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut out).unwrap();
    out.into_inner()
}

/// Files in memory.
pub struct Memory(HashMap<String, Vec<u8>>);

impl Memory {
    pub fn new<const N: usize>(files: [(&str, Vec<u8>); N]) -> Self {
        Self(files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect())
    }
}

impl Files for Memory {
    fn read(&self, name: &str, _: &Budget) -> Result<Vec<u8>> {
        let missing = || Error::io(name, std::io::Error::from(std::io::ErrorKind::NotFound));
        self.0.get(name).cloned().ok_or_else(missing)
    }

    fn path(&self, name: &str) -> PathBuf {
        name.into()
    }
}
