//! The unwrapped view: a painting as it lies in the planes of the surface. A picture painted there,
//! placed where the view says and bent by D_s, lies on the surface where it was seen. Floor 4.

use super::ViewUnavailable;
use crate::document::{
    Document, Highlights, Layer, Progress, flatten, flatten_layer, flatten_to_floats,
};
use crate::math::{Rect, Size, Vec2, parallel, srgb::quantize, vec2};
use crate::memory::fill_or_unwind;
use crate::paint::Placement;
use crate::raster::{Picture, TileGrid};
use crate::surface::deformation::DeformedRect;
use crate::surface::operator::UnwrapSettings;
use crate::surface::unwrap::PlaneView;
use crate::surface::{Bend, Deformation};
use rayon::prelude::*;

/// How the view is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnwrapOptions {
    /// Pixels of the view along one of the plane, [`UnwrapOptions::SCALE`].
    pub scale: u32,
    /// How the surface is unwrapped, unless the layer has settings of its own.
    pub settings: UnwrapSettings,
    /// If given, the painting is composed without rounding to 8 bits, and its highlights are
    /// treated this way.
    pub floats: Option<Highlights>,
}

impl UnwrapOptions {
    /// How many pixels of it may lie along one of the canvas.
    pub const SCALE: std::ops::RangeInclusive<u32> = 1..=4;
}

impl Default for UnwrapOptions {
    fn default() -> Self {
        Self { scale: 1, settings: UnwrapSettings { amount: 1.0, smooth_px: 0.0 }, floats: None }
    }
}

/// A painting in the planes of its surface, and what puts the same picture back: an image layer
/// with this placement and this bend shows it where it was.
pub struct UnwrappedPicture {
    /// Its size, px.
    pub size: Size,
    /// Premultiplied, encoded, row by row. A few pixels around the pieces continue their rims, so
    /// that nothing shines through where a rim is looked up.
    pub pixels: Vec<[f32; 4]>,
    /// Where a picture lies in it.
    pub placement: Placement,
    /// How it is bent back.
    pub bend: Bend,
}

impl UnwrappedPicture {
    /// With 8 bits a channel.
    pub fn picture(&self) -> Option<Picture> {
        let straight = |&[r, g, b, a]: &[f32; 4]| {
            let over = 1.0 / a.max(1e-6);
            [r * over, g * over, b * over, a].map(quantize)
        };
        Picture::srgb8(self.size, self.pixels.par_iter().map(straight).collect())
    }
}

/// How far the rims of pieces are continued, px of the plane.
const BLEED_PX: u32 = 6;

/// The painting in the planes of its surface, the objects laid out next to each other.
///
/// `layer`: shows that layer alone; if it is bent by D_s, in the plane as its own operator and
/// anchors lay it.
pub fn render_unwrapped(
    document: &Document,
    layer: Option<&Layer>,
    options: UnwrapOptions,
    progress: &Progress,
) -> Result<UnwrappedPicture, ViewUnavailable> {
    let surface = document.surface.as_deref().ok_or(ViewUnavailable::NoSurface)?;
    let own = layer
        .and_then(|layer| layer.content.bend())
        .filter(|bend| bend.operator.unwrapping().is_some());
    let layout = match own {
        Some(_) => None,
        None => {
            Some(surface.plane_layout(options.settings).ok_or(ViewUnavailable::NothingUnwrapped)?)
        }
    };
    let (view, bend) = match (&layout, own) {
        (None, Some(bend)) => (Some(lay_out_by(document, &bend)?), bend),
        (layout, _) => (None, layout.as_ref().map(|layout| layout.bend()).unwrap_or_default()),
    };
    let view = view
        .as_ref()
        .or(layout.as_ref().map(|layout| layout.sheet()))
        .ok_or(ViewUnavailable::NothingUnwrapped)?;
    let painting =
        Painting::of(document, layer, options.floats, progress).ok_or(ViewUnavailable::NoMemory)?;
    let scale = options.scale.clamp(*UnwrapOptions::SCALE.start(), *UnwrapOptions::SCALE.end());
    let (size, pixels) = pull_painting(&painting, view, scale);
    Ok(UnwrappedPicture {
        size,
        pixels,
        placement: place_over(view.rect, size, document.size),
        bend,
    })
}

/// The plane as an operator and anchors lay it.
fn lay_out_by(document: &Document, bend: &Bend) -> Result<PlaneView, ViewUnavailable> {
    let surface = document.surface.as_deref().ok_or(ViewUnavailable::NoSurface)?;
    let mut deformed = DeformedRect::default();
    Deformation::new(Some(surface), document.size, bend).fill(document.size.rect(), &mut deformed);
    PlaneView::of(surface, &deformed).ok_or(ViewUnavailable::NothingUnwrapped)
}

/// The placement that shows a picture over a rectangle of the plane, equally wide.
pub fn place_over(rect: Rect, picture: Size, canvas: Size) -> Placement {
    let (w, h) = (picture.width.max(1) as f32, picture.height.max(1) as f32);
    let cover = (canvas.width as f32 / w).max(canvas.height as f32 / h);
    let px_per_texel = rect.width() as f32 / w;
    Placement {
        center: vec2(
            rect.x0 as f32 + 0.5 * rect.width() as f32,
            rect.y0 as f32 + 0.5 * rect.height() as f32,
        ),
        scale: (px_per_texel / cover).max(*Placement::SCALE.start()).min(*Placement::SCALE.end()),
        rotation: 0.0,
    }
}

/// What is sampled: composed with 8 bits, or without rounding.
enum Painting {
    Tiles(TileGrid, Size),
    Floats(Vec<[f32; 4]>, Size),
}

impl Painting {
    fn of(
        document: &Document,
        layer: Option<&Layer>,
        floats: Option<Highlights>,
        progress: &Progress,
    ) -> Option<Self> {
        Some(match (layer, floats) {
            (Some(layer), _) => {
                Painting::Tiles(flatten_layer(document, layer.id, progress)?, document.size)
            }
            (None, Some(highlights)) => {
                Painting::Floats(flatten_to_floats(document, highlights, progress)?, document.size)
            }
            (None, None) => Painting::Tiles(flatten(document, progress)?, document.size),
        })
    }

    /// Premultiplied; the canvas's rim is continued beyond it.
    fn pixel(&self, x: i32, y: i32) -> [f32; 4] {
        let (Painting::Tiles(_, size) | Painting::Floats(_, size)) = self;
        let (x, y) = (x.clamp(0, size.width as i32 - 1), y.clamp(0, size.height as i32 - 1));
        match self {
            Painting::Tiles(tiles, _) => tiles.pixel(x, y).map(|v| f32::from(v) / 255.0),
            Painting::Floats(pixels, size) => pixels[y as usize * size.width as usize + x as usize],
        }
    }

    /// Between four pixels.
    fn interpolate(&self, point: Vec2) -> [f32; 4] {
        let corner = (point - 0.5).floor();
        let (share, x, y) = (point - 0.5 - corner, corner.x as i32, corner.y as i32);
        let [a, b, c, d] =
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| self.pixel(x + dx, y + dy));
        std::array::from_fn(|i| {
            let (above, below) = (a[i] + share.x * (b[i] - a[i]), c[i] + share.x * (d[i] - c[i]));
            above + share.y * (below - above)
        })
    }
}

/// The painting at each pixel of a view of the plane, with so many pixels per pixel of the plane.
fn pull_painting(painting: &Painting, view: &PlaneView, scale: u32) -> (Size, Vec<[f32; 4]>) {
    let size = Size::new(view.rect.width() as u32 * scale, view.rect.height() as u32 * scale);
    let corner = vec2(view.rect.x0 as f32, view.rect.y0 as f32);
    let w = size.width as usize;
    let mut pixels = fill_or_unwind(size.area(), [f32::NAN; 4]);
    parallel::for_each_row(&mut pixels, w, 1, |y, row| {
        for (x, pixel) in row.iter_mut().enumerate() {
            let p = corner + (vec2(x as f32, y as f32) + 0.5) / scale as f32;
            if let Some(point) = view.sample(p) {
                *pixel = painting.interpolate(point);
            }
        }
    });
    bleed(&mut pixels, size, BLEED_PX * scale);
    (size, pixels)
}

/// Continues what is known into what is not (NaN), pixel by pixel from the rims; what stays unknown
/// is transparent.
fn bleed(pixels: &mut [[f32; 4]], size: Size, steps: u32) {
    let (w, h) = (size.width as i32, size.height as i32);
    let sides = [(-1, 0), (1, 0), (0, -1), (0, 1)];
    let beside = |i: usize| {
        let (x, y) = (i as i32 % w, i as i32 / w);
        let inside = move |(x, y): &(i32, i32)| *x >= 0 && *y >= 0 && *x < w && *y < h;
        sides
            .into_iter()
            .map(move |(dx, dy)| (x + dx, y + dy))
            .filter(inside)
            .map(move |(x, y)| (y * w + x) as usize)
    };
    let is_known = |pixel: &[f32; 4]| !pixel[3].is_nan();
    let mut rim: Vec<usize> = (0..pixels.len())
        .into_par_iter()
        .filter(|&i| !is_known(&pixels[i]) && beside(i).any(|j| is_known(&pixels[j])))
        .collect();
    for _ in 0..steps {
        let mean = |&i: &usize| {
            let known = beside(i).map(|j| pixels[j]).filter(is_known);
            let (sum, n) = known.fold(([0.0f32; 4], 0.0f32), |(s, n), p| {
                (std::array::from_fn(|c| s[c] + p[c]), n + 1.0)
            });
            (i, sum.map(|v| v / n.max(1.0)))
        };
        let filled: Vec<(usize, [f32; 4])> = rim.iter().map(mean).collect();
        filled.iter().for_each(|&(i, pixel)| pixels[i] = pixel);
        let mut next: Vec<usize> =
            rim.iter().flat_map(|&i| beside(i)).filter(|&j| !is_known(&pixels[j])).collect();
        next.sort_unstable();
        next.dedup();
        rim = next;
    }
    pixels.par_iter_mut().filter(|pixel| !is_known(pixel)).for_each(|pixel| *pixel = [0.0; 4]);
}
