//! The image tool: a whole picture bent over the surface (SF sec. 5.2).
//! Floor 3.

use super::{adjust::Adjust, scene::Filter};
use crate::math::{Affine2, Size, Vec2};
use crate::raster::{Outside, Picture, Texture};
use crate::surface::Bend;
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
    pub fn texture(&self) -> &Texture {
        self.texture.get_or_init(|| Texture::new(&self.picture))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

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
