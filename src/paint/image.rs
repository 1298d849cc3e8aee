//! The image tool: a whole picture bent over the surface (SF sec. 5.2).
//! Floor 3.

use super::{
    adjust::Adjust,
    scene::{Filter, Scene},
};
use crate::math::{Affine2, Rect, Size, Vec2};
use crate::raster::{Outside, Picture, TILE, Texture, Tile, TileAt, sampler, tile::TILE_AREA};
use crate::surface::{Bend, Deformation, deformation::DeformedRect};
use std::sync::{Arc, OnceLock};

/// P: where the picture lies on the canvas before it is bent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Where the picture's centre lies, canvas px.
    pub center: Vec2,
    /// 1 covers the canvas, aspect kept.
    pub scale: f32,
    /// Counter-clockwise as seen, degrees.
    pub rotation: f32,
}

impl Placement {
    /// Covers the canvas, centred.
    pub fn covering(canvas: Size) -> Self {
        Self { center: canvas.center(), scale: 1.0, rotation: 0.0 }
    }
    /// P⁻¹: texels of a picture from canvas px. A picture of the canvas's own size at scale 1 maps pixel for pixel.
    pub fn texels_from_canvas(&self, canvas: Size, picture: Size) -> Affine2 {
        let cover = (canvas.width as f32 / picture.width as f32).max(canvas.height as f32 / picture.height as f32);
        let texels_per_px = 1.0 / (cover * self.scale);
        // Counter-clockwise as seen is clockwise in y-down coordinates, so its inverse turns by +rotation.
        Affine2::from_translation(picture.center())
            * Affine2::from_scale_angle_translation(Vec2::splat(texels_per_px), self.rotation.to_radians(), Vec2::ZERO)
            * Affine2::from_translation(-self.center)
    }
}

/// A picture and its adjustments; the texture is made once, when it is first needed.
#[derive(Clone)]
pub struct PictureSource {
    /// The name it goes by in the document: a path relative to the recipe or an entry of the project.
    pub file: String,
    pub picture: Picture,
    pub adjust: Adjust,
    texture: Arc<OnceLock<Texture>>,
}

impl PictureSource {
    pub fn new(file: String, picture: Picture, adjust: Adjust) -> Self {
        Self { file, picture, adjust, texture: Arc::default() }
    }
    /// The adjusted texture.
    ///
    /// Made by the thread that first asks, without helpers: a worker waiting for helpers here could be handed a tile that
    /// waits for this very texture.
    pub fn texture(&self) -> &Texture {
        self.texture.get_or_init(|| Texture::new(&self.adjust.apply(&self.picture)))
    }
}

/// I(P⁻¹(D(q))).
#[derive(Clone)]
pub struct PlacedImage {
    pub source: PictureSource,
    pub placement: Placement,
    pub outside: Outside,
    pub bend: Bend,
    pub filter: Filter,
}

impl PlacedImage {
    /// One tile of the layer; `None` where it is transparent, or beyond the canvas.
    pub fn render_tile(&self, scene: &Scene, at: TileAt) -> Option<Tile> {
        let area = at.rect().intersect(scene.size.rect());
        if area.is_empty() {
            return None;
        }
        let texture = self.source.texture();
        let positions = self.texel_positions(scene, area);
        let mut bytes = vec![0u8; TILE_AREA * 4];
        for (row, y) in (area.y0..area.y1).enumerate() {
            let to = ((y - at.rect().y0) as usize * TILE + (area.x0 - at.rect().x0) as usize) * 4;
            let from = row * area.width()..(row + 1) * area.width();
            let out = &mut bytes[to..to + area.width() * 4];
            sampler::bilinear_row(texture, &positions.x[from.clone()], &positions.y[from], self.outside, out);
        }
        if bytes.chunks_exact(4).all(|p| p[3] == 0) {
            return None;
        }
        Tile::from_bytes(bytes)
    }
    /// P⁻¹(D(q)) at every pixel centre of a rectangle, in texels.
    fn texel_positions(&self, scene: &Scene, rect: Rect) -> DeformedRect {
        let mut positions = DeformedRect::default();
        Deformation::new(scene.surface.as_deref(), scene.size, &self.bend).fill(rect, &mut positions);
        let texels_from_canvas = self.placement.texels_from_canvas(scene.size, self.source.texture().size());
        if texels_from_canvas != Affine2::IDENTITY {
            transform(texels_from_canvas, &mut positions.x, &mut positions.y);
        }
        positions
    }
}

crate::widest! {
    /// Moves every point by a linear map and a translation.
    fn transform(map: Affine2, x: &mut [f32], y: &mut [f32]) {
        let ([xx, yx], [xy, yy], [x0, y0]) =
            (map.matrix2.x_axis.to_array(), map.matrix2.y_axis.to_array(), map.translation.to_array());
        for (x, y) in x.iter_mut().zip(y) {
            (*x, *y) = (xx * *x + xy * *y + x0, yx * *x + yy * *y + y0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{hash, vec2};
    use crate::raster::{TileGrid, picture::Texels};
    use crate::surface::Anchor;
    use std::sync::Arc;

    /// Every tile of the layer, as straight bytes of the canvas.
    fn rendered(image: &PlacedImage, scene: &Scene) -> Vec<u8> {
        let mut grid = TileGrid::for_rect(scene.size.rect());
        for at in TileAt::covering(scene.size.rect()) {
            grid.set(at, image.render_tile(scene, at).map(Arc::new));
        }
        grid.to_straight_rgba(scene.size.rect())
    }
    fn noise(size: Size) -> Picture {
        let byte = |i: u32, c: u32| (hash::unit(3, i, c) * 256.0) as u8;
        let texel = |i| [byte(i, 0), byte(i, 1), byte(i, 2), 255];
        Picture::srgb8(size, (0..size.area() as u32).map(texel).collect()).unwrap()
    }
    fn placed(picture: Picture, canvas: Size) -> PlacedImage {
        PlacedImage {
            source: PictureSource::new("noise.png".into(), picture, Adjust::default()),
            placement: Placement::covering(canvas),
            outside: Outside::None,
            bend: Bend::default(),
            filter: Filter::Bilinear,
        }
    }

    #[test]
    fn an_unbent_picture_of_the_canvas_size_equals_its_file_byte_for_byte() {
        let size = Size::new(131, 70);
        let picture = noise(size);
        let Texels::Srgb8(texels) = &picture.texels else { unreachable!() };
        let texels = texels.as_flattened().to_vec();
        let scene = Scene { size, surface: None };
        for filter in [Filter::Bilinear, Filter::Antialias] {
            let image = PlacedImage { filter, ..placed(picture.clone(), size) };
            assert!(rendered(&image, &scene) == texels, "{filter:?}");
        }
    }
    #[test]
    fn a_tile_beyond_the_canvas_or_the_picture_is_nothing() {
        let size = Size::new(100, 100);
        let scene = Scene { size, surface: None };
        let mut image = placed(noise(size), size);
        assert!(image.render_tile(&scene, TileAt::new(2, 0)).is_none());
        assert!(image.render_tile(&scene, TileAt::new(-1, 0)).is_none());
        image.placement.center = vec2(-400.0, 50.0);
        assert!(image.render_tile(&scene, TileAt::new(0, 0)).is_none());
    }
    #[test]
    fn dragged_content_shows_its_source_point_at_the_anchor() {
        let size = Size::new(64, 64);
        let picture = noise(size);
        let scene = Scene { size, surface: None };
        let mut image = placed(picture.clone(), size);
        image.bend.anchors = vec![Anchor { at: vec2(10.5, 20.5), source: vec2(40.5, 7.5) }];
        let bytes = rendered(&image, &scene);
        let Texels::Srgb8(texels) = &picture.texels else { unreachable!() };
        assert_eq!(bytes[(20 * 64 + 10) * 4..][..4], texels[7 * 64 + 40]);
    }

    #[test]
    fn a_picture_of_the_canvas_size_maps_pixel_for_pixel() {
        let size = Size::new(300, 200);
        let m = Placement::covering(size).texels_from_canvas(size, size);
        assert!((m.transform_point2(vec2(12.5, 7.5)) - vec2(12.5, 7.5)).length() < 1e-4);
    }
    #[test]
    fn rotation_is_counter_clockwise_as_seen() {
        let size = Size::new(200, 200);
        let placement = Placement { rotation: 90.0, ..Placement::covering(size) };
        // The picture's right end must be seen at the top of the canvas.
        let texel = placement.texels_from_canvas(size, size).transform_point2(vec2(100.0, 10.0));
        assert!((texel - vec2(190.0, 100.0)).length() < 1e-3, "{texel}");
    }
}
