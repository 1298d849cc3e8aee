//! The image tool: a whole picture bent over the surface (SF sec. 5.2).
//! Floor 3. Here: rendered as bytes. Without rounding: `floats`.

mod floats;
mod placed_path;
mod source;

pub use source::{PictureOrigin, PictureSource};

use super::patches::Patches;
use super::scene::{ImageFilter, Scene};
use crate::math::{Affine2, PlaneMap, Rect, Size, Vec2, vec2};
use crate::raster::sampler::{Antialias, Bilinear};
use crate::raster::{Outside, Picture, TILE, Texture, Tile, TileAt, tile::TILE_AREA};
use crate::surface::{Bend, Deformation, Operator, deformation::DeformedRect};
use std::cell::RefCell;
use std::sync::Arc;

/// P: where the picture lies on the canvas before it is bent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Where the picture's center lies, canvas px.
    pub center: Vec2,
    /// 1 covers the canvas, aspect kept.
    pub scale: f32,
    /// Counter-clockwise as seen, degrees.
    pub rotation: f32,
}

impl Placement {
    /// The range of a scale.
    pub const SCALE: crate::math::Range = 1e-4..=1e4;

    /// Covers the canvas, centered.
    pub fn covering(canvas: Size) -> Self {
        Self { center: canvas.center(), scale: 1.0, rotation: 0.0 }
    }

    /// A picture at 100 %, its middle at a point.
    pub fn at_own_size(canvas: Size, picture: &Picture, center: Vec2) -> Self {
        let pixels = vec2(picture.size.width as f32, picture.size.height as f32);
        let cover = (canvas.width as f32 / pixels.x).max(canvas.height as f32 / pixels.y);
        let scale = picture.own_size().x / pixels.x / cover;
        let scale = scale.max(*Self::SCALE.start()).min(*Self::SCALE.end());
        Self { center, scale, rotation: 0.0 }
    }

    /// Covers everything that the reflection operator looks up from anywhere on a shape that fits
    /// the canvas: `|D(q) − c| ≤ (½ +
    /// |α|) L`, so that an angular map, of which only the inscribed disc is painted, leaves no holes.
    ///
    /// * `alpha`: of the operator, canvas lengths. `turn`: r̄ where the picture is pinned.
    pub fn covering_mirror(canvas: Size, alpha: f32, turn: Vec2) -> Self {
        let longer = canvas.longer_side();
        // The picture covers the canvas at scale 1: its shorter side is the canvas's or longer.
        let shorter = canvas.width.min(canvas.height) as f32;
        let scale = (1.0 + 2.0 * alpha.abs()) * longer / shorter.max(1.0);
        let center = canvas.center() - alpha * longer * turn;
        Self {
            center,
            scale: scale.max(*Self::SCALE.start()).min(*Self::SCALE.end()),
            rotation: 0.0,
        }
    }

    /// The same place on another canvas, px for px, for a picture that covers both by its own
    /// aspect.
    pub fn on_canvas_of(&self, from: Size, to: Size, picture: Size) -> Self {
        let cover = |canvas: Size| {
            (canvas.width as f32 / picture.width as f32)
                .max(canvas.height as f32 / picture.height as f32)
        };
        let scale = self.scale * (cover(from) / cover(to));
        Self { scale: scale.max(*Self::SCALE.start()).min(*Self::SCALE.end()), ..*self }
    }

    /// P⁻¹: texels of a picture from canvas px. A picture of the canvas's own size at scale 1 maps
    /// pixel for pixel.
    pub fn texels_from_canvas(&self, canvas: Size, picture: Size) -> Affine2 {
        let cover = (canvas.width as f32 / picture.width as f32)
            .max(canvas.height as f32 / picture.height as f32);
        let texels_per_px = 1.0 / (cover * self.scale);
        // Counter-clockwise as seen is clockwise in y-down coordinates, so its inverse turns by
        // +rotation.
        Affine2::from_translation(picture.center())
            * Affine2::from_scale_angle_translation(
                Vec2::splat(texels_per_px),
                self.rotation.to_radians(),
                Vec2::ZERO,
            )
            * Affine2::from_translation(-self.center)
    }
}

/// Buffers of one tile, reused for the next.
#[derive(Default)]
struct ImageScratch {
    positions: DeformedRect,
    patches: Patches,
    bilinear: Bilinear,
    antialias: Antialias,
}

thread_local! {
    /// Some 60 KiB a thread; new ones would be filled with zeros for each tile.
    static SCRATCH: RefCell<ImageScratch> = RefCell::default();
}

/// I(P⁻¹(D(q))).
#[derive(Clone, PartialEq)]
pub struct PlacedImage {
    /// What is placed.
    pub source: PictureSource,
    /// Where it lies before it is bent.
    pub placement: Placement,
    /// What is beyond its edges.
    pub outside: Outside,
    /// How it is bent, and where it is pinned.
    pub bend: Bend,
    /// How it is read.
    pub filter: ImageFilter,
    /// Where the frame of `placement` lies on the canvas; anchors are on the canvas already.
    pub frame: PlaneMap,
}

impl PlacedImage {
    /// A picture that is not bent yet, mirrored beyond its edges.
    pub fn new(source: impl Into<PictureSource>, placement: Placement) -> Self {
        Self {
            source: source.into(),
            placement,
            outside: Outside::Mirror,
            bend: Bend::default(),
            filter: ImageFilter::default(),
            frame: PlaneMap::IDENTITY,
        }
    }

    /// The frame's px from those of the picture at 100 %, from its corner.
    pub fn frame_from_own(&self, canvas: Size) -> Affine2 {
        let picture = &self.source.picture;
        let texels = picture.size.width as f32 / picture.own_size().x;
        self.placement.texels_from_canvas(canvas, picture.size).inverse()
            * Affine2::from_scale(Vec2::splat(texels))
    }

    /// The same picture, bent.
    pub fn with_bend(self, bend: Bend) -> Self {
        Self { bend, ..self }
    }

    /// The pixels of a canvas that see some texels of its picture; `None` where these may be
    /// anywhere.
    pub fn seen_rect(&self, canvas: Size, texels: Rect) -> Option<Rect> {
        if self.bend.operator != Operator::None || self.outside != Outside::None {
            return None;
        }
        let to_frame =
            self.placement.texels_from_canvas(canvas, self.source.picture.size).inverse();
        let to_canvas = self.frame.as_affine()? * to_frame;
        let corners = [(texels.x0, texels.y0), (texels.x1, texels.y0), (texels.x0, texels.y1)];
        let [a, b, c] = corners.map(|(x, y)| to_canvas.transform_point2(vec2(x as f32, y as f32)));
        let all = [a, b, c, b + c - a];
        // A pixel is the mean of what lies around it, and so is a texel where it is enlarged.
        let texel = to_canvas.matrix2.x_axis.length().max(to_canvas.matrix2.y_axis.length());
        let reach = Vec2::splat(4.0 + 4.0 * texel);
        let low = all.into_iter().fold(a, Vec2::min) - reach;
        let high = all.into_iter().fold(a, Vec2::max) + reach;
        let is_near = low.abs().max(high.abs()).max_element() < 1e7;
        is_near.then(|| {
            Rect::new(low.x as i32 - 1, low.y as i32 - 1, high.x as i32 + 1, high.y as i32 + 1)
        })
    }

    /// One tile of the layer; `None` if it is transparent or beyond the canvas.
    pub fn render_tile(&self, scene: &Scene, at: TileAt) -> Option<Tile> {
        let area = scene.area(at);
        if area.is_empty() {
            return None;
        }
        let texture = self.texture_at(scene, area);
        SCRATCH.with_borrow_mut(|scratch| self.render_with(scratch, &texture, scene, area))
    }

    /// The texture that an area reads.
    fn texture_at(&self, scene: &Scene, area: Rect) -> Arc<Texture> {
        if self.source.picture.drawing.is_none() {
            return self.source.texture();
        }
        let from_frame = self.placement.texels_from_canvas(scene.size, self.source.picture.size);
        let frame = BentFrame::of(&self.frame, area, (0, 0));
        let [x, y] = (from_frame * frame.linear).matrix2.to_cols_array_2d();
        self.source.texture_of(Vec2::from(x).length().min(Vec2::from(y).length()))
    }

    fn render_with(
        &self,
        scratch: &mut ImageScratch,
        texture: &Texture,
        scene: &Scene,
        area: Rect,
    ) -> Option<Tile> {
        let mut pixels = vec![[0u8; 4]; TILE_AREA];
        let ImageScratch { positions, patches, bilinear, antialias } = scratch;
        let ImageLookup { margin, texels_from_canvas } =
            self.place_texture(scene, area, texture.size(), positions);
        let width = area.width();
        // Tiles begin at the canvas's corner, so an area begins at its tile's.
        let first = |y: i32| (y - area.y0) as usize * TILE;
        if margin == 0 && width == TILE {
            // The rows of a whole tile are contiguous: the next row is prefetched while this one is
            // read.
            bilinear.row(
                texture,
                &positions.x,
                &positions.y,
                self.outside,
                &mut pixels[first(area.y0)..],
            );
            return Tile::from_pixels(pixels.into_flattened());
        }
        for y in scene.rows(area) {
            let out = &mut pixels[first(y)..first(y) + width];
            if margin == 0 {
                let row = (y - area.y0) as usize;
                let from = row * width..(row + 1) * width;
                let (x, y) = (&positions.x[from.clone()], &positions.y[from]);
                bilinear.row(texture, x, y, self.outside, out);
            } else {
                let row = patches.row(scene, area, y, positions, texels_from_canvas);
                antialias.row_by(self.source.rule, texture, row, self.outside, out);
            }
        }
        Tile::from_pixels(pixels.into_flattened())
    }

    /// Where each pixel of an area reads a texture of this size: `positions` in texels, of the area
    /// grown by the margin.
    fn place_texture(
        &self,
        scene: &Scene,
        area: Rect,
        texture: Size,
        positions: &mut DeformedRect,
    ) -> ImageLookup {
        let texels_from_frame = self.placement.texels_from_canvas(scene.size, texture);
        let deformation = Deformation::new(scene.surface.as_deref(), scene.size, &self.bend);
        let deformation = deformation.with_origin(BentFrame::origin(&self.frame));
        let bent_frame = BentFrame::of(&self.frame, area, deformation.origin());
        let texels_from_canvas = texels_from_frame * bent_frame.linear;
        let is_exact = deformation.is_identity() && texels_from_canvas == Affine2::IDENTITY;
        // One more pixel on every side, where differences are taken.
        let margin = if self.filter == ImageFilter::Bilinear || is_exact { 0 } else { 1 };
        deformation.fill(area.grown(margin), positions);
        if bent_frame.apply(&mut positions.x, &mut positions.y) {
            transform(texels_from_frame, &mut positions.x, &mut positions.y);
        } else if texels_from_canvas != Affine2::IDENTITY {
            transform(texels_from_canvas, &mut positions.x, &mut positions.y);
        }
        ImageLookup { margin, texels_from_canvas }
    }
}

/// How P⁻¹(D(q)) of an area is read.
struct ImageLookup {
    /// 1 where each pixel is averaged over its patch, 0 where the picture is read at its center.
    margin: i32,
    texels_from_canvas: Affine2,
}

/// The inverse map, from the canvas into the frame of what is placed in it.
pub(super) struct BentFrame {
    /// The map itself if it is affine, else its tangent at the middle of the tile.
    pub linear: Affine2,
    perspective: Option<PlaneMap>,
}

impl BentFrame {
    /// The corner of the pixels next to where the frame's own corner lies: points are relative to
    /// it, so that what was moved by whole px is computed from the same numbers. For perspectives
    /// the corner of the canvas.
    pub fn origin(frame: &PlaneMap) -> (i32, i32) {
        const FAR: f64 = 1e6;
        match frame.coefficients() {
            Some([.., e, f]) if e.abs() <= FAR && f.abs() <= FAR => {
                (e.round() as i32, f.round() as i32)
            }
            _ => (0, 0),
        }
    }

    /// * `area`: the pixels wanted.
    /// * `origin`: the point that canvas points are relative to; for a perspective (0, 0).
    pub fn of(frame: &PlaneMap, area: Rect, origin: (i32, i32)) -> Self {
        let from_origin = PlaneMap::translation(vec2(origin.0 as f32, origin.1 as f32));
        if let Some(linear) = from_origin.then(&frame.inverse()).as_affine() {
            return Self { linear, perspective: None };
        }
        let middle = vec2((area.x0 + area.x1) as f32, (area.y0 + area.y1) as f32) * 0.5;
        let linear = frame.from_canvas(middle).map_or(Affine2::IDENTITY, |(p, jacobian)| {
            Affine2::from_mat2_translation(jacobian, p - jacobian * middle)
        });
        Self { linear, perspective: Some(*frame) }
    }

    /// Takes points of the canvas into the frame if the map is a perspective; whether it did.
    /// Points beyond the horizon go far away.
    pub fn apply(&self, x: &mut [f32], y: &mut [f32]) -> bool {
        const FAR: f32 = 1e7;
        let Some(frame) = &self.perspective else { return false };
        for (x, y) in x.iter_mut().zip(y) {
            let p = frame.from_canvas(vec2(*x, *y)).map_or(Vec2::splat(FAR), |(p, _)| p);
            (*x, *y) = p.into();
        }
        true
    }
}

crate::widest! {
    /// Moves every point by a linear map and a translation.
    pub(super) fn transform(map: Affine2, x: &mut [f32], y: &mut [f32]) {
        let ([xx, yx], [xy, yy], [x0, y0]) =
            (map.matrix2.x_axis.to_array(), map.matrix2.y_axis.to_array(), map.translation.to_array());
        for (x, y) in x.iter_mut().zip(y) {
            (*x, *y) = (xx * *x + xy * *y + x0, yx * *x + yy * *y + y0);
        }
    }
}

#[cfg(test)]
mod tests;
