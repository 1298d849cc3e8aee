//! A placed picture without rounding to bytes: from 16 bits or floats if its file has them, with
//! light that is brighter than white. Floor 3. Twin of `PlacedImage::render_tile`, for pictures
//! that are written once.

use super::{ImageLookup, PictureSource, PlacedImage};
use crate::paint::patches::Patches;
use crate::paint::scene::Scene;
use crate::raster::sampler::{Antialias, float_bilinear_row};
use crate::raster::tile::transparent_f32;
use crate::raster::{FloatTexture, PlanarTile, TILE, Tile, TileAt};
use crate::surface::deformation::DeformedRect;
use std::sync::{Arc, PoisonError};

impl PictureSource {
    /// The adjusted texture in floats; made again when it is no longer in use.
    pub fn float_texture(&self) -> Arc<FloatTexture> {
        let held = || self.derived.floats.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = held().upgrade() {
            return known;
        }
        // Without the lock: two threads may both make it; the results are equal.
        let made = Arc::new(FloatTexture::floats(
            self.picture.size,
            self.adjust.apply_in_floats(&self.picture),
        ));
        *held() = Arc::downgrade(&made);
        made
    }
}

/// The pixels of a tile of bytes.
fn in_floats(tile: &Tile) -> PlanarTile {
    let mut pixels = transparent_f32();
    for (pixel, bytes) in pixels.iter_mut().zip(tile.bytes().as_chunks().0) {
        *pixel = bytes.map(|v: u8| f32::from(v) / 255.0);
    }
    PlanarTile::from_pixels(&pixels)
}

impl PlacedImage {
    /// One tile of the layer; `None` beyond the canvas. Colors may be brighter than white.
    pub fn render_pixels(&self, scene: &Scene, at: TileAt) -> Option<PlanarTile> {
        let area = scene.area(at);
        if area.is_empty() {
            return None;
        }
        if self.source.picture.drawing.is_some() {
            // It has bytes only, and may be drawn larger.
            return self.render_tile(scene, at).map(|tile| in_floats(&tile));
        }
        let (texture, width) = (self.source.float_texture(), area.width());
        let mut positions = DeformedRect::default();
        let ImageLookup { margin, texels_from_canvas } =
            self.place_texture(scene, area, texture.size(), &mut positions);
        let (mut pixels, mut patches, mut antialias) =
            (transparent_f32(), Patches::default(), Antialias::default());
        for y in scene.rows(area) {
            let row = (y - area.y0) as usize;
            let out = &mut pixels[row * TILE..row * TILE + width];
            if margin == 0 {
                let from = row * width..(row + 1) * width;
                float_bilinear_row(
                    &texture,
                    &positions.x[from.clone()],
                    &positions.y[from],
                    self.outside,
                    out,
                );
            } else {
                let row = patches.row(scene, area, y, &positions, texels_from_canvas);
                antialias.float_row(&texture, row, self.outside, out);
            }
        }
        Some(PlanarTile::from_bright(&pixels))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, hash, vec2, vec3};
    use crate::paint::{Adjust, ImageFilter, Placement};
    use crate::raster::{Outside, Picture, Plane};
    use crate::surface::{Anchor, Bend, Maps, Operator, Surface};

    fn placed(picture: Picture, canvas: Size) -> PlacedImage {
        PlacedImage {
            source: PictureSource::new("a.png".into(), picture, Adjust::default()),
            placement: Placement::covering(canvas),
            outside: Outside::Mirror,
            bend: Bend::default(),
            filter: ImageFilter::Antialias,
            frame: Default::default(),
        }
    }

    /// The greatest difference between the tiles of bytes and those of floats, in bytes.
    fn greatest_difference(image: &PlacedImage, scene: &Scene) -> f32 {
        let mut farthest = 0.0f32;
        for at in TileAt::covering(scene.size.rect()) {
            let (bytes, floats) =
                (image.render_tile(scene, at).unwrap(), image.render_pixels(scene, at).unwrap());
            let inside = at.rect().intersect(scene.size.rect());
            for (x, y) in
                (0..inside.height()).flat_map(|y| (0..inside.width()).map(move |x| (x, y)))
            {
                let (byte, float) =
                    (&bytes.bytes()[(y * TILE + x) * 4..][..4], floats.rows()[y].pixel(x));
                let apart = |(byte, float): (&u8, f32)| (f32::from(*byte) - float * 255.0).abs();
                farthest = byte.iter().zip(float).map(apart).fold(farthest, f32::max);
            }
        }
        farthest
    }

    #[test]
    fn bent_or_not_it_is_the_tile_of_bytes_before_it_is_rounded() {
        let size = Size::new(70, 66);
        let slope = |x: usize, y: usize| {
            vec3((x as f32 / 9.0).sin() * 0.4, (y as f32 / 7.0).cos() * 0.3, 1.0)
        };
        let maps = Maps {
            normals: Plane::from_fn(size, |x, y| slope(x, y).normalize_or_zero()),
            depth: Plane::full(size, 0.5),
            coverage: Plane::full(size, 255),
        };
        let scene = Scene { size, surface: Some(Arc::new(Surface::new(maps).unwrap())) };
        let byte = |i: u32, c: u32| {
            (128.0 + 100.0 * (i as f32 / 40.0 + c as f32).sin() + hash::unit(1, i, c)) as u8
        };
        let texels = (0..90 * 80)
            .map(|i| [byte(i, 0), byte(i, 1), byte(i, 2), 255 - (i % 60) as u8])
            .collect();
        let picture = Picture::srgb8(Size::new(90, 80), texels).unwrap();
        for filter in [ImageFilter::Bilinear, ImageFilter::Antialias] {
            for operator in
                [Operator::None, Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 }]
            {
                let mut image = PlacedImage { filter, ..placed(picture.clone(), size) };
                image.bend = Bend {
                    operator,
                    anchors: vec![Anchor::pin(vec2(30.5, 20.5))],
                    ..Bend::default()
                };
                let apart = greatest_difference(&image, &scene);
                // Half a step for the result, for the texels, and for the level that was halved.
                assert!(apart < 1.6, "{filter:?} {operator:?}: {apart}");
            }
        }
    }

    #[test]
    fn sixteen_bits_and_light_beyond_white_come_through() {
        let size = Size::new(64, 64);
        let scene = Scene { size, surface: None };
        let level = |i: usize| (i * 16) as u16;
        let texels = (0..64 * 64).map(|i| [level(i), 0, 0, 65535]).collect();
        let picture = Picture::srgb16(size, texels).unwrap();
        let tile = placed(picture, size).render_pixels(&scene, TileAt::new(0, 0)).unwrap();
        assert_eq!(tile.rows()[40].pixel(11)[0], f32::from(level(40 * 64 + 11)) / 65535.0);
        let sun = Picture::linear(size, vec![[9.0, 1.0, 0.0, 1.0]; 64 * 64]).unwrap();
        let tile = placed(sun, size).render_pixels(&scene, TileAt::new(0, 0)).unwrap();
        let [r, g, ..] = tile.rows()[0].pixel(0);
        assert!(
            (crate::math::srgb::decode(r) - 9.0).abs() < 1e-3 && (g - 1.0).abs() < 1e-6,
            "{r} {g}"
        );
    }

    #[test]
    fn the_texture_of_floats_is_shared_while_it_is_held_and_gone_afterwards() {
        let source =
            placed(Picture::srgb8(Size::new(2, 2), vec![[9; 4]; 4]).unwrap(), Size::new(2, 2))
                .source;
        let (a, b) = (source.float_texture(), source.clone().float_texture());
        assert!(Arc::ptr_eq(&a, &b));
        let weak = Arc::downgrade(&a);
        drop((a, b));
        assert!(weak.upgrade().is_none());
    }
}
